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
        return self.plane.shape[1]

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


def link_matrices(
    geometry: FlatGeometry, offset: npt.ArrayLike = 0.0, side_normals: FloatArray | None = None
) -> tuple[FloatArray, FloatArray]:
    """Matrices from the nodal d.o.f. in global axes to those of the plane.

    Parameters
    ----------
    geometry : FlatGeometry
    offset : float or array (n_e,)
        From the reference surface, where the nodes are, to the mid-surface along the normal [m].
    side_normals : array (n_e, n_side, 3), optional
        Normals of the curved surface along the sides; drilling rotations are then taken about them.

    Returns
    -------
    membrane, bending : array (n_e, 3 n_node, 6 n_node)
        Rows per node: u, v, φ and w, θ_x, θ_y.
    """
    axes, n = geometry.axes, geometry.node_count
    n_e = len(axes)
    reach = np.broadcast_to(np.asarray(offset, dtype=float), (n_e,))[:, None] - geometry.height
    membrane = np.zeros((n_e, n, 3, n, 6))
    bending = np.zeros((n_e, n, 3, n, 6))
    drill = _drilling(geometry, side_normals)
    for k in range(n):
        # (θ × d n) in the plane: (d θ_y, -d θ_x)
        membrane[:, k, 0, k, :3], membrane[:, k, 1, k, :3] = axes[:, 0], axes[:, 1]
        membrane[:, k, 0, k, 3:] = reach[:, k, None] * axes[:, 1]
        membrane[:, k, 1, k, 3:] = -reach[:, k, None] * axes[:, 0]
        membrane[:, k, 2, :, 3:] = drill[:, k]
        bending[:, k, 0, k, :3] = axes[:, 2]
        bending[:, k, 1, k, 3:], bending[:, k, 2, k, 3:] = axes[:, 0], axes[:, 1]
    shape = (n_e, 3 * n, 6 * n)
    return membrane.reshape(shape), bending.reshape(shape)


def _drilling(geometry: FlatGeometry, side_normals: FloatArray | None) -> FloatArray:
    """Drilling rotations of the nodes from the rotation vectors, (n_e, n_node, n_node, 3).

    On a curved surface the smooth field of rotations that goes with inextensional bending has no
    difference about the surface's normal, but it has one about the normal of a flat element, which side by
    side would stretch it. With the surface's normals n_s along the sides, φ is the field whose mean is that
    of θ·n and whose differences along the sides are, by least squares, Δθ·n_s.
    """
    n_e, n = geometry.height.shape
    normal = geometry.axes[:, 2]
    if side_normals is None:
        own = np.zeros((n_e, n, n, 3))
        own[:, np.arange(n), np.arange(n)] = normal[:, None]
        return own
    if side_normals.shape != (n_e, n, 3):
        raise InputError(
            f"must have the shape ({n_e}, {n}, 3)", field="side_normals", value=side_normals.shape
        )
    difference = np.roll(np.eye(n), 1, axis=1) - np.eye(n)
    spread = np.linalg.pinv(difference)
    drill: FloatArray = np.einsum("as,esi,sb->eabi", spread, side_normals, difference)
    return drill + normal[:, None, None] / n


def diagonals(points: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Vectors (n_e, 3) whose cross product is twice the area: diagonals, or two sides of a triangle."""
    if points.shape[1] == 3:
        return points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    return points[:, 2] - points[:, 0], points[:, 3] - points[:, 1]


def _unit(vectors: FloatArray) -> FloatArray:
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    unit: FloatArray = vectors / np.where(length > 0.0, length, 1.0)
    return unit
