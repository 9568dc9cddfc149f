"""A spectrum of one's own: a text file with wavenumbers and densities."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Literal

from axlespan.errors import InputError, Place
from axlespan.irregularity.spectra.base import Spectrum, tabulated

__all__ = ["read_spectrum"]

_Argument = Literal["cycles/m", "rad/m"]

# What a first column may be in, and what a second one may be, with its factor to m²/(1/m) or m²/(rad/m).
_ARGUMENTS: dict[str, _Argument] = {"1/m": "cycles/m", "cycles/m": "cycles/m", "rad/m": "rad/m"}
_PER: tuple[tuple[str, _Argument], ...] = (
    ("/(1/m)", "cycles/m"),
    (" m", "cycles/m"),
    ("/(rad/m)", "rad/m"),
    (" m/rad", "rad/m"),
)
_DENSITIES: dict[str, tuple[_Argument, float]] = {
    "m^3": ("cycles/m", 1.0),
    **{
        f"{length}^2{per}": (argument, factor)
        for length, factor in (("m", 1.0), ("cm", 1e-4), ("mm", 1e-6))
        for per, argument in _PER
    },
}
_EXAMPLE = "Begin with a line such as: n [1/m]; S [mm^2/(1/m)], or omega [rad/m]; S [m^2/(rad/m)]"
_UNIT = re.compile(r"[^\[]*\[\s*(.*?)\s*\]\s*")
_DELIMITERS, _DECIMAL_COMMA = (";", "\t", ","), (";", "\t")


def read_spectrum(path: str | Path) -> Spectrum:
    """Read a one-sided spectrum from a text file; between its points it is straight in a double logarithmic plot.

    The first line gives the units: of wavenumbers ``[1/m]`` (cycles per meter) or ``[rad/m]``, of densities
    ``[mm^2/(1/m)]``, ``[m^3]``, ``[m^2/(rad/m)]`` and the like. Fields are separated by semicolons, tabs or commas;
    with semicolons and tabs a comma may be a decimal comma. Empty lines and what follows a ``#`` are skipped.

    Parameters
    ----------
    path : path
        A table of wavenumbers and densities.

    Raises
    ------
    InputError
        With file and line: if the file cannot be read, a unit is missing or unknown, a field is no positive number,
        or the wavenumbers don't increase.
    """
    path = Path(path)
    rows = _rows(path)
    (line, header), *rows = rows
    top = Place(str(path), line)
    argument, factor = _units(header, top)
    if len(rows) < 2:
        raise InputError("needs at least two points below its header", place=top)
    points: list[tuple[float, float]] = []
    for line, row in rows:
        place = Place(str(path), line)
        if len(row) < 2:
            raise InputError("needs a wavenumber and a density", place=place)
        points.append((_positive(row[0], header[0], place), _positive(row[1], header[1], place)))
        if len(points) > 1 and points[-1][0] <= points[-2][0]:
            rule = f"must increase: the one before is {points[-2][0]:g}"
            raise InputError(rule, field=header[0], value=row[0], place=place)
    return tabulated(
        path.stem,
        [wavenumber for wavenumber, _ in points],
        [factor * density for _, density in points],
        argument=argument,
        source=f"given by the user, {path.name}",
    )


def _rows(path: Path) -> list[tuple[int, list[str]]]:
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
        raise InputError("needs two columns", place=Place(str(path), lines[0][0]), fix=_EXAMPLE)
    rows = [(i, [field.strip().strip('"') for field in line.split(delimiter)]) for i, line in lines]
    if delimiter in _DECIMAL_COMMA:
        rows[1:] = [(i, [field.replace(",", ".") for field in fields]) for i, fields in rows[1:]]
    return rows


def _units(header: list[str], place: Place) -> tuple[_Argument, float]:
    """What the wavenumbers are, and the factor of the densities to meters."""
    found = [_UNIT.fullmatch(field) for field in header[:2]]
    if len(found) < 2 or found[0] is None or found[1] is None:
        raise InputError(
            "must name both columns with their units", value="; ".join(header), place=place, fix=_EXAMPLE
        )
    first = found[0][1]
    second = re.sub(r"\s+", " ", found[1][1].replace("²", "^2").replace("³", "^3").replace("*", " "))
    if first not in _ARGUMENTS:
        raise InputError("must be in 1/m or rad/m", field=header[0], place=place, fix=_EXAMPLE)
    if second not in _DENSITIES:
        raise InputError("is no unit of a density that is known", field=header[1], place=place, fix=_EXAMPLE)
    argument, factor = _DENSITIES[second]
    if argument != _ARGUMENTS[first]:
        rule = f"must be per {'rad/m' if argument == 'cycles/m' else '1/m'}, as {header[0]} says"
        raise InputError(rule, field=header[1], place=place, fix=_EXAMPLE)
    return argument, factor


def _positive(text: str, field: str, place: Place) -> float:
    try:
        value = float(text)
    except ValueError:
        raise InputError("must be a number", field=field, value=text, place=place) from None
    if not 0.0 < value < float("inf"):
        raise InputError("must be positive and finite", field=field, value=text, place=place)
    return value
