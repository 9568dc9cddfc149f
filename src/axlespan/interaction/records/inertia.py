"""Inertia forces that go with the other forces of a time: (1+α) I^c = M ü^c + α I^p, see N12 (13)."""

from __future__ import annotations

from collections.abc import Callable, Container, Sequence
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


def special_steps(
    steps: IntArray, restarted: Container[int], released: Container[int], cut: Container[int]
) -> list[int]:
    """Places of the steps whose inertia forces do not just follow those of the step before: the start, and what was set anew."""
    if not (restarted or released or cut):
        return [0] if steps[0] == 0 else []
    return [
        i
        for i, step in enumerate(steps.tolist())
        if step == 0 or step in restarted or step - 1 in released or step in cut
    ]


def filtered(
    momentum: FloatArray,
    alpha: float,
    before: FloatArray,
    special: Sequence[int],
    anew: Callable[[int], bool],
) -> None:
    """Turn M ü (n_step, m) of consecutive steps into inertia forces, in place.

    Parameters
    ----------
    before : array (m,)
        Those of the step before; those of the last step afterwards.
    special : sequence of int
        Places before which ``anew`` is called: it may set ``before``, and says whether the step's own M ü stands.
    """
    loop, begin = _compiled() or _recur, 0
    for step in [*special, len(momentum)]:
        loop(momentum[begin:step], alpha, before)
        begin = step
        if step < len(momentum) and anew(step):
            before[:] = momentum[step]
            begin = step + 1
