"""Several wrong inputs at once, one line each."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import Any, Final

from axlespan.errors import InputError, Place

_SHOWN: Final = 20


class InputErrors(InputError):
    """All that is wrong with an input, in the order of the file; prints one line for each.

    Parameters
    ----------
    errors : iterable of InputError
        At least one; errors that hold several are taken apart. The attributes ``rule``, ``field``, ``value``,
        ``fix`` and ``place`` are those of the first.
    """

    def __init__(self, errors: Iterable[InputError]) -> None:
        flat = [part for error in errors for part in getattr(error, "errors", (error,))]
        self.errors: tuple[InputError, ...] = tuple(sorted(flat, key=_order))
        first = self.errors[0]
        more: Mapping[str, Any] = {"value": first.value} if first.has_value else {}
        super().__init__(first.rule, field=first.field, fix=first.fix, place=first.place, **more)

    def located(self, place: Place, field: str | None = None) -> InputErrors:
        """Return the same errors, with the place filled in where there is none; fields keep their names."""
        return InputErrors(error.located(place, error.field or field) for error in self.errors)

    def __reduce__(self) -> tuple[type[InputErrors], tuple[tuple[InputError, ...]]]:
        return InputErrors, (self.errors,)

    def __str__(self) -> str:
        lines = [str(error) for error in self.errors[:_SHOWN]]
        if len(self.errors) > _SHOWN:
            lines.append(f"... and {len(self.errors) - _SHOWN} more")
        return "\n".join(lines)


def nearest(name: str, known: Iterable[str], likeness: float = 0.7) -> str | None:
    """Return the known name that is most like ``name``, whatever its case, hyphens and underscores.

    Examples
    --------
    >>> nearest("Youngs-Modulus", ["length", "youngs_modulus"]), nearest("colour", ["length"])
    ('youngs_modulus', None)
    """
    folded = {_folded(other): other for other in known}
    near = get_close_matches(_folded(name), folded, n=1, cutoff=likeness)
    return folded[near[0]] if near else None


def listed(names: Iterable[str], limit: int = 12) -> str:
    """Return names for a sentence: ``a, b or c``.

    Examples
    --------
    >>> listed(["rigid", "hertz", "unilateral"])
    'rigid, hertz or unilateral'
    """
    *heads, last = names
    if len(heads) >= limit:
        return f"{', '.join(heads[:limit])}, ..."
    return f"{', '.join(heads)} or {last}" if heads else last


def _folded(name: str) -> str:
    return name.lower().replace("-", "").replace("_", "").replace(" ", "")


def _order(error: InputError) -> tuple[int, int]:
    return (error.place and error.place.line) or 0, (error.place and error.place.column) or 0
