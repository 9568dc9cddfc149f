"""Flat shell elements with three and four nodes, six d.o.f. per node in global axes.

Order of the d.o.f. of a node: x, y, z, rx, ry, rz. Nodes run counterclockwise about the element's normal,
z of its axes; resultants are per unit length on the mid-surface, M > 0 pulls on the side of the normal.
How the elements work and what they were measured against: docs/theory/shell-elements.md.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.elements import shell_quadrilateral, shell_triangle
from axlespan.elements.shell_checks import ShapeFaults, check_geometry
from axlespan.elements.shell_geometry import ShellKind, flatten, link_matrices, per_element, prepared
from axlespan.elements.shell_interpolation import interpolation
from axlespan.elements.shell_loads import body_force, mass, surface_pressure
from axlespan.elements.shell_material import ShellMaterial, section
from axlespan.elements.shell_turning import surface_turning
from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]

__all__ = [
    "ShapeFaults",
    "ShellKind",
    "ShellMaterial",
    "ShellResultants",
    "areas",
    "body_force",
    "check_geometry",
    "interpolation",
    "mass",
    "resultants",
    "stiffness",
    "surface_pressure",
    "surface_turning",
]

_GAUSS = 1.0 / np.sqrt(3.0)
_DEFAULT_POINTS = {
    "shell3": np.array([[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]]),
    "shell4": _GAUSS * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]),
}


@dataclass(frozen=True, eq=False)
class ShellResultants:
    """Stress resultants at points of shell elements, in the elements' axes."""

    normal_forces: FloatArray  # N_x, N_y, N_xy (n_e, n_point, 3) [N/m]
    moments: FloatArray  # M_x, M_y, M_xy (n_e, n_point, 3) [N m/m]
    shear_forces: FloatArray  # Q_x, Q_y (n_e, n_point, 2) [N/m]
    axes: FloatArray  # x, y and normal as rows (n_e, 3, 3)
    points: FloatArray  # in global axes, on the plane of the element (n_e, n_point, 3) [m]

    def along(self, direction: npt.ArrayLike) -> ShellResultants:
        """Return the resultants in axes whose x is the projection of a global direction on each element.

        Raises
        ------
        InputError
            If the direction is normal to an element.
        """
        vector = np.broadcast_to(np.asarray(direction, dtype=float), (len(self.axes), 3))
        part = np.einsum("eki,ei->ek", self.axes[:, :2], vector)
        size = np.linalg.norm(part, axis=1)
        if np.any(size < 1e-6 * np.linalg.norm(vector, axis=1)):
            raise InputError("must not be normal to an element", field="direction", value=direction)
        c, s = part.T[..., None] / size[:, None]
        x, y, normal = (self.axes[:, k] for k in range(3))
        axes = np.stack([c * x + s * y, c * y - s * x, normal], axis=1)
        shear = self.shear_forces
        turned = np.stack(
            [c * shear[..., 0] + s * shear[..., 1], c * shear[..., 1] - s * shear[..., 0]], axis=-1
        )
        return ShellResultants(
            _turned(self.normal_forces, c, s), _turned(self.moments, c, s), turned, axes, self.points
        )


def stiffness(
    kind: ShellKind,
    coordinates: npt.ArrayLike,
    material: ShellMaterial,
    thickness: npt.ArrayLike,
    offset: npt.ArrayLike = 0.0,
    turning: npt.ArrayLike = 0.0,
) -> FloatArray:
    """Stiffness matrices (n_e, 6 n_node, 6 n_node) [N/m, N, N m].

    Parameters
    ----------
    kind : {"shell3", "shell4"}
    coordinates : array (n_e, n_node, 3)
        Nodes on the reference surface [m].
    material : ShellMaterial
    thickness : float or array (n_e,)
        t > 0 [m].
    offset : float or array (n_e,)
        From the reference surface to the mid-surface, along the element's normal [m].
    turning : float or array (n_e,)
        Angle by which a curved surface turns from the element's plane to its sides, from
        `surface_turning` [rad]. With 0, right for plates and folded plates, coarse meshes of doubly curved
        shells are too stiff, triangles above all.

    Raises
    ------
    InputError
        If the coordinates are not usable, an element has no area or a thickness is not positive.
    """
    geometry, t, reach = prepared(kind, coordinates, thickness, offset)
    cut = section(material, geometry.axes, geometry.first_side, t)
    delta = per_element(turning, len(t), "turning")
    to_membrane, to_bending = link_matrices(geometry, reach)
    if kind == "shell4":
        membrane = shell_quadrilateral.membrane_parameters(geometry, cut, delta)[1]
        bending = shell_quadrilateral.bending_parameters(geometry, cut)[1]
    else:
        membrane = shell_triangle.membrane_stiffness(geometry, cut, delta)
        bending = shell_triangle.bending_stiffness(geometry, cut)
    return _congruent(to_membrane, membrane) + _congruent(to_bending, bending)


