"""Consecutive steps with laws of contact and nonlinear springs in one compiled loop.

The loop of :mod:`axlespan.interaction.fused.kernel` for one crossing, with the interface of wheels and springs in place
of the contact system. A step that is out of the ordinary (a wheel on a one-sided contact lifts off or lands, no
convergence) is not made: the loop returns, and the coupling makes it. Only to be imported where numba is.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from axlespan.interaction.fused.kernel import (
    add_load,
    backward,
    eliminate,
    forward,
    on_ground,
    predict_fleet,
    take_fleet,
    write,
)
from axlespan.interaction.nonlinear.interface_kernel import (
    FORCE,
    FOUND,
    FREE,
    deviations,
    solve_interface,
)
from axlespan.interaction.nonlinear.law_codes import (
    COLUMN,
    DONE,
    LARGEST,
    ONE_SIDED,
    RIGID,
    SPRING_ROWS,
    UNUSUAL,
    WHEEL_ROWS,
)
from axlespan.linalg.compiled import as_compiled

# Rows of the springs' room: free elongation and rate, deviation, elongation and rate of the step, and three to work in.
_E_FREE, _RATE_FREE, _Q, _E, _RATE, _SOON, _BY_E, _BY_RATE = range(SPRING_ROWS)
# Rows of the wheels' room: gap, forces of the step before, approaches.
_GAP, _BEFORE, _APPROACH = range(WHEEL_ROWS)


@as_compiled
def _free_wheels(
    into: Any, place: Any, weights: Any, state: Any, x: Any, w: Any, late: Any, gap: Any
) -> None:
    """Add the line's displacements without the new forces to the gaps of wheels with rows (n_wheel, n_local)."""
    u, v, a = state
    dt, late_u, _, u_from_a, _ = late
    for r in range(len(into)):
        total = 0.0
        for m in range(place.shape[1]):
            if weights[r, m] != 0.0:
                i = np.uint64(place[r, m])
                total += weights[r, m] * (u[i] + (dt * v[i] + late_u * a[i]) + u_from_a * x[i + w])
        gap[into[r]] += total


@as_compiled
def _free_springs(springs: Any, memory: Any, state: Any, x: Any, w: Any, late: Any, room: Any) -> None:
    """Elongations and rates without the new forces; unknown are springs that deviate, or will if they go on so."""
    coded, at, B = springs[0], springs[1], springs[2]
    active, every, values = room
    u, v, a = state
    dt, late_u, late_v, u_from_a, v_from_a = late
    for s in range(len(active)):
        total, moving = 0.0, 0.0
        for m in range(at.shape[1]):
            i, entry = np.uint64(at[s, m]), B[s, m]
            new = x[i + w]
            total += entry * (u[i] + (dt * v[i] + late_u * a[i]) + u_from_a * new)
            moving += entry * ((v[i] + late_v * a[i]) + v_from_a * new)
        values[_E_FREE, s], values[_RATE_FREE, s] = total, moving
        values[_SOON, s] = memory[1, s] + dt * memory[2, s]
    deviations(
        every, 0, len(active), values[_SOON], memory[2], coded, values[_Q], values[_BY_E], values[_BY_RATE]
    )
    for s in range(len(active)):
        active[s] = memory[0, s] != 0.0 or values[_Q, s] != 0.0


@as_compiled
def _add_springs(springs: Any, q: Any, loads: Any, factor: float, shift: int, load: Any) -> Any:
    """Add what springs do that are said to load; the lowest place and the highest one that were loaded."""
    at, B = springs[1], springs[2]
    low, high = load.shape[0], -1
    for s in range(len(q)):
        if loads[s] and q[s] != 0.0:
            for m in range(at.shape[1]):
                if B[s, m] != 0.0:
                    i = at[s, m] + shift
                    load[np.uint64(i)] += B[s, m] * (factor * q[s])
                    low, high = min(low, i), max(high, i)
    return low, high


@as_compiled
def _solve(n: Any, n_wheel: Any, laws: Any, scale: float, rooms: Any, figures: Any) -> int:
    """Solve an interface, and keep the residuals of the slowest solution; iterations, or 0: no convergence."""
    slowest, counts = figures
    count: int = solve_interface(n, n_wheel, laws, scale, rooms)
    if count > counts[0]:
        counts[0] = count
        for i in range(count):
            slowest[i] = rooms[4][i]
    return count


