"""Steps between two that are written down, where a time step was cut."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Substep:
    """What reactions, section forces and the balance need of a step in between: inertia forces go on through it."""

    time: float  # [s]
    dofs: IntArray  # (n,) free d.o.f. whose inertia is needed, sorted
    near: FloatArray  # (n,) their accelerations [m/s^2]
    total: float  # the balance's weighted sum of all accelerations
    excess: float | None  # inertia left out by accelerations that were set anew; None: those of the recursion

    def at(self, dofs: IntArray) -> FloatArray:
        """Accelerations of some of the d.o.f."""
        return np.asarray(self.near[np.searchsorted(self.dofs, dofs)])
