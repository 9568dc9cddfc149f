"""A crossing for ParaView: the structure and the wheels at the times of the fields, as .vtu files and a .pvd."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.records.fields import Fields
from axlespan.interaction.result import Result
from axlespan.io.vtk_xml import LINE, VERTEX, Cells, Grid, write_collection, write_grid
from axlespan.linalg.eigen import Modes
from axlespan.model.modal import full_shapes
from axlespan.model.model import Model
from axlespan.model.nodal import nodal_values
from axlespan.model.parts import Part, SpringPart
from axlespan.model.stresses import ElementForces
from axlespan.running.geometry import LineGeometry
from axlespan.running.structure import Structure

FloatArray = npt.NDArray[np.float64]

#: The collection that ParaView opens, and the folder of its files beside it.
COLLECTION, FOLDER = "fields.pvd", "fields"
_PARTS = ("structure", "wheels")

# VTK's numbers of the kinds of elements, whose nodes are in VTK's order.
_TYPES = {
    "tri3": 5,
    "quad4": 9,
    "tet4": 10,
    "hex8": 12,
    "wedge6": 13,
    "tri6": 22,
    "quad8": 23,
    "tet10": 24,
    "hex20": 25,
}


def write_paraview(result: Result, crossing: Crossing, folder: str | PathLike[str]) -> list[str]:
    """Write the fields of a result for ParaView.

    ``fields.pvd`` opens as a series in time of two parts. ``structure`` has the elements of the model with
    ``displacement``, ``rotation`` and ``velocity`` at the nodes, and in the middles of the elements the stresses
    and forces of :data:`axlespan.model.stresses.COMPONENTS_OF`. ``wheels`` has a point for each wheel on the
    undeformed line, with its ``displacement``, ``contact_force`` [N] (on the vehicle, compression positive) and
    ``force_on_structure`` [N], a vector for arrows.

    Parameters
    ----------
    result : Result
        With ``fields``.
    crossing : Crossing
        What was run.
    folder : path
        Of the collection; it is made if it is not there.

    Returns
    -------
    list of str
        The files written, relative to the folder, the collection first.

    Raises
    ------
    InputError
        If the result has no fields, or the structure was given by matrices.
    OSError
        If the folder cannot be written to.
    """
    if result.fields is None or not len(result.fields.times):
        fix = "Ask for them: simulate(..., fields=100), or output: {fields: {every: 100}}"
        raise InputError("has no fields", field="result", fix=fix)
    model, fields = require_model(crossing.structure), result.fields
    place = Path(folder)
    _empty(place / FOLDER)
    grid, forces = _grid(model), ElementForces.of(model)
    head, wheels = grid.head(), _Wheels(crossing)
    entries: list[tuple[float, str, str]] = []
    for i, time in enumerate(fields.times.tolist()):
        names = [f"{FOLDER}/{part}-{i:04d}.vtu" for part in _PARTS]
        motions = {"displacement": fields.displacement[i], "velocity": fields.velocity[i]}
        write_grid(
            place / names[0],
            grid,
            _motion(model, motions),
            forces.at(fields.displacement[i]),
            head=head,
            time=time,
        )
        wheels.write(place / names[1], fields, i)
        entries += [(time, part, name) for part, name in zip(_PARTS, names, strict=True)]
    write_collection(place / COLLECTION, entries)
    return [COLLECTION, *(name for _, _, name in entries)]


def write_modes(structure: Structure, modes: Modes, path: str | PathLike[str]) -> None:
    """Write mode shapes into one .vtu file: a vector ``mode_1`` … at the nodes for each.

    Each is scaled so that its largest displacement is 1.

    Raises
    ------
    InputError
        If the structure was given by matrices.
    """
    model = require_model(structure)
    at_nodes = nodal_values(model, full_shapes(structure.system, modes).T)[..., :3]
    sizes = np.linalg.norm(at_nodes, axis=2).max(axis=1)
    at_nodes = at_nodes / np.where(sizes > 0.0, sizes, 1.0)[:, None, None]
    write_grid(Path(path), _grid(model), {f"mode_{i + 1}": shape for i, shape in enumerate(at_nodes)})


def require_model(structure: Structure) -> Model:
    """The finite element model of a structure.

    Raises
    ------
    InputError
        If it was given by matrices.
    """
    if structure.model is None:
        raise InputError(
            "has no mesh to show: it is given by matrices", field="structure", value=structure.name
        )
    return structure.model


def _empty(folder: Path) -> None:
    """Make the folder, without files of an earlier series."""
    folder.mkdir(parents=True, exist_ok=True)
    for part in _PARTS:
        for old in folder.glob(f"{part}-[0-9]*.vtu"):
            old.unlink()


def _grid(model: Model) -> Grid:
    """The elements of a model, part by part in the order of the model; points without elements stay."""
    cells = [_cells(part, model.points) for part in model.parts]
    parts = np.repeat(np.arange(1, len(cells) + 1), [len(block.nodes) for block in cells])
    return Grid(model.points, cells, {"part": parts.astype(np.int32)})


def _cells(part: Part, points: FloatArray) -> Cells:
    nodes, kind = np.asarray(part.nodes), getattr(part, "kind", "")
    if kind in _TYPES:
        return Cells(_TYPES[kind], nodes)
    if nodes.shape[1] == 2 and not (isinstance(part, SpringPart) and _is_short(nodes, points)):
        return Cells(LINE, nodes)
    return Cells(VERTEX, nodes[:, -1:])


def _is_short(nodes: npt.NDArray[np.int64], points: FloatArray) -> bool:
    """Whether springs join nodes at the same place."""
    return bool(np.all(points[nodes[:, 0]] == points[nodes[:, 1]]))


def _motion(model: Model, motions: dict[str, FloatArray]) -> dict[str, FloatArray]:
    """Vectors at the nodes (n_node, 3)."""
    found: dict[str, FloatArray] = {}
    for name, values in motions.items():
        at_nodes = nodal_values(model, values)
        found[name] = at_nodes[:, :3]
        if name == "displacement" and np.any(at_nodes[:, 3:]):
            found["rotation"] = at_nodes[:, 3:]
    return found


class _Wheels:
    """Points of the wheels on their lines."""

    def __init__(self, crossing: Crossing) -> None:
        self._lines: Sequence[str] = crossing.contact_lines
        self._geometries = {
            line: LineGeometry.of(crossing.structure, line) for line in dict.fromkeys(self._lines)
        }
        numbers = [name.split(".") for name in crossing.contact_names]
        self._data = {
            "vehicle": np.array([int(vehicle) for vehicle, *_ in numbers], dtype=np.int32),
            "contact": np.arange(1, len(numbers) + 1, dtype=np.int32),
        }

    def write(self, path: Path, fields: Fields, i: int) -> None:
        """Write the wheels at the i-th time."""
        position, force = fields.contact_position[i], fields.contact_force[i]
        points = np.zeros((len(position), 3))
        for line, geometry in self._geometries.items():
            mine = np.array([own == line for own in self._lines])
            points[mine] = geometry.at(position[mine])
        cells = [Cells(VERTEX, np.arange(len(points))[:, None])]
        data = {
            "displacement": _upward(fields.contact_displacement[i]),
            "contact_force": force,
            "force_on_structure": _upward(-force),
        }
        write_grid(path, Grid(points, cells, self._data), data, time=float(fields.times[i]))


def _upward(values: FloatArray) -> FloatArray:
    return np.column_stack([np.zeros((len(values), 2)), values])
