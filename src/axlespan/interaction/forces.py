"""External forces on a body: constant vectors times histories, weighted as the alpha method asks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.alpha import Alpha
from axlespan.model.motions import Constant
from axlespan.model.system import System

FloatArray = npt.NDArray[np.float64]
History = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True, eq=False)
class AppliedForces:
    """Loads and the effect of prescribed motions on the free d.o.f. (N12 (15))."""

    vectors: FloatArray  # (n, n_term)
    histories: Sequence[History]  # (n_term,)
    rate: npt.NDArray[np.int64]  # (n_term,) 0: loads and u_P; 1: u̇_P; 2: ü_P, which acts at the new time only

    @classmethod
    def of(cls, system: System) -> AppliedForces:
        """The terms of a system; none where a history is zero throughout."""
        vectors: list[FloatArray] = []
        histories: list[History] = []
        rate: list[int] = []
        for load in system.loads:
            vectors.append(load.vector[system.free])
            histories.append(load.factor)
            rate.append(0)
        blocks = system.partition
        for j, motion in enumerate(system.motions):
            if isinstance(motion, Constant) and motion.amount == 0.0:
                continue
            terms = (
                (blocks.K_FP, motion.value),
                (blocks.C_FP, motion.velocity),
                (blocks.M_FP, motion.acceleration),
            )
            for order, (matrix, history) in enumerate(terms):
                column = np.asarray(matrix[:, [j]].toarray())[:, 0]
                if np.any(column):
                    vectors.append(-column)
                    histories.append(history)
                    rate.append(order)
        stacked = np.column_stack(vectors) if vectors else np.zeros((len(system.free), 0))
        return cls(stacked, tuple(histories), np.array(rate, dtype=np.int64))

    @property
    def inertial(self) -> npt.NDArray[np.bool_]:
        """Terms (n_term,) in ü_P."""
        return np.asarray(self.rate == 2)

    def static(self, time: float) -> FloatArray:
        """The force (n,) [N] of loads and displacements of supports alone."""
        return np.asarray(self.vectors @ np.where(self.rate == 0, self.factors(np.array([time]))[0], 0.0))

    @property
    def n_term(self) -> int:
        """Number of terms."""
        return len(self.histories)

    def factors(self, times: FloatArray) -> FloatArray:
        """Values (n_time, n_term) of the histories."""
        if not self.histories:
            return np.zeros((len(times), 0))
        return np.column_stack([np.asarray(history(times), float) for history in self.histories])

    def weighted(self, times: FloatArray, method: Alpha) -> FloatArray:
        """Factors (n_time - 1, n_term) of (1+α) F^c - α F^p, with the inertial terms at the new time."""
        values = self.factors(times)
        mixed = (1.0 + method.alpha) * values[1:] - method.alpha * values[:-1]
        return np.where(self.inertial, values[1:], mixed)

    def at(self, time: float) -> FloatArray:
        """The force (n,) [N] at a time."""
        return np.asarray(self.vectors @ self.factors(np.array([time]))[0])
