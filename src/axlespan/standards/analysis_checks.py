"""Checks of the analysis itself: whether it is needed, resonance speeds, the damping that it takes."""

from __future__ import annotations

import numpy as np

from axlespan.standards.bridge_checks import wheels_behind
from axlespan.standards.bridge_values import (
    ADDED_SOURCE,
    DAMPING_SOURCE,
    added_damping,
    frequency_limits,
    structural_damping,
)
from axlespan.standards.dynamic_analysis import (
    FLOW_CHART,
    LOWEST_SPEED,
    OVERSPEED,
    SPEEDS,
    load_model,
    need_of_dynamic_analysis,
    regular_distance,
    resonance_speeds,
)
from axlespan.standards.given import Given
from axlespan.standards.limits import limit_of
from axlespan.standards.verdict import REPORTED, Verdict, judged, not_assessed

# Damping ratios are compared to so many digits: they come from eigenvectors.
_DIGITS = 9


def dynamic_analysis(given: Given) -> list[Verdict]:
    """The flow chart: reported, not judged; with the load model to use."""
    check, clause = "dynamic_analysis", "EN 1991-2 figure 6.9"
    quantity = "need of a dynamic analysis"
    facts, speed = given.facts, given.assessment.line_speed
    if speed is None:
        return [
            not_assessed(
                check, clause, quantity, "the line speed is not known: give line_speed", source=FLOW_CHART
            )
        ]
    n0 = facts.first_frequency
    if not facts.spans or n0 is None:
        reason = facts.missing or "the first frequency is not known: give first_frequency"
        return [not_assessed(check, clause, quantity, reason, source=FLOW_CHART)]
    span = max(facts.spans)
    need = need_of_dynamic_analysis(
        line_speed=speed,
        span=span,
        continuous=facts.continuous,
        simple=facts.simple,
        first_frequency=n0,
        torsional_frequency=given.assessment.torsional_frequency,
    )
    path = "; ".join(need.path)
    if need.required is None:
        return [not_assessed(check, clause, quantity, path, source=FLOW_CHART)]
    limits = frequency_limits(span)
    words = f"{need.words}: {path}"
    if limits is not None and "n0" not in path:
        words += f"; limits of n0 are {limits[0]:.3g} to {limits[1]:.3g} Hz"
    if need.required:
        words += f"; load model {load_model(facts.spans, simple=facts.simple and not facts.continuous)}"
        words += f", speeds from {3.6 * LOWEST_SPEED:.0f} to {3.6 * OVERSPEED * speed:.0f} km/h"
    verdict = Verdict(
        check, clause, f"{quantity}; n0", REPORTED, n0, None, "Hz", source=FLOW_CHART, note=words
    )
    return [verdict]


def critical_speed(given: Given) -> list[Verdict]:
    """Resonance speeds f_j d / i up to 1.2 times the line speed; the one nearest to the run's is the value."""
    check, clause = "critical_speed", "EN 1991-2 6.4.6.2"
    quantity = "resonance speed nearest to that of the run"
    regular = _regular_distance(given)
    if not given.facts.frequencies:
        return [not_assessed(check, clause, quantity, "the frequencies of vertical bending are not known")]
    if regular is None:
        several = given.crossing is not None and len(given.crossing.runs) > 1
        words = (
            "several trains are under way" if several else "the train has no regular distance that stands out"
        )
        reason = f"{words}: give coach_length"
        return [not_assessed(check, clause, quantity, reason, source=SPEEDS)]
    distance, whose = regular
    highest = OVERSPEED * max(given.assessment.line_speed or 0.0, given.speed)
    found = resonance_speeds(given.facts.frequencies, distance, highest=highest)
    if not found:
        reason = f"there is none up to {3.6 * highest:.0f} km/h"
        return [not_assessed(check, clause, quantity, reason, source=SPEEDS)]
    nearest, mode, order = min(found, key=lambda item: abs(item[0] - given.speed))
    fast = [f"{3.6 * speed:.0f} (f{j} d/{i})" for speed, j, i in found if speed >= LOWEST_SPEED]
    note = f"f{mode} d/{order} with d = {distance:.4g} m {whose}; the run has {3.6 * given.speed:.4g} km/h"
    if fast:
        note += f"; from 144 km/h on: {', '.join(fast)} km/h"
    return [Verdict(check, clause, quantity, REPORTED, nearest, None, "m/s", source=SPEEDS, note=note)]


def _regular_distance(given: Given) -> tuple[float, str] | None:
    """Distance [m] of equal vehicles, if most of at least three have the same, else that of the axles; and whose it is."""
    if given.assessment.coach_length is not None:
        return given.assessment.coach_length, "as given"
    if given.crossing is None or len(given.crossing.runs) > 1:
        return None
    steps = np.diff([item.behind for item in given.crossing.placements]).round(3)
    if len(steps) > 1:
        values, counts = np.unique(steps, return_counts=True)
        most = int(np.argmax(counts))
        if 2 * counts[most] > len(steps) and values[most] > 0.0:
            return float(values[most]), "from vehicle to vehicle"
    if not np.all(np.isfinite(given.static_forces)):
        return None
    found = given.at_rest.get(
        "regular distance", lambda: regular_distance(given.static_forces, wheels_behind(given))
    )
    return None if found is None else (found, "at which the axles add up most")


def damping(given: Given) -> list[Verdict]:
    """The model's damping of its first vertical mode against the lower bound by type and span."""
    check, clause = "damping", "EN 1991-2 table 6.6"
    quantity = "damping ratio of the first vertical mode"
    kind, facts = given.assessment.bridge_type, given.facts
    if kind is None:
        reason = "the type of the bridge is not known: give bridge_type"
        return [not_assessed(check, clause, quantity, reason, source=DAMPING_SOURCE)]
    if not facts.spans or facts.damping_ratio is None:
        reason = facts.missing or "the model's damping is not known"
        return [not_assessed(check, clause, quantity, reason, source=DAMPING_SOURCE)]
    forces = bool(np.all(given.moving_forces))
    # Which span counts is not said for several: the one that allows least.
    bound, span = min((_allowed(kind, span, forces), span) for span in facts.spans)
    source, note = DAMPING_SOURCE, f"{kind}, span {span:.4g} m"
    added = added_damping(span) if forces else 0.0
    if added > 0.0:
        source = f"{source}; {ADDED_SOURCE}"
        note += f"; {100.0 * added:.2g} % added for moving forces"
    excess = limit_of("damping_excess", given.assessment).value or 1.0
    verdict = judged(
        check,
        clause,
        quantity,
        round(facts.damping_ratio, _DIGITS),
        round(bound * excess, _DIGITS),
        "",
        source=source,
        note=f"no more than the lower bound may be taken; {note}",
    )
    return [verdict]


def _allowed(kind: str, span: float, forces: bool) -> float:
    """Lower bound of the damping ratio [-] of a span [m], with what is added for moving forces."""
    return structural_damping(kind, span) + (added_damping(span) if forces else 0.0)
