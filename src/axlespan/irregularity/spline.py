"""A smooth profile through points."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline, PPoly

from axlespan.errors import InputError
from axlespan.irregularity.checks import Array, clipped, column, require_increasing, within

__all__ = ["Spline"]


@dataclass(frozen=True, eq=False)
class Spline:
    """A natural cubic spline through points: slope and curvature are continuous between them.

    At their ends it goes on with the heights there.

    Parameters
    ----------
    x : array_like, (n,)
        Positions [m], strictly increasing, at least two.
    r : array_like, (n,)
        Heights [m].
    """

    x: Array
    r: Array
    _pieces: tuple[PPoly, ...] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "x", column(self.x, "x"))
        object.__setattr__(self, "r", column(self.r, "r"))
        if self.x.size != self.r.size:
            raise InputError(f"must have as many entries as x, {self.x.size}", field="r", value=self.r.size)
        require_increasing(self.x)
        spline = CubicSpline(self.x, self.r, bc_type="natural", extrapolate=False)
        pieces = (spline, spline.derivative(1), spline.derivative(2), spline.antiderivative())
        object.__setattr__(self, "_pieces", pieces)

    def value(self, x: ArrayLike) -> Array:
        """Return r(x) [m], shaped like x."""
        return self._derivative(x, 0)

    def slope(self, x: ArrayLike) -> Array:
        """Return dr/dx [-], shaped like x."""
        return self._derivative(x, 1)

    def curvature(self, x: ArrayLike) -> Array:
        """Return d²r/dx² [1/m], shaped like x."""
        return self._derivative(x, 2)

    def integral(self, x: ArrayLike) -> Array:
        """Return an antiderivative of r [m²], shaped like x."""
        wanted = np.asarray(x, dtype=np.float64)
        x = clipped(wanted, float(self.x[0]), float(self.x[-1]))
        beyond = (wanted - x) * np.where(wanted < x, self.r[0], self.r[-1])
        return np.asarray(beyond + self._pieces[3](x), dtype=np.float64)

    def _derivative(self, x: ArrayLike, order: int) -> Array:
        x = np.asarray(x, dtype=np.float64)
        start, stop = float(self.x[0]), float(self.x[-1])
        inside = np.asarray(self._pieces[order](clipped(x, start, stop)), dtype=np.float64)
        return inside if order == 0 else np.where(within(x, start, stop), inside, 0.0)
