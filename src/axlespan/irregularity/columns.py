"""Two columns of numbers from a text file, with the line of whatever is wrong in it."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np

from axlespan.errors import InputError, Place
from axlespan.irregularity.checks import Array, nearest
from axlespan.units import LENGTH, factor

__all__ = ["read_columns"]

_DELIMITERS = (";", "\t", ",")
_DECIMAL_COMMA = (";", "\t")
# A name with its unit behind it: r [mm], height (mm).
_NAMED = re.compile(r"(.*?)\s*([\[(])\s*([^\])]*?)\s*[\])]")
# Headers without delimiters: words, each perhaps with a unit.
_WORDS = re.compile(r"[^\s\[(]+(?:\s*[\[(][^\])]*[\])])?")


def read_columns(
    path: str | Path, columns: tuple[int | str, int | str] = (0, 1), scale: float | None = None
) -> tuple[Array, Array, list[int]]:
    """Read two columns of a text file: positions and heights, both in meters.

    Fields are separated by semicolons, tabs, commas or blanks (found from the first row); with semicolons and
    tabs a comma is a decimal comma. Empty lines and what follows a ``#`` are skipped; a first row that isn't
    numbers is a header. Lengths have the units that the header gives them, ``x [m]; r [mm]``, else meters.

    Parameters
    ----------
    path : str or Path
        The file.
    columns : tuple
        The two columns by number (from 0) or by their names in the header, with or without the unit.
    scale : float, optional
        Factor from the file's heights to meters, in place of the unit in the header.

    Returns
    -------
    x, r : array, (n,)
        The columns [m]; an empty field is NaN.
    lines : list of int
        The line of the file that each entry stands on, counted from 1.

    Raises
    ------
    InputError
        When the file can't be read, a column is missing, a unit isn't one of length or a field isn't a number.
    """
    rows = _rows(Path(path))
    if not rows:
        raise InputError("has no rows", field="file", place=Place(str(path)))
    delimiter = next((d for d in _DELIMITERS if d in rows[0][1]), None)
    fields = [(line, [f.strip().strip('"') for f in text.split(delimiter)]) for line, text in rows]
    header, top = None, Place(str(path), rows[0][0])
    if not _is_number(fields[0][1][0], delimiter):
        names = fields.pop(0)[1]
        header = names if delimiter else _WORDS.findall(rows[0][1])
    chosen = [_column_number(c, header, path) for c in columns]
    factors = [_factor(c, header, top) for c in chosen]
    if scale is not None:
        factors[1] = scale
    data = np.empty((len(fields), 2))
    for i, (line, row) in enumerate(fields):
        for j, c in enumerate(chosen):
            data[i, j] = _number(row, c, delimiter, Place(str(path), line))
    return factors[0] * data[:, 0], factors[1] * data[:, 1], [line for line, _ in fields]


def _rows(path: Path) -> list[tuple[int, str]]:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not a text file"
        raise InputError(f"cannot be read: {reason}", field="file", value=str(path)) from error
    bare = ((i, line.split("#", 1)[0].strip()) for i, line in enumerate(text.splitlines(), start=1))
    return [(i, line) for i, line in bare if line]


def _column_number(column: int | str, header: list[str] | None, path: str | Path) -> int:
    if isinstance(column, int):
        return column
    if header is None:
        raise InputError(
            "is a name, but the file has no header row", field="columns", value=column, place=Place(str(path))
        )
    bare = [named[1] if (named := _NAMED.fullmatch(name)) else name for name in header]
    if column not in header and column in bare:
        return bare.index(column)
    if column not in header:
        raise InputError(
            f"is not in the header: {', '.join(header)}",
            field="columns",
            value=column,
            fix=nearest(column, header),
            place=Place(str(path)),
        )
    return header.index(column)


def _factor(column: int, header: list[str] | None, place: Place) -> float:
    """Factor to meters by the unit behind a name of the header; remarks in parentheses are no units."""
    name = header[column] if header is not None and column < len(header) else ""
    named = _NAMED.fullmatch(name)
    if named is None or not named[3]:
        return 1.0
    try:
        return factor(named[3], LENGTH)
    except InputError as error:
        if named[2] == "(":
            return 1.0
        raise InputError(error.rule, field=name, fix="Write m, mm or km", place=place) from None


def _number(row: list[str], column: int, delimiter: str | None, place: Place) -> float:
    if column >= len(row):
        raise InputError(f"has {len(row)} fields, but column {column} is asked for", field="row", place=place)
    text = row[column]
    if text == "":
        return math.nan
    if not _is_number(text, delimiter):
        raise InputError("must be a number", field=f"column {column}", value=text, place=place)
    return float(text.replace(",", ".") if delimiter in _DECIMAL_COMMA else text)


def _is_number(text: str, delimiter: str | None) -> bool:
    try:
        float(text.replace(",", ".") if delimiter in _DECIMAL_COMMA else text)
    except ValueError:
        return False
    return True
