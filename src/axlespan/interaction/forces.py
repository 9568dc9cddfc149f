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
    inertial: npt.NDArray[np.bool_]  # (n_term,) terms in ü_P, which act at the new time only

    @classmethod
    def of(cls, system: System) -> AppliedForces:
        """The terms of a system; none where a history is zero throughout."""
        vectors: list[FloatArray] = []
        histories: list[History] = []
        inertial: list[bool] = []
        for load in system.loads:
            vectors.append(load.vector[system.free])
            histories.append(load.factor)
            inertial.append(False)
        blocks = system.partition
        for j, motion in enumerate(system.motions):
            if isinstance(motion, Constant) and motion.amount == 0.0:
                continue
            terms: list[tuple[object, History, bool]] = [
                (blocks.K_FP, motion.value, False),
                (blocks.C_FP, motion.velocity, False),
                (blocks.M_FP, motion.acceleration, True),
            ]
            for matrix, history, is_inertial in terms:
                column = np.asarray(matrix[:, [j]].toarray())[:, 0]  # type: ignore[index]
                if np.any(column):
                    vectors.append(-column)
                    histories.append(history)
                    inertial.append(is_inertial)
        stacked = np.column_stack(vectors) if vectors else np.zeros((len(system.free), 0))
        return cls(stacked, tuple(histories), np.array(inertial, dtype=bool))

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
