"""Gmsh meshes out: MSH 4.1 and 2.2 in ASCII.

Element sets become physical groups. A node set becomes a physical group of points, unless it holds just the
nodes of the element set of the same name: Gmsh has no other form for it.

Source: Gmsh reference manual, "MSH file format" and "Legacy formats".
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.io.meshes.gmsh_parts import KIND_OF_TYPE, VTK_FROM_GMSH
from axlespan.model.mesh import CELL_KINDS, Mesh

IntArray = npt.NDArray[np.int64]

_TYPE_OF_KIND = {kind: number for number, kind in KIND_OF_TYPE.items()}


@dataclass(frozen=True, eq=False)
class _Rows:
    """Elements of one kind that are in the same physical groups."""

    type: int
    dimension: int
    tags: tuple[int, ...]
    labels: IntArray
    nodes: IntArray  # labels of nodes, in Gmsh's order


def write_gmsh(mesh: Mesh, path: str | PathLike[str], *, version: str = "4.1") -> None:
    """Write a mesh for Gmsh, in ASCII.

    Parameters
    ----------
    mesh : Mesh
        The mesh. Coordinates are written with 17 digits, so that they come back exactly.
    path : path
        The file.
    version : {"4.1", "2.2"}
        Version of the format.

    Raises
    ------
    InputError
        If the version is another, or the name of a set holds a quote or a line break.
    """
    if version not in ("4.1", "2.2"):
        raise InputError("must be '4.1' or '2.2'", field="version", value=version)
    names, rows = _grouped(mesh)
    lines = ["$MeshFormat", f"{version} 0 8", "$EndMeshFormat"]
    if names:
        lines += ["$PhysicalNames", str(len(names))]
        lines += [f'{dimension} {tag} "{name}"' for (name, dimension), tag in names.items()]
        lines += ["$EndPhysicalNames"]
    body = _version_4(mesh, rows) if version == "4.1" else _version_2(mesh, rows)
    try:
        Path(path).write_text("\n".join([*lines, *body]) + "\n", encoding="utf-8")
    except OSError as error:
        raise InputError(f"cannot be written: {error.strerror}", field="file", value=str(path)) from None


def _grouped(mesh: Mesh) -> tuple[dict[tuple[str, int], int], list[_Rows]]:
    """Tags of physical groups by name and dimension, and the elements by kind and groups."""
    names: dict[tuple[str, int], int] = {}
    rows = []
    for position, block in enumerate(mesh.blocks):
        dimension = CELL_KINDS[block.kind].dimension
        sets = {
            name: elements
            for name, parts in mesh.element_sets.items()
            for owner, elements in parts
            if owner == position
        }
        tags, member = _combinations(names, sets, len(block), dimension)
        order = np.argsort(VTK_FROM_GMSH.get(block.kind, range(block.nodes.shape[1])))
        nodes = mesh.node_labels[block.nodes[:, order]]
        for i, own in enumerate(tags):
            chosen = member == i
            rows.append(_Rows(_TYPE_OF_KIND[block.kind], dimension, own, block.labels[chosen], nodes[chosen]))
    rows += _points(mesh, names, 1 + max((int(part.labels.max(initial=0)) for part in rows), default=0))
    return names, [part for part in rows if len(part.labels)]


def _points(mesh: Mesh, names: dict[tuple[str, int], int], first: int) -> Iterator[_Rows]:
    """Point elements for the node sets that no element set of the same name implies."""
    sets = {
        name: nodes
        for name, nodes in mesh.node_sets.items()
        if name not in mesh.element_sets or not np.array_equal(nodes, _implied(mesh, name))
    }
    tags, member = _combinations(names, sets, mesh.n_node, 0)
    for i, own in enumerate(tags):
        if own:
            chosen = np.flatnonzero(member == i)
            yield _Rows(15, 0, own, first + chosen, mesh.node_labels[chosen, None])


def _implied(mesh: Mesh, name: str) -> IntArray:
    used = [mesh.blocks[block].nodes[elements].ravel() for block, elements in mesh.element_sets[name]]
    return np.unique(np.concatenate([np.empty(0, dtype=np.int64), *used]))


def _combinations(
    names: dict[tuple[str, int], int], sets: dict[str, IntArray], count: int, dimension: int
) -> tuple[list[tuple[int, ...]], IntArray]:
    """Combinations of tags that occur, and for each of the items the number of its combination."""
    inside = np.zeros((len(sets), count), dtype=bool)
    tags = []
    for row, (name, members) in enumerate(sets.items()):
        if '"' in name or not name.isprintable():
            raise InputError("must be printable and without quotes", field="name of a set", value=name)
        inside[row, members] = True
        tags.append(names.setdefault((name, dimension), len(names) + 1))
    if not sets:
        return [()], np.zeros(count, dtype=np.int64)
    found, member = np.unique(inside, axis=1, return_inverse=True)
    combinations = [
        tuple(tag for tag, has in zip(tags, column, strict=True) if has) for column in found.T.tolist()
    ]
    return combinations, member.reshape(-1)


def _text(table: IntArray) -> list[str]:
    return [" ".join(map(str, row)) for row in table.tolist()]


def _coordinates(mesh: Mesh) -> list[str]:
    return [f"{x:.17g} {y:.17g} {z:.17g}" for x, y, z in mesh.points.tolist()]


def _version_4(mesh: Mesh, rows: list[_Rows]) -> Iterator[str]:
    low, high = mesh.bounding_box() if mesh.n_node else (np.zeros(3), np.zeros(3))
    box = " ".join(f"{value:.17g}" for value in (*low, *high))
    corner = " ".join(f"{value:.17g}" for value in low)
    # one geometrical entity for each row, numbered by its position; one more holds the nodes
    holder = (3, len(rows) + 1)
    yield "$Entities"
    yield " ".join(str(sum(part.dimension == d for part in rows) + (d == 3)) for d in range(4))
    for dimension in range(4):
        for entity, part in enumerate(rows, start=1):
            if part.dimension == dimension:
                groups = " ".join(map(str, (len(part.tags), *part.tags)))
                yield f"{entity} {corner} {groups}" if dimension == 0 else f"{entity} {box} {groups} 0"
    yield f"{holder[1]} {box} 0 0"
    yield "$EndEntities"
    yield "$Nodes"
    yield f"1 {mesh.n_node} {mesh.node_labels.min(initial=0)} {mesh.node_labels.max(initial=0)}"
    yield f"{holder[0]} {holder[1]} 0 {mesh.n_node}"
    yield from map(str, mesh.node_labels.tolist())
    yield from _coordinates(mesh)
    yield "$EndNodes"
    labels = np.concatenate([np.empty(0, dtype=np.int64), *(part.labels for part in rows)])
    yield "$Elements"
    yield f"{len(rows)} {len(labels)} {labels.min(initial=0)} {labels.max(initial=0)}"
    for entity, part in enumerate(rows, start=1):
        yield f"{part.dimension} {entity} {part.type} {len(part.labels)}"
        yield from _text(np.column_stack([part.labels, part.nodes]))
    yield "$EndElements"


def _version_2(mesh: Mesh, rows: list[_Rows]) -> Iterator[str]:
    yield "$Nodes"
    yield str(mesh.n_node)
    for label, point in zip(mesh.node_labels.tolist(), _coordinates(mesh), strict=True):
        yield f"{label} {point}"
    yield "$EndNodes"
    yield "$Elements"
    yield str(sum(len(part.labels) * max(1, len(part.tags)) for part in rows))
    label = max((int(part.labels.max()) for part in rows), default=0)
    for entity, part in enumerate(rows, start=1):
        for copy, tag in enumerate(part.tags or (0,)):
            # an element stands there once for each of its groups, under a number of its own
            labels = part.labels if copy == 0 else label + np.arange(1, len(part.labels) + 1)
            label = max(label, int(labels.max()))
            head = np.broadcast_to([part.type, 2, tag, entity], (len(labels), 4))
            yield from _text(np.column_stack([labels, head, part.nodes]))
    yield "$EndElements"
