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

from axlespan.linalg.compiled import compiled

# A response to contact that is so much smaller than its largest value is none; asked every so many rows.
_NOTHING, _ROWS = 1e-22, 16


@compiled
def forward(
    lanes: Any, width: Any, p: Any, late: Any, state: Any, x: Any, added: Any, reach: Any, K: Any, C: Any, damped: bool,
    lower: Any, extra: Any, forced: bool, ring: Any, ahead: Any, completes: bool, goes_on: bool
) -> None:  # fmt: skip
    """Complete the step before, if it was made, and begin the next one, if there is one: L y = right-hand side.

    ``state`` holds u, u̇, ü; ``x`` accelerations of the step before, then y; ``added`` is what contact adds from row
    ``reach[0]`` to ``reach[1]``; ``ring`` predictions (1+α) ũ - α u and (1+α) ṽ - α u̇ of the latest rows.
    """
    L, w, one = np.uint64(len(lanes)), np.uint64(len(width)), np.uint64(1)
    single = len(lanes) == 1
    u, v, a = state
    mean_u, mean_v = ring
    mask = np.uint64(mean_u.shape[0] // len(lanes) - 1)
    starts, columns, entries = K
    c_starts, c_columns, c_entries = C
    n = np.uint64(starts.shape[0] - 1)
    dt, late_u, late_v, u_from_a, v_from_a = late
    u1, u2, u3, v2, v3 = p[2, 0], p[2, 1], p[2, 2], p[3, 1], p[3, 2]
    low, high = np.uint64(reach[0]), np.uint64(reach[1])
    rows = n + np.uint64(ahead) if goes_on else n
    last = 0.0
    for i in range(rows):
        if i < n:
            at = i * L
            into = (i & mask) * L
            if completes:
                inside = low <= i and i < high
                for c in range(L):
                    new = x[(i + w) * L + c]
                    if inside:
                        new += added[(i + w) * L + c]
                    u0, v0, a0 = u[at + c], v[at + c], a[at + c]
                    uc = (u0 + (dt * v0 + late_u * a0)) + u_from_a * new
                    vc = (v0 + late_v * a0) + v_from_a * new
                    u[at + c], v[at + c], a[at + c] = uc, vc, new
                    mean_u[into + c] = u1 * uc + (u2 * vc + u3 * new)
                    mean_v[into + c] = v2 * vc + v3 * new
            else:
                for c in range(L):
                    mean_u[into + c] = u1 * u[at + c] + (u2 * v[at + c] + u3 * a[at + c])
                    mean_v[into + c] = v2 * v[at + c] + v3 * a[at + c]
        if not goes_on or i < ahead:
            continue
        j = i - np.uint64(ahead)
        k = j + w
        if single:
            total = extra[j] if forced else 0.0
            for q in range(starts[j], starts[j + one]):
                total -= entries[q] * mean_u[columns[q] & mask]
            if damped:
                for q in range(c_starts[j], c_starts[j + one]):
                    total -= c_entries[q] * mean_v[c_columns[q] & mask]
            for e in range(len(width) - 1):  # the newest row comes last: all wait for it
                d = w - np.uint64(e)
                total -= lower[j, d] * x[k - d]
            last = total - lower[j, one] * last
            x[k] = last
            continue
        at = k * L
        if forced:
            for c in range(L):
                x[at + c] = extra[j * L + c]
        else:
            for c in range(L):
                x[at + c] = 0.0
        for q in range(starts[j], starts[j + one]):
            entry, where = entries[q], (columns[q] & mask) * L
            for c in range(L):
                x[at + c] -= entry * mean_u[where + c]
        if damped:
            for q in range(c_starts[j], c_starts[j + one]):
                entry, where = c_entries[q], (c_columns[q] & mask) * L
                for c in range(L):
                    x[at + c] -= entry * mean_v[where + c]
        for e in range(len(width)):
            d = w - np.uint64(e)
            entry, where = lower[j, d], (k - d) * L
            for c in range(L):
                x[at + c] -= entry * x[where + c]


@compiled
def eliminate(lanes: Any, width: Any, lower: Any, x: Any, begin: Any, must: Any) -> Any:
    """L y = b in place from row ``begin`` on, at least to row ``must``; the row behind the last one that is not nothing."""
    L, w = np.uint64(len(lanes)), np.uint64(len(width))
    n = np.uint64(lower.shape[0]) - w
    i, largest = np.uint64(begin), 0.0
    while i < n:
        stop = min(i + np.uint64(_ROWS), n)
        here = 0.0
        for j in range(i, stop):
            k = j + w
            for e in range(len(width)):
                d = w - np.uint64(e)
                entry = lower[j, d]
                for c in range(L):
                    x[k * L + c] -= entry * x[(k - d) * L + c]
            for c in range(L):
                here = max(here, abs(x[k * L + c]))
        i, largest = stop, max(largest, here)
        if i > must and here <= _NOTHING * largest:
            break
    return i


@compiled
def backward(lanes: Any, width: Any, lower: Any, x: Any, end: Any, must: Any) -> Any:
    """Lᵀ x = D⁻¹ y in place from row ``end`` back, at least to row ``must``; the last row that is not nothing."""
    L, w, zero, one = np.uint64(len(lanes)), np.uint64(len(width)), np.uint64(0), np.uint64(1)
    i, largest = np.uint64(end), 0.0
    while i > zero:
        stop = i - min(i, np.uint64(_ROWS))
        here = 0.0
        for r in range(i - stop):
            j = i - one - np.uint64(r)
            k = j + w
            pivot = lower[j, zero]
            if len(lanes) == 1:
                total = pivot * x[k]
                for e in range(len(width)):
                    d = w - np.uint64(e)
                    total -= lower[j + d, d] * x[k + d]
                x[k] = total
            else:
                for c in range(L):
                    x[k * L + c] *= pivot
                for e in range(len(width)):
                    d = w - np.uint64(e)
                    entry = lower[j + d, d]
                    for c in range(L):
                        x[k * L + c] -= entry * x[(k + d) * L + c]
            for c in range(L):
                here = max(here, abs(x[k * L + c]))
        i, largest = stop, max(largest, here)
        if i < must and here <= _NOTHING * largest:
            break
    return i


@compiled
def move_vehicles(first: Any, kind: Any, begin: Any, entries: Any, parts: int, p: Any, values: Any, work: Any, result: Any) -> None:
    """Accelerations of vehicles, block after block, from their states (3, n) and the force in the last row of ``work``."""
    u, v, a = values[0], values[1], values[2]
    for b in range(kind.shape[0]):
        low, high = first[b], first[b + 1]
        for i in range(low, high):
            work[0, i] = p[2, 0] * u[i] + (p[2, 1] * v[i] + p[2, 2] * a[i])
            if parts == 3:
                work[1, i] = p[3, 1] * v[i] + p[3, 2] * a[i]
        at = begin[kind[b]]
        for i in range(low, high):
            total = 0.0
            for part in range(parts):
                for j in range(low, high):
                    total += entries[at] * work[part, j]
                    at += 1
            result[i] = total


@compiled
def solve_small(S: Any, n: Any, x: Any) -> bool:
    """S x = b in place for symmetric positive definite S (n, n), which is overwritten; False if it is not."""
    for j in range(n):
        pivot = S[j, j]
        if not pivot > 0.0:
            return False
        for i in range(j + 1, n):
            factor = S[j, i] / pivot
            if factor != 0.0:
                for m in range(i, n):
                    S[i, m] -= factor * S[j, m]
                x[i] -= factor * x[j]
    for r in range(n):
        j = n - 1 - r
        total = x[j]
        for m in range(j + 1, n):
            total -= S[j, m] * x[m]
        x[j] = total / S[j, j]
    return True
