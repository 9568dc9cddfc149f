"""Quantities of a study: which are shown, their worst over speed, and how they are called."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.report.pack import Pack
from axlespan.report.study_store import StoredStudy
from axlespan.report.units import plain
from axlespan.study.sweep.answers import label_of

FloatArray = npt.NDArray[np.float64]

KMH = 3.6

#: Curves of a plot.
TRAINS = 24

_QUANTITIES = 12


def quantities_of(study: StoredStudy) -> list[str]:
    """What the plots show: quantities that vary, and how far limits are used."""
    answers = study.answers
    if not len(answers.columns["id"]) or not answers.completed.any():
        return []
    found = [name for name in answers.quantities if np.ptp(answers.distribution(name).values) > 0.0]
    used = [name for name in answers.columns if name.startswith("utilization.")]
    most = {
        name: float(np.nanmax(numbers_of(study, name)[answers.completed], initial=-np.inf)) for name in used
    }
    ranked = sorted((name for name in used if np.isfinite(most[name])), key=lambda name: -most[name])[:5]
    rest = (found or answers.quantities)[: _QUANTITIES - len(ranked)]
    return [*rest[:1], *ranked[:2], *rest[1:], *ranked[2:]]


def numbers_of(study: StoredStudy, name: str) -> FloatArray:
    """A column of the table as numbers (n_row,)."""
    return np.asarray(study.answers.columns[name], dtype=np.float64)


def label(quantity: str) -> tuple[str, str, float]:
    """Name of a quantity in words, its unit there, and the factor from the column to it."""
    if quantity.startswith("utilization."):
        return (
            f"Used share of the limit: {quantity.removeprefix('utilization.').replace('_', ' ')}",
            "%",
            100.0,
        )
    words, unit, factor = label_of(quantity)
    return words[:1].upper() + words[1:], unit, factor


def envelope_plot(study: StoredStudy, pack: Pack, quantity: str) -> dict[str, Any] | None:
    """The worst at each speed, for each train."""
    answers = study.answers
    found = {train: answers.envelope(quantity, train) for train in answers.trains}
    found = {train: e for train, e in found.items() if len(e.speed)}
    if not found or max(len(e.speed) for e in found.values()) < 2:
        return None
    words, unit, factor = label(quantity)
    sign = 1.0 if next(iter(found.values())).lowest else -1.0
    ranked = sorted(found, key=lambda train: sign * float(found[train].value[found[train].worst]))
    drawn = [train for train in found if train in ranked[:TRAINS]]  # in the same order and colors everywhere
    series = [
        {
            "name": train,
            "x": pack.add(KMH * found[train].speed, "f8"),
            "a": pack.add(factor * found[train].value),
            "ids": pack.add(found[train].id, "i4"),
            "on": train in ranked[:6],
            "paint": answers.trains.index(train),
        }
        for train in drawn
    ]
    marks = _resonances(study, ranked[0])
    notes = [
        f"{TRAINS} of {len(ranked)} trains are drawn, those with the largest values."
        if len(ranked) > TRAINS
        else "",
        f"Dashed upright: resonance speeds of {ranked[0]}: {'; '.join(m['words'] for m in marks)}."
        if marks
        else "",
        "Dashed across: the limit." if unit == "%" and quantity.startswith("utilization.") else "",
    ]
    return {
        "key": quantity.replace(".", "-"),
        "title": words,
        "unit": unit,
        "series": series,
        "levels": [100.0] if quantity.startswith("utilization.") else [],
        "marks": [mark["speed"] for mark in marks],
        "note": " ".join(note for note in notes if note),
    }


def _resonances(study: StoredStudy, train: str) -> list[dict[str, Any]]:
    """Resonance speeds of a train within the study, v = f d / i [km/h]."""
    known = study.resonances.get(train)
    speeds = KMH * numbers_of(study, "speed_m_per_s")[study.answers.completed]
    if not known or not len(speeds):
        return []
    found: list[dict[str, Any]] = []
    for order, values in known.get("speeds_m_per_s_by_order", {}).items():
        for mode, value in enumerate(values, 1):
            speed = KMH * value
            if speeds.min() <= speed <= speeds.max():
                found.append({"speed": speed, "words": f"{plain(speed)} km/h (f{mode} d/{order})"})
    return sorted(found, key=lambda mark: float(mark["speed"]))[:12]
