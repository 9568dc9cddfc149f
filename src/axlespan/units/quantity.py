"""Read and show quantities: a number and its unit."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

from axlespan.errors import InputError
from axlespan.units.dimensions import FORCE, FREQUENCY, MASS, NUMBER, RATIO, Dimension, kind
from axlespan.units.symbols import Exponents, UnknownUnit, corrected, multiply_out

_LONGEST: Final = 80
_SMALLEST, _LARGEST = 1e-30, 1e30  # SI; far beyond whatever is measured, far within what floats can multiply
_WEIGHT: Final = 9.81  # m/s^2, for messages that turn masses into weights
_SUPERSCRIPTS: Final = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")
_PLAIN: Final = str.maketrans(
    {"µ": "u", "μ": "u", "−": "-", "·": "*", "⋅": "*", "×": "*", "\u00a0": " ", "\u2009": " ", "\u202f": " "}
)
_VALUE: Final = re.compile(r"[+-]?(?:[0-9]+(?:_[0-9]+)*\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
# a number with a decimal comma or with separators: 12,5 | 1'000 | 1 595 | 1,595.5 | 1.000.000
_SEPARATED: Final = re.compile(r"[+-]?[0-9]+(?:[,.'][0-9]+| [0-9]{3}(?![0-9]))+")
_NO_MARKS: Final = str.maketrans("", "", ",.' ")
_GOES_ON: Final = re.compile(
    r"[,'.]?\.?[0-9]|\s+[0-9]+(?!\s*/|[0-9])|\s*/\s*[0-9]|\s*[*^±]|\s*-\s*[0-9]|\s*\+-|[eE]\b"
)


@dataclass(frozen=True)
class Reading:
    """A quantity as it was read: SI value, powers of m, kg, s and rad; number and unit as written."""

    value: float
    exponents: Exponents
    number: str
    unit: str


def parse(text: Any, dimension: Dimension) -> float:
    """Return a quantity of a known kind in SI units.

    Parameters
    ----------
    text : str or float
        ``"47.7 km/h"``, or a plain number, which is SI.
    dimension : Dimension
        What it must be, such as ``SPEED``.

    Raises
    ------
    InputError
        If it is no number, not finite, beyond 1e-30 to 1e30 in size, has an unknown unit or is of another kind.

    Examples
    --------
    >>> from axlespan.units import DAMPING, LENGTH, SPEED
    >>> parse("90 km/h", SPEED), parse("20 kN s/m", DAMPING), parse(25, LENGTH)
    (25.0, 20000.0, 25.0)
    >>> parse("25 kg", LENGTH)
    Traceback (most recent call last):
    axlespan.errors.InputError: '25 kg': must be a length; 'kg' is a mass. Write 25 m
    """
    if isinstance(text, bool) or not isinstance(text, (str, int, float)):
        raise InputError(f"must be {dimension.name}", value=text, fix=_example(dimension))
    if not isinstance(text, str):
        try:
            return _sound(_finite(float(text), text), text)
        except OverflowError:
            return _finite(math.inf, text)
    reading = read(text, dimension)
    if reading.unit and not dimension.accepts(reading.exponents):
        raise InputError(
            f"must be {dimension.name}; '{reading.unit}' is {kind(reading.exponents)}",
            value=text,
            fix=_other_kind(reading, dimension),
        )
    return _sound(reading.value, text)


def read(text: str, dimension: Dimension | None = None) -> Reading:
    """Return number, unit, SI value and powers of a text, whatever its kind.

    Parameters
    ----------
    text : str
        ``"2.87 GPa"``.
    dimension : Dimension, optional
        The kind that is expected: it words the messages and tells gravity from grams.

    Examples
    --------
    >>> read("2.87 GPa").exponents
    (-1.0, 1.0, -2.0, 0.0)
    """
    plain = re.sub("[⁰¹²³⁴⁵⁶⁷⁸⁹⁻]+", lambda m: "^" + m[0].translate(_SUPERSCRIPTS), text.translate(_PLAIN))
    plain = plain.strip()
    match = _VALUE.match(plain)
    if match is None or len(plain) > _LONGEST:
        raise _no_number(text, plain, dimension)
    number, unit = match[0], plain[match.end() :].strip()
    _refuse_half_number(text, plain, match.end(), dimension)
    if not unit:
        return Reading(_finite(float(number), text), (0, 0, 0, 0), number, "")
    try:
        scale, exponents = multiply_out(unit, dimension is not None and dimension.gravity)
    except UnknownUnit as unknown:
        rule = f"'{unknown.symbol or unit}' is not a {'known ' if unknown.symbol else ''}unit"
        raise InputError(rule, value=text, fix=_near(number, unit, dimension)) from None
    return Reading(_finite(_product(number, scale), text), exponents, number, unit)


def factor(unit: str, dimension: Dimension) -> float:
    """Return the SI value of one ``unit``; the empty unit is SI.

    Examples
    --------
    >>> from axlespan.units import STIFFNESS
    >>> factor("kN/mm", STIFFNESS)
    1000000.0
    """
    return parse(f"1 {unit}", dimension)


def show(value: float, dimension: Dimension, digits: int = 4) -> str:
    """Return a quantity for people to read.

    Examples
    --------
    >>> from axlespan.units import FORCE, LENGTH, PRESSURE, SPEED
    >>> show(2.87e9, PRESSURE), show(13.25, SPEED), show(-5e-4, LENGTH), show(0.0, FORCE)
    ('2.87 GPa', '47.7 km/h', '-0.5 mm', '0 N')
    """
    if value == 0.0 or not math.isfinite(value):
        return f"{value:g} {dimension.unit}".strip()
    scales = [(factor(unit, dimension), unit) for unit in dimension.shown]
    scale, unit = next((s for s in scales if abs(value) >= s[0] * (1.0 - 1e-12)), scales[-1])
    return f"{value / scale:.{digits}g} {unit}".strip()


def _product(number: str, scale: Fraction) -> float:
    """Return the number nearest to the exact product, so that 47.7 km/h is 13.25 m/s to the last digit."""
    value = float(number)
    if not 1e-200 < abs(value) < 1e200:  # spares fractions of huge powers of ten
        return value * float(scale)
    return float(Fraction(number) * scale)


def _finite(value: float, written: object) -> float:
    if not math.isfinite(value):
        raise InputError("must be a finite number", value=written)
    return value


def _sound(value: float, written: object) -> float:
    """Refuse sizes whose powers and products would overflow, or vanish, in what is computed from them."""
    if value != 0.0 and not _SMALLEST <= abs(value) <= _LARGEST:
        size = "large" if abs(value) > 1.0 else "small"
        raise InputError(f"is too {size} to compute with", value=written, fix="Look at its exponent")
    return value


def _example(dimension: Dimension | None) -> str:
    if dimension is NUMBER:
        return f"Write a plain number, such as {dimension.example}"
    if dimension is RATIO:
        return "Write a plain number, such as 0.01, or 1 %"
    return f"Write a number and its unit, such as {dimension.example if dimension else '25 m'}"


def _no_number(text: str, plain: str, dimension: Dimension | None) -> InputError:
    if plain.lower().lstrip("+-.") in ("nan", "inf", "infinity"):
        return InputError("must be a finite number", value=text)
    name = dimension.name if dimension else "a number and its unit"
    return InputError(f"must be {name}", value=text, fix=_example(dimension))


def _near(number: str, unit: str, dimension: Dimension | None) -> str:
    """Say what an unreadable unit may have meant."""
    better = corrected(unit)
    try:
        exponents = multiply_out(better, dimension is not None and dimension.gravity)[1]
    except UnknownUnit:
        return _example(dimension)
    if dimension and not dimension.accepts(exponents):
        return _example(dimension)
    return f"Write {number} {better}"


def _other_kind(reading: Reading, dimension: Dimension) -> str:
    """Say what to write instead of a quantity of another kind; weights and masses are converted."""
    here, wanted = reading.exponents, dimension.exponents
    if dimension in (RATIO, NUMBER) or here == (0, 0, 0, 0):
        return _example(dimension)
    if here == MASS.exponents and wanted == FORCE.exponents:
        return f"Write {show(reading.value * _WEIGHT, FORCE)}, the weight of {reading.number} {reading.unit}"
    if here == FORCE.exponents and wanted == MASS.exponents:
        return f"Write {show(reading.value / _WEIGHT, MASS)}, which weighs {reading.number} {reading.unit}"
    if here == (0, 0, -1, 1) and dimension is FREQUENCY:
        return f"Write {show(reading.value / math.tau, FREQUENCY)}, the angular frequency over 2 pi"
    return f"Write {reading.number} {dimension.everyday}"


def _refuse_half_number(text: str, plain: str, end: int, dimension: Dimension | None) -> None:
    """Refuse a text whose number goes on after ``end``: ``12,5 m``, ``1 595 kN/m``, ``1/3 m``."""
    run = _SEPARATED.match(plain)
    if run is None or run.end() <= end:
        if _GOES_ON.match(plain, end):
            raise InputError("must be one number and its unit", value=text, fix=_example(dimension))
        return
    unit = plain[run.end() :].strip() or (dimension.everyday if dimension else "")
    marks = re.sub("[0-9+-]", "", run[0])
    digits = run[0].translate(_NO_MARKS)
    before, _, after = run[0].rpartition(marks[-1])
    decimal = f"{before.translate(_NO_MARKS)}.{after}"
    if marks == ",":
        thousands = f", or {f'{digits} {unit}'.strip()} if the comma parts thousands"
        fix = f"Write {decimal} {unit}".strip() + (thousands if len(after) == 3 else "")
        raise InputError("has a decimal comma", value=text, fix=fix)
    # of several marks, the last one is the decimal sign where it is a comma or a point that stands once
    number = decimal if marks[-1] in ",." and marks.count(marks[-1]) == 1 else digits
    raise InputError("has separators in its number", value=text, fix=f"Write {number} {unit}".strip())
