"""What unit forces in some coordinates do to a structure at rest: columns of K⁻¹ Rᵀ, solved for when they are needed."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.linalg.factor import Factor

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


class StaticColumns:
    """The columns of those rows that have been taken in.

    Parameters
    ----------
    rows : csr_array (m, n)
        R of all coordinates.
    stiffness : Factor
        Of K (n, n).
    """

    def __init__(self, rows: sp.csr_array, stiffness: Factor) -> None:
        self._rows, self._stiffness = rows, stiffness
        self.chosen = np.empty(0, dtype=np.int64)  # rows that have been taken in, in that order
        self.values = np.zeros((rows.shape[1], 0))  # (n, n_chosen) [m/N]
        self._Z = np.zeros((0, 0))

    def take_in(self, rows: IntArray) -> None:
        """Solve for the columns of further rows (n_new,)."""
        if not len(rows):
            return
        new = self._stiffness.solve(np.ascontiguousarray(self._rows[rows].T.toarray()))
        self.chosen, self.values = np.append(self.chosen, rows), np.hstack([self.values, new])
        n, own = len(self.chosen), self._rows[self.chosen]
        Z = np.zeros((n, n))
        Z[:, n - len(rows) :] = own @ new
        Z[n - len(rows) :, : n - len(rows)] = Z[: n - len(rows), n - len(rows) :].T
        Z[: n - len(rows), : n - len(rows)] = self._Z
        self._Z = 0.5 * (Z + Z.T)

    def deflection(self, forces: FloatArray) -> FloatArray:
        """Displacements (n,) under forces (m,) that vanish but where rows have been taken in."""
        return np.asarray(self.values @ forces[self.chosen])

    def compliance(self, rows: IntArray) -> FloatArray:
        """R K⁻¹ Rᵀ (k, k) of some rows (k,), zero for those that have not been taken in."""
        place = np.full(self._rows.shape[0], -1, dtype=np.int64)
        place[self.chosen] = np.arange(len(self.chosen))
        there = np.flatnonzero(place[rows] >= 0)
        result, at = np.zeros((len(rows), len(rows))), place[rows[there]]
        result[np.ix_(there, there)] = self._Z[np.ix_(at, at)]
        return result
