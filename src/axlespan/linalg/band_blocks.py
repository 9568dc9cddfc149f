"""Many right-hand sides in a wide band, block by block: products of dense matrices, which BLAS makes quickly.

Entry (i, j) of the factor stands at i - j + j (w + 1) in LAPACK's band storage, which is i + j w: so a block inside the
band is a dense matrix with columns w apart, to be multiplied where it stands. Of blocks that stick out of the band only
the corner inside is taken.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg.blas import dtrsm

from axlespan.linalg.arrays import FloatArray

# Rows of a block, and the half-bandwidth from which blocks are quicker than the loop of the band kernel.
_ROWS = 64
NARROWEST = 128


class BandBlocks:
    """The Cholesky factor L of a wide band, as blocks.

    Parameters
    ----------
    lower : ndarray, shape (w + 1, n), columns contiguous
        Entry (i, j) of L stands at [i - j, j]; w >= 64.
    """

    def __init__(self, lower: FloatArray) -> None:
        self._columns, self._reach, self.n = lower.T, lower.shape[0] - 1, lower.shape[1]
        self._inside = np.triu(np.ones((_ROWS, _ROWS)))

    def solve(self, x: FloatArray) -> None:
        """Solve L Lᵀ x = b in place, for right-hand sides (n, k) in the order of elimination, C-contiguous."""
        filled = np.asarray(x.any(axis=1))
        first = int(filled.argmax())
        if not filled[first]:
            return
        first -= first % _ROWS  # what lies above stays zero
        for begin in range(first, self.n, _ROWS):
            self._forward(x, first, begin, min(begin + _ROWS, self.n))
        for begin in reversed(range(0, self.n, _ROWS)):
            self._backward(x, begin, min(begin + _ROWS, self.n))

    def _view(self, row: int, column: int, n_row: int, n_column: int) -> FloatArray:
        """L[row : row + n_row, column : column + n_column], with the entries of others outside the band."""
        offset = 8 * (row + column * self._reach)
        return np.ndarray((n_row, n_column), np.float64, self._columns, offset, (8, 8 * self._reach))

    def _forward(self, x: FloatArray, first: int, begin: int, end: int) -> None:
        """Solve for rows begin to end of L y = b, those before being done."""
        here = x[begin:end]
        whole = max(first, end - 1 - self._reach)  # columns that are in the band for all these rows
        if whole < begin:
            here -= self._view(begin, whole, end - begin, begin - whole) @ x[whole:begin]
        edge = begin - self._reach
        low = max(first, edge)
        if low < whole:
            corner = self._view(begin, low, end - begin - 1, whole - low)
            here[:-1] -= (corner * self._inside[: end - begin - 1, low - edge : whole - edge]) @ x[low:whole]
        dtrsm(1.0, self._view(begin, begin, end - begin, end - begin), here.T, 1, 1, 1, overwrite_b=1)

    def _backward(self, x: FloatArray, begin: int, end: int) -> None:
        """Solve for rows begin to end of Lᵀ x = y, those after being done."""
        here = x[begin:end]
        whole = min(begin + self._reach + 1, self.n)  # rows before it are in the band for all these columns
        if end < whole:
            here -= self._view(end, begin, whole - end, end - begin).T @ x[end:whole]
        last = min(end + self._reach, self.n)
        if whole < last:
            corner = self._view(whole, begin + 1, last - whole, end - begin - 1)
            here[1:] -= (corner * self._inside[: last - whole, : end - begin - 1]).T @ x[whole:last]
        dtrsm(1.0, self._view(begin, begin, end - begin, end - begin), here.T, 1, 1, 0, overwrite_b=1)
