r"""A path as piecewise polynomials: the displacement under a wheel in the structure's d.o.f.

At the position s along the path, inside segment e with ξ = (s - s_e) / h_e,

.. math:: u_Y(s) = \sum_j \Big( \sum_p c_{ejp} ξ^p \Big) u_{d(e, j)}

These weights are a row of N12's E (28), and D = Eᵀ: the load of a unit force at s. Every kind of
structure gives such a path, so contact, sensors and footprints need to know only this.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from math import comb
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.compiled import numba_is_there
from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Shares of three sleepers in an axle load (EN 1991-2 6.3.6.1; from memory).
SLEEPER_SHARES = (0.25, 0.5, 0.25)

# So many positions at a time are worth machine code: the first time, and where it is at hand.
_MANY, _SOME = 256, 8


@cache
def _loops() -> Any:
    """The compiled loops over positions, None without numba."""
    if not numba_is_there():
        return None
    from axlespan.running import path_kernel

    return path_kernel


def _loops_for(positions: int) -> Any:
    """The compiled loops where they pay for so many positions, else None."""
    at_hand = _loops.cache_info().currsize > 0
    return _loops() if positions >= (_SOME if at_hand else _MANY) else None


@dataclass(frozen=True, eq=False)
class PolynomialPath:
    """Weights of the d.o.f. along a path, one polynomial per segment and d.o.f."""

    breaks: FloatArray  # (n_segment + 1,) positions along the path [m]
    dofs: IntArray  # (n_segment, n_local); unused places repeat a d.o.f. with zero coefficients
    coefficients: FloatArray  # (n_segment, n_local, n_power), powers of ξ ascending

    def __post_init__(self) -> None:
        if np.any(np.diff(self.breaks) <= 0.0):
            raise InputError("must advance: its positions must increase", field="running line")

    @property
    def start(self) -> float:
        """Position of the first point [m]."""
        return float(self.breaks[0])

    @property
    def stop(self) -> float:
        """Position of the last point [m]."""
        return float(self.breaks[-1])

    @cached_property
    def path_dofs(self) -> IntArray:
        """The d.o.f. that take part anywhere on the path, sorted."""
        used = np.any(self.coefficients != 0.0, axis=2)
        return np.unique(self.dofs[used])

    @cached_property
    def _by_power(self) -> FloatArray:
        """Coefficients (n_power, n_segment, n_local), each power in one piece."""
        return np.ascontiguousarray(np.moveaxis(self.coefficients, 2, 0))

    @cached_property
    def _table(self) -> tuple[FloatArray, FloatArray, IntArray]:
        """Breaks, coefficients (n_segment, n_power, n_local) and d.o.f., as the compiled loops want them."""
        table = np.ascontiguousarray(np.moveaxis(self.coefficients, 2, 1))
        return np.asarray(self.breaks, float), table, np.ascontiguousarray(self.dofs, dtype=np.int64)

    @cached_property
    def _weighty(self) -> npt.NDArray[np.bool_]:
        """Which segments (n_segment,) have any weight."""
        return np.asarray(np.any(self.coefficients != 0.0, axis=(1, 2)))

    def carries(self, position: FloatArray) -> npt.NDArray[np.bool_]:
        """Whether positions [m] are on the path, ends included."""
        return np.asarray((position >= self.start) & (position <= self.stop))

    def locate(self, position: FloatArray) -> tuple[IntArray, FloatArray]:
        """Segment and ξ of positions on the path; a break belongs to the segment that begins there."""
        segment = np.clip(np.searchsorted(self.breaks, position, side="right") - 1, 0, len(self.breaks) - 2)
        begin = self.breaks[segment]
        return segment, (position - begin) / (self.breaks[segment + 1] - begin)

    def weights(self, position: FloatArray, derivative: int = 0) -> tuple[IntArray, FloatArray]:
        """D.o.f. and weights (..., n_local) at positions [m], or derivatives of the weights along s.

        Positions off the path get zero weights.
        """
        position = np.asarray(position, float)
        segment, xi = self.locate(position)
        n_power = self.coefficients.shape[-1]
        result = np.zeros((*segment.shape, self.coefficients.shape[1]))
        xi = xi[..., None]
        for power in range(n_power - 1, derivative - 1, -1):
            falling = float(np.prod(np.arange(power, power - derivative, -1))) if derivative else 1.0
            result *= xi
            result += falling * self._by_power[power].take(segment, axis=0)
        if derivative:
            result /= (np.diff(self.breaks)[segment] ** derivative)[..., None]
        result[~self.carries(position)] = 0.0
        return self.dofs[segment], result

    def dofs_between(self, low: FloatArray, high: FloatArray) -> IntArray:
        """D.o.f. with weights anywhere between positions low and high (n_range,) [m]."""
        on = (high >= self.start) & (low <= self.stop)
        first, last = (self.locate(np.clip(at[on], self.start, self.stop))[0] for at in (low, high))
        covered = np.zeros(len(self.dofs) + 1, dtype=np.int64)
        np.add.at(covered, first, 1)
        np.add.at(covered, last + 1, -1)
        there = np.cumsum(covered)[:-1] > 0
        return np.asarray(self.dofs[there][self._used[there]])

    @cached_property
    def _used(self) -> npt.NDArray[np.bool_]:
        """Which d.o.f. (n_segment, n_local) have any weight."""
        return np.asarray(np.any(self.coefficients != 0.0, axis=2))

    def fill_rows(
        self,
        positions: FloatArray,
        contacts: IntArray,
        slots: IntArray,
        dofs: IntArray,
        weights: FloatArray,
        derivative: int = 0,
        numbers: IntArray | None = None,
    ) -> None:
        """Write the weights of some contacts that stand on the path, or derivatives along s, into places that hold zeros.

        Parameters
        ----------
        positions : array (n_step, n_contact)
            Of all contacts [m].
        contacts, slots : array (n_wheel,)
            Which of them, and their places in the arrays to fill.
        dofs, weights : array (n_step, n_slot, at least n_local)
        numbers : array (n_segment, n_local), optional
            What is written in place of the d.o.f.
        """
        loops = None if derivative else _loops_for(positions.shape[0] * len(contacts))
        if loops is not None:
            breaks, table, own_dofs = self._table
            where = own_dofs if numbers is None else numbers
            loops.fill_rows(
                breaks, table, where, np.ascontiguousarray(positions), contacts, slots, dofs, weights
            )
            return
        own_dofs, own = self.weights(positions[:, contacts], derivative)
        if numbers is not None:
            own_dofs = numbers[self.locate(positions[:, contacts])[0]]
        dofs[:, slots, : own.shape[2]], weights[:, slots, : own.shape[2]] = own_dofs, own

    def loads(
        self,
        positions: FloatArray,
        forces: FloatArray,
        wheels: IntArray,
        n: int,
        shift: float = 0.0,
        *,
        one_way: bool = False,
    ) -> FloatArray:
        """Loads (n_step, n) on the d.o.f. of some wheels, from positions [m] and forces [N] (n_step, n_contact) of all.

        ``shift`` [m] is added to the positions. Wheels that run one way are left out where they never come by.
        """
        total = np.zeros((len(positions), n))
        if not n:  # a structure without supports has none of their d.o.f.
            return total
        if one_way and len(positions):
            ends = positions[[0, -1]][:, wheels] + shift
            wheels = wheels[(ends.max(axis=0) >= self.start) & (ends.min(axis=0) <= self.stop)]
        loops = _loops_for(positions.shape[0] * len(wheels))
        if loops is not None:
            arrays = (np.ascontiguousarray(positions), shift, np.ascontiguousarray(forces), wheels, total)
            loops.add_loads(*self._table, self._weighty, *arrays)
            return total
        at = positions[:, wheels] + shift
        step, wheel = np.nonzero(self.carries(at))
        dofs, weights = self.weights(at[step, wheel])
        shares = weights * forces[step, wheels[wheel]][:, None]
        np.add.at(total.reshape(-1), (step[:, None] * n + dofs).ravel(), shares.ravel())
        return total

    def rows(self, position: FloatArray, n: int, derivative: int = 0) -> sp.csr_array:
        """E (n_position, n) as a sparse matrix over n d.o.f."""
        dofs, values = self.weights(np.atleast_1d(np.asarray(position, float)), derivative)
        row = np.broadcast_to(np.arange(len(dofs))[:, None], dofs.shape)
        return sp.csr_array(sp.coo_array((values.ravel(), (row.ravel(), dofs.ravel())), shape=(len(dofs), n)))

    def transformed(self, elimination: sp.csr_array) -> PolynomialPath:
        """The same path in the d.o.f. q of u = elimination @ q; columns that vanish drop out."""
        n_segment, _, n_power = self.coefficients.shape
        stacked = _stack(self.dofs, self.coefficients, elimination.shape[0]) @ elimination
        return _unstack(self.breaks, sp.csr_array(stacked), n_segment, n_power)

    def renumbered(self, number: IntArray) -> PolynomialPath:
        """The same path with d.o.f. d called number[d]; negative numbers drop out."""
        new = number[self.dofs]
        coefficients = np.where((new >= 0)[..., None], self.coefficients, 0.0)
        return PolynomialPath(self.breaks, np.maximum(new, 0), coefficients)

    def moved_by(self, displacement: FloatArray) -> PolynomialPath:
        """The line that given displacements (n,) of the d.o.f. make, as the weights of a single d.o.f. 0."""
        line = np.einsum("ej,ejp->ep", displacement[self.dofs], self.coefficients)
        return PolynomialPath(self.breaks, np.zeros((len(line), 1), dtype=np.int64), line[:, None])

    def averaged(self, length: float) -> PolynomialPath:
        """The moving average over a length [m]: the weights of a footprint of uniform pressure.

        The ground before and after the path counts as weight zero. The result is again a piecewise
        polynomial, one power higher and one time more differentiable, from half a length before the
        path to half a length after it.
        """
        return _averaged(self, length)

    def spread(self, length: float) -> PolynomialPath:
        """The path under a footprint: a triangular pressure over a length [m], most in the middle.

        Two moving averages over half the length each; a path with kinks in slope becomes one with a
        continuous curvature.
        """
        if length not in self._spread:
            self._spread[length] = self.averaged(0.5 * length).averaged(0.5 * length)
        return self._spread[length]

    @cached_property
    def _spread(self) -> dict[float, PolynomialPath]:
        """Footprints that were asked for: crossings of one structure share them."""
        return {}

    def shared(self, spacing: float, shares: tuple[float, ...] = SLEEPER_SHARES) -> PolynomialPath:
        """The path under loads that are shared among points in a row, in the middle of which the wheel stands.

        With three shares of 25, 50 and 25 % this is an axle on three sleepers (EN 1991-2 6.3.6.1). The points move
        with the wheel: it always stands over one of them. Points before and after the path count as on the ground.

        Parameters
        ----------
        spacing : float
            Between the points [m].
        shares : tuple of float
            Of each point, an odd number of them that sum up to one.
        """
        half = len(shares) // 2
        offsets = spacing * (np.arange(len(shares)) - half)
        edges = np.unique(np.concatenate([self.breaks + offset for offset in offsets]))
        edges = edges[np.concatenate([[True], np.diff(edges) > 1e-9 * spacing])]
        middles, n_power = 0.5 * (edges[1:] + edges[:-1]), self.coefficients.shape[2]
        blocks, dofs = [], []
        for offset, share in zip(offsets, shares, strict=True):
            on = self.carries(middles + offset)
            segment, _ = self.locate(middles + offset)
            begin = self.breaks[segment]
            size = self.breaks[segment + 1] - begin
            a, b = (edges[:-1] + offset - begin) / size, np.diff(edges) / size
            turn = np.zeros((len(middles), n_power, n_power))
            for p in range(n_power):
                for q in range(p + 1):
                    turn[:, p, q] = comb(p, q) * a ** (p - q) * b**q
            turn[~on] = 0.0
            blocks.append(share * self.coefficients[segment] @ turn)
            dofs.append(self.dofs[segment])
        n = int(self.dofs.max()) + 1
        stacked = _stack(np.concatenate(dofs, axis=1), np.concatenate(blocks, axis=1), n)
        return _unstack(edges, stacked, len(middles), n_power)


def _stack(dofs: IntArray, coefficients: FloatArray, n: int) -> sp.csr_array:
    """Coefficients as a sparse matrix (n_segment · n_power, n)."""
    n_segment, _n_local, n_power = coefficients.shape
    row = np.arange(n_segment)[:, None, None] * n_power + np.arange(n_power)[None, None, :]
    row = np.broadcast_to(row, coefficients.shape)
    column = np.broadcast_to(dofs[:, :, None], coefficients.shape)
    matrix = sp.coo_array(
        (coefficients.ravel(), (row.ravel(), column.ravel())), shape=(n_segment * n_power, n)
    )
    return sp.csr_array(matrix)


def _unstack(breaks: FloatArray, stacked: sp.csr_array, n_segment: int, n_power: int) -> PolynomialPath:
    entries = stacked.tocoo()
    keep = entries.data != 0.0
    segment, power = np.divmod(entries.row[keep].astype(np.int64), n_power)
    column, value = entries.col[keep].astype(np.int64), entries.data[keep]
    n = stacked.shape[1]
    keys, inverse = np.unique(segment * n + column, return_inverse=True)
    inverse = inverse.reshape(-1)
    pairs = np.column_stack(np.divmod(keys, n))
    begin = np.searchsorted(pairs[:, 0], np.arange(n_segment))
    local = np.arange(len(pairs)) - begin[pairs[:, 0]] if len(pairs) else np.empty(0, dtype=np.int64)
    n_local = int(local.max(initial=0)) + 1
    fallback = int(pairs[0, 1]) if len(pairs) else 0
    dofs = np.full((n_segment, n_local), fallback, dtype=np.int64)
    coefficients = np.zeros((n_segment, n_local, n_power))
    if len(pairs):
        dofs[pairs[:, 0], local] = pairs[:, 1]
        np.add.at(coefficients, (segment, local[inverse], power), value)
    return PolynomialPath(breaks, dofs, coefficients)


def _averaged(path: PolynomialPath, length: float) -> PolynomialPath:
    half = 0.5 * length
    edges = np.unique(np.concatenate([path.breaks - half, path.breaks + half]))
    edges = edges[np.concatenate([[True], np.diff(edges) > 1e-9 * length])]
    size = np.diff(path.breaks)
    n_power = path.coefficients.shape[2]
    powers = np.arange(1, n_power + 1)
    # ∫ of a segment's weights from its begin to ξ, times 1 / length.
    primitive = np.zeros((*path.coefficients.shape[:2], n_power + 1))
    primitive[:, :, 1:] = path.coefficients / powers * (size / length)[:, None, None]
    whole = primitive.sum(axis=2)
    begins, steps = edges[:-1], np.diff(edges)
    middles = begins + 0.5 * steps
    # Segments under the moving window, whose ends lie in segments first and last; n_segment of them at most.
    first = np.searchsorted(path.breaks, middles - half, side="right") - 1
    last = np.searchsorted(path.breaks, middles + half, side="right") - 1
    low, high = np.maximum(first, 0), np.minimum(last, len(size) - 1)
    n_local, n_edge = path.dofs.shape[1], len(middles)
    under = low[:, None] + np.arange(int((high - low).max(initial=0)) + 1)
    there = under <= high[:, None]
    under = np.minimum(under, len(size) - 1)
    terms = np.zeros((*under.shape, n_local, n_power + 1))
    terms[..., 0] = np.where(under == last[:, None], 0.0, 1.0)[..., None] * whole[under]
    for ends, sign in ((last, 1.0), (first, -1.0)):
        row, column = np.nonzero((under == ends[:, None]) & there)
        segment = under[row, column]
        offset = begins[row] + sign * half - path.breaks[segment]
        terms[row, column] += sign * _substituted(primitive[segment], offset, steps[row], size[segment])
    terms[~there] = 0.0
    all_dofs = np.where(there[..., None], path.dofs[under], path.dofs[low][:, None])
    n = int(path.dofs.max()) + 1
    stacked = _stack(all_dofs.reshape(n_edge, -1), terms.reshape(n_edge, -1, n_power + 1), n)
    return _unstack(edges, stacked, n_edge, n_power + 1)


def _substituted(
    coefficients: FloatArray, offset: FloatArray, step: FloatArray, size: FloatArray
) -> FloatArray:
    """Polynomials (m, n_local, n_power) in ξ = (offset + step · η) / size, rewritten in powers of η."""
    a, b = offset / size, step / size
    n = coefficients.shape[-1]
    turn = np.zeros((len(a), n, n))
    for p in range(n):
        for q in range(p + 1):
            turn[:, p, q] = comb(p, q) * a ** (p - q) * b**q
    return np.asarray(coefficients @ turn)
