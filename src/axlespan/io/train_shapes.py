"""What a train looks like from the side: bodies, bogies and wheels."""

from __future__ import annotations

import itertools
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

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
    wheels: tuple[
        tuple[int, float, str, str], ...
    ]  # contact, behind the head [m], name of its d.o.f. (or empty), line
    boxes: tuple[Box, ...]
    static: tuple[float, ...] = ()  # [N] of each wheel


def units_of(content: Mapping[str, Any]) -> list[Unit]:
    """The vehicles of all trains, from the content of a :class:`axlespan.io.drawing.Drawing`."""
    found: list[Unit] = []
    for number, train in enumerate(content.get("trains", ())):
        placed = [(content["vehicles"][kind], float(behind)) for kind, behind in train["placements"]]
        contact = sum(len(unit.wheels) for unit in found)
        found += train_of(number, placed, len(found), contact, train["lines"])
    return found


def train_of(
    train: int,
    placed: Sequence[tuple[Mapping[str, Any], float]],
    first: int,
    contact: int,
    lines: Sequence[str],
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
    return Unit(
        number, train, str(kind["name"]), front, rear, wheels, boxes, tuple(kind.get("static_N") or ())
    )


def _boxes(
    bodies: Mapping[str, float],
    number: int,
    behind: float,
    places: Sequence[float],
    front: float,
    rear: float,
) -> tuple[Box, ...]:
    low = {name: place for name, place in bodies.items() if LOW.search(name)}
    high = {name: place for name, place in bodies.items() if name not in low}
    boxes = []
    for name, place in low.items():
        own = [x for x in places if abs(x - place) == min(abs(x - other) for other in low.values())]
        length = (max(own) - min(own) if len(own) > 1 else 1.2) + 0.9
        boxes.append(Box(f"{number}.{name}", behind + place, length, *_BOGIE, True))
    centers = sorted(high.items(), key=lambda item: item[1])
    cuts = [front, *(behind + 0.5 * (a[1] + b[1]) for a, b in itertools.pairwise(centers)), rear]
    bottom, top = _SMALL if len(places) == 1 else _BODY
    for (name, _), begin, end in zip(centers, cuts, cuts[1:], strict=False):
        length = max(end - begin - _GAP, 0.4)
        boxes.append(Box(f"{number}.{name}", 0.5 * (begin + end), length, bottom, top, False))
    return tuple(boxes)
