"""Newton's method on the interface of wheels and springs whose laws are numbers, compiled.

The same iteration as :func:`axlespan.interaction.nonlinear.interface_solver.solve_interface`, for one interface. Only
to be imported where numba is.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from axlespan.compiled import as_compiled
from axlespan.interaction.nonlinear.interface_solver import HALVINGS, LIMIT, ROUNDING, TOLERANCE
from axlespan.interaction.nonlinear.law_codes import (
    HERTZ,
    ONE_SIDED,
    POWER,
    POWER_DASHPOT,
    PULLING,
    RIGID,
    TABLE,
    UNILATERAL,
)

# Vectors to work in: forces, free and found coordinates, the Newton step and where it starts, rates of springs; twice
# residual, slope, whether a constraint holds, and coordinate.
FREE, FORCE, FOUND, STEP, START, RATE, BY_RATE, NOW, THEN = 0, 1, 2, 3, 4, 5, 6, 7, 11
SLOPE, HELD, COORDINATE = 1, 2, 3

_EXACT = 1e-14  # of the forces that make it up: a deviation below that is rounding


@as_compiled
def _power(k: float, n: float, x: float) -> Any:
    """Value and slope of k |x|^n sign(x)."""
    size = abs(x)
    slope = k * n * size ** (n - 1.0)
    value = k * size**n
    return (value if x > 0.0 else -value), slope


@as_compiled
def _read(points: Any, begin: int, end: int, x: float) -> Any:
    """Value and slope of a table, continued beyond its ends."""
    i = begin
    while i < end - 2 and points[i + 1, 0] <= x:
        i += 1
    slope = (points[i + 1, 1] - points[i, 1]) / (points[i + 1, 0] - points[i, 0])
    return points[i, 1] + slope * (x - points[i, 0]), slope


@as_compiled
def _unilateral(k: float, c: float, touch: float, e: float, rate: float) -> Any:
    """Force of a spring that pushes only, and its derivatives to elongation and rate."""
    if e >= 0.0:
        return 0.0, 0.0, 0.0
    share = min(-e / touch, 1.0)
    force = k * e + c * share * rate
    if force >= 0.0:
        return 0.0, 0.0, 0.0
    coming = -c * rate / touch if share < 1.0 else 0.0
    return force, k + coming, c * share


@as_compiled
def deviations(
    chosen: Any, begin: int, end: int, e: Any, rate: Any, coded: Any, q: Any, by_e: Any, by_rate: Any
) -> None:
    """Fill in deviations of springs from their reference, and the derivatives to elongation and rate.

    Entries ``begin`` to ``end`` are those of the springs ``chosen``. A deviation is exactly zero where a law follows
    its reference.
    """
    kinds, numbers, points = coded
    for r in range(begin, end):
        i = np.uint64(chosen[r])
        kind, first, second = kinds[i, 0], numbers[i, 0], numbers[i, 1]
        total, moving, force, k, c = numbers[i, 4] + e[r], rate[r], 0.0, 0.0, 0.0
        if kind == UNILATERAL:
            force, k, c = _unilateral(first, second, numbers[i, 2], total, moving)
        elif kind == POWER:
            force, k = _power(first, second, total)
        elif kind == TABLE:
            force, k = _read(points, kinds[i, 1], kinds[i, 2], total)
        elif kind == POWER_DASHPOT:
            force, c = _power(first, second, moving)
        else:
            force, c = _read(points, kinds[i, 1], kinds[i, 2], moving)
        factor, linear, damped, held = (
            numbers[i, 3],
            numbers[i, 5] * e[r],
            numbers[i, 6] * moving,
            numbers[i, 7],
        )
        left = (factor * force - held) - (linear + damped)
        q[r] = 0.0 if abs(left) <= _EXACT * (abs(linear) + abs(damped) + abs(held)) else left
        by_e[r], by_rate[r] = factor * k - numbers[i, 5], factor * c - numbers[i, 6]


@as_compiled
def _contact(kind: int, k: float, c: float, total: float, rate: float, per_rate: float) -> Any:
    """Force of a compliant wheel at its approach from no force on, and its derivative."""
    if kind == HERTZ:
        root = np.sqrt(max(total, 0.0))
        return k * root * root * root, 1.5 * k * root
    force = k * total + c * rate
    if kind == PULLING or (total > 0.0 and force > 0.0):
        return force, k + per_rate * c
    return 0.0, 0.0


@as_compiled
def solve_dense(J: Any, n: Any, x: Any) -> bool:
    """J x = b in place by elimination with pivots by rows; J (n, n) is overwritten; False if it is singular."""
    for j in range(n):
        row, largest = j, abs(J[j, j])
        for i in range(j + 1, n):
            if abs(J[i, j]) > largest:
                row, largest = i, abs(J[i, j])
        if not largest > 0.0:
            return False
        if row != j:
            for m in range(j, n):
                J[j, m], J[row, m] = J[row, m], J[j, m]
            x[j], x[row] = x[row], x[j]
        pivot = J[j, j + 1 : n]
        for i in range(j + 1, n):
            if J[i, j] != 0.0:
                factor = J[i, j] / J[j, j]
                line = J[i, j + 1 : n]
                for m in range(len(pivot)):
                    line[m] -= factor * pivot[m]
                x[i] -= factor * x[j]
    for r in range(n):
        j = n - 1 - r
        total = x[j]
        for m in range(j + 1, n):
            total -= J[j, m] * x[m]
        x[j] = total / J[j, j]
    return True


@as_compiled
def _residual(n: Any, n_wheel: Any, S: Any, names: Any, vectors: Any, at: int, laws: Any) -> float:
    """Fill in residuals and what goes with them, from vector ``at`` on; the sum of squares of the residuals."""
    (kinds, numbers, approaches, dt), coded, (free_motion, rate_from_e) = laws
    free, p, rates, by_rate = vectors[FREE], vectors[FORCE], vectors[RATE], vectors[BY_RATE]
    residual, slope, held, d = vectors[at], vectors[at + SLOPE], vectors[at + HELD], vectors[at + COORDINATE]
    for i in range(n):
        d[i], held[i] = free[i], 0.0
    for j in range(n):  # S is symmetric
        if p[j] != 0.0:
            row, into = S[j, :n], d[:n]
            for i in range(len(into)):
                into[i] -= row[i] * p[j]
    for i in range(n_wheel):
        name, diagonal = names[i], max(S[i, i], 1e-300)
        slope[i] = 0.0
        if kinds[name] > ONE_SIDED:
            rate = (3.0 * d[i] - 4.0 * approaches[0, name] + approaches[1, name]) / (2.0 * dt)
            total = d[i] + numbers[name, 2]
            force, slope[i] = _contact(kinds[name], numbers[name, 0], numbers[name, 1], total, rate, 1.5 / dt)
            residual[i] = p[i] - force
        elif kinds[name] == RIGID or p[i] + d[i] / diagonal > 0.0:
            residual[i], held[i] = -d[i] / diagonal, 1.0
        else:
            residual[i] = p[i]
    for i in range(n_wheel, n):
        rates[i] = free_motion[1, names[i]] + rate_from_e * (d[i] - free_motion[0, names[i]])
    deviations(names, n_wheel, n, d, rates, coded, residual, slope, by_rate)
    for i in range(n_wheel, n):
        residual[i], slope[i] = p[i] - residual[i], slope[i] + rate_from_e * by_rate[i]
    squares = 0.0
    for i in range(n):
        squares += residual[i] * residual[i]
    return squares


@as_compiled
def _fill_jacobian(n: Any, S: Any, slope: Any, held: Any, J: Any) -> None:
    """Fill in 1 + F' S; rows of constraints that hold are those of S over its diagonal."""
    for i in range(n):
        factor = 1.0 / max(S[i, i], 1e-300) if held[i] != 0.0 else slope[i]
        row, into = S[i, :n], J[i, :n]
        for j in range(len(into)):
            into[j] = factor * row[j]
        if held[i] == 0.0:
            J[i, i] += 1.0


