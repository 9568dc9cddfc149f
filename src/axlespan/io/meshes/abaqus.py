"""Abaqus input files in: nodes, elements and sets, flat or as parts and instances; all else is passed over."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from os import PathLike

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.io.lines import load_bytes, text_of
from axlespan.io.meshes.abaqus_keywords import Keyword, keywords_of
from axlespan.io.meshes.abaqus_sets import SetDefinition, Sets
from axlespan.io.meshes.abaqus_types import KIND_OF_TYPE, VTK_FROM_ABAQUS
from axlespan.io.meshes.assemble import ElementRows, NodeRows, Unsupported, assemble, refuse
from axlespan.model.mesh import CELL_KINDS, Mesh

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Keywords that make or place nodes and elements in a way that isn't supported: passing over them would be wrong.
_GENERATORS = {
    **{name: "Let the preprocessor write all nodes and elements." for name in ("NGEN", "NFILL", "NCOPY", "NMAP")},
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

    def mesh(self, file: str) -> Mesh:
        """The part as a mesh, in its own axes."""
        nodes = NodeRows.joined(self.nodes)
        labels = np.concatenate([np.empty(0, dtype=np.int64), *(rows.labels for rows in self.elements)])
        element_sets = Sets(self.element_sets, labels).resolved()
        of_elements = {
            name: np.concatenate([rows.nodes[np.isin(rows.labels, chosen)].ravel() for rows in self.elements])
            for name, chosen in element_sets.items()
        }
        node_sets = Sets(self.node_sets, nodes.labels, of_elements).resolved()
        return assemble(file, nodes, self.elements, node_sets, element_sets)


@dataclass(frozen=True, eq=False)
class _Instance:
    """A part placed in the assembly."""

    name: str
    part: _Part
    translation: FloatArray
    axis: FloatArray  # (2, 3) two points of the axis of rotation
    angle: float  # [rad]

    def placed(self, mesh: Mesh) -> Mesh:
        """The mesh moved, then turned about the axis (Rodrigues)."""
        points, origin = mesh.points + self.translation, self.axis[0]
        direction = self.axis[1] - origin
        length = float(np.linalg.norm(direction))
        if self.angle and length:
            a, arms = direction / length, points - origin
            along = np.outer(arms @ a, a)
            points = origin + along + np.cos(self.angle) * (arms - along) + np.sin(self.angle) * np.cross(a, arms)
        return mesh.with_points(points)


def read_abaqus(path: str | PathLike[str]) -> Mesh:
    """Read the mesh of an Abaqus input file.

    Read are ``*NODE``, ``*ELEMENT``, ``*NSET`` and ``*ELSET`` (also ``GENERATE``, sets of sets, nodes of an element
    set), ``*PART``, ``*INSTANCE`` (moved and turned) and ``*ASSEMBLY``. With one instance sets keep their names; with
    several, the sets of an instance are called ``instance.set``. Materials, sections, loads and steps are
    passed over: give them in the case file by the names of the sets.

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
        self.instances: dict[str, _Instance] = {}
        self.assembly_sets: list[tuple[str, SetDefinition]] = []  # with the instance that they refer to
        self.current = self.assembly
        self.strange: list[Unsupported] = []

    def take(self, keyword: Keyword) -> None:
        """Read a keyword block, or pass over it."""
        name = keyword.name
        if name in _GENERATORS:
            raise InputError("is not supported", field=f"*{name}", place=keyword.place, fix=_GENERATORS[name])
        if name in ("NODE", "ELEMENT", "NSET", "ELSET", "PART", "INSTANCE"):
            if "INPUT" in keyword.parameters:
                fix = "Put the content of that file in its place."
                raise InputError("with INPUT is not supported", field=f"*{name}", place=keyword.place, fix=fix)
            getattr(self, f"_{name.lower()}")(keyword)
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
            raise InputError("is already the name of an instance", field="*INSTANCE", value=name, place=keyword.place)
        if part and part.upper() not in self.parts:
            raise InputError("is not a part of the file", field="*INSTANCE", value=part, place=keyword.place)
        rows = [_floats(keyword, i, row) for i, row in enumerate(keyword.words())]
        if len(rows) > 2 or (rows and len(rows[0]) != 3) or (len(rows) == 2 and len(rows[1]) != 7):
            rule = "must be followed by a translation (3 numbers) and a rotation (7 numbers), or less"
            raise InputError(rule, field="*INSTANCE", value=name, place=keyword.place)
        shift = np.array(rows[0]) if rows else np.zeros(3)
        turn = np.array(rows[1]) if len(rows) == 2 else np.zeros(7)
        own = self.parts[part.upper()] if part else _Part()
        axis, angle = turn[:6].reshape(2, 3), float(np.deg2rad(turn[6]))
        self.instances[name.upper()] = _Instance(name, own, shift, axis, angle)
        self.current = own

    def _node(self, keyword: Keyword) -> None:
        if keyword.parameters.get("SYSTEM", "R").upper() != "R":
            fix = "Write the coordinates in the global rectangular system."
            raise InputError("must be R (rectangular)", field="*NODE, SYSTEM", place=keyword.place, fix=fix)
        labels, points = keyword.node_table()
        self.current.nodes.append(NodeRows(labels, points, keyword.numbers))
        if keyword.parameters.get("NSET"):
            self.current.node_sets.append(SetDefinition.of_labels(keyword, keyword.parameters["NSET"], labels))

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
            definition = SetDefinition.of_labels(keyword, keyword.parameters["ELSET"], rows[:, 0])
            self.current.element_sets.append(definition)

    def _nset(self, keyword: Keyword) -> None:
        self._set(keyword, "NSET", self.current.node_sets)

    def _elset(self, keyword: Keyword) -> None:
        self._set(keyword, "ELSET", self.current.element_sets)

    def _set(self, keyword: Keyword, what: str, target: list[SetDefinition]) -> None:
        definition = SetDefinition.of_keyword(keyword, keyword.required(what))
        instance = keyword.parameters.get("INSTANCE", "").upper()
        if not instance:
            target.append(definition)
        elif instance not in self.instances:
            raise InputError("is not an instance of the file", field=f"*{what}", value=instance, place=keyword.place)
        else:
            self.assembly_sets.append((instance, definition))

    def mesh(self) -> Mesh:
        """The whole mesh."""
        refuse(self.file, self.strange)
        if not self.instances and len(self.parts) == 1:
            return next(iter(self.parts.values())).mesh(self.file)  # a part alone
        flat = not self.instances
        mesh = (self.assembly if flat else _without_references(self.assembly, self.instances)).mesh(self.file)
        for key, instance in self.instances.items():
            own = instance.placed(instance.part.mesh(self.file))
            if len(self.instances) > 1:
                own = _prefixed(own, instance.name)
            for owner, definition in self.assembly_sets:
                if owner == key:
                    own = _with_set(own, definition)
            mesh = mesh.merged(own) if mesh.n_node else own
        if not mesh.n_node:
            raise InputError("has no nodes", field="mesh", value=self.file, fix="Write the model with *NODE and *ELEMENT.")
        return _united(mesh)
