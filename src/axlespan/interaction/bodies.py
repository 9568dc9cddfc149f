"""The two bodies in time: the structure, loaded along its path, and the fleet of vehicles.

Both advance without the new contact forces (``predict``) and take them afterwards (``take``). Several
crossings of one structure go side by side: the structure's state then has a column for each of them, and
the fleet holds the vehicles of all.
"""

from __future__ import annotations

from copy import copy
from functools import cache, cached_property

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.dynamics.alpha import Alpha
from axlespan.dynamics.block_step import Blocks, BlockStepper
from axlespan.dynamics.integrator import Integrator, Matrices, State, Stepper
from axlespan.interaction.fleet import Fleet
from axlespan.interaction.fused.banded_body import BandedBody
from axlespan.interaction.path_columns import PathColumns
from axlespan.interaction.path_kernel import load_sums, subtract_at
from axlespan.linalg.products import Product

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


class PreparedStructure:
    """A structure, factored for one method and time step: serves every train, speed and irregularity."""

    def __init__(
        self,
        matrices: Matrices,
        method: Alpha,
        time_step: float,
        path_dofs: IntArray,
        *,
        loaded: int | None = None,
        solver: str = "auto",
        threads: int = 1,
        lanes: int = 1,
    ) -> None:
        self.integrator = Integrator(
            matrices, method, time_step, solver=solver, threads=threads, columns=lanes
        )
        self.columns = PathColumns(self.integrator, path_dofs, loaded)

    @cached_property
    def banded(self) -> BandedBody | None:
        """The structure as the compiled loop over steps wants it; None if it is not of narrow band."""
        return BandedBody.of(self.integrator)

    def for_others(self) -> PreparedStructure:
        """The same factored structure for crossings that advance by themselves."""
        other = copy(self)
        other.columns = self.columns.for_others()
        return other

    def body(self, states: list[State], loads: list[FloatArray]) -> StructureBody:
        """The structure at the states of several crossings, under their Eᵀ X (n,)."""
        return StructureBody(self, states, loads)

    def project(self, vectors: FloatArray) -> FloatArray:
        """Forces (n,) or (n, k) in the coordinates of the state."""
        return vectors

    @property
    def shapes(self) -> FloatArray | None:
        """All d.o.f. (n, m) from m coordinates of the state; None: the state holds the d.o.f."""
        return None


