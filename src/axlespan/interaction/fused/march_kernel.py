"""Consecutive steps of the direct method in one compiled loop, for structures of narrow band and vehicles in blocks.

The same steps as :func:`axlespan.interaction.march.couple_directly`, with the structure in its order of elimination
and ``len(lanes)`` crossings innermost in memory. What would be eight passes over the state are two: *forward*
completes a row of the step before, predicts it, and eliminates the row that its prediction was waited for; *backward*
substitutes. The second solve, for the response to contact, stays where the wheels are.

Only to be imported where numba is. Tuples ``lanes`` and ``width`` give their lengths to the compiler; indices are
unsigned, since a signed one would be asked at each access whether it counts from the end.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from axlespan.compiled import as_compiled
from axlespan.interaction.fused.alike_kernel import (
    exchange,
    on_ground_alike,
    predict_alike,
    take_alike,
)
from axlespan.interaction.fused.contact_kernel import fill_system, pack_rows, room_for, solve_system
from axlespan.interaction.fused.lane_vectors import plus, put, read, scaled
from axlespan.interaction.fused.line_kernel import add_line, add_load, clear, standing
from axlespan.interaction.fused.modal_kernel import (
    add_modal_line,
    damp,
    find_modes,
    room_for_modes,
    subtract_modes,
    take_modes,
    undamp,
)
from axlespan.interaction.fused.structure_kernel import backward, eliminate, forward
from axlespan.interaction.fused.vehicle_kernel import on_ground, predict_fleet, take_fleet


@as_compiled
def march(
    lanes: Any, width: Any, numbers: Any, structure: Any, chunk: Any, wheels: Any, known: Any, external: Any, fleet: Any,
    alike: Any, modal: Any, systems: Any, tape: Any, first: int, stop: int
) -> int:  # fmt: skip
    """Make steps ``first`` to ``stop`` of a stretch; the step whose contact system is not positive definite, or ``stop``.

    ``alike`` are the vehicles of equal trains side by side; None: each of the fleet goes by itself. ``modal`` is damping
    of modes; None: there is none.
    """
    p, late, wc, wp = numbers
    K, C, damped, lower, ahead, n = structure
    state, x, added, extra, forced, ring, reach = chunk
    place, weights, into = wheels
    known_place, known_weights, known_forces = known
    vectors, factors = external
    gaps, at_contacts = fleet[1], fleet[2]
    contacts, ends, wheel_ends, at, (compliance, compliance_begins, vehicles_reach), path = systems
    L, w, count = len(lanes), len(width) * len(lanes), 0
    if alike is None:
        forces = fleet[0]
        gap = np.zeros(len(forces))
    else:
        forces, gap = alike[0], alike[1]
        exchange(lanes, fleet, alike, True)
    most = 0
    for s in range(len(ends) - 1):
        most = max(most, ends[s + 1] - ends[s])
    S, b, within = np.zeros((most, most)), np.zeros(most), np.zeros(most, np.int64)
    room = room_for(place.shape[1], place.shape[2])
    if modal is not None:
        rows, U = modal[0], modal[1]
        modal_room = room_for_modes(lanes, len(rows), U.shape[1], len(into))
    one_by_one = np.arange(len(known_forces))
    # Wheels and moving forces on the line, at this step and at the one before.
    on, on_p = np.zeros(len(into), np.int64), np.zeros(len(into), np.int64)
    here, here_p = np.zeros(len(known_forces), np.int64), np.zeros(len(known_forces), np.int64)
    n_on_p = standing(weights[first - 1], on_p) if first > 0 else 0
    n_here_p = standing(known_weights[first - 1], here_p) if first > 0 else 0
    for k in range(first, stop):
        n_on, n_here = standing(weights[k], on), standing(known_weights[k], here)
        now = on[:n_on]
        acting = (
            (0, n) if forced and (k == 0 or factors.shape[1]) else (n, 0)
        )  # rows of extra forces; or none
        if forced:
            low, high = add_load(
                here[:n_here], known_place[k], known_weights[k], one_by_one, known_forces, -wc, 0, extra
            )
            if k > 0 and wp != 0.0:  # before the first step of a stretch, it is there already
                low_p, high_p = add_load(
                    on_p[:n_on_p], place[k - 1], weights[k - 1], into, forces, -wp, 0, extra
                )
                low, high = min(low, low_p), max(high, high_p)
                low_p, high_p = add_load(
                    here_p[:n_here_p], known_place[k - 1], known_weights[k - 1], one_by_one, known_forces, -wp, 0, extra
                )  # fmt: skip
                low, high = min(low, low_p), max(high, high_p)
            if acting[1] == 0 and high >= low:
                acting = (low // L, high // L + 1)
            for t in range(factors.shape[1]):
                if factors[k, t] != 0.0:
                    for i in range(vectors.shape[1]):
                        for c in range(L):
                            extra[i * L + c] += factors[k, t] * vectors[t, i]
        if modal is not None:
            damp(lanes, len(width), modal, modal_room, p, late, state, x, added, reach, k > first, extra)
            acting = (min(acting[0], rows[0]), max(acting[1], rows[-1] + 1))
        forward(
            lanes, width, p, late, state, x, added, reach, K, C, damped, lower, extra, acting, ring, ahead, k > first, True
        )  # fmt: skip
        if modal is not None:
            undamp(lanes, rows, extra)
        if forced:
            if factors.shape[1] or k == 0:
                extra[:] = 0.0
            else:
                clear(on_p[:n_on_p], place[k - 1], weights[k - 1], extra)
                clear(here_p[:n_here_p], known_place[k - 1], known_weights[k - 1], extra)
                clear(here[:n_here], known_place[k], known_weights[k], extra)
        if k > first:
            write(lanes, state, tape, k - 1)
        backward(lanes, width, lower, x, n, 0)
        added[reach[0] * L + w : reach[1] * L + w] = 0.0
        reach[:] = 0
        low, high = len(added), -1
        if modal is not None:
            find_modes(lanes, len(width), modal, modal_room, x)
        if at_contacts[1] > at_contacts[0]:
            if alike is None:
                predict_fleet(fleet, p, late, wp, gaps[k], gap)
            else:
                predict_alike(lanes, alike, p, late, wp, gaps[k])
            add_line(now, place[k], weights[k], into, late, state, x, w, gap)
            if modal is not None:
                add_modal_line(
                    lanes, now, place[k], weights[k], into, path[0], modal, modal_room, late[3], gap
                )
            if alike is None:
                on_ground(fleet, gap)
            else:
                on_ground_alike(lanes, alike)
            pack_rows(lanes, now, place[k], weights[k], path, room)
            count = 0
            for s in range(len(ends) - 1):
                own, begin = contacts[ends[s] : ends[s + 1]], count
                while count < n_on and now[count] < wheel_ends[s + 1]:
                    count += 1
                for i in range(len(own)):
                    b[i] = gap[own[i]]
                own_vehicles = (compliance, vehicles_reach, ends[s])
                fill_system(
                    now[begin:count], at, compliance_begins[s], len(own), own_vehicles, path, room, S, within
                )
                if not solve_system(S, within, len(own), b):
                    if alike is not None:
                        exchange(lanes, fleet, alike, False)
                    return k
                for i in range(len(own)):
                    forces[own[i]] = b[i]
            low, high = add_load(now, place[k], weights[k], into, forces, -wc, w, added)
            if modal is not None:
                take_modes(lanes, now, into, forces, wc, modal, modal_room)
            if alike is None:
                take_fleet(fleet, late, tape, k)
            else:
                take_alike(lanes, alike, late, fleet[12], tape, k)
        if modal is not None:
            subtract_modes(lanes, rows, U, modal_room[2], len(width), added)
            low, high = min(low, rows[0] * L + w), max(high, rows[-1] * L + w)
        if high >= low:
            low, high = low // L - len(width), high // L - len(width) + 1
            end = eliminate(lanes, width, lower, added, low, high)
            reach[0], reach[1] = backward(lanes, width, lower, added, end, low), end
        on, on_p, n_on_p = on_p, on, n_on
        here, here_p, n_here_p = here_p, here, n_here
    forward(
        lanes, width, p, late, state, x, added, reach, K, C, damped, lower, extra, (0, 0), ring, ahead, True, False
    )  # fmt: skip
    write(lanes, state, tape, stop - 1)
    added[reach[0] * L + w : reach[1] * L + w] = 0.0
    reach[:] = 0
    if alike is not None:
        exchange(lanes, fleet, alike, False)
    return stop


@as_compiled
def write(lanes: Any, state: Any, tape: Any, k: int) -> None:
    """Write down what is watched of the structure after a step: d.o.f., and sums over all."""
    near, rows, _, _, sums, (into_sum, of, ends, at, values, room), lane = tape
    u, v, a = state
    L = np.uint64(len(lanes))
    n = len(rows)
    used = min(len(lanes), sums.shape[0] - lane)
    for c in range(used):
        into = (lane + c) * n
        for i in range(n):
            where = np.uint64(rows[i]) * L + np.uint64(c)
            near[k, 0, into + i], near[k, 1, into + i], near[k, 2, into + i] = u[where], v[where], a[where]
    for s in range(len(room)):
        room[s] = 0.0
    for s in range(len(of)):
        source = u if of[s] == 0 else (v if of[s] == 1 else a)
        t0 = scaled(0.0, read(lanes, u, np.uint64(0)))  # four sums that do not wait for one another
        t1, t2, t3, more = t0, t0, t0, ends[s]
        while more + 4 <= ends[s + 1]:
            t0 = plus(t0, values[more], read(lanes, source, at[more] * L))
            t1 = plus(t1, values[more + 1], read(lanes, source, at[more + 1] * L))
            t2 = plus(t2, values[more + 2], read(lanes, source, at[more + 2] * L))
            t3 = plus(t3, values[more + 3], read(lanes, source, at[more + 3] * L))
            more += 4
        while more < ends[s + 1]:
            t0 = plus(t0, values[more], read(lanes, source, at[more] * L))
            more += 1
        into = np.uint64(into_sum[s]) * L
        put(room, into, plus(plus(plus(t0, 1.0, t1), 1.0, plus(t2, 1.0, t3)), 1.0, read(lanes, room, into)))
    for c in range(used):
        for s in range(sums.shape[1]):
            sums[lane + c, s, k] = room[s * len(lanes) + c]
