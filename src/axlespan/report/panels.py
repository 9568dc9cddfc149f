"""Histories over time, in groups of curves that share an axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.io.dof_units import is_rotation
from axlespan.io.train_shapes import LOW
from axlespan.report.pack import Pack
from axlespan.report.stored import Stored
from axlespan.report.thinning import chosen_columns, rows_for
from axlespan.report.units import shown_unit

FloatArray = npt.NDArray[np.float64]

# Curves that a plot holds, and those of them that show at first.
_MOST, _AT_FIRST = 24, 6


@dataclass(frozen=True)
class Group:
    """Curves of one plot: columns of a variable."""

    key: str
    title: str
    variable: str
    columns: tuple[int, ...]
    unit: str  # SI
    prefix: str = ""  # before the names of the curves
    open: bool = True  # whether it shows at first


def panels(stored: Stored, pack: Pack) -> list[dict[str, Any]]:
    """All plots of histories; their arrays go into the pack."""
    found = []
    for group in groups(stored):
        try:
            found.append(_panel(stored, pack, group))
        except (OSError, RuntimeError, ValueError) as error:
            stored.miss(group.variable, error)
    return found


def groups(stored: Stored) -> list[Group]:
    """The groups of curves that a result has."""
    sensors = tuple(range(len(stored.names("sensor"))))
    contacts = tuple(range(len(stored.names("contact"))))
    parts, turns = _bodies(stored)
    forces, moments = _supports(stored)
    found = [
        Group("displacement", "Displacement at the sensors", "sensor_displacement", sensors, "m"),
        Group("acceleration", "Acceleration at the sensors", "sensor_acceleration", sensors, "m/s^2"),
        Group("velocity", "Velocity at the sensors", "sensor_velocity", sensors, "m/s", open=False),
        Group("contact", "Contact forces", "contact_force", contacts, "N", "wheel "),
        Group("body-a", "Vertical acceleration of the vehicles", "vehicle_acceleration", parts, "m/s^2"),
        Group(
            "body-u", "Vertical displacement of the vehicles", "vehicle_displacement", parts, "m", open=False
        ),
        Group("pitch-u", "Rotation of the vehicles", "vehicle_displacement", turns, "rad", open=False),
        Group("reaction", "Support reactions", "support_reaction", forces, "N"),
        Group("reaction-m", "Support moments", "support_reaction", moments, "N m", open=False),
    ]
    sections = tuple(range(len(stored.names("section"))))
    for name, title, unit in (
        ("moment", "Bending moment at sections, sagging positive", "N m"),
        ("shear", "Shear force at sections", "N"),
        ("normal", "Normal force at sections", "N"),
    ):
        found.append(
            Group(f"section-{name}", title, f"section_{name}", sections, unit, open=name == "moment")
        )
    found += _stresses(stored)
    return [group for group in found if group.columns and stored.has(group.variable)]


def _bodies(stored: Stored) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Vertical d.o.f. and rotations of what is no wheel."""
    shifts, turns = [], []
    for i, name in enumerate(stored.names("vehicle_dof")):
        part, _, component = name.partition(".")[2].rpartition(".")
        if part.startswith("wheel"):
            continue
        if is_rotation(name):
            turns.append(i)
        elif component == "z":
            shifts.append(i)
    return tuple(shifts), tuple(turns)


def _supports(stored: Stored) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Vertical reactions (all forces where none is vertical), and moments."""
    names = stored.names("support")
    moments = tuple(i for i, name in enumerate(names) if is_rotation(name))
    forces = tuple(i for i, name in enumerate(names) if not is_rotation(name))
    vertical = tuple(i for i in forces if names[i].endswith(".z"))
    return vertical or forces, moments


def _stresses(stored: Stored) -> list[Group]:
    names = stored.names("stress")
    kinds = {
        "N/m^2": tuple(i for i, name in enumerate(names) if name.rpartition(".")[2].islower()),
        "N/m": tuple(i for i, name in enumerate(names) if name.rpartition(".")[2][:1] in "NQ"),
        "N m/m": tuple(i for i, name in enumerate(names) if name.rpartition(".")[2][:1] == "M"),
    }
    titles = {"N/m^2": "Stresses", "N/m": "Forces in shells", "N m/m": "Moments in shells"}
    return [
        Group(f"stress-{i}", titles[unit], "stress_history", columns, unit)
        for i, (unit, columns) in enumerate(kinds.items())
    ]


def names_of(stored: Stored, group: Group) -> list[str]:
    """Names of the curves of a group, without what all of them end in."""
    dimension = {
        "sensor": "sensor",
        "contact": "contact",
        "vehicle": "vehicle_dof",
        "support": "support",
        "section": "section",
        "stress": "stress",
    }[group.variable.partition("_")[0]]
    names = stored.names(dimension)
    shown = [names[i] for i in group.columns]
    if dimension in ("vehicle_dof", "support"):
        ends = {name.rpartition(".")[2] for name in shown}
        if len(ends) == 1 and len(shown) > 0:
            shown = [name.rpartition(".")[0] for name in shown]
    return [group.prefix + name for name in shown]


def _panel(stored: Stored, pack: Pack, group: Group) -> dict[str, Any]:
    factor, unit = shown_unit(group.unit)
    names = names_of(stored, group)
    sizes = [_range(stored.column(group.variable, i)) for i in group.columns]
    kept = chosen_columns(sizes, _MOST)
    columns = [group.columns[i] for i in kept]
    n = len(stored.time)
    rows = rows_for(n, columns, lambda column: stored.column(group.variable, column))
    first = _at_first([names[i] for i in kept], [sizes[i] for i in kept])
    series = []
    for place, (i, column) in enumerate(zip(kept, columns, strict=True)):
        values = factor * stored.column(group.variable, column)[rows]
        series.append({"name": names[i], "a": pack.add(values), "on": place in first})
    return {
        "key": group.key,
        "title": group.title,
        "unit": unit,
        "open": group.open,
        "x": pack.add(stored.time[rows], "f8"),
        "series": series,
        "note": _note(n, len(rows), len(names), len(kept)),
    }


def _at_first(names: Sequence[str], sizes: Sequence[float]) -> set[int]:
    """Curves that show at first; of vehicles the bodies, where there are bogies too."""
    places = [i for i, name in enumerate(names) if not LOW.search(name)] or list(range(len(names)))
    return {places[i] for i in chosen_columns([sizes[i] for i in places], _AT_FIRST)}


def _range(values: FloatArray) -> float:
    finite = values[np.isfinite(values)]
    return float(np.ptp(finite)) if finite.size else 0.0


def _note(n: int, kept: int, all_curves: int, curves: int) -> str:
    words: Sequence[str] = [
        f"{kept} of {n} times are shown, with every peak." if kept < n else "",
        f"{curves} of {all_curves} curves are on this page; result.nc has all."
        if curves < all_curves
        else "",
    ]
    return " ".join(word for word in words if word)
