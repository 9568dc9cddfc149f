"""A profile given by points."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from axlespan.errors import InputError, Place
from axlespan.irregularity.checks import Array, column, require_finite, require_increasing
from axlespan.irregularity.columns import read_columns

__all__ = ["Table"]


@dataclass(frozen=True, eq=False)
class Table:
    """A profile that is linear between points and goes on at their ends with the heights there.

    The slope is constant between points, at a point that of the piece to its right (zero from the last point
    on); the curvature is zero. :class:`Bounded` makes it zero outside bounds.

    Parameters
    ----------
    x : array_like, (n,)
        Positions [m], strictly increasing, at least two.
    r : array_like, (n,)
        Heights [m].

    Examples
    --------
    >>> Table([0.0, 10.0, 20.0], [0.0, 2e-3, 0.0]).value([-1.0, 5.0, 10.0])
    array([0.   , 0.001, 0.002])
    """

    x: Array
    r: Array
    _slopes: Array = field(init=False, repr=False)
    _areas: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "x", column(self.x, "x"))
        object.__setattr__(self, "r", column(self.r, "r"))
        if self.x.size != self.r.size:
            raise InputError(f"must have as many entries as x, {self.x.size}", field="r", value=self.r.size)
        require_increasing(self.x)
        slopes = np.diff(self.r) / np.diff(self.x)
        areas = np.diff(self.x) * 0.5 * (self.r[1:] + self.r[:-1])
        # One zero piece on either side, so that searchsorted's answer is an index without exceptions.
        object.__setattr__(self, "_slopes", np.concatenate(([0.0], slopes, [0.0])))
        object.__setattr__(self, "_areas", np.concatenate(([0.0], np.cumsum(areas))))

    @classmethod
    def from_csv(
        cls, path: str | Path, *, columns: tuple[int | str, int | str] = (0, 1), scale: float | None = None
    ) -> Table:
        """Read the points from a text file with two columns, x and r.

        Parameters
        ----------
        path : str or Path
            The file; see `columns` for which of its columns are read.
        columns : tuple
            Positions and heights: numbers of columns (from 0) or names in the header.
        scale : float, optional
            Factor from the file's heights to meters, 1e-3 for a file in millimeters; by the unit in its header,
            ``x [m]; r [mm]``, when left out, else 1.
        """
        require_finite(scale=scale)
        x, r, lines = read_columns(path, columns, scale)
        bad = np.flatnonzero(
            ~(np.isfinite(x) & np.isfinite(r)) | np.concatenate(([False], np.diff(x) <= 0.0))
        )
        try:
            return cls(x, r)
        except InputError as error:
            raise error.located(Place(str(path), lines[int(bad[0])] if bad.size else None)) from None

    def value(self, x: ArrayLike) -> Array:
        """Return r(x) [m], shaped like x."""
        return np.asarray(np.interp(np.asarray(x, dtype=np.float64), self.x, self.r))

    def slope(self, x: ArrayLike) -> Array:
        """Return dr/dx [-], shaped like x."""
        return self._slopes[np.searchsorted(self.x, np.asarray(x, dtype=np.float64), side="right")]

    def curvature(self, x: ArrayLike) -> Array:
        """Return zeros [1/m], shaped like x."""
        return np.zeros(np.shape(x))

    def integral(self, x: ArrayLike) -> Array:
        """Return an antiderivative of r [m²], shaped like x."""
        wanted = np.asarray(x, dtype=np.float64)
        x = np.clip(wanted, self.x[0], self.x[-1])
        beyond = (wanted - x) * np.where(wanted < x, self.r[0], self.r[-1])
        i = np.clip(np.searchsorted(self.x, x, side="right") - 1, 0, self.x.size - 2)
        dx = x - self.x[i]
        inside = dx * (self.r[i] + 0.5 * dx * np.diff(self.r)[i] / np.diff(self.x)[i])
        return np.asarray(beyond + self._areas[i] + inside)
