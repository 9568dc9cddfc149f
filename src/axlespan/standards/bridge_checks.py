"""Checks of deflections against load model 71: its own, and the dynamic effects of the train."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.linalg.factor import NotPositiveDefinite
from axlespan.standards import dynamic_factors, lm71
from axlespan.standards.given import Given
from axlespan.standards.influence import deflection_lines
from axlespan.standards.limits import limit_of
from axlespan.standards.verdict import Verdict, judged, not_assessed

FloatArray = npt.NDArray[np.float64]

_NO_EFFECTS = "the static deflections cannot be computed"


@dataclass(frozen=True, eq=False)
class SpanEffects:
    """Static deflections at the middle of a span, positive downward."""

    middle: float  # [m]
    span: float  # [m]
    lm71: float  # LM71, for continuous beams SW/0 too, with α and without dynamic factor [m]
    train: float  # of the run's train [m]


def span_effects(given: Given) -> list[SpanEffects]:
    """Static deflections of each span under load model 71 and under the train of the run.

    Raises
    ------
    InputError, NotPositiveDefinite
        If the structure cannot be solved.
    """
    if given.crossing is None or len(given.crossing.runs) > 1 or not given.facts.spans:
        return []
    starts, spans = np.array(given.facts.starts), np.array(given.facts.spans)
    lines = deflection_lines(given.crossing.structure, starts + 0.5 * spans)
    behind = wheels_behind(given)
    alpha, found = given.assessment.alpha, []
    for line, start, span in zip(lines, starts, spans, strict=True):
        model = lm71.lm71_effect(line, sign=-1.0, alpha=alpha)
        if given.facts.continuous:
            model = max(model, lm71.sw0_effect(line, sign=-1.0, alpha=alpha))
        train = lm71.train_effect(line, given.static_forces, behind, sign=-1.0)
        found.append(SpanEffects(float(start + 0.5 * span), float(span), model, train))
    return found


def lm71_deflection(given: Given, effects: Sequence[SpanEffects]) -> list[Verdict]:
    """Deflection under load model 71 with its dynamic factor, against L/600."""
    check, clause = "lm71_deflection", "EN 1990 A2.4.4.2.3"
    quantity = "vertical deflection under Φ × LM71"
    reason = not_possible(given) or ("" if effects else _NO_EFFECTS)
    if reason:
        return [not_assessed(check, clause, quantity, reason, source=lm71.SOURCE)]
    limit = limit_of("deflection_ratio", given.assessment)
    assert limit.value is not None
    factor, name = static_factor(given)
    worst = max(effects, key=lambda effect: effect.lm71 / effect.span)
    value = factor * worst.lm71
    ratio = worst.span / value if value > 0.0 else float("inf")
    return [
        judged(
            check,
            clause,
            quantity,
            value,
            worst.span / limit.value,
            "m",
            where=f"{worst.middle:.4g} m",
            source=f"{limit.source}; {lm71.SOURCE}",
            note=f"L/{ratio:.0f}, limit L/{limit.value:.0f}; {name} = {factor:.3f}, α = {given.assessment.alpha:g}",
        )
    ]


def dynamic_effect(given: Given, effects: Sequence[SpanEffects]) -> list[Verdict]:
    """(1 + φ'_dyn + φ''/2) times the static effect of the run's train over Φ × LM71, by midspan deflections."""
    check, clause = "dynamic_effect", "EN 1991-2 6.4.6.5"
    quantity = "(1 + φ'_dyn + φ''/2) × train over Φ × LM71, midspan deflections"
    reason = not_possible(given) or ("" if effects else _NO_EFFECTS)
    if not reason and not given.result.line_displacement.size:
        reason = "the deck was not recorded: write line: 41 under output"
    if not reason and not all(effect.train > 0.0 and effect.lm71 > 0.0 for effect in effects):
        reason = "a span does not deflect under the train or under load model 71"
    if reason:
        return [not_assessed(check, clause, quantity, reason, source=lm71.SOURCE)]
    moved, at = given.live_deflection, given.result.line_position
    factor, name = static_factor(given)
    n0, length = given.facts.first_frequency, given.facts.determinant_length
    assert n0 is not None and length is not None
    second, share_words = added_share(given)
    best: tuple[float, SpanEffects, float, int] | None = None
    for effect in effects:
        history = -_at_middle(moved, at, effect)
        row = int(np.argmax(history))
        first = float(history[row]) / effect.train - 1.0
        ratio = (1.0 + first + second) * effect.train / (factor * effect.lm71)
        if best is None or ratio > best[0]:
            best = (ratio, effect, first, row)
    assert best is not None
    ratio, effect, first, row = best
    limit = limit_of(check, given.assessment)
    theory = dynamic_factors.phi_dash(given.speed, length, n0)
    return [
        judged(
            check,
            clause,
            quantity.replace("φ''/2", share_words),
            ratio,
            limit.value,
            "",
            where=f"{effect.middle:.4g} m",
            when=float(given.result.time[row]),
            source=f"{limit.source}; {dynamic_factors.SOURCE}",
            note=f"φ'_dyn = {first:.3f} (φ' of annex C {theory:.3f}), {share_words} = {second:.3f}, "
            f"{name} = {factor:.3f}" + ("; the train governs, not LM71" if ratio > 1.0 else ""),
        )
    ]


def wheels_behind(given: Given) -> FloatArray:
    """Distance (n_contact,) of each wheel behind the foremost one [m], of one train."""
    assert given.crossing is not None
    items = given.crossing.placements
    behind = np.array([item.behind + point.behind for item in items for point in item.vehicle.contacts])
    backward = given.crossing.runs[0].course.direction < 0
    return np.asarray(behind.max() - behind) if backward else behind


def effects_of(given: Given) -> list[SpanEffects]:
    """Static effects; none where the structure cannot be solved."""

    def found() -> list[SpanEffects]:
        try:
            return span_effects(given)
        except (InputError, NotPositiveDefinite):
            return []

    return given.at_rest.get("effects on spans", found)


def added_share(given: Given) -> tuple[float, str]:
    """φ''/2 for carefully maintained track, else φ'' [-], and its name."""
    n0, length = given.facts.first_frequency, given.facts.determinant_length
    assert n0 is not None and length is not None
    second = dynamic_factors.phi_double_dash(given.speed, length, n0)
    return (0.5 * second, "φ''/2") if given.assessment.maintenance == "careful" else (second, "φ''")


def static_factor(given: Given) -> tuple[float, str]:
    """Φ2 for carefully maintained track, else Φ3 [-], and its name."""
    length = given.facts.determinant_length
    assert length is not None
    if given.assessment.maintenance == "careful":
        return dynamic_factors.phi2(length), "Φ2"
    return dynamic_factors.phi3(length), "Φ3"


def not_possible(given: Given) -> str:
    """Why static effects cannot be known; empty if they can."""
    if given.crossing is None:
        return "the structure is not known, only its result"
    if len(given.crossing.runs) > 1:
        return "several trains are under way: the static effect depends on where they meet"
    if not given.facts.spans:
        return given.facts.missing
    if given.facts.first_frequency is None or given.facts.determinant_length is None:
        return "the first frequency is not known: give first_frequency"
    if not np.all(np.isfinite(given.static_forces)):
        return "the static wheel forces are not known"
    return ""


def _at_middle(table: FloatArray, positions: FloatArray, effect: SpanEffects) -> FloatArray:
    """History in the middle of a span, by the polynomial through the nearest four recorded points of the span.

    A straight line between two points would cut the crest of the deflection off.
    """
    reach = 0.5 * effect.span * (1.0 + 1e-9)
    beside = np.abs(positions - effect.middle)
    near = np.argsort(beside, kind="stable")[:4]
    near = near[beside[near] <= reach]
    x = positions[near] - effect.middle
    if not len(near) or x.min() > 0.0 or x.max() < 0.0:  # the span is recorded in one half at most
        return np.array([np.interp(effect.middle, positions, row) for row in table])
    others = np.where(np.eye(len(x), dtype=bool), 1.0, -x)
    apart = np.where(np.eye(len(x), dtype=bool), 1.0, x[:, None] - x)
    return np.asarray(table[:, near] @ (others / apart).prod(axis=1))
