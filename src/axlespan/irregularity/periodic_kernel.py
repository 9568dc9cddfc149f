"""Values of a tabled periodic profile at many positions, compiled by numba: to be imported late."""

from __future__ import annotations

from typing import Any

import numpy as np

from axlespan.compiled import as_compiled


@as_compiled
def fill_values(x: Any, table: Any, h: float, sign: float, out: Any) -> None:
    """Interpolate between points at distance h, as :func:`axlespan.irregularity.hermite.quintic` does.

    Parameters
    ----------
    x, out : ndarray, shape (n,)
        Positions and values.
    table : ndarray, shape (n_point + 1, 3)
        Value, slope and curvature times 1, h and h² at the points of a period, and at the first one of the next.
    sign : float
        By which values change from period to period.
    """
    points = table.shape[0] - 1
    for i in range(x.shape[0]):
        u = x[i] / h
        cell = np.floor(u)
        t = u - cell
        whole = np.int64(cell)
        turns = whole // points
        j = whole - turns * points
        f0, d0, c0 = table[j, 0], table[j, 1], table[j, 2]
        f1, d1, c1 = table[j + 1, 0], table[j + 1, 1], table[j + 1, 2]
        rise = f1 - f0
        a3 = 10.0 * rise - 6.0 * d0 - 4.0 * d1 - 1.5 * c0 + 0.5 * c1
        a4 = -15.0 * rise + 8.0 * d0 + 7.0 * d1 + 1.5 * c0 - c1
        a5 = 6.0 * rise - 3.0 * (d0 + d1) - 0.5 * (c0 - c1)
        f = f0 + t * (d0 + t * (0.5 * c0 + t * (a3 + t * (a4 + t * a5))))
        out[i] = f if turns % 2 == 0 else sign * f
