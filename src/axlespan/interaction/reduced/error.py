"""How far a reduced run is from the full one.

Two parts, both as displacements relative to the largest one:

* What the basis lacks. At sampled steps the forces that it leaves out of balance, (1+α) f^c - α f^p - M ü^c with
  f = F - C u̇ - K u in all d.o.f., are applied statically: K⁻¹ of them. What a basis of the lowest shapes lacks
  answers almost statically.
* What the time step does not resolve. Shapes above its reach follow their forces at once; in the full system
  they ring. The run is repeated with inertia in all shapes, and the displacements on the path are compared.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.integrator import State
from axlespan.dynamics.reduction import ReducedBasis
from axlespan.interaction.convoy import Lane
from axlespan.interaction.drive import Couple, drive
from axlespan.interaction.plan import Plan
from axlespan.interaction.records.recorder import Recorder
from axlespan.interaction.reduced.body import PreparedReduced
from axlespan.interaction.start import Start

FloatArray = npt.NDArray[np.float64]

# Steps at which the two are looked at.
_SAMPLES = 12


def _samples(plan: Plan) -> list[int]:
    """Time indices, spread over the run to its end."""
    steps = plan.settings.steps
    spread = np.linspace(0, steps, min(_SAMPLES, steps) + 1)[1:].astype(int)
    return [int(step) for step in np.unique(spread)]


class ReductionError:
    """What the basis lacks; also keeps the displacements on the path at the samples."""

    def __init__(self, plan: Plan, basis: ReducedBasis) -> None:
        self._plan, self._basis = plan, basis
        self._samples = set(_samples(plan))
        self._before: tuple[int, FloatArray] | None = None
        self._worst, self._scale = 0.0, 0.0
        self.on_path: dict[int, FloatArray] = {}  # sample -> displacements of the path's d.o.f.

    @property
    def steps(self) -> Collection[int]:
        """Time indices at which it looks: the samples and the steps before them."""
        return self._samples | {step - 1 for step in self._samples}

    def look(
        self, step: int, structure: State, vehicles: State, load: FloatArray, forces: FloatArray
    ) -> None:
        """Look at a completed step; see :class:`axlespan.interaction.records.watchers.Watcher`."""
        plan, matrices = self._plan, self._plan.structure
        factors = plan.forces.factors(plan.times_of(np.array([step])))[0]
        out_of_balance = plan.forces.vectors @ np.where(plan.forces.inertial, 0.0, factors) - load
        out_of_balance -= matrices.K @ structure.u + matrices.damping_force(structure.v)
        if step in self._samples:
            self.on_path[step] = structure.u[self._basis.path_dofs]
        if step in self._samples and self._before is not None and self._before[0] == step - 1:
            alpha = plan.settings.method.alpha
            residual = (1.0 + alpha) * out_of_balance - alpha * self._before[1] - matrices.M @ structure.a
            residual += plan.forces.vectors @ np.where(plan.forces.inertial, factors, 0.0)
            missing = self._basis.static_factor.solve(residual)
            self._worst = max(self._worst, float(np.abs(missing).max(initial=0.0)))
            self._scale = max(self._scale, float(np.abs(structure.u).max(initial=0.0)))
        self._before = (step, out_of_balance)

    def facts(self, ringing: PathSamples) -> dict[str, float]:
        """Size of the basis, and the relative error [-], with the two parts that it is the sum of."""
        common = self.on_path.keys() & ringing.on_path.keys()
        apart = [float(np.abs(self.on_path[k] - ringing.on_path[k]).max(initial=0.0)) for k in common]
        scale = self._scale if self._scale > 0.0 else 1.0
        of_basis, of_time_step = self._worst / scale, max(apart, default=0.0) / scale
        return {
            "basis_size": self._basis.size,
            "reduction_error": of_basis + of_time_step,
            "reduction_error_of_basis": of_basis,
            "reduction_error_of_time_step": of_time_step,
        }


class PathSamples:
    """Keeps the displacements on the path at the samples."""

    def __init__(self, plan: Plan, basis: ReducedBasis) -> None:
        self._basis = basis
        self.steps: Collection[int] = _samples(plan)
        self.on_path: dict[int, FloatArray] = {}

    def look(
        self, step: int, structure: State, vehicles: State, load: FloatArray, forces: FloatArray
    ) -> None:
        """Look at a completed step; see :class:`axlespan.interaction.records.watchers.Watcher`."""
        self.on_path[step] = structure.u[self._basis.path_dofs]


def ringing_runs(
    plans: Sequence[Plan], starts: Sequence[Start], basis: ReducedBasis, couple: Couple
) -> list[PathSamples]:
    """Repeat reduced crossings with inertia in all shapes; what is known of those that fail is kept."""
    plans = [_bare(plan) for plan in plans]
    settings = plans[0].settings
    prepared = PreparedReduced(
        plans[0].structure, basis, settings.method, settings.time_step, all_with_inertia=True
    )
    samples = [PathSamples(plan, basis) for plan in plans]
    lanes = [
        Lane.at_start(plan, start, Recorder(plan, None, [sample]))
        for plan, start, sample in zip(plans, starts, samples, strict=True)
    ]
    drive(lanes, prepared, couple)
    return samples


def _bare(plan: Plan) -> Plan:
    """The same crossing with nothing kept."""
    settings = replace(
        plan.settings,
        every=plan.settings.steps,
        sensors={},
        sensor_lines={},
        reactions=False,
        fields=(),
        section_forces=(),
        stresses=(),
        envelopes=(),
        line_points=(),
    )
    return replace(plan, settings=settings)
