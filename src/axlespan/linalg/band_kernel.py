"""Forward and back substitution in a band, compiled by numba, many right-hand sides at once."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

from axlespan.linalg.arrays import FloatArray, IntArray

Solver = Callable[[FloatArray, IntArray, FloatArray], None]


@cache
def compiled_solver() -> Solver | None:
    """Return :func:`substitute` as machine code, or None without numba.

    No fast-math: the order of the operations is the one written, so the numbers are the same at every run.
    """
    try:
        import numba
    except ImportError:
        return None
    options: dict[str, Any] = {"nogil": True, "fastmath": False}
    try:
        compiled: Solver = numba.njit(cache=True, **options)(substitute)
    except RuntimeError:  # no folder to keep the machine code in
        compiled = numba.njit(**options)(substitute)
    return compiled


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
