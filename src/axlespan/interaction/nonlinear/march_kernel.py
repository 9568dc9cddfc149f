"""Consecutive steps with laws of contact and nonlinear springs in one compiled loop.

The loop of :mod:`axlespan.interaction.fused.march_kernel` for one crossing, with the interface of wheels and springs in place
of the contact system. A step that is out of the ordinary (a wheel on a one-sided contact lifts off or lands, no
convergence) is not made: the loop returns, and the coupling makes it. Only to be imported where numba is.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from axlespan.compiled import as_compiled
from axlespan.interaction.fused.line_kernel import add_line, add_load, standing
from axlespan.interaction.fused.march_kernel import write
from axlespan.interaction.fused.structure_kernel import backward, eliminate, forward
from axlespan.interaction.fused.vehicle_kernel import on_ground, predict_fleet, take_fleet
from axlespan.interaction.nonlinear.law_codes import COLUMN, DONE, ONE_SIDED, UNUSUAL
from axlespan.interaction.nonlinear.step_kernel import (
    APPROACH,
    BEFORE,
    DEVIATION,
    GAP,
    add_springs,
    assemble,
    free_springs,
    remember,
    settle,
    solve_apart,
    solve_together,
)


@as_compiled
def _clear(added: Any, reach: Any, shift: int) -> None:
    """Take a response out of ``added``."""
    for i in range(reach[0] + shift, reach[1] + shift):
        added[i] = 0.0
    reach[0] = reach[1] = 0


@as_compiled
def _respond(
    lanes: Any, width: Any, lower: Any, on: Any, place: Any, weights: Any, into: Any, forces: Any, springs: Any, room: Any,
    wc: float, added: Any, reach: Any
) -> None:  # fmt: skip
    """Fill in the response of the structure to wheels and springs."""
    shift = len(width)
    low, high = add_load(on, place, weights, into, forces, -wc, shift, added)
    lower_one, higher_one = add_springs(springs, room[2][DEVIATION], room[0], -wc, shift, added)
    low, high = min(low, lower_one) - shift, max(high, higher_one) - shift + 1
    if high > low:
        end = eliminate(lanes, width, lower, added, low, high)
        reach[0], reach[1] = backward(lanes, width, lower, added, end, low), end


@as_compiled
def march(
    lanes: Any, width: Any, numbers: Any, structure: Any, chunk: Any, rows: Any, known: Any, external: Any, fleet: Any,
    system: Any, tape: Any, interface: Any, springs: Any, memory: Any, figures: Any, work: Any, first: int, stop: int
) -> Any:  # fmt: skip
    """Make steps ``first`` to ``stop`` of a stretch; the first step that was not made, why, and the spring that it needs."""
    p, late, wc, wp = numbers
    K, C, damped, lower, ahead, n = structure
    state, x, added, extra, forced, ring, reach = chunk
    place, weights, into, wheels_at, among = rows
    known_place, known_weights, known_forces = known
    vectors, factors = external
    forces, gaps, n_coupled = fleet[0], fleet[1], fleet[2][1]
    wheel_laws, touching, apart, scale = interface
    last, counts, history, flown = memory
    shift, w, all_known = len(width), np.uint64(len(width)), np.arange(len(known_forces))
    on = np.zeros(len(into), np.int64)
    u_from_a, rate_from_e = late[3], late[4] / late[3]
    wheels, room, rooms = work
    active, values = room[0], room[2]
    laws = (wheel_laws, springs[0], (values, rate_from_e))
    for k in range(first, stop):
        acting = (0, n if forced else 0)
        if forced:
            if k > first:  # before the first step, it is there already
                for i in range(len(extra)):
                    extra[i] = 0.0
                if wp != 0.0:
                    before = on[: standing(weights[k - 1], on)]
                    add_load(before, place[k - 1], weights[k - 1], into, forces, -wp, 0, extra)
                    add_load(
                        all_known, known_place[k - 1], known_weights[k - 1], all_known, known_forces, -wp, 0, extra
                    )  # fmt: skip
                    add_springs(springs, last[0], active, -wp, 0, extra)
            add_load(all_known, known_place[k], known_weights[k], all_known, known_forces, -wc, 0, extra)
            for t in range(factors.shape[1]):
                if factors[k, t] != 0.0:
                    for i in range(vectors.shape[1]):
                        extra[i] += factors[k, t] * vectors[t, i]
        forward(
            lanes, width, p, late, state, x, added, reach, K, C, damped, lower, extra, acting, ring, ahead, k > first, True
        )  # fmt: skip
        if k > first:
            write(lanes, state, tape, k - 1)
        backward(lanes, width, lower, x, n, 0)
        _clear(added, reach, shift)
        apart_ones, iterations, needed, n_unknown = 0, 0, 0, 0
        now = on[: standing(weights[k], on)]
        if n_coupled:
            predict_fleet(fleet, p, late, wp, gaps[k], wheels[GAP])
            add_line(now, place[k], weights[k], into, late, state, x, w, wheels[GAP])
            for i in range(n_coupled):
                wheels[BEFORE, i], wheels[APPROACH, i] = forces[i], 0.0
            on_ground(fleet, wheels[GAP])
            apart_ones = solve_apart(apart, laws, scale, rooms, figures, forces, wheels)
            for i in system[0]:
                forces[i] = wheels[BEFORE, i]
        free_springs(springs, last, state, x, w, late, room)
        usual = apart_ones >= 0
        while usual:
            n_unknown, needed = assemble(system, k, springs, wheels_at[k], weights[k], among, active, rooms)
            count = 0
            if n_unknown > 0:
                count = solve_together(
                    n_unknown, system[0], laws, scale, rooms, figures, forces, wheels, values
                )
            if n_unknown < 0 or (n_unknown > 0 and count == 0):
                usual = False
                break
            iterations += count
            _respond(
                lanes, width, lower, now, place[k], weights[k], into, forces, springs, room, wc, added, reach
            )  # fmt: skip
            if settle(springs, added, w, u_from_a, rate_from_e, room):
                break
            _clear(added, reach, shift)
        for i in range(n_coupled):  # a wheel on a one-sided contact lifts off or lands
            usual = usual and (wheel_laws[0][i] != ONE_SIDED or touching[i] == (forces[i] > 0.0))
        if not usual:
            _clear(added, reach, shift)
            for i in range(n_coupled):
                forces[i] = wheels[BEFORE, i]
            return k, COLUMN if needed > 0 else UNUSUAL, needed - 1
        remember(k - first, forces, wheels, laws, room, last, history, flown)
        counts[k - first] = max(apart_ones, iterations)
        figures[1][1] = max(figures[1][1], n_unknown - len(system[0]))
        take_fleet(fleet, late, tape, k)
    forward(
        lanes, width, p, late, state, x, added, reach, K, C, damped, lower, extra, (0, 0), ring, ahead, stop > first, False
    )  # fmt: skip
    write(lanes, state, tape, stop - 1)
    _clear(added, reach, shift)
    return stop, DONE, 0
