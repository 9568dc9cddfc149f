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
from axlespan.linalg.low_rank import UpdatedFactor

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Csr = tuple[npt.NDArray[np.uint32], npt.NDArray[np.uint32], FloatArray]

#: Entries of small rows that compiled loops read at a time.
PIECE = 8


@dataclass(frozen=True, eq=False)
class ModalDamping:
    """Damping of modes U diag(c) Uᵀ beside a band; modes are padded to pieces by some that are zero."""

    rows: IntArray  # (n_row,) in the order, where U is not zero
    U: FloatArray  # (n_row, m)
    coefficients: FloatArray  # c (m,)
    core: FloatArray  # G (m, m): see the kernel
    responses: FloatArray  # W (n, m) by d.o.f.

    @classmethod
    def of(cls, integrator: Integrator, factor: UpdatedFactor, rank: IntArray) -> ModalDamping:
        """That of an integrator, with its factor and the place of each d.o.f. in the order."""
        low_rank = integrator.matrices.C_low_rank
        assert low_rank is not None
        c = low_rank.coefficients
        U, W, core = factor.parts
        more = -U.shape[1] % PIECE
        dofs = np.flatnonzero(np.any(U != 0.0, axis=1))
        dofs = dofs[np.argsort(rank[dofs])]
        return cls(
            rank[dofs],
            _widened(U[dofs], more),
            np.pad(c[c > 0.0], (0, more)),
            np.ascontiguousarray(np.pad(core, (0, more))),
            _widened(W, more),
        )


def _widened(rows: FloatArray, more: int) -> FloatArray:
    """Rows (n, m), each in one piece, with so many zeros behind."""
    return np.ascontiguousarray(np.pad(rows, ((0, 0), (0, more))))


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
    modal: ModalDamping | None = None  # that the band does not hold

    @classmethod
    def of(cls, integrator: Integrator) -> BandedBody | None:
        """The body, or None if it is not of narrow band or loops cannot be compiled."""
        factor, m = integrator.factor, integrator.matrices
        updated = factor if isinstance(factor, UpdatedFactor) else None
        factor = factor if updated is None else updated.base
        if not isinstance(factor, BandedFactor) or factor.half_bandwidth > WIDEST or not numba_is_there():
            return None
        rows, width = factor.order, padded_width(factor.half_bandwidth)
        K, C = (_in_order(matrix, rows) for matrix in (m.K, m.C))
        rank = np.empty_like(rows)
        rank[rows] = np.arange(len(rows))
        ahead = max(_half_bandwidth(matrix) for matrix in (K, C))
        damped = m.C is not None
        modal = None if updated is None else ModalDamping.of(integrator, updated, rank)
        lower = factor.unit_rows(width)
        return cls(width, rank, rows, csr_parts(K), csr_parts(C), damped, lower, ahead, modal)


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
