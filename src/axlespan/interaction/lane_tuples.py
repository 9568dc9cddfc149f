"""Numbers of one or of eight crossings side by side, as tuples that compiled loops keep in registers.

Only to be imported where numba is.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numba.extending import overload

#: How many crossings a tuple may hold.
FEW, MANY = 1, 8

# Places are unsigned (see the band kernel), and so must be what is added to them.
_1, _2, _3, _4, _5, _6, _7 = (np.uint64(i) for i in range(1, 8))


def read(lanes: Any, array: Any, at: Any) -> Any:
    """As many entries of an array as ``lanes`` has, from a place on."""
    return tuple(array[at + np.uint64(c)] for c in range(len(lanes)))


def put(array: Any, at: Any, t: Any) -> None:
    """Set entries of an array from a place on."""
    for c, value in enumerate(t):
        array[at + np.uint64(c)] = value


def plus(t: Any, factor: Any, s: Any) -> Any:
    """t + factor s."""
    return tuple(one + factor * other for one, other in zip(t, s, strict=True))


def scaled(factor: Any, t: Any) -> Any:
    """factor t."""
    return tuple(factor * one for one in t)


def size(t: Any) -> Any:
    """Largest magnitude."""
    return max(abs(one) for one in t)


@overload(read, strict=False)
def _read(lanes: Any, array: Any, at: Any) -> Callable[..., Any]:
    if lanes.count == FEW:
        return lambda lanes, array, at: (array[at],)
    return lambda lanes, array, at: (
        array[at], array[at + _1], array[at + _2], array[at + _3],
        array[at + _4], array[at + _5], array[at + _6], array[at + _7],
    )  # fmt: skip


@overload(put, strict=False)
def _put(array: Any, at: Any, t: Any) -> Callable[..., Any]:
    def one(array: Any, at: Any, t: Any) -> None:
        array[at] = t[0]

    def eight(array: Any, at: Any, t: Any) -> None:
        array[at], array[at + _1], array[at + _2], array[at + _3] = t[0], t[1], t[2], t[3]
        array[at + _4], array[at + _5], array[at + _6], array[at + _7] = t[4], t[5], t[6], t[7]

    return one if t.count == FEW else eight


@overload(plus, strict=False)
def _plus(t: Any, factor: Any, s: Any) -> Callable[..., Any]:
    if t.count == FEW:
        return lambda t, factor, s: (t[0] + factor * s[0],)
    return lambda t, factor, s: (
        t[0] + factor * s[0], t[1] + factor * s[1], t[2] + factor * s[2], t[3] + factor * s[3],
        t[4] + factor * s[4], t[5] + factor * s[5], t[6] + factor * s[6], t[7] + factor * s[7],
    )  # fmt: skip


@overload(scaled, strict=False)
def _scaled(factor: Any, t: Any) -> Callable[..., Any]:
    if t.count == FEW:
        return lambda factor, t: (factor * t[0],)
    return lambda factor, t: (
        factor * t[0], factor * t[1], factor * t[2], factor * t[3],
        factor * t[4], factor * t[5], factor * t[6], factor * t[7],
    )  # fmt: skip


@overload(size, strict=False)
def _size(t: Any) -> Callable[..., Any]:
    if t.count == FEW:
        return lambda t: abs(t[0])
    return lambda t: max(
        max(max(abs(t[0]), abs(t[1])), max(abs(t[2]), abs(t[3]))),
        max(max(abs(t[4]), abs(t[5])), max(abs(t[6]), abs(t[7]))),
    )
