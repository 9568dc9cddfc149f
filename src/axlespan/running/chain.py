"""Nodes in the order of the line that they form."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components, minimum_spanning_tree
from scipy.spatial import cKDTree

from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_NEIGHBORS = 12
_SHARPEST = 0.5  # cosine of the largest turn from node to node


def ordered_along(points: FloatArray, name: str = "running line") -> IntArray:
    """Return the order of points (n, 3) along the line that they form, from its end with the lower x.

    The line may be curved; it is the shortest tree that joins the points, which must have no branches.

    Parameters
    ----------
    points : array (n, 3)
        Points of one line, in any order [m].
    name : str
        What an error message calls them.

    Raises
    ------
    InputError
        If there are fewer than two points, or they form no single line.

    Examples
    --------
    >>> ordered_along(np.array([[2.0, 1.0, 0.0], [0.0, 0.0, 0.0], [3.0, 1.0, 0.0], [1.0, 0.5, 0.0]]))
    array([1, 3, 0, 2])
    """
    n = len(points)
    if n < 2:
        raise InputError("must have at least two nodes", field=name, value=n)
    found = cKDTree(points).query(points, k=min(n, _NEIGHBORS))
    distance, neighbor = np.asarray(found[0]), np.asarray(found[1])
    row = np.broadcast_to(np.arange(n)[:, None], neighbor.shape)
    other = row != neighbor
    edges = (np.maximum(distance[other], 1e-300), (row[other], neighbor[other]))  # a zero would be no edge
    half = minimum_spanning_tree(coo_array(edges, shape=(n, n)).tocsr())
    tree = csr_array(half + half.T)
    degree = np.diff(tree.indptr)
    if connected_components(tree, directed=False)[0] > 1:
        raise InputError("must form one line: there is a gap among its nodes", field=name)
    if np.any(degree > 2):
        where = points[int(np.argmax(degree))]
        raise InputError("must form one line: it branches at this node", field=name, value=where.tolist())
    ends = np.flatnonzero(degree == 1)
    here = int(min(ends, key=lambda i: tuple(points[i].tolist())))
    order, before = [here], -1
    while len(order) < n:
        after = [int(j) for j in tree.indices[tree.indptr[here] : tree.indptr[here + 1]] if j != before]
        before, here = here, after[0]
        order.append(here)
    steps = np.diff(points[order], axis=0)
    steps /= np.linalg.norm(steps, axis=1, keepdims=True)
    turns = np.flatnonzero((steps[1:] * steps[:-1]).sum(axis=1) < _SHARPEST)
    if len(turns):
        where = points[order[int(turns[0]) + 1]]
        raise InputError(
            "must form one line: it turns sharply at this node", field=name, value=where.tolist()
        )
    return np.array(order, dtype=np.int64)
