r"""Damping of modes, C = U c U^T, in compiled steps, beside the band that holds all else.

With s = (1+α) γ Δt c the effective matrix is A + U s U^T, and by Woodbury's identity

.. math:: (A + U s U^T)^{-1} f = A^{-1} (f - U d), \qquad d = G U^T A^{-1} f, \quad G = (s^{-1} + U^T W)^{-1},
          \quad W = A^{-1} U

So U d is one more load of the second solve, which the response to contact needs anyway. Only to be imported where numba
is. Indices are unsigned, since a signed one would be asked at each access whether it counts from the end.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from axlespan.compiled import as_compiled
from axlespan.interaction.fused.banded_body import PIECE
from axlespan.interaction.fused.lane_vectors import plus, put, read, scaled, times, total

_EIGHT = (0,) * PIECE
# Modes at a time; they share what they read of the state. A part of :data:`PIECE`.
_TOGETHER = 4


@as_compiled
def room_for_modes(lanes: Any, n_row: int, n_mode: int, n_wheel: int) -> Any:
    """Room for values at the modes' rows, modes, d, d lane by lane, and rows of W under wheels."""
    n_all = n_mode * len(lanes)
    values, under = np.zeros(n_row * len(lanes)), np.zeros(n_wheel * n_mode)
    return values, np.zeros(n_all), np.zeros(n_all), np.zeros(n_all), under


@as_compiled
def project(lanes: Any, U: Any, values: Any, result: Any) -> None:
    """U^T (m, n_row) times values (n_row) of all lanes, one behind the other."""
    if len(lanes) == 1:
        _project_one(U, values, result)
        return
    L, n_mode, one, two, three = np.uint64(len(lanes)), U.shape[1], np.uint64(1), np.uint64(2), np.uint64(3)
    none = scaled(0.0, read(lanes, values, np.uint64(0)))
    for first in range(np.uint64(0), np.uint64(n_mode), np.uint64(_TOGETHER)):
        t0, t1, t2, t3 = none, none, none, none
        for r in range(np.uint64(U.shape[0])):
            value = read(lanes, values, r * L)
            t0, t1 = plus(t0, U[r, first], value), plus(t1, U[r, first + one], value)
            t2, t3 = plus(t2, U[r, first + two], value), plus(t3, U[r, first + three], value)
        put(result, first * L, t0)
        put(result, (first + one) * L, t1)
        put(result, (first + two) * L, t2)
        put(result, (first + three) * L, t3)


@as_compiled
def _project_one(U: Any, values: Any, result: Any) -> None:
    """The same for one lane, a piece of the modes at a time."""
    n_row, n_mode, flat, one = np.uint64(U.shape[0]), np.uint64(U.shape[1]), U.reshape(-1), np.uint64(1)
    pairs = n_row - n_row % np.uint64(2)
    for first in range(np.uint64(0), n_mode, np.uint64(PIECE)):
        even = odd = scaled(0.0, read(_EIGHT, flat, np.uint64(0)))
        for r in range(np.uint64(0), pairs, np.uint64(2)):  # rows that do not wait for one another
            even = plus(even, values[r], read(_EIGHT, flat, r * n_mode + first))
            odd = plus(odd, values[r + one], read(_EIGHT, flat, (r + one) * n_mode + first))
        if pairs < n_row:
            even = plus(even, values[pairs], read(_EIGHT, flat, pairs * n_mode + first))
        put(result, first, plus(even, 1.0, odd))


@as_compiled
def subtract_modes(lanes: Any, rows: Any, U: Any, amounts: Any, shift: Any, load: Any) -> None:
    """Subtract U times the amounts (m) of all lanes from a load at some rows, which lie so far behind in it."""
    if len(lanes) == 1:
        _subtract_from_one(rows, U, amounts, shift, load)
        return
    L = np.uint64(len(lanes))
    none = scaled(0.0, read(lanes, load, np.uint64(0)))
    for r in range(np.uint64(len(rows))):
        t0, t1, t2, t3 = none, none, none, none
        for k in range(np.uint64(0), np.uint64(U.shape[1]), np.uint64(_TOGETHER)):
            a, b, c, d = k, k + np.uint64(1), k + np.uint64(2), k + np.uint64(3)
            t0, t1 = (
                plus(t0, U[r, a], read(lanes, amounts, a * L)),
                plus(t1, U[r, b], read(lanes, amounts, b * L)),
            )
            t2, t3 = (
                plus(t2, U[r, c], read(lanes, amounts, c * L)),
                plus(t3, U[r, d], read(lanes, amounts, d * L)),
            )
        at = (np.uint64(rows[r]) + np.uint64(shift)) * L
        put(
            load,
            at,
            plus(read(lanes, load, at), -1.0, plus(plus(t0, 1.0, t1), 1.0, plus(t2, 1.0, t3))),
        )


