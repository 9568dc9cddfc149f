"""Loads of wheels on the structure, and its compliance under them, E Z Eᵀ, compiled by numba."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.linalg.blas import daxpy

from axlespan.compiled import Loop, compiled

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@cache
def _compiled_scatter() -> Loop | None:
    return compiled(_scatter)


def subtract_at(places: IntArray, factor: float, load: FloatArray, force: FloatArray) -> None:
    """``force[places] -= factor * load`` for loads (m,) or (m, k), places all different."""
    if not len(places):  # no wheel was on the structure
        return
    if (loop := _compiled_scatter()) is None:
        force[places] -= factor * load
        return
    loop(places, factor, load.reshape(len(places), -1), force.reshape(len(force), -1))


@cache
def _compiled_sums() -> Loop | None:
    return compiled(_sums)


def load_sums(flat: IntArray, weights: FloatArray, forces: FloatArray, size: int) -> FloatArray:
    """Eᵀ X (size,) of wheels with rows (n_wheel, n_local) and forces (n_wheel,), by flat places.

    A row may name places with zero weight that lie behind the size.
    """
    if (loop := _compiled_sums()) is None:
        loads = (weights * forces[:, None]).ravel()
        return np.asarray(np.bincount(flat.ravel(), loads, minlength=size), dtype=np.float64)[:size]
    result = np.zeros(size)
    loop(flat, weights, forces, result)
    return result


@cache
def _compiled_rows() -> Loop | None:
    return compiled(_rows)


def weighted_rows(table: FloatArray, rows: IntArray, weights: FloatArray) -> FloatArray:
    """The sum (n,) of some rows of a table (m, n), times weights."""
    result = np.zeros(table.shape[1])
    if (loop := _compiled_rows()) is None:
        for row, weight in zip(rows.tolist(), weights.tolist(), strict=True):
            daxpy(table[row], result, a=weight)
    elif len(rows):
        spare = -len(rows) % 4
        loop(table, np.pad(rows, (0, spare), mode="edge"), np.pad(weights, (0, spare)), result)
    return result


def _rows(table: Any, rows: Any, weights: Any, result: Any) -> None:
    """Add to ``result`` four rows at a time, piece by piece, so that the pieces stay in the cache."""
    for begin in range(0, result.shape[0], 1024):
        end = min(begin + 1024, result.shape[0])
        into = result[begin:end]
        for i in range(0, rows.shape[0], 4):
            r0, r1 = table[rows[i], begin:end], table[rows[i + 1], begin:end]
            r2, r3 = table[rows[i + 2], begin:end], table[rows[i + 3], begin:end]
            w0, w1, w2, w3 = weights[i], weights[i + 1], weights[i + 2], weights[i + 3]
            for c in range(end - begin):
                into[c] += (w0 * r0[c] + w1 * r1[c]) + (w2 * r2[c] + w3 * r3[c])


def _sums(flat: Any, weights: Any, forces: Any, result: Any) -> None:
    for i in range(forces.shape[0]):
        for a in range(flat.shape[1]):
            if weights[i, a] != 0.0:
                result[np.uint64(flat[i, a])] += weights[i, a] * forces[i]


def _scatter(places: Any, factor: float, load: Any, force: Any) -> None:
    for i in range(places.shape[0]):
        row = np.uint64(places[i])  # unsigned: see the band kernel
        for c in range(load.shape[1]):
            force[row, c] -= factor * load[i, c]


@cache
def compiled_sandwich() -> Loop | None:
    """Return :func:`sandwich` as machine code, or None without numba."""
    return compiled(sandwich)


def sandwich(Z: Any, offset: Any, low: Any, high: Any, local: Any, weights: Any, result: Any) -> None:
    """Fill in E Z Eᵀ (n_step, n_wheel, n_wheel), symmetric.

    Parameters
    ----------
    Z : ndarray, shape (n_path, width)
        Compliance of the path: row i begins at entry ``offset[i]``.
    offset, low, high : ndarray of int, shape (n_path,)
        Row i is zero but for ``low[i] <= j < high[i]``.
    local, weights : ndarray, shape (n_step, n_wheel, n_local)
        Rows of E: places on the path and weights.
    """
    n_step, n_wheel, n_local = local.shape
    n_path, width = Z.shape
    row = np.zeros(n_path)  # of E Z, for one wheel
    # What the wheels load: places and weights, filled up to fours with weights of zero, and the range of the places.
    fours = (n_local + 3) // 4
    place, weight = np.zeros((n_wheel, 4 * fours), np.int64), np.zeros((n_wheel, 4 * fours))
    count, lowest, highest = (
        np.zeros(n_wheel, np.int64),
        np.zeros(n_wheel, np.int64),
        np.zeros(n_wheel, np.int64),
    )
    for k in range(n_step):
        for i in range(n_wheel):
            m, lowest[i], highest[i] = 0, n_path, 0
            for a in range(n_local):
                if weights[k, i, a] != 0.0:
                    place[i, m], weight[i, m] = local[k, i, a], weights[k, i, a]
                    lowest[i], highest[i] = min(lowest[i], place[i, m]), max(highest[i], place[i, m] + 1)
                    m += 1
            count[i] = m
            while m % 4:
                place[i, m], weight[i, m] = place[i, 0], 0.0
                m += 1
        for i in range(n_wheel):
            reach, limit = n_path, 0  # of the rows of this wheel
            for a in range(count[i]):
                reach, limit = min(reach, low[place[i, a]]), max(limit, high[place[i, a]])
            first, last = n_path, 0  # what this wheel and those after it load of that
            for j in range(i, n_wheel):
                if highest[j] > reach and lowest[j] < limit:
                    first, last = min(first, lowest[j]), max(last, highest[j])
            first, last = max(first, reach), min(last, limit)
            if first < last:
                row[first:last] = 0.0
            alike = True  # whether all rows hold all of that; not if a wheel loads places far apart
            for a in range(count[i]):
                begin = offset[place[i, a]]
                alike = alike and begin <= first and last <= begin + width
            for a in range(0 if alike else count[i]):
                p0, begin = place[i, a], offset[place[i, a]]
                for c in range(max(first, begin), min(last, begin + width)):
                    row[c] += weight[i, a] * Z[p0, c - begin]
            for a in range(0, count[i] if alike else 0, 4):
                p0, p1, p2, p3 = place[i, a], place[i, a + 1], place[i, a + 2], place[i, a + 3]
                w0, w1, w2, w3 = weight[i, a], weight[i, a + 1], weight[i, a + 2], weight[i, a + 3]
                if first < last:
                    z0 = Z[p0, first - offset[p0] : last - offset[p0]]
                    z1 = Z[p1, first - offset[p1] : last - offset[p1]]
                    z2 = Z[p2, first - offset[p2] : last - offset[p2]]
                    z3 = Z[p3, first - offset[p3] : last - offset[p3]]
                    into = row[first:last]
                    for c in range(last - first):
                        into[c] += (w0 * z0[c] + w1 * z1[c]) + (w2 * z2[c] + w3 * z3[c])
            for j in range(i, n_wheel):
                total = 0.0
                if lowest[j] < last and highest[j] > first:
                    for b in range(count[j]):
                        if first <= place[j, b] < last:
                            total += weight[j, b] * row[place[j, b]]
                result[k, i, j] = result[k, j, i] = total
