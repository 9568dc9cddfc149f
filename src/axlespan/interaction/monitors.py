"""Self-checks of a run: compatibility, equilibrium, energy, tension."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.integrator import Integrator, State
from axlespan.interaction.bodies import FleetBody, StructureBody
from axlespan.interaction.contact_system import Stretch
from axlespan.interaction.plan import Plan
from axlespan.running.path import PolynomialPath

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Steps at which the energy of a run is balanced.
_ENERGY_SAMPLES = 128


class CompatibilityMonitor:
    """Largest |u_X - E u - r| relative to the largest displacement of the wheels (N12 (27))."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._worst, self._scale = 0.0, 0.0

    def look(self, stretch: Stretch, k: int, structure: StructureBody, fleet: FleetBody) -> None:
        """Check one step."""
        wheels = fleet.at_wheels()
        line = stretch.gap[k].copy()
        on = stretch.live_coupled
        if len(on):
            line[stretch.into_coupled] += structure.under(stretch.dofs[k][on], stretch.weights[k][on])
        if np.all(np.isfinite(wheels)) and np.all(np.isfinite(line)):
            self._worst = max(self._worst, float(np.abs(wheels - line).max()))
            self._scale = max(self._scale, float(np.abs(wheels).max()))

    @property
    def residual(self) -> float:
        """Relative residual [-]."""
        return self._worst / self._scale if self._scale > 0.0 else self._worst


class BalanceMonitor:
    """Vertical equilibrium of the whole structure at each step: reactions, loads, wheels and inertia."""

    def __init__(self, plan: Plan, prescribed_paths: list[tuple[IntArray, PolynomialPath]]) -> None:
        self._plan, self._prescribed_paths = plan, prescribed_paths
        system = plan.crossing.structure.system
        t = system.translation("z")
        self._t_prescribed = t[system.prescribed]
        self._t = t
        mass, damping, stiffness = (
            np.asarray(m @ t) for m in (system.mass, system.damping, system.stiffness)
        )
        if system.modal_damping is not None:
            damping[system.free] += system.modal_damping.apply(t[system.free])
        scale = np.abs(system.stiffness.diagonal()).max(initial=1.0)
        stiffness[np.abs(stiffness) < 1e-10 * scale] = 0.0
        rows = [(mass, "a")]
        rows += [(vector, name) for vector, name in ((damping, "v"), (stiffness, "u")) if np.any(vector)]
        self._rows = [(vector[system.free], vector[system.prescribed], name) for vector, name in rows]
        self.n_sum = len(self._rows)
        self._loads = [(float(t @ load.vector), load.factor) for load in system.loads]
        self._inertia, self._worst, self._scale = 0.0, 0.0, 0.0

    def take(self, state: State, sums: FloatArray) -> None:
        """Sums over the free d.o.f. at one step."""
        for i, (vector, _, name) in enumerate(self._rows):
            sums[i] = vector @ getattr(state, name)

    def look(
        self,
        steps: IntArray,
        sums: FloatArray,
        reactions: FloatArray,
        positions: FloatArray,
        forces: FloatArray,
    ) -> None:
        """Check consecutive steps."""
        plan, system = self._plan, self._plan.crossing.structure.system
        times = plan.times_of(steps)
        alpha = plan.settings.method.alpha
        totals = np.zeros(len(steps))
        for i, (_, prescribed, name) in enumerate(self._rows):
            history = {"a": "acceleration", "v": "velocity", "u": "value"}[name]
            moved = sum(
                (prescribed[j] * getattr(system.motions[j], history)(times) for j in plan.moving),
                np.zeros(len(steps)),
            )
            value = sums[:, i] + moved
            if name == "a" and alpha != 0.0:
                for k, step in enumerate(steps):
                    self._inertia = (
                        value[k] if step == 0 else (value[k] + alpha * self._inertia) / (1.0 + alpha)
                    )
                    totals[k] += self._inertia
            else:
                totals += value
        applied = sum((amount * factor(times) for amount, factor in self._loads), np.zeros(len(steps)))
        wheels = (self._share(positions) * forces).sum(axis=1)
        residual = reactions @ self._t_prescribed + applied - wheels - totals
        self._worst = max(self._worst, float(np.abs(residual).max()))
        self._scale = max(self._scale, *(float(np.abs(part).max()) for part in (wheels, applied, totals)))

    def _share(self, positions: FloatArray) -> FloatArray:
        """Share (n_step, n_contact) of each wheel's force that the structure carries: 1, or less at its ends."""
        system, result = self._plan.crossing.structure.system, np.zeros(positions.shape)
        for path in self._plan.rows.paths:
            dofs, weights = path.free.weights(positions[:, path.wheels])
            result[:, path.wheels] = (self._t[system.free][dofs] * weights).sum(axis=2)
        for wheels, prescribed in self._prescribed_paths:
            dofs, weights = prescribed.weights(positions[:, wheels])
            result[:, wheels] += (self._t_prescribed[dofs] * weights).sum(axis=2)
        return result

    @property
    def residual(self) -> float:
        """Largest residual relative to the largest load [-]."""
        return self._worst / self._scale if self._scale > 0.0 else self._worst


