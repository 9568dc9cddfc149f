"""Balance of energy over single steps."""

from __future__ import annotations

from collections.abc import Callable, Collection

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.integrator import Matrices, State
from axlespan.interaction.plan import Plan

FloatArray = npt.NDArray[np.float64]

# Steps at which the energy of a run is balanced: many of a small model, a few of a large one.
_ENERGY_SAMPLES, _FEWEST_SAMPLES, _BESIDE_OTHERS, _SAMPLED_DOFS = 128, 8, 4, 100_000


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
    if gamma != 0.5:
        numerical -= (gamma - 0.5) * float(du @ (m.M @ da))
    if offset != 0.0:
        numerical -= offset * float(da @ (m.M @ (mean_a + (gamma - 0.5) * da)))
    imbalance = (kinetic_c - kinetic_p) + (strain_c - strain_p) + damped + numerical - work
    return kinetic_c + strain_c, imbalance