@as_compiled
def _subtract_from_one(rows: Any, U: Any, amounts: Any, shift: Any, load: Any) -> None:
    """The same for one lane, a piece of the modes at a time."""
    n_mode, flat = np.uint64(U.shape[1]), U.reshape(-1)
    for r in range(np.uint64(len(rows))):
        t = scaled(0.0, read(_EIGHT, flat, np.uint64(0)))
        for first in range(np.uint64(0), n_mode, np.uint64(PIECE)):
            t = plus(t, 1.0, times(read(_EIGHT, amounts, first), read(_EIGHT, flat, r * n_mode + first)))
        load[np.uint64(rows[r]) + np.uint64(shift)] -= total(t)


@as_compiled
def damp(
    lanes: Any, w: int, modal: Any, room: Any, p: Any, late: Any, state: Any, x: Any, added: Any, reach: Any,
    completes: bool, extra: Any
) -> None:  # fmt: skip
    """Add the forces of the modes' damping to ``extra``; the step before is completed on the way, as in ``forward``."""
    rows, U, coefficients = modal[0], modal[1], modal[2]
    values, modes = room[0], room[1]
    L = np.uint64(len(lanes))
    _, v, a = state
    late_v, v_from_a, v2, v3 = late[2], late[4], p[3, 1], p[3, 2]
    for r in range(len(rows)):
        i = np.uint64(rows[r])
        at, k = i * L, (i + np.uint64(w)) * L
        v0, a0 = read(lanes, v, at), read(lanes, a, at)
        if completes:
            new = read(lanes, x, k)
            if reach[0] <= rows[r] and rows[r] < reach[1]:
                new = plus(new, 1.0, read(lanes, added, k))
            v0, a0 = plus(plus(v0, late_v, a0), v_from_a, new), new
        put(values, np.uint64(r) * L, plus(scaled(v2, v0), v3, a0))
    project(lanes, U, values, modes)
    for m in range(np.uint64(U.shape[1])):
        put(modes, m * L, scaled(coefficients[m], read(lanes, modes, m * L)))
    subtract_modes(lanes, rows, U, modes, 0, extra)


@as_compiled
def undamp(lanes: Any, rows: Any, extra: Any) -> None:
    """Take what acts at the modes' rows out of ``extra`` again."""
    none = scaled(0.0, read(lanes, extra, np.uint64(0)))
    for r in range(len(rows)):
        put(extra, np.uint64(rows[r]) * np.uint64(len(lanes)), none)


@as_compiled
def find_modes(lanes: Any, w: int, modal: Any, room: Any, x: Any) -> None:
    """Modes of a solution of the band, U^T x, and with them d for all loads that it knows."""
    rows, values = modal[0], room[0]
    L = np.uint64(len(lanes))
    for r in range(len(rows)):
        put(values, np.uint64(r) * L, read(lanes, x, (np.uint64(rows[r]) + np.uint64(w)) * L))
    project(lanes, modal[1], values, room[1])
    project(lanes, modal[3], room[1], room[2])


@as_compiled
def add_modal_line(
    lanes: Any, on: Any, place: Any, weights: Any, into: Any, row_of: Any, modal: Any, room: Any, u_from_a: float, gap: Any
) -> None:  # fmt: skip
    """Add to the gaps what d does to the line under the wheels on it; the rows of W under them are kept."""
    W, lane_of = modal[4], modal[5]
    amounts, by_lane, under = room[2], room[3], room[4]
    L = np.uint64(len(lanes))
    n_mode = np.uint64(len(amounts)) // L
    for c in range(L):
        for m in range(n_mode):
            by_lane[c * n_mode + m] = amounts[m * L + c]
    for wheel in on:
        r, change = np.uint64(wheel), 0.0
        lane = np.uint64(lane_of[r])
        for piece in range(np.uint64(0), n_mode, np.uint64(PIECE)):
            row = scaled(0.0, read(_EIGHT, by_lane, np.uint64(0)))
            for e in range(place.shape[1]):
                if weights[r, e] != 0.0:
                    q = np.uint64(row_of[np.uint64(place[r, e]) // L])
                    row = plus(row, weights[r, e], read(_EIGHT, W, q * n_mode + piece))
            put(under, r * n_mode + piece, row)
            change += total(times(row, read(_EIGHT, by_lane, lane * n_mode + piece)))
        gap[into[r]] -= u_from_a * change


@as_compiled
def take_modes(lanes: Any, on: Any, into: Any, forces: Any, wc: float, modal: Any, room: Any) -> None:
    """Take what contact forces do to the modes into them, and find d again."""
    lane_of, modes, by_lane, under = modal[5], room[1], room[3], room[4]
    L = np.uint64(len(lanes))
    n_mode = np.uint64(len(modes)) // L
    by_lane[:] = 0.0
    for wheel in on:
        r = np.uint64(wheel)
        first, factor = np.uint64(lane_of[r]) * n_mode, wc * forces[into[r]]
        for piece in range(np.uint64(0), n_mode, np.uint64(PIECE)):
            at = first + piece
            put(by_lane, at, plus(read(_EIGHT, by_lane, at), factor, read(_EIGHT, under, r * n_mode + piece)))
    for m in range(n_mode):
        for c in range(L):
            modes[m * L + c] -= by_lane[c * n_mode + m]
    project(lanes, modal[3], modes, room[2])
