"""The vehicles of a result: from its drawing, or from its names where it has none."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from axlespan.io import train_shapes
from axlespan.io.drawing import Drawing
from axlespan.io.train_shapes import LOW, Unit
from axlespan.report.stored import Stored


def units_of(stored: Stored, drawing: Drawing | None) -> list[Unit]:
    """The vehicles of a result; from names and positions of contacts where it has no drawing."""
    if drawing is None or not drawing.content.get("trains"):
        return train_shapes.train_of(0, _from_names(stored), 0, 0, [])
    return train_shapes.units_of(drawing.content)


def _from_names(stored: Stored) -> list[tuple[dict[str, Any], float]]:
    """Vehicles by the names of contacts (vehicle.wheel) and d.o.f. (vehicle.part.component)."""
    contacts, dofs = stored.names("contact"), set(stored.names("vehicle_dof"))
    if not contacts or not stored.has("contact_position"):
        return []
    first = stored.rows("contact_position", np.array([0]))[0]
    behind = first.max() - first
    found = []
    for vehicle in dict.fromkeys(name.partition(".")[0] for name in contacts):
        mine = [i for i, name in enumerate(contacts) if name.partition(".")[0] == vehicle]
        start = float(behind[mine].min())
        wheels = []
        for i in mine:
            dof = f"wheel{contacts[i].partition('.')[2]}.z"
            wheels.append(
                {"behind": float(behind[i]) - start, "dof": dof if f"{vehicle}.{dof}" in dofs else None}
            )
        parts = dict.fromkeys(
            name.split(".")[1]
            for name in stored.names("vehicle_dof")
            if name.startswith(f"{vehicle}.") and ".wheel" not in name and name.count(".") == 2
        )
        found.append(
            ({"name": f"vehicle {vehicle}", "wheels": wheels, "bodies": _spread(parts, wheels)}, start)
        )
    return found


def _spread(parts: Mapping[str, None], wheels: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    """Centers of bodies of which only the names are known: bogies over equal shares of the wheels."""
    places = [float(wheel["behind"]) for wheel in wheels]
    centers: dict[str, float] = {}
    for group in ([p for p in parts if LOW.search(p)], [p for p in parts if not LOW.search(p)]):
        for i, name in enumerate(group):
            share = np.array_split(np.array(places), len(group))[i]
            centers[name] = float(share.mean()) if len(share) else float(np.mean(places))
    return centers
