"""The loop that drives crossings side by side to their ends.

A lane that is finished leaves between two stretches, or idles along for a while where many steps are made at once.
A lane that fails leaves too, and the others repeat the stretch without it, so that nothing of it reaches them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Protocol

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.integrator import State
from axlespan.errors import AnalysisError
from axlespan.interaction.bodies import PreparedStructure
from axlespan.interaction.contact_system import Stretch
from axlespan.interaction.convoy import Convoy, Lane

FloatArray = npt.NDArray[np.float64]

# Lanes at their ends go along until they are so large a share; the compiled loop leaves out chunks of them.
_IDLE = 0.75

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

    def show(self, stretch: Stretch, k: int, *, states: bool) -> None:
        """Bring the convoy's bodies to step ``k``, the last one made, the structure's with or without its states."""
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
                leap.show(stretch, k, states=alone)
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