@dataclass(frozen=True)
class TensionEpisode:
    """A stretch of time in which a wheel would have to pull at the rail."""

    contact: str
    start: float  # [s]
    stop: float  # [s]
    position: float  # of the wheel at the largest tension [m]
    size: float  # largest tension [N], positive


class TensionMonitor:
    """Tension episodes of every wheel, over all steps."""

    _LIMIT = 1000  # episodes kept; all are counted

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self.episodes: list[TensionEpisode] = []
        self.count = 0
        self._open: dict[int, TensionEpisode] = {}
        n = plan.rows.n_contact
        self.largest, self.smallest = np.full(n, -np.inf), np.full(n, np.inf)
        self.largest_at, self.smallest_at = np.zeros(n), np.zeros(n)

    def look(self, steps: IntArray, positions: FloatArray, forces: FloatArray) -> None:
        """Look at consecutive steps: positions and forces (n_step, n_contact)."""
        times = self._plan.times_of(steps)
        self._peaks(times, forces)
        pulled = forces < 0.0
        for wheel in np.flatnonzero(
            pulled.any(axis=0) | np.isin(np.arange(forces.shape[1]), list(self._open))
        ):
            self._episodes_of(int(wheel), times, forces[:, wheel], positions[:, wheel])

    def _peaks(self, times: FloatArray, forces: FloatArray) -> None:
        top, bottom = forces.argmax(axis=0), forces.argmin(axis=0)
        wheel = np.arange(forces.shape[1])
        higher, lower = forces[top, wheel] > self.largest, forces[bottom, wheel] < self.smallest
        self.largest_at[higher], self.smallest_at[lower] = times[top[higher]], times[bottom[lower]]
        self.largest, self.smallest = (
            np.maximum(self.largest, forces[top, wheel]),
            np.minimum(self.smallest, forces[bottom, wheel]),
        )

    def _episodes_of(self, wheel: int, times: FloatArray, forces: FloatArray, positions: FloatArray) -> None:
        name = self._plan.crossing.train.contact_names[wheel]
        for time, force, position in zip(times.tolist(), forces.tolist(), positions.tolist(), strict=True):
            current = self._open.get(wheel)
            if force < 0.0:
                if current is None:
                    current = TensionEpisode(name, time, time, position, -force)
                if -force > current.size:
                    current = TensionEpisode(name, current.start, time, position, -force)
                self._open[wheel] = TensionEpisode(name, current.start, time, current.position, current.size)
            elif current is not None:
                self._close(wheel)

    def _close(self, wheel: int) -> None:
        episode = self._open.pop(wheel)
        self.count += 1
        if len(self.episodes) < self._LIMIT:
            self.episodes.append(episode)

    def finish(self) -> None:
        """Close the episodes that last until the end."""
        for wheel in list(self._open):
            self._close(wheel)