class StructureBody:
    """The structure in time, under the wheels of ``lanes`` crossings."""

    def __init__(
        self,
        prepared: PreparedStructure,
        states: list[State],
        path_loads: list[FloatArray],
    ) -> None:
        self.integrator, self.columns = prepared.integrator, prepared.columns
        self.lanes = len(states)
        single = self.lanes == 1
        values = states[0].values.copy() if single else np.stack([state.values for state in states], axis=-1)
        self.stepper = Stepper(self.integrator, State(np.ascontiguousarray(values)))
        n = self.integrator.size
        self._shape = (n,) if single else (n, self.lanes)
        # Eᵀ X of the step before, on the d.o.f. that were held then.
        self._n_dof = len(path_loads[0])
        self._loaded = np.arange(self._n_dof)
        self._load = path_loads[0].copy() if single else np.stack(path_loads, axis=-1)

    @property
    def state(self) -> State:
        """The state at the last completed step."""
        return self.stepper.state

    def lane(self, lane: int) -> State:
        """The state of one crossing; a view if it is the only one."""
        values = self.state.values
        return State(values if values.ndim == 2 else np.ascontiguousarray(values[:, :, lane]))

    def full(self, lane: int) -> State:
        """The state of one crossing in all free d.o.f."""
        return self.lane(lane)

    def load_of(self, lane: int) -> FloatArray:
        """Eᵀ X (n,) of one crossing at the last completed step."""
        result = np.zeros(self._n_dof)
        result[self._loaded] = self._load if self._load.ndim == 1 else self._load[:, lane]
        return result

    def predict(self, external: FloatArray | None, known: FloatArray | None) -> None:
        """Advance under the weighted external force (n,), the contact of the step before and known wheel loads."""
        if external is None and known is None and not self.integrator.weight_p:
            self.stepper.predict(forceless=True)
            return
        force = self.stepper.force
        if external is None:
            force[...] = 0.0
        else:
            force[...] = external if force.ndim == 1 else external[:, None]
        self._add_loads(force, known)
        self.stepper.predict()

    def _add_loads(self, force: FloatArray, known: FloatArray | None) -> None:
        """Add the contact loads of the step before and those known at the new time, as the alpha method weighs them."""
        if self.integrator.weight_p:
            subtract_at(self._loaded, self.integrator.weight_p, self._load, force)
        if known is not None:
            subtract_at(self.columns.held, self.integrator.weight_c, known, force)

    def gather(self, flat: IntArray, held: IntArray, weights: FloatArray) -> FloatArray:
        """Displacements E u (n_wheel,) at the new time as far as known, for rows (n_wheel, n_local)."""
        return weighted_sums(self.stepper.displacement(flat), weights)

    def path_load(self, flat: IntArray, weights: FloatArray, forces: FloatArray) -> FloatArray:
        """Eᵀ X (n_held,) or (n_held, k) of wheels with rows (n_wheel, n_local) and forces (n_wheel,)."""
        n_held = len(self.columns.held)
        total = load_sums(flat, weights, forces, n_held * self.lanes)
        return total if self.lanes == 1 else total.reshape(n_held, self.lanes)

    def take(self, coupled: FloatArray | None, known: FloatArray | None) -> None:
        """Take the loads (n_held, …) of the coupled wheels, and complete the step; known loads are in already."""
        self._loaded = self.columns.held
        response = None if coupled is None else self._response(coupled)
        if coupled is None or known is None:
            given = coupled if coupled is not None else known
            self._load = given if given is not None else np.zeros((len(self._loaded), *self._shape[1:]))
        else:
            self._load = coupled + known
        self.stepper.finish(response)

    def _response(self, load: FloatArray) -> FloatArray:
        """Acceleration under the loads (n_held, …) of the coupled wheels at the new time."""
        return self.columns.response(load)

    def take_solved(self, coupled: FloatArray, known: FloatArray | None) -> None:
        """Complete the step when the response to the coupled wheels is in the acceleration already."""
        self._loaded = self.columns.held
        self._load = coupled if known is None else coupled + known
        self.stepper.finish()

    def carry(self, load: FloatArray) -> None:
        """Set the load (n,) of the last completed step, of a single crossing: wheels and all else that acts inside."""
        self._loaded, self._load = np.arange(self._n_dof), load

    @property
    def carried(self) -> tuple[IntArray, FloatArray]:
        """Eᵀ X (n_held,) or (n_held, k) of the last completed step, with its d.o.f."""
        return self._loaded, self._load

    def settle(self, load: FloatArray | None) -> None:
        """Set the load (n_held, …) of steps that were made, and put into the state, elsewhere."""
        self._loaded = self.columns.held
        self._load = np.zeros((len(self._loaded), *self._shape[1:])) if load is None else load

    def put(self, values: FloatArray, load: FloatArray) -> None:
        """Set the state (3, n) at the new time and Eᵀ X (n,), computed elsewhere, of a single crossing."""
        self.state.values[...] = values
        self.stepper.hold()
        self._loaded, self._load = np.arange(self.integrator.size), load


