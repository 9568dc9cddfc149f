"""What a compiled step does with wheels and springs: their free coordinates, the interface, and what is left of it.

Only to be imported where numba is.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from axlespan.compiled import as_compiled
from axlespan.interaction.nonlinear.interface_kernel import FORCE, FOUND, FREE, deviations, solve_interface
from axlespan.interaction.nonlinear.law_codes import LARGEST, ONE_SIDED, RIGID, SPRING_ROWS, WHEEL_ROWS

# Rows of the springs' room: elongation and rate without new forces (read by the interface), deviation, elongation and
# rate of the step, and three to work in.
_E_FREE, _RATE_FREE, DEVIATION, _E, _RATE, _SOON, _BY_E, _BY_RATE = range(SPRING_ROWS)
# Rows of the wheels' room: gap, forces of the step before, approaches.
GAP, BEFORE, APPROACH = range(WHEEL_ROWS)


@as_compiled
def free_springs(springs: Any, memory: Any, state: Any, x: Any, w: Any, late: Any, room: Any) -> None:
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
        every,
        0,
        len(active),
        values[_SOON],
        memory[2],
        coded,
        values[DEVIATION],
        values[_BY_E],
        values[_BY_RATE],
    )
    for s in range(len(active)):
        active[s] = memory[0, s] != 0.0 or values[DEVIATION, s] != 0.0


@as_compiled
def add_springs(springs: Any, q: Any, loads: Any, factor: float, shift: int, load: Any) -> Any:
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
def solve_apart(
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
                wheels[GAP, low + i],
                wheels[BEFORE, low + i],
            )
            for j in range(n):
                S[i, j] = blocks[begin[vehicle] + i * n + j]
        count = _solve(n, n, laws, scale, rooms, figures)
        if count == 0:
            return -1
        most = max(most, count)
        for i in range(n):
            forces[low + i], wheels[APPROACH, low + i] = vectors[FORCE, i], vectors[FOUND, i]
    return most


@as_compiled
def assemble(
    system: Any, k: int, springs: Any, wheels_at: Any, weights: Any, into: Any, active: Any, rooms: Any
) -> Any:
    """Fill in compliance and names of wheels and active springs; how many there are, and nothing to wait for.

    Or -1, and the spring whose column is not there, counted from one; zero: there are too many.
    """
    contacts, matrices = system
    B, columns, at, slot = springs[2], springs[3], springs[4], springs[5]
    S, names = rooms[0], rooms[2]
    w = len(contacts)
    for i in range(w):
        names[i] = contacts[i]
        for j in range(w):
            S[i, j] = matrices[(k * w + i) * w + j]
    n = w
    for s in range(len(active)):
        if active[s]:
            if slot[s] < 0:
                return -1, s + 1
            if n - w == LARGEST:
                return -1, 0
            names[n] = s
            for i in range(w):
                S[i, n] = S[n, i] = 0.0
            n += 1
    for c in range(w, n):
        column = columns[slot[names[c]]]
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
def solve_together(
    n: Any, contacts: Any, laws: Any, scale: float, rooms: Any, figures: Any, forces: Any, wheels: Any, values: Any
) -> int:  # fmt: skip
    """Wheels on the structure and active springs, from what is known of them on; iterations, or 0: no convergence."""
    names, vectors, w = rooms[2], rooms[3], len(contacts)
    for i in range(w):
        vectors[FREE, i], vectors[FORCE, i] = wheels[GAP, contacts[i]], forces[contacts[i]]
    for i in range(w, n):
        vectors[FREE, i], vectors[FORCE, i] = values[_E_FREE, names[i]], values[DEVIATION, names[i]]
    count: int = _solve(n, w, laws, scale, rooms, figures)
    if count:
        for i in range(w):
            forces[contacts[i]], wheels[APPROACH, contacts[i]] = vectors[FORCE, i], vectors[FOUND, i]
        for i in range(w, n):
            values[DEVIATION, names[i]] = vectors[FORCE, i]
    return count


@as_compiled
def settle(springs: Any, added: Any, w: Any, u_from_a: float, rate_from_e: float, room: Any) -> bool:
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
            active[s], values[DEVIATION, s], settled = True, q[s], False
    return settled


@as_compiled
def remember(
    made: int, forces: Any, wheels: Any, laws: Any, room: Any, memory: Any, history: Any, flown: Any
) -> None:
    """Take over what a completed step leaves."""
    kinds, approaches = laws[0][0], laws[0][2]
    active, _, values = room
    for i in range(len(forces)):
        approaches[2, i], approaches[1, i] = approaches[1, i], approaches[0, i]
        closed = kinds[i] == RIGID or (kinds[i] == ONE_SIDED and forces[i] > 0.0)
        approaches[0, i] = 0.0 if closed else wheels[APPROACH, i]
        flown[0, made, i], flown[1, made, i] = wheels[GAP, i], approaches[0, i]
    for s in range(len(active)):
        memory[0, s] = values[DEVIATION, s] if active[s] else 0.0
        memory[1, s], memory[2, s] = values[_E, s], values[_RATE, s]
        if history.shape[0]:
            history[made, s] = memory[0, s]
