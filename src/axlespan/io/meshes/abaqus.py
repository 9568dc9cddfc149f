"""Abaqus input files in: nodes, elements and sets, flat or as parts and instances."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from os import PathLike

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError, Place
from axlespan.io.lines import load_bytes, numbers_of, text_of
from axlespan.io.meshes.abaqus_keywords import Keyword, keywords_of
from axlespan.io.meshes.abaqus_sets import Scope, SetDefinition, resolve
from axlespan.io.meshes.abaqus_types import KIND_OF_TYPE, VTK_FROM_ABAQUS
from axlespan.io.meshes.assemble import (
    LARGEST_COORDINATE,
    ElementRows,
    Lookup,
    NodeRows,
    Unsupported,
    assemble,
    refuse,
    split_by_block,
)
from axlespan.model.mesh import CELL_KINDS, Mesh

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Keywords that make or place nodes and elements and aren't supported; passing over them would be wrong.
_GENERATORS = {
    **{
        name: "Let the preprocessor write all nodes and elements."
        for name in ("NGEN", "NFILL", "NCOPY", "NMAP")
    },
    **{name: "Let the preprocessor write all nodes and elements." for name in ("ELGEN", "ELCOPY", "UEL")},
    "SYSTEM": "Write the coordinates in the global system.",
    "INCLUDE": "Put the content of the included file in its place.",
    "SUBMODEL": "Export the whole model.",
}


@dataclass
class _Part:
    """Nodes, elements and sets of a part, as they are found."""

    nodes: list[NodeRows] = field(default_factory=list)
    elements: list[ElementRows] = field(default_factory=list)
    node_sets: list[SetDefinition] = field(default_factory=list)
    element_sets: list[SetDefinition] = field(default_factory=list)


@dataclass(frozen=True, eq=False)
class _Instance:
    """A part placed in the assembly."""

    name: str
    part: _Part
    translation: FloatArray = field(default_factory=lambda: np.zeros(3))
    axis: FloatArray = field(default_factory=lambda: np.zeros((2, 3)))  # two points on the axis of rotation
    angle: float = 0.0  # [rad]

    def placed(self, mesh: Mesh) -> Mesh:
        """The mesh moved, then turned about the axis (Rodrigues)."""
        points, origin = mesh.points + self.translation, self.axis[0]
        direction = self.axis[1] - origin
        length = float(np.linalg.norm(direction))
        if self.angle and length:
            a, arms = direction / length, points - origin
            along = np.outer(arms @ a, a)
            points = (
                origin + along + np.cos(self.angle) * (arms - along) + np.sin(self.angle) * np.cross(a, arms)
            )
        return mesh.with_points(points)


def read_abaqus(path: str | PathLike[str]) -> Mesh:
    """Read the mesh of an Abaqus input file.

    Read are ``*NODE``, ``*ELEMENT``, ``*NSET`` and ``*ELSET`` (also ``GENERATE``, sets of sets, nodes of an
    element set), ``*PART``, ``*INSTANCE`` (moved and turned) and ``*ASSEMBLY``. With one instance sets keep
    their names; with several, the sets of an instance are called ``instance.set``. Materials, sections,
    loads and steps are passed over: give them in the case file by the names of the sets.

    Parameters
    ----------
    path : path
        The file.

    Returns
    -------
    Mesh

    Raises
    ------
    InputError
        If the file is damaged, generates nodes or elements, or holds an element type that isn't supported.

    References
    ----------
    Abaqus Keywords Guide; Abaqus Elements Guide (node ordering).
    """
    file = str(path)
    reader = _Reader(file)
    for keyword in keywords_of(file, text_of(load_bytes(path), file)):
        reader.take(keyword)
    return reader.mesh()


class _Reader:
    """Collects parts, instances and sets from keywords in the order of the file."""

    def __init__(self, file: str) -> None:
        self.file = file
        self.assembly = _Part()  # of a flat file: the whole model
        self.parts: dict[str, _Part] = {}
        self.instances: dict[str, _Instance] = {}  # by name in upper case
        self.current = self.assembly
        self.strange: list[Unsupported] = []

    def take(self, keyword: Keyword) -> None:
        """Read a keyword block, or pass over it."""
        readers = {
            **{"NODE": self._node, "ELEMENT": self._element, "NSET": self._set, "ELSET": self._set},
            **{"PART": self._part, "INSTANCE": self._instance},
        }
        name = keyword.name
        if name in _GENERATORS and not (
            name == "SYSTEM" and not keyword.data
        ):  # without data: back to global axes
            raise InputError("is not supported", field=f"*{name}", place=keyword.place, fix=_GENERATORS[name])
        if name in readers:
            if "INPUT" in keyword.parameters:
                fix = "Put the content of that file in its place."
                raise InputError(
                    "with INPUT is not supported", field=f"*{name}", place=keyword.place, fix=fix
                )
            readers[name](keyword)
        elif name in ("END PART", "END INSTANCE", "END ASSEMBLY", "ASSEMBLY"):
            self.current = self.assembly

    def _part(self, keyword: Keyword) -> None:
        name = keyword.required("NAME").upper()
        if name in self.parts:
            raise InputError("is already the name of a part", field="*PART", value=name, place=keyword.place)
        self.current = self.parts[name] = _Part()

    def _instance(self, keyword: Keyword) -> None:
        name, part = keyword.required("NAME"), keyword.parameters.get("PART", "")
        if name.upper() in self.instances:
            raise InputError(
                "is already the name of an instance", field="*INSTANCE", value=name, place=keyword.place
            )
        if part and part.upper() not in self.parts:
            raise InputError("is not a part of the file", field="*INSTANCE", value=part, place=keyword.place)
        rows = keyword.words()
        numbers = [numbers_of([row], width) for row, width in zip(rows, (3, 7), strict=False)]
        if len(rows) > 2 or any(v is None or not np.all(np.abs(v) <= LARGEST_COORDINATE) for v in numbers):
            rule = "must be followed by a translation (3 numbers) and a rotation (7 numbers), or by less"
            raise InputError(rule, field="*INSTANCE", value=name, place=keyword.place)
        moves = np.concatenate([np.zeros((0,)), *(values[0] for values in numbers if values is not None)])
        moves = np.concatenate([moves, np.zeros(10 - len(moves))])
        own = self.parts[part.upper()] if part else _Part()
        angle = float(np.deg2rad(moves[9]))
        self.instances[name.upper()] = _Instance(name, own, moves[:3], moves[3:9].reshape(2, 3), angle)
        self.current = own

    def _node(self, keyword: Keyword) -> None:
        if keyword.parameters.get("SYSTEM", "R").upper() != "R":
            fix = "Write the coordinates in the global rectangular system."
            raise InputError("must be R (rectangular)", field="*NODE, SYSTEM", place=keyword.place, fix=fix)
        labels, points = keyword.node_table()
        self.current.nodes.append(NodeRows(labels, points, keyword.numbers, keyword.numbers))
        if keyword.parameters.get("NSET"):
            self.current.node_sets.append(SetDefinition(keyword.parameters["NSET"], keyword, "", labels))

    def _element(self, keyword: Keyword) -> None:
        name = keyword.required("TYPE").upper()
        if name not in KIND_OF_TYPE:
            self.strange.append(Unsupported(f"Abaqus type {name}", len(keyword.data), keyword.line))
            return
        kind = KIND_OF_TYPE[name]
        rows, lines = keyword.records(1 + CELL_KINDS[kind].node_count, f"{name} element and its nodes")
        nodes = rows[:, 1:][:, VTK_FROM_ABAQUS[kind]] if kind in VTK_FROM_ABAQUS else rows[:, 1:]
        self.current.elements.append(ElementRows(kind, rows[:, 0], nodes, lines))
        if keyword.parameters.get("ELSET"):
            self.current.element_sets.append(
                SetDefinition(keyword.parameters["ELSET"], keyword, "", rows[:, 0])
            )

    def _set(self, keyword: Keyword) -> None:
        name = keyword.required(keyword.name)
        instance = keyword.parameters.get("INSTANCE", "").upper()
        if instance and instance not in self.instances:
            raise InputError(
                "is not an instance of the file",
                field=f"*{keyword.name}",
                value=instance,
                place=keyword.place,
            )
        sets = self.current.node_sets if keyword.name == "NSET" else self.current.element_sets
        sets.append(SetDefinition(name, keyword, instance))

    def mesh(self) -> Mesh:
        """The whole mesh."""
        refuse(self.file, self.strange)
        if not self.instances:  # parts without an assembly stand as they are
            self.instances = {name: _Instance(name, part) for name, part in self.parts.items()}
        return _assembled(self.file, self.assembly, self.instances)


def _assembled(file: str, assembly: _Part, instances: Mapping[str, _Instance]) -> Mesh:
    """Merge the instances and the assembly's own nodes, and resolve the sets of all of them."""
    mesh = Mesh(np.empty((0, 3)))
    node_scopes: dict[str, Scope] = {}
    element_scopes: dict[str, Scope] = {}
    node_sets: dict[str, IntArray] = {}
    element_sets: dict[str, IntArray] = {}
    for key, instance in [*instances.items(), ("", _Instance("", assembly))]:
        own = assemble(file, NodeRows.joined(instance.part.nodes), instance.part.elements, {}, {})
        labels = np.concatenate([np.empty(0, dtype=np.int64), *(block.labels for block in own.blocks)])
        nodes = _scope(file, own.node_labels, mesh.n_node, "node")
        elements = _scope(file, labels, mesh.n_element, "element")
        mesh = mesh.merged(instance.placed(own))
        of_blocks = resolve(instance.part.element_sets, elements, element_scopes)
        used = {name.upper(): _nodes_of(mesh, members) for name, members in of_blocks.items()}
        of_nodes = resolve(instance.part.node_sets, nodes, node_scopes, used)
        node_scopes[key] = replace(nodes, sets={name.upper(): members for name, members in of_nodes.items()})
        element_scopes[key] = replace(
            elements, sets={name.upper(): members for name, members in of_blocks.items()}
        )
        prefix = f"{instance.name}." if key and len(instances) > 1 else ""
        for found, target in ((of_nodes, node_sets), (of_blocks, element_sets)):
            for name, members in found.items():
                target[prefix + name] = np.union1d(target.get(prefix + name, members[:0]), members)
    if not mesh.n_node:
        fix = "Write the model with *NODE and *ELEMENT."
        raise InputError("has no nodes", field="mesh", place=Place(file), fix=fix)
    bounds = np.cumsum([0, *(len(block) for block in mesh.blocks)])
    split = {name: split_by_block(members, bounds) for name, members in element_sets.items()}
    return replace(mesh, node_sets=node_sets, element_sets=split)


def _scope(file: str, labels: IntArray, first: int, what: str) -> Scope:
    return Scope(labels, Lookup(labels, np.zeros_like(labels), file, what), first)


def _nodes_of(mesh: Mesh, elements: IntArray) -> IntArray:
    """Nodes of elements that are counted through all blocks."""
    bounds = np.cumsum([0, *(len(block) for block in mesh.blocks)])
    used = [mesh.blocks[block].nodes[inside].ravel() for block, inside in split_by_block(elements, bounds)]
    return np.unique(np.concatenate([np.empty(0, dtype=np.int64), *used]))
