"""The summary of a run: what was run, its peaks, and what its self-checks say; ready for summary.json.

Names are stable and carry their units. Values that a run does not have are null or left out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

import axlespan
from axlespan.interaction.crossing import Crossing, Run
from axlespan.interaction.result import Result
from axlespan.io.dof_units import is_rotation, unit_of
from axlespan.io.force_extremes import force_extremes
from axlespan.io.peaks import clean, highest, lowest, time_of
from axlespan.io.strict_json import json_ready, to_json
from axlespan.io.summary_text import print_summary, summary_lines
from axlespan.io.summary_verdicts import assessed
from axlespan.io.verdicts import verdicts as self_checks

__all__ = ["FORMAT_VERSION", "print_summary", "summary", "summary_lines", "write_summary"]

#: Version of the layout of summary.json.
FORMAT_VERSION = 1

# Tension episodes and kinds of vehicle d.o.f. that are listed; result.nc has them all.
_EPISODES, _PARTS = 20, 60

_COMPUTATION = {
    "coupling": "coupling",
    "solver": "solver",
    "threads": "threads",
    "structure_dofs": "structure_dofs",
    "vehicle_dofs": "vehicle_dofs",
    "path_dofs": "path_dofs",
    "factor_bytes": "factor_bytes",
    "iterations": "iterations",
    "factorizations": "factorizations",
    "contact_laws": "contact_laws",
    "newton_iterations": "newton_iterations",
    "newton_iterations_largest": "newton_iterations_largest",
    "cut_steps": "cut_steps",
    "smallest_time_step": "smallest_time_step_s",
    "nonlinear_springs": "nonlinear_springs",
    "nonlinear_springs_active": "nonlinear_springs_active",
    "wall_time": "wall_time_s",
}


def summary(
    result: Result,
    crossing: Crossing | None = None,
    *,
    title: str = "",
    version: str | None = None,
    files: Sequence[str | PathLike[str]] = (),
    verdicts: Sequence[Mapping[str, Any]] = (),
) -> dict[str, Any]:
    """The summary of a result, of a failed run's partial result too.

    Parameters
    ----------
    result : Result
    crossing : Crossing, optional
        What was run; a result knows no more than names and numbers.
    title : str, optional
    version : str, optional
        Of axlespan; this one when left out.
    files : sequence of path, optional
        Files written.
    verdicts : sequence of mapping, optional
        Verdicts by the rules of codes, as :mod:`axlespan.standards` gives them.

    Returns
    -------
    dict
        Strict JSON: no NaN, no tuples. Names carry their units.
    """
    checks = self_checks(result.checks if len(result.time) > 1 else {})  # nothing is checked before a step
    good = result.outcome.code == "completed" and all(check["verdict"] == "pass" for check in checks)
    content = {
        "format": "axlespan summary",
        "format_version": FORMAT_VERSION,
        "version": version or axlespan.__version__,
        "outcome": asdict(result.outcome),
        "verdict": "pass" if good else "attention",
        "run": {"title": title, **_what(crossing, _last_time(result)), **_run(result)},
        "computation": _computation(result),
        "sensors": _sensors(result),
        "contact_forces": force_extremes(result, _ends(crossing)),
        "tension": _tension(result),
        "flights": _flights(result),
        "vehicle_accelerations": _vehicle_accelerations(result),
        "support_reactions": _reactions(result),
        "checks": checks,
        "assessment": assessed(verdicts),
        "verdicts": [dict(verdict) for verdict in verdicts],
        "notes": list(result.facts.get("notes") or ()),
        "files": [str(file) for file in files],
    }
    ready: dict[str, Any] = json_ready(content)
    return ready


def write_summary(content: Mapping[str, Any], path: str | PathLike[str]) -> Path:
    """Write a summary as JSON, whole or not at all.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    place = Path(path)
    part = place.with_name(f".{place.name}.part")
    try:
        part.write_text(to_json(content, indent=2) + "\n", encoding="utf-8")
        part.replace(place)
    finally:
        part.unlink(missing_ok=True)
    return place


def _last_time(result: Result) -> float:
    return float(result.time[-1]) if len(result.time) else 0.0


def _what(crossing: Crossing | None, end: float) -> dict[str, Any]:
    names = (
        "structure",
        "structure_from_m",
        "structure_to_m",
        "train",
        "vehicles",
        "speed_start_m_per_s",
        "speed_end_m_per_s",
        "other_trains",
    )
    if crossing is None:
        return dict.fromkeys(names)
    first, *others = [_moving(run, end) for run in crossing.runs]
    own = [value for name, value in first.items() if name != "wheels"]
    values = (crossing.structure.name, *(_ends(crossing) or (None, None)), *own, others)
    return dict(zip(names, values, strict=True))


def _moving(run: Run, end: float) -> dict[str, Any]:
    """A train and its speeds at the beginning and the end."""
    speeds = np.abs(run.course.velocity(np.array([0.0, end]))).tolist()
    return {
        "train": run.train.name,
        "vehicles": len(run.train.placements),
        "wheels": len(run.lines),
        "speed_start_m_per_s": speeds[0],
        "speed_end_m_per_s": speeds[1],
    }


