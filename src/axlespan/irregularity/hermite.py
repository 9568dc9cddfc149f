"""Interpolation between two points that matches value, slope and curvature at both."""

from __future__ import annotations

import numpy as np

from axlespan.irregularity.checks import Array

__all__ = ["quintic"]


def quintic(left: Array, right: Array, t: Array, h: float, order: int) -> Array:
    """Return the polynomial of degree five through two points, or its derivative.

    Parameters
    ----------
    left, right : array, (3, n)
        Value, slope and curvature at the left and right points.
    t : array, (n,)
        Where between them, 0 to 1.
    h : float
        Distance of the points.
    order : int
        0, 1 or 2: value, slope, curvature.
    """
    f0, d0, c0 = left[0], h * left[1], h * h * left[2]
    f1, d1, c1 = right[0], h * right[1], h * h * right[2]
    rise = f1 - f0
    # f = f0 + d0 t + c0 t²/2 + a3 t³ + a4 t⁴ + a5 t⁵
    a3 = 10.0 * rise - 6.0 * d0 - 4.0 * d1 - 1.5 * c0 + 0.5 * c1
    a4 = -15.0 * rise + 8.0 * d0 + 7.0 * d1 + 1.5 * c0 - c1
    a5 = 6.0 * rise - 3.0 * (d0 + d1) - 0.5 * (c0 - c1)
    if order == 0:
        f = f0 + t * (d0 + t * (0.5 * c0 + t * (a3 + t * (a4 + t * a5))))
    elif order == 1:
        f = (d0 + t * (c0 + t * (3.0 * a3 + t * (4.0 * a4 + t * 5.0 * a5)))) / h
    else:
        f = (c0 + t * (6.0 * a3 + t * (12.0 * a4 + t * 20.0 * a5))) / (h * h)
    return np.asarray(f)
