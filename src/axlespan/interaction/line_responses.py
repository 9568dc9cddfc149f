"""Responses F⁻¹ Eᵀ of a structure to loads under the wheels of several crossings, solved for side by side."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.linalg.factor import Factor

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Right-hand sides solved for together, and solutions that are kept whole, take so much memory at most [byte].
_AT_ONCE, _KEPT = 64e6, 128e6
# Up to so many entries a dense matrix of rows is quicker than a sparse one.
_DENSE_UP_TO = 200_000


class LineResponses:
    """The responses to loads on the rows of several crossings.

    Parameters
    ----------
    factor : Factor
        Of the structure's K or M (n, n).
    lanes : sequence of (dofs, weights)
        Rows (m, n_local) of each crossing: d.o.f. and weights.

    Notes
    -----
    Crossings of one structure load the same d.o.f. of its lines: there are as many systems to solve as d.o.f., or as
    wheels, whichever are fewer. Whole solutions are kept if there is room; else only what the lines see of them.
    """

    def __init__(self, factor: Factor, lanes: Sequence[tuple[IntArray, FloatArray]]) -> None:
        self._factor, self._n = factor, factor.n
        self._ends = np.cumsum([0, *(len(dofs) for dofs, _ in lanes)])
        used = [dofs[weights != 0.0] for dofs, weights in lanes]
        self._dofs = np.unique(np.concatenate([*used, np.empty(0, dtype=np.int64)]))
        # Rows over the d.o.f. used; places with zero weight may name others.
        self._rows = [self._over_used(dofs, weights) for dofs, weights in lanes]
        self._by_wheel = self._ends[-1] <= len(self._dofs)
        loads = self._loads()
        count = loads.shape[1]
        self._whole = np.empty((self._n, count)) if 8 * self._n * count <= _KEPT else None
        self._seen = np.empty((len(self._dofs), count))
        for some in _pieces(count, self._n):
            solved = _dense(loads[:, some])
            factor.solve(solved, out=solved)
            self._seen[:, some] = solved[self._dofs]
            if self._whole is not None and solved.shape == self._whole.shape:
                self._whole = solved
            elif self._whole is not None:
                self._whole[:, some] = solved

    def _over_used(self, dofs: IntArray, weights: FloatArray) -> FloatArray | sp.csr_array:
        shape = (len(dofs), len(self._dofs))
        at = np.minimum(np.searchsorted(self._dofs, dofs), max(shape[1] - 1, 0))
        if shape[0] * shape[1] <= _DENSE_UP_TO:
            rows = np.zeros(shape)
            if rows.size:
                np.add.at(rows, (np.arange(len(dofs))[:, None], at), weights)
            return rows
        ends = np.arange(0, dofs.size + 1, dofs.shape[1])
        matrix = sp.csr_array((weights.flatten(), at.flatten(), ends), shape=shape)
        matrix.sum_duplicates()
        return matrix

    def _loads(self) -> sp.csc_array:
        """The loads (n, count) to solve for: Eᵀ of all crossings, or a unit load on each d.o.f."""
        place = sp.csc_array(
            (np.ones(len(self._dofs)), self._dofs, np.arange(len(self._dofs) + 1)),
            shape=(self._n, len(self._dofs)),
        )
        if not self._by_wheel:
            return place
        rows = sp.vstack([sp.csr_array(rows) for rows in self._rows], format="csr")
        return sp.csc_array(place @ rows.T)

    def between(self, lane: int) -> FloatArray:
        """E F⁻¹ Eᵀ (m, m) of one crossing."""
        rows = self._rows[lane]
        seen = self._seen[:, self._own(lane)] if self._by_wheel else self._seen @ rows.T
        result = np.asarray(rows @ seen)
        return np.asarray(0.5 * (result + result.T))

    def _own(self, lane: int) -> slice:
        return slice(int(self._ends[lane]), int(self._ends[lane + 1]))

    def under(self, forces: Sequence[FloatArray]) -> FloatArray:
        """F⁻¹ Eᵀ X (n, n_lane) of forces (m,) of each crossing."""
        shape = (self._seen.shape[1], len(forces))
        amounts = np.zeros(shape)
        for lane, own in enumerate(forces):
            if self._by_wheel:
                amounts[self._own(lane), lane] = own
            else:
                amounts[:, lane] = self._rows[lane].T @ own
        if self._whole is not None:
            return np.asarray(self._whole @ amounts)
        loads = self._loads()
        result = np.empty((self._n, len(forces)))
        for some in _pieces(len(forces), self._n):
            result[:, some] = self._factor.solve(np.ascontiguousarray(loads @ amounts[:, some]))
        return result


def _dense(columns: sp.csc_array) -> FloatArray:
    return np.asarray(columns.toarray(order="C"))


def _pieces(count: int, n: int) -> list[slice]:
    """So many right-hand sides (n,) in pieces that memory allows."""
    at_once = max(int(_AT_ONCE / (8 * max(n, 1))), 8)
    return [slice(begin, min(begin + at_once, count)) for begin in range(0, count, at_once)]


def side_by_side(factor: Factor, loads: Sequence[FloatArray]) -> list[FloatArray]:
    """Solve for several loads (n,), as many at once as memory allows."""
    result: list[FloatArray] = []
    for some in _pieces(len(loads), factor.n):
        if some.stop - some.start == 1:
            result.append(factor.solve(np.ascontiguousarray(loads[some.start])))
            continue
        solved = factor.solve(np.ascontiguousarray(np.column_stack(loads[some])))
        result += list(np.ascontiguousarray(solved.T))
    return result
