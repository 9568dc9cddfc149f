"""What the page of a study needs from its store: answers, columns and some histories."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import numpy.typing as npt

from axlespan.report.pack import Pack
from axlespan.report.thinning import rows_for
from axlespan.report.units import shown_unit
from axlespan.study.sweep.answers import Answers
from axlespan.study.sweep.store import Store

FloatArray = npt.NDArray[np.float64]

# Values of histories that a page carries, scenarios of which it does, and curves of one of them.
_VALUES, _SCENARIOS, _CURVES = 400_000, 60, 8


@dataclass(eq=False)
class StoredStudy:
    """A store and its answers; ``notices`` tell what is missing."""

    folder: Path
    store: Store
    answers: Answers
    resonances: Mapping[str, Any]  # by train, as summary.json has them
    notices: list[str]


def open_study(folder: Path, summary: Mapping[str, Any]) -> StoredStudy:
    """A study as far as it is done.

    Raises
    ------
    InputError
        If it is damaged or of a later version.
    """
    store = Store.open(folder)
    answers = Answers.of_store(store)
    rows = len(answers.columns["id"])
    notices = []
    if rows < answers.scenarios:
        notices.append(
            f"{rows} of {answers.scenarios} scenarios are done: the study is still running, or was stopped. "
            "This page shows what there is; axlespan sweep --resume computes the rest."
        )
    if answers.failed:
        reasons = dict.fromkeys(map(str, answers.columns["reason"][~answers.completed].tolist()))
        notices.append(f"{answers.failed} scenarios failed: {'; '.join(list(reasons)[:3])}")
    return StoredStudy(folder, store, answers, summary.get("resonances") or {}, notices)


def histories(study: StoredStudy, pack: Pack, wanted: Iterable[int]) -> dict[str, Any]:
    """Histories of some scenarios by id, as far as they are stored and fit on the page."""
    if "histories" not in study.store.header.columns:
        return {}
    columns = study.store.arrays(["id", "histories"])
    shard = dict(zip(columns["id"].tolist(), columns["histories"].tolist(), strict=True))
    found: dict[str, Any] = {}
    spent = 0
    for scenario in list(dict.fromkeys(wanted)):
        name = shard.get(scenario)
        if not name or len(found) >= _SCENARIOS or spent > _VALUES:
            continue
        try:
            plots, values = _of_scenario(study.folder / "histories" / str(name), pack, scenario)
        except (OSError, KeyError, ValueError, IndexError) as error:
            study.notices.append(f"Histories of scenario {scenario} cannot be read: {error}")
            continue
        found[str(scenario)] = plots
        spent += values
    return found


def _of_scenario(path: Path, pack: Pack, scenario: int) -> tuple[list[dict[str, Any]], int]:
    plots, spent = [], 0
    with h5py.File(path, "r") as file:
        place = int(np.flatnonzero(file["scenario"][...] == scenario)[0])
        time = np.asarray(file["time"][...], dtype=np.float64)
        for name, data in file.items():
            if data.ndim != 3:
                continue
            table = np.asarray(data[place], dtype=np.float64)
            there = np.flatnonzero(np.isfinite(table).any(axis=0))[:_CURVES]
            rows = np.flatnonzero(np.isfinite(table[:, there]).any(axis=1)) if len(there) else np.empty(0)
            if len(rows) < 2:
                continue
            table, now = table[: rows[-1] + 1, there], time[: rows[-1] + 1]
            kept = rows_for(len(now), range(len(there)), partial(_column, table))
            kept = kept[:: max(1, len(kept) // 4000)]
            factor, unit = shown_unit(str(data.attrs.get("units", "")))
            names = file[_dimension(name)].asstr()[...].tolist()
            series = [
                {"name": names[c], "a": pack.add(factor * table[kept, k])}
                for k, c in enumerate(there.tolist())
            ]
            plots.append(
                {
                    "key": name,
                    "title": name.replace("_", " ").capitalize(),
                    "unit": unit,
                    "x": pack.add(now[kept], "f8"),
                    "series": series,
                }
            )
            spent += len(kept) * (len(series) + 2)
    return plots, spent


def _column(table: FloatArray, index: int) -> FloatArray:
    return np.asarray(table[:, index])


def _dimension(variable: str) -> str:
    return {"vehicle": "vehicle_dof"}.get(variable.partition("_")[0], variable.partition("_")[0])
