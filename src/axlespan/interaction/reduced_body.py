"""The structure in time, in the coordinates of a reduced basis.

u = V q throughout: in the free response, under the wheels and in the contact system. The basis holds the static
shapes of all loads on the path, so nothing is left of the static compliance there to be added.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.dynamics.alpha import Alpha
from axlespan.dynamics.integrator import Integrator, Matrices, State
from axlespan.dynamics.reduction import ReducedBasis
from axlespan.interaction.bodies import PreparedStructure, StructureBody, weighted_sums
from axlespan.interaction.path_columns import PathColumns
from axlespan.linalg.low_rank import LowRank

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


def reduced_matrices(matrices: Matrices, basis: ReducedBasis) -> Matrices:
    """Stiffness, mass and damping in the coordinates of the basis."""
    V = basis.vectors
    stiffness = sp.csr_array(sp.diags_array(basis.angular_frequencies**2))
    mass = sp.csr_array(sp.eye_array(basis.size))
    damping = None
    if matrices.C is not None:
        dense = V.T @ np.asarray(matrices.C @ V)
        scale = np.abs(dense).max()
        damping = sp.csr_array(np.where(np.abs(dense) > 1e-12 * scale, 0.5 * (dense + dense.T), 0.0))
    low_rank = matrices.C_low_rank
    reduced = None if low_rank is None else LowRank(V.T @ low_rank.vectors, low_rank.coefficients)
    return Matrices(stiffness, mass, damping, reduced)


class ReducedColumns(PathColumns):
    """Compliance on the path from the basis: (1+α) β Δt² (R V) A_r⁻¹ (R V)ᵀ, all at once."""

    def __init__(self, integrator: Integrator, basis: ReducedBasis) -> None:
        super().__init__(integrator, np.empty(0, dtype=np.int64))
        self.path_dofs = self.held = basis.path_dofs
        self.position = np.zeros(basis.vectors.shape[0], dtype=np.int64)
        self.position[self.held] = np.arange(len(self.held))
        shapes = np.ascontiguousarray(basis.vectors[self.held].T)
        scale = integrator.weight_c * integrator.u_from_a
        block = scale * (shapes.T @ integrator.factor.solve(shapes.copy()))
        self.compliance = 0.5 * (block + block.T)

    def hold(self, dofs: IntArray) -> None:
        """All columns are at hand."""


class PreparedReduced(PreparedStructure):
    """A structure in a reduced basis; the full operator is not needed any more."""

    def __init__(self, matrices: Matrices, basis: ReducedBasis, method: Alpha, time_step: float) -> None:
        self.basis, self._mass = basis, matrices.M
        self.integrator = Integrator(reduced_matrices(matrices, basis), method, time_step)
        self.columns = ReducedColumns(self.integrator, basis)

    def body(self, states: list[State], loads: list[FloatArray]) -> StructureBody:
        """The structure at the states of several crossings, given in full or in the basis."""
        own = [self._in_basis(state) for state in states]
        return ReducedStructureBody(self, own, loads)

    def _in_basis(self, state: State) -> State:
        if state.values.shape[1] == self.basis.size:
            return state
        weighted = np.asarray(self._mass @ state.values.T)
        return State(np.ascontiguousarray((self.basis.vectors.T @ weighted).T))

    def project(self, vectors: FloatArray) -> FloatArray:
        """Vᵀ F of forces (n,) or (n, k)."""
        return np.asarray(self.basis.vectors.T @ vectors)

    def reading(self, dofs: IntArray) -> FloatArray:
        """Rows of V (n_dof, m): displacements of d.o.f. from coordinates."""
        return self.basis.vectors[dofs]


class ReducedStructureBody(StructureBody):
    """The structure as coordinates q of a basis."""

    def __init__(self, prepared: PreparedReduced, states: list[State], path_loads: list[FloatArray]) -> None:
        self._basis = prepared.basis
        super().__init__(prepared, states, path_loads)
        self._held: IntArray | None = None

    def _shapes(self) -> FloatArray:
        """V at the held d.o.f. (n_held, m)."""
        if self._held is not self.columns.held:
            self._held = self.columns.held
            self._held_shapes = np.ascontiguousarray(self._basis.vectors[self._held])
        return self._held_shapes

    def full(self, lane: int) -> State:
        """The state of one crossing in all d.o.f."""
        return State(self.lane(lane).values @ self._basis.vectors.T)

    def _add_loads(self, force: FloatArray, known: FloatArray | None) -> None:
        if self.integrator.weight_p:
            force -= self._basis.vectors[self._loaded].T @ (self.integrator.weight_p * self._load)
        if known is not None:
            force -= self._shapes().T @ (self.integrator.weight_c * known)

    def gather(self, flat: IntArray, held: IntArray, weights: FloatArray) -> FloatArray:
        """Displacements E V q (n_wheel,) at the new time as far as known."""
        everywhere = np.arange(self.stepper.acceleration.size).reshape(self.stepper.acceleration.shape)
        line = self._shapes() @ self.stepper.displacement(everywhere)
        return weighted_sums(line.take(held), weights)

    def _response(self, load: FloatArray) -> FloatArray:
        force = -self.integrator.weight_c * (self._shapes().T @ load)
        return self.integrator.factor.solve(np.ascontiguousarray(force))