class FleetBody:
    """All vehicles of one or several trains in time; displacements from the static position on level ground."""

    def __init__(
        self, fleet: Fleet, method: Alpha, time_step: float, state: State, forces: FloatArray
    ) -> None:
        self.fleet = fleet
        self.integrator = Integrator(fleet.matrices, method, time_step)
        blocks = Blocks.of(self.integrator, fleet.owner_of_dof)
        if blocks is None:
            self.stepper, columns = Stepper(self.integrator, state.copy()), self._unit_responses()
        else:
            self.stepper = BlockStepper(self.integrator, state.copy(), blocks)
            columns = blocks.unit_responses(fleet.dofs)
        scale = self.integrator.weight_c * self.integrator.u_from_a
        self.compliance = scale * columns[fleet.dofs]
        self.stiffness = _block_inverse(self.compliance, fleet.vehicle_of)
        self._stiffness = Product(self.stiffness)
        self.columns = sp.csr_array(self.integrator.weight_c * columns)  # (n, n_coupled)
        self._columns = Product(self.columns)
        self.static = fleet.weight[fleet.coupled]  # (n_coupled,) [N]
        self.forces = forces.copy()  # (n_coupled,) of the last completed step [N]
        self.inner: FloatArray | None = None  # (n,) what nonlinear springs add at that step [N]

    def _unit_responses(self) -> sp.csr_array:
        """A⁻¹ I_Xᵀ (n, n_coupled), one block for each vehicle: wheels of the same rank are solved for together."""
        fleet, n = self.fleet, self.fleet.matrices.size
        owner = fleet.vehicle_of
        rank = np.arange(len(owner)) - np.searchsorted(owner, owner)
        n_wheel = int(rank.max(initial=-1)) + 1
        loads = np.zeros((n, n_wheel))
        loads[fleet.dofs, rank] = 1.0
        responses = self.integrator.factor.solve(loads)
        row_owner = fleet.owner_of_dof
        rows, columns = [], []
        for wheel in range(len(owner)):
            own = np.flatnonzero(row_owner == owner[wheel])
            rows.append(own)
            columns.append(np.full(len(own), wheel))
        row, column = np.concatenate(rows), np.concatenate(columns)
        return sp.csr_array(
            sp.coo_array((responses[row, rank[column]], (row, column)), shape=(n, len(owner)))
        )

    @property
    def state(self) -> State:
        """The state at the last completed step."""
        return self.stepper.state

    def predict(self) -> None:
        """Advance without the contact forces of the new time."""
        stepper = self.stepper
        stepper.force[...] = 0.0
        stepper.force[self.fleet.dofs] = self.integrator.weight_p * self.forces - self.static
        if self.inner is not None:
            stepper.force += self.integrator.weight_p * self.inner
        stepper.predict()

    def at_wheels(self) -> FloatArray:
        """Displacements (n_coupled,) of the contact points at the new time as far as known."""
        return self.stepper.displacement(self.fleet.dofs)

    def on_ground(self, gap: FloatArray) -> FloatArray:
        """Contact forces (n_coupled,) that close the gaps of wheels on rigid ground."""
        return self._stiffness.of(gap)

    def take(self, forces: FloatArray) -> None:
        """Take the contact forces (n_coupled,) of the new time, and complete the step."""
        self.stepper.finish(self._columns.of(forces))
        self.forces = forces

    def put(self, values: FloatArray, forces: FloatArray) -> None:
        """Set the state (3, n) at the new time and the contact forces (n_coupled,), computed elsewhere."""
        self.state.values[...] = values
        self.stepper.hold()
        self.forces = forces


@cache
def _ones(n: int) -> FloatArray:
    return np.ones(n)


def weighted_sums(values: FloatArray, weights: FloatArray) -> FloatArray:
    """Sums (n_wheel,) of values times weights (n_wheel, n_local); the values are overwritten."""
    values *= weights
    return np.asarray(values.dot(_ones(values.shape[1])))  # quicker than a sum along short rows


def _block_inverse(matrix: sp.csr_array, owner: IntArray) -> sp.csr_array:
    """Inverse of a matrix with one symmetric block for each vehicle; blocks of one size are inverted together."""
    first, rank, size = np.unique(owner, return_index=True, return_inverse=True, return_counts=True)[1:]
    entries = matrix.tocoo()
    block = rank[entries.row]
    rows, columns, values = [], [], []
    for n in np.unique(size):
        of_size = np.flatnonzero(size == n)
        place = np.full(len(size), -1)
        place[of_size] = np.arange(len(of_size))
        own = place[block] >= 0
        row, column, at = entries.row[own], entries.col[own], block[own]
        dense = np.zeros((len(of_size), n, n))
        dense[place[at], row - first[at], column - first[at]] = entries.data[own]
        inverse = np.linalg.inv(0.5 * (dense + dense.transpose(0, 2, 1)))
        values.append(0.5 * (inverse + inverse.transpose(0, 2, 1)).ravel())
        here = first[of_size][:, None] + np.arange(n)
        rows.append(np.repeat(here, n, axis=1).ravel())
        columns.append(np.tile(here, (1, n)).ravel())
    where = (np.concatenate(rows), np.concatenate(columns)) if rows else (np.empty(0, int), np.empty(0, int))
    return sp.csr_array(sp.coo_array((np.concatenate([np.empty(0), *values]), where), shape=matrix.shape))
