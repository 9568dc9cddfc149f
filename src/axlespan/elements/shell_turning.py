"""What shell elements need to know of their neighbors: a surface that turns away, sides of the other kind."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from axlespan.elements.shell_geometry import ShellKind, flatten
from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: angle between neighbors above which the side between them is an edge of the structure [degrees].
CREASE = 30.0


def surface_turning(
    points: npt.ArrayLike, connectivity: Mapping[ShellKind, npt.ArrayLike], crease: float = CREASE
) -> dict[ShellKind, FloatArray]:
    """Angle (n_e,) [rad] from each element's plane to the surface at its sides, for `stiffness`.

    It is half the largest angle between the element and a neighbor across a side. Free edges, creases and
    sides where more than two elements meet don't count: a plate, a box girder and a folded plate have
    zeros.

    Parameters
    ----------
    points : array (n_points, 3)
        Nodes [m].
    connectivity : mapping of kind to array (n_e, n_node)
        Nodes of the elements, by their rows in points; all shells of a structure at once.
    crease : float
        Angle between neighbors from which on the surface is not taken for smooth [degrees].

    Raises
    ------
    InputError
        If an element has no area or a node does not exist.

    Examples
    --------
    >>> roof = [[0, 0, 0], [0, 1, 0], [1, 0, 0.1], [1, 1, 0.1], [2, 0, 0], [2, 1, 0]]
    >>> surface_turning(roof, {"shell4": [[0, 2, 3, 1], [2, 4, 5, 3]]})["shell4"].round(4)
    array([0.0997, 0.0997])
    """
    nodes = np.asarray(points, dtype=float)
    tables = {kind: np.asarray(table, dtype=np.int64) for kind, table in connectivity.items()}
    tables = {kind: table for kind, table in tables.items() if table.size}
    if not tables:
        return {}
    for kind, table in tables.items():
        if table.min() < 0 or table.max() >= len(nodes):
            raise InputError(
                f"must be rows of the points, 0 to {len(nodes) - 1}", field=kind, value=int(table.max())
            )
    normals = np.concatenate([flatten(kind, nodes[table]).axes[:, 2] for kind, table in tables.items()])
    counts = [len(table) for table in tables.values()]
    widths = np.repeat([table.shape[1] for table in tables.values()], counts)
    element = np.repeat(np.arange(len(normals)), widths)
    ends = np.concatenate(
        [np.stack([table, np.roll(table, -1, axis=1)], axis=2).reshape(-1, 2) for table in tables.values()]
    )
    turning = _largest_turn(normals, element, ends, np.radians(crease))
    parts = np.split(turning, np.cumsum(counts)[:-1])
    return dict(zip(tables, parts, strict=True))


def mixed_sides(triangles: npt.ArrayLike, quadrilaterals: npt.ArrayLike) -> npt.NDArray[np.bool_]:
    """Sides (n_e, 3) of triangles that a quadrilateral shares, for `stiffness`.

    Parameters
    ----------
    triangles, quadrilaterals : array (n_e, 3), (n, 4)
        Nodes of the elements; side k runs from node k to the next.

    Examples
    --------
    >>> mixed_sides([[1, 4, 2]], [[0, 1, 2, 3]])
    array([[False, False,  True]])
    """
    three, four = (
        np.sort(np.stack([table, np.roll(table, -1, axis=1)], axis=2), axis=2).reshape(-1, 2)
        for table in (
            np.asarray(triangles, dtype=np.int64).reshape(-1, 3),
            np.asarray(quadrilaterals, dtype=np.int64).reshape(-1, 4),
        )
    )
    _, label = np.unique(np.concatenate([three, four]), axis=0, return_inverse=True)
    label = label.ravel()
    return np.isin(label[: len(three)], label[len(three) :]).reshape(-1, 3)


def _largest_turn(normals: FloatArray, element: IntArray, ends: IntArray, crease: float) -> FloatArray:
    """Half the largest smooth angle to a neighbor; element and ends (n_sides,) and (n_sides, 2)."""
    _, group, count = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(group.ravel(), kind="stable")
    first = (np.cumsum(count) - count)[count == 2]
    a, b = order[first], order[first + 1]
    # neighbors numbered the same way round run along their side in opposite directions
    sign = np.where(ends[a, 0] == ends[b, 1], 1.0, -1.0)
    mine, other = normals[element[a]], sign[:, None] * normals[element[b]]
    angle = np.arctan2(np.linalg.norm(np.cross(mine, other), axis=1), (mine * other).sum(axis=1))
    half = np.where(angle < crease, 0.5 * angle, 0.0)
    turning = np.zeros(len(normals))
    np.maximum.at(turning, element[a], half)
    np.maximum.at(turning, element[b], half)
    return turning
