"""What is wrong with the shape of shell elements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.elements.shell_geometry import ShellKind, check_coordinates, diagonals

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: nodes higher above the mean plane than this share of the root of the area are called strongly warped.
STRONG_WARP = 0.1
#: sine of the angle below which a corner counts as folded back or straight.
_LEAST_SINE = 1e-6


@dataclass(frozen=True, eq=False)
class ShapeFaults:
    """Indices of the elements whose shape is poor; the elements of `degenerate` can't be used."""

    without_area: IntArray  # nodes coincide or lie on one line
    non_convex: IntArray  # a corner of 180 degrees or more, or sides that cross
    warped: IntArray  # convex, but strongly warped: usable, with less accuracy

    @property
    def degenerate(self) -> IntArray:
        """Elements without area or not convex, sorted."""
        return np.union1d(self.without_area, self.non_convex)


def check_geometry(
    kind: ShellKind, coordinates: npt.ArrayLike, strong_warp: float = STRONG_WARP
) -> ShapeFaults:
    """Find elements without area, not convex or strongly warped.

    Parameters
    ----------
    kind : {"shell3", "shell4"}
    coordinates : array (n_e, n_node, 3)
        Nodes [m].
    strong_warp : float
        Height of the nodes above the mean plane over the root of the area from which an element is listed
        as warped.

    Examples
    --------
    >>> arrow = [[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 2.0, 0.0]]]
    >>> check_geometry("shell4", arrow).non_convex
    array([0])
    """
    points = check_coordinates(kind, coordinates)
    first, second = diagonals(points)
    normal = np.cross(first, second)
    doubled = np.linalg.norm(normal, axis=1)
    sides = np.roll(points, -1, axis=1) - points
    longest = np.linalg.norm(sides, axis=2).max(axis=1)
    empty = doubled <= 1e-8 * longest**2
    safe = np.where(empty, 1.0, doubled)
    unit = normal / safe[:, None]
    if kind == "shell3":
        none = np.zeros(0, dtype=np.int64)
        return ShapeFaults(np.flatnonzero(empty), none, none)
    corner = np.einsum("eni,ei->en", np.cross(np.roll(sides, 1, axis=1), sides), unit)
    folded = ~empty & np.any(corner <= _LEAST_SINE * longest[:, None] ** 2, axis=1)
    height = np.abs(np.einsum("eni,ei->en", points - points.mean(axis=1, keepdims=True), unit)).max(axis=1)
    warped = ~empty & ~folded & (height > strong_warp * np.sqrt(0.5 * safe))
    return ShapeFaults(*(np.flatnonzero(fault) for fault in (empty, folded, warped)))
