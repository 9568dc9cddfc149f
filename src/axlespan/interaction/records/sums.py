"""Weighted sums over the whole structure: what supports and equilibrium need of a step, without the d.o.f. themselves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Sums:
    """Weights of displacements, velocities and accelerations, one row for each sum."""

    rows: sp.csr_array  # (n_sum, 3 n)

    @classmethod
    def of_blocks(cls, *blocks: sp.csr_array | FloatArray) -> Sums:
        """Sums with weights (n_sum, n) for displacements, velocities and accelerations."""
        return cls(sp.csr_array(sp.hstack([sp.csr_array(block) for block in blocks])))

    @classmethod
    def together(cls, parts: Sequence[Sums]) -> Sums:
        """Several sums, one after the other."""
        return cls(sp.csr_array(sp.vstack([part.rows for part in parts])))

    @property
    def count(self) -> int:
        """Number of sums."""
        return int(self.rows.shape[0])

    def of(self, values: FloatArray) -> FloatArray:
        """The sums (n_sum,) or (n_sum, k) of states (3, n) or (3, n, k)."""
        return np.asarray(self.rows @ values.reshape(self.rows.shape[1], *values.shape[2:]))

    def read_through(self, reading: FloatArray) -> FloatArray:
        """Weights (n_sum, 3, m) of m coordinates from which the d.o.f. follow by ``reading`` (n, m)."""
        n = len(reading)
        parts = [np.asarray(self.rows[:, i * n : (i + 1) * n] @ reading) for i in range(3)]
        return np.stack(parts, axis=1)

    def pieces(self) -> tuple[IntArray, IntArray, IntArray, IntArray, FloatArray]:
        """The same as pieces that weigh one quantity each: sum and quantity of a piece, ends, d.o.f. and weights."""
        rows, n = self.rows, self.rows.shape[1] // 3
        rows.sort_indices()
        which, dof = np.divmod(rows.indices.astype(np.int64), n)
        row = np.repeat(np.arange(self.count), np.diff(rows.indptr))
        key = 3 * row + which
        begins = (
            np.flatnonzero(np.concatenate([[True], np.diff(key) > 0])) if len(key) else np.empty(0, np.int64)
        )
        of_row, of_which = np.divmod(key[begins], 3)
        ends = np.concatenate([begins, [len(key)]]).astype(np.int64)
        return of_row.astype(np.int64), of_which.astype(np.int64), ends, dof, rows.data
