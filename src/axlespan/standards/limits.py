"""Limits of the standards with their sources, and those that a case puts in their place."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from axlespan.standards.verdict import FROM_MEMORY
from axlespan.units import ACCELERATION, ANGLE, FORCE, FREQUENCY, LENGTH, NUMBER, Dimension

if TYPE_CHECKING:
    from axlespan.standards.assessment import Assessment

_EN1990 = f"EN 1990:2002/A1:2005 A2.4.4; {FROM_MEMORY}"

#: Names of limits, and what they measure.
LIMITS: dict[str, Dimension] = {
    "deck_acceleration": ACCELERATION,
    "deck_frequency": FREQUENCY,  # up to which the deck's acceleration counts, before 1.5 f1 and f3
    "deflection_ratio": NUMBER,  # L/δ
    "end_rotation": ANGLE,
    "end_offset": LENGTH,
    "twist": LENGTH,  # over 3 m
    "body_acceleration": ACCELERATION,
    "wheel_unloading": NUMBER,
    "contact_force": FORCE,
    "derailment": NUMBER,
    "dynamic_effect": NUMBER,
    "damping_excess": NUMBER,
    "continuous_comfort": ACCELERATION,
    "mean_comfort": NUMBER,
    "weighted_rms": ACCELERATION,
    "sperling": NUMBER,
}


@dataclass(frozen=True)
class Limit:
    """A limit and its source; the value is None where the standards have none, or one that is not known."""

    value: float | None
    source: str = ""
    missing: str = ""  # what would have to be known


def limit_of(name: str, assessment: Assessment) -> Limit:
    """The limit of a name of :data:`LIMITS`: that of the assessment, else that of the standards."""
    if name in assessment.limits:
        whose = f"national value: {assessment.national}" if assessment.national else "given in the assessment"
        return Limit(float(assessment.limits[name]), whose)
    if name == "deck_acceleration":
        return Limit({"ballasted": 3.5, "unballasted": 5.0}[assessment.deck], _EN1990)
    if name == "body_acceleration":
        level = {"very-good": 1.0, "good": 1.3, "acceptable": 2.0}[assessment.comfort]
        return Limit(level, f"{_EN1990} (comfort {assessment.comfort})")
    if name in ("end_offset", "twist"):
        return _by_speed(name, assessment)
    return _FIXED.get(name, Limit(None))


def largest_wheel_force(static: float, speed: float) -> tuple[float, str]:
    """Limit of the vertical wheel force Q [N] by the static one Q0 and the speed [m/s] (EN 14363).

    90 kN more than Q0, and at most 200, 190, 180, 170 or 160 kN up to 160, 200, 250, 300 km/h and beyond.
    """
    steps = ((160.0, 200e3), (200.0, 190e3), (250.0, 180e3), (300.0, 170e3), (float("inf"), 160e3))
    most = next(force for end, force in steps if 3.6 * speed <= end * (1.0 + 1e-9))
    return min(90e3 + static, most), f"EN 14363:2016, vertical wheel force; {FROM_MEMORY}"


_FIXED = {
    "deck_frequency": Limit(30.0, _EN1990),
    "deflection_ratio": Limit(600.0, _EN1990),
    "wheel_unloading": Limit(0.6, f"EN 14363 (twisted track) and common practice; {FROM_MEMORY}"),
    "derailment": Limit(0.8, f"EN 14363, radii from 250 m on; {FROM_MEMORY}"),
    "dynamic_effect": Limit(1.0, f"EN 1991-2:2003 6.4.6.5; {FROM_MEMORY}"),
    "damping_excess": Limit(1.0, f"EN 1991-2:2003 6.4.6.3; {FROM_MEMORY}"),
}


def _by_speed(name: str, assessment: Assessment) -> Limit:
    speed = assessment.line_speed
    if speed is None:
        return Limit(None, missing="line_speed")
    kmh = 3.6 * speed * (1.0 - 1e-12)
    if name == "end_offset":
        return Limit(3e-3 if kmh <= 160.0 else 2e-3, f"EN 1991-2:2003 6.5.4.5.2; {FROM_MEMORY}")
    return Limit(4.5e-3 if kmh <= 120.0 else 3.0e-3 if kmh <= 200.0 else 1.5e-3, _EN1990)
