"""Loads on the faces of solids and on the edges of plane elements, as consistent nodal forces.

Kinds are those of `axlespan.elements.shape_functions`: "tri3", "quad4", "tri6", "quad8" for faces in space,
"line2", "line3" for edges in the plane or lines in space. Coordinates are arrays (n_face, n_node, d) [m].
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.elements.quadrature import Rule, gauss, triangle
from axlespan.elements.shape_functions import shape_functions
from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]

_RULES: dict[str, Rule] = {
    "line2": gauss(1, 2),
    "line3": gauss(1, 4),
    "tri3": triangle(2),
    "tri6": triangle(5),
    "quad4": gauss(2, 3),
    "quad8": gauss(2, 4),
}


def traction_force(kind: str, coordinates: npt.ArrayLike, traction: npt.ArrayLike) -> FloatArray:
    """Nodal forces (n_face, n_node d) [N] equivalent to a traction with a fixed direction.

    Parameters
    ----------
    kind : str
        Kind of the faces or edges.
    coordinates : array (n_face, n_node, d)
        Node coordinates [m].
    traction : array (d,), (n_face, d) or (n_face, n_node, d)
        Force per area of faces [N/m^2], per length of edges [N/m]; values at nodes are interpolated.
    """
    x, rule = _checked(kind, coordinates)
    shape = shape_functions(kind)
    values = shape.values(rule.points)
    tangents = shape.derivatives(rule.points)[None] @ x[:, None]
    metric = np.sqrt(np.linalg.det(tangents @ np.swapaxes(tangents, 2, 3)))
    field = np.asarray(traction, float)
    if field.ndim == 3:
        field = values @ field
    elif field.ndim == 2:
        field = field[:, None]
    return _integrate(
        values, np.broadcast_to(field * (rule.weights * metric)[..., None], (*metric.shape, x.shape[2]))
    )


def pressure_force(kind: str, coordinates: npt.ArrayLike, pressure: npt.ArrayLike) -> FloatArray:
    """Nodal forces (n_face, n_node d) [N] equivalent to a pressure, which pushes against the outward normal.

    The outward normal follows the right-hand rule for faces in space; on the edges of a plane element,
    numbered counterclockwise, it points to the right.

    Parameters
    ----------
    kind : str
        Kind of the faces or edges.
    coordinates : array (n_face, n_node, d)
        Node coordinates [m]; faces need d = 3, edges d = 2.
    pressure : float, array (n_face,) or (n_face, n_node)
        Force per area of faces [N/m^2], per length of edges [N/m]; values at nodes are interpolated.
    """
    x, rule = _checked(kind, coordinates)
    shape = shape_functions(kind)
    if x.shape[2] != shape.dimension + 1:
        raise InputError(
            f"must have {shape.dimension + 1} coordinates per node for a normal to exist",
            field="coordinates",
            value=x.shape,
            fix="Use traction_force, which takes a direction",
        )
    values = shape.values(rule.points)
    tangents = shape.derivatives(rule.points)[None] @ x[:, None]
    if shape.dimension == 2:
        normals = np.cross(tangents[:, :, 0], tangents[:, :, 1])
    else:
        normals = np.stack([tangents[:, :, 0, 1], -tangents[:, :, 0, 0]], axis=-1)
    field = np.asarray(pressure, float)
    if field.ndim == 2:
        field = field @ values.T
    elif field.ndim == 1:
        field = field[:, None]
    return _integrate(values, -normals * (rule.weights * field)[..., None])


def sizes(kind: str, coordinates: npt.ArrayLike) -> FloatArray:
    """Areas (n_face,) [m^2] of faces, lengths [m] of edges."""
    x = np.asarray(coordinates, float)
    unit = np.zeros(x.shape[-1])
    unit[0] = 1.0
    return np.asarray(traction_force(kind, x, unit).sum(axis=1))


def _integrate(values: FloatArray, field: FloatArray) -> FloatArray:
    """Σ_q N_a f (n_face, n_node d) from the weighted field (n_face, n_point, d)."""
    return np.asarray(values.T @ field).reshape(len(field), values.shape[1] * field.shape[2])


def _checked(kind: str, coordinates: npt.ArrayLike) -> tuple[FloatArray, Rule]:
    if kind not in _RULES:
        raise InputError(
            "is not a kind of face or edge", field="kind", value=kind, fix=f"Use one of {tuple(_RULES)}"
        )
    x = np.asarray(coordinates, float)
    shape = shape_functions(kind)
    if x.ndim != 3 or x.shape[1] != shape.node_count or not shape.dimension <= x.shape[2] <= 3:
        raise InputError(
            f"must be an array (n_face, {shape.node_count}, d) for {kind}",
            field="coordinates",
            value=x.shape,
            fix="Take the nodes of a face from element.faces or element.edges",
        )
    return x, _RULES[kind]
