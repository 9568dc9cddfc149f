"""How far a reduced run is from the full one: the residual of the full equations, turned into a displacement.

At sampled steps the forces that the basis leaves out of balance, (1+α) f^c - α f^p - M ü^c with
f = F - C u̇ - K u in all d.o.f., are applied statically: K⁻¹ of them. What a basis of the lowest shapes lacks
answers almost statically, so this tells the order of magnitude of the displacement that is missing anywhere in
the structure; dynamic amplification of the missing part is not in it.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.integrator import State
from axlespan.dynamics.reduction import ReducedBasis
from axlespan.interaction.plan import Plan

FloatArray = npt.NDArray[np.float64]

# Steps at which the residual is looked at.
_SAMPLES = 12


class ReductionError:
    """The largest missing displacement, relative to the largest displacement."""

    def __init__(self, plan: Plan, basis: ReducedBasis) -> None:
        self._plan, self._basis = plan, basis
        steps = plan.settings.steps
        self._samples = set(np.unique(np.linspace(1, steps, min(_SAMPLES, steps)).astype(int)).tolist())
        self._before: tuple[int, FloatArray] | None = None
        self._worst, self._scale = 0.0, 0.0

    @property
    def steps(self) -> Collection[int]:
        """Time indices at which it looks: the samples and the steps before them."""
        return self._samples | {step - 1 for step in self._samples}

    def look(
        self, step: int, structure: State, vehicles: State, load: FloatArray, forces: FloatArray
    ) -> None:
        """Look at a completed step; see :class:`axlespan.interaction.watchers.Watcher`."""
        plan, matrices = self._plan, self._plan.structure
        factors = plan.forces.factors(plan.times_of(np.array([step])))[0]
        out_of_balance = plan.forces.vectors @ np.where(plan.forces.inertial, 0.0, factors) - load
        out_of_balance -= matrices.K @ structure.u + matrices.damping_force(structure.v)
        if step in self._samples and self._before is not None and self._before[0] == step - 1:
            alpha = plan.settings.method.alpha
            residual = (1.0 + alpha) * out_of_balance - alpha * self._before[1] - matrices.M @ structure.a
            residual += plan.forces.vectors @ np.where(plan.forces.inertial, factors, 0.0)
            missing = self._basis.static_factor.solve(residual)
            self._worst = max(self._worst, float(np.abs(missing).max(initial=0.0)))
            self._scale = max(self._scale, float(np.abs(structure.u).max(initial=0.0)))
        self._before = (step, out_of_balance)

    @property
    def estimate(self) -> float:
        """Relative error [-]."""
        return self._worst / self._scale if self._scale > 0.0 else 0.0
