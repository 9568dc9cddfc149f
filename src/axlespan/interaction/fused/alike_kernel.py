"""Vehicles of equal trains side by side in compiled steps: what one does, all lanes do in the same instructions.

The arrays of :class:`axlespan.interaction.fused.alike.AlikeTrains` are flat, with the lanes innermost. Only to be
imported where numba is. Indices are unsigned, since a signed one would be asked at each access whether it counts from
the end.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from axlespan.compiled import as_compiled
from axlespan.interaction.fused.banded_body import PIECE
from axlespan.interaction.fused.lane_vectors import plus, put, read, scaled

# Rows of a vehicle's matrix at a time; they share what they read of the state. A part of :data:`PIECE`.
_TOGETHER = 4


@as_compiled
def exchange(lanes: Any, fleet: Any, alike: Any, inward: bool) -> None:
    """Copy states (3, n) and contact forces from the fleet, or to it."""
    L, values, every_force = len(lanes), fleet[4], fleet[0]
    forces, state, (first_dofs, first_contacts), n_dof = alike[0], alike[2], alike[10], alike[11]
    for c in range(len(first_dofs)):
        for which in range(3):
            own = state[which]
            for i in range(n_dof):
                if inward:
                    own[i * L + c] = values[which, first_dofs[c] + i]
                else:
                    values[which, first_dofs[c] + i] = own[i * L + c]
        for i in range(len(forces) // L):
            if inward:
                forces[i * L + c] = every_force[first_contacts[c] + i]
            else:
                every_force[first_contacts[c] + i] = forces[i * L + c]


@as_compiled
def predict_alike(lanes: Any, alike: Any, p: Any, late: Any, wp: float, gaps: Any) -> None:
    """Vehicles without the new contact forces, and the gaps under their wheels on level ground."""
    forces, gap, (u, v, a), work, result, static, dofs, blocks, _, _, (_, first_contacts), n_dof = alike
    L, n, zero = np.uint64(len(lanes)), np.uint64(n_dof), np.uint64(0)
    dt, late_u, _, u_from_a, _ = late
    parts = len(work) // max(len(u), 1)
    none = scaled(0.0, read(lanes, result, zero))
    force = np.uint64(parts - 1) * n
    for i in range(n):
        put(work, (force + i) * L, none)
    for i in range(len(dofs)):
        at = np.uint64(i) * L
        acting = plus(scaled(wp, read(lanes, forces, at)), -1.0, read(lanes, static, at))
        put(work, (force + np.uint64(dofs[i])) * L, acting)
    _move(lanes, blocks, parts, p, (u, v, a), n_dof, work, result)
    for c in range(len(first_contacts)):
        for i in range(len(dofs)):
            gap[i * len(lanes) + c] = gaps[first_contacts[c] + i]
    for i in range(len(dofs)):
        at, d = np.uint64(i) * L, np.uint64(dofs[i]) * L
        ahead = plus(plus(read(lanes, u, d), dt, read(lanes, v, d)), late_u, read(lanes, a, d))
        ahead = plus(ahead, u_from_a, read(lanes, result, d))
        put(gap, at, plus(read(lanes, gap, at), -1.0, ahead))


@as_compiled
def _move(
    lanes: Any, blocks: Any, parts: int, p: Any, state: Any, n_dof: int, work: Any, result: Any
) -> None:
    """Accelerations of vehicles, block after block, from states and the force in the last part of ``work``."""
    L, n, padding = np.uint64(len(lanes)), np.uint64(n_dof), np.uint64(PIECE)
    u, v, a = state
    first, kind, begin, entries = blocks
    u1, u2, u3, v2, v3 = p[2, 0], p[2, 1], p[2, 2], p[3, 1], p[3, 2]
    none = scaled(0.0, read(lanes, result, np.uint64(0)))
    one, two, three = np.uint64(1), np.uint64(2), np.uint64(3)
    for b in range(len(kind)):
        low, high = np.uint64(first[b]), np.uint64(first[b + 1])
        for i in range(low, high):
            v0, a0 = read(lanes, v, i * L), read(lanes, a, i * L)
            put(work, i * L, plus(plus(scaled(u2, v0), u3, a0), u1, read(lanes, u, i * L)))
            if parts == 3:
                put(work, (n + i) * L, plus(scaled(v2, v0), v3, a0))
        padded = (high - low + padding - one) // padding * padding
        for r in range(np.uint64(0), high - low, np.uint64(_TOGETHER)):
            t0, t1, t2, t3, at = none, none, none, none, np.uint64(begin[kind[b]]) + r
            for part in range(np.uint64(parts)):
                for j in range(part * n + low, part * n + high):
                    value = read(lanes, work, j * L)
                    t0, t1 = plus(t0, entries[at], value), plus(t1, entries[at + one], value)
                    t2, t3 = plus(t2, entries[at + two], value), plus(t3, entries[at + three], value)
                    at += padded
            into = low + r  # behind the vehicle there is room, or the next one, whose turn comes later
            put(result, into * L, t0)
            put(result, (into + one) * L, t1)
            put(result, (into + two) * L, t2)
            put(result, (into + three) * L, t3)


@as_compiled
def on_ground_alike(lanes: Any, alike: Any) -> None:
    """Forces of all wheels as if the ground were rigid."""
    forces, gap, (starts, columns, entries) = alike[0], alike[1], alike[8]
    L = np.uint64(len(lanes))
    none = scaled(0.0, read(lanes, alike[4], np.uint64(0)))
    for i in range(len(starts) - 1):
        t = none
        for q in range(starts[i], starts[i + 1]):
            t = plus(t, entries[q], read(lanes, gap, np.uint64(columns[q]) * L))
        put(forces, np.uint64(i) * L, t)


@as_compiled
def take_alike(lanes: Any, alike: Any, late: Any, coupled: Any, tape: Any, k: int) -> None:
    """Vehicles with the new contact forces; write them down."""
    forces, _, (u, v, a), _, result, _, _, _, _, responses, (first_dofs, first_contacts), n_dof = alike
    starts, columns, entries = responses
    dt, late_u, late_v, u_from_a, v_from_a = late
    L = np.uint64(len(lanes))
    for i in range(n_dof):
        at = np.uint64(i) * L
        new = read(lanes, result, at)
        for q in range(starts[i], starts[i + 1]):
            new = plus(new, entries[q], read(lanes, forces, np.uint64(columns[q]) * L))
        u0, v0, a0 = read(lanes, u, at), read(lanes, v, at), read(lanes, a, at)
        put(u, at, plus(plus(u0, 1.0, plus(scaled(dt, v0), late_u, a0)), u_from_a, new))
        put(v, at, plus(plus(v0, late_v, a0), v_from_a, new))
        put(a, at, new)
    u_on, v_on, a_on, forces_on = tape[2][k, 0], tape[2][k, 1], tape[2][k, 2], tape[3]
    for c in range(len(first_dofs)):
        for i in range(n_dof):
            at, into = np.uint64(i) * L + np.uint64(c), first_dofs[c] + i
            u_on[into], v_on[into], a_on[into] = u[at], v[at], a[at]
        for i in range(len(forces) // len(lanes)):
            forces_on[k, coupled[first_contacts[c] + i]] = forces[i * len(lanes) + c]
