"""What a result needs to be drawn: lines, supports and surface of the structure, bodies and wheels of the train.

It goes along in result.nc as the group ``drawing``, so that a result can be shown without its case's files.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import h5netcdf
import h5py
import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.line_points import deck_line
from axlespan.interaction.result import Result
from axlespan.io.strict_json import to_json
from axlespan.model.compile import dof_table
from axlespan.model.model import Model
from axlespan.model.outline import surface
from axlespan.model.parts import BarPart, BeamPart, SpringPart
from axlespan.model.shell_parts import ShellPart
from axlespan.model.stresses import ElementForces
from axlespan.running.geometry import LineGeometry
from axlespan.running.structure import Structure
from axlespan.vehicles.vehicle import Vehicle

FloatArray = npt.NDArray[np.float64]
Arrays = dict[str, npt.NDArray[Any]]

#: Name of the group in result.nc, and of the variable that holds its text.
GROUP, TEXT = "drawing", "content"

# Points of a line between two others are left out if they miss it by no more than this [m].
_STRAIGHT = 1e-6

# Points of the irregularity.
_PROFILE = 1501


@dataclass(frozen=True, eq=False)
class Drawing:
    """Geometry of a crossing, as plain data.

    ``content`` holds ``lines`` (name -> rows of s, x, y, z), ``deck`` (its name), ``supports`` (name,
    components, point), ``vehicles`` (name, overhangs, wheels, bodies, static forces), ``trains`` (name,
    direction, placements as vehicle and distance behind the head, lines of the contacts), ``profile`` (r under the
    first wheel, at even steps) and ``space`` (whether the structure is more than a line). ``arrays`` holds
    ``points`` (n, 3) [m], ``dofs`` (n, 3), the columns of the fields for x, y, z or -1, ``beams`` (n_beam, 2),
    ``springs`` (n_spring, 2), ``faces`` (n_face, 3) and, with fields of solids and shells, ``face_stress``
    (n_field, n_face), von Mises [N/m^2].
    """

    content: Mapping[str, Any]
    arrays: Mapping[str, npt.NDArray[Any]] = field(default_factory=dict)


def drawing_of(crossing: Crossing, result: Result | None = None) -> Drawing:
    """The drawing of a crossing; with a result that has fields, stresses on the surface too."""
    structure = crossing.structure
    kinds = list({id(item.vehicle): item.vehicle for item in crossing.placements}.values())
    number = {id(vehicle): i for i, vehicle in enumerate(kinds)}
    arrays = {} if structure.model is None else _arrays(structure.model, result)
    deck = deck_line(structure)
    content = {
        "lines": {name: _line(structure, name) for name in structure.lines},
        "deck": next((name for name, path in structure.lines.items() if path is deck), None),
        "supports": _supports(structure),
        "structure": structure.name,
        "space": bool(len(arrays.get("faces", ()))),
        "vehicles": [_vehicle(vehicle, crossing.gravity) for vehicle in kinds],
        "trains": [
            {
                "name": run.train.name,
                "direction": run.course.direction,
                "placements": [[number[id(item.vehicle)], item.behind] for item in run.train.placements],
                "lines": [crossing.line_name(name) for name in run.lines],
            }
            for run in crossing.runs
        ],
        "profile": _profile(crossing, result),
    }
    return Drawing(content, arrays)


def _profile(crossing: Crossing, result: Result | None) -> dict[str, Any] | None:
    """The irregularity under the first wheel near the structure; None where it is even."""
    path = crossing.structure.line()
    length = path.stop - path.start
    begin, end = path.start - 0.5 * length, path.stop + 0.5 * length
    if result is not None and result.contact_position.size:
        run = result.contact_position[:, 0]
        begin, end = max(begin, float(run.min())), min(end, float(run.max()))
    if not end > begin:
        return None
    s = np.linspace(begin, end, _PROFILE)
    r = np.asarray(crossing.runs[0].surfaces[0].value(s), dtype=float)
    if not (np.all(np.isfinite(r)) and np.any(r)):
        return None
    return {"from": begin, "step": (end - begin) / (_PROFILE - 1), "r": np.round(r, 8).tolist()}


def _line(structure: Structure, name: str) -> list[list[float]]:
    """Points (s, x, y, z) of a line: its ends and where it bends."""
    geometry = LineGeometry.of(structure, name)
    table = np.column_stack([geometry.position, geometry.points])
    keep = [0]
    for i in range(1, len(table) - 1):
        begin, here, end = table[keep[-1]], table[i], table[i + 1]
        share = (here[0] - begin[0]) / (end[0] - begin[0])
        if np.abs(begin + share * (end - begin) - here).max() > _STRAIGHT:
            keep.append(i)
    rows: list[list[float]] = np.round(table[[*keep, len(table) - 1]], 9).tolist()
    return rows


def _supports(structure: Structure) -> list[dict[str, Any]]:
    """Supports by node: names, components, where."""
    system, model = structure.system, structure.model
    found: dict[str, dict[str, Any]] = {}
    points = {}
    if model is not None:
        points = dict(zip(model.node_labels(), model.points.tolist(), strict=True))
    for full, name in zip(system.independent[system.prescribed], system.support_names, strict=True):
        node, _, component = system.dof_names[int(full)].rpartition(".")
        entry: dict[str, Any] = {"name": name.rpartition(".")[0], "components": [], "point": points.get(node)}
        found.setdefault(node, entry)["components"].append(component)
    return list(found.values())


def _vehicle(vehicle: Vehicle, gravity: float) -> dict[str, Any]:
    try:
        static = vehicle.static_forces(gravity).tolist()
    except InputError:
        static = []
    return {
        "name": vehicle.name,
        "ahead": vehicle.front_overhang if vehicle.length is not None else None,
        "astern": vehicle.rear_overhang if vehicle.length is not None else None,
        "bodies": dict(vehicle.bodies),
        "wheels": [
            {"name": point.name, "behind": point.behind, "dof": point.dof, "line": point.line}
            for point in vehicle.contacts
        ],
        "static_N": static,
    }


def _arrays(model: Model, result: Result | None) -> Arrays:
    """Nodes that something visible has, and what connects them."""
    empty = [np.empty((0, 2), dtype=np.int64)]
    beams = np.concatenate(
        [*empty, *(np.asarray(p.nodes) for p in model.parts if isinstance(p, (BeamPart, BarPart)))]
    )
    springs = np.concatenate(
        [*empty, *(np.asarray(p.nodes) for p in model.parts if isinstance(p, SpringPart))]
    )
    faces, owners = surface(model)
    used = np.unique(np.concatenate([beams.ravel(), springs.ravel(), faces.ravel()]))
    place = np.full(len(model.points), -1, dtype=np.int64)
    place[used] = np.arange(len(used))
    arrays: Arrays = {
        "points": model.points[used],
        "dofs": dof_table(model).number[used, :3].astype(np.int32),
        "beams": place[beams].astype(np.int32),
        "springs": place[springs].astype(np.int32),
        "faces": place[faces].astype(np.int32),
    }
    if len(faces) and result is not None and result.fields is not None:
        arrays["face_stress"] = _face_stress(model, result.fields.displacement, owners)
    return arrays


def _face_stress(model: Model, fields: FloatArray, owners: npt.NDArray[np.int64]) -> npt.NDArray[np.float32]:
    """Von Mises stresses (n_field, n_face) in the middles of the elements behind the faces."""
    forces, thickness = ElementForces.of(model), _thickness(model)
    found = np.full((len(fields), len(owners)), np.nan, dtype=np.float32)
    for i, field_now in enumerate(fields):
        at = forces.at(field_now)
        mises = at["von_mises"][:, 0] if "von_mises" in at else np.full(len(thickness), np.nan)
        if "shell_force" in at:
            sides = [
                _mises(
                    at["shell_force"] / thickness[:, None]
                    + sign * 6.0 * at["shell_moment"] / thickness[:, None] ** 2
                )
                for sign in (1.0, -1.0)
            ]
            mises = np.where(np.isfinite(mises), mises, np.maximum(*sides))
        found[i] = mises[owners]
    return found


def _mises(stress: FloatArray) -> FloatArray:
    """Of stresses (n, 3) in a plane."""
    xx, yy, xy = stress.T
    return np.asarray(np.sqrt(xx**2 - xx * yy + yy**2 + 3.0 * xy**2))


def _thickness(model: Model) -> FloatArray:
    """Thickness (n_element,) of shells; nan elsewhere."""
    return np.concatenate(
        [
            np.broadcast_to(part.thickness if isinstance(part, ShellPart) else np.nan, (len(part.nodes),))
            for part in model.parts
        ]
    )


# --- in a file -------------------------------------------------------------------------------------


def write_drawing(file: h5netcdf.File, drawing: Drawing) -> None:
    """Add a drawing to an open file."""
    group = file.create_group(GROUP)
    text = group.create_variable(TEXT, (), h5py.string_dtype())
    text[...] = to_json(drawing.content)
    for name, values in drawing.arrays.items():
        if not values.size:
            continue
        dimensions = tuple(f"{name}_{axis}" for axis in range(values.ndim))
        for dimension, size in zip(dimensions, values.shape, strict=True):
            group.dimensions[dimension] = size
        storage = {"compression": "gzip", "compression_opts": 1} if values.size > 1024 else {}
        group.create_variable(name, dimensions, values.dtype, data=values, **storage)


def read_drawing(file: h5py.File) -> Drawing | None:
    """The drawing in an open file; None if it has none."""
    if GROUP not in file:
        return None
    group = file[GROUP]
    content = json.loads(group[TEXT].asstr()[()])
    arrays = {
        name: np.asarray(data[...])
        for name, data in group.items()
        if name != TEXT and not name.rpartition("_")[2].isdigit()
    }
    return Drawing(content, arrays)
