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
from axlespan.interaction.fused.banded_body import PIECE
from axlespan.interaction.fused.contact_kernel import fill_system, pack_rows, room_for, solve_system
from axlespan.interaction.fused.lane_vectors import plus, plus_size, put, read, scaled, total

_EIGHT = (0,) * PIECE
# A response to contact that is so much smaller than its largest value is none; asked every so many rows.
_NOTHING, _ROWS = 1e-22, 16


@as_compiled
def forward(
    lanes: Any, width: Any, p: Any, late: Any, state: Any, x: Any, added: Any, reach: Any, K: Any, C: Any, damped: bool,
    lower: Any, extra: Any, acting: Any, ring: Any, ahead: Any, completes: bool, goes_on: bool
) -> None:  # fmt: skip
    """Complete the step before, if it was made, and begin the next one, if there is one: L y = right-hand side.

    ``state`` holds u, u̇, ü; ``x`` accelerations of the step before, then y; ``added`` is what contact adds from row
    ``reach[0]`` to ``reach[1]``, as ``extra`` forces do from ``acting[0]`` to ``acting[1]``; ``ring`` predictions
    (1+α) ũ - α u and (1+α) ṽ - α u̇ of the latest rows.
    """
    L, w, zero, one = np.uint64(len(lanes)), np.uint64(len(width)), np.uint64(0), np.uint64(1)
    u, v, a = state
    mean_u, mean_v = ring
    mask = np.uint64(mean_u.shape[0] // len(lanes) - 1)
    starts, columns, entries = K
    c_starts, c_columns, c_entries = C
    n = np.uint64(starts.shape[0] - 1)
    dt, late_u, late_v, u_from_a, v_from_a = late
    u1, u2, u3, v2, v3 = p[2, 0], p[2, 1], p[2, 2], p[3, 1], p[3, 2]
    low, high = np.uint64(reach[0]), np.uint64(reach[1])
    acts, rests = np.uint64(acting[0]), np.uint64(acting[1])
    rows = n + np.uint64(ahead) if goes_on else n
    none = scaled(0.0, read(lanes, u, zero))
    last = none
    for i in range(rows):
        if i < n:
            at, into = i * L, (i & mask) * L
            if completes:
                u0, v0, a0, new = (
                    read(lanes, u, at),
                    read(lanes, v, at),
                    read(lanes, a, at),
                    read(lanes, x, at + w * L),
                )
                if low <= i and i < high:
                    new = plus(new, 1.0, read(lanes, added, at + w * L))
                put(u, at, plus(plus(u0, 1.0, plus(scaled(dt, v0), late_u, a0)), u_from_a, new))
                put(v, at, plus(plus(v0, late_v, a0), v_from_a, new))
                put(a, at, new)
            u0, v0, a0 = read(lanes, u, at), read(lanes, v, at), read(lanes, a, at)
            put(mean_u, into, plus(plus(scaled(u2, v0), u3, a0), u1, u0))
            put(mean_v, into, plus(scaled(v2, v0), v3, a0))
        if not goes_on or i < ahead:
            continue
        j = i - np.uint64(ahead)
        k = j + w
        t = read(lanes, extra, j * L) if acts <= j and j < rests else none
        for q in range(starts[j], starts[j + one]):
            t = plus(t, -entries[q], read(lanes, mean_u, (columns[q] & mask) * L))
        if damped:
            for q in range(c_starts[j], c_starts[j + one]):
                t = plus(t, -c_entries[q], read(lanes, mean_v, (c_columns[q] & mask) * L))
        for e in range(len(width) - 1):
            d = w - np.uint64(e)
            t = plus(t, -lower[j, d], read(lanes, x, (k - d) * L))
        last = plus(t, -lower[j, one], last)  # the newest row comes last: all wait for it
        put(x, k * L, last)


@as_compiled
def eliminate(lanes: Any, width: Any, lower: Any, x: Any, begin: Any, must: Any) -> Any:
    """L y = b in place from row ``begin`` on, at least to row ``must``; the row behind the last that is not nothing."""
    L, w, zero = np.uint64(len(lanes)), np.uint64(len(width)), np.uint64(0)
    n = np.uint64(lower.shape[0]) - w
    i, largest = np.uint64(begin), 0.0
    while i < n:
        stop = min(i + np.uint64(_ROWS), n)
        sizes = scaled(0.0, read(lanes, x, zero))
        for j in range(i, stop):
            k = j + w
            t = read(lanes, x, k * L)
            for e in range(len(width)):
                d = w - np.uint64(e)
                t = plus(t, -lower[j, d], read(lanes, x, (k - d) * L))
            put(x, k * L, t)
            sizes = plus_size(sizes, t)
        here = total(sizes)
        i, largest = stop, max(largest, here)
        if i > must and here <= _NOTHING * largest:
            break
    return i


@as_compiled
def backward(lanes: Any, width: Any, lower: Any, x: Any, end: Any, must: Any) -> Any:
    """Lᵀ x = D⁻¹ y in place from row ``end`` back, at least to row ``must``; the last row that is not nothing."""
    L, w, zero, one = np.uint64(len(lanes)), np.uint64(len(width)), np.uint64(0), np.uint64(1)
    i, largest, last = np.uint64(end), 0.0, read(lanes, x, (np.uint64(end) + w) * L)
    while i > zero:
        stop = i - min(i, np.uint64(_ROWS))
        sizes = scaled(0.0, read(lanes, x, zero))
        for r in range(i - stop):
            j = i - one - np.uint64(r)
            k = j + w
            t = scaled(lower[j, zero], read(lanes, x, k * L))
            for e in range(len(width) - 1):
                d = w - np.uint64(e)
                t = plus(t, -lower[j + d, d], read(lanes, x, (k + d) * L))
            last = plus(t, -lower[j + one, one], last)
            put(x, k * L, last)
            sizes = plus_size(sizes, last)
        here = total(sizes)
        i, largest = stop, max(largest, here)
        if i < must and here <= _NOTHING * largest:
            break
    return i


@as_compiled
def move_vehicles(
    first: Any, kind: Any, begin: Any, entries: Any, parts: int, p: Any, values: Any, work: Any, result: Any
) -> None:
    """Accelerations of vehicles, block after block, from their states (3, n) and the force in the last row of ``work``.

    Columns of a block of ``entries`` are padded to pieces; so ``result`` has room for a piece behind its end.
    """
    u, v, a = values[0], values[1], values[2]
    u1, u2, u3, v2, v3 = p[2, 0], p[2, 1], p[2, 2], p[3, 1], p[3, 2]
    mean_u, mean_v = work[0], work[1]
    for b in range(kind.shape[0]):
        low, high = first[b], first[b + 1]
        for i in range(low, high):
            mean_u[i] = u1 * u[i] + (u2 * v[i] + u3 * a[i])
        if parts == 3:
            for i in range(low, high):
                mean_v[i] = v2 * v[i] + v3 * a[i]
        padded = (high - low + PIECE - 1) // PIECE * PIECE
        for piece in range(0, padded, PIECE):
            at = begin[kind[b]] + piece
            sums = scaled(0.0, read(_EIGHT, entries, np.uint64(at)))
            none = sums
            for part in range(parts):
                own = none  # parts do not wait for one another
                for j in range(low, high):
                    own = plus(own, work[part, j], read(_EIGHT, entries, np.uint64(at)))
                    at += padded
                sums = plus(sums, 1.0, own)
            put(result, np.uint64(low + piece), sums)


@as_compiled
def march(
    lanes: Any, width: Any, numbers: Any, structure: Any, chunk: Any, wheels: Any, known: Any, external: Any, fleet: Any,
    systems: Any, tape: Any, first: int, stop: int
) -> int:  # fmt: skip
    """Make steps ``first`` to ``stop`` of a stretch; the step whose contact system is not positive definite, or ``stop``."""
    p, late, wc, wp = numbers
    K, C, damped, lower, ahead, n = structure
    state, x, added, extra, forced, ring, reach = chunk
    place, weights, into = wheels
    known_place, known_weights, known_forces = known
    vectors, factors = external
    forces, gaps, at_contacts = fleet[0], fleet[1], fleet[2]
    contacts, ends, wheel_ends, at, (compliance, compliance_begins, vehicles_reach), path = systems
    L, w = len(lanes), len(width) * len(lanes)
    gap = np.zeros(len(forces))
    most = 0
    for s in range(len(ends) - 1):
        most = max(most, ends[s + 1] - ends[s])
    S, b, within = np.zeros((most, most)), np.zeros(most), np.zeros(most, np.int64)
    room = room_for(place.shape[1], place.shape[2])
    one_by_one = np.arange(len(known_forces))
    for k in range(first, stop):
        acting = (0, n if forced and (k == 0 or factors.shape[1]) else 0)
        if forced:
            low, high = add_load(known_place[k], known_weights[k], one_by_one, known_forces, -wc, 0, extra)
            if k > 0 and wp != 0.0:  # before the first step of a stretch, it is there already
                low_p, high_p = add_load(place[k - 1], weights[k - 1], into, forces, -wp, 0, extra)
                low, high = min(low, low_p), max(high, high_p)
                low_p, high_p = add_load(
                    known_place[k - 1], known_weights[k - 1], one_by_one, known_forces, -wp, 0, extra
                )
                low, high = min(low, low_p), max(high, high_p)
            if acting[1] == 0 and high >= low:
                acting = (low // L, high // L + 1)
            for t in range(factors.shape[1]):
                if factors[k, t] != 0.0:
                    for i in range(vectors.shape[1]):
                        for c in range(L):
                            extra[i * L + c] += factors[k, t] * vectors[t, i]
        forward(
            lanes, width, p, late, state, x, added, reach, K, C, damped, lower, extra, acting, ring, ahead, k > first, True
        )  # fmt: skip
        if forced:
            if factors.shape[1] or k == 0:
                extra[:] = 0.0
            else:
                clear(place[k - 1], weights[k - 1], extra)
                clear(known_place[k - 1], known_weights[k - 1], extra)
                clear(known_place[k], known_weights[k], extra)
        if k > first:
            write(lanes, state, tape, k - 1)
        backward(lanes, width, lower, x, n, 0)
        added[reach[0] * L + w : reach[1] * L + w] = 0.0
        reach[:] = 0
        if at_contacts[1] > at_contacts[0]:
            predict_fleet(fleet, p, late, wp, gaps[k], gap)
            add_line(place[k], weights[k], into, late, state, x, w, gap)
            on_ground(fleet, gap)
            pack_rows(lanes, place[k], weights[k], path, room)
            for s in range(len(ends) - 1):
                own, here = contacts[ends[s] : ends[s + 1]], (wheel_ends[s], wheel_ends[s + 1])
                for i in range(len(own)):
                    b[i] = gap[own[i]]
                own_vehicles = (compliance, vehicles_reach, ends[s])
                fill_system(here, at, compliance_begins[s], len(own), own_vehicles, path, room, S, within)
                if not solve_system(S, within, len(own), b):
                    return k
                for i in range(len(own)):
                    forces[own[i]] = b[i]
            low, high = add_load(place[k], weights[k], into, forces, -wc, w, added)
            if high >= low:
                low, high = low // L - len(width), high // L - len(width) + 1
                end = eliminate(lanes, width, lower, added, low, high)
                reach[0], reach[1] = backward(lanes, width, lower, added, end, low), end
            take_fleet(fleet, late, tape, k)
    forward(
        lanes, width, p, late, state, x, added, reach, K, C, damped, lower, extra, (0, 0), ring, ahead, True, False
    )  # fmt: skip
    write(lanes, state, tape, stop - 1)
    added[reach[0] * L + w : reach[1] * L + w] = 0.0
    reach[:] = 0
    return stop


@as_compiled
def add_line(place: Any, weights: Any, into: Any, late: Any, state: Any, x: Any, w: int, gap: Any) -> None:
    """Add to the gaps what the line does under wheels with rows (n_wheel, n_local) without new contact forces."""
    dt, late_u, _, u_from_a, _ = late
    u, v, a = state
    for r in range(len(into)):
        height = 0.0
        for m in range(place.shape[1]):
            if weights[r, m] != 0.0:
                i = np.uint64(place[r, m])
                height += weights[r, m] * (
                    u[i] + (dt * v[i] + late_u * a[i]) + u_from_a * x[i + np.uint64(w)]
                )
        gap[into[r]] += height


@as_compiled
def clear(place: Any, weights: Any, load: Any) -> None:
    """Take away what wheels with rows (n_wheel, n_local) have loaded."""
    for r in range(place.shape[0]):
        for m in range(place.shape[1]):
            if weights[r, m] != 0.0:
                load[np.uint64(place[r, m])] = 0.0


@as_compiled
def add_load(place: Any, weights: Any, into: Any, forces: Any, factor: float, shift: int, load: Any) -> Any:
    """Add loads of wheels with rows (n_wheel, n_local); the lowest place and the highest one that were loaded."""
    low, high = load.shape[0], -1
    for r in range(len(into)):
        scaled = factor * forces[into[r]]
        for m in range(place.shape[1]):
            if weights[r, m] != 0.0:
                at = place[r, m] + shift
                load[np.uint64(at)] += weights[r, m] * scaled
                low, high = min(low, at), max(high, at)
    return low, high


@as_compiled
def predict_fleet(fleet: Any, p: Any, late: Any, wp: float, gaps: Any, gap: Any) -> None:
    """Vehicles without the new contact forces; ``gap`` is that under their wheels on level ground."""
    forces, _, at_contacts, at_dofs, values, work, result, static, dofs, blocks, _, _, _ = fleet
    first, kind, begin, entries = blocks
    dt, late_u, _, u_from_a, _ = late
    parts = work.shape[0]
    for i in range(at_dofs[0], at_dofs[1]):
        work[parts - 1, i] = 0.0
    for i in range(at_contacts[0], at_contacts[1]):
        work[parts - 1, dofs[i]] = wp * forces[i] - static[i]
    move_vehicles(first, kind, begin, entries, parts, p, values, work, result)
    for i in range(at_contacts[0], at_contacts[1]):
        d = dofs[i]
        gap[i] = gaps[i] - (values[0, d] + (dt * values[1, d] + late_u * values[2, d]) + u_from_a * result[d])


@as_compiled
def on_ground(fleet: Any, gap: Any) -> None:
    """Forces of all wheels as if the ground were rigid."""
    forces, at_contacts, stiffness = fleet[0], fleet[2], fleet[10]
    starts, columns, entries = stiffness
    for i in range(at_contacts[0], at_contacts[1]):
        total = 0.0
        for q in range(starts[i], starts[i + 1]):
            total += entries[q] * gap[columns[q]]
        forces[i] = total


@as_compiled
def take_fleet(fleet: Any, late: Any, tape: Any, k: int) -> None:
    """Vehicles with the new contact forces; write them down."""
    forces, _, at_contacts, at_dofs, values, _, result, _, _, _, _, responses, coupled = fleet
    starts, columns, entries = responses
    dt, late_u, late_v, u_from_a, v_from_a = late
    on_tape, forces_on_tape = tape[2], tape[3]
    u, v, a = values[0], values[1], values[2]
    u_on, v_on, a_on = on_tape[k, 0], on_tape[k, 1], on_tape[k, 2]
    for i in range(at_dofs[0], at_dofs[1]):
        new = result[i]
        for q in range(starts[i], starts[i + 1]):
            new += entries[q] * forces[columns[q]]
        u_new = (u[i] + (dt * v[i] + late_u * a[i])) + u_from_a * new
        v_new = (v[i] + late_v * a[i]) + v_from_a * new
        u[i], v[i], a[i] = u_new, v_new, new
        u_on[i], v_on[i], a_on[i] = u_new, v_new, new
    for i in range(at_contacts[0], at_contacts[1]):
        forces_on_tape[k, coupled[i]] = forces[i]


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
