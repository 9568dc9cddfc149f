r"""A path as piecewise polynomials: the displacement under a wheel in the structure's d.o.f.

At the position s along the path, inside segment e with ξ = (s - s_e) / h_e,

.. math:: u_Y(s) = \sum_j \Big( \sum_p c_{ejp} ξ^p \Big) u_{d(e, j)}

These weights are a row of N12's E (28), and D = Eᵀ: the load of a unit force at s. Every kind of
structure gives such a path, so contact, sensors and footprints need to know only this.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import comb

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


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
        coefficients = self.coefficients[segment]
        n_power = coefficients.shape[-1]
        result = np.zeros(coefficients.shape[:-1])
        for power in range(n_power - 1, derivative - 1, -1):
            falling = float(np.prod(np.arange(power, power - derivative, -1))) if derivative else 1.0
            result = result * xi[..., None] + falling * coefficients[..., power]
        if derivative:
            result /= (np.diff(self.breaks)[segment] ** derivative)[..., None]
        result[~self.carries(position)] = 0.0
        return self.dofs[segment], result

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
        continuous curvature. A sleeper spacing to either side is how a rail spreads an axle load
        (EN 1991-2 6.3.6.1: 25/50/25 % over three sleepers).
        """
        return self.averaged(0.5 * length).averaged(0.5 * length)


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
    pairs, inverse = np.unique(np.column_stack([segment, column]), axis=0, return_inverse=True)
    inverse = inverse.reshape(-1)
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
    middles = 0.5 * (edges[1:] + edges[:-1])
    rows: list[tuple[IntArray, FloatArray]] = []
    for begin, end, middle in zip(edges[:-1], edges[1:], middles, strict=True):
        first = int(np.searchsorted(path.breaks, middle - half, side="right")) - 1
        last = int(np.searchsorted(path.breaks, middle + half, side="right")) - 1
        dofs, terms = [], []
        for e in range(max(first, 0), min(last, len(size) - 1) + 1):
            term = np.zeros((path.dofs.shape[1], n_power + 1))
            if e == last:
                term += _substituted(primitive[e], begin + half - path.breaks[e], end - begin, size[e])
            else:
                term[:, 0] += whole[e]
            if e == first:
                term -= _substituted(primitive[e], begin - half - path.breaks[e], end - begin, size[e])
            dofs.append(path.dofs[e])
            terms.append(term)
        rows.append((np.concatenate(dofs), np.concatenate(terms)))
    n_local = max(len(dofs) for dofs, _ in rows)
    all_dofs = np.full((len(rows), n_local), rows[0][0][0], dtype=np.int64)
    coefficients = np.zeros((len(rows), n_local, n_power + 1))
    for i, (own, polynomials) in enumerate(rows):
        all_dofs[i, : len(own)] = own
        coefficients[i, : len(own)] = polynomials
    n = int(path.dofs.max()) + 1
    return _unstack(edges, _stack(all_dofs, coefficients, n), len(rows), n_power + 1)


def _substituted(coefficients: FloatArray, offset: float, step: float, size: float) -> FloatArray:
    """Polynomials in ξ = (offset + step · η) / size, rewritten in powers of η."""
    a, b = offset / size, step / size
    n = coefficients.shape[1]
    turn = np.zeros((n, n))
    for p in range(n):
        for q in range(p + 1):
            turn[p, q] = comb(p, q) * a ** (p - q) * b**q
    return np.asarray(coefficients @ turn)
