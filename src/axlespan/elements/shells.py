"""Flat shell elements with three and four nodes, six d.o.f. per node in global axes.

Order of the d.o.f. of a node: x, y, z, rx, ry, rz. Nodes run counterclockwise about the element's normal,
which is z of its axes. How the elements work and what they were measured against stands in
docs/theory/shell-elements.md; this module gathers what a model needs of them.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.elements import shell_quadrilateral, shell_triangle
from axlespan.elements.shell_checks import ShapeFaults, check_geometry
from axlespan.elements.shell_geometry import (
    ShellKind,
    flatten,
    link_matrices,
    per_element,
    per_side,
    prepared,
)
from axlespan.elements.shell_interpolation import interpolation
from axlespan.elements.shell_loads import body_force, mass, surface_pressure
from axlespan.elements.shell_material import ShellMaterial, section
from axlespan.elements.shell_resultants import ShellResultants, resultants
from axlespan.elements.shell_turning import mixed_sides, surface_turning

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
    "mixed_sides",
    "resultants",
    "stiffness",
    "surface_pressure",
    "surface_turning",
]


def stiffness(
    kind: ShellKind,
    coordinates: npt.ArrayLike,
    material: ShellMaterial,
    thickness: npt.ArrayLike,
    offset: npt.ArrayLike = 0.0,
    turning: npt.ArrayLike = 0.0,
    mixed: npt.ArrayLike = False,
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
        shells are too stiff, those of triangles above all.
    mixed : bool or array (n_e, 3)
        Sides of triangles that quadrilaterals share, from `mixed_sides`; of no effect on quadrilaterals.
        Without it constant membrane strains are disturbed where the kinds meet.

    Raises
    ------
    InputError
        If the coordinates are not usable, an element has no area or a thickness is not positive.

    Examples
    --------
    >>> plate = [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]]
    >>> matrix = stiffness("shell4", plate, ShellMaterial.isotropic(30e9, 0.2), 0.2)[0]
    >>> int((abs(np.linalg.eigvalsh(matrix)) > 1.0).sum())
    18
    """
    geometry, t, reach = prepared(kind, coordinates, thickness, offset)
    cut = section(material, geometry.axes, geometry.first_side, t)
    delta = per_element(turning, len(t), "turning")
    if kind == "shell4":
        membrane = shell_quadrilateral.membrane_parameters(geometry, cut, delta)[1]
        bending = shell_quadrilateral.bending_parameters(geometry, cut)[1]
    else:
        membrane = shell_triangle.membrane_stiffness(geometry, cut, delta, per_side(mixed, len(t)))
        bending = shell_triangle.bending_stiffness(geometry, cut)
    in_plane, across = link_matrices(geometry, reach)
    matrix: FloatArray = in_plane.transpose(0, 2, 1) @ membrane @ in_plane
    matrix += across.transpose(0, 2, 1) @ bending @ across
    return 0.5 * (matrix + matrix.transpose(0, 2, 1))


def areas(kind: ShellKind, coordinates: npt.ArrayLike) -> FloatArray:
    """Areas (n_e,) on the mean planes of the elements [m^2].

    Examples
    --------
    >>> areas("shell3", [[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 3.0, 1.0]]])
    array([3.16227766])
    """
    return flatten(kind, coordinates).area
