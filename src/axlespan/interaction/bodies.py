"""The two bodies in time: the structure with its path columns, and the fleet of vehicles.

Both advance without contact (``predict``) and take the contact forces afterwards (``correct``). What the
contact system needs of them is their compliance at the wheels, which comes from a few columns of A⁻¹,
computed once.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.dynamics.alpha import Alpha
from axlespan.dynamics.integrator import Integrator, Matrices, State
from axlespan.interaction.plan import Fleet

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Up to this many entries, products with all path columns are quicker than with a selection.
_WHOLE_PRODUCT_UP_TO = 100_000


class StructureBody:
    """The structure in time, loaded along its path.

    Parameters
    ----------
    matrices, method, time_step, solver
        As for :class:`~axlespan.dynamics.integrator.Integrator`.
    path_dofs : array (n_path,)
        D.o.f. that the running lines use; their columns of A⁻¹ are computed here.
    """

    def __init__(
        self,
        matrices: Matrices,
        method: Alpha,
        time_step: float,
        path_dofs: IntArray,
        *,
        solver: str = "auto",
    ) -> None:
        self.integrator = Integrator(matrices, method, time_step, solver=solver)
        self.path_dofs = path_dofs
        n, n_path = matrices.size, len(path_dofs)
        self.local = np.full(n, 0, dtype=np.int64)  # d.o.f. -> position on the path
        self.local[path_dofs] = np.arange(n_path)
        self.columns = self._path_columns(n, n_path)
        scale = self.integrator.weight_c * self.integrator.u_from_a
        # Displacement of path d.o.f. per contact force on path d.o.f.: (1+α) β Δt² R A⁻¹ Rᵀ.
        self.compliance = scale * self.columns[:, path_dofs]
        self.compliance = 0.5 * (self.compliance + self.compliance.T)
        self.state = State.at_rest((n,))
        self.path_load = np.zeros(n_path)  # Eᵀ X of the step before
        self._force = np.zeros(n)

    def _path_columns(self, n: int, n_path: int) -> FloatArray:
        """A⁻¹ Rᵀ, transposed (n_path, n) so that a column lies in one piece."""
        result = np.empty((n_path, n))
        for begin in range(0, n_path, 64):
            dofs = self.path_dofs[begin : begin + 64]
            loads = np.zeros((n, len(dofs)))
            loads[dofs, np.arange(len(dofs))] = 1.0
            result[begin : begin + len(dofs)] = self.integrator.factor.solve(loads).T
        return result

    def path_force(self, local: IntArray, weights: FloatArray, forces: FloatArray) -> FloatArray:
        """Eᵀ X (n_path,) for wheels with rows (n_wheel, n_local) and forces (n_wheel,)."""
        loads = (weights * forces[:, None]).ravel()
        return np.asarray(np.bincount(local.ravel(), loads, minlength=len(self.path_dofs)), dtype=np.float64)

    def predict(self, external: FloatArray, known_load: FloatArray | None = None) -> None:
        """Advance under the external force (n,) already weighted, the contact of the step before, and known wheel loads."""
        force = self._force
        force[:] = external
        weight_c, weight_p = self.integrator.weight_c, self.integrator.weight_p
        if weight_p:
            force[self.path_dofs] -= weight_p * self.path_load
        if known_load is not None:
            force[self.path_dofs] -= weight_c * known_load
        self.integrator.predict(self.state, force)

    def under(self, dofs: IntArray, weights: FloatArray) -> FloatArray:
        """Displacement E u (n_wheel,) for rows (n_wheel, n_local)."""
        return np.asarray((self.state.u.take(dofs) * weights).sum(axis=1))

    def correct(self, load: FloatArray) -> None:
        """Take the contact load Eᵀ X (n_path,) of the coupled wheels at the new time."""
        self.integrator.correct(self.state, self._response(load))

    def _response(self, load: FloatArray) -> FloatArray:
        weight = -self.integrator.weight_c
        if self.columns.size <= _WHOLE_PRODUCT_UP_TO:
            return (weight * load) @ self.columns
        active = np.flatnonzero(load)
        return (weight * load[active]) @ self.columns[active]


class FleetBody:
    """All vehicles of a train in time; displacements from the static position on level ground."""

    def __init__(self, fleet: Fleet, method: Alpha, time_step: float, *, solver: str = "auto") -> None:
        self.fleet = fleet
        self.integrator = Integrator(fleet.matrices, method, time_step, solver=solver)
        n, n_coupled = fleet.matrices.size, len(fleet.dofs)
        loads = np.zeros((n, n_coupled))
        loads[fleet.dofs, np.arange(n_coupled)] = 1.0
        columns = self.integrator.columns(loads)
        scale = self.integrator.weight_c * self.integrator.u_from_a
        self.compliance = _same_vehicle(scale * columns[fleet.dofs], fleet.vehicle_of)
        self.stiffness = _block_inverse(self.compliance, fleet.vehicle_of)
        weighted = self.integrator.weight_c * columns
        self._columns = weighted if weighted.size <= _WHOLE_PRODUCT_UP_TO else sp.csr_array(_pruned(weighted))
        self.state = State.at_rest((n,))
        self.static = fleet.weight[fleet.coupled]  # (n_coupled,) [N]
        self.forces = self.static.copy()  # of the step before
        self._force = np.zeros(n)

    def predict(self) -> None:
        """Advance without the contact forces of the new time."""
        force, integrator = self._force, self.integrator
        force[:] = 0.0
        force[self.fleet.dofs] = integrator.weight_p * self.forces - self.static
        integrator.predict(self.state, force)

    def at_wheels(self) -> FloatArray:
        """Displacements (n_coupled,) of the contact points."""
        return self.state.u.take(self.fleet.dofs)

    def correct(self, forces: FloatArray) -> None:
        """Take the contact forces (n_coupled,) of the new time."""
        self.integrator.correct(self.state, np.asarray(self._columns @ forces))
        self.forces = forces


def _same_vehicle(matrix: FloatArray, owner: IntArray) -> FloatArray:
    """Clear the rounding between contacts of different vehicles, and make it symmetric."""
    masked = np.where(owner[:, None] == owner[None, :], matrix, 0.0)
    return np.asarray(0.5 * (masked + masked.T))


def _block_inverse(matrix: FloatArray, owner: IntArray) -> FloatArray:
    result = np.zeros_like(matrix)
    for vehicle in np.unique(owner):
        own = np.flatnonzero(owner == vehicle)
        result[np.ix_(own, own)] = np.linalg.inv(matrix[np.ix_(own, own)])
    return result


def _pruned(matrix: FloatArray) -> FloatArray:
    return np.where(np.abs(matrix) > 1e-300, matrix, 0.0)
