"""Normals of a curved surface along the sides of the flat elements that approximate it."""

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


def side_normals(
    points: npt.ArrayLike, connectivity: Mapping[ShellKind, npt.ArrayLike], crease: float = CREASE
) -> dict[ShellKind, FloatArray]:
    """Normals (n_e, n_side, 3) of the surface at the middles of the elements' sides, for `stiffness`.

    Where two elements meet at less than the crease angle it is the mean of theirs. At free edges, creases
    and where more than two meet it is extrapolated from the element's other sides.

    Parameters
    ----------
    points : array (n_points, 3)
        Nodes [m].
    connectivity : mapping of kind to array (n_e, n_node)
        Nodes of the elements, by their rows in points.
    crease : float
        [degrees].

    Raises
    ------
    InputError
        If an element has no area or a node does not exist.
    """
    nodes = np.asarray(points, dtype=float)
    tables = {kind: np.asarray(table, dtype=np.int64) for kind, table in connectivity.items()}
    for kind, table in tables.items():
        if table.size and (table.min() < 0 or table.max() >= len(nodes)):
            raise InputError(
                f"must be rows of points, 0 to {len(nodes) - 1}", field=kind, value=int(table.max())
            )
    own = {kind: flatten(kind, nodes[table]).axes[:, 2] for kind, table in tables.items()}
    side_own = np.concatenate(
        [np.repeat(own[kind], table.shape[1], axis=0) for kind, table in tables.items()]
    )
    ends = np.concatenate(
        [np.stack([table, np.roll(table, -1, axis=1)], axis=2).reshape(-1, 2) for table in tables.values()]
    )
    shared = _neighbor_mean(side_own, ends, np.cos(np.radians(crease)))
    normals: dict[ShellKind, FloatArray] = {}
    start = 0
    for kind, table in tables.items():
        part = shared[start : start + table.size].reshape(*table.shape, 3)
        start += table.size
        normals[kind] = _extrapolated(part, own[kind])
    return normals


def _neighbor_mean(own: FloatArray, ends: IntArray, least_cosine: float) -> FloatArray:
    """Mean normal of each pair of sides between the same nodes; nan where there is no smooth pair."""
    _, group, count = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(group, kind="stable")
    first = np.cumsum(count) - count
    pairs = first[count == 2]
    a, b = order[pairs], order[pairs + 1]
    # neighbors numbered the same way round run along their side in opposite directions
    sign = np.where(ends[a, 0] == ends[b, 1], 1.0, -1.0)[:, None]
    smooth = (own[a] * sign * own[b]).sum(axis=1) > least_cosine
    a, b, sign = a[smooth], b[smooth], sign[smooth]
    mean = np.full_like(own, np.nan)
    mean[a] = _unit(own[a] + sign * own[b])
    mean[b] = sign * mean[a]
    return mean


def _extrapolated(normals: FloatArray, own: FloatArray) -> FloatArray:
    """Fill sides without a smooth neighbor, so that the normal is linear over the element."""
    n = normals.shape[1]
    known = ~np.isnan(normals[..., 0])
    filled = np.where(known[..., None], normals, own[:, None])
    if n == 4:
        opposite = np.roll(filled, 2, axis=1)
        guess = 2.0 * own[:, None] - opposite
    else:
        rest = (3.0 * own - (filled * known[..., None]).sum(axis=1)) / np.maximum(3 - known.sum(axis=1), 1)[
            :, None
        ]
        guess = np.where(known.any(axis=1)[:, None, None], rest[:, None], own[:, None])
    return np.where(known[..., None], filled, _unit(guess))


def _unit(vectors: FloatArray) -> FloatArray:
    unit: FloatArray = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
    return unit