def resultants(
    kind: ShellKind,
    coordinates: npt.ArrayLike,
    material: ShellMaterial,
    thickness: npt.ArrayLike,
    displacements: npt.ArrayLike,
    offset: npt.ArrayLike = 0.0,
    turning: npt.ArrayLike = 0.0,
    natural: npt.ArrayLike | None = None,
) -> ShellResultants:
    """Normal forces, moments and shear forces at points of the elements.

    Parameters
    ----------
    kind, coordinates, material, thickness, offset, turning
        As in `stiffness`.
    displacements : array (n_e, 6 n_node)
        Nodal displacements [m, rad].
    natural : array (n_point, 2), optional
        Natural coordinates: (r, s) in [-1, 1]² of a quadrilateral, area coordinates of nodes 2 and 3 of a
        triangle. Default: the 2 × 2 Gauss points, the middles of the sides.
    """
    geometry, t, reach = prepared(kind, coordinates, thickness, offset)
    cut = section(material, geometry.axes, geometry.first_side, t)
    delta = per_element(turning, len(t), "turning")
    d = np.asarray(displacements, dtype=float)
    if d.shape != (len(t), 6 * geometry.node_count):
        raise InputError(
            f"must have the shape {(len(t), 6 * geometry.node_count)}", field="displacements", value=d.shape
        )
    in_plane, across = (matrix @ d[:, :, None] for matrix in link_matrices(geometry, reach))
    where = _DEFAULT_POINTS[kind] if natural is None else np.atleast_2d(np.asarray(natural, dtype=float))
    if kind == "shell4":
        at = shell_quadrilateral.bilinear(where)[0] @ geometry.plane
        n_beta = shell_quadrilateral.membrane_parameters(geometry, cut, delta)[0] @ in_plane
        m_beta = shell_quadrilateral.bending_parameters(geometry, cut)[0] @ across
        n = (shell_quadrilateral.membrane_modes(geometry, at) @ n_beta[:, None])[..., 0]
        mq = (shell_quadrilateral.bending_modes(geometry, at) @ m_beta[:, None])[..., 0]
        m, q = mq[..., :3], mq[..., 3:]
    else:
        at = shell_triangle.linear(where)[0] @ geometry.plane
        n, m, q = (
            (stiff[:, None] @ (strain(geometry, cut, where) @ part[:, None]))[..., 0]
            for stiff, strain, part in (
                (cut.membrane, shell_triangle.membrane_strain, in_plane),
                (cut.bending, shell_triangle.curvature, across),
                (cut.shear, shell_triangle.shear_strain, across),
            )
        )
    points = geometry.center[:, None] + at @ geometry.axes[:, :2]
    return ShellResultants(n, m, q, geometry.axes, points)


def areas(kind: ShellKind, coordinates: npt.ArrayLike) -> FloatArray:
    """Areas (n_e,) on the mean planes of the elements [m^2].

    Examples
    --------
    >>> areas("shell3", [[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 1.0]]])
    array([3.16227766])
    """
    return flatten(kind, coordinates).area


def _congruent(links: FloatArray, matrix: FloatArray) -> FloatArray:
    product: FloatArray = links.transpose(0, 2, 1) @ matrix @ links
    return product


def _turned(tensor: FloatArray, c: FloatArray, s: FloatArray) -> FloatArray:
    """Components of plane tensors (xx, yy, xy) in axes turned by the angle of cosine c and sine s."""
    xx, yy, xy = (tensor[..., k] for k in range(3))
    return np.stack(
        [
            c * c * xx + s * s * yy + 2.0 * c * s * xy,
            s * s * xx + c * c * yy - 2.0 * c * s * xy,
            c * s * (yy - xx) + (c * c - s * s) * xy,
        ],
        axis=-1,
    )
