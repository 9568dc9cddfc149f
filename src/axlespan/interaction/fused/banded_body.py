"""A structure of narrow band in the order of elimination of its factor, for compiled loops."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.compiled import numba_is_there
from axlespan.dynamics.integrator import Integrator
from axlespan.linalg.band_kernel import WIDEST, padded_width
from axlespan.linalg.banded import BandedFactor

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Csr = tuple[npt.NDArray[np.uint32], npt.NDArray[np.uint32], FloatArray]

#: Entries of small rows that compiled loops read at a time.
PIECE = 8


@dataclass(frozen=True, eq=False)
class BandedBody:
    """A structure in the order of elimination of its factor."""

    width: int  # that is compiled for the half-bandwidth
    rank: IntArray  # (n,) place of each d.o.f. in the order
    rows: IntArray  # (n,) the d.o.f. in that order
    K: Csr
    C: Csr
    damped: bool
    lower: FloatArray  # (n + width, width + 1): 1 / D, and entry (i, i - d) of L at [i, d]
    ahead: int  # half-bandwidth of K and C

    @classmethod
    def of(cls, integrator: Integrator) -> BandedBody | None:
        """The body, or None if it is not of narrow band or loops cannot be compiled."""
        factor, m = integrator.factor, integrator.matrices
        if not isinstance(factor, BandedFactor) or factor.half_bandwidth > WIDEST or not numba_is_there():
            return None
        rows, width = factor.order, padded_width(factor.half_bandwidth)
        K, C = (_in_order(matrix, rows) for matrix in (m.K, m.C))
        rank = np.empty_like(rows)
        rank[rows] = np.arange(len(rows))
        ahead = max(_half_bandwidth(matrix) for matrix in (K, C))
        damped = m.C is not None
        return cls(width, rank, rows, csr_parts(K), csr_parts(C), damped, factor.unit_rows(width), ahead)


def _in_order(matrix: sp.csr_array | None, rows: IntArray) -> sp.csr_array:
    if matrix is None:
        return sp.csr_array((len(rows), len(rows)))
    result = sp.csr_array(matrix[rows][:, rows])
    result.sort_indices()
    return result


def _half_bandwidth(matrix: sp.csr_array) -> int:
    entries = matrix.tocoo()
    return int(np.abs(entries.row.astype(np.int64) - entries.col).max(initial=0))


def csr_parts(matrix: sp.csr_array) -> Csr:
    """Row starts, columns and entries, unsigned: see the band kernel."""
    return matrix.indptr.astype(np.uint32), matrix.indices.astype(np.uint32), matrix.data.astype(np.float64)
