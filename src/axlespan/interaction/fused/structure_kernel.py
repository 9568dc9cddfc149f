"""The structure in compiled steps: two passes over its state, and the response to contact where the wheels are.

*Forward* completes a row of the step before, predicts it, and eliminates the row that its prediction was waited for;
*backward* substitutes.

Only to be imported where numba is. Indices are unsigned, since a signed one would be asked at each access whether it
counts from the end.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from axlespan.compiled import as_compiled
from axlespan.interaction.fused.lane_vectors import plus, plus_size, put, read, scaled, total

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
