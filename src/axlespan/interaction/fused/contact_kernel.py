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
def pack_rows(lanes: Any, on: Any, place: Any, weights: Any, path: Any, room: Any) -> None:
    """Sort rows (n_wheel, n_local) of the wheels on the line by their places on the path.

    ``path`` gives these places by rows of the body, and for each where its row of Z begins, less the first place that
    it holds; what that reaches, begin and end; and the first place that it holds. The numbers are: entries, lowest
    place, highest place, pieces from the lowest (0: they lie too far apart), begin and end of what the rows of Z of a
    wheel reach, and of what these hold.
    """
    row_of, table, _, width = path
    begins, places, values, dense, numbers = room
    n_local, one = np.uint64(place.shape[1]), np.uint64(1)
    widest = np.uint64(4 * place.shape[1] + 2 * PIECE)
    for wheel in on:
        r = np.uint64(wheel)
        begin = end = r * n_local
        first, last, reach, limit, hold, until = len(table), -1, len(table), 0, 0, len(table)
        for a in range(n_local):
            if weights[r, a] != 0.0:
                place_on_path = row_of[np.uint64(place[r, a]) // np.uint64(len(lanes))]
                q = np.uint64(place_on_path)
                begins[end], places[end], values[end] = table[q, 0], place_on_path, weights[r, a]
                first, last = min(first, place_on_path), max(last, place_on_path)
                reach, limit = min(reach, table[q, 1]), max(limit, table[q, 2])
                hold, until = max(hold, table[q, 3]), min(until, table[q, 3] + width)
                end += one
        for k in range(end, begin + n_local):  # loops of one length are foreseen
            begins[k], places[k], values[k] = begins[begin], places[begin], 0.0
        pieces = (last + PIECE - first) // PIECE
        pieces = pieces if np.uint64(pieces * PIECE) <= widest else 0
        numbers[r, 0], numbers[r, 1], numbers[r, 2], numbers[r, 3] = (
            np.int64(end - begin),
            first,
            last,
            pieces,
        )
        numbers[r, 4], numbers[r, 5], numbers[r, 6], numbers[r, 7] = reach, limit, hold, until
        if pieces:
            low = r * widest
            for k in range(low, low + np.uint64(pieces * PIECE)):
                dense[k] = 0.0
            for k in range(begin, end):
                dense[low + np.uint64(places[k] - first)] += values[k]


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
def in_order(on: Any, numbers: Any) -> bool:
    """Whether wheels follow one another on the path, as those of one train on one line: forward or backward."""
    up = down = True
    for m in range(1, len(on)):
        r, before = np.uint64(on[m]), np.uint64(on[m - 1])
        up = up and numbers[r, 1] >= numbers[before, 1] and numbers[r, 2] >= numbers[before, 2]
        down = down and numbers[r, 1] <= numbers[before, 1] and numbers[r, 2] <= numbers[before, 2]
    return up or down


@as_compiled
def fill_system(
    on: Any, at: Any, begin: int, n: int, vehicles: Any, path: Any, room: Any, S: Any, reach: Any
) -> None:
    """Fill in the upper triangle of S (n, n) for contacts, as far as ``reach`` (n,) says.

    Parameters
    ----------
    on : array (n_on,)
        Wheels on the structure; ``at`` are the places of all wheels among the contacts.
    vehicles
        Compliance of the vehicles (n, n), of which only the upper triangle is not zero, from ``begin`` on; and as far
        as its rows reach.
    """
    compliance, vehicles_reach, first_contact = vehicles
    begins, _, values, dense, numbers = room
    _, _, Z, width = path
    n_local, one = np.uint64(len(begins) // max(len(numbers), 1)), np.uint64(1)
    widest = np.uint64(4 * n_local + 2 * PIECE)
    for i in range(n):
        reach[i] = vehicles_reach[first_contact + i]
        for j in range(n):
            S[i, j] = compliance[begin + i * n + j]
    follow = in_order(on, numbers)  # then behind a wheel that is out of reach, all are
    for m in range(len(on)):
        r = np.uint64(on[m])
        e_0, stop = r * n_local, (r + one) * n_local
        low, high, hold, until = numbers[r, 4], numbers[r, 5], numbers[r, 6], numbers[r, 7]
        for other in range(m, len(on)):
            s = np.uint64(on[other])
            first, pieces = numbers[s, 1], numbers[s, 3]
            if first >= high or numbers[s, 2] < low:
                if follow:
                    break
                continue
            result = 0.0
            if pieces and first >= hold and first + pieces * PIECE <= until:
                # In place: a call that hands on arrays takes longer than this.
                for piece in range(pieces):
                    shift = first + piece * PIECE
                    row = scaled(values[e_0], read(_EIGHT, Z, np.uint64(begins[e_0] + shift)))
                    for e in range(e_0 + one, stop):
                        row = plus(row, values[e], read(_EIGHT, Z, np.uint64(begins[e] + shift)))
                    dense_at = s * widest + np.uint64(piece * PIECE)
                    result += total(times(row, read(_EIGHT, dense, dense_at)))
            else:
                result = entry(np.int64(r), np.int64(s), np.int64(n_local), Z, width, room)
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
