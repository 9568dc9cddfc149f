"""The passes of a step over a large body, compiled by numba: predictors and right-hand side, and the new state."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from axlespan.linalg.compiled import Loop, compiled


@cache
def compiled_right_side(single: bool) -> Loop | None:
    """Return :func:`right_side` for one or many columns as machine code, or None without numba."""
    return compiled(right_side(single))


@cache
def compiled_completion() -> Loop | None:
    """Return :func:`complete` as machine code, or None without numba."""
    return compiled(complete)


@cache
def compiled_reading() -> Loop | None:
    """Return :func:`read_ahead` as machine code, or None without numba."""
    return compiled(read_ahead)


def right_side(single: bool) -> Loop:
    """The loop that predicts a step of one body, or of many side by side, innermost in memory."""

    def predict(prediction: Any, values: Any, K: Any, C: Any, damped: bool, forced: bool, work: Any) -> None:
        """Fill ``work`` (2 or 3, n, k): (1+α) ũ - α u, where damped (1+α) ṽ - α u̇, and force - K … - C ….

        K and C are row starts, columns and entries of sparse matrices; the force is the last row of ``work``, taken for
        zero if not ``forced``.
        """
        n = values.shape[1]
        k = 1 if single else values.shape[2]
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
            if single:
                total = force[i, 0]
                for j in range(starts[i], starts[i + 1]):
                    total -= entries[j] * mean_u[columns[j], 0]
                if damped:
                    for j in range(c_starts[i], c_starts[i + 1]):
                        total -= c_entries[j] * mean_v[c_columns[j], 0]
                force[i, 0] = total
            else:
                for j in range(starts[i], starts[i + 1]):
                    entry, r = entries[j], columns[j]
                    for c in range(k):
                        force[i, c] -= entry * mean_u[r, c]
                if damped:
                    for j in range(c_starts[i], c_starts[i + 1]):
                        entry, r = c_entries[j], c_columns[j]
                        for c in range(k):
                            force[i, c] -= entry * mean_v[r, c]

    return predict


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
