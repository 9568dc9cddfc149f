"""Sparse matrices as compiled loops want them, and products with one: each row is summed in its own order."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.compiled import Loop, compiled
from axlespan.linalg.arrays import FloatArray

IndexArray = npt.NDArray[np.uint32]
Parts = tuple[IndexArray | FloatArray, ...]


def whole_of(matrix: sp.csr_array | None, n: int) -> Parts:
    """Row starts, columns and entries; of an empty matrix (n, n) for None. Unsigned: see the band kernel."""
    if matrix is None:
        return np.zeros(n + 1, dtype=np.uint32), np.zeros(0, dtype=np.uint32), np.zeros(0)
    entries = matrix.data.astype(np.float64, copy=False)
    return matrix.indptr.astype(np.uint32), matrix.indices.astype(np.uint32), entries


def half_of(matrix: sp.csr_array | None, n: int) -> Parts:
    """The diagonal of a symmetric matrix, and row starts, columns and entries of what stands above it."""
    if matrix is None:
        return np.zeros(n), *whole_of(None, n)
    columns, entries = matrix.indices, matrix.data
    rows = np.repeat(np.arange(n, dtype=columns.dtype), np.diff(matrix.indptr))
    on, above = np.flatnonzero(columns == rows), columns > rows
    if matrix.has_canonical_format and len(on) == n:  # what stands above the diagonal follows it
        diagonal, counts = entries[on], matrix.indptr[1:] - on - 1
    else:
        diagonal, counts = matrix.diagonal(), np.bincount(rows[above], minlength=n)
    ends = np.zeros(n + 1, dtype=np.uint32)
    np.cumsum(counts, out=ends[1:])
    return diagonal, ends, columns[above].astype(np.uint32), entries[above]


@cache
def _loop() -> Loop | None:
    return compiled(_multiply)


def _multiply(starts: Any, columns: Any, entries: Any, x: Any, result: Any) -> None:
    for i in range(result.shape[0]):
        total = 0.0
        for j in range(starts[i], starts[i + 1]):
            total += entries[j] * x[columns[j]]
        result[i] = total


class Product:
    """The product of one matrix with vectors.

    A row gives the same number whatever other rows there are, so blocks side by side act as each alone does.

    Parameters
    ----------
    matrix : csr_array, shape (m, n)
    """

    def __init__(self, matrix: sp.csr_array) -> None:
        self._matrix, self._loop = matrix, _loop()
        self._parts = whole_of(matrix, matrix.shape[0])

    def of(self, x: FloatArray) -> FloatArray:
        """The product (m,) with a vector (n,)."""
        if self._loop is None:
            return np.asarray(self._matrix @ x)
        result = np.empty(len(self._parts[0]) - 1)
        self._loop(*self._parts, x, result)
        return result
