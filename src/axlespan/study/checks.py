"""Checks of single values in a case file: quantities, whole numbers, choices, texts, positions."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

from pydantic import BaseModel, ConfigDict, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from axlespan import units
from axlespan.errors import InputError
from axlespan.study.faults import listed, nearest
from axlespan.units import Dimension

_INFINITY: Final = float("inf")
_NOT_IN_A_LINE: Final = ("Cc", "Cs", "Zl", "Zp")  # control characters, halves of pairs, line separators


class Part(BaseModel):
    """A mapping of the case file: its keys are fixed, its values frozen and in SI units."""

    model_config = ConfigDict(frozen=True, extra="forbid", use_attribute_docstrings=True)

    def given(self) -> dict[str, Any]:
        """Return the values that are not ``None``, by their names."""
        return {name: value for name, value in self if value is not None}


class Checked:
    """A check of one value, in the form that pydantic takes: the validator is ``read``."""

    def read(self, raw: Any) -> Any:
        """Return the value, or raise what is wrong with it."""
        raise NotImplementedError

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema of what may be written."""
        raise NotImplementedError

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        return self.json_schema()


@dataclass(frozen=True)
class Measured(Checked):
    """A quantity: a number in SI units, or a number and its unit.

    Parameters
    ----------
    dimension : Dimension
        What it measures.
    above, at_least, below, at_most : float
        Bounds in SI units.
    believable : (float, float), optional
        Where such a quantity lies in practice [SI], whatever its sign. A plain number outside is refused, for
        it was probably meant in another unit; a number with a unit is taken.
    """

    dimension: Dimension
    above: float = -_INFINITY
    at_least: float = -_INFINITY
    below: float = _INFINITY
    at_most: float = _INFINITY
    believable: tuple[float, float] | None = None

    def read(self, raw: Any) -> float:
        """Return the value in SI units."""
        value = units.parse(raw, self.dimension)
        if not (self.above < value < self.below and self.at_least <= value <= self.at_most):
            raise InputError(self._rule(), value=raw, fix=self._remedy(raw, value))
        if not self.is_believable(value) and not _has_unit(raw):
            rule = f"looks wrong: without a unit it is {self._in_full(value)}"
            raise InputError(rule, value=raw, fix=self._intended(value))
        return value

    def is_believable(self, value: float) -> bool:
        """Whether a value [SI] has a usual magnitude; zero has."""
        if self.believable is None or value == 0.0:
            return True
        return self.believable[0] <= abs(value) <= self.believable[1]

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema: a number, or a text with a unit."""
        unit = f"In {self.dimension.unit}." if self.dimension.unit else "A number."
        number: dict[str, Any] = {"type": "number", "description": unit}
        bounds = {
            "exclusiveMinimum": self.above,
            "minimum": self.at_least,
            "exclusiveMaximum": self.below,
            "maximum": self.at_most,
        }
        number |= {keyword: bound for keyword, bound in bounds.items() if abs(bound) != _INFINITY}
        text = {"type": "string", "pattern": r"^\s*[+\-−]?(\d|\.\d)"}
        return {"anyOf": [number, {**text, "description": f"With its unit: '{self.dimension.example}'."}]}

    def plainly(self, value: float) -> str:
        """Return a value with its SI unit; a small fraction as a fraction."""
        fraction = Fraction(value).limit_denominator(12)
        if not self.dimension.unit and fraction.denominator in (3, 6) and float(fraction) == value:
            return str(fraction)
        return f"{value:.6g} {self.dimension.unit}".strip()

    def _in_full(self, value: float) -> str:
        """Return a value with a unit, so that it is believed."""
        return units.show(value, self.dimension) if self.dimension is units.RATIO else self.plainly(value)

    def _rule(self) -> str:
        if self.above == 0.0 and self.below == _INFINITY == self.at_most:
            return "must be positive"
        if self.at_least == 0.0 and self.below == _INFINITY == self.at_most:
            return "must not be negative"
        if self.at_least > -_INFINITY and self.at_most < _INFINITY:
            return f"must be from {self.plainly(self.at_least)} to {self.plainly(self.at_most)}"
        bounds = (
            ("above", self.above),
            ("at least", self.at_least),
            ("below", self.below),
            ("at most", self.at_most),
        )
        told = [f"{word} {self.plainly(bound)}" for word, bound in bounds if abs(bound) != _INFINITY]
        return f"must be {' and '.join(told)}"

    def _remedy(self, raw: Any, value: float) -> str | None:
        if self.dimension is units.RATIO and 1.0 <= value <= 100.0 and self.below <= 1.0:
            return f"Write {value:g} % if percent are meant"
        if value < 0.0 and 0.0 in (self.above, self.at_least):
            return f"Write {str(raw).strip().lstrip('-−')}"
        return f"Write, for example, {self.dimension.example}" if self.above == 0.0 else None

    def _intended(self, value: float) -> str:
        """Say which unit makes the number believable."""
        as_it_is = self._in_full(value)
        for unit in self.dimension.shown + _ALSO_WRITTEN.get(self.dimension.unit, ()):
            if self.is_believable(value * units.factor(unit, self.dimension)):
                return f"Write {value:.6g} {unit}; or {as_it_is}, if that is meant"
        return f"Write {as_it_is}, if that is meant"


_ALSO_WRITTEN: Final = {"m/s": ("km/h",), "Pa": ("N/mm^2",), "m^2": ("mm^2",), "kg": ("t",)}


def _has_unit(raw: Any) -> bool:
    return isinstance(raw, str) and bool(units.read(raw).unit)


@dataclass(frozen=True)
class Whole(Checked):
    """A whole number."""

    at_least: int = 1
    at_most: int = 10**9

    def read(self, raw: Any) -> int:
        """Return the number."""
        if isinstance(raw, bool) or not isinstance(raw, (int, float)) or raw != raw or raw % 1 != 0:
            such = min(max(50, self.at_least), self.at_most)
            raise InputError(
                "must be a whole number", value=raw, fix=f"Write it without unit and quotes, as in {such}"
            )
        if not self.at_least <= raw <= self.at_most:
            bound = f"least {self.at_least}" if raw < self.at_least else f"most {self.at_most}"
            raise InputError(f"must be at {bound}", value=raw)
        return int(raw)

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {"type": "integer", "minimum": self.at_least, "maximum": self.at_most}


@dataclass(frozen=True)
class OneOf(Checked):
    """One word of a few."""

    words: tuple[str, ...]

    def read(self, raw: Any) -> str:
        """Return the word."""
        if isinstance(raw, str) and raw in self.words:
            return raw
        near = nearest(raw, self.words) if isinstance(raw, str) else None
        fix = f"Did you mean {near}?" if near else None
        raise InputError(f"must be {listed(self.words)}", value=raw, fix=fix)

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {"enum": list(self.words)}


@dataclass(frozen=True)
class Word(Checked):
    """A text that is not empty, in one line; line breaks are refused, or folded into spaces.

    With ``strict`` it is a name of letters, digits, - and _, as in names of d.o.f.
    """

    strict: bool = False
    folded: bool = False

    def read(self, raw: Any) -> str:
        """Return the text; a number is taken as its digits."""
        if isinstance(raw, bool) or not isinstance(raw, (str, int, float)) or not str(raw).strip():
            raise InputError("must be a text", value=raw, fix="Put it in quotes")
        text = " ".join(str(raw).split()) if self.folded else str(raw).strip()
        odd = next((sign for sign in text if unicodedata.category(sign) in _NOT_IN_A_LINE), None)
        if odd is not None:  # of no use in tables and figures, and some files cannot hold them
            raise InputError(f"must be a text in one line; it has the character U+{ord(odd):04X}", value=raw)
        if self.strict and not re.fullmatch(r"[A-Za-z0-9_-]+", text):
            clean = re.sub(r"[^A-Za-z0-9_-]+", "_", text).strip("_") or "body"
            raise InputError("must be a name of letters, digits, - and _", value=raw, fix=f"Write {clean}")
        return text

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        pattern: dict[str, Any] = {"pattern": "^[A-Za-z0-9_-]+$"} if self.strict else {"minLength": 1}
        return {"type": ["string", "number"], **pattern}


@dataclass(frozen=True)
class Location(Checked):
    """A position along the running line [m], or the name of a node."""

    def read(self, raw: Any) -> float | str:
        """Return the position in meters, or the name."""
        if isinstance(raw, str) and re.match(r"\s*[A-Za-z_]", raw):
            return raw.strip()
        return units.parse(raw, units.LENGTH)

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {
            "type": ["number", "string"],
            "description": "Position along the running line, in m or with its unit; or the name of a node.",
        }
