"""Stress resultants of shell elements: N [N/m], M [N m/m] and Q [N/m] at points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.elements import shell_hybrid, shell_quadrilateral, shell_triangle
from axlespan.elements.shell_geometry import (
    FlatGeometry,
    ShellKind,
    link_matrices,
    per_element,
    per_side,
    prepared,
)
from axlespan.elements.shell_material import ShellMaterial, ShellSection, section
from axlespan.elements.shell_shapes import shapes
from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]

_GAUSS = 1.0 / np.sqrt(3.0)
_DEFAULT_POINTS = {
    "shell3": np.array([[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]]),
    "shell4": _GAUSS * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]),
}


@dataclass(frozen=True, eq=False)
class ShellResultants:
    """Stress resultants at points of shell elements, in the elements' axes; M > 0 pulls where z > 0."""

    normal_forces: FloatArray  # N_x, N_y, N_xy (n_e, n_point, 3) [N/m]
    moments: FloatArray  # M_x, M_y, M_xy (n_e, n_point, 3) [N m/m]
    shear_forces: FloatArray  # Q_x, Q_y (n_e, n_point, 2) [N/m]
    axes: FloatArray  # x, y and normal as rows (n_e, 3, 3)
    points: FloatArray  # in global axes, on the plane of the element (n_e, n_point, 3) [m]

    def along(self, direction: npt.ArrayLike) -> ShellResultants:
        """Return them in axes whose x is the projection of a global direction, one for all or one for each.

        Raises
        ------
        InputError
            If the direction is normal to an element.
        """
        vector = np.broadcast_to(np.asarray(direction, dtype=float), (len(self.axes), 3))
        part = np.einsum("eki,ei->ek", self.axes[:, :2], vector)
        size = np.linalg.norm(part, axis=1)
        if np.any(size <= 1e-6 * np.linalg.norm(vector, axis=1)):
            raise InputError("must not be normal to an element", field="direction", value=direction)
        c, s = (part / size[:, None]).T[..., None]
        x, y, normal = (self.axes[:, k] for k in range(3))
        q_x, q_y = self.shear_forces[..., 0], self.shear_forces[..., 1]
        return ShellResultants(
            _turned(self.normal_forces, c, s),
            _turned(self.moments, c, s),
            np.stack([c * q_x + s * q_y, c * q_y - s * q_x], axis=-1),
            np.stack([c * x + s * y, c * y - s * x, normal], axis=1),
            self.points,
        )


def resultants(
    kind: ShellKind,
    coordinates: npt.ArrayLike,
    material: ShellMaterial,
    thickness: npt.ArrayLike,
    displacements: npt.ArrayLike,
    offset: npt.ArrayLike = 0.0,
    turning: npt.ArrayLike = 0.0,
    natural: npt.ArrayLike | None = None,
    mixed: npt.ArrayLike = False,
) -> ShellResultants:
    """Normal forces, moments and shear forces at points of the elements.

    Parameters
    ----------
    kind, coordinates, material, thickness, offset, turning, mixed
        As in `axlespan.elements.shells.stiffness`.
    displacements : array (n_e, 6 n_node)
        Nodal displacements [m, rad].
    natural : array (n_point, 2), optional
        Natural coordinates: (r, s) in [-1, 1]² of a quadrilateral, area coordinates of nodes 2 and 3 of a
        triangle. Default: the 2 × 2 Gauss points, the middles of the sides.

    Raises
    ------
    InputError
        If an array has the wrong shape, or as in `stiffness`.
    """
    geometry, t, reach = prepared(kind, coordinates, thickness, offset)
    cut = section(material, geometry.axes, geometry.first_side, t)
    delta = per_element(turning, len(t), "turning")
    d = np.asarray(displacements, dtype=float)
    shape = (len(t), 6 * geometry.node_count)
    if d.shape != shape:
        raise InputError(f"must have the shape {shape}", field="displacements", value=d.shape)
    where = _DEFAULT_POINTS[kind] if natural is None else np.asarray(natural, dtype=float)
    if where.ndim != 2 or where.shape[1] != 2:
        raise InputError("must have the shape (n_point, 2)", field="natural", value=where.shape)
    at = shapes(geometry.node_count, where) @ geometry.plane
    in_plane, across = (links @ d[:, :, None] for links in link_matrices(geometry, reach))
    if kind == "shell4":
        n, m, q = _of_quadrilaterals(geometry, cut, delta, at, in_plane, across)
    else:
        sides = per_side(mixed, len(t))
        n, m, q = _of_triangles(geometry, cut, delta, sides, where, in_plane, across)
    return ShellResultants(n, m, q, geometry.axes, geometry.center[:, None] + at @ geometry.axes[:, :2])


def _of_quadrilaterals(
    geometry: FlatGeometry,
    cut: ShellSection,
    turning: FloatArray,
    at: FloatArray,
    in_plane: FloatArray,
    across: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The assumed resultants P β at points (n_e, n_point, 2) of the plane."""
    force_beta = shell_quadrilateral.membrane_parameters(geometry, cut, turning)[0] @ in_plane
    moment_beta = shell_quadrilateral.bending_parameters(geometry, cut)[0] @ across
    forces = (shell_hybrid.membrane_modes(geometry, at) @ force_beta[:, None])[..., 0]
    moments = (shell_hybrid.bending_modes(geometry, at) @ moment_beta[:, None])[..., 0]
    return forces, moments[..., :3], moments[..., 3:]


def _of_triangles(
    geometry: FlatGeometry,
    cut: ShellSection,
    turning: FloatArray,
    mixed: npt.NDArray[np.bool_],
    natural: FloatArray,
    in_plane: FloatArray,
    across: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Section stiffness times strains at natural points; for bending those of the discrete plate alone."""
    strain = shell_triangle.membrane_strain(geometry, cut, turning, mixed, natural) @ in_plane[:, None]
    curvature = shell_triangle.curvature(geometry, cut, natural) @ across[:, None]
    shear = shell_triangle.shear_strain(geometry, cut, natural) @ across[:, None]
    forces, moments, cross = (
        (stiff[:, None] @ strains)[..., 0]
        for stiff, strains in ((cut.membrane, strain), (cut.bending, curvature), (cut.shear, shear))
    )
    return forces, moments, cross


def _turned(tensor: FloatArray, c: FloatArray, s: FloatArray) -> FloatArray:
    """Components (xx, yy, xy) of plane tensors in axes turned by the angle of cosine c and sine s."""
    xx, yy, xy = (tensor[..., k] for k in range(3))
    return np.stack(
        [
            c * c * xx + s * s * yy + 2.0 * c * s * xy,
            s * s * xx + c * c * yy - 2.0 * c * s * xy,
            c * s * (yy - xx) + (c * c - s * s) * xy,
        ],
        axis=-1,
    )
