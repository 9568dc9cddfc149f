"""The outline of a model: edges to draw, those inside solids left out."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.elements.shape_functions import EDGES
from axlespan.model.continuum_parts import SolidPart
from axlespan.model.model import Model

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
