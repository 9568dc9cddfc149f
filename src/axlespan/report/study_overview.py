"""All scenarios of a study at once: maps of trains and speeds, distributions, and the table."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.report.pack import Pack
from axlespan.report.study_quantities import KMH, label, numbers_of
from axlespan.report.study_store import StoredStudy
from axlespan.report.units import plain

# Rows of a map, scenarios and columns of a table.
_ROWS, _CELLS, _COLUMNS = 60, 100_000, 24


def speed_maps(study: StoredStudy, pack: Pack, quantities: list[str]) -> dict[str, Any] | None:
    """Tables of the worst by train (or what else varies) and speed."""
    answers = study.answers
    if not quantities:
        return None
    use = answers.completed
    speeds = np.unique(np.round(KMH * numbers_of(study, "speed_m_per_s")[use], 6))
    rows, what = _row_labels(study)
    if len(speeds) < 2 or len(speeds) > 400 or not 2 <= len(set(rows[use].tolist())) <= _ROWS:
        return None
    names = list(dict.fromkeys(rows[use].tolist()))
    i = np.array([names.index(name) for name in rows[use].tolist()])
    j = np.searchsorted(speeds, np.round(KMH * numbers_of(study, "speed_m_per_s")[use], 6))
    ids = np.asarray(answers.columns["id"])[use]
    found = []
    for quantity in quantities:
        words, unit, factor = label(quantity)
        values = factor * numbers_of(study, quantity)[use]
        lowest = quantity.endswith(("contact_force_min_N", "displacement_min_m"))
        order = np.argsort(np.where(np.isfinite(values), values, np.inf if not lowest else -np.inf))
        order = order[::-1] if lowest else order  # the worst comes last and stays
        order = order[np.isfinite(values[order])]
        table, which = np.full((len(names), len(speeds)), np.nan), np.full((len(names), len(speeds)), -1)
        table[i[order], j[order]], which[i[order], j[order]] = values[order], ids[order]
        found.append({"title": words, "unit": unit, "a": pack.add(table), "ids": pack.add(which, "i4")})
    return {"rows": [str(name) for name in names], "label": what, "x": pack.add(speeds, "f8"), "maps": found}


def _row_labels(study: StoredStudy) -> tuple[npt.NDArray[Any], str]:
    """What the rows of a map are: trains, or another path of few values."""
    answers = study.answers
    if len(answers.trains) > 1:
        return np.asarray(answers.columns["train_name"], dtype=object), "train"
    for path in study.store.header.paths:
        if path in answers.columns and path not in ("crossing.speed", "train"):
            values = answers.columns[path]
            shown = [plain(float(v)) if isinstance(v, (int, float)) else str(v) for v in values.tolist()]
            if 2 <= len(set(shown)) <= _ROWS:
                return np.array(shown, dtype=object), path.replace(".", " › ").replace("_", " ")
    return np.asarray(answers.columns["train_name"], dtype=object), "train"


def exceedance_plots(study: StoredStudy, pack: Pack, quantities: list[str]) -> list[dict[str, Any]]:
    """Share of scenarios above each value, of studies that are no grid of speeds."""
    answers = study.answers
    speeds = np.unique(numbers_of(study, "speed_m_per_s")) if quantities else np.zeros(0)
    done = int(answers.completed.sum()) if quantities else 0
    if done < 20 or (len(speeds) < 0.5 * done and len(speeds) > 1):
        return []
    found = []
    for quantity in quantities:
        words, unit, factor = label(quantity)
        values = np.sort(factor * numbers_of(study, quantity)[answers.completed])
        values = values[np.isfinite(values)]
        if len(values) < 20:
            continue
        share = 100.0 * (1.0 - (np.arange(len(values)) + 0.5) / len(values))
        keep = np.unique(np.linspace(0, len(values) - 1, 1500).round().astype(int))
        series = [{"name": f"{len(values)} scenarios", "a": pack.add(share[keep]), "on": True}]
        found.append({"key": f"above-{quantity.replace('.', '-')}", "title": f"Scenarios above: {words.lower()}", "unit": "%",
                      "xLabel": f"{words} [{unit}]", "x": pack.add(values[keep], "f8"), "series": series})  # fmt: skip
    return found


def scenario_table(study: StoredStudy, pack: Pack, quantities: list[str]) -> dict[str, Any]:
    """Columns of all scenarios: numbers as arrays, texts as numbers of a list."""
    answers = study.answers
    n = len(answers.columns["id"])
    step = max(1, -(-n // _CELLS))
    columns: list[dict[str, Any]] = [{"name": "scenario", "a": pack.add(answers.columns["id"][::step], "i4")}]
    columns += [
        _column(pack, path.replace(".", " › ").replace("_", " "), answers.columns[path][::step])
        for path in study.store.header.paths
        if path in answers.columns and path not in ("crossing.speed", "train")
    ]
    columns.append(_column(pack, "train", answers.columns["train_name"][::step]))
    speed = KMH * numbers_of(study, "speed_m_per_s")[::step]
    columns.append({"name": "speed [km/h]", "a": pack.add(speed)})
    for quantity in quantities:
        words, unit, factor = label(quantity)
        columns.append(
            {"name": f"{words} [{unit}]", "a": pack.add(factor * numbers_of(study, quantity)[::step])}
        )
    columns += [
        _column(pack, name, answers.columns[name][::step])
        for name in ("verdict", "outcome", "reason")
        if name in answers.columns and any(answers.columns[name].tolist())
    ]
    note = f"Every {step}th of {n} scenarios is in this table; table/*.parquet has all." if step > 1 else ""
    return {"columns": columns[:_COLUMNS], "n": -(-n // step), "note": note}


def _column(pack: Pack, name: str, values: npt.NDArray[Any]) -> dict[str, Any]:
    many = values.tolist()
    if many and all(isinstance(value, (int, float)) and not isinstance(value, bool) for value in many):
        return {"name": name, "a": pack.add(np.asarray(values, dtype=np.float64))}
    texts = ["" if value is None else str(value)[:300] for value in many]
    known: dict[str, int] = {}
    numbers = [known.setdefault(text, len(known)) for text in texts]
    return {"name": name, "a": pack.add(np.array(numbers), "i4"), "texts": list(known)}
