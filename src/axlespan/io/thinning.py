"""Fewer points for the eye: histories thinned without losing a peak, and bands of many curves."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

#: Points of a curve that an image of usual width can show.
POINTS = 4000


def thinned(x: FloatArray, values: FloatArray, points: int = POINTS) -> tuple[FloatArray, FloatArray]:
    """First, lowest, highest and last point of each of many bins; short histories stay as they are.

    Parameters
    ----------
    x, values : array (n,)
        A curve.
    points : int
        Largest number of points returned.

    Examples
    --------
    >>> x = np.arange(100_000.0)
    >>> peak = np.zeros(100_000)
    >>> peak[77_777] = 5.0
    >>> t, v = thinned(x, peak, 400)
    >>> len(t) <= 400, float(v.max()), float(t[v.argmax()])
    (True, 5.0, 77777.0)
    """
    n = len(x)
    if n <= points:
        return x, values
    bins = points // 4
    edges = np.linspace(0, n, bins + 1).astype(np.int64)
    width = int(np.diff(edges).max())
    # rows of equal length: a bin that is short by one repeats its last point
    index = np.minimum(edges[:-1, None] + np.arange(width), edges[1:, None] - 1)
    table = values[index]
    first, row = edges[:-1], np.arange(bins)
    lowest, highest = index[row, table.argmin(axis=1)], index[row, table.argmax(axis=1)]
    chosen = np.unique(np.concatenate([first, lowest, highest, edges[1:] - 1]))
    return x[chosen], values[chosen]


def band(
    x: FloatArray, table: FloatArray, bins: int = POINTS // 4
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Lowest and highest of the columns of ``table`` (n, n_curve) over ``x`` (n,), in bins along it.

    Returns
    -------
    tuple of array (n_bin,)
        Positions, lowest and highest values; together they hold every point of every curve.
    """
    low, high = table.min(axis=1), table.max(axis=1)
    if len(x) <= bins:
        return x, low, high
    edges = np.linspace(0, len(x), bins + 1).astype(np.int64)[:-1]
    return x[edges], np.minimum.reduceat(low, edges), np.maximum.reduceat(high, edges)


def band_over(
    positions: FloatArray, table: FloatArray, window: tuple[float, float], bins: int = 600
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Lowest and highest of curves that each have their own abscissae (n, n_curve), in bins of a window.

    Bins are at least two steps wide, so that every curve that passes has a point in each.
    """
    begin, end = window
    step = float(np.abs(np.diff(positions, axis=0)).max(initial=0.0))
    count = bins if step == 0.0 else int(np.clip((end - begin) / (2.0 * step), 1, bins))
    inside = (positions >= begin) & (positions <= end)
    at = np.minimum((positions[inside] - begin) / (end - begin) * count, count - 1).astype(np.int64)
    low, high = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(low, at, table[inside])
    np.maximum.at(high, at, table[inside])
    centers = begin + (np.arange(count) + 0.5) * (end - begin) / count
    filled = low <= high
    return centers[filled], low[filled], high[filled]