def _ends(crossing: Crossing | None) -> tuple[float, float] | None:
    """Where the first running line begins and ends [m]."""
    if crossing is None:
        return None
    path = next(iter(crossing.structure.lines.values()))
    return float(path.start), float(path.stop)


def _run(result: Result) -> dict[str, Any]:
    facts = result.facts
    return {
        "contacts": len(result.contact),
        "time_step_s": facts.get("time_step"),
        "steps": facts.get("steps"),
        "completed_steps": facts.get("completed_steps"),
        "simulated_s": time_of(result, -1) if len(result.time) else 0.0,
        "kept_times": len(result.time),
        "alpha": facts.get("alpha"),
        "beta": facts.get("beta"),
        "gamma": facts.get("gamma"),
        "footprint_m": facts.get("footprint"),
    }


def _computation(result: Result) -> dict[str, Any]:
    facts = result.facts
    known = {name: facts[key] for key, name in _COMPUTATION.items() if key in facts}
    wall, steps = facts.get("wall_time"), facts.get("completed_steps")
    known["steps_per_s"] = steps / wall if wall and steps else None
    return known


def _sensors(result: Result) -> dict[str, dict[str, Any]]:
    return {
        name: {
            **_extremes(result, result.sensor_displacement, i, "displacement", "m"),
            **_extremes(result, result.sensor_acceleration, i, "acceleration", "m_per_s2"),
        }
        for i, name in enumerate(result.sensor)
    }


def _extremes(result: Result, table: np.ndarray, column: int, quantity: str, unit: str) -> dict[str, Any]:
    top, bottom = highest(table, [column]), lowest(table, [column])
    if top is None or bottom is None:
        return {}
    return {
        f"{quantity}_min_{unit}": bottom.value,
        f"{quantity}_min_time_s": time_of(result, bottom.row),
        f"{quantity}_max_{unit}": top.value,
        f"{quantity}_max_time_s": time_of(result, top.row),
    }


def _tension(result: Result) -> dict[str, Any]:
    episodes = list(result.checks.get("tension") or ())
    shown = [
        {
            "contact": episode["contact"],
            "start_s": clean(episode["start"]),
            "stop_s": clean(episode["stop"]),
            "position_m": episode["position"],
            "largest_tension_N": episode["size"],
        }
        for episode in sorted(episodes, key=lambda episode: float(episode["start"]))[:_EPISODES]
    ]
    return {"episodes": int(result.checks.get("tension_episodes") or 0), "first": shown}


def _flights(result: Result) -> dict[str, Any] | None:
    """Wheels in the air: the longest flights; null where no wheel can leave the line."""
    count = result.checks.get("flight_count")
    if count is None:
        return None
    flights = sorted(result.checks["flights"], key=lambda flight: flight["start"] - flight["stop"])
    shown = [
        {
            "contact": flight["contact"],
            "start_s": clean(flight["start"]),
            "stop_s": clean(flight["stop"]),
            "start_position_m": flight["start_position"],
            "stop_position_m": flight["stop_position"],
            "largest_gap_m": flight["gap"],
            "closing_speed_m_per_s": flight["closing_speed"] if flight["landed"] else None,
        }
        for flight in flights[:_EPISODES]
    ]
    return {
        "count": int(count),
        "landing_loss_J": result.facts.get("landing_loss"),
        "longest": shown,
    }


def _vehicle_accelerations(result: Result) -> dict[str, dict[str, Any]]:
    """Extremes of each part, such as body.z, over all vehicles.

    Wheels are left out: the acceleration of one without mass means nothing.
    """
    groups: dict[str, list[int]] = {}
    for i, name in enumerate(result.vehicle_dof):
        part = name.partition(".")[2]
        if not part.startswith("wheel"):
            groups.setdefault(part, []).append(i)
    found = {}
    for part in list(groups)[:_PARTS]:
        top, bottom = (find(result.vehicle_acceleration, groups[part]) for find in (highest, lowest))
        if top is None or bottom is None:
            continue
        found[part] = {
            "unit": unit_of("acceleration", part),
            "min": bottom.value,
            "min_vehicle": result.vehicle_dof[bottom.column].partition(".")[0],
            "min_time_s": time_of(result, bottom.row),
            "max": top.value,
            "max_vehicle": result.vehicle_dof[top.column].partition(".")[0],
            "max_time_s": time_of(result, top.row),
        }
    return found


def _reactions(result: Result) -> dict[str, dict[str, Any]]:
    found = {}
    for i, name in enumerate(result.support):
        top, bottom = highest(result.support_reaction, [i]), lowest(result.support_reaction, [i])
        if top is None or bottom is None:
            continue
        unit = "N_m" if is_rotation(name) else "N"
        found[name] = {
            f"min_{unit}": bottom.value,
            "min_time_s": time_of(result, bottom.row),
            f"max_{unit}": top.value,
            "max_time_s": time_of(result, top.row),
        }
    return found
