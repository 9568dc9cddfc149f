"""Checks of what is done to a measured profile: its trend, and a band of wavelengths."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from axlespan.errors import InputError
from axlespan.irregularity.bands import EN13848_BANDS
from axlespan.study.check_lists import Several
from axlespan.study.checks import Checked, Measured, Whole
from axlespan.study.faults import listed, nearest
from axlespan.units import LENGTH

_MOST_DEGREES: Final = 10
_WAVELENGTHS: Final = Several(Measured(LENGTH, above=0.0), "[3 m, 25 m]", exactly=2, increasing=True)


@dataclass(frozen=True)
class Detrended(Checked):
    """Degree of a polynomial; true is a straight line, false and nothing none."""

    def read(self, raw: Any) -> int | None:
        """Return the degree."""
        if raw is None or isinstance(raw, bool):
            return 1 if raw else None
        try:
            return Whole(at_least=0, at_most=_MOST_DEGREES).read(raw)
        except InputError as error:
            raise InputError(
                f"must be true, or a degree from 0 to {_MOST_DEGREES}",
                value=raw,
                fix="Write true for a straight line, 0 for the mean alone",
            ) from error

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {"anyOf": [{"type": "boolean"}, Whole(at_least=0, at_most=_MOST_DEGREES).json_schema()]}


@dataclass(frozen=True)
class Band(Checked):
    """Wavelengths: a band of EN 13848-1 by its name, or the shortest and the longest."""

    def read(self, raw: Any) -> str | tuple[float, float] | None:
        """Return the name, or the shortest and the longest [m]."""
        if raw is None or (isinstance(raw, str) and raw in EN13848_BANDS):
            return raw
        if not isinstance(raw, (list, tuple)):
            near = nearest(raw, EN13848_BANDS) if isinstance(raw, str) else None
            rule = (
                f"must be {listed(EN13848_BANDS)} of EN 13848-1, or the shortest and the longest wavelength"
            )
            raise InputError(rule, value=raw, fix=f"Did you mean {near}?" if near else "Write [3 m, 25 m]")
        shortest, longest = _WAVELENGTHS.read(raw)
        return shortest, longest

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        return {"anyOf": [{"enum": list(EN13848_BANDS)}, _WAVELENGTHS.json_schema()]}
