"""Rows of histories to keep, so that no peak of any of them is lost."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Points of a plot, and values of all its curves.
POINTS, VALUES = 6000, 72_000
_LEAST = 1200


def rows_for(n: int, columns: Sequence[int], read: Callable[[int], FloatArray]) -> IntArray:
    """Rows (n_kept,) of ``n`` to keep for some columns; all if they are few.

    Every bin of rows keeps its first row and, of every column, the rows of its lowest and highest value. The
    curves of a plot share their rows, so all values are true ones at true times.

    Parameters
    ----------
    n : int
        Number of rows.
    columns : sequence of int
        Columns of the plot.
    read : callable
        Gives a column (n,).

    Examples
    --------
    >>> peak = np.zeros(1_000_000)
    >>> peak[777_777] = 1.0
    >>> kept = rows_for(1_000_000, [0], lambda column: peak)
    >>> len(kept) <= POINTS, 777_777 in kept, int(kept[0]), int(kept[-1])
    (True, True, 0, 999999)
    """
    limit = max(_LEAST, min(POINTS, VALUES // max(len(columns), 1)))
    if n <= limit:
        return np.arange(n)
    bins = max(20, (limit - 1) // (2 * len(columns) + 1))
    edges = np.linspace(0, n, bins + 1).astype(np.int64)
    chosen = np.zeros(n, dtype=bool)
    chosen[edges[:-1]] = True
    chosen[-1] = True
    for column in columns:
        lowest, highest = extremes(read(column), edges)
        chosen[lowest] = chosen[highest] = True
    return np.flatnonzero(chosen)


def extremes(values: FloatArray, edges: IntArray) -> tuple[IntArray, IntArray]:
    """Rows of the lowest and the highest value (n_bin,) in bins between edges (n_bin + 1,); nan never wins."""
    width = int(np.diff(edges).max())
    index = np.minimum(edges[:-1, None] + np.arange(width), edges[1:, None] - 1)
    table = values[index]
    row = np.arange(len(index))
    low, high = np.where(np.isnan(table), np.inf, table), np.where(np.isnan(table), -np.inf, table)
    return index[row, low.argmin(axis=1)], index[row, high.argmax(axis=1)]


def chosen_columns(sizes: Sequence[float], most: int) -> list[int]:
    """Columns to show where there are too many: first, last, the largest, and others evenly between them.

    Examples
    --------
    >>> chosen_columns([1.0, 1.0, 9.0, 1.0, 1.0, 1.0], 4)
    [0, 2, 3, 5]
    """
    n = len(sizes)
    if n <= most:
        return list(range(n))
    picked = {0, n - 1, int(np.argmax(np.nan_to_num(np.asarray(sizes, float))))}
    for i in np.linspace(0, n - 1, most).round().astype(int).tolist():
        if len(picked) < most:
            picked.add(i)
    return sorted(picked)
