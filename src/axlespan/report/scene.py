"""What the animation moves: the line, the vehicles and how hard each wheel presses, at so many times."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.io.dof_units import is_rotation
from axlespan.io.drawing import Drawing
from axlespan.report.pack import Pack
from axlespan.report.shapes import Unit
from axlespan.report.stored import Stored

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Frames, and values of one table over all frames.
_FRAMES, _VALUES = 900, 400_000
_LEAST = 120


def scene(
    stored: Stored, pack: Pack, drawing: Drawing | None, units: Sequence[Unit], ends: tuple[float, float] | None
) -> dict[str, Any] | None:
    """The animation of a crossing; None where nothing moves or nothing is known."""
    if ends is None or len(stored.time) < 2 or not units or not stored.has("contact_position"):
        return None
    frames = _frames(stored, units)
    time = stored.time[frames]
    content: dict[str, Any] = {
        "ends": ends,
        "t": pack.add(time, "f8"),
        "head": pack.add(stored.column("contact_position", 0)[frames], "f8"),
        "line": _line(stored, pack, frames),
        "ratio": _ratio(stored, pack, frames),
        "units": [_unit(unit) for unit in units],
        "moves": _moves(stored, pack, frames, units),
        "supports": _supports(drawing, ends),
        "notes": [],
    }
    if content["line"] is None:
        content["notes"].append(
            "The motion along the line was not kept (output: line: 0), so the structure is drawn at rest."
        )
    return content


def _frames(stored: Stored, units: Sequence[Unit]) -> IntArray:
    """Rows of the frames: evenly over time, fewer for long trains."""
    dofs = max(len(stored.names("vehicle_dof")) + len(stored.names("contact")), 1)
    count = int(np.clip(_VALUES // dofs, _LEAST, _FRAMES))
    n = len(stored.time)
    return np.unique(np.linspace(0, n - 1, min(count, n)).round().astype(np.int64))


def _line(stored: Stored, pack: Pack, frames: IntArray) -> dict[str, Any] | None:
    positions = stored.numbers("line_position")
    if len(positions) < 2 or not stored.has("line_displacement"):
        return None
    table = stored.rows("line_displacement", frames)
    return {"x": pack.add(positions, "f8"), "w": pack.quantized(table), "most": float(np.nanmax(np.abs(table)))}


def _ratio(stored: Stored, pack: Pack, frames: IntArray) -> dict[str, Any] | None:
    """Contact forces over static ones (frame, contact); nan where there is no static one."""
    if not stored.has("contact_force"):
        return None
    known = stored.content("checks").get("static_contact_force") or {}
    static = np.array([float(known.get(name) or np.nan) for name in stored.names("contact")])
    ratio = stored.rows("contact_force", frames) / static
    return pack.quantized(np.clip(ratio, -1.0, 3.0)) if np.isfinite(static).any() else None


def _unit(unit: Unit) -> dict[str, Any]:
    return {
        "name": unit.name,
        "front": unit.front,
        "rear": unit.rear,
        "wheels": [list(wheel) for wheel in unit.wheels],
        "boxes": [[box.name, box.center, box.length, box.bottom, box.top, box.low] for box in unit.boxes],
    }


def _moves(stored: Stored, pack: Pack, frames: IntArray, units: Sequence[Unit]) -> dict[str, Any]:
    """Vertical motions and rotations of bodies and wheels, by name of their d.o.f."""
    names = stored.names("vehicle_dof")
    if not stored.has("vehicle_displacement"):
        return {}
    drawn = {dof for unit in units for _, _, dof, _ in unit.wheels}
    drawn |= {f"{box.name}.{end}" for unit in units for box in unit.boxes for end in ("z", "pitch", "ry")}
    columns = [i for i, name in enumerate(names) if name in drawn]
    if not columns:
        return {}
    table = stored.rows("vehicle_displacement", frames)[:, columns]
    found = {}
    for kind, mine in (
        ("z", [k for k, i in enumerate(columns) if not is_rotation(names[i])]),
        ("pitch", [k for k, i in enumerate(columns) if is_rotation(names[i])]),
    ):
        if mine:
            labels = [names[columns[k]] for k in mine]
            found[kind] = {"names": labels, "values": pack.quantized(table[:, mine])}
    return found


def _supports(drawing: Drawing | None, ends: tuple[float, float]) -> list[dict[str, Any]]:
    """Places of vertical supports along the line."""
    found: dict[float, bool] = {}
    for item in [] if drawing is None else drawing.content.get("supports", []):
        point = item.get("point")
        if point is not None and "z" in item["components"] and ends[0] - 1.0 <= point[0] <= ends[1] + 1.0:
            place = round(float(point[0]), 3)
            found[place] = found.get(place, False) or "x" in item["components"]
    return [{"x": x, "fixed": fixed} for x, fixed in sorted(found.items())]
