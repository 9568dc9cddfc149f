"""Forward and back substitution in a band, compiled by numba: one right-hand side, or many side by side."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from axlespan.compiled import Loop, compiled
from axlespan.linalg.arrays import FloatArray

# The widest half-bandwidth for which the loop over one right-hand side beats LAPACK (n = 5436; at 32, 108
# against 180 µs; at 8, 30 against 120), and the step between the widths that are compiled.
WIDEST, _WIDTHS = 32, 2


@cache
def compiled_solver() -> Loop | None:
    """Return :func:`substitute` as machine code, or None without numba."""
    return compiled(substitute)


@cache
def compiled_single(width: int) -> Loop | None:
    """Return :func:`single` for a width as machine code, or None without numba."""
    return compiled(single(width))


def padded_width(half_bandwidth: int) -> int:
    """The width that is compiled for a half-bandwidth."""
    return max(-(-half_bandwidth // _WIDTHS) * _WIDTHS, 4)


def scaled_rows(lower: FloatArray, width: int) -> tuple[FloatArray, FloatArray]:
    """Rows of L and of Lᵀ (n, width + 1), divided by their diagonals, whose inverses stand first.

    Parameters
    ----------
    lower : ndarray, shape (n, w + 1)
        ``lower[j, d]`` is entry (j + d, j) of L, w <= width.
    """
    n, w = lower.shape
    inverse = 1.0 / lower[:, 0]
    forward, backward = np.zeros((n, width + 1)), np.zeros((n, width + 1))
    forward[:, 0] = backward[:, 0] = inverse
    for d in range(1, min(w, n)):
        forward[d:, d] = lower[: n - d, d] * inverse[d:]
        backward[: n - d, d] = lower[: n - d, d] * inverse[: n - d]
    return forward, backward


def single(width: int) -> Loop:
    """The loop that solves L Lᵀ x = b for one right-hand side and a width that the compiler knows.

    Every row waits for the one before it. So the newest entry comes last, and divisions are made beforehand: what is
    left of the wait is one multiplication and one addition.
    """
    pairs = width // 2 - 1

    def substitute_one(forward: Any, backward: Any, rows: Any, b: Any, x: Any, work: Any) -> None:
        """Solve; rows as in :func:`substitute`, and zeros (n + 2 width,) to work in."""
        # Unsigned: a signed index would be asked at each access whether it counts from the end.
        one, two, w = np.uint64(1), np.uint64(2), np.uint64(width)
        n = np.uint64(forward.shape[0])
        for i in range(n):
            k = i + w
            first, second = forward[i, 0] * b[rows[i]], 0.0
            for e in range(np.uint64(pairs)):
                d = w - two * e
                first -= forward[i, d] * work[k - d]
                second -= forward[i, d - one] * work[k - d + one]
            first -= forward[i, two] * work[k - two]
            work[k] = (first + second) - forward[i, one] * work[k - one]
        for j in range(n):
            r = n - one - j
            k = r + w
            first, second = backward[r, 0] * work[k], 0.0
            for e in range(np.uint64(pairs)):
                d = w - two * e
                first -= backward[r, d] * work[k + d]
                second -= backward[r, d - one] * work[k + d - one]
            first -= backward[r, two] * work[k + two]
            work[k] = (first + second) - backward[r, one] * work[k + one]
            x[rows[r]] = work[k]

    return substitute_one


def substitute(lower: Any, rows: Any, x: Any) -> None:
    """Solve L Lᵀ x = b in place.

    Parameters
    ----------
    lower : ndarray, shape (n, w + 1)
        ``lower[j, d]`` is entry (j + d, j) of the Cholesky factor L of half-bandwidth w.
    rows : ndarray of int, shape (n,)
        ``rows[i]`` is the row of `x` that is eliminated as number i.
    x : ndarray, shape (n, k)
        Right-hand sides, then solutions, k innermost.

    Notes
    -----
    The columns of `x` are the inner loop, which the compiler turns into vector instructions; four entries of
    L at a time save three of four passes over the row that is being solved for.
    """
    n, width = lower.shape
    k = x.shape[1]
    for i in range(n):  # L y = b
        r = rows[i]
        j = max(0, i - width + 1)
        while j + 4 <= i:
            l0, l1, l2, l3 = (
                lower[j, i - j],
                lower[j + 1, i - j - 1],
                lower[j + 2, i - j - 2],
                lower[j + 3, i - j - 3],
            )
            r0, r1, r2, r3 = rows[j], rows[j + 1], rows[j + 2], rows[j + 3]
            for c in range(k):
                x[r, c] -= (l0 * x[r0, c] + l1 * x[r1, c]) + (l2 * x[r2, c] + l3 * x[r3, c])
            j += 4
        while j < i:
            l0, r0 = lower[j, i - j], rows[j]
            for c in range(k):
                x[r, c] -= l0 * x[r0, c]
            j += 1
        pivot = 1.0 / lower[i, 0]
        for c in range(k):
            x[r, c] *= pivot
    for i in range(n - 1, -1, -1):  # Lᵀ x = y
        r = rows[i]
        last = min(width - 1, n - 1 - i)
        d = 1
        while d + 3 <= last:
            l0, l1, l2, l3 = lower[i, d], lower[i, d + 1], lower[i, d + 2], lower[i, d + 3]
            r0, r1, r2, r3 = rows[i + d], rows[i + d + 1], rows[i + d + 2], rows[i + d + 3]
            for c in range(k):
                x[r, c] -= (l0 * x[r0, c] + l1 * x[r1, c]) + (l2 * x[r2, c] + l3 * x[r3, c])
            d += 4
        while d <= last:
            l0, r0 = lower[i, d], rows[i + d]
            for c in range(k):
                x[r, c] -= l0 * x[r0, c]
            d += 1
        pivot = 1.0 / lower[i, 0]
        for c in range(k):
            x[r, c] *= pivot
