"""Symbols of units and how a product of them is multiplied out, in exact fractions."""

from __future__ import annotations

import difflib
import math
import re
from fractions import Fraction
from functools import lru_cache
from typing import Final

Exponents = tuple[float, float, float, float]
"""Powers of length [m], mass [kg], time [s] and angle [rad]."""

Unit = tuple[Fraction, Exponents]
"""SI value of one such unit, and its powers."""

STANDARD_GRAVITY: Final = Fraction("9.80665")  # m/s^2, exact (3rd CGPM, 1901)
INCH: Final = Fraction("0.0254")  # m, exact (international yard and pound, 1959)
POUND: Final = Fraction("0.45359237")  # kg, exact (the same)

_NUMBER: Final = (0.0, 0.0, 0.0, 0.0)
_LENGTH: Final = (1.0, 0.0, 0.0, 0.0)
_MASS: Final = (0.0, 1.0, 0.0, 0.0)
_TIME: Final = (0.0, 0.0, 1.0, 0.0)
_ANGLE: Final = (0.0, 0.0, 0.0, 1.0)
_FORCE: Final = (1.0, 1.0, -2.0, 0.0)
_PRESSURE: Final = (-1.0, 1.0, -2.0, 0.0)

_PREFIXES: Final = {
    "": Fraction(1),
    "u": Fraction(1, 10**6),
    "m": Fraction(1, 1000),
    "c": Fraction(1, 100),
    "d": Fraction(1, 10),
    "k": Fraction(10**3),
    "M": Fraction(10**6),
    "G": Fraction(10**9),
}
# symbol: (SI value, powers, prefixes that it takes)
_ATOMS: Final[dict[str, tuple[Fraction, Exponents, str]]] = {
    "m": (Fraction(1), _LENGTH, "umcdk"),
    "g": (Fraction(1, 1000), _MASS, "mk"),
    "t": (Fraction(1000), _MASS, "k"),
    "s": (Fraction(1), _TIME, "um"),
    "min": (Fraction(60), _TIME, ""),
    "h": (Fraction(3600), _TIME, ""),
    "N": (Fraction(1), _FORCE, "kMG"),
    "Pa": (Fraction(1), _PRESSURE, "kMG"),
    "Hz": (Fraction(1), (0.0, 0.0, -1.0, 0.0), "mkM"),
    "rad": (Fraction(1), _ANGLE, "um"),
    "deg": (Fraction(math.pi) / 180, _ANGLE, ""),
    "°": (Fraction(math.pi) / 180, _ANGLE, ""),
    "%": (Fraction(1, 100), _NUMBER, ""),
    "‰": (Fraction(1, 1000), _NUMBER, ""),
    "kgf": (STANDARD_GRAVITY, _FORCE, ""),
    "tf": (1000 * STANDARD_GRAVITY, _FORCE, ""),
    "in": (INCH, _LENGTH, ""),
    "ft": (12 * INCH, _LENGTH, ""),
    "lb": (POUND, _MASS, ""),
    "lbf": (POUND * STANDARD_GRAVITY, _FORCE, ""),
    "kip": (1000 * POUND * STANDARD_GRAVITY, _FORCE, ""),
    "psi": (POUND * STANDARD_GRAVITY / INCH**2, _PRESSURE, ""),
    "ksi": (1000 * POUND * STANDARD_GRAVITY / INCH**2, _PRESSURE, ""),
    "mph": (Fraction("0.44704"), (1.0, 0.0, -1.0, 0.0), ""),
}
UNITS: Final[dict[str, Unit]] = {
    prefix + symbol: (_PREFIXES[prefix] * value, exponents)
    for symbol, (value, exponents, prefixes) in _ATOMS.items()
    for prefix in ("", *prefixes)
}
# products written without a sign between: kNs/m, MNm, kgm2
RUN_TOGETHER: Final[dict[str, tuple[str, ...]]] = {
    prefix + "".join(symbols): (prefix + symbols[0], *symbols[1:])
    for symbols, prefixes in (
        (("N", "m"), ("", "k", "M", "G")),
        (("N", "mm"), ("", "k")),
        (("N", "s"), ("", "k", "M", "G")),
        (("N", "m", "s"), ("", "k", "M", "G")),
        (("g", "m"), ("k",)),
        (("t", "m"), ("",)),
    )
    for prefix in prefixes
}
_SPOKEN: Final = {
    **dict.fromkeys(("kph", "kmh", "kmph", "kmhr"), "km/h"),
    **dict.fromkeys(("ton", "tons", "tonne", "tonnes", "to"), "t"),
    **dict.fromkeys(("meter", "meters", "metre", "metres"), "m"),
    **dict.fromkeys(("sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("hr", "hour", "hours"), "h"),
    **dict.fromkeys(("newton", "newtons"), "N"),
    **dict.fromkeys(("percent", "pct"), "%"),
    **dict.fromkeys(("degree", "degrees"), "deg"),
    **dict.fromkeys(("hertz", "cps"), "Hz"),
    **dict.fromkeys(("lbs", "pound", "pounds"), "lb"),
    "kgs": "kg",
    "micron": "um",
}
_TERM: Final = re.compile(
    r"(?P<symbol>[A-Za-z°%‰]+)"
    r"(?:\s*(?:\^|\*\*)\s*(?P<power>[+-]?\d+(?:\.\d+)?|\([+-]?\d+/[1-9]\d*\))|(?P<adjacent>-?\d+))?"
)


class UnknownUnit(ValueError):
    """A unit cannot be read; ``symbol`` is the part that is not known, ``None`` where the form is wrong."""

    def __init__(self, symbol: str | None = None) -> None:
        self.symbol = symbol
        super().__init__(symbol)


@lru_cache(maxsize=1024)
def multiply_out(text: str, gravity: bool = False) -> Unit:
    """Return SI value and powers of a unit, read from left to right: ``kN/m s`` is (kN/m) s.

    With ``gravity`` the symbol ``g`` is the standard gravity, otherwise a gram.
    """
    value, exponents, sign, at, due = Fraction(1), _NUMBER, 1, 0, False
    while at < len(text):
        if text[at] in " *.-/":
            if text[at] != " ":
                # two signs in a row, or a sign before the first factor other than 1/..., are slips
                if due or (at == 0 and text[at] != "/"):
                    raise UnknownUnit
                due, sign = True, -1 if text[at] == "/" else 1
            at += 1
            continue
        if text[at] == "(":
            end = text.find(")", at)
            if end < 0 or "(" in text[at + 1 : end]:
                raise UnknownUnit
            part, at = multiply_out(text[at + 1 : end], gravity), end + 1
        elif at == 0 and re.match(r"1\s*/", text):
            part, at = (Fraction(1), _NUMBER), 1
        elif match := _TERM.match(text, at):
            part, at = _term(match, gravity), match.end()
        else:
            raise UnknownUnit
        value, exponents = value * part[0] ** sign, _times(exponents, part[1], sign)
        sign, due = 1, False
    if due:
        raise UnknownUnit
    return value, exponents


def corrected(text: str) -> str:
    """Return a unit with each unknown symbol replaced by the nearest known one: ``KM/H`` is ``km/h``."""
    return _TERM.sub(
        lambda m: (nearest(m["symbol"]) or m["symbol"]) + m[0][len(m["symbol"]) :], text.strip(" .,;")
    )


def nearest(symbol: str) -> str | None:
    """Return the known unit that a symbol resembles most."""
    known = [*UNITS, *RUN_TOGETHER]
    if symbol in known:
        return symbol
    if symbol.lower() in _SPOKEN:
        return _SPOKEN[symbol.lower()]
    same = [unit for unit in known if unit.lower() == symbol.lower()]
    return next(iter(same or difflib.get_close_matches(symbol, known, n=1, cutoff=0.6)), None)


def _term(match: re.Match[str], gravity: bool) -> Unit:
    """Return value and powers of one symbol with its power; ``kgm2`` is kg m^2."""
    *heads, last = RUN_TOGETHER.get(match["symbol"], (match["symbol"],))
    power = Fraction((match["power"] or match["adjacent"] or "1").strip("()"))
    if abs(power) > 12:
        raise UnknownUnit
    value, exponents = _symbol(last, gravity)
    raised = value**power
    value = raised if isinstance(raised, Fraction) else Fraction(raised)
    exponents = _times(_NUMBER, exponents, float(power))
    for head in heads:
        other = _symbol(head, gravity)
        value, exponents = value * other[0], _times(exponents, other[1], 1)
    return value, exponents


def _symbol(symbol: str, gravity: bool) -> Unit:
    if gravity and symbol == "g":
        return STANDARD_GRAVITY, (1.0, 0.0, -2.0, 0.0)
    if symbol not in UNITS:
        raise UnknownUnit(symbol)
    return UNITS[symbol]


def _times(a: Exponents, b: Exponents, power: float) -> Exponents:
    return (a[0] + power * b[0], a[1] + power * b[1], a[2] + power * b[2], a[3] + power * b[3])
