"""Numbers of a library file, each kept as written with its source and note."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from axlespan.units import Dimension
from axlespan.vehicles.library.document import Item
from axlespan.vehicles.library.entry import Origin, Value

_OF_A_VALUE = ("value", "source", "note", "check")


@dataclass
class Quantities:
    """Reads numbers, ``2.5 m`` or ``{value: 2.5 m, source: ..., note: ...}``, and keeps a book of them."""

    origins: Mapping[str, Origin]
    default: Origin | None = None
    values: list[Value] = field(default_factory=list)

    def number(self, item: Item, dimension: Dimension, path: str) -> float:
        """Return one number in SI units."""
        inner = self._booked(item, path)
        return inner.quantity(dimension)

    def positive(self, item: Item, dimension: Dimension, path: str) -> float:
        """Return one positive number in SI units."""
        inner = self._booked(item, path)
        value = inner.quantity(dimension)
        if value <= 0.0:
            raise inner.wrong("must be positive")
        return value

    def several(self, item: Item, dimension: Dimension, path: str) -> tuple[float, ...]:
        """Return a list of numbers, or one, in SI units."""
        inner = self._booked(item, path)
        if not inner.is_list:
            return (inner.quantity(dimension),)
        return tuple(part.quantity(dimension) for part in inner.items())

    def _booked(self, item: Item, path: str) -> Item:
        """Note a value, and return the number or list that it is."""
        inner, origin, note, check = item, self.default, "", False
        if item.is_mapping:
            keys = item.mapping(_OF_A_VALUE, needed=("value",))
            inner = keys["value"]
            note = keys["note"].text() if "note" in keys else ""
            if "source" in keys:
                word = keys["source"].text()
                origin = self.origins.get(word) or Origin(word, word)
            check = "check" in keys and keys["check"].truth()
        written = ", ".join(part.text() for part in inner.items()) if inner.is_list else inner.text()
        marked = check or (origin is not None and origin.check)
        self.values.append(Value(path, written, origin, note, marked))
        return inner