@as_compiled
def solve_interface(n: Any, n_wheel: Any, laws: Any, scale: float, rooms: Any) -> int:
    """Newton's method from the forces in ``rooms``, which it changes; how many residuals it looked at, or 0: no convergence.

    Parameters
    ----------
    n, n_wheel : int
        Rows; wheels come first.
    laws : tuple
        Of wheels and springs; free elongations and rates of the latter, and how rates follow elongations.
    scale : float
        A force to relate residuals to [N].
    rooms : tuple
        S (n, n), J (n, n), names of wheels and springs (n,), vectors, and the largest residuals (LIMIT,).
    """
    S, J, names, vectors, history = rooms
    p, step, start = vectors[FORCE], vectors[STEP], vectors[START]
    constrained = n_wheel == n
    for i in range(n_wheel):
        constrained = constrained and laws[0][0][names[i]] <= ONE_SIDED
    now, then = np.int64(NOW), np.int64(THEN)
    squares = _residual(n, n_wheel, S, names, vectors, now, laws)
    for count in range(LIMIT):
        size = 0.0
        for i in range(n):
            step[i], start[i] = vectors[now, i], p[i]
            size = max(size, abs(step[i]))
        history[count] = size / scale
        done = size <= ROUNDING * scale
        if not done:
            _fill_jacobian(n, S, vectors[now + SLOPE], vectors[now + HELD], J)
            if not np.isfinite(squares) or not solve_dense(J, n, step):
                return 0
            share, least = 1.0, 0.0
            for halving in range(HALVINGS + 2):
                if halving > HALVINGS:  # no share does: the whole step
                    share = 1.0
                for i in range(n):
                    p[i] = start[i] - share * step[i]
                least = _residual(n, n_wheel, S, names, vectors, then, laws)
                if constrained or least <= (1.0 - 1e-4 * share) * squares:
                    break
                share *= 0.5
            largest, same = 0.0, True
            for i in range(n):
                largest = max(largest, abs(step[i]))
                same = same and vectors[now + HELD, i] == vectors[then + HELD, i]
            now, then, squares = then, now, least
            done = same and largest <= TOLERANCE * scale
        if done:
            for i in range(n):
                vectors[FOUND, i] = vectors[now + COORDINATE, i]
            return count + 1
    return 0
