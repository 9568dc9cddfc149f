"""What both versions and both encodings of a Gmsh file say, and the numbers of Gmsh's element types.

Source: Gmsh reference manual, "MSH file format", "Legacy formats" and "Node ordering".
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from axlespan.io.meshes.assemble import ElementRows, NodeRows, Unsupported, assemble, refuse
from axlespan.model.mesh import CELL_KINDS, Mesh

IntArray = npt.NDArray[np.int64]

KIND_OF_TYPE: Mapping[int, str] = MappingProxyType(
    {
        **{1: "line2", 2: "tri3", 3: "quad4", 4: "tet4", 5: "hex8", 6: "wedge6", 8: "line3", 9: "tri6"},
        **{11: "tet10", 15: "point1", 16: "quad8", 17: "hex20"},
    }
)

_INCOMPLETE = "Set Mesh.SecondOrderIncomplete = 1 in Gmsh, so that elements have no nodes inside their faces."
_PYRAMIDS = "Mesh without pyramids (all hexahedra, or all tetrahedra)."
_LOWER = "Set Mesh.ElementOrder to 1 or 2 in Gmsh."

#: type: name, number of nodes, remedy
_OTHER_TYPES: Mapping[int, tuple[str, int, str]] = MappingProxyType(
    {
        7: ("5-node pyramid", 5, _PYRAMIDS),
        10: ("9-node quadrilateral", 9, _INCOMPLETE),
        12: ("27-node hexahedron", 27, _INCOMPLETE),
        13: ("18-node prism", 18, "Set Mesh.ElementOrder = 1 in Gmsh, or mesh without prisms."),
        14: ("14-node pyramid", 14, _PYRAMIDS),
        18: ("15-node prism", 15, "Set Mesh.ElementOrder = 1 in Gmsh, or mesh without prisms."),
        19: ("13-node pyramid", 13, _PYRAMIDS),
        **{
            i: (f"{n}-node triangle", n, _LOWER)
            for i, n in ((20, 9), (21, 10), (22, 12), (23, 15), (24, 15), (25, 21))
        },
        **{i: (f"{n}-node line", n, _LOWER) for i, n in ((26, 4), (27, 5), (28, 6))},
        **{i: (f"{n}-node tetrahedron", n, _LOWER) for i, n in ((29, 20), (30, 35), (31, 56))},
        **{i: (f"{n}-node hexahedron", n, _LOWER) for i, n in ((92, 64), (93, 125))},
    }
)

#: Positions of Gmsh's nodes in VTK's order, for the kinds where the two differ.
VTK_FROM_GMSH: Mapping[str, tuple[int, ...]] = MappingProxyType(
    {
        "tet10": (0, 1, 2, 3, 4, 5, 6, 7, 9, 8),
        "hex20": (0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15),
    }
)

_DIMENSION_WORDS = ("point", "line", "surface", "volume")


@dataclass(frozen=True, eq=False)
class TypeRows:
    """Elements of one Gmsh type that share their physical groups."""

    type: int
    dimension: int
    physical: tuple[int, ...]
    labels: IntArray  # (n,)
    nodes: IntArray  # (n, n_node) labels of nodes, in Gmsh's order
    lines: IntArray  # (n,) line numbers, 0 where unknown
    copies: npt.NDArray[np.bool_] | None = None  # (n,) rows that only add an element to another group


@dataclass(frozen=True, eq=False)
class GmshParts:
    """Content of a Gmsh file."""

    names: Mapping[tuple[int, int], str]  # (dimension, physical tag)
    nodes: NodeRows
    elements: tuple[TypeRows, ...]


def node_count(element_type: int) -> int | None:
    """Number of nodes of a Gmsh element type; None if the type is unknown."""
    if element_type in KIND_OF_TYPE:
        return CELL_KINDS[KIND_OF_TYPE[element_type]].node_count
    return _OTHER_TYPES[element_type][1] if element_type in _OTHER_TYPES else None


def dimension_of(element_type: int) -> int:
    """Dimension of a supported Gmsh element type; 0 for others."""
    return CELL_KINDS[KIND_OF_TYPE[element_type]].dimension if element_type in KIND_OF_TYPE else 0


def unknown_type(element_type: int, count: int, line: int) -> Unsupported:
    """How a type that isn't supported is reported."""
    name, _, remedy = _OTHER_TYPES.get(element_type, ("unknown", 0, ""))
    return Unsupported(f"Gmsh type {element_type}, {name}", count, line, remedy)


def once_per_element(parts: Sequence[TypeRows], entities: Sequence[IntArray]) -> tuple[TypeRows, ...]:
    """Take together the copies that version 2 writes of an element that is in several physical groups.

    Copies have the same type, geometrical entity and nodes, and another group. What the copies share is put
    into one row: the result's rows list an element once for each group, under the label of the first.
    """
    result = list(parts)
    for kind in dict.fromkeys(rows.type for rows in parts):
        same = [i for i, rows in enumerate(parts) if rows.type == kind]
        if len(same) < 2:
            continue
        keys = np.concatenate([np.column_stack([entities[i], parts[i].nodes]) for i in same])
        labels = np.concatenate([parts[i].labels for i in same])
        group = np.repeat(np.arange(len(same)), [len(parts[i].labels) for i in same])
        _, first, member = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        original = first[member.reshape(-1)]
        copied = group[original] != group
        labels = np.where(copied, labels[original], labels)
        for position, i in enumerate(same):
            rows = group == position
            result[i] = replace(parts[i], labels=labels[rows], copies=copied[rows])
    return tuple(result)


def mesh_of(file: str, parts: GmshParts) -> Mesh:
    """Build the mesh: physical groups of all dimensions become sets of nodes and of elements.

    A group without a name is called ``line-7``, ``surface-3``, … ; groups of the same name are united.
    """
    refuse(
        file,
        (
            unknown_type(rows.type, len(rows.labels), int(rows.lines[0]) if len(rows.lines) else 0)
            for rows in parts.elements
            if rows.type not in KIND_OF_TYPE
        ),
    )
    elements, groups = [], _Groups(parts.names)
    for rows in parts.elements:
        kind = KIND_OF_TYPE[rows.type]
        nodes = rows.nodes[:, VTK_FROM_GMSH[kind]] if kind in VTK_FROM_GMSH else rows.nodes
        new = slice(None) if rows.copies is None else ~rows.copies
        elements.append(ElementRows(kind, rows.labels[new], nodes[new], rows.lines[new]))
        groups.add(rows)
    return assemble(file, parts.nodes, elements, groups.united(groups.nodes), groups.united(groups.elements))


class _Groups:
    """Labels collected by the names of physical groups."""

    def __init__(self, names: Mapping[tuple[int, int], str]) -> None:
        self._names = names
        self.nodes: dict[str, list[IntArray]] = {}
        self.elements: dict[str, list[IntArray]] = {}

    def add(self, rows: TypeRows) -> None:
        for tag in rows.physical:
            name = self._names.get((rows.dimension, tag)) or f"{_DIMENSION_WORDS[rows.dimension]}-{tag}"
            self.nodes.setdefault(name, []).append(rows.nodes.ravel())
            self.elements.setdefault(name, []).append(rows.labels)

    @staticmethod
    def united(groups: Mapping[str, Sequence[IntArray]]) -> dict[str, IntArray]:
        return {name: np.unique(np.concatenate(labels)) for name, labels in groups.items()}
