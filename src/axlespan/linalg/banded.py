"""Cholesky factors of narrow bands: beams and track, whose d.o.f. follow one another along a line."""

from __future__ import annotations

from dataclasses import dataclass
from operator import itemgetter
from typing import Any, NoReturn

import numpy as np
import numpy.typing as npt
from scipy.linalg.lapack import dpbtrf, dpbtrs, dtbtrs
from scipy.sparse.csgraph import reverse_cuthill_mckee

from axlespan.linalg.arrays import CsrMatrix, FloatArray, IntArray, right_hand_side
from axlespan.linalg.band_blocks import NARROWEST, BandBlocks
from axlespan.linalg.band_kernel import (
    WIDEST,
    compiled_single,
    compiled_solver,
    padded_width,
    scaled_rows,
)
from axlespan.linalg.definiteness import PivotBreakdown
from axlespan.linalg.protocol import refuse_pickling

# Half-bandwidth times right-hand sides from which blocks pay.
_BLOCKS_PAY = 1600

# Parts that are eliminated one after the other, at most; a diagonal matrix has as many as rows.
_PARTS = 64


@dataclass(frozen=True, eq=False)
class BandOrder:
    """An order of elimination and the half-bandwidth that it leaves.

    Parameters
    ----------
    half_bandwidth : int
        Largest distance of a stored entry from the diagonal.
    rows : ndarray of int, shape (n,), or None
        ``rows[i]`` is eliminated as number i; None keeps the given order.
    """

    half_bandwidth: int
    rows: IntArray | None

    @classmethod
    def of(cls, matrix: CsrMatrix) -> BandOrder:
        """Return the narrowest of three orders, the first of equals.

        They are the given one; the given one part by part, where no entry connects parts with one another, as those of
        each direction in a mass matrix; and the reverse Cuthill-McKee order.
        """
        reordered = np.asarray(reverse_cuthill_mckee(matrix, symmetric_mode=True), dtype=np.intp)
        narrow, part = _reach(matrix, reordered)
        orders: list[tuple[int, IntArray | None]] = [(_spread(matrix, None), None)]
        if 0 < part.max(initial=0) < _PARTS:
            by_part = np.argsort(part, kind="stable").astype(np.intp)
            orders.append((_spread(matrix, by_part), by_part))
        return cls(*min([*orders, (narrow, reordered)], key=itemgetter(0)))

    def on(self, matrix: CsrMatrix) -> BandOrder:
        """The same order for another matrix."""
        return BandOrder(_spread(matrix, self.rows), self.rows)


