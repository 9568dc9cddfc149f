"""Vehicles from meshes and matrices: their wheels, from the foremost on, and the names of their d.o.f."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.model.damping import Modal
from axlespan.model.system import System
from axlespan.study.build_matrices import system_of
from axlespan.study.build_model import MeshModel, model_of
from axlespan.study.build_supports import damping_of
from axlespan.study.case_placing import Placed
from axlespan.study.case_vehicle_imported import MatricesVehicle, MeshVehicle, Wheels
from axlespan.study.matrix_body import RowBook, matrices_of
from axlespan.study.mesh_checks import require_held
from axlespan.vehicles import ContactPoint, Vehicle

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# What results call a node without a name of its own.
_UNNAMED = re.compile(r"n?-?\d+")


@dataclass(frozen=True)
class _Wheel:
    """Where a wheel touches the track."""

    node: str  # name of its node in the d.o.f.
    behind: float  # the first wheel [m]
    line: str


def vehicle_of_mesh(case: MeshVehicle, gravity: float) -> Vehicle:
    """Build the vehicle of a mesh.

    Raises
    ------
    InputError
        If the mesh or its wheels are wrong, or a part of it hangs on no wheel; fields are paths under the
        entry of the train.
    """
    law = damping_of(case.damping)
    if isinstance(law, Modal):
        rule = "must be of the kind rayleigh for vehicles"
        raise InputError(rule, field="damping", fix="Write {kind: rayleigh, alpha: 0 1/s, beta: 0.1 ms}")
    built = model_of(case, case.supports, law)
    groups = case.wheels if isinstance(case.wheels, tuple) else (Wheels(at=case.wheels),)
    if not groups:
        raise InputError("must have at least one wheel", field="wheels")
    places = [f"wheels.{i}.at" for i in range(len(groups))] if groups is case.wheels else ["wheels"]
    chosen = [_nodes_of(built, group, place) for group, place in zip(groups, places, strict=True)]
    every = np.concatenate(chosen)
    if len(np.unique(every)) < len(every):
        raise InputError("names a node twice", field="wheels")
    require_held(built, every, "wheel", "wheels")
    labels = built.model.node_labels()
    points = built.model.points[every]
    lines = [group.line for group, nodes in zip(groups, chosen, strict=True) for _ in nodes]
    order = np.lexsort([-points[:, 1], -points[:, 0]])
    front = float(points[:, 0].max())
    wheels = [_Wheel(labels[every[i]], front - float(points[i, 0]), lines[i]) for i in order.tolist()]
    name = case.file.stem if case.file is not None else "mesh"
    return _vehicle(case, built.compiled.system, wheels, name, gravity)


def _nodes_of(built: MeshModel, group: Wheels, place: str) -> IntArray:
    nodes = built.book.chosen(group.at, place)
    labels = built.model.node_labels()
    known = set(built.compiled.system.dof_names)
    lost = [i for i in nodes.tolist() if f"{labels[i]}.z" not in known]
    if lost:
        rule = f"has nodes without a vertical d.o.f.: {built.book.shown(np.array(lost))}"
        raise InputError(rule, field=place, fix="Choose nodes of elements or springs")
    return nodes


def vehicle_of_matrices(case: MatricesVehicle, gravity: float) -> Vehicle:
    """Build the vehicle of matrices.

    Raises
    ------
    InputError
        If the matrices or the wheels are wrong; fields are paths under the entry of the train.
    """
    model, book = matrices_of(case, case.damping)
    if not book.is_named:
        rule = "is missing; the weight acts on the vertical d.o.f."
        raise InputError(rule, field="dofs", fix="Add dofs: rows.csv, or dofs: [body.z, body.pitch, ...]")
    system = system_of(model, book, case.supports, None)
    rows = [_row_of(case, book, number) for number in range(len(case.wheels))]
    behind = _behind(case, book, rows)
    wheels = [
        _Wheel(book.names[row].rpartition(".")[0], x, wheel.line)
        for row, x, wheel in zip(rows, behind, case.wheels, strict=True)
    ]
    wheels.sort(key=lambda wheel: wheel.behind)
    assert case.stiffness is not None  # the schema asks for it
    return _vehicle(case, system, wheels, case.stiffness.stem, gravity)


def _row_of(case: MatricesVehicle, book: RowBook, number: int) -> int:
    wheel, place = case.wheels[number], f"wheels.{number}"
    if wheel.dof is not None:
        row = book.row_of(wheel.dof, f"{place}.dof")
        if book.dofs.components[row] != "z":
            raise InputError(
                f"must be vertical: {book.names[row]} is not", field=f"{place}.dof", fix="Name a d.o.f. in z"
            )
        return row
    assert wheel.node is not None  # the schema asks for one of the two
    node = book.nodes.one(wheel.node, f"{place}.node")
    row = int(book.rows(np.array([node]), "z")[0])
    if row < 0:
        raise InputError("has no vertical d.o.f. in the matrices", field=f"{place}.node")
    return row


def _behind(case: MatricesVehicle, book: RowBook, rows: Sequence[int]) -> list[float]:
    """Distances of the wheels behind the first one [m], given or from the coordinates."""
    given = [wheel.position for wheel in case.wheels if wheel.position is not None]
    if len(given) == len(case.wheels):
        return given
    numbers = book.dofs.nodes[np.array(rows)]
    places = book.nodes.points[np.searchsorted(book.node_numbers, numbers), 0]
    return [float(x) for x in places.max() - places]


def _vehicle(case: Placed, system: System, wheels: Sequence[_Wheel], name: str, gravity: float) -> Vehicle:
    names = {dof.rpartition(".")[0] for dof in system.dof_names}
    renamed = {
        wheel.node: f"wheel{i + 1}"
        for i, wheel in enumerate(wheels)
        if _UNNAMED.fullmatch(wheel.node) and f"wheel{i + 1}" not in names
    }
    new = {
        dof: f"{renamed[node]}.{component}"
        for dof in system.dof_names
        for node, _, component in [dof.rpartition(".")]
        if node in renamed
    }
    contacts = tuple(
        ContactPoint(str(i + 1), wheel.behind, f"{renamed.get(wheel.node, wheel.node)}.z", wheel.line)
        for i, wheel in enumerate(wheels)
    )
    vehicle = Vehicle(contacts, system.renamed(new), name, is_multibody=False)
    case.require_room(max(point.behind for point in contacts))
    try:
        vehicle.static_forces(gravity)
    except InputError as error:
        if error.rule.startswith("must stand on its wheels"):
            fix = "Hold what wheels don't: supports: [{at: wheels, fixed: [y]}, ...], or join its parts"
            raise InputError(error.rule, fix=fix) from error
        raise
    return vehicle
