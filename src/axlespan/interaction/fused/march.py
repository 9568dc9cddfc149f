"""The direct method for consecutive steps at once, where structure and vehicles allow it: narrow bands, small vehicles.

Many short calls a step would cost a small model more than its arithmetic. Crossings side by side go in chunks
that stay in the caches, while factor and matrices are read once for all of a chunk.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.dynamics.block_step import BlockStepper
from axlespan.errors import AnalysisError
from axlespan.interaction.bodies import PreparedStructure, StructureBody
from axlespan.interaction.contact_system import Stretch
from axlespan.interaction.convoy import Convoy
from axlespan.interaction.fused.banded_body import BandedBody, csr_parts
from axlespan.interaction.fused.chunk import Chunk, chunks_of
from axlespan.linalg.compiled import Loop

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Crossings in a chunk, and the fewest that are worth one.
_CHUNK, _WORTH_A_CHUNK = 8, 3


@cache
def _march() -> Loop:
    from axlespan.interaction.fused.kernel import march  # numba is an optional part

    return march


class FusedMarch:
    """Consecutive steps of all lanes of a convoy."""

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
        self._sums = _compact(convoy.tape.watched.sums, body.rank)
        for chunk in self._chunks:
            chunk.take(convoy.structure)
        self._stretch: Stretch | None = None

    @classmethod
    def of(cls, convoy: Convoy) -> FusedMarch | None:
        """For a convoy whose structure and vehicles allow it, else None."""
        structure, fleet = convoy.structure, convoy.fleet
        if type(structure) is not StructureBody or type(convoy.prepared) is not PreparedStructure:
            return None
        if structure.integrator.matrices.C_low_rank is not None:
            return None
        if fleet is not None and (not isinstance(fleet.stepper, BlockStepper) or fleet.inner is not None):
            return None
        body = convoy.prepared.banded
        return None if body is None else cls(convoy, body)

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
            for chunk in self._chunks:
                chunk.prepare(stretch, structure.lanes)
                chunk.carry(structure, weight)
        forced = external is not None or bool(len(stretch.forced)) or weight != 0.0
        done = stop
        for chunk in self._chunks:
            done = min(done, self._march(chunk, stretch, forced, external, first, stop))
        convoy.tape.filled = done
        if done < stop:
            raise AnalysisError(f"step {stretch.first + done}: the contact system is not positive definite")

    def _march(
        self, chunk: Chunk, stretch: Stretch, forced: bool, external: FloatArray | None, first: int, stop: int
    ) -> int:
        near, vehicles, forces, sums = self._convoy.tape.arrays
        result: int = _march()(
            (0,) * chunk.width,
            (0,) * self._width,
            self._numbers,
            self._structure,
            chunk.arrays(forced),
            chunk.wheels,
            chunk.known(self._convoy.joint.weight),
            (self._vectors, np.empty((stretch.n_step, 0)) if external is None else external),
            self._fleet_of(chunk, stretch),
            chunk.systems,
            (near, self._watched, vehicles, forces, sums, self._sums, chunk.lane),
            first,
            stop,
        )
        return result

    def _fleet_of(self, chunk: Chunk, stretch: Stretch) -> tuple[Any, ...]:
        """The vehicles of some lanes, as the loop wants them."""
        forces, values, work, result, static, dofs, (first, kind, begin, entries), *rest = self._fleet
        low, high = chunk.blocks
        blocks = (first[low : high + 1], kind[low:high], begin, entries)
        return (
            forces, stretch.gap, chunk.contacts, chunk.dofs, values, work, result, static, dofs, blocks, *rest
        )  # fmt: skip

    def show(self, stretch: Stretch, k: int, lanes: Sequence[int]) -> None:
        """Bring the bodies of the convoy to the step just made; of the structure, the states of some lanes."""
        structure, fleet = self._convoy.structure, self._convoy.fleet
        for chunk in self._chunks:
            chunk.show(structure, np.asarray(lanes, dtype=np.int64))
        load = self._convoy.known_load(stretch, k)
        if fleet is not None:
            fleet.forces = self._fleet[0].copy()
            if len(stretch.into):
                on_line = fleet.forces[stretch.into]
                coupled = structure.path_load(stretch.held[k], stretch.weights[k], on_line)
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
    b = stepper.blocks
    return (
        fleet.forces.copy(),
        stepper.state.values,
        np.zeros((3 if fleet.integrator.has_damping else 2, fleet.integrator.size)),
        np.zeros(fleet.integrator.size),
        fleet.static,
        fleet.fleet.dofs,
        (b.first, b.kind, b.begin, b.entries),
        csr_parts(fleet.stiffness),
        csr_parts(fleet.columns),
        fleet.fleet.coupled,
    )


def _compact(
    sums: Sequence[tuple[FloatArray, int]], rank: IntArray
) -> tuple[IntArray, IntArray, npt.NDArray[np.uint64], FloatArray]:
    """Weighted sums over the structure by their nonzero weights: ends, quantities, rows, weights."""
    parts = [(np.flatnonzero(vector), vector, which) for vector, which in sums]
    ends = np.cumsum([0, *(len(at) for at, _, _ in parts)]).astype(np.int64)
    of = np.array([which for _, _, which in parts], dtype=np.int64)
    at = np.concatenate([np.empty(0, np.int64), *(rank[at] for at, _, _ in parts)])
    return (
        ends,
        of,
        at.astype(np.uint64),
        np.concatenate([np.empty(0), *(vector[at] for at, vector, _ in parts)]),
    )