class BandedFactor:
    """Cholesky factor in LAPACK's band storage.

    With numba, one right-hand side of a narrow band and several at once are solved by compiled loops (n = 5436,
    half-bandwidth 13: 50 µs for one and 18 µs each for 48, where LAPACK takes 160 µs). Several at once of a wide band
    are solved block by block (n = 36 597, half-bandwidth 401: 14 ms for one, 7.5, 3.4 and 2.1 ms each for 8, 32 and 64);
    all else by LAPACK.

    Parameters
    ----------
    matrix : csr_array, shape (n, n)
        Symmetric matrix in canonical form.
    order : BandOrder, optional
        The order of elimination; :meth:`BandOrder.of` the matrix when left out.

    Raises
    ------
    PivotBreakdown
        When a pivot is not positive.
    """

    name = "banded"

    def __init__(self, matrix: CsrMatrix, order: BandOrder | None = None) -> None:
        order = order or BandOrder.of(matrix)
        self.n: int = matrix.shape[0]
        self.half_bandwidth = order.half_bandwidth
        self.band_order = order
        self._rows = order.rows
        self._rank = None if order.rows is None else _inverse(order.rows)
        self._lower, info = dpbtrf(_band(matrix, self._rank, self.half_bandwidth), lower=1, overwrite_ab=1)
        if info > 0:
            raise PivotBreakdown(f"pivot {info} of {self.n} is not positive")
        self._order = np.arange(self.n, dtype=np.intp) if self._rows is None else self._rows
        self._single = self._scaled = None
        width = padded_width(self.half_bandwidth)
        if self.half_bandwidth <= WIDEST and self.n > width:
            self._single = compiled_single(width)
        if self._single is not None:
            self._scaled = scaled_rows(self._lower.T, width)

    @property
    def order(self) -> IntArray:
        """The rows (n,) as they are eliminated, one after the other."""
        return self._order.astype(np.int64)

    def unit_rows(self, width: int) -> FloatArray:
        """Rows (n + width, width + 1) of A = L D Lᵀ: 1 / D, then entry (i, i - d) of L at [i, d]; zeros at the end."""
        result = np.zeros((self.n + width, width + 1))
        diagonal = self._lower[0]
        result[: self.n, 0] = 1.0 / diagonal**2
        for d in range(1, min(self.half_bandwidth + 1, self.n)):
            result[d : self.n, d] = self._lower[d, : self.n - d] / diagonal[: self.n - d]
        return result

    @property
    def nbytes(self) -> int:
        """Memory of the factor that a solve reads [byte]."""
        if self._scaled is not None:
            return sum(rows.nbytes for rows in self._scaled)
        return int(self._lower.nbytes)

    def solve(self, b: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Solve A x = b; see :meth:`axlespan.linalg.Factor.solve`."""
        out = right_hand_side(b, self.n, out)
        if b.size == 0:
            return out
        if b.ndim == 1 and self._single is not None and self._scaled is not None:
            width = self._scaled[0].shape[1] - 1
            work = np.empty(self.n + 2 * width)
            work[:width] = work[-width:] = 0.0
            self._single(*self._scaled, self._order, b, out, work)
            return out
        if self._blocks_are_faster(b):
            if self._rows is not None:
                x = b.take(self._rows, axis=0)
                BandBlocks(self._lower).solve(x)
                return self._scatter(x, out)
            if out is not b:
                np.copyto(out, b)
            BandBlocks(self._lower).solve(out)
            return out
        if self._loop_is_faster(b) and (solver := compiled_solver()) is not None:
            if out is not b:
                np.copyto(out, b)
            solver(self._lower.T, self._order, out)
            return out
        return self._scatter(dpbtrs(self._lower, self._gather(b), lower=1, overwrite_b=1)[0], out)

    def _blocks_are_faster(self, b: FloatArray) -> bool:
        """Whether products of blocks beat LAPACK and the loop: measured for half-bandwidths of 133 to 800."""
        count = 1 if b.ndim == 1 else b.shape[1]
        return count > 1 and self.half_bandwidth >= NARROWEST and self.half_bandwidth * count >= _BLOCKS_PAY

    def _loop_is_faster(self, b: FloatArray) -> bool:
        """Whether the compiled loop beats LAPACK: measured for half-bandwidths of 8 to 400."""
        count = 1 if b.ndim == 1 else b.shape[1]
        return count > 1 and (self.half_bandwidth <= 5 * count or count >= 16)

    def forward(self, b: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Solve C y = b; see :class:`axlespan.linalg.SplitFactor`."""
        out = right_hand_side(b, self.n, out)
        if b.size == 0:
            return out
        y = dtbtrs(self._lower, self._gather(b), uplo="L", trans="N", overwrite_b=1)[0]
        np.copyto(out, y)  # stays in the factor's order
        return out

    def backward(self, b: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Solve Cᵀ x = b; see :class:`axlespan.linalg.SplitFactor`."""
        out = right_hand_side(b, self.n, out)
        if b.size == 0:
            return out
        x = dtbtrs(self._lower, b.copy(order="F"), uplo="L", trans="T", overwrite_b=1)[0]
        return self._scatter(x, out)

    def _gather(self, b: FloatArray) -> FloatArray:
        """A copy of the right-hand sides in the order of elimination, columns contiguous for LAPACK."""
        if b.ndim == 1:
            return b.copy() if self._rows is None else b.take(self._rows)
        return b.copy(order="F") if self._rows is None else b.T.take(self._rows, axis=1).T

    def _scatter(self, x: FloatArray, out: FloatArray) -> FloatArray:
        if self._rank is None:
            np.copyto(out, x)
        else:
            x.take(self._rank, axis=0, out=out, mode="clip")  # "clip" writes to out without a buffer
        return out

    def __reduce__(self) -> NoReturn:
        refuse_pickling(self.name)


def _spread(matrix: CsrMatrix, rows: IntArray | None) -> int:
    """Largest distance between row and column of an entry in an order of elimination; the matrix is symmetric."""
    filled = np.flatnonzero(np.diff(matrix.indptr))
    if not len(filled):
        return 0
    begins = matrix.indptr[filled]
    if rows is None:  # columns are sorted
        return max(int((filled - matrix.indices[begins]).max()), 0)
    rank = _inverse(rows).astype(np.int32)
    return max(int((rank[filled] - np.minimum.reduceat(rank.take(matrix.indices), begins)).max()), 0)


def _reach(matrix: CsrMatrix, rows: IntArray) -> tuple[int, IntArray]:
    """The same for reverse Cuthill-McKee's order, with the part (n,) of each row: one after the other in this order."""
    n, filled = matrix.shape[0], np.flatnonzero(np.diff(matrix.indptr))
    rank = _inverse(rows).astype(np.int32)
    last = np.arange(
        n, dtype=np.int32
    )  # in the order of elimination, the farthest row that each is connected with
    if len(filled):
        own = rank[filled]
        last[own] = np.maximum(own, np.maximum.reduceat(rank.take(matrix.indices), matrix.indptr[filled]))
    ends = np.maximum.accumulate(last) == np.arange(n)
    part = np.empty(n, dtype=np.intp)
    part[rows] = np.cumsum(ends) - ends
    return int((last - np.arange(n)).max(initial=0)), part


def _inverse(rows: IntArray) -> IntArray:
    rank = np.empty_like(rows)
    rank[rows] = np.arange(rows.size)
    return rank


def _band(matrix: CsrMatrix, rank: IntArray | None, half_bandwidth: int) -> FloatArray:
    """Lower band storage: entry (i, j) of the reordered matrix stands at [i − j, j]."""
    n, size = matrix.shape[0], matrix.shape[0] * (half_bandwidth + 1)
    # Short numbers, where they do, take less time to pass through.
    kind: npt.DTypeLike = np.int32 if size <= np.iinfo(np.int32).max else np.intp
    rows: npt.NDArray[Any] = (np.arange(n) if rank is None else rank).astype(kind)
    column: npt.NDArray[Any] = (
        matrix.indices.astype(kind, copy=False) if rank is None else rows.take(matrix.indices)
    )
    row = np.repeat(rows, np.diff(matrix.indptr))
    lower = row >= column
    # In memory column after column, so at (i - j) + j (half_bandwidth + 1).
    place = column * half_bandwidth
    place += row
    band = np.zeros(size)
    band[place[lower]] = matrix.data[lower]
    return band.reshape(n, half_bandwidth + 1).T