@as_compiled
def _solve_apart(
    apart: Any, laws: Any, scale: float, rooms: Any, figures: Any, forces: Any, wheels: Any
) -> int:
    """Wheels of vehicles off the structure, one vehicle after the other; iterations, or -1: no convergence."""
    vehicles, starts, begin, blocks = apart
    S, _, names, vectors, _ = rooms
    most = 0
    for vehicle in vehicles:
        low = starts[vehicle]
        n = starts[vehicle + 1] - low
        for i in range(n):
            names[i], vectors[FREE, i], vectors[FORCE, i] = (
                low + i,
                wheels[_GAP, low + i],
                wheels[_BEFORE, low + i],
            )
            for j in range(n):
                S[i, j] = blocks[begin[vehicle] + i * n + j]
        count = _solve(n, n, laws, scale, rooms, figures)
        if count == 0:
            return -1
        most = max(most, count)
        for i in range(n):
            forces[low + i], wheels[_APPROACH, low + i] = vectors[FORCE, i], vectors[FOUND, i]
    return most


@as_compiled
def _assemble(
    system: Any, k: int, springs: Any, wheels_at: Any, weights: Any, into: Any, active: Any, rooms: Any
) -> Any:
    """Fill in compliance and names of wheels and active springs; how many there are, and nothing to wait for.

    Or -1, and the spring whose column is not there, counted from one; zero: there are too many.
    """
    contacts, matrices = system
    B, columns, at, there = springs[2], springs[3], springs[4], springs[5]
    S, names = rooms[0], rooms[2]
    w = len(contacts)
    for i in range(w):
        names[i] = contacts[i]
        for j in range(w):
            S[i, j] = matrices[(k * w + i) * w + j]
    n = w
    for s in range(len(active)):
        if active[s]:
            if not there[s]:
                return -1, s + 1
            if n - w == LARGEST:
                return -1, 0
            names[n] = s
            for i in range(w):
                S[i, n] = S[n, i] = 0.0
            n += 1
    for c in range(w, n):
        column = columns[names[c]]
        for i in range(len(into)):
            total = 0.0
            for m in range(weights.shape[1]):
                if weights[i, m] != 0.0:
                    total += weights[i, m] * column[np.uint64(wheels_at[i, m])]
            S[into[i], c] = S[c, into[i]] = total
        for r in range(w, c + 1):
            s, total = names[r], 0.0
            for m in range(at.shape[1]):
                total += B[s, m] * column[np.uint64(at[s, m])]
            S[r, c] = S[c, r] = total
    return n, 0


@as_compiled
def _solve_together(
    n: Any, contacts: Any, laws: Any, scale: float, rooms: Any, figures: Any, forces: Any, wheels: Any, values: Any
) -> int:  # fmt: skip
    """Wheels on the structure and active springs, from what is known of them on; iterations, or 0: no convergence."""
    names, vectors, w = rooms[2], rooms[3], len(contacts)
    for i in range(w):
        vectors[FREE, i], vectors[FORCE, i] = wheels[_GAP, contacts[i]], forces[contacts[i]]
    for i in range(w, n):
        vectors[FREE, i], vectors[FORCE, i] = values[_E_FREE, names[i]], values[_Q, names[i]]
    count: int = _solve(n, w, laws, scale, rooms, figures)
    if count:
        for i in range(w):
            forces[contacts[i]], wheels[_APPROACH, contacts[i]] = vectors[FORCE, i], vectors[FOUND, i]
        for i in range(w, n):
            values[_Q, names[i]] = vectors[FORCE, i]
    return count


@as_compiled
def _settle(springs: Any, added: Any, w: Any, u_from_a: float, rate_from_e: float, room: Any) -> bool:
    """Elongations with the response in ``added``; false where springs deviate that were left out: they are active now."""
    coded, at, B = springs[0], springs[1], springs[2]
    active, every, values = room
    settled = True
    for s in range(len(active)):
        moved = 0.0
        for m in range(at.shape[1]):
            moved += B[s, m] * added[np.uint64(at[s, m]) + w]
        moved *= u_from_a
        values[_E, s] = values[_E_FREE, s] + moved
        values[_RATE, s] = values[_RATE_FREE, s] + rate_from_e * moved
    q = values[_SOON]
    deviations(every, 0, len(active), values[_E], values[_RATE], coded, q, values[_BY_E], values[_BY_RATE])
    for s in range(len(active)):
        if q[s] != 0.0 and not active[s]:
            active[s], values[_Q, s], settled = True, q[s], False
    return settled


@as_compiled
def _clear(added: Any, reach: Any, shift: int) -> None:
    """Take a response out of ``added``."""
    for i in range(reach[0] + shift, reach[1] + shift):
        added[i] = 0.0
    reach[0] = reach[1] = 0


@as_compiled
def _respond(
    lanes: Any, width: Any, lower: Any, place: Any, weights: Any, into: Any, forces: Any, springs: Any, room: Any, wc: float,
    added: Any, reach: Any
) -> None:  # fmt: skip
    """Fill in the response of the structure to wheels and springs."""
    shift = len(width)
    low, high = add_load(place, weights, into, forces, -wc, shift, added)
    lower_one, higher_one = _add_springs(springs, room[2][_Q], room[0], -wc, shift, added)
    low, high = min(low, lower_one) - shift, max(high, higher_one) - shift + 1
    if high > low:
        end = eliminate(lanes, width, lower, added, low, high)
        reach[0], reach[1] = backward(lanes, width, lower, added, end, low), end


