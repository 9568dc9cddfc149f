"""Facets: the faces of solids and shells, the edges of plane elements, on which wheels can run.

A facet knows where its points are and how their displacement follows from its d.o.f.: by the shape
functions of its nodes, on shells by the element's own interpolation with rotations.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from axlespan.elements.shape_functions import ShapeFunctions, shape_functions
from axlespan.errors import InputError
from axlespan.model.continuum_parts import PlanePart, SolidPart
from axlespan.model.dofs import COMPONENTS, DofTable, nearest
from axlespan.model.model import Model
from axlespan.model.shell_parts import ShellPart

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
SurfacePart = SolidPart | PlanePart | ShellPart

#: The faces that look along the direction of the contact force.
TOP = "top"
# A facet steeper than this cosine of its normal to the direction carries no wheel (84 degrees).
_STEEPEST = 0.1


@dataclass(frozen=True, eq=False)
class Facets:
    """Facets of one kind that belong to one part."""

    part: SurfacePart
    kind: str  # line2, line3, tri3, tri6, quad4 or quad8
    elements: IntArray  # (n_facet,) elements of the part
    nodes: IntArray  # (n_facet, n_node) nodes of the model
    coordinates: FloatArray  # (n_facet, n_node, 3) [m]

    def __len__(self) -> int:
        return len(self.elements)

    @property
    def shape(self) -> ShapeFunctions:
        """Shape functions of the geometry."""
        return shape_functions(self.kind)

    @property
    def n_corner(self) -> int:
        """Number of corners (ends of an edge)."""
        return {"l": 2, "t": 3, "q": 4}[self.kind[0]]

    def taken(self, facets: npt.NDArray[np.bool_] | IntArray) -> Facets:
        """Return some of the facets."""
        return replace(
            self,
            elements=self.elements[facets],
            nodes=self.nodes[facets],
            coordinates=self.coordinates[facets],
        )

    def label(self, facet: int) -> str:
        """What an error message calls the element of a facet."""
        labels, element = self.part.labels, int(self.elements[facet])
        return f"element {element + 1 if labels is None else int(labels[element])} of '{self.part.name}'"

    def dofs(self, table: DofTable, facets: IntArray) -> IntArray:
        """D.o.f. (n, n_dof) of facets."""
        numbers = table.number[self.nodes[facets]]
        return numbers[:, :, self._components()].reshape(len(facets), -1)

    def _components(self) -> list[int]:
        return [COMPONENTS.index(name) for name in self.part.components]

    def weights(
        self, points: FloatArray, facets: IntArray, natural: FloatArray, direction: FloatArray
    ) -> FloatArray:
        """Displacement along a direction at natural points (n, n_point, d), per d.o.f. (n, n_point, n_dof)."""
        if isinstance(self.part, ShellPart):
            rows = self.part.displacement_rows(points, self.elements[facets], natural)
            return np.asarray(np.einsum("i,epid->epd", direction, rows))
        along = direction[self._components()]
        values = self.shape.values(natural.reshape(-1, natural.shape[2]))
        values = values.reshape(*natural.shape[:2], -1)
        return (values[..., None] * along).reshape(*values.shape[:2], -1)


def facets_of(model: Model, faces: str | None, direction: FloatArray) -> tuple[Facets, ...]:
    """Facets of a model on which wheels may run.

    Parameters
    ----------
    model : Model
        With solids or shells, or with plane elements if it is a plane model.
    faces : str or None
        "top": the outer faces that look along the direction, shells on either side. The name of a part:
        its outer faces. The name of a node set: the outer faces between its nodes. None: all outer faces.
    direction : array (3,)
        Unit vector along the contact force.

    Raises
    ------
    InputError
        If there is no such part or set, or it has no facets.
    """
    found = _plane_edges(model) if model.plane else [*_solid_faces(model), *_shell_faces(model)]
    chosen = [_selected(model, facets, faces) for facets in found]
    chosen = [facets.taken(_looks(facets, direction, faces == TOP)) for facets in chosen if len(facets)]
    chosen = [facets for facets in chosen if len(facets)]
    if not chosen:
        raise InputError(
            "has no faces of solids or shells (edges of plane elements) that wheels can run on",
            field="running line",
            value=faces or "model",
        )
    return tuple(chosen)


def _selected(model: Model, facets: Facets, faces: str | None) -> Facets:
    if faces in (None, TOP):
        return facets
    names = [part.name for part in model.parts if isinstance(part, (SolidPart, PlanePart, ShellPart))]
    if any(_belongs(name, faces) for name in names):
        return facets if _belongs(facets.part.name, faces) else facets.taken(np.empty(0, dtype=np.int64))
    if faces in model.node_sets:
        return facets.taken(np.flatnonzero(np.isin(facets.nodes, model.node_sets[faces]).all(axis=1)))
    raise nearest(faces, [TOP, *names, *model.node_sets], "part or set of nodes")


def _belongs(part: str, name: str) -> bool:
    return part == name or part.startswith(f"{name}/")


def _looks(facets: Facets, direction: FloatArray, only_up: bool) -> npt.NDArray[np.bool_]:
    """Which facets face the direction, or also the opposite one."""
    x = facets.coordinates
    if facets.n_corner == 2:  # outward, to the right of a counterclockwise edge
        along = x[:, 1] - x[:, 0]
        normal = np.stack([along[:, 2], np.zeros(len(x)), -along[:, 0]], axis=1)
    elif facets.n_corner == 3:
        normal = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
    else:
        normal = np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1])
    cosine = (normal @ direction) / np.linalg.norm(normal, axis=1)
    one_sided = only_up and not isinstance(facets.part, ShellPart)
    return np.asarray((cosine if one_sided else np.abs(cosine)) > _STEEPEST)


def _shell_faces(model: Model) -> list[Facets]:
    return [
        Facets(part, part.kind, np.arange(len(part.nodes)), part.nodes, model.points[part.nodes])
        for part in model.parts
        if isinstance(part, ShellPart)
    ]


def _solid_faces(model: Model) -> list[Facets]:
    groups = []
    for part in model.parts:
        if isinstance(part, SolidPart):
            by_kind: dict[str, list[tuple[int, ...]]] = {}
            for face in part.element.faces:
                by_kind.setdefault(face.kind, []).append(face.nodes)
            groups += [_faces(model, part, kind, local) for kind, local in by_kind.items()]
    return _outer(groups)


def _plane_edges(model: Model) -> list[Facets]:
    groups = []
    for part in model.parts:
        if isinstance(part, PlanePart):
            local = list(part.element.edges)
            groups.append(_faces(model, part, f"line{len(local[0])}", local))
    return _outer(groups)


def _faces(model: Model, part: SolidPart | PlanePart, kind: str, local: list[tuple[int, ...]]) -> Facets:
    nodes = part.nodes[:, np.array(local)].reshape(-1, len(local[0]))
    elements = np.repeat(np.arange(len(part.nodes)), len(local))
    return Facets(part, kind, elements, nodes, model.points[nodes])


def _outer(groups: list[Facets]) -> list[Facets]:
    """The facets that only one element has."""
    if not groups:
        return []
    corners = np.full((sum(len(facets) for facets in groups), 4), -1, dtype=np.int64)
    ends = np.cumsum([len(facets) for facets in groups])
    for facets, end in zip(groups, ends, strict=True):
        own = facets.nodes[:, : facets.n_corner]
        corners[end - len(own) : end, : own.shape[1]] = own
    corners.sort(axis=1)
    order = np.lexsort(corners.T)
    same = np.concatenate([[False], (np.diff(corners[order], axis=0) == 0).all(axis=1), [False]])
    single = np.empty(len(corners), dtype=bool)
    single[order] = ~(same[:-1] | same[1:])
    return [facets.taken(mask) for facets, mask in zip(groups, np.split(single, ends[:-1]), strict=True)]
