"""Checks of running safety: wheel unloading, wheel forces, loss of contact, derailment quotient."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.standards.filters import low_pass
from axlespan.standards.given import Given
from axlespan.standards.limits import largest_wheel_force, limit_of
from axlespan.standards.verdict import FROM_MEMORY, Verdict, judged, not_assessed
from axlespan.vehicles.vehicle import LEFT, RIGHT

FloatArray = npt.NDArray[np.float64]

#: Frequency of the low-pass of wheel forces [Hz] (EN 14363, from memory).
WHEEL_FREQUENCY = 20.0

# Lines of left and right wheels.
_SIDES = frozenset((LEFT, RIGHT))

_FORCES = "the loads are given forces that no vehicle carries: they do not change"


def wheel_unloading(given: Given) -> list[Verdict]:
    """ΔQ/Q0 of the wheels on the deck, forces below 20 Hz."""
    check, clause = "wheel_unloading", "EN 14363; ΔQ/Q0"
    quantity = "wheel unloading ΔQ/Q0"
    found = _filtered(given)
    if isinstance(found, str):
        return [not_assessed(check, clause, quantity, found)]
    forces, raw = found
    static = given.static_forces
    unloading = np.where(np.isfinite(forces), 1.0 - forces / static, -np.inf)
    row, wheel = np.unravel_index(int(np.argmax(unloading)), unloading.shape)
    limit = limit_of(check, given.assessment)
    whole = float(np.nanmax(np.where(np.isfinite(forces), 1.0 - raw / static, -np.inf)))
    return [
        judged(
            check,
            clause,
            quantity,
            float(unloading[row, wheel]),
            limit.value,
            "",
            where=_where(given, int(row), int(wheel)),
            when=float(given.result.time[row]),
            source=limit.source,
            note=f"forces below {WHEEL_FREQUENCY:g} Hz, wheels on the deck; {whole:.3g} of all frequencies",
        )
    ]


def contact_force(given: Given) -> list[Verdict]:
    """Largest vertical wheel force on the deck, below 20 Hz: that with the highest share of its limit."""
    check, clause = "contact_force", "EN 14363; Q"
    quantity = "vertical wheel force Q"
    found = _filtered(given)
    if isinstance(found, str):
        return [not_assessed(check, clause, quantity, found)]
    forces, _ = found
    own = limit_of(check, given.assessment)
    wheels = given.static_forces * _share(given)
    limits = [largest_wheel_force(force, given.speed) for force in wheels]
    values = np.array([own.value if own.value is not None else limit for limit, _ in limits]) / _share(given)
    used = np.where(np.isfinite(forces), forces / values, -np.inf)
    row, wheel = np.unravel_index(int(np.argmax(used)), used.shape)
    per_axle = _share(given)[wheel] != 1.0
    return [
        judged(
            check,
            clause,
            quantity,
            float(forces[row, wheel] * _share(given)[wheel]),
            float(values[wheel] * _share(given)[wheel]),
            "N",
            where=_where(given, int(row), int(wheel)),
            when=float(given.result.time[row]),
            source=own.source if own.value is not None else limits[int(wheel)][1],
            note=f"forces below {WHEEL_FREQUENCY:g} Hz, wheels on the deck"
            + ("; half of the force of the axle" if per_axle else ""),
        )
    ]


def loss_of_contact(given: Given) -> list[Verdict]:
    """Episodes in which a wheel is off the rail, or held to it pulls at it, where a free one would lift off."""
    check, clause, quantity = "loss_of_contact", "running safety", "episodes without contact pressure"
    result = given.result
    if not result.contact or bool(np.all(given.moving_forces)):
        return [not_assessed(check, clause, quantity, _FORCES if result.contact else "there are no wheels")]
    checks = result.checks
    if checks.get("tension_episodes") is None or not checks.get("smallest_contact_force"):
        return [not_assessed(check, clause, quantity, "tension was not watched in this run")]
    free = np.flatnonzero(~given.moving_forces)
    smallest = np.array([float(checks["smallest_contact_force"][result.contact[i]]) for i in free])
    share = smallest / given.static_forces[free]
    worst = int(np.argmin(share))
    name = result.contact[int(free[worst])]
    when = (checks.get("smallest_contact_force_time") or {}).get(name)
    return [
        judged(
            check,
            clause,
            quantity,
            float(checks["tension_episodes"] + checks.get("flight_count", 0)),
            0.0,
            "",
            where=f"wheel {name}",
            when=None if when is None else float(when),
            source="a wheel must press on the rail",
            note=f"smallest force {share[worst]:.3g} of the static one",
        )
    ]


def derailment(given: Given) -> list[Verdict]:
    """Y/Q and the track shifting force need lateral forces."""
    reason = "the model has no lateral forces"
    return [
        not_assessed(
            "derailment",
            "EN 14363; Y/Q",
            "derailment quotient Y/Q",
            reason,
            source=limit_of("derailment", given.assessment).source or FROM_MEMORY,
        )
    ]


def _share(given: Given) -> FloatArray:
    """Share of a contact's force that one wheel has: 1/2 for axles of vehicles in the plane, else 1.

    A left or right wheel is one wherever it runs: on one line for both, or on the rails of a second track.
    """
    if given.crossing is None or len(given.crossing.contact_lines) != len(given.result.contact):
        return np.full(len(given.result.contact), 0.5)
    own = [point.line for item in given.crossing.placements for point in item.vehicle.contacts]
    both = zip(own, given.crossing.contact_lines, strict=True)
    return np.array([0.5 if _SIDES.isdisjoint(names) else 1.0 for names in both])


def _filtered(given: Given) -> tuple[FloatArray, FloatArray] | str:
    """Filtered forces (n_time, n_contact), nan off the deck and for given forces, and raw ones; or why not."""
    result = given.result
    if not result.contact_force.size or len(result.time) < 2:
        return "there are no wheel forces"
    if bool(np.all(given.moving_forces)):
        return _FORCES
    wanted = given.on_deck & ~given.moving_forces
    if not np.any(wanted):
        return "no wheel is on the deck"
    longest = 0.5 / (2.0 * WHEEL_FREQUENCY)
    if given.interval > longest:
        return f"records are {given.interval:.3g} s apart; a filter at 20 Hz asks for {longest:.3g} s"
    if given.thinned:
        return given.thinned
    if not np.all(np.isfinite(given.static_forces)):
        return "the static wheel forces are not known"
    smooth = low_pass(result.contact_force, given.interval, WHEEL_FREQUENCY)
    return np.where(wanted, smooth, np.nan), result.contact_force


def _where(given: Given, row: int, wheel: int) -> str:
    return f"wheel {given.result.contact[wheel]} at {given.result.contact_position[row, wheel]:.4g} m"