@as_compiled
def _remember(
    made: int, forces: Any, wheels: Any, laws: Any, room: Any, memory: Any, history: Any, flown: Any
) -> None:
    """Take over what a completed step leaves."""
    kinds, approaches = laws[0][0], laws[0][2]
    active, _, values = room
    for i in range(len(forces)):
        approaches[2, i], approaches[1, i] = approaches[1, i], approaches[0, i]
        closed = kinds[i] == RIGID or (kinds[i] == ONE_SIDED and forces[i] > 0.0)
        approaches[0, i] = 0.0 if closed else wheels[_APPROACH, i]
        flown[0, made, i], flown[1, made, i] = wheels[_GAP, i], approaches[0, i]
    for s in range(len(active)):
        memory[0, s] = values[_Q, s] if active[s] else 0.0
        memory[1, s], memory[2, s] = values[_E, s], values[_RATE, s]
        if history.shape[0]:
            history[made, s] = memory[0, s]


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
    u_from_a, rate_from_e = late[3], late[4] / late[3]
    wheels, room, rooms = work
    active, values = room[0], room[2]
    laws = (wheel_laws, springs[0], (values, rate_from_e))
    for k in range(first, stop):
        if forced:
            if k > first:  # before the first step, it is there already
                for i in range(len(extra)):
                    extra[i] = 0.0
                if wp != 0.0:
                    add_load(place[k - 1], weights[k - 1], into, forces, -wp, 0, extra)
                    add_load(known_place[k - 1], known_weights[k - 1], all_known, known_forces, -wp, 0, extra)
                    _add_springs(springs, last[0], active, -wp, 0, extra)
            add_load(known_place[k], known_weights[k], all_known, known_forces, -wc, 0, extra)
            for t in range(factors.shape[1]):
                if factors[k, t] != 0.0:
                    for i in range(vectors.shape[1]):
                        extra[i] += factors[k, t] * vectors[t, i]
        forward(
            lanes, width, p, late, state, x, added, reach, K, C, damped, lower, extra, forced, ring, ahead, k > first, True
        )  # fmt: skip
        if k > first:
            write(lanes, state, tape, k - 1)
        backward(lanes, width, lower, x, n, 0)
        _clear(added, reach, shift)
        apart_ones, iterations, needed, n_unknown = 0, 0, 0, 0
        if n_coupled:
            predict_fleet(fleet, p, late, wp, gaps[k], wheels[_GAP])
            _free_wheels(into, place[k], weights[k], state, x, w, late, wheels[_GAP])
            for i in range(n_coupled):
                wheels[_BEFORE, i], wheels[_APPROACH, i] = forces[i], 0.0
            on_ground(fleet, wheels[_GAP])
            apart_ones = _solve_apart(apart, laws, scale, rooms, figures, forces, wheels)
            for i in system[0]:
                forces[i] = wheels[_BEFORE, i]
        _free_springs(springs, last, state, x, w, late, room)
        usual = apart_ones >= 0
        while usual:
            n_unknown, needed = _assemble(system, k, springs, wheels_at[k], weights[k], among, active, rooms)
            count = 0
            if n_unknown > 0:
                count = _solve_together(
                    n_unknown, system[0], laws, scale, rooms, figures, forces, wheels, values
                )
            if n_unknown < 0 or (n_unknown > 0 and count == 0):
                usual = False
                break
            iterations += count
            _respond(
                lanes, width, lower, place[k], weights[k], into, forces, springs, room, wc, added, reach
            )  # fmt: skip
            if _settle(springs, added, w, u_from_a, rate_from_e, room):
                break
            _clear(added, reach, shift)
        for i in range(n_coupled):  # a wheel on a one-sided contact lifts off or lands
            usual = usual and (wheel_laws[0][i] != ONE_SIDED or touching[i] == (forces[i] > 0.0))
        if not usual:
            _clear(added, reach, shift)
            for i in range(n_coupled):
                forces[i] = wheels[_BEFORE, i]
            return k, COLUMN if needed > 0 else UNUSUAL, needed - 1
        _remember(k - first, forces, wheels, laws, room, last, history, flown)
        counts[k - first] = max(apart_ones, iterations)
        figures[1][1] = max(figures[1][1], n_unknown - len(system[0]))
        take_fleet(fleet, late, tape, k)
    forward(
        lanes, width, p, late, state, x, added, reach, K, C, damped, lower, extra, forced, ring, ahead, stop > first, False
    )  # fmt: skip
    write(lanes, state, tape, stop - 1)
    _clear(added, reach, shift)
    return stop, DONE, 0
