"""Inertia forces that go with the other forces of a time: (1+α) I^c = M ü^c + α I^p, see N12 (13)."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.compiled import Loop, compiled

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@cache
def _compiled() -> Loop | None:
    return compiled(_recur)


def _recur(momentum: Any, alpha: float, before: Any) -> None:
    for i in range(momentum.shape[0]):
        for j in range(momentum.shape[1]):
            before[j] = (momentum[i, j] + alpha * before[j]) / (1.0 + alpha)
            momentum[i, j] = before[j]


def filtered(
    momentum: FloatArray, alpha: float, before: FloatArray, special: IntArray, anew: Callable[[int], bool]
) -> None:
    """Turn M ü (n_step, m) of consecutive steps into inertia forces, in place.

    Parameters
    ----------
    before : array (m,)
        Those of the step before; those of the last step afterwards.
    special : array of int
        Steps before which ``anew`` is called: it may set ``before``, and says whether the step's own M ü stands.
    """
    loop, begin = _compiled() or _recur, 0
    for step in [*special.tolist(), len(momentum)]:
        loop(momentum[begin:step], alpha, before)
        begin = step
        if step < len(momentum) and anew(step):
            before[:] = momentum[step]
            begin = step + 1
