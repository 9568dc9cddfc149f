"""The passes of a step over a large body, compiled by numba: predictors and right-hand side, and the new state."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from axlespan.compiled import Loop, compiled


@cache
def compiled_right_side(single: bool) -> Loop | None:
    """Return :func:`right_side_of_one` or :func:`right_side_of_many` as machine code, or None without numba."""
    return compiled(right_side_of_one if single else right_side_of_many)


@cache
def compiled_completion() -> Loop | None:
    """Return :func:`complete` as machine code, or None without numba."""
    return compiled(complete)


@cache
def compiled_reading() -> Loop | None:
    """Return :func:`read_ahead` as machine code, or None without numba."""
    return compiled(read_ahead)


def right_side_of_one(
    prediction: Any, values: Any, K: Any, C: Any, damped: bool, forced: bool, work: Any
) -> None:
    """Fill ``work`` (2 or 3, n): (1+α) ũ - α u, where damped (1+α) ṽ - α u̇, and force - K … - C ….

    K and C are the diagonal, and row starts, columns and entries above it: half of a symmetric matrix is half of what
    a product must read. The force is the last row of ``work``, taken for zero if not ``forced``.
    """
    n = values.shape[1]
    diagonal, starts, columns, entries = K
    c_diagonal, c_starts, c_columns, c_entries = C
    u, v, a, mean_u = values[0], values[1], values[2], work[0]
    mean_v, force = work[1 if damped else 0], work[2 if damped else 1]
    p = prediction
    one = np.uint64(1)  # unsigned: see the band kernel
    for i in range(n):
        mean_u[i] = p[2, 0] * u[i] + (p[2, 1] * v[i] + p[2, 2] * a[i])
        if not forced:
            force[i] = 0.0
    if damped:
        for i in range(n):
            mean_v[i] = p[3, 1] * v[i] + p[3, 2] * a[i]
    for i in range(n):
        own = mean_u[i]
        total = force[i] - diagonal[i] * own
        j, end = np.uint64(starts[i]), np.uint64(starts[i + 1])
        while j < end:
            r, entry = columns[j], entries[j]
            total -= entry * mean_u[r]
            force[r] -= entry * own
            j += one
        if damped:
            own = mean_v[i]
            total -= c_diagonal[i] * own
            j, end = np.uint64(c_starts[i]), np.uint64(c_starts[i + 1])
            while j < end:
                r, entry = c_columns[j], c_entries[j]
                total -= entry * mean_v[r]
                force[r] -= entry * own
                j += one
        force[i] = total


def right_side_of_many(
    prediction: Any, values: Any, K: Any, C: Any, damped: bool, forced: bool, work: Any
) -> None:
    """Fill ``work`` (2 or 3, n, k) as :func:`right_side_of_one`, for bodies side by side, innermost in memory.

    K and C are row starts, columns and entries of the whole matrices.
    """
    n, k = values.shape[1:]
    starts, columns, entries = K
    c_starts, c_columns, c_entries = C
    u, v, a, mean_u = values[0], values[1], values[2], work[0]
    mean_v, force = work[1 if damped else 0], work[2 if damped else 1]
    p = prediction
    for i in range(n):
        for c in range(k):
            mean_u[i, c] = p[2, 0] * u[i, c] + (p[2, 1] * v[i, c] + p[2, 2] * a[i, c])
        if damped:
            for c in range(k):
                mean_v[i, c] = p[3, 1] * v[i, c] + p[3, 2] * a[i, c]
    for i in range(n):
        if not forced:
            for c in range(k):
                force[i, c] = 0.0
        for j in range(starts[i], starts[i + 1]):
            entry, r = entries[j], columns[j]
            for c in range(k):
                force[i, c] -= entry * mean_u[r, c]
        if damped:
            for j in range(c_starts[i], c_starts[i + 1]):
                entry, r = c_entries[j], c_columns[j]
                for c in range(k):
                    force[i, c] -= entry * mean_v[r, c]


def complete(
    prediction: Any, u_from_a: float, v_from_a: float, acceleration: Any, added: Any, adds: bool, values: Any
) -> None:
    """Advance ``values`` (3, m) to accelerations (m,) at the new time, ``added`` included if ``adds``."""
    u, v, a = values[0], values[1], values[2]
    dt, late_u, late_v = prediction[0, 1], prediction[0, 2], prediction[1, 2]
    for i in range(acceleration.shape[0]):
        new = acceleration[i]
        if adds:
            new += added[i]
        u[i] = (u[i] + (dt * v[i] + late_u * a[i])) + u_from_a * new
        v[i] = (v[i] + late_v * a[i]) + v_from_a * new
        a[i] = new


def read_ahead(
    where: Any, dt: float, late: float, new: float, values: Any, acceleration: Any, result: Any
) -> None:
    """Fill ``result`` (m,) with displacements at the new time at flat positions, as far as known."""
    u, v, a = values[0], values[1], values[2]
    for i in range(where.shape[0]):
        r = np.uint64(where[i])  # unsigned: see the band kernel
        result[i] = u[r] + (dt * v[r] + late * a[r]) + new * acceleration[r]
