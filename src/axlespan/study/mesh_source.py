"""The mesh of a case: read from its file or made of equal cells, in meters, z up, near nodes merged."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from axlespan import units
from axlespan.errors import InputError
from axlespan.io.meshes import read_mesh
from axlespan.model.mesh import Mesh as MeshValue
from axlespan.study.case_imported import Mesh
from axlespan.study.case_made_mesh import MadeMesh
from axlespan.study.nodes import under

IntArray = npt.NDArray[np.int64]

# Linear kinds that quadratic ones are made from.
_LINEAR = {"hex20": "hex8", "tet10": "tet4", "quad8": "quad4", "tri6": "tri3"}


def mesh_of(case: Mesh) -> MeshValue:
    """Read or make the mesh.

    Raises
    ------
    InputError
        If the file is damaged or holds elements that are not supported; it names the line of that file.
    """
    if case.file is not None:
        with under("file"):
            mesh = read_mesh(case.file)
        if not mesh.n_element:
            raise InputError("has no elements", field="file")
        mesh = mesh.with_points(mesh.points * units.factor(case.unit, units.LENGTH))
    else:
        assert case.mesh is not None  # the schema asks for one of the two
        with under("mesh"):
            mesh = _made(case.mesh)
    if case.up == "y":
        mesh = mesh.with_points(mesh.points @ np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]))
    if case.plane and np.ptp(mesh.points[:, 1]) <= 1e-9 * np.ptp(mesh.points, axis=0).max():
        mesh = mesh.with_points(mesh.points * [1.0, 0.0, 1.0])
    return mesh if case.merge is None else merged(mesh, case.merge)


def _made(case: MadeMesh) -> MeshValue:
    if case.line is not None:
        return MeshValue.line(case.line.from_, case.line.to, case.line.divisions)
    shape = case.box or case.rectangle
    assert shape is not None  # the schema asks for one of the three
    kind = _LINEAR.get(shape.elements, shape.elements)
    if case.box is not None:
        mesh = MeshValue.box(case.box.lengths, case.box.divisions, origin=case.box.origin, kind=kind)
    else:
        assert case.rectangle is not None
        flat = case.rectangle
        mesh = MeshValue.rectangle(
            flat.lengths, flat.divisions, origin=flat.origin, plane=flat.plane, kind=kind
        )
    return mesh if kind == shape.elements else mesh.quadratic()


def merged(mesh: MeshValue, distance: float) -> MeshValue:
    """The mesh with nodes no farther apart than a distance [m] become one, that with the lowest position.

    The others stay in the mesh without elements; sets name those that are left.

    Raises
    ------
    InputError
        If the distance is so large that an element loses a node.
    """
    pairs = mesh.duplicate_nodes(distance)
    ones = (np.ones(len(pairs), dtype=np.int8), (pairs[:, 0], pairs[:, 1]))
    graph = coo_array(ones, shape=(mesh.n_node, mesh.n_node))
    group = connected_components(graph.tocsr(), directed=False)[1]
    first = np.full(group.max(initial=-1) + 1, mesh.n_node, dtype=np.int64)
    np.minimum.at(first, group, np.arange(mesh.n_node))
    target = first[group]
    blocks = []
    for block in mesh.blocks:
        nodes = target[block.nodes]
        ordered = np.sort(nodes, axis=1)
        short = np.flatnonzero(np.any(ordered[:, 1:] == ordered[:, :-1], axis=1))
        if len(short):
            label = int(block.labels[short[0]])
            raise InputError(f"is so large that element {label} loses a node", field="merge")
        blocks.append(replace(block, nodes=nodes))
    sets = {name: np.unique(target[nodes]) for name, nodes in mesh.node_sets.items()}
    return replace(mesh, blocks=tuple(blocks), node_sets=sets)


def is_merged_away(mesh: MeshValue, nodes: IntArray, distance: float | None) -> npt.NDArray[np.bool_]:
    """Which of some nodes have become another one."""
    if distance is None:
        return np.zeros(len(nodes), dtype=bool)
    return np.isin(nodes, mesh.duplicate_nodes(distance)[:, 1])
