"""The direct method for consecutive steps at once, where structure and vehicles allow it: narrow bands, small vehicles.

Many short calls a step would cost a small model more than its arithmetic. Crossings side by side go in chunks
that stay in the caches, while factor and matrices are read once for all of a chunk.
"""

from __future__ import annotations

from functools import cache
from itertools import pairwise
from typing import Any, Self

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.compiled import Loop
from axlespan.dynamics.block_step import Blocks, BlockStepper
from axlespan.dynamics.integrator import State
from axlespan.errors import AnalysisError
from axlespan.interaction.bodies import PreparedStructure, StructureBody
from axlespan.interaction.contact_system import Stretch
from axlespan.interaction.convoy import Convoy
from axlespan.interaction.fused.alike import AlikeTrains
from axlespan.interaction.fused.banded_body import PIECE, BandedBody, csr_parts
from axlespan.interaction.fused.chunk import Chunk, chunks_of
from axlespan.interaction.records.sums import Sums

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Crossings in a chunk, and the fewest that are worth one.
_CHUNK, _WORTH_A_CHUNK = 8, 3


@cache
def _march() -> Loop:
    from axlespan.interaction.fused.march_kernel import march  # numba is an optional part

    return march


class FusedMarch:
    """Consecutive steps of all lanes of a convoy."""

    #: Whether a stretch must bring contact systems; the loop makes its own.
    needs_systems = False
    #: Whether damping of modes goes through the loop.
    damps_modes = True

    def __init__(self, convoy: Convoy, body: BandedBody) -> None:
        self._convoy = convoy
        integrator = convoy.structure.integrator
        p, n = integrator.prediction, integrator.size
        late = (float(p[0, 1]), float(p[0, 2]), float(p[1, 2]), integrator.u_from_a, integrator.v_from_a)
        self._numbers = (p, late, float(integrator.weight_c), float(integrator.weight_p))
        self._structure = (body.K, body.C, body.damped, body.lower, body.ahead, n)
        self._width = body.width
        self._vectors = np.ascontiguousarray(convoy.vectors.reshape(n, -1)[body.rows].T)
        self._fleet = _fleet_arrays(convoy)
        vehicles = [np.unique(convoy.joint.owner_of_dof[own]) for own in convoy.vehicle_dofs]
        ends = np.cumsum([0, *map(len, vehicles)]).tolist()
        blocks = [slice(a, b) for a, b in pairwise(ends)]
        self._chunks = chunks_of(body, (convoy.coupled, convoy.vehicle_dofs, blocks), _CHUNK, _WORTH_A_CHUNK)
        self._watched = body.rank[convoy.tape.watched.dofs]
        self._sums = _pieces(convoy.tape.watched.sums, body.rank, _CHUNK)
        for chunk in self._chunks:
            chunk.take(convoy.structure)
        self._alike = [self._alike_in(chunk) for chunk in self._chunks]
        self._stretch: Stretch | None = None
        self._body = body
        self._compliance: dict[int, FloatArray] = {}  # by lane

    def _alike_in(self, chunk: Chunk) -> AlikeTrains | None:
        """The vehicles of a chunk side by side, if its trains are equal."""
        if chunk.width == 1:
            return None
        return AlikeTrains.of(
            self._convoy, range(chunk.lane, chunk.lane + chunk.used), chunk.width, self._fleet[6]
        )

    @classmethod
    def of(cls, convoy: Convoy) -> Self | None:
        """For a convoy whose structure and vehicles allow it, else None."""
        structure, fleet = convoy.structure, convoy.fleet
        if type(structure) is not StructureBody or type(convoy.prepared) is not PreparedStructure:
            return None
        if fleet is not None and (not isinstance(fleet.stepper, BlockStepper) or fleet.inner is not None):
            return None
        body = convoy.prepared.banded
        if body is None or (body.modal is not None and not cls.damps_modes):
            return None
        return cls(convoy, body)

    def go(self, stretch: Stretch, first: int, stop: int, external: FloatArray | None) -> None:
        """Make steps ``first`` to ``stop`` of a stretch, and write them on the tape.

        Raises
        ------
        AnalysisError
            If a contact system is not positive definite.
        """
        convoy, structure = self._convoy, self._convoy.structure
        weight = self._numbers[3]
        if stretch is not self._stretch:
            self._stretch = stretch
            convoy.tape.arrays[2][...] = convoy.joint.weight  # moving forces stay so
            self._systems = self._systems_of(stretch)
            self._modal = [self._modal_of(chunk, number) for number, chunk in enumerate(self._chunks)]
            for chunk in self._chunks:
                chunk.prepare(stretch, structure.lanes)
                chunk.carry(structure, weight)
        forced = external is not None or bool(len(stretch.forced)) or weight != 0.0
        done = stop
        for chunk in self._chunks:
            own = min(stop, max(lane.left for lane in convoy.lanes[chunk.lane : chunk.lane + chunk.used]))
            if first < own and (made := self._march(chunk, stretch, forced, external, first, own)) < own:
                done = min(done, made)
        convoy.tape.filled = done
        if done < stop:
            raise AnalysisError(f"step {stretch.first + done}: the contact system is not positive definite")

    def _systems_of(self, stretch: Stretch) -> list[tuple[Any, ...]]:
        """What makes the contact systems of each chunk: contacts, wheels among them, vehicles and the path."""
        convoy, columns = self._convoy, self._convoy.structure.columns
        Z, row_of = columns.compliance, columns.position[self._body.rows]
        offset = columns.offset
        table = np.column_stack([np.arange(len(Z)) * Z.shape[1] - offset, columns.low, columns.high, offset])
        path = (row_of, np.ascontiguousarray(table), Z.reshape(-1), Z.shape[1])
        owner = convoy.joint.vehicle_of
        touched = np.zeros(int(owner.max(initial=-1)) + 1, dtype=bool)
        touched[owner[stretch.into]] = True
        systems = []
        for chunk, alike in zip(self._chunks, self._alike, strict=True):
            lanes = range(chunk.lane, chunk.lane + chunk.used)
            own, wheel_ends, at, vehicles = self._contacts_of(lanes, touched, stretch.into)
            systems.append((own if alike is None else alike.places(own), *wheel_ends, at, vehicles, path))
        return systems

    def _contacts_of(
        self, lanes: range, touched: npt.NDArray[np.bool_], into: IntArray
    ) -> tuple[IntArray, tuple[IntArray, IntArray], IntArray, tuple[FloatArray, IntArray, IntArray]]:
        """Contacts of the systems of some lanes; where those and wheels of each lane end; wheels among them; vehicles."""
        owner = self._convoy.joint.vehicle_of
        contacts, at, n_wheel, vehicles = [], [], [0], []
        for lane in lanes:
            own = self._convoy.coupled[lane]
            here = np.flatnonzero(touched[owner[own]])
            wheels = into[(into >= own.start) & (into < own.stop)]
            contacts.append(own.start + here)
            at.append(np.searchsorted(contacts[-1], wheels))
            n_wheel.append(len(wheels))
            vehicles.append(self._vehicles_of(lane, here))
        ends = np.cumsum([0, *map(len, contacts)]).astype(np.int64)
        begins = np.cumsum([0, *(S.size for S, _ in vehicles)])[:-1].astype(np.int64)
        compliance = np.concatenate([S.ravel() for S, _ in vehicles])
        reach = np.concatenate([own for _, own in vehicles])
        wheel_ends = np.cumsum(n_wheel).astype(np.int64)
        return (
            np.concatenate(contacts),
            (ends, wheel_ends),
            np.concatenate(at),
            (compliance, begins, reach),
        )

    def _vehicles_of(self, lane: int, contacts: IntArray) -> tuple[FloatArray, IntArray]:
        """Compliance of the vehicles of a lane at some of its contacts, the upper triangle, and the reach of its rows."""
        convoy = self._convoy
        if lane not in self._compliance:
            whole = convoy.coupled[lane]
            block = (
                convoy.fleet.compliance[whole][:, whole].toarray()
                if convoy.fleet is not None
                else np.zeros((0, 0))
            )
            self._compliance[lane] = np.triu(0.5 * (block + block.T))
        S = self._compliance[lane]
        if len(contacts) < len(S):
            S = S[np.ix_(contacts, contacts)]
        n = len(S)
        reach = n - 1 - np.argmax(S[:, ::-1] != 0.0, axis=1) if n else np.empty(0, dtype=np.int64)
        return S, reach.astype(np.int64)

    def _march(
        self, chunk: Chunk, stretch: Stretch, forced: bool, external: FloatArray | None, first: int, stop: int
    ) -> int:
        near, vehicles, forces, sums = self._convoy.tape.arrays
        number = self._chunks.index(chunk)
        alike, (place, weights, into) = self._alike[number], chunk.wheels
        result: int = _march()(
            (0,) * chunk.width,
            (0,) * self._width,
            self._numbers,
            self._structure,
            chunk.arrays(forced),
            (place, weights, into if alike is None else alike.places(into)),
            chunk.known(self._convoy.joint.weight),
            (self._vectors, np.empty((stretch.n_step, 0)) if external is None else external),
            self._fleet_of(chunk, stretch),
            None if alike is None else alike.arrays,
            self._modal[number],
            self._systems[number],
            (near, self._watched, vehicles, forces, sums, self._sums, chunk.lane),
            first,
            stop,
        )
        return result

    def _modal_of(self, chunk: Chunk, number: int) -> tuple[Any, ...] | None:
        """Damping of modes, W on the path, and the lanes of a chunk's wheels."""
        modal = self._body.modal
        if modal is None:
            return None
        wheel_ends = self._systems[number][2]
        lanes = np.repeat(np.arange(chunk.used), np.diff(wheel_ends))
        W = modal.responses[self._convoy.structure.columns.held].reshape(-1)
        return modal.rows, modal.U, modal.coefficients, modal.core, W, lanes

    def _fleet_of(self, chunk: Chunk, stretch: Stretch) -> tuple[Any, ...]:
        """The vehicles of some lanes, as the loop wants them."""
        forces, values, work, result, static, dofs, (first, kind, begin, entries), *rest = self._fleet
        low, high = chunk.blocks
        blocks = (first[low : high + 1], kind[low:high], begin, entries)
        return (
            forces, stretch.gap, chunk.contacts, chunk.dofs, values, work, result, static, dofs, blocks, *rest
        )  # fmt: skip

    def state_of(self, lane: int) -> State:
        """The structure of one lane at the last step made."""
        (chunk,) = (one for one in self._chunks if one.lane <= lane < one.lane + one.used)
        return chunk.state_of(lane)

    def show(self, stretch: Stretch, k: int, *, states: bool) -> None:
        """Bring the bodies of the convoy to the step just made, the structure's with or without its states."""
        structure, fleet = self._convoy.structure, self._convoy.fleet
        for chunk in self._chunks if states else ():
            chunk.show(structure)
        load = self._convoy.known_load(stretch, k, once=True)
        if fleet is not None:
            fleet.forces = self._fleet[0].copy()
            if len(stretch.into):
                rows = stretch.rows(True, slice(k, k + 1))
                coupled = structure.path_load(rows.held[0], rows.weights[0], fleet.forces[stretch.into])
                load = coupled if load is None else coupled + load
        structure.settle(load)


