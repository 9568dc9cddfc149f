"""What a train looks like from the side: bodies, bogies and wheels, from its geometry or from its names."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from axlespan.io.drawing import Drawing
from axlespan.report.stored import Stored

# Sizes [m] of what a model of masses and springs does not say; vehicles look like rolling stock with them.
WHEEL_RADIUS = 0.46
_BOGIE = (0.45, 0.95)  # bottom and top of a bogie
_BODY = (1.05, 3.75)  # of a car body
_SMALL = (1.05, 2.35)  # of the body of a single sprung mass
_OVERHANG, _GAP = 2.6, 0.5  # of a body over its last wheels; between bodies
_FREE = 2.4  # length of a body on one wheel

#: Names of parts that stand below the car body.
LOW = re.compile(r"bogie|truck|frame|wheelset", re.IGNORECASE)


@dataclass(frozen=True)
class Box:
    """A body seen from the side."""

    name: str
    center: float  # behind the head of the train [m]
    length: float  # [m]
    bottom: float  # above the rail [m]
    top: float
    low: bool  # whether it is a bogie


@dataclass(frozen=True)
class Unit:
    """A vehicle of the train."""

    number: int  # from 1, from the head of the first train on
    train: int  # from 0
    name: str
    front: float  # behind the head of the train [m]; negative is before its first wheel
    rear: float
    wheels: tuple[tuple[int, float, str, str], ...]  # contact, behind the head [m], name of its d.o.f. (or empty), line
    boxes: tuple[Box, ...]
    static: tuple[float, ...] = ()  # [N] of each wheel


def units_of(stored: Stored, drawing: Drawing | None) -> list[Unit]:
    """The vehicles of a result; from names and positions of contacts where it has no drawing."""
    if drawing is None or not drawing.content.get("trains"):
        return _train(0, _from_names(stored), 0, 0, [])
    found: list[Unit] = []
    kinds = drawing.content["vehicles"]
    for number, train in enumerate(drawing.content["trains"]):
        placed = [(kinds[kind], float(behind)) for kind, behind in train["placements"]]
        contact = sum(len(unit.wheels) for unit in found)
        found += _train(number, placed, len(found), contact, train["lines"])
    return found


def _train(
    train: int, placed: Sequence[tuple[Mapping[str, Any], float]], first: int, contact: int, lines: Sequence[str]
) -> list[Unit]:
    """The vehicles of one train; ``first`` vehicles and ``contact`` wheels come before it."""
    found, own = [], 0
    ends = [behind for _, behind in placed]
    for i, (kind, behind) in enumerate(placed):
        last = _last(placed[i])
        before = behind - _last(placed[i - 1]) if i else np.inf
        after = ends[i + 1] - last if i + 1 < len(placed) else np.inf
        count = len(kind["wheels"])
        named = lines[own : own + count] or [""] * count
        found.append(_unit((first + i + 1, train), kind, behind, contact + own, (before, after), named))
        own += count
    return found


def _last(item: tuple[Mapping[str, Any], float]) -> float:
    kind, behind = item
    return float(behind + max(wheel["behind"] for wheel in kind["wheels"]))


def _unit(
    numbers: tuple[int, int],
    kind: Mapping[str, Any],
    behind: float,
    contact: int,
    room: tuple[float, float],
    lines: Sequence[str],
) -> Unit:
    number, train = numbers
    places = [float(wheel["behind"]) for wheel in kind["wheels"]]
    base = max(places)
    front, rear = behind - float(kind.get("ahead") or 0.0), behind + base + float(kind.get("astern") or 0.0)
    if kind.get("ahead") is None:
        reach = _OVERHANG if base > 0.0 else 0.5 * _FREE
        front = behind - min(reach, 0.5 * max(room[0] - _GAP, 0.6))
        rear = behind + base + min(reach, 0.5 * max(room[1] - _GAP, 0.6))
    wheels = tuple(
        (contact + i, behind + place, f"{number}.{wheel['dof']}" if wheel.get("dof") else "", line)
        for i, (wheel, place, line) in enumerate(zip(kind["wheels"], places, lines, strict=True))
    )
    boxes = _boxes(kind.get("bodies") or {}, number, behind, sorted(set(places)), front, rear)
    return Unit(number, train, str(kind["name"]), front, rear, wheels, boxes, tuple(kind.get("static_N") or ()))


def _boxes(
    bodies: Mapping[str, float], number: int, behind: float, places: Sequence[float], front: float, rear: float
) -> tuple[Box, ...]:
    low = {name: place for name, place in bodies.items() if LOW.search(name)}
    high = {name: place for name, place in bodies.items() if name not in low}
    boxes = []
    for name, place in low.items():
        own = [x for x in places if abs(x - place) == min(abs(x - other) for other in low.values())]
        length = (max(own) - min(own) if len(own) > 1 else 1.2) + 0.9
        boxes.append(Box(f"{number}.{name}", behind + place, length, *_BOGIE, True))
    centers = sorted(high.items(), key=lambda item: item[1])
    cuts = [front, *(behind + 0.5 * (a[1] + b[1]) for a, b in zip(centers, centers[1:], strict=False)), rear]
    bottom, top = _SMALL if len(places) == 1 else _BODY
    for (name, _), begin, end in zip(centers, cuts, cuts[1:], strict=False):
        length = max(end - begin - _GAP, 0.4)
        boxes.append(Box(f"{number}.{name}", 0.5 * (begin + end), length, bottom, top, False))
    return tuple(boxes)


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
            wheels.append({"behind": float(behind[i]) - start, "dof": dof if f"{vehicle}.{dof}" in dofs else None})
        parts = dict.fromkeys(
            name.split(".")[1]
            for name in stored.names("vehicle_dof")
            if name.startswith(f"{vehicle}.") and ".wheel" not in name and name.count(".") == 2
        )
        found.append(({"name": f"vehicle {vehicle}", "wheels": wheels, "bodies": _spread(parts, wheels)}, start))
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
