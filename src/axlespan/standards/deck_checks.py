"""Checks of the deck: acceleration, deflection, rotation and offset of its ends, twist."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.standards.filters import ROLL_OFF, up_to
from axlespan.standards.given import Given
from axlespan.standards.limits import limit_of
from axlespan.standards.verdict import Verdict, judged, not_assessed

FloatArray = npt.NDArray[np.float64]

_NO_LINE = "the deck was not recorded: write line: 41 under output"


def deck_acceleration(given: Given) -> list[Verdict]:
    """Vertical acceleration of the deck, of frequencies up to the largest of 30 Hz, 1.5 f1 and f3."""
    check, clause = "deck_acceleration", "EN 1990 A2.4.4.2.1"
    quantity = "vertical acceleration of the deck"
    result, frequencies = given.result, given.facts.frequencies
    if not result.line_acceleration.size:
        return [not_assessed(check, clause, quantity, _NO_LINE)]
    if not frequencies:
        reason = "the frequencies of vertical bending are not known"
        return [not_assessed(check, clause, quantity, reason)]
    band = limit_of("deck_frequency", given.assessment).value or 0.0
    band = max(band, 1.5 * frequencies[0], frequencies[2] if len(frequencies) > 2 else 0.0)
    longest = 0.5 / (ROLL_OFF * band)
    if not 0.0 < given.interval <= longest:
        reason = f"records are {given.interval:.3g} s apart; frequencies up to {band:.3g} Hz ask for {longest:.2g} s"
        return [not_assessed(check, clause, quantity, reason)]
    if given.thinned:
        return [not_assessed(check, clause, quantity, given.thinned)]
    filtered = np.abs(up_to(result.line_acceleration, given.interval, band))
    row, column = np.unravel_index(int(np.argmax(filtered)), filtered.shape)
    limit = limit_of(check, given.assessment)
    raw = float(np.abs(result.line_acceleration).max())
    verdict = judged(
        check,
        clause,
        quantity,
        float(filtered[row, column]),
        limit.value,
        "m/s^2",
        where=f"{result.line_position[column]:.4g} m",
        when=float(result.time[row]),
        source=limit.source,
        note=f"frequencies up to {band:.3g} Hz; {raw:.3g} m/s^2 of all frequencies; {given.assessment.deck} deck",
    )
    return [verdict]


def deflection(given: Given) -> list[Verdict]:
    """Vertical deflection of each span under the train of the run, against L/600."""
    check, clause = "deflection", "EN 1990 A2.4.4.2.3"
    quantity = "vertical deflection"
    result = given.result
    if not result.line_displacement.size:
        return [not_assessed(check, clause, quantity, _NO_LINE)]
    if not given.facts.spans:
        return [not_assessed(check, clause, quantity, given.facts.missing)]
    limit = limit_of("deflection_ratio", given.assessment)
    assert limit.value is not None
    moved = given.live_deflection
    best: tuple[float, float, int, int] | None = None
    for start, span in zip(given.facts.starts, given.facts.spans, strict=True):
        inside = np.flatnonzero(
            (result.line_position >= start - 1e-9) & (result.line_position <= start + span + 1e-9)
        )
        if not len(inside):
            continue
        place = np.unravel_index(int(np.argmax(-moved[:, inside])), (len(moved), len(inside)))
        at = (int(place[0]), int(inside[place[1]]))
        size = float(-moved[at])
        if best is None or size / span > best[0] / best[1]:
            best = (size, span, *at)
    if best is None:
        return [not_assessed(check, clause, quantity, "no recorded point lies in a span")]
    size, span, row, column = best
    ratio = span / size if size > 0.0 else float("inf")
    return [
        judged(
            check,
            clause,
            quantity,
            max(size, 0.0),
            span / limit.value,
            "m",
            where=f"{result.line_position[column]:.4g} m",
            when=float(result.time[row]),
            source=limit.source,
            note=f"L/{ratio:.0f} of a span of {span:.4g} m under the train of this run, limit L/{limit.value:.0f}",
        )
    ]


def end_rotation(given: Given) -> list[Verdict]:
    """Rotation of the deck's ends; the standards limit it through the offset and the rail stresses (6.5.4)."""
    check, clause, quantity = "end_rotation", "EN 1990 A2.4.4.2.3 (2)", "rotation of the deck's end"
    found = _end_motion(given)
    if found is None:
        return [not_assessed(check, clause, quantity, _NO_LINE)]
    rotation, _ = found
    row, end = np.unravel_index(int(np.argmax(rotation)), rotation.shape)
    limit = limit_of(check, given.assessment)
    return [
        judged(
            check,
            clause,
            quantity,
            float(rotation[row, end]),
            limit.value,
            "rad",
            where=f"{given.result.line_end[end]:.4g} m",
            when=float(given.result.time[row]),
            source=limit.source,
        )
    ]


