"""Columns of A⁻¹ at the d.o.f. under the wheels: computed once, kept while the train is there.

The effective matrix A of the structure is constant, and a row of E only interpolates between the d.o.f. along
the path. So the columns of A⁻¹ for these d.o.f. give the structure's compliance under all wheels at every
step; N12's (A.5) leaves the time loop.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.linalg.blas import daxpy

from axlespan.dynamics.integrator import Integrator

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Up to this many entries, a product with all columns is quicker than one with a selection.
_WHOLE_PRODUCT_UP_TO = 100_000

# Columns that no wheel needs any more are dropped when they are more than this share of those held.
_IDLE_SHARE = 0.5


class PathColumns:
    """The columns of one structure and time step.

    Parameters
    ----------
    integrator : Integrator
        Of the structure.
    path_dofs : array (n_path,)
        D.o.f. that running lines use, sorted.

    Notes
    -----
    ``held`` are the d.o.f. whose columns are at hand. Where a second solve costs less than the product with
    whole columns (narrow bands), only their entries on the path are kept.
    """

    def __init__(self, integrator: Integrator, path_dofs: IntArray) -> None:
        self.integrator, self.path_dofs = integrator, path_dofs
        self.held = np.empty(0, dtype=np.int64)
        self.position = np.zeros(integrator.size, dtype=np.int64)  # d.o.f. -> place among the held ones
        self._on_path = np.zeros(integrator.size, dtype=np.int64)
        self._on_path[path_dofs] = np.arange(len(path_dofs))
        self._columns = np.empty((0, integrator.size))
        self.compliance = np.empty((0, 0))  # (1+α) β Δt² R A⁻¹ Rᵀ of the held d.o.f. [m/N]
        self.solves_again: bool | None = None  # decided with the first wheels

    @property
    def nbytes(self) -> int:
        """Memory of the columns held [byte]."""
        return int(self._columns.nbytes + self.compliance.nbytes)

    def hold(self, dofs: IntArray) -> None:
        """Have the columns of some d.o.f. of the path at hand; drop others that are idle."""
        needed = np.unique(dofs)
        if self.solves_again is None and len(needed):
            self.solves_again = self._second_solve_pays(len(needed))
            self._columns = np.empty((0, len(self.path_dofs) if self.solves_again else self.integrator.size))
        missing = np.setdiff1d(needed, self.held, assume_unique=True)
        idle = len(self.held) + len(missing) - len(needed)
        if not len(missing) and idle <= _IDLE_SHARE * len(self.held):
            return
        keep = (
            np.isin(self.held, needed)
            if idle > _IDLE_SHARE * max(len(needed), 1)
            else np.ones(len(self.held), bool)
        )
        held = np.concatenate([self.held[keep], missing])
        order = np.argsort(held)
        self._columns = np.concatenate([self._columns[keep], self._new(missing)])[order]
        self.held = held[order]
        self.position[:] = 0
        self.position[self.held] = np.arange(len(self.held))
        where = self._on_path[self.held] if self.solves_again else self.held
        scale = self.integrator.weight_c * self.integrator.u_from_a
        block = scale * self._columns[:, where]
        self.compliance = 0.5 * (block + block.T)

    def _second_solve_pays(self, n_active: int) -> bool:
        """Compare the memory traffic of a solve with that of a product with the columns under the wheels."""
        n = self.integrator.size
        return n * n_active > _WHOLE_PRODUCT_UP_TO and 8 * n * n_active > 2 * self.integrator.factor.nbytes

    def _new(self, dofs: IntArray) -> FloatArray:
        if not len(dofs):
            return np.empty((0, self._columns.shape[1]))
        if not self.solves_again:
            return self.integrator.columns(dofs)
        parts = [
            self.integrator.columns(dofs[i : i + 256])[:, self.path_dofs] for i in range(0, len(dofs), 256)
        ]
        return np.concatenate(parts)

    def response(self, load: FloatArray) -> FloatArray:
        """Acceleration (n,) or (n, k) of the structure under loads (n_held,) or (n_held, k), downward: -(1+α) A⁻¹ Rᵀ load."""
        weight = -self.integrator.weight_c
        if self.solves_again:
            force = np.zeros((self.integrator.size, *load.shape[1:]))
            force[self.held] = weight * load
            return self.integrator.factor.solve(force, out=force)
        if load.ndim > 1 or self._columns.size <= _WHOLE_PRODUCT_UP_TO:
            return np.asarray(self._columns.T @ (weight * load))
        result = np.zeros(self.integrator.size)
        for i in np.flatnonzero(load).tolist():
            daxpy(self._columns[i], result, a=weight * load[i])
        return result
