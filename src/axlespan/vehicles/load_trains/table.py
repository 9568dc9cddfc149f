"""Axle forces from a text file with a position and a load in each line."""

from __future__ import annotations

import math
import re
from pathlib import Path

from axlespan import units
from axlespan.errors import InputError, Place
from axlespan.units import FORCE, LENGTH, Dimension
from axlespan.vehicles.simple import axle_loads
from axlespan.vehicles.train import Train

# Names of columns, and what they hold.
_POSITION, _LOAD = ("position", "x", "distance", "s"), ("load", "force", "axle load", "p", "weight")
_DELIMITERS, _DECIMAL_COMMA = (";", "\t", ","), (";", "\t")
_EXAMPLE = "Begin with a line such as: position [m]; load [kN]"
# A load below this without a unit is kilonewtons, or tonnes [N].
_LEAST = 1e3

_Rows = list[tuple[int, list[str]]]


def read_axles(path: str | Path) -> Train:
    """A train of moving forces from a file; see :func:`axle_table`.

    Parameters
    ----------
    path : path
        A table with the columns position and load.

    Raises
    ------
    InputError
        If the file is wrong, with its line.
    """
    positions, loads = axle_table(path)
    return Train.of(axle_loads(loads=loads, positions=positions, name=Path(path).stem))


def axle_table(path: str | Path) -> tuple[list[float], list[float]]:
    """Positions [m], counted from the first axle, and loads [N] of a text file.

    Its first line names the columns and their units, as in ``position [m]; load [kN]``; without units they are m
    and N. Fields are separated by semicolons, tabs or commas; with semicolons and tabs a comma may be a decimal
    comma. Other columns, empty lines and what follows a ``#`` are skipped.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    positions, loads : list of float

    Raises
    ------
    InputError
        With file and line: if the file cannot be read, a field is empty or no number, a load not positive, or the
        positions don't increase.
    """
    rows = _rows(Path(path))
    (line, header), *rows = rows
    x, x_factor, _ = _column(header, _POSITION, LENGTH, Place(str(path), line))
    p, p_factor, has_unit = _column(header, _LOAD, FORCE, Place(str(path), line))
    if not rows:
        raise InputError("has no axles below its header", place=Place(str(path), line))
    positions: list[float] = []
    loads: list[float] = []
    for line, row in rows:
        place = Place(str(path), line)
        positions.append(x_factor * _number(row, x, header, place))
        loads.append(p_factor * _number(row, p, header, place))
        if len(positions) > 1 and positions[-1] <= positions[-2]:
            raise InputError(
                f"must increase: the axle before is at {positions[-2] / x_factor:g}",
                field=header[x],
                value=row[x],
                place=place,
            )
        if loads[-1] <= 0.0:
            raise InputError("must be positive", field=header[p], value=row[p], place=place)
        if loads[-1] < _LEAST and not has_unit:
            raise InputError(
                f"looks wrong: without a unit it is {loads[-1]:g} N",
                field=header[p],
                value=row[p],
                place=place,
                fix=f"Name the column {header[p]} [kN], if that is meant",
            )
    return [round(position - positions[0], 9) for position in positions], loads


def _rows(path: Path) -> _Rows:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not a text file"
        raise InputError(f"cannot be read: {reason}", place=Place(str(path))) from error
    bare = [(i, line.split("#", 1)[0].strip()) for i, line in enumerate(text.splitlines(), start=1)]
    lines = [(i, line) for i, line in bare if line]
    if not lines:
        raise InputError("is empty", place=Place(str(path)), fix=_EXAMPLE)
    delimiter = next((d for d in _DELIMITERS if d in lines[0][1]), None)
    if delimiter is None:
        fix = "Separate them by semicolons, tabs or commas. " + _EXAMPLE
        raise InputError("needs two columns", value=lines[0][1], place=Place(str(path), lines[0][0]), fix=fix)
    rows = [(i, [field.strip().strip('"') for field in line.split(delimiter)]) for i, line in lines]
    if delimiter in _DECIMAL_COMMA:
        rows[1:] = [(i, [field.replace(",", ".") for field in fields]) for i, fields in rows[1:]]
    return rows


def _column(
    header: list[str], names: tuple[str, ...], dimension: Dimension, place: Place
) -> tuple[int, float, bool]:
    """Number of a column, factor of its unit to SI, and whether it has a unit."""
    for number, field in enumerate(header):
        found = re.fullmatch(r"\s*([A-Za-z_ ]+?)\s*(?:[\[(/]\s*([^\])]*?)\s*[\])]?)?\s*", field)
        if found is None or found[1].lower().replace("_", " ") not in names:
            continue
        if not found[2]:
            return number, 1.0, False
        try:
            return number, units.factor(found[2], dimension), True
        except InputError as error:
            fix = error.fix if dimension is LENGTH else "Write N, kN or MN; 1 t weighs 9.81 kN"
            raise InputError(error.rule, field=field, place=place, fix=fix) from None
    raise InputError(
        f"has no column named {names[0]}", field="header", value=", ".join(header), place=place, fix=_EXAMPLE
    )


def _number(row: list[str], column: int, header: list[str], place: Place) -> float:
    text = row[column] if column < len(row) else ""
    if not text:
        raise InputError("is missing", field=header[column], place=place)
    try:
        value = float(text)
    except ValueError:
        raise InputError("must be a number", field=header[column], value=text, place=place) from None
    if not math.isfinite(value):
        raise InputError("must be finite", field=header[column], value=text, place=place)
    return value
