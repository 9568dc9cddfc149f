"""Crossings of one structure that advance side by side: their bodies, and what is written down of them.

All lanes share the factored structure; each has its own train, speed, irregularity and length of run.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.integrator import State
from axlespan.errors import AnalysisError
from axlespan.interaction.bodies import FleetBody, PreparedStructure, StructureBody
from axlespan.interaction.contact_system import Stretch, stretch_of
from axlespan.interaction.fleet import Fleet, joined
from axlespan.interaction.plan import Plan
from axlespan.interaction.records.recorder import Recorder
from axlespan.interaction.records.sums import Sums
from axlespan.interaction.records.tape import LaneTape, Tape, Watched
from axlespan.interaction.start import Start

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Steps of a stretch (half as many for crossings side by side, whose memory they share), and the entries of contact
# systems and of contact rows that one may hold.
_STRETCH, _ENTRIES, _ROWS = 1024, 12_000_000, 4_000_000

# There is something to tell about every half a second; what a step takes for each byte of the factor [s].
_NEWS, _PER_BYTE = 0.5, 2e-10


@dataclass(eq=False)
class Lane:
    """One crossing on its way."""

    plan: Plan
    recorder: Recorder
    structure: State
    fleet: State
    forces: FloatArray  # (n_contact,) [N]
    load: FloatArray  # Eᵀ X (n,) on the structure [N]
    done: int = 0  # time index of the last completed step
    error: AnalysisError | None = None

    @classmethod
    def at_start(cls, plan: Plan, start: Start, recorder: Recorder) -> Lane:
        """A crossing at time zero."""
        return cls(plan, recorder, start.structure, start.fleet, start.forces, start.load)

    @property
    def left(self) -> int:
        """Steps that are still to be made."""
        return self.plan.settings.steps - self.done


class Convoy:
    """The bodies of several lanes at a time, and what is written down of them."""

    def __init__(self, lanes: Sequence[Lane], prepared: PreparedStructure) -> None:
        self.lanes, self.prepared = list(lanes), prepared
        plans = [lane.plan for lane in lanes]
        self.plans = plans
        settings = plans[0].settings
        self.forces = plans[0].forces  # external forces on the structure, the same for all
        self.vectors = prepared.project(self.forces.vectors)
        self.structure: StructureBody = prepared.body(
            [lane.structure for lane in lanes], [lane.load for lane in lanes]
        )
        fleets = [plan.fleet for plan in plans]
        self.joint: Fleet = joined(fleets)
        self.contacts = _slices([len(fleet.weight) for fleet in fleets])
        self.coupled = _slices([len(fleet.coupled) for fleet in fleets])
        self.vehicle_dofs = _slices([fleet.matrices.size for fleet in fleets])
        self.fleet: FleetBody | None = None
        if len(self.joint.coupled):
            values = np.concatenate([lane.fleet.values for lane in lanes], axis=1)
            forces = np.concatenate([lane.forces for lane in lanes])[self.joint.coupled]
            self.fleet = FleetBody(self.joint, settings.method, settings.time_step, State(values), forces)
        dofs = np.unique(np.concatenate([lane.recorder.selected for lane in lanes]))
        self._own_sums, sums = _distinct([lane.recorder.sums for lane in lanes])
        watched = Watched(dofs, sums, prepared.shapes)
        self.tape = Tape(watched, len(lanes), self.joint.matrices.size, len(self.joint.weight))

    def stretch(self, *, systems: bool = True, idle: bool = False) -> Stretch:
        """The next steps: as many as memory allows.

        None is behind the end of any lane, unless lanes may be ``idle``: then some lane makes all of them.
        """
        size = sum(plan.rows.n_contact**2 for plan in self.plans) if systems else 0
        # Side by side, a crossing costs about a third.
        alone = _PER_BYTE * self.prepared.integrator.factor.nbytes
        seconds = alone * (2 + len(self.lanes)) / 3
        often = int(_NEWS / max(seconds, _NEWS / _STRETCH))
        most = _STRETCH if len(self.lanes) == 1 else _STRETCH // 2
        n_step = max(16, min(most, _ENTRIES // max(size, 1), often))
        left = [lane.left for lane in self.lanes]
        n_step = min(n_step, max(left) if idle else min(left))
        first = max(lane.done for lane in self.lanes) + 1
        begin, end = self.plans[0].times_of(np.array([first, first + n_step]))
        rows = sum(plan.rows.n_entries(begin, end) for plan in self.plans)
        n_step = min(n_step, max(64, _ROWS // max(rows, 1)))
        return stretch_of(self.plans, first, n_step, self.structure, self.fleet, systems=systems)

    def external(self, stretch: Stretch) -> FloatArray | None:
        """Weighted factors (n_step, n_term) of the external forces; None if there are none."""
        if not self.forces.n_term:
            return None
        times = self.plans[0].times_of(stretch.first - 1 + np.arange(stretch.n_step + 1))
        return self.forces.weighted(times, self.plans[0].settings.method)

    def known_load(self, stretch: Stretch, k: int, *, once: bool = False) -> FloatArray | None:
        """Eᵀ P of the moving forces at a step, of all or just ``once``; None where there are none on the structure."""
        if not len(stretch.forced):
            return None
        weights = self.joint.weight[stretch.forced]
        if once:
            rows = stretch.rows(False, slice(k, k + 1))
            return self.structure.path_load(rows.held[0], rows.weights[0], weights)
        return self.structure.path_load(stretch.forced_held[k], stretch.forced_weights[k], weights)

    def predict(self, stretch: Stretch, k: int, external: FloatArray | None) -> FloatArray | None:
        """Advance the structure under all but the new contact forces of the vehicles; returns :meth:`known_load`."""
        known = self.known_load(stretch, k)
        self.structure.predict(None if external is None else self.vectors @ external, known)
        return known

    def tape_of(self, lane: int) -> LaneTape:
        """The tape of one lane."""
        dofs = self.lanes[lane].recorder.selected
        own = self._own_sums[lane]
        return self.tape.of(lane, dofs, self.vehicle_dofs[lane], self.contacts[lane], own)

    def moment(
        self, lane: int, structure: State | None = None
    ) -> tuple[State, State, FloatArray, FloatArray]:
        """Structure, vehicles, Eᵀ X (n,) and contact forces (n_coupled,) of one lane at the last completed step."""
        structure = structure or self.structure.full(lane)
        load = self.structure.load_of(lane)
        if self.fleet is None:
            return structure, State(np.zeros((3, 0))), load, np.zeros(0)
        vehicles = State(self.fleet.state.values[:, self.vehicle_dofs[lane]])
        return structure, vehicles, load, self.fleet.forces[self.coupled[lane]]

    def contact_at(
        self, stretch: Stretch, k: int, states: Sequence[State] | None
    ) -> tuple[FloatArray, FloatArray]:
        """Displacements of all wheels and of the line under them (n_coupled,), after step k.

        ``states`` are those of the structure in all lanes, where the bodies do not hold them.
        """
        assert self.fleet is not None
        line = stretch.gap[k].copy()
        if states is not None:
            for rows, state, own in zip(stretch.crossings, states, self.coupled, strict=True):
                on, block = rows.active, rows.at(slice(k, k + 1))
                heights = (state.u[block.dofs[0, on]] * block.weights[0, on]).sum(axis=1)
                line[own][rows.rank[on]] += heights
        elif len(stretch.into):
            rows_at = stretch.rows(True, slice(k, k + 1))
            line[stretch.into] += self.structure.gather(rows_at.flat[0], rows_at.held[0], rows_at.weights[0])
        return self.fleet.at_wheels(), line

    def count(self, what: str, number: int) -> None:
        """Count something that a coupling does, for the summary of the first lane."""
        counts = self.lanes[0].recorder.counts
        counts[what] = counts.get(what, 0) + number

    def save(self, n_step: int, states: Sequence[State]) -> None:
        """Put the states of the bodies back into the lanes that are not at their ends, after so many steps."""
        for i, lane in enumerate(self.lanes):
            own = min(n_step, lane.left)
            lane.done += own
            if own < n_step:
                continue
            lane.structure, lane.load = states[i], self.structure.load_of(i)
            lane.forces = self.tape.last_forces(self.contacts[i])
            if self.fleet is not None:
                lane.fleet = State(self.fleet.state.values[:, self.vehicle_dofs[i]].copy())


def _distinct(sums: Sequence[Sums]) -> tuple[list[slice], Sums]:
    """What each lane reads of the sums of all: those that read the same share them."""
    known: dict[int, tuple[slice, Sums]] = {}
    begin = 0
    for one in sums:
        if id(one) not in known:
            known[id(one)] = slice(begin, begin + one.count), one
            begin += one.count
    parts = [part for _, part in known.values()]
    return [known[id(one)][0] for one in sums], parts[0] if len(parts) == 1 else Sums.together(parts)


def _slices(sizes: Sequence[int]) -> list[slice]:
    ends = np.cumsum(sizes).tolist()
    return [slice(end - size, end) for end, size in zip(ends, sizes, strict=True)]
