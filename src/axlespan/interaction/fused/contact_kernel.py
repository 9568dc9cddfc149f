"""The contact systems of compiled steps, S = vehicles + E Z Eᵀ: made when a step needs them, and solved, in the caches.

A wheel loads a few neighboring d.o.f. of the path. So its weights are a short piece of a row, and E Z Eᵀ for two
wheels is the product of two short pieces with a small block of Z. Only to be imported where numba is.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from axlespan.compiled import as_compiled
from axlespan.interaction.fused.banded_body import PIECE
from axlespan.interaction.fused.lane_vectors import plus, read, scaled, times, total

_EIGHT = (0,) * PIECE


@as_compiled
def room_for(n_wheel: int, n_local: int) -> Any:
    """Room for the rows of wheels; a row of each array, but for the numbers, in one piece.

    Where rows of Z begin, places and weights of the entries; dense weights from the lowest place on; eight numbers.
    """
    widest = 4 * n_local + 2 * PIECE
    return (
        np.zeros(n_wheel * n_local, np.int64),
        np.zeros(n_wheel * n_local, np.int64),
        np.zeros(n_wheel * n_local),
        np.zeros(n_wheel * widest),
        np.zeros((n_wheel, 8), np.int64),
    )


@as_compiled
def pack_rows(lanes: Any, place: Any, weights: Any, path: Any, room: Any) -> None:
    """Sort rows (n_wheel, n_local) of wheels by their places on the path, which ``path`` gives by rows of the body.

    The numbers are: entries, lowest place, highest place, pieces from the lowest (0: they lie too far apart), begin and
    end of what their rows of Z reach, and of what these hold.
    """
    row_of, offset, low, high, _, width = path
    begins, places, values, dense, numbers = room
    n_local = place.shape[1]
    widest = 4 * n_local + 2 * PIECE
    for r in range(place.shape[0]):
        m, first, last, reach, limit, hold, until = 0, len(low), -1, len(low), 0, 0, len(low)
        for a in range(n_local):
            if weights[r, a] != 0.0:
                q, k = row_of[np.uint64(place[r, a]) // np.uint64(len(lanes))], r * n_local + m
                begins[k], places[k], values[k] = q * width - offset[q], q, weights[r, a]
                first, last = min(first, q), max(last, q)
                reach, limit = min(reach, low[q]), max(limit, high[q])
                hold, until = max(hold, offset[q]), min(until, offset[q] + width)
                m += 1
        for k in range(r * n_local + m, (r + 1) * n_local if m else 0):  # loops of one length are foreseen
            begins[k], places[k], values[k] = begins[r * n_local], places[r * n_local], 0.0
        pieces = (last + PIECE - first) // PIECE if m else 0
        pieces = pieces if pieces * PIECE <= widest else 0
        for i, number in enumerate((m, first, last, pieces, reach, limit, hold, until)):
            numbers[r, i] = number
        if pieces:
            dense[r * widest : r * widest + pieces * PIECE] = 0.0
            for k in range(r * n_local, r * n_local + m):
                dense[r * widest + places[k] - first] += values[k]


@as_compiled
def entry(i: int, j: int, n_local: int, Z: Any, width: int, room: Any) -> float:
    """Entry (i, j) of E Z Eᵀ for any rows."""
    begins, places, values, _, numbers = room
    result = 0.0
    for e in range(i * n_local, i * n_local + numbers[i, 0]):
        part = 0.0
        lowest = places[e] * width - begins[e]
        for b in range(j * n_local, j * n_local + numbers[j, 0]):
            if places[b] >= lowest and places[b] < lowest + width:
                part += values[b] * Z[begins[e] + places[b]]
        result += values[e] * part
    return result


@as_compiled
def fill_system(
    wheels: Any, at: Any, begin: int, n: int, vehicles: Any, path: Any, room: Any, S: Any, reach: Any
) -> None:
    """Fill in the upper triangle of S (n, n) for contacts, as far as ``reach`` (n,) says.

    Parameters
    ----------
    wheels : (int, int)
        Those on the structure, first and behind the last; ``at`` are their places among the contacts.
    vehicles
        Compliance of the vehicles (n, n), of which only the upper triangle is not zero, from ``begin`` on; and as far
        as its rows reach.
    """
    compliance, vehicles_reach, first_contact = vehicles
    begins, _, values, dense, numbers = room
    Z, width, n_local = path[4], path[5], len(begins) // max(len(numbers), 1)
    widest = 4 * n_local + 2 * PIECE
    for i in range(n):
        reach[i] = vehicles_reach[first_contact + i]
        for j in range(n):
            S[i, j] = compliance[begin + i * n + j]
    in_order = True  # wheels of one train on one line: behind one that is out of reach, all are
    for r in range(wheels[0] + 1, wheels[1]):
        in_order = in_order and numbers[r, 0] and numbers[r, 1] <= numbers[r - 1, 1]
        in_order = in_order and numbers[r, 2] <= numbers[r - 1, 2]
    for r in range(wheels[0], wheels[1]):
        if numbers[r, 0] == 0:
            continue
        e_0, stop = np.uint64(r * n_local), np.uint64((r + 1) * n_local)
        for s in range(r, wheels[1]):
            first, pieces = numbers[s, 1], numbers[s, 3]
            if not (numbers[s, 0] and first < numbers[r, 5] and numbers[s, 2] >= numbers[r, 4]):
                if in_order:
                    break
                continue
            result = 0.0
            if pieces and first >= numbers[r, 6] and first + pieces * PIECE <= numbers[r, 7]:
                # In place: a call that hands on arrays takes longer than this.
                for piece in range(pieces):
                    shift = first + piece * PIECE
                    row = scaled(values[e_0], read(_EIGHT, Z, np.uint64(begins[e_0] + shift)))
                    for e in range(e_0 + np.uint64(1), stop):
                        row = plus(row, values[e], read(_EIGHT, Z, np.uint64(begins[e] + shift)))
                    result += total(times(row, read(_EIGHT, dense, np.uint64(s * widest + piece * PIECE))))
            else:
                result = entry(r, s, n_local, Z, width, room)
            i, j = min(at[r], at[s]), max(at[r], at[s])
            S[i, j] += result
            reach[i] = max(reach[i], j)


@as_compiled
def solve_system(S: Any, reach: Any, n: int, x: Any) -> bool:
    """S x = b in place for symmetric positive definite S, which is overwritten; False if it is not.

    Row i is zero behind column ``reach[i]``; what elimination fills in lies within the reach of rows before.
    """
    for j in range(n):
        pivot, last = S[j, j], reach[j]
        if not pivot > 0.0:
            return False
        for i in range(j + 1, last + 1):
            factor = S[j, i] / pivot
            if factor != 0.0:
                reach[i] = max(reach[i], last)
                for m in range(i, last + 1):
                    S[i, m] -= factor * S[j, m]
                x[i] -= factor * x[j]
    for r in range(n):
        j = n - 1 - r
        rest = x[j]
        for m in range(j + 1, reach[j] + 1):
            rest -= S[j, m] * x[m]
        x[j] = rest / S[j, j]
    return True
