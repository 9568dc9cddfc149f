"""Numbers with one unit, and ranges of them: ``{from: 140 km/h, to: 420 km/h, step: 5 km/h}``.

Steps are counted in decimal numbers of the unit that was written, so that 145 km/h is the same number as in a
case file that says 145 km/h.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from typing import Any, Final

from axlespan import units
from axlespan.errors import InputError
from axlespan.study.checks import Whole
from axlespan.study.sweep.node import Node

MOST: Final = 1_000_000
"""Most values along one axis of a study."""

_EXAMPLE: Final = "{from: 140 km/h, to: 420 km/h, step: 5 km/h}"


@dataclass(frozen=True)
class Amount:
    """A number and its unit as written; ``scale`` turns the number into SI."""

    number: float
    unit: str
    exponents: units.Exponents
    scale: float
    decimal: Decimal

    def text(self, number: float | Decimal) -> Any:
        """Another number of this unit, as one writes it in a case file."""
        return f"{number} {self.unit}" if self.unit else float(number)


PLAIN: Final = Amount(0.0, "", (0.0, 0.0, 0.0, 0.0), 1.0, Decimal(0))
"""What a plain number is like."""


def amount(node: Node) -> Amount:
    """Read a number with or without unit."""
    raw = node.data
    if isinstance(raw, bool) or not isinstance(raw, int | float | str):
        raise node.fault("must be a number and its unit", "Write, for example, 140 km/h")
    if not isinstance(raw, str):
        if not math.isfinite(raw):
            raise node.fault("must be a finite number")
        return Amount(float(raw), "", (0.0,) * 4, 1.0, Decimal(repr(raw)))
    try:
        reading = units.read(raw)
    except InputError as error:
        raise node.fault(error.rule, error.fix) from None
    scale = units.read(f"1 {reading.unit}").value if reading.unit else 1.0
    number = reading.number.replace("_", "")
    return Amount(float(number), reading.unit, reading.exponents, scale, Decimal(number))


def alike(node: Node, like: Amount) -> Amount:
    """Read a number of the same kind as another, in that one's unit."""
    found = amount(node)
    if found.exponents != like.exponents:
        wanted = f"a quantity like {like.number:g} {like.unit}" if like.unit else "a plain number"
        fix = f"Write {found.number:g} {like.unit}" if not found.unit else None
        raise node.fault(f"must be {wanted}", fix)
    if found.unit == like.unit:
        return found
    number = found.number * found.scale / like.scale
    return Amount(number, like.unit, like.exponents, like.scale, Decimal(repr(number)))


def values_of_range(node: Node) -> list[Any]:
    """The values of ``{from, to, step}`` or ``{from, to, count}``, as one writes them in a case file."""
    parts = node.keys(("from", "to", "step", "count"), _EXAMPLE)
    for name in ("from", "to"):
        if name not in parts:
            raise node.source.blame((*node.path, name), "is missing", f"Write {_EXAMPLE}")
    if ("step" in parts) == ("count" in parts):
        rule = "says again what step says" if "step" in parts else "is missing"
        fix = "Keep one of the two" if "step" in parts else "Add step: 5 km/h, or count: 57"
        raise node.source.blame((*node.path, "count" if "step" in parts else "step"), rule, fix)
    first = amount(parts["from"])
    if not first.unit and (unit := amount(parts["to"]).unit):
        raise parts["from"].fault("has no unit, and to has one", f"Write {first.number:g} {unit}")
    last = alike(parts["to"], first)
    if "count" in parts:
        return _counted(parts["count"], first, last)
    step = alike(parts["step"], first)
    if step.number == 0.0:
        raise parts["step"].fault(
            "must not be zero", "Write how far values are apart, or count: 57 in its place"
        )
    if (last.number - first.number) * step.number < 0.0:
        fix = "Exchange from and to" if step.number > 0.0 else f"Write {step.text(-step.decimal)}"
        raise parts["step"].fault("never gets from the first value to the last", fix)
    # a tenth of a thousandth of a step forgives what rounding of units takes from the last value
    number = int((last.decimal - first.decimal) / step.decimal + Decimal("1e-4")) + 1
    if number > MOST:
        raise parts["step"].fault(f"makes {number} values; at most {MOST} are possible", "Use a longer step")
    return [first.text(first.decimal + i * step.decimal) for i in range(number)]


def _counted(node: Node, first: Amount, last: Amount) -> list[Any]:
    count = int(node.checked(Whole(at_most=MOST)))
    if count == 1:
        if first.decimal != last.decimal:
            raise node.fault("must be at least 2 to reach both ends")
        return [first.text(first.decimal)]
    if first.decimal == last.decimal:
        raise node.fault("values between two equal ends are all the same", "Change to, or write a list")
    share = (last.decimal - first.decimal) / (count - 1)
    inner = [first.text(float(first.decimal + i * share)) for i in range(count - 1)]
    return [*inner, first.text(last.decimal)]


def is_range(data: Any) -> bool:
    """Whether a mapping is meant as a range."""
    return isinstance(data, Mapping) and ("from" in data or "to" in data)
