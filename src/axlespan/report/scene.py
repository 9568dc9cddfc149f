"""What the animation moves: the line, the vehicles and how hard each wheel presses, at so many times."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.io.dof_units import is_rotation
from axlespan.io.drawing import Drawing
from axlespan.io.train_shapes import Unit
from axlespan.report.legs import deck_height, legs
from axlespan.report.pack import Pack
from axlespan.report.stored import Stored

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Frames, and values of one table over all frames.
_FRAMES, _VALUES = 900, 400_000
_LEAST = 120


def scene(
    stored: Stored,
    pack: Pack,
    drawing: Drawing | None,
    units: Sequence[Unit],
    ends: tuple[float, float] | None,
) -> dict[str, Any] | None:
    """The animation of a crossing; None where nothing moves or nothing is known."""
    if ends is None or len(stored.time) < 2 or not units or not stored.has("contact_position"):
        return None
    frames = _frames(stored, units)
    time = stored.time[frames]
    content: dict[str, Any] = {
        "ends": ends,
        "t": pack.add(time, "f8"),
        "trains": _trains(stored, pack, frames, drawing, units),
        "line": _line(stored, pack, frames),
        "ratio": _ratio(stored, pack, frames),
        "units": [_unit(unit) for unit in units],
        "moves": _moves(stored, pack, frames, units),
        "supports": _supports(drawing, ends),
        "legs": legs(drawing),
        "profile": _profile(pack, drawing),
        "notes": [],
    }
    content["most"] = _largest_motion(stored, frames)
    if drawing is not None and _on_track(drawing):
        content["notes"].append(
            "The track is drawn on the deck: wheels sink into it by as much as the rail deflects against the deck."
        )
    if content["line"] is None:
        content["notes"].append(
            "The motion along the line was not kept (output: line: 0), so the structure is drawn at rest."
        )
    return content


def _trains(
    stored: Stored, pack: Pack, frames: IntArray, drawing: Drawing | None, units: Sequence[Unit]
) -> list[dict[str, Any]]:
    """Each train: where its first wheel is, and which way it runs."""
    known = [] if drawing is None else drawing.content.get("trains", [])
    found = []
    for number in sorted({unit.train for unit in units}):
        first = min(wheel[0] for unit in units if unit.train == number for wheel in unit.wheels)
        direction = int(known[number]["direction"]) if number < len(known) else 1
        column = stored.column("contact_position", first)[frames]
        found.append({"head": pack.add(column, "f8"), "direction": direction})
    return found


def _profile(pack: Pack, drawing: Drawing | None) -> dict[str, Any] | None:
    """The irregularity that the wheels of the first train run on."""
    known = None if drawing is None else drawing.content.get("profile")
    return (
        None if known is None else {"from": known["from"], "step": known["step"], "r": pack.add(known["r"])}
    )


def _on_track(drawing: Drawing) -> bool:
    """Whether wheels run on another line than that of the deck."""
    lines = {name for train in drawing.content.get("trains", []) for name in train["lines"]}
    ends = {name: (rows[0][0], rows[-1][0]) for name, rows in drawing.content.get("lines", {}).items()}
    deck = ends.get(drawing.content.get("deck") or "")
    return deck is not None and any(ends.get(name, deck) != deck for name in lines)


def _largest_motion(stored: Stored, frames: IntArray) -> float:
    """Largest vertical motion of a vehicle's part [m]."""
    if not stored.has("vehicle_displacement"):
        return 0.0
    vertical = [i for i, name in enumerate(stored.names("vehicle_dof")) if name.endswith(".z")]
    table = stored.rows("vehicle_displacement", frames)[:, vertical]
    return float(np.nanmax(np.abs(table), initial=0.0))


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
    return {
        "x": pack.add(positions, "f8"),
        "w": pack.quantized(table),
        "most": float(np.nanmax(np.abs(table))),
    }


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
        "train": unit.train,
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
    below: dict[float, float] = {}
    for item in [] if drawing is None else drawing.content.get("supports", []):
        point = item.get("point")
        if point is not None and "z" in item["components"] and ends[0] - 1.0 <= point[0] <= ends[1] + 1.0:
            place = round(float(point[0]), 3)
            found[place] = found.get(place, False) or "x" in item["components"]
            if drawing is not None and not drawing.content.get("space"):
                below[place] = max(below.get(place, 0.0), deck_height(drawing) - float(point[2]))
    return [{"x": x, "fixed": fixed, "below": below.get(x, 0.0)} for x, fixed in sorted(found.items())]
