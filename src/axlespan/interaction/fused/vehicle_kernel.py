"""The vehicles in compiled steps.

Only to be imported where numba is. Indices are unsigned, since a signed one would be asked at each access whether it
counts from the end.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from axlespan.compiled import as_compiled
from axlespan.interaction.fused.banded_body import PIECE
from axlespan.interaction.fused.lane_vectors import plus, put, read, scaled

_EIGHT = (0,) * PIECE


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