def end_offset(given: Given) -> list[Verdict]:
    """Vertical offset of the deck's end: its rotation times the overhang beyond the bearing, and what the end moves."""
    check, clause, quantity = "end_offset", "EN 1991-2 6.5.4.5.2", "vertical offset of the deck's end"
    found = _end_motion(given)
    if found is None:
        return [not_assessed(check, clause, quantity, _NO_LINE)]
    overhang = given.assessment.overhang
    if overhang is None:
        reason = "the overhang from the bearing to the end of the deck is not known: give overhang"
        return [not_assessed(check, clause, quantity, reason)]
    limit = limit_of(check, given.assessment)
    if limit.missing:
        return [not_assessed(check, clause, quantity, f"the limit depends on it: give {limit.missing}")]
    rotation, moved = found
    size = overhang * rotation + np.abs(moved)
    row, end = np.unravel_index(int(np.argmax(size)), size.shape)
    return [
        judged(
            check,
            clause,
            quantity,
            float(size[row, end]),
            limit.value,
            "m",
            where=f"{given.result.line_end[end]:.4g} m",
            when=float(given.result.time[row]),
            source=limit.source,
            note=f"overhang {overhang:.3g} m",
        )
    ]


def twist(given: Given) -> list[Verdict]:
    """Twist of the track over 3 m: needs two rails."""
    check, clause, quantity = "twist", "EN 1990 A2.4.4.2.2", "twist of the track over 3 m"
    result = given.result
    if not result.line_twist.size:
        reason = "twist needs lines called left and right, of a model in space, and line: 41 under output"
        return [not_assessed(check, clause, quantity, reason)]
    limit = limit_of(check, given.assessment)
    if limit.missing:
        return [not_assessed(check, clause, quantity, f"the limit depends on it: give {limit.missing}")]
    rest = 0.0 if np.any(given.on_deck[0]) else result.line_twist[0]
    size = np.abs(result.line_twist - rest)
    row, column = np.unravel_index(int(np.argmax(size)), size.shape)
    return [
        judged(
            check,
            clause,
            quantity,
            float(size[row, column]),
            limit.value,
            "m",
            where=f"{result.line_position[column]:.4g} m",
            when=float(result.time[row]),
            source=limit.source,
            note="under the train of this run",
        )
    ]


def _end_motion(given: Given) -> tuple[FloatArray, FloatArray] | None:
    """|slope| and displacement of the ends (n_time, 2) by traffic; displacements where ends are recorded."""
    result = given.result
    if not result.line_slope.size:
        return None
    rest = not np.any(given.on_deck[0])
    slope = result.line_slope - (result.line_slope[0] if rest else 0.0)
    moved = np.zeros_like(slope)
    live = given.live_deflection
    for end in range(2):
        at = np.flatnonzero(np.abs(result.line_position - result.line_end[end]) < 1e-6)
        if len(at):
            moved[:, end] = live[:, at[0]]
    return np.abs(slope), moved
