"""Crossings of one structure that advance side by side, and the loop that drives them.

All lanes share the factored structure; each has its own train, speed, irregularity and length of run. A
lane that is finished leaves at the end of a stretch. A lane that fails leaves too, and the others repeat
the stretch without it, so that nothing of it reaches them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.integrator import State
from axlespan.errors import AnalysisError
from axlespan.interaction.bodies import FleetBody, PreparedStructure, StructureBody
from axlespan.interaction.contact_system import Stretch, stretch_of
from axlespan.interaction.plan import Fleet, Plan, joined
from axlespan.interaction.records.recorder import Recorder
from axlespan.interaction.records.sums import Sums
from axlespan.interaction.records.tape import LaneTape, Tape, Watched
from axlespan.interaction.start import Start

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Steps of a stretch, and the entries of contact systems and of contact rows that one may hold.
_STRETCH, _ENTRIES, _ROWS = 1024, 12_000_000, 4_000_000

# Lanes at their ends go along until they are so large a share.
_IDLE = 0.25

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
        n_step = max(16, min(_STRETCH, _ENTRIES // max(size, 1), often))
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


#: One step of a convoy; returns all contact forces (n_contact,) of the joint fleet.
Couple = Callable[[Convoy, Stretch, int, FloatArray | None], FloatArray]


class Leap(Protocol):
    """Makes many steps of a convoy at once, as its coupling would one by one."""

    #: Whether a stretch must bring contact systems.
    needs_systems: bool

    def go(self, stretch: Stretch, first: int, stop: int, external: FloatArray | None) -> None:
        """Make steps ``first`` to ``stop`` of a stretch under weighted factors (n_step, n_term), and write the tape."""
        ...

    def state_of(self, lane: int) -> State:
        """The structure of one lane at the last step made."""
        ...

    def show(self, stretch: Stretch, k: int, lanes: Sequence[int]) -> None:
        """Bring the convoy's bodies to step ``k``, the last one made; of the structure, the states of some lanes."""
        ...


#: How to make many steps at once, where a convoy allows it.
Leaper = Callable[[Convoy], Leap | None]


