"""What to draw of a model: its edges and its surface, those inside solids left out."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.elements.shape_functions import EDGES
from axlespan.model.continuum_parts import PlanePart, SolidPart
from axlespan.model.model import Model
from axlespan.model.shell_parts import ShellPart

IntArray = npt.NDArray[np.int64]


def outline(model: Model) -> IntArray:
    """Edges (n_edge, 2) between nodes, each once: lines, sides of shells and plane elements, outer faces of solids."""
    pairs = [np.empty((0, 2), dtype=np.int64)]
    corners: list[IntArray] = []
    for part in model.parts:
        nodes = np.asarray(part.nodes)
        if isinstance(part, SolidPart):
            corners += _faces(part)
        elif nodes.shape[1] == 2:
            pairs.append(nodes)
        elif nodes.shape[1] > 2:
            shape = str(getattr(part, "kind", "")).rstrip("0123456789")
            pairs.append(nodes[:, np.array(EDGES[shape])].reshape(-1, 2))
    pairs += _edges_of_outer(corners)
    return np.unique(np.sort(np.concatenate(pairs), axis=1), axis=0)


def surface(model: Model) -> tuple[IntArray, IntArray]:
    """Triangles that cover outer faces of solids, shells and plane elements.

    Returns
    -------
    triangles : array (n, 3)
        Nodes; corners only, where elements have nodes at the middles of their edges too.
    elements : array (n,)
        Their elements, counted over all parts of the model.
    """
    faces, owners, begin = [np.empty((0, 4), dtype=np.int64)], [np.empty(0, dtype=np.int64)], 0
    inside = [np.empty(0, dtype=bool)]  # whether a face may lie between two solids
    for part in model.parts:
        nodes = np.asarray(part.nodes)
        elements = begin + np.arange(len(nodes))
        begin += len(nodes)
        found: list[IntArray] = []
        if isinstance(part, SolidPart):
            found = _faces(part)
        elif isinstance(part, (PlanePart, ShellPart)):
            found = [nodes[:, [0, 1, 2, 2] if part.kind.startswith("tri") else [0, 1, 2, 3]]]
        for corners in found:
            faces.append(corners)
            owners.append(elements)
            inside.append(np.full(len(corners), isinstance(part, SolidPart)))
    quads, owner, solid = (np.concatenate(found) for found in (faces, owners, inside))
    if not len(quads):
        return np.empty((0, 3), dtype=np.int64), owner
    _, which, count = np.unique(np.sort(quads, axis=1), axis=0, return_inverse=True, return_counts=True)
    outer = ~solid | (count[which.ravel()] == 1)
    quads, owner = quads[outer], owner[outer]
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    real = triangles[:, 1] != triangles[:, 2]
    return triangles[real], np.concatenate([owner, owner])[real]


def _faces(part: SolidPart) -> list[IntArray]:
    """Corners (n_face, 4) of all faces; triangles name the last one twice."""
    found = []
    for face in part.element.faces:
        count = 3 if face.kind.startswith("tri") else 4
        local = [*face.nodes[:count], *face.nodes[count - 1 : count] * (4 - count)]
        found.append(np.asarray(part.nodes)[:, local])
    return found


def _edges_of_outer(corners: list[IntArray]) -> list[IntArray]:
    """Sides of the faces that only one element has."""
    if not corners:
        return []
    faces = np.concatenate(corners)
    _, which, count = np.unique(np.sort(faces, axis=1), axis=0, return_inverse=True, return_counts=True)
    outer = faces[count[which.ravel()] == 1]
    sides = np.stack([outer, np.roll(outer, -1, axis=1)], axis=2).reshape(-1, 2)
    return [sides[sides[:, 0] != sides[:, 1]]]
