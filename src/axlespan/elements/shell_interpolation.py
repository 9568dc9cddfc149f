"""Displacements inside shell elements: quadratic, linked to the rotations of the nodes.

The sides' arches (1 - ξ²)/8 (θ_i - θ_j) × (x_j - x_i) of `shell_sides` are blended into the element, so the
field is continuous from element to element; what turns into shear (the cubic part) is left out. Mass, loads
and the places under wheels all use this one field.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.elements import shell_sides
from axlespan.elements.shell_geometry import (
    FlatGeometry,
    ShellKind,
    flatten,
    link_matrices,
    per_element,
)
from axlespan.elements.shell_shapes import bubbles, shapes
from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]


def plane_rows(geometry: FlatGeometry, natural: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Displacements of points of the plane per d.o.f. of the plane.

    Parameters
    ----------
    natural : array (n_point, 2) or (n_e, n_point, 2)
        Natural coordinates.

    Returns
    -------
    membrane : array (n_e, n_point, 2, 3 n_node)
        Rows u and v per u, v, φ of each node.
    bending : array (n_e, n_point, 3, 3 n_node)
        Rows w, θ_x and θ_y per w, θ_x, θ_y of each node.
    """
    n_e, n = geometry.height.shape
    n_point = natural.shape[-2]
    value = np.broadcast_to(shapes(n, natural), (n_e, n_point, n))
    arched = np.broadcast_to(bubbles(n, natural) / 8.0, (n_e, n_point, n))
    left = np.stack([-geometry.sides[..., 1], geometry.sides[..., 0]], axis=-1)
    membrane = np.zeros((n_e, n_point, 2, n, 3))
    membrane[:, :, 0, :, 0] = membrane[:, :, 1, :, 1] = value
    bulge = np.einsum("eps,esi->epis", arched, left)
    membrane[..., 2] = bulge - np.roll(bulge, 1, axis=3)
    nodal = np.zeros((n_e, n_point, 3, n, 3))
    for row in range(3):
        nodal[:, :, row, :, row] = value
    bending = nodal.reshape(n_e, n_point, 3, 3 * n)
    bending[:, :, 0] += arched @ (geometry.lengths[..., None] * shell_sides.arch(geometry))
    return membrane.reshape(n_e, n_point, 2, 3 * n), bending


def interpolation(
    kind: ShellKind, coordinates: npt.ArrayLike, natural: npt.ArrayLike, offset: npt.ArrayLike = 0.0
) -> FloatArray:
    """Displacements of points of the reference surface per nodal d.o.f., in global axes.

    The rows of E in N12 (28), and with E = Dᵀ the nodal forces of a force at the point.

    Parameters
    ----------
    kind, coordinates, offset
        As in `axlespan.elements.shells.stiffness`.
    natural : array (n_point, 2) or (n_e, n_point, 2)
        Natural coordinates, the same in all elements or for each.

    Returns
    -------
    array (n_e, n_point, 3, 6 n_node)

    Examples
    --------
    >>> square = [[[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]]]
    >>> interpolation("shell4", square, [[-1.0, -1.0]])[0, 0, 2].nonzero()[0]
    array([2])
    """
    geometry = flatten(kind, coordinates)
    n_e = len(geometry.area)
    where = np.asarray(natural, dtype=float)
    if where.shape[-1:] != (2,) or where.ndim not in (2, 3) or (where.ndim == 3 and len(where) != n_e):
        raise InputError(
            f"must have the shape (n_point, 2) or ({n_e}, n_point, 2)", field="natural", value=where.shape
        )
    reach = per_element(offset, n_e, "offset")
    to_membrane, to_bending = link_matrices(geometry, reach)
    membrane, bending = plane_rows(geometry, where)
    rows = np.concatenate([membrane @ to_membrane[:, None], bending[:, :, :1] @ to_bending[:, None]], axis=2)
    # back from the mid-surface of the plane to the reference surface: u + θ × (h - offset) n
    turn = bending[:, :, 1:] @ to_bending[:, None]
    height = (shapes(geometry.node_count, where) * geometry.height[:, None]).sum(axis=-1)
    back = (height - reach[:, None])[..., None]
    rows[:, :, 0] += back * turn[:, :, 1]
    rows[:, :, 1] -= back * turn[:, :, 0]
    in_space: FloatArray = geometry.axes.transpose(0, 2, 1)[:, None] @ rows
    return in_space
