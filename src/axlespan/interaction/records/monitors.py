"""Self-checks of a run: compatibility, equilibrium, energy, tension."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.integrator import Matrices, State
from axlespan.interaction.plan import Plan
from axlespan.interaction.records.inertia import filtered, special_steps
from axlespan.interaction.records.substeps import Substep
from axlespan.interaction.records.sums import Sums
from axlespan.running.path import PolynomialPath

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Steps at which the energy of a run is balanced: many of a small model, a few of a large one.
_ENERGY_SAMPLES, _FEWEST_SAMPLES, _BESIDE_OTHERS, _SAMPLED_DOFS = 128, 8, 4, 100_000


# Smallest displacement [m] that a compatibility residual is related to.
_SMALLEST = 1e-6


class CompatibilityMonitor:
    """Largest |u_X - E u - r| relative to the largest displacement of the wheels (N12 (27)), now and then."""

    def __init__(self) -> None:
        self._worst, self._scale = 0.0, _SMALLEST
        self.touching: Callable[[], npt.NDArray[np.bool_]] | None = None  # which wheels; None: all

    def look(self, wheels: FloatArray, line: FloatArray) -> None:
        """Compare wheels with the line under them (n_coupled,) [m]."""
        if len(wheels) and self.touching is not None:
            which = self.touching()
            wheels, line = wheels[which], line[which]
        if len(wheels) and np.all(np.isfinite(wheels)) and np.all(np.isfinite(line)):
            self._worst = max(self._worst, float(np.abs(wheels - line).max()))
            self._scale = max(self._scale, float(np.abs(wheels).max()))

    @property
    def residual(self) -> float:
        """Relative residual [-]."""
        return self._worst / self._scale


class BalanceMonitor:
    """Vertical equilibrium of the whole structure at each step: reactions, loads, wheels and inertia.

    ``like`` is that of another crossing of the structure, whose tables serve here too.
    """

    mass: FloatArray  # (n,) M t of the structure that moves up by one [kg]
    sums: Sums
    _t_prescribed: FloatArray
    _t_free: FloatArray
    _rows: list[tuple[FloatArray, str]]
    _loads: list[tuple[float, Callable[[FloatArray], FloatArray]]]

    def __init__(
        self,
        plan: Plan,
        prescribed_paths: list[tuple[IntArray, PolynomialPath]],
        like: BalanceMonitor | None = None,
    ) -> None:
        self._plan = plan
        if like is None:
            self._read_tables(plan)
        else:
            self._t_prescribed, self._t_free, self._rows = like._t_prescribed, like._t_free, like._rows
            self.mass, self.sums, self._loads = like.mass, like.sums, like._loads
        # Each wheel's line when the whole structure moves up by one.
        free = [(path.wheels, path.free) for path in plan.rows.paths]
        self._lifted = [
            (wheels, path.moved_by(unit))
            for paths, unit in ((free, self._t_free), (prescribed_paths, self._t_prescribed))
            for wheels, path in paths
            if len(path.path_dofs)
        ]
        self._inertia, self._worst, self._scale = np.zeros(1), 0.0, 0.0
        # Steps whose accelerations were set anew, with the inertia that these leave out: those where a wheel landed,
        # and, with the new ones (n,), those after which a wheel let go.
        self.restarted: Mapping[int, float] = {}
        self.released: Mapping[int, tuple[FloatArray, float]] = {}
        self.between: Mapping[int, Sequence[Substep]] = {}  # steps that were cut
        # What elements that stand on nothing take in the steps for which reactions were asked last (n_step,).
        self.left_over: Callable[[], FloatArray | None] | None = None

    def _read_tables(self, plan: Plan) -> None:
        """What follows from the structure alone."""
        system = plan.crossing.structure.system
        t = system.translation("z")
        self._t_prescribed = t[system.prescribed]
        self._t_free = t[system.free]
        mass, damping, stiffness = (
            np.asarray(m @ t) for m in (system.mass, system.damping, system.stiffness)
        )
        if system.modal_damping is not None:
            damping[system.free] += system.modal_damping.apply(t[system.free])
        scale = np.abs(system.stiffness.diagonal()).max(initial=1.0)
        stiffness[np.abs(stiffness) < 1e-10 * scale] = 0.0
        rows = [(mass, "a")]
        rows += [(vector, name) for vector, name in ((damping, "v"), (stiffness, "u")) if np.any(vector)]
        self._rows = [(vector[system.prescribed], name) for vector, name in rows]
        moved = [vector[system.free] for vector, _ in rows]
        self.mass = moved[0]
        self.sums = Sums.together(
            [
                Sums.of_blocks(*(vector[None] if name == which else 0.0 * vector[None] for which in "uva"))
                for vector, (_, name) in zip(moved, rows, strict=True)
            ]
        )
        self._loads = [(float(t @ load.vector), load.factor) for load in system.loads]

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
        for i, (prescribed, name) in enumerate(self._rows):
            history = {"a": "acceleration", "v": "velocity", "u": "value"}[name]
            moved = sum(
                (prescribed[j] * getattr(system.motions[j], history)(times) for j in plan.moving),
                np.zeros(len(steps)),
            )
            value = sums[:, i] + moved
            if name == "a" and alpha != 0.0:
                self._filter(steps, value, moved, prescribed)
            totals += value
        applied = sum((amount * factor(times) for amount, factor in self._loads), np.zeros(len(steps)))
        wheels = self._carried(positions, forces)
        residual = reactions @ self._t_prescribed + applied - wheels - totals
        left_over = self.left_over() if self.left_over is not None else None
        if left_over is not None:
            residual -= left_over
        self._worst = max(self._worst, float(np.abs(residual).max()))
        self._scale = max(self._scale, *(float(np.abs(part).max()) for part in (wheels, applied, totals)))

    def _after(self, part: Substep, prescribed: FloatArray, alpha: float) -> float:
        """Inertia of the whole structure after a step in between."""
        motions, time = self._plan.crossing.structure.system.motions, np.array([part.time])
        moved = sum(float(prescribed[j] * motions[j].acceleration(time)[0]) for j in self._plan.moving)
        if part.excess is not None:
            return part.total + moved + part.excess
        return (part.total + moved + alpha * float(self._inertia[0])) / (1.0 + alpha)

    def _filter(
        self, steps: IntArray, momentum: FloatArray, moved: FloatArray, prescribed: FloatArray
    ) -> None:
        """Turn tᵀ M ü (n_step,), of which supports that move have a share, into inertia forces, in place."""
        alpha = self._plan.settings.method.alpha
        special = special_steps(steps, self.restarted, self.released, self.between)

        def anew(k: int) -> bool:
            step = int(steps[k])
            if step - 1 in self.released:
                accelerations, excess = self.released[step - 1]
                before = moved[k - 1] if k else moved[k]  # a support hardly changes its acceleration
                self._inertia[0] = float(self.mass @ accelerations) + before + excess
            for part in self.between.get(step, ()):
                self._inertia[0] = self._after(part, prescribed, alpha)
            if step in self.restarted:
                momentum[k] += self.restarted[step]
            return step == 0 or step in self.restarted

        filtered(momentum[:, None], alpha, self._inertia, special, anew)

    def _carried(self, positions: FloatArray, forces: FloatArray) -> FloatArray:
        """What the structure carries (n_step,) of the wheels' forces: all of it, or less at its ends."""
        total = np.zeros(len(positions))
        for wheels, path in self._lifted:
            total += path.loads(positions, forces, wheels, 1, one_way=True)[:, 0]
        return total

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
        # Moving forces stay as they are.
        self._constant = not len(plan.fleet.coupled) and bool(np.all(plan.fleet.weight >= 0.0))

    def look(self, steps: IntArray, positions: FloatArray, forces: FloatArray) -> None:
        """Look at consecutive steps: positions and forces (n_step, n_contact)."""
        if self._constant:
            self.largest = self.smallest = self._plan.fleet.weight
            return
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
        name = self._plan.crossing.contact_names[wheel]
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
    r"""Energy balance over single steps, sampled over the run; less often where crossings go side by side.

    Over one step the kinetic and strain energy change by the work of the applied and contact forces, less
    what damping and the alpha method take. With the Newmark kinematics (N12 (16), (17)) the kinetic energy
    changes by exactly

    .. math:: ΔT = [Δu - Δt^2 (β - γ/2) Δü]^T M [\\bar{ü} + (γ - ½) Δü]

    and M ü^c = (1+α) f^c - α f^p for the forces f = F - C u̇ - K u. What is left after inserting both is the
    work of forces out of balance; it should vanish to rounding.
    """

    def __init__(self, plan: Plan, samples: Collection[int] | None = None, *, alone: bool = True) -> None:
        self._plan = plan
        self.cut: Collection[int] = ()  # steps that were cut: others look at their parts
        self.restarted: Collection[int] = ()  # steps at which a wheel landed: they lose energy
        self.released: Collection[int] = ()  # steps after which a wheel let go
        # Forces (n,) of nonlinear springs on the vehicles at the last completed step.
        self.inner_of_fleet: Callable[[], FloatArray | None] | None = None
        self._inner_before: FloatArray | None = None
        steps = plan.settings.steps
        count = max(_FEWEST_SAMPLES, min(_ENERGY_SAMPLES, _SAMPLED_DOFS // plan.structure.size))
        count = count if alone else _BESIDE_OTHERS  # one of many is one of the same kind
        count = plan.settings.energy_samples or count
        spread = np.unique(np.linspace(1, steps, min(count, steps)).astype(int)).tolist()
        self._samples = set(spread if samples is None else samples)
        # A balanced step needs the one before it.
        self.steps = frozenset(self._samples | {step - 1 for step in self._samples})
        self._before: tuple[State, State, FloatArray, FloatArray] | None = None
        self._before_step = -1
        self._worst, self._scale = 0.0, 0.0

    def look(
        self, step: int, structure: State, vehicles: State, load: FloatArray, forces: FloatArray
    ) -> None:
        """Look at a completed step: states, Eᵀ X (n,) and contact forces (n_coupled,)."""
        follows = self._before_step == step - 1
        follows &= step not in self.restarted and step - 1 not in self.released and step not in self.cut
        if step in self._samples and self._before is not None and follows:
            self._balance(step, structure, vehicles, load, forces)
        self._before = None
        if step + 1 in self._samples:
            self._before = (structure.copy(), vehicles.copy(), load.copy(), forces.copy())
            self._before_step = step
            self._inner_before = None if self.inner_of_fleet is None else self.inner_of_fleet()

    def _balance(
        self, step: int, structure: State, vehicles: State, load: FloatArray, forces: FloatArray
    ) -> None:
        assert self._before is not None
        plan = self._plan
        structure_p, vehicles_p, load_p, forces_p = self._before
        factors = plan.forces.factors(plan.times_of(np.array([step - 1, step])))
        inertial = plan.forces.inertial
        applied = [plan.forces.vectors @ np.where(inertial, 0.0, row) for row in factors]
        extra = plan.forces.vectors @ np.where(inertial, factors[1], 0.0)
        pair = (applied[0] - load_p, applied[1] - load)
        energy, imbalance = _step_balance(plan, plan.structure, (structure_p, structure), pair, extra)
        fleet = plan.fleet
        if len(fleet.coupled):
            on_wheels = []
            for values in (forces_p, forces):
                vector = np.zeros(fleet.matrices.size)
                vector[fleet.dofs] = values - fleet.weight[fleet.coupled]
                on_wheels.append(vector)
            if self.inner_of_fleet is not None:
                for vector, inner in zip(on_wheels, (self._inner_before, self.inner_of_fleet()), strict=True):
                    vector += 0.0 if inner is None else inner
            states, none = (vehicles_p, vehicles), np.zeros(fleet.matrices.size)
            own = _step_balance(plan, fleet.matrices, states, (on_wheels[0], on_wheels[1]), none)
            energy, imbalance = energy + own[0], imbalance + own[1]
        if np.isfinite(energy) and np.isfinite(imbalance):
            self._worst, self._scale = max(self._worst, abs(imbalance)), max(self._scale, energy)

    def include(self, other: EnergyMonitor) -> None:
        """Count in what another one saw."""
        self._worst, self._scale = max(self._worst, other._worst), max(self._scale, other._scale)

    @property
    def residual(self) -> float:
        """Largest imbalance of a step relative to the largest energy [-]."""
        return self._worst / self._scale if self._scale > 0.0 else self._worst


def _step_balance(
    plan: Plan,
    m: Matrices,
    states: tuple[State, State],
    forces: tuple[FloatArray, FloatArray],
    inertial: FloatArray,
) -> tuple[float, float]:
    """Energy at the new time and the imbalance of one step [J]."""
    (p, c), (force_p, force_c) = states, forces
    method, dt = plan.settings.method, plan.settings.time_step
    alpha, beta, gamma = method.alpha, method._beta, method._gamma
    du, da, mean_a = c.u - p.u, c.a - p.a, 0.5 * (c.a + p.a)
    Ku = [m.K @ state.u for state in states]
    f_p, f_c = (
        force - inner - m.damping_force(state.v)
        for force, inner, state in zip(forces, Ku, states, strict=True)
    )
    kinetic_p, kinetic_c = (0.5 * float(state.v @ (m.M @ state.v)) for state in states)
    strain_p, strain_c = (0.5 * float(state.u @ inner) for state, inner in zip(states, Ku, strict=True))
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
