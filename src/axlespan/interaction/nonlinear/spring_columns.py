r"""What a unit force of a spring does to the structure in a step: columns of A⁻¹ Bᵀ, solved for when they are needed.

Of a column the entries at d.o.f. of springs and of the path are kept: they give the compliance between springs,
B_i (A⁻¹ B_jᵀ), and between a wheel and a spring, E (A⁻¹ B_jᵀ).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.dynamics.integrator import Integrator

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Springs next to one another that are solved for together: where one deviates, its neighbors soon will.
_BLOCK = 32


class SpringColumns:
    """The columns of one structure and time step.

    Parameters
    ----------
    integrator : Integrator
        Of the structure.
    rows : csr_array (n_spring, n)
        B of the springs.
    path_dofs : array (n_path,)
        D.o.f. under running lines.
    """

    def __init__(self, integrator: Integrator, rows: sp.csr_array, path_dofs: IntArray) -> None:
        self._integrator, self._rows = integrator, rows
        self._dofs = np.union1d(path_dofs, rows.indices).astype(np.int64)
        self.place = np.zeros(integrator.size, dtype=np.int64)  # d.o.f. -> place in a column
        self.place[self._dofs] = np.arange(len(self._dofs))
        # Rows of B, filled up with zeros: d.o.f. and weights (n_spring, n_local), places in a column.
        self.dofs, self.weights = padded(rows)
        self.at = self.place[self.dofs]
        # (1+α) β Δt² A⁻¹ Bᵀ [m/N], column after column, and which of them is that of a spring: -1 while it is not there.
        self.values = np.zeros((0, len(self._dofs)))
        self.slot = np.full(rows.shape[0], -1, dtype=np.int64)
        self._used = 0

    def need(self, springs: IntArray) -> None:
        """Have the columns of some springs at hand."""
        missing = springs[self.slot[springs] < 0]
        for block in np.unique(missing // _BLOCK).tolist():
            self._solve(slice(block * _BLOCK, min((block + 1) * _BLOCK, len(self.slot))))

    def _solve(self, some: slice) -> None:
        integrator = self._integrator
        loads = np.zeros((integrator.size, some.stop - some.start))
        entries = self._rows[some].tocoo()
        loads[entries.col, entries.row] = integrator.weight_c * integrator.u_from_a * entries.data
        into = slice(self._used, self._used + loads.shape[1])
        if into.stop > len(self.values):
            more = np.zeros((max(into.stop, 2 * len(self.values)), len(self._dofs)))
            more[: self._used] = self.values[: self._used]
            self.values = more
        self.values[into] = integrator.factor.solve(loads, out=loads)[self._dofs].T
        self.slot[some] = np.arange(into.start, into.stop)
        self._used = into.stop

    def between(self, springs: IntArray) -> FloatArray:
        """Compliance (n, n) between some springs, symmetric [m/N]."""
        self.need(springs)
        chosen = self.values[self.slot[springs][:, None, None], self.at[springs]]  # (n, n, n_local)
        half = np.einsum("ijk,jk->ij", chosen, self.weights[springs])
        return np.asarray(0.5 * (half + half.T))

    def under(self, dofs: IntArray, weights: FloatArray, springs: IntArray) -> FloatArray:
        """Compliance (n_wheel, n) between wheels with rows (n_wheel, n_local) of d.o.f. and some springs [m/N]."""
        self.need(springs)
        chosen = self.values[self.slot[springs][:, None, None], self.place[dofs]]  # (n, n_wheel, n_local)
        return np.asarray(np.einsum("ijk,jk->ji", chosen, weights))


def padded(rows: sp.csr_array) -> tuple[IntArray, FloatArray]:
    """Columns and entries (n, m) of sparse rows, those with fewer than m filled up with zeros."""
    count = np.diff(rows.indptr)
    m = int(count.max(initial=0))
    into = np.arange(m) < count[:, None]
    columns, entries = np.zeros((rows.shape[0], m), dtype=np.int64), np.zeros((rows.shape[0], m))
    columns[into], entries[into] = rows.indices, rows.data
    return columns, entries
