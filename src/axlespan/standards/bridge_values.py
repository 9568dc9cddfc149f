"""What EN 1991-2 6.4 expects of a bridge: damping by type and span, and the band of first frequencies."""

from __future__ import annotations

from axlespan.errors import InputError
from axlespan.standards.verdict import FROM_MEMORY

DAMPING_SOURCE = f"EN 1991-2:2003 table 6.6; {FROM_MEMORY}"
ADDED_SOURCE = f"EN 1991-2:2003 6.4.6.4, figure 6.15 as a formula; {FROM_MEMORY}"
FREQUENCY_SOURCE = f"EN 1991-2:2003 figure 6.10; {FROM_MEMORY}"

#: type -> damping ratio [%] from 20 m on, and its growth [% per m] below.
_DAMPING = {
    "steel": (0.5, 0.125),
    "composite": (0.5, 0.125),
    "prestressed-concrete": (1.0, 0.07),
    "reinforced-concrete": (1.5, 0.07),
    "filler-beam": (1.5, 0.07),
}
BRIDGE_TYPES = tuple(_DAMPING)


def structural_damping(bridge_type: str, span: float) -> float:
    """Lower bound of the damping ratio [-] by type of bridge and span [m].

    Examples
    --------
    >>> structural_damping("prestressed-concrete", 40.0), round(structural_damping("steel", 10.0), 5)
    (0.01, 0.0175)
    """
    if bridge_type not in _DAMPING:
        raise InputError(f"must be one of {', '.join(BRIDGE_TYPES)}", field="bridge_type", value=bridge_type)
    _require_span(span)
    base, growth = _DAMPING[bridge_type]
    return (base + growth * max(0.0, 20.0 - span)) / 100.0


def added_damping(span: float) -> float:
    """Δζ [-] that stands for the vehicles' suspensions when they are modeled as moving forces, spans below 30 m.

    The edition of 2024 and several national annexes set it to zero.

    Examples
    --------
    >>> round(added_damping(15.0), 5), added_damping(30.0)
    (0.00653, 0.0)
    """
    _require_span(span)
    if span >= 30.0:
        return 0.0
    top = 0.0187 * span - 0.00064 * span**2
    bottom = 1.0 - 0.0441 * span - 0.0044 * span**2 + 0.000255 * span**3
    return max(0.0, top / bottom) / 100.0


def frequency_limits(span: float) -> tuple[float, float] | None:
    """Lower and upper limit of the first bending frequency n0 [Hz]; None beyond 4 to 100 m.

    Examples
    --------
    >>> [round(f, 3) for f in frequency_limits(20.0)]
    [4.0, 10.08]
    """
    _require_span(span)
    if not 4.0 <= span <= 100.0:
        return None
    lower = 80.0 / span if span <= 20.0 else 23.58 * span**-0.592
    return lower, 94.76 * span**-0.748


def _require_span(span: float) -> None:
    if not 0.0 < span < float("inf"):
        raise InputError("must be positive", field="span", value=span)
