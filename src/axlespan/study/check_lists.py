"""Checks of lists in a case file: quantities of one kind, and tables of two."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from axlespan.errors import InputError
from axlespan.study.checks import Checked, Measured
from axlespan.study.faults import InputErrors


@dataclass(frozen=True)
class Table(Checked):
    """Pairs of two quantities, the first of them increasing: ``[[0 s, 10 m/s], [5 s, 20 m/s]]``."""

    first: Measured
    second: Measured
    at_least: int = 2

    def read(self, raw: Any) -> tuple[tuple[float, float], ...]:
        """Return the pairs in SI units."""
        example = f"[[0, {self.second.dimension.example}], [{self.first.dimension.example}, ...]]"
        if not isinstance(raw, Sequence) or isinstance(raw, str):
            raise InputError("must be a list of pairs", value=raw, fix=f"Write {example}")
        if len(raw) < self.at_least:
            raise InputError(f"must have at least {self.at_least} pairs", value=raw, fix=f"Write {example}")
        pairs = [self._pair(pair, row) for row, pair in enumerate(raw)]
        for row in range(1, len(pairs)):
            if pairs[row][0] <= pairs[row - 1][0]:
                raise InputError(
                    f"must increase: the pair before has {self.first.plainly(pairs[row - 1][0])}",
                    field=f"{row}.0",
                    value=raw[row][0],
                )
        return tuple(pairs)

    def _pair(self, raw: Any, row: int) -> tuple[float, float]:
        if not isinstance(raw, Sequence) or isinstance(raw, str) or len(raw) != 2:
            name = f"{self.first.dimension.name} and {self.second.dimension.name}"
            raise InputError(f"must be a pair: {name}", field=f"{row}", value=raw)
        values = []
        for column, kind in enumerate((self.first, self.second)):
            try:
                values.append(kind.read(raw[column]))
            except InputError as error:
                raise InputError(
                    error.rule, field=f"{row}.{column}", value=raw[column], fix=error.fix
                ) from None
        return values[0], values[1]

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        pair = [self.first.json_schema(), self.second.json_schema()]
        row = {"type": "array", "prefixItems": pair, "items": False, "minItems": 2}
        return {"type": "array", "items": row, "minItems": self.at_least}


@dataclass(frozen=True)
class Several(Checked):
    """A list of quantities of one kind.

    Parameters
    ----------
    item : Measured
        What each of them is.
    example : str
        Such a list, for messages.
    exactly : int, optional
        How many there must be; at least one when left out.
    increasing : bool
        Whether each must be larger than the one before.
    alone : bool
        Whether one quantity without brackets is a list of one.
    """

    item: Measured
    example: str
    exactly: int | None = None
    increasing: bool = False
    alone: bool = False

    def read(self, raw: Any) -> tuple[float, ...]:
        """Return the values in SI units."""
        if self.alone and not isinstance(raw, (list, tuple)):
            return (self.item.read(raw),)
        if not isinstance(raw, (list, tuple)):
            raise InputError("must be a list", value=raw, fix=f"Write {self.example}")
        values, faults = [], []
        for number, one in enumerate(raw):
            try:
                values.append(self.item.read(one))
            except InputError as error:
                faults.append(InputError(error.rule, field=str(number), value=one, fix=error.fix))
        if faults:
            raise InputErrors(faults)
        if (self.exactly is None and not values) or len(values) != (self.exactly or len(values)):
            wanted = f"exactly {self.exactly} values" if self.exactly else "at least one value"
            raise InputError(f"must have {wanted}, not {len(values)}", value=raw, fix=f"Write {self.example}")
        for number in range(1, len(values) if self.increasing else 0):
            if values[number] <= values[number - 1]:
                rule = f"must increase: the value before is {self.item.plainly(values[number - 1])}"
                raise InputError(rule, field=str(number), value=raw[number])
        return tuple(values)

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        items = {"type": "array", "items": self.item.json_schema(), "minItems": self.exactly or 1}
        several = {**items, "maxItems": self.exactly} if self.exactly else items
        return {"anyOf": [self.item.json_schema(), several]} if self.alone else several
