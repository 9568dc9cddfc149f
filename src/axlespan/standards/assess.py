"""From a result to verdicts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

from axlespan.interaction.crossing import Crossing
from axlespan.interaction.result import Result
from axlespan.standards import (
    analysis_checks,
    bridge_checks,
    deck_checks,
    moment_checks,
    ride_checks,
    wheel_checks,
)
from axlespan.standards.assessment import CHECKS, Assessment
from axlespan.standards.at_rest import AtRest
from axlespan.standards.bridge_facts import BridgeFacts, bridge_facts
from axlespan.standards.given import Given
from axlespan.standards.verdict import Verdict

Check = Callable[[Given], list[Verdict]]

_WITH_EFFECTS = MappingProxyType(
    {
        "lm71_deflection": bridge_checks.lm71_deflection,
        "dynamic_effect": bridge_checks.dynamic_effect,
    }
)
_CHECKS: Mapping[str, Check] = MappingProxyType(
    {
        "dynamic_analysis": analysis_checks.dynamic_analysis,
        "critical_speed": analysis_checks.critical_speed,
        "damping": analysis_checks.damping,
        "deck_acceleration": deck_checks.deck_acceleration,
        "deflection": deck_checks.deflection,
        "dynamic_moment": moment_checks.dynamic_moment,
        "end_rotation": deck_checks.end_rotation,
        "end_offset": deck_checks.end_offset,
        "twist": deck_checks.twist,
        "body_acceleration": ride_checks.body_acceleration,
        "wheel_unloading": wheel_checks.wheel_unloading,
        "contact_force": wheel_checks.contact_force,
        "loss_of_contact": wheel_checks.loss_of_contact,
        "derailment": wheel_checks.derailment,
        "continuous_comfort": ride_checks.continuous_comfort,
        "mean_comfort": ride_checks.mean_comfort,
        "weighted_rms": ride_checks.weighted_rms,
        "sperling": ride_checks.sperling,
    }
)


def assess(
    result: Result,
    crossing: Crossing | None,
    assessment: Assessment,
    *,
    facts: BridgeFacts | None = None,
    at_rest: AtRest | None = None,
) -> tuple[Verdict, ...]:
    """Assess a run by the rules.

    Parameters
    ----------
    result : Result
        With ``line_points`` recorded for what concerns the deck.
    crossing : Crossing, optional
        What was run; without it spans, frequencies and static effects are not known.
    assessment : Assessment
        Line, bridge, national values, and which checks.
    facts : BridgeFacts, optional
        Those of the bridge if they are known already, from :func:`bridge_facts`; they are the same for every
        train and speed.
    at_rest : AtRest, optional
        What earlier runs of this bridge, train and assessment found that is the same at every speed.

    Returns
    -------
    tuple of Verdict
        In the order of :data:`CHECKS`. A quantity that the run does not have is "not assessed", with the reason.

    Examples
    --------
    ``assess(result, crossing, Assessment(line_speed=300 / 3.6, deck="ballasted"))``
    """
    if facts is None:
        facts = BridgeFacts(missing="the structure is not known, only its result")
        if crossing is not None:
            facts = bridge_facts(crossing.structure, assessment)
    given = Given(result, assessment, facts, crossing, at_rest or AtRest())
    effects: list[bridge_checks.SpanEffects] = []
    if any(check in _WITH_EFFECTS for check in assessment.checks):
        effects = bridge_checks.effects_of(given)
    found: list[Verdict] = []
    for check in CHECKS:
        if check not in assessment.checks:
            continue
        if check in _WITH_EFFECTS:
            found += _WITH_EFFECTS[check](given, effects)
        else:
            found += _CHECKS[check](given)
    return tuple(found)
