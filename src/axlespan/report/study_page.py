"""The page of a study: envelopes over speed, maps of trains and speeds, a table to sort, histories to open."""

from __future__ import annotations

import json
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from axlespan.report.assembly import assembled
from axlespan.report.pack import Pack
from axlespan.report.study_overview import exceedance_plots, scenario_table, speed_maps
from axlespan.report.study_quantities import KMH, TRAINS, envelope_plot, label, quantities_of
from axlespan.report.study_store import StoredStudy, histories, open_study
from axlespan.report.tables import badge, bar
from axlespan.report.units import number, plain
from axlespan.report.words import shortened

_VERDICTS = {"fail": ("bad", "✗", "limits are exceeded"), "pass": ("good", "✓", "all limits are kept")}


def study_page(folder: Path) -> tuple[str, list[str]]:
    """The page of a study as text, and what the study lacks.

    Raises
    ------
    InputError
        If the store is damaged or of a later version.
    """
    study = open_study(folder, _summary(folder))
    pack = Pack()
    answers = study.answers
    quantities = quantities_of(study)
    envelopes = [envelope_plot(study, pack, name) for name in quantities]
    content: dict[str, Any] = {
        "title": answers.title or folder.resolve().name,
        "envelopes": [found for found in envelopes if found is not None],
        "maps": speed_maps(study, pack, quantities),
        "exceedance": exceedance_plots(study, pack, quantities),
        "table": scenario_table(study, pack, quantities),
        "histories": {},
    }
    content["histories"] = histories(study, pack, _interesting(study, quantities))
    content["arrays"] = pack.directory()
    values = {
        "title": shortened(content["title"]),
        "version": escape(study.store.header.version),
        "badge": _badge(study),
        "notices": _notices(study),
        "words": _words(study),
        "cards": _cards(study, quantities),
        "checks": _checks(study),
    }
    scripts = ("inflate", "data", "export", "plots", "maps", "scenarios", "chrome", "study")
    return assembled("study", values, content, pack, scripts), study.notices


def _summary(folder: Path) -> dict[str, Any]:
    try:
        found = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}


# --- words -----------------------------------------------------------------------------------------


def _badge(study: StoredStudy) -> str:
    answers = study.answers
    if len(answers.columns["id"]) < answers.scenarios:
        return '<span class="badge warn"><span aria-hidden="true">!</span> not complete</span>'
    if answers.verdict in _VERDICTS:
        kind, sign, words = _VERDICTS[answers.verdict]
        return f'<span class="badge {kind}"><span aria-hidden="true">{sign}</span> {words}</span>'
    return (
        badge("attention")
        if answers.failed
        else '<span class="badge good"><span aria-hidden="true">✓</span> completed</span>'
    )


def _notices(study: StoredStudy) -> str:
    items = "".join(f"<li>{escape(text)}</li>" for text in study.notices)
    return f'<aside class="notices" aria-label="Notices"><ul>{items}</ul></aside>' if items else ""


def _words(study: StoredStudy) -> str:
    answers, header = study.answers, study.store.header
    done = int(answers.completed.sum()) if len(answers.columns["id"]) else 0
    varied = ", ".join(path.replace(".", " › ").replace("_", " ") for path in header.paths)
    text = [
        f"{done} of {answers.scenarios} scenarios around one case are completed; what varies: {varied or 'nothing'}."
    ]
    if done:
        speeds = np.asarray(answers.columns["speed_m_per_s"], dtype=float)[answers.completed]
        low, high = KMH * float(np.nanmin(speeds)), KMH * float(np.nanmax(speeds))
        trains = answers.trains
        names = ", ".join(trains[:8]) + (f" and {len(trains) - 8} more" if len(trains) > 8 else "")
        run = f"at {plain(low)} km/h" if low == high else f"from {plain(low)} to {plain(high)} km/h"
        text.append(f"Trains ({len(trains)}): {names}; {run}.")
    return "".join(f"<p>{escape(line)}</p>" for line in text)


def _cards(study: StoredStudy, quantities: list[str]) -> str:
    found = []
    for name in [name for name in quantities if not name.startswith("sensor.")][:6] or quantities[:6]:
        envelope = study.answers.envelope(name)
        if not len(envelope.value):
            continue
        words, unit, factor = label(name)
        worst = envelope.worst
        row = int(np.flatnonzero(study.answers.columns["id"] == envelope.id[worst])[0])
        where = (
            f"{study.answers.columns['train_name'][row]}, {plain(KMH * float(envelope.speed[worst]))} km/h"
        )
        found.append(
            f'<div class="card"><div class="what">{escape(words)}</div><div class="value">'
            f'{number(factor * float(envelope.value[worst]))} {escape(unit)}</div><div class="where">{escape(where)}</div></div>'
        )
    return "".join(found)


def _checks(study: StoredStudy) -> str:
    """How often each check passes and how far its limit is used at most."""
    rows = []
    for check, about in study.answers.checks().items():
        outcomes = about["outcomes"]
        words = ", ".join(f"{count} {word}" for word, count in outcomes.items())
        where = f"{about['train']}, {plain(KMH * about['speed_m_per_s'])} km/h" if "train" in about else ""
        rows.append(
            f"<tr><td>{escape(check.replace('_', ' '))}</td><td>{bar(about.get('utilization'))}</td><td>{escape(where)}</td>"
            f"<td>{escape(words)}</td><td>{badge('fail' if outcomes.get('fail') else 'pass')}</td></tr>"
        )
    if not rows:
        done = len(study.answers.columns["id"])
        return f"<p>No {'limits of standards were checked in this study' if done else 'scenario is done yet'}.</p>"
    heads = "".join(
        f'<th scope="col">{h}</th>' for h in ("Check", "Used at most", "By", "Scenarios", "Verdict")
    )
    return (
        '<div class="scroll" tabindex="0" role="region" aria-label="Verdicts"><table>'
        "<caption>Verdicts over all scenarios</caption>"
        f"<thead><tr>{heads}</tr></thead><tbody>{''.join(rows)}</tbody></table></div>"
    )


def _interesting(study: StoredStudy, quantities: list[str]) -> list[int]:
    """Scenarios whose histories come first: the worst of each train, then those of the envelopes."""
    answers = study.answers
    first: list[int] = []
    rest: list[int] = []
    for quantity in quantities:
        for train in answers.trains[:TRAINS]:
            envelope = answers.envelope(quantity, train)
            if len(envelope.id):
                first.append(int(envelope.id[envelope.worst]))
                rest += envelope.id.tolist()
    every = np.asarray(answers.columns["id"]).tolist()
    return [*first, *_spread(rest), *_spread(every)]


def _spread(ids: list[int]) -> list[int]:
    """Some of many, evenly."""
    return ids[:: max(1, len(ids) // 60)]
