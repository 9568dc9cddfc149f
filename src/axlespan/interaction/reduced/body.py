r"""The structure in time, in the coordinates of a reduced basis.

u = V q throughout: in the free response, under the wheels and in the contact system. The basis holds the static
shapes of all loads on the path, so nothing is left of the static compliance there to be added.

Shapes of high frequency are the dents under the wheels. A time step resolves a shape while ω Δt < 2; one above
that would ring undamped near the highest frequency that the step can show, which is no motion of the structure.
Such shapes follow their forces at once, without inertia and damping, and add nothing to velocities and
accelerations.
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


class Coordinates(State):
    """A state in the coordinates of a basis, which may be as many as the d.o.f."""


# Shapes with ω Δt beyond this are not resolved by the time step.
_RESOLVED = 2.0


def resolved_shapes(basis: ReducedBasis, time_step: float) -> npt.NDArray[np.bool_]:
    """Which shapes (m,) a time step [s] resolves."""
    return np.asarray(basis.angular_frequencies * time_step < _RESOLVED)


def reduced_matrices(
    matrices: Matrices, basis: ReducedBasis, resolved: npt.NDArray[np.bool_] | None = None
) -> Matrices:
    """Stiffness, mass and damping in the coordinates of the basis; only resolved shapes have the latter two."""
    V = basis.vectors
    moves = np.ones(basis.size) if resolved is None else resolved.astype(float)
    stiffness = sp.csr_array(sp.diags_array(basis.angular_frequencies**2))
    mass = sp.csr_array(sp.diags_array(moves))
    damping = None
    if matrices.C is not None:
        dense = moves[:, None] * (V.T @ np.asarray(matrices.C @ V)) * moves
        scale = np.abs(dense).max()
        damping = sp.csr_array(np.where(np.abs(dense) > 1e-12 * scale, 0.5 * (dense + dense.T), 0.0))
    low_rank = matrices.C_low_rank
    reduced = None
    if low_rank is not None:
        reduced = LowRank(moves[:, None] * (V.T @ low_rank.vectors), low_rank.coefficients)
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
        self.offset = self.low = np.zeros_like(self.held)
        self.high = np.full_like(self.held, len(self.held))

    @property
    def is_whole(self) -> bool:
        """All are at hand."""
        return True

    def for_others(self) -> PathColumns:
        """Nothing changes here: crossings may share it."""
        return self

    def hold(self, dofs: IntArray) -> None:
        """All columns are at hand."""


class PreparedReduced(PreparedStructure):
    """A structure in a reduced basis; the full operator is not needed any more."""

    def __init__(
        self,
        matrices: Matrices,
        basis: ReducedBasis,
        method: Alpha,
        time_step: float,
        *,
        all_with_inertia: bool = False,
    ) -> None:
        self.basis, self._matrices = basis, matrices
        self.resolved = resolved_shapes(basis, time_step) | all_with_inertia
        self.integrator = Integrator(reduced_matrices(matrices, basis, self.resolved), method, time_step)
        self.columns = ReducedColumns(self.integrator, basis)

    def body(self, states: list[State], loads: list[FloatArray]) -> StructureBody:
        """The structure at the states of several crossings, given in full or in the basis."""
        own = [self._in_basis(state) for state in states]
        return ReducedStructureBody(self, own, loads)

    def _in_basis(self, state: State) -> State:
        if isinstance(state, Coordinates):
            return state
        m, at_once = self._matrices, ~self.resolved
        # Displacements by strain energy, which also holds for shapes without inertia; rates by kinetic energy.
        inertia = (self.basis.vectors.T @ np.asarray(m.M @ state.values.T)).T
        forces = self.basis.vectors.T @ np.asarray(m.K @ state.u)
        # Shapes that follow at once balance all forces from the start, those that inertia and damping took too.
        applied = forces + inertia[2] + self.basis.vectors.T @ m.damping_force(state.v)
        result = inertia
        result[0] = np.where(at_once, applied, forces) / self.basis.angular_frequencies**2
        result[1:, at_once] = 0.0
        return Coordinates(np.ascontiguousarray(result))

    def project(self, vectors: FloatArray) -> FloatArray:
        """Vᵀ F of forces (n,) or (n, k)."""
        return np.asarray(self.basis.vectors.T @ vectors)

    @property
    def shapes(self) -> FloatArray:
        """All d.o.f. (n, m) from m coordinates."""
        return self.basis.vectors


class ReducedStructureBody(StructureBody):
    """The structure as coordinates q of a basis."""

    def __init__(self, prepared: PreparedReduced, states: list[State], path_loads: list[FloatArray]) -> None:
        self._basis = prepared.basis
        super().__init__(prepared, states, path_loads)
        self._held: IntArray | None = None
        self._at_once = np.flatnonzero(~prepared.resolved)
        self.state.values[1:, self._at_once] = 0.0

    def _shapes(self) -> FloatArray:
        """V at the held d.o.f. (n_held, m)."""
        if self._held is not self.columns.held:
            self._held = self.columns.held
            self._held_shapes = np.ascontiguousarray(self._basis.vectors[self._held])
        return self._held_shapes

    def lane(self, lane: int) -> State:
        """The coordinates of one crossing; a view if it is the only one."""
        return Coordinates(super().lane(lane).values)

    def full(self, lane: int) -> State:
        """The state of one crossing in all d.o.f."""
        return State(self.lane(lane).values @ self._basis.vectors.T)

    def take(self, coupled: FloatArray | None, known: FloatArray | None) -> None:
        """Take the loads, and complete the step; shapes that follow at once have no rates to go on with."""
        super().take(coupled, known)
        self.state.values[1:, self._at_once] = 0.0

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
