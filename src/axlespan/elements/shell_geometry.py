"""Geometry of flat shell elements: mean plane, axes, rigid links from the nodes, normals along the sides.

A quadrilateral need not be flat. Its formulas live on the mean plane, whose normal is the cross product of
the diagonals, so that its nodes lie alternately h above and below; rigid links along the normal carry nodal
displacements there: u_plane = u + θ × d n with d = offset - h. Rigid motions stay exact, and the same links
carry an offset of the mid-surface (the correction of warped elements in MacNeal, Finite Elements: Their
Design and Performance, 1994, and in R. L. Taylor, Finite element analysis of linear shell problems, 1988).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
ShellKind = Literal["shell3", "shell4"]

#: nodes per element of each kind.
NODE_COUNT: dict[str, int] = {"shell3": 3, "shell4": 4}


@dataclass(frozen=True, eq=False)
class FlatGeometry:
    """Elements of one kind, laid on their mean planes."""

    axes: FloatArray  # (n_e, 3, 3) unit vectors x, y and normal as rows
    center: FloatArray  # (n_e, 3) mean of the nodes [m]
    plane: FloatArray  # (n_e, n_node, 2) nodes in the axes x, y from the center [m]
    height: FloatArray  # (n_e, n_node) of the nodes above the plane [m]
    first_side: FloatArray  # (n_e, 3) from node 1 to node 2, in global axes [m]

    @property
    def node_count(self) -> int:
        """Nodes per element."""
        return int(self.plane.shape[1])

    @cached_property
    def sides(self) -> FloatArray:
        """Vectors (n_e, n_side, 2) from node k to node k + 1 in the plane [m]."""
        return np.roll(self.plane, -1, axis=1) - self.plane

    @cached_property
    def lengths(self) -> FloatArray:
        """Lengths (n_e, n_side) of the sides in the plane [m]."""
        length: FloatArray = np.linalg.norm(self.sides, axis=2)
        return length

    @cached_property
    def area(self) -> FloatArray:
        """Area (n_e,) on the plane [m^2]."""
        x, y = self.plane[..., 0], self.plane[..., 1]
        area: FloatArray = 0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1)
        return area


def flatten(kind: ShellKind, coordinates: npt.ArrayLike) -> FlatGeometry:
    """Lay elements on their mean planes.

    The x axis of a triangle runs along its first side; that of a quadrilateral halves the angle between
    the diagonals, so that it points from side 4-1 to side 2-3 and turns with the numbering.

    Raises
    ------
    InputError
        If the shape of the coordinates is wrong, a number is not finite or an element has no area.
    """
    points = check_coordinates(kind, coordinates)
    first, second = diagonals(points)
    normal = np.cross(first, second)
    size = np.linalg.norm(normal, axis=1)
    span = np.abs(points - points.mean(axis=1, keepdims=True)).max(axis=(1, 2))
    flat = np.flatnonzero(size <= 1e-12 * span**2)
    if flat.size:
        raise InputError(
            f"element {flat[0]} has no area",
            field="coordinates",
            value=points[flat[0]].tolist(),
            fix="drop elements whose nodes coincide or lie on one line (check_geometry lists them)",
        )
    normal /= size[:, None]
    x = first if points.shape[1] == 3 else _unit(first) - _unit(second)
    x = _unit(x)
    axes = np.stack([x, np.cross(normal, x), normal], axis=1)
    center = points.mean(axis=1)
    local = (points - center[:, None]) @ axes.transpose(0, 2, 1)
    return FlatGeometry(axes, center, local[..., :2], local[..., 2], points[:, 1] - points[:, 0])


def check_coordinates(kind: str, coordinates: npt.ArrayLike) -> FloatArray:
    """Return the coordinates as an array (n_e, n_node, 3), or say what is wrong with them.

    Raises
    ------
    InputError
        If the kind is unknown, the shape is wrong or a number is not finite.
    """
    if kind not in NODE_COUNT:
        raise InputError(
            "must be a kind of shell element", field="kind", value=kind, fix="Use shell3 or shell4"
        )
    points = np.asarray(coordinates, dtype=float)
    if points.ndim != 3 or points.shape[1:] != (NODE_COUNT[kind], 3):
        raise InputError(
            f"must have the shape (n_e, {NODE_COUNT[kind]}, 3)", field="coordinates", value=points.shape
        )
    if not np.all(np.isfinite(points)):
        raise InputError(
            "must be finite", field="coordinates", value=np.argwhere(~np.isfinite(points))[0].tolist()
        )
    return points


def prepared(
    kind: ShellKind, coordinates: npt.ArrayLike, thickness: npt.ArrayLike, offset: npt.ArrayLike
) -> tuple[FlatGeometry, FloatArray, FloatArray]:
    """Geometry, thicknesses (n_e,) and offsets (n_e,) of elements, checked.

    Raises
    ------
    InputError
        If the coordinates are not usable, an element has no area or a thickness is not positive.
    """
    geometry = flatten(kind, coordinates)
    t = per_element(thickness, len(geometry.area), "thickness")
    if not np.all(t > 0.0):
        raise InputError("must be positive", field="thickness", value=float(t.min()))
    return geometry, t, per_element(offset, len(t), "offset")


def per_element(value: npt.ArrayLike, n_e: int, field: str) -> FloatArray:
    """Return one finite number per element, from one for all or one for each.

    Raises
    ------
    InputError
        If there is another number of values, or one is not finite.
    """
    array = np.asarray(value, dtype=float)
    if array.ndim and array.shape != (n_e,):
        raise InputError(f"must be one number or one per element ({n_e})", field=field, value=array.shape)
    if not np.all(np.isfinite(array)):
        raise InputError("must be finite", field=field, value=value)
    return np.broadcast_to(array, (n_e,))


def per_side(flags: npt.ArrayLike, n_e: int) -> npt.NDArray[np.bool_]:
    """Return flags (n_e, 3) of the sides of triangles, from one for all or one for each.

    Raises
    ------
    InputError
        If the shape is another.
    """
    array = np.asarray(flags, dtype=bool)
    if array.ndim and array.shape != (n_e, 3):
        raise InputError(f"must be one flag or have the shape ({n_e}, 3)", field="mixed", value=array.shape)
    return np.broadcast_to(array, (n_e, 3))


def link_matrices(geometry: FlatGeometry, offset: npt.ArrayLike = 0.0) -> tuple[FloatArray, FloatArray]:
    """Matrices from the nodal d.o.f. in global axes to those of the plane.

    Parameters
    ----------
    geometry : FlatGeometry
    offset : float or array (n_e,)
        From the reference surface, where the nodes are, to the mid-surface along the normal [m].

    Returns
    -------
    membrane, bending : array (n_e, 3 n_node, 6 n_node)
        Rows per node: u, v, φ and w, θ_x, θ_y.
    """
    n_e, n = geometry.height.shape
    reach = np.broadcast_to(np.asarray(offset, dtype=float), (n_e,))[:, None] - geometry.height
    x, y, normal = (geometry.axes[:, None, k] for k in range(3))
    membrane, bending = np.zeros((2, n_e, n, 3, n, 6))
    node = np.arange(n)
    # (θ × d n) in the plane: (d θ_y, -d θ_x)
    turned = (reach[..., None] * y, -reach[..., None] * x)
    for row, (axis, link) in enumerate(zip((x, y), turned, strict=True)):
        membrane[:, node, row, node, :3], membrane[:, node, row, node, 3:] = axis, link
    membrane[:, node, 2, node, 3:] = bending[:, node, 0, node, :3] = normal
    bending[:, node, 1, node, 3:], bending[:, node, 2, node, 3:] = x, y
    shape = (n_e, 3 * n, 6 * n)
    return membrane.reshape(shape), bending.reshape(shape)


def diagonals(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Vectors (n_e, 3) whose cross product is twice the area: diagonals, or two sides of a triangle."""
    if points.shape[1] == 3:
        return points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    return points[:, 2] - points[:, 0], points[:, 3] - points[:, 1]


def _unit(vectors: FloatArray) -> FloatArray:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    unit: FloatArray = vectors / np.where(length > 0.0, length, 1.0)
    return unit
