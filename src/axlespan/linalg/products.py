"""A sparse matrix times a vector, again and again: compiled where numba is there, each row summed in its own order."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import scipy.sparse as sp

from axlespan.linalg.arrays import FloatArray
from axlespan.linalg.compiled import Loop, compiled


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
        self._parts = (
            matrix.indptr.astype(np.uint32),
            matrix.indices.astype(np.uint32),
            matrix.data.astype(np.float64),
        )

    def of(self, x: FloatArray) -> FloatArray:
        """The product (m,) with a vector (n,)."""
        if self._loop is None:
            return np.asarray(self._matrix @ x)
        result = np.empty(len(self._parts[0]) - 1)
        self._loop(*self._parts, x, result)
        return result