class EnergyMonitor:
    r"""Energy balance over single steps, sampled over the run.

    Over one step the kinetic and strain energy change by the work of the applied and contact forces, less
    what damping and the alpha method take. With the Newmark kinematics (N12 (16), (17)) the kinetic energy
    changes by exactly

    .. math:: ΔT = [Δu - Δt^2 (β - γ/2) Δü]^T M [\\bar{ü} + (γ - ½) Δü]

    and M ü^c = (1+α) f^c - α f^p for the forces f = F - C u̇ - K u. What is left after inserting both is the
    work of forces out of balance; it should vanish to rounding.
    """

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        steps = plan.settings.steps
        self._samples = set(
            np.unique(np.linspace(1, steps, min(_ENERGY_SAMPLES, steps)).astype(int)).tolist()
        )
        self._before: tuple[State, State | None, FloatArray, FloatArray | None] | None = None
        self._worst, self._scale = 0.0, 0.0

    def begin(self, structure: StructureBody, fleet: FleetBody | None) -> None:
        """Remember time zero if the first step is sampled."""
        if 1 in self._samples:
            self._remember(structure, fleet)

    def _remember(self, structure: StructureBody, fleet: FleetBody | None) -> None:
        self._before = (
            structure.state.copy(),
            None if fleet is None else fleet.state.copy(),
            structure.path_load.copy(),
            None if fleet is None else fleet.forces.copy(),
        )

    def step(
        self, stretch: Stretch, k: int, structure: StructureBody, fleet: FleetBody | None, forces: FloatArray
    ) -> None:
        """Balance the step that has just been made, if it is sampled."""
        step = stretch.first + k
        if step in self._samples and self._before is not None:
            self._balance(step, structure, fleet)
        self._before = None
        if step + 1 in self._samples:
            self._remember(structure, fleet)

    def _balance(self, step: int, structure: StructureBody, fleet: FleetBody | None) -> None:
        assert self._before is not None
        before_s, before_v, load, wheel_forces = self._before
        dt, n = self._plan.settings.time_step, self._plan.structure.size
        factors = self._plan.forces.factors(np.array([step - 1, step]) * dt)
        inertial = self._plan.forces.inertial
        applied = [self._plan.forces.vectors @ np.where(inertial, 0.0, row) for row in factors]
        extra = self._plan.forces.vectors @ np.where(inertial, factors[1], 0.0)
        for vector, path_load in zip(applied, (load, structure.path_load), strict=True):
            vector[structure.path_dofs] -= path_load
        energy, imbalance = _step_balance(
            structure.integrator, before_s, structure.state, applied[0], applied[1], extra
        )
        if fleet is not None and before_v is not None and wheel_forces is not None:
            pair = []
            for values in (wheel_forces, fleet.forces):
                vector = np.zeros(len(before_v.u))
                vector[fleet.fleet.dofs] = values - fleet.static
                pair.append(vector)
            own = _step_balance(
                fleet.integrator, before_v, fleet.state, pair[0], pair[1], np.zeros(len(before_v.u))
            )
            energy, imbalance = energy + own[0], imbalance + own[1]
        if np.isfinite(energy) and np.isfinite(imbalance):
            self._worst, self._scale = max(self._worst, abs(imbalance)), max(self._scale, energy)
        assert n == structure.integrator.size

    @property
    def residual(self) -> float:
        """Largest imbalance of a step relative to the largest energy [-]."""
        return self._worst / self._scale if self._scale > 0.0 else self._worst


def _step_balance(
    body: Integrator, p: State, c: State, force_p: FloatArray, force_c: FloatArray, inertial: FloatArray
) -> tuple[float, float]:
    """Energy at the new time and the imbalance of one step [J]."""
    m, method, dt = body.matrices, body.method, body.time_step
    alpha, beta, gamma = method.alpha, method._beta, method._gamma
    du, da, mean_a = c.u - p.u, c.a - p.a, 0.5 * (c.a + p.a)

    def internal(state: State) -> FloatArray:
        return np.asarray(m.K @ state.u) + m.damping_force(state.v)

    f_p, f_c = force_p - internal(p), force_c - internal(c)
    kinetic_c, kinetic_p = (0.5 * float(s.v @ (m.M @ s.v)) for s in (c, p))
    strain_c, strain_p = (0.5 * float(s.u @ (m.K @ s.u)) for s in (c, p))
    work = float(du @ (0.5 * (force_p + force_c)))
    damped = float(du @ m.damping_force(0.5 * (p.v + c.v)))
    inertia_c = (1.0 + alpha) * f_c - alpha * f_p + inertial
    numerical = float(du @ (0.5 * (f_p + f_c) - 0.5 * (m.M @ p.a + inertia_c)))
    offset = -(dt**2) * (beta - 0.5 * gamma)
    numerical -= float(
        (gamma - 0.5) * (du @ (m.M @ da)) + offset * (da @ (m.M @ (mean_a + (gamma - 0.5) * da)))
    )
    imbalance = (kinetic_c - kinetic_p) + (strain_c - strain_p) + damped + numerical - work
    return kinetic_c + strain_c, imbalance
