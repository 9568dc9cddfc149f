"""What a result has only when asked for, as named arrays: section forces, stresses, the deck, envelopes, fields."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from axlespan.interaction.records.envelopes import UNITS, Envelope, Envelopes
from axlespan.interaction.records.fields import Fields

if TYPE_CHECKING:
    from axlespan.interaction.result import Result

#: name -> (dimension beside time, unit, meaning)
SECTION_VARIABLES: dict[str, tuple[str, str, str]] = {
    "section_moment": ("section", "N m", "bending moment of the beams, sagging positive"),
    "section_shear": ("section", "N", "shear force of the beams, dM/ds, right of an axle over the section"),
    "section_normal": ("section", "N", "normal force of the beams, tension positive"),
    "section_torsion": ("section", "N m", "torsional moment of the beams"),
    "stress_history": (
        "stress",
        "N/m^2, of shells N/m or N m/m",
        "elastic stresses of solids, resultants of shells (x along global x)",
    ),
}
#: name -> (dimension beside time, unit, meaning)
LINE_VARIABLES: dict[str, tuple[str, str, str]] = {
    "line_displacement": ("line_point", "m", "vertical displacement along the deck, positive upward"),
    "line_acceleration": ("line_point", "m/s^2", "vertical acceleration along the deck"),
    "line_twist": ("line_point", "m", "change over 3 m of the left line's height over the right one's"),
    "line_slope": ("line_end", "rad", "slope dw/ds of the deck at the ends of its line"),
}
# end of the name -> attribute of an envelope
_SIDES = {
    "largest": "largest",
    "smallest": "smallest",
    "largest_time": "time_of_largest",
    "smallest_time": "time_of_smallest",
}
# name -> attribute of the fields, dimension beside field_time, unit, meaning
_FIELDS = {
    "field_displacement": ("displacement", "dof", "m or rad", "displacement of the structure"),
    "field_velocity": ("velocity", "dof", "m/s or rad/s", "velocity of the structure"),
    "field_contact_position": ("contact_position", "contact", "m", "position of the wheel along the line"),
    "field_contact_displacement": (
        "contact_displacement",
        "contact",
        "m",
        "vertical displacement of the contact point",
    ),
    "field_contact_force": ("contact_force", "contact", "N", "contact force on the vehicle"),
}


@dataclass(frozen=True, eq=False)
class Variable:
    """A named array with its dimensions."""

    dimensions: tuple[str, ...]
    values: npt.NDArray[Any]  # numbers, or names (object)
    unit: str  # empty for names
    meaning: str


def extra_coordinates(result: Result) -> dict[str, Variable]:
    """Coordinates of the dimensions that :func:`extra_variables` needs beside those of every result."""
    found: dict[str, Variable] = {}
    if result.section:
        found["section"] = _names("section", result.section, "sensor at which section forces are kept")
    if result.stress:
        found["stress"] = _names("stress", result.stress, "sensor.component")
    if len(result.line_position):
        along = "position along the line of the deck"
        found["line_position"] = Variable(("line_point",), result.line_position, "m", along)
        found["line_end"] = Variable(("line_end",), result.line_end, "m", along)
    if result.envelopes is not None:
        meaning = "position along the running line"
        found["station"] = Variable(("station",), result.envelopes.position, "m", meaning)
    if result.fields is not None:
        found["field_time"] = Variable(("field_time",), result.fields.times, "s", "time of the fields")
        found["dof"] = _names("dof", result.fields.dof_names, "node.component")
    return found


def extra_variables(result: Result) -> dict[str, Variable]:
    """Section forces, stresses, the deck's motion, envelopes and fields of a result, as far as it has them."""
    found: dict[str, Variable] = {}
    for name, (dimension, unit, meaning) in SECTION_VARIABLES.items():
        if getattr(result, dimension):
            found[name] = Variable(("time", dimension), getattr(result, name), unit, meaning)
    if len(result.line_position):
        for name, (dimension, unit, meaning) in LINE_VARIABLES.items():
            if getattr(result, name).shape[1]:  # no twist without two lines
                found[name] = Variable(("time", dimension), getattr(result, name), unit, meaning)
    if result.envelopes is not None:
        for quantity, table in result.envelopes.tables.items():
            for end, attribute in _SIDES.items():
                unit, meaning = UNITS[quantity]
                word, _, timed = end.partition("_")
                meaning = f"{'time of the ' if timed else ''}{word} over all steps: {meaning}"
                variable = Variable(("station",), getattr(table, attribute), "s" if timed else unit, meaning)
                found[f"envelope_{quantity}_{end}"] = variable
    if result.fields is not None:
        for name, (attribute, dimension, unit, meaning) in _FIELDS.items():
            values = getattr(result.fields, attribute)
            found[name] = Variable(("field_time", dimension), values, unit, meaning)
    return found


def extras_from(arrays: Mapping[str, npt.NDArray[Any]]) -> dict[str, Any]:
    """Arguments of a Result from the arrays that its extra coordinates and variables were written as.

    Raises
    ------
    KeyError
        If an array of an extra that is there is missing.
    """
    found: dict[str, Any] = {}
    for name, (dimension, *_) in SECTION_VARIABLES.items():
        if dimension in arrays:
            found |= {dimension: tuple(arrays[dimension].tolist()), name: arrays[name]}
    if "line_position" in arrays:
        names = ("line_position", "line_end", *LINE_VARIABLES)
        found |= {name: arrays[name] for name in names if name in arrays or name != "line_twist"}
    if "station" in arrays:
        quantities = [quantity for quantity in UNITS if f"envelope_{quantity}_largest" in arrays]
        tables = {
            quantity: Envelope(*(arrays[f"envelope_{quantity}_{end}"] for end in _SIDES))
            for quantity in quantities
        }
        found["envelopes"] = Envelopes(arrays["station"], tables)
    if "field_time" in arrays:
        table = {attribute: arrays[name] for name, (attribute, *_) in _FIELDS.items()}
        names = tuple(arrays["dof"].tolist())
        found["fields"] = Fields(times=arrays["field_time"], dof_names=names, **table)
    return found


def _names(dimension: str, names: tuple[str, ...], meaning: str) -> Variable:
    return Variable((dimension,), np.array(names, dtype=object), "", meaning)