def drive(
    lanes: Sequence[Lane],
    prepared: PreparedStructure,
    couple: Couple,
    *,
    systems: bool = True,
    leaper: Leaper | None = None,
) -> None:
    """Advance all lanes to their ends; failed ones keep their error and what was computed.

    With several threads, each takes its share of the lanes, unless the factor's own solves use them.
    """
    threads = min(lanes[0].plan.settings.threads, len(lanes)) if lanes else 1
    if threads > 1 and prepared.integrator.factor.name != "pardiso":
        shares = [lanes[i * len(lanes) // threads : (i + 1) * len(lanes) // threads] for i in range(threads)]
        with ThreadPoolExecutor(threads) as pool:
            runs = [
                pool.submit(_drive, share, prepared.for_others(), couple, systems, leaper) for share in shares
            ]
        for run in runs:
            run.result()
        return
    _drive(lanes, prepared, couple, systems, leaper)


def _drive(
    lanes: Sequence[Lane],
    prepared: PreparedStructure,
    couple: Couple,
    systems: bool,
    leaper: Leaper | None,
) -> None:
    def formed(lanes: Sequence[Lane]) -> tuple[Convoy, Leap | None]:
        convoy = Convoy(lanes, prepared)
        return convoy, None if leaper is None else leaper(convoy)

    convoy, leap = formed(lanes)
    for i, lane in enumerate(lanes):
        # As the body holds it: a reduced basis has not all of a start in all d.o.f.
        lane.recorder.begin(convoy.structure.full(i), lane.fleet, lane.forces, lane.load)
    while True:
        with_systems = systems and (leap is None or leap.needs_systems)
        stretch = convoy.stretch(systems=with_systems, idle=leap is not None)
        failed, states = _make(convoy, stretch, couple, leap)
        if failed:
            staying = _without(convoy, failed)
        else:
            for i, lane in enumerate(convoy.lanes):
                if own := min(stretch.n_step, lane.left):
                    tape, positions = convoy.tape_of(i).upto(own), stretch.crossings[i].positions[:own]
                    lane.recorder.work_up(stretch.steps[:own], positions, tape)
            convoy.save(
                stretch.n_step, states or [convoy.structure.lane(i) for i in range(len(convoy.lanes))]
            )
            staying = convoy.lanes
        staying = [lane for lane in staying if lane.left]
        if not staying:
            return
        # A few lanes that are at their ends may idle along: forming a convoy anew has its price.
        idle = len(convoy.lanes) - len(staying)
        if failed or (idle and (leap is None or idle >= _IDLE * len(convoy.lanes))):
            convoy, leap = formed(staying)


def _states(convoy: Convoy, leap: Leap | None) -> list[State] | None:
    """The structure in all lanes, where a leap holds it; None where the bodies of the convoy do."""
    n = len(convoy.lanes)
    return None if leap is None or n == 1 else [leap.state_of(i) for i in range(n)]


def _make(
    convoy: Convoy, stretch: Stretch, couple: Couple, leap: Leap | None
) -> tuple[dict[int, tuple[int, str | None]], list[State] | None]:
    """Make the steps of a stretch; lanes that failed, with the step inside the stretch and a message; the states."""
    external, alone = convoy.external(stretch), len(convoy.lanes) == 1
    watching = [lane.recorder.watchers for lane in convoy.lanes]
    convoy.tape.start(stretch.n_step)
    message: str | None = None
    looks = {k for one in watching for k in one.between(stretch.first, stretch.n_step)}
    with np.errstate(over="ignore", invalid="ignore"):
        for k in range(stretch.n_step) if leap is None else sorted(looks | {stretch.n_step - 1}):
            try:
                if leap is None:
                    forces = couple(convoy, stretch, k, None if external is None else external[k])
                    convoy.tape.take(convoy.structure, convoy.fleet, forces)
                else:
                    leap.go(stretch, convoy.tape.filled, k + 1, external)
            except AnalysisError as error:
                message = str(error)
                break
            who = (
                [i for i, one in enumerate(watching) if one.looks_at(stretch.first + k)] if k in looks else []
            )
            if leap is not None:
                leap.show(stretch, k, [0] if alone else [])
            for i in who:
                state = convoy.structure.full(i) if leap is None or alone else leap.state_of(i)
                watching[i].look(stretch.first + k, *convoy.moment(i, state))
    own = {i: min(convoy.tape.filled, lane.left) for i, lane in enumerate(convoy.lanes) if lane.left}
    found: dict[int, tuple[int, str | None]] = {}
    if not convoy.tape.is_good(min(lane.recorder.largest_force for lane in convoy.lanes)):
        bad = {i: convoy.lanes[i].recorder.first_bad(convoy.tape_of(i).upto(n)) for i, n in own.items()}
        found = {i: (k, None) for i, k in bad.items() if k is not None}
    if found:
        earliest = min(k for k, _ in found.values())
        return {i: entry for i, entry in found.items() if entry[0] == earliest}, None
    if message is not None:
        cut_off = [i for i in own if convoy.lanes[i].left > convoy.tape.filled] or list(own)
        return dict.fromkeys(cut_off, (convoy.tape.filled, message)), None
    states = _states(convoy, leap)
    if convoy.fleet is not None:
        wheels, line = convoy.contact_at(stretch, stretch.n_step - 1, states)
        for i in own:
            at = convoy.coupled[i]
            convoy.lanes[i].recorder.compatibility.look(wheels[at], line[at])
    return {}, states


def _without(convoy: Convoy, failed: dict[int, tuple[int, str | None]]) -> list[Lane]:
    """Let failed lanes go, with their good steps kept; the others stand where they stood before the stretch."""
    for i, (k, message) in failed.items():
        lane, steps = convoy.lanes[i], convoy.lanes[i].done + 1 + np.arange(convoy.tape.filled)
        positions = lane.plan.rows.positions(lane.plan.times_of(steps))
        lane.error = lane.recorder.broken_off(steps, positions, convoy.tape_of(i), k, message)
    return [lane for i, lane in enumerate(convoy.lanes) if i not in failed]


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