def _fleet_arrays(convoy: Convoy) -> tuple[Any, ...]:
    """Forces, states, room to work in, static forces, d.o.f. of wheels, blocks, A_X⁻¹, A⁻¹ columns, contacts."""
    fleet = convoy.fleet
    if fleet is None:
        none, number, csr = np.empty(0), np.empty(0, np.int64), csr_parts(sp.csr_array((0, 0)))
        block = (np.zeros(1, np.int64), number, number, none)
        return none, np.zeros((3, 0)), np.zeros((2, 0)), none, none, number, block, csr, csr, number
    stepper = fleet.stepper
    assert isinstance(stepper, BlockStepper)
    n, parts = fleet.integrator.size, 3 if fleet.integrator.has_damping else 2
    return (
        fleet.forces.copy(),
        stepper.state.values,
        np.zeros((parts, n)),
        np.zeros(n + PIECE),
        fleet.static,
        fleet.fleet.dofs,
        _padded(stepper.blocks, parts),
        csr_parts(fleet.stiffness),
        csr_parts(fleet.columns),
        fleet.fleet.coupled,
    )


def _padded(blocks: Blocks, parts: int) -> tuple[IntArray, IntArray, IntArray, FloatArray]:
    """Blocks of vehicles with columns in one piece each, padded so that compiled loops read them by eights."""
    begins, padded, filled = [], [], 0
    for kind, begin in enumerate(blocks.begin.tolist()):
        like = int(np.flatnonzero(blocks.kind == kind)[0])
        n = int(blocks.first[like + 1] - blocks.first[like])
        rows = blocks.entries[begin : begin + n * parts * n].reshape(n, parts * n)
        padded.append(np.pad(rows.T, ((0, 0), (0, -n % PIECE))).ravel())
        begins.append(filled)
        filled += padded[-1].size
    return blocks.first, blocks.kind, np.array(begins, dtype=np.int64), np.concatenate(padded)


def _pieces(
    sums: Sums, rank: IntArray, width: int
) -> tuple[IntArray, IntArray, IntArray, npt.NDArray[np.uint64], FloatArray, FloatArray]:
    """Weighted sums over the structure, as the loop wants them: sums, quantities, ends, rows, weights; and room."""
    row, which, ends, dofs, weights = sums.pieces()
    return row, which, ends, rank[dofs].astype(np.uint64), weights, np.zeros(sums.count * width)
