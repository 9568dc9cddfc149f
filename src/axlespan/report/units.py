"""Units that engineers read: mm, kN and mrad instead of m, N and rad."""

from __future__ import annotations

import math

#: SI unit -> factor and unit shown.
_SHOWN = {
    "m": (1e3, "mm"),
    "rad": (1e3, "mrad"),
    "m/s": (1e3, "mm/s"),
    "m/s^2": (1.0, "m/s²"),
    "rad/s^2": (1.0, "rad/s²"),
    "N": (1e-3, "kN"),
    "N m": (1e-3, "kN m"),
    "N/m^2": (1e-6, "MPa"),
    "N/m": (1e-3, "kN/m"),
}


def shown_unit(unit: str) -> tuple[float, str]:
    """Factor from an SI unit to the unit that is shown, and that unit.

    Examples
    --------
    >>> shown_unit("m"), shown_unit("Hz")
    ((1000.0, 'mm'), (1.0, 'Hz'))
    """
    return _SHOWN.get(unit, (1.0, unit))


def plain(value: float | None) -> str:
    """A number as one would write it, without zeros at its end.

    Examples
    --------
    >>> plain(25.0), plain(27.777777), plain(None)
    ('25', '27.78', '–')
    """
    if value is None or not math.isfinite(value):
        return "–"
    return f"{value:.4g}".replace("-", "−") if abs(value) < 1e4 else number(value, 6)


def number(value: float | None, digits: int = 4) -> str:
    """A number with some significant digits and a true minus sign; a dash where there is none.

    Examples
    --------
    >>> number(-2.40689), number(57258.54), number(1.2e-15), number(None)
    ('−2.407', '57\u202f259', '1.2e−15', '–')
    """
    if value is None or not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    size = abs(value)
    if size >= 1e7 or size < 1e-4:
        text = f"{value:.{min(digits, 3) - 1}g}"
        return text.replace("-", "−").replace("e+0", "e").replace("e−0", "e−")
    decimals = max(0, digits - 1 - math.floor(math.log10(size)))
    text = f"{value:,.{decimals}f}".replace(",", "\u202f")
    return text.replace("-", "−")
