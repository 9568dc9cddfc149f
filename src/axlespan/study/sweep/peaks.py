"""One row of the table of scenarios: what went in, how it ended, and the extremes over time and place."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from axlespan.interaction.plan import Plan
from axlespan.interaction.result import Result

FloatArray = npt.NDArray[np.float64]

COMPLETED, FAILED, INVALID = "completed", "failed", "invalid"

#: Columns that every table has, and their kinds, with units in their names.
COLUMNS: Final[Mapping[str, str]] = {
    "id": "int",
    "outcome": "text",
    "reason": "text",
    "train_name": "text",
    "speed_m_per_s": "number",
    "steps": "int",
    "passed": "flag",  # whether the last wheel had left the structure at the end
    "line_displacement_min_m": "number",
    "line_displacement_max_m": "number",
    "line_displacement_at_m": "number",
    "line_acceleration_max_m_per_s2": "number",
    "line_acceleration_at_m": "number",
    "contact_force_max_N": "number",
    "contact_force_min_N": "number",
    "unloading_max": "number",
    "tension_episodes": "int",
    "body_acceleration_max_m_per_s2": "number",
    "compatibility_residual": "number",
    "equilibrium_residual": "number",
    "energy_residual": "number",
    "verdict": "text",
    "seconds": "number",
    "version": "text",
    "provenance": "text",
}

#: Columns of each sensor: ``sensor.midspan.displacement_min_m``.
OF_SENSORS: Final = (
    "displacement_min_m",
    "displacement_max_m",
    "velocity_max_m_per_s",
    "acceleration_max_m_per_s2",
)

#: Columns that differ between two runs of the same scenario.
TIMING: Final = ("seconds",)


def peaks_of(result: Result, plan: Plan) -> dict[str, Any]:
    """Extremes of a completed result by the names of their columns."""
    row: dict[str, Any] = {"passed": has_passed(plan)}
    if result.sensor:
        u = result.sensor_displacement
        v, a = _largest(result.sensor_velocity), _largest(result.sensor_acceleration)
        table = np.array([u.min(axis=0), u.max(axis=0), v, a])
        for name, values in zip(result.sensor, table.T.tolist(), strict=True):
            row |= {f"sensor.{name}.{column}": v for column, v in zip(OF_SENSORS, values, strict=True)}
    return {**row, **_line(result), **_contacts(result), **_bodies(result)}


def _line(result: Result) -> dict[str, float]:
    if not len(result.line_position):
        return {}
    w = result.line_displacement
    low, high, hardest = w.min(axis=0), w.max(axis=0), _largest(result.line_acceleration)
    at, where = int(np.maximum(-low, high).argmax()), int(hardest.argmax())
    return {
        "line_displacement_min_m": float(low.min()),
        "line_displacement_max_m": float(high.max()),
        "line_displacement_at_m": float(result.line_position[at]),
        "line_acceleration_max_m_per_s2": float(hardest[where]),
        "line_acceleration_at_m": float(result.line_position[where]),
    }


def _largest(values: FloatArray) -> FloatArray:
    """Largest amounts (n, ...) over time, without a copy of the table."""
    return np.asarray(np.maximum(-values.min(axis=0), values.max(axis=0)))


def _contacts(result: Result) -> dict[str, Any]:
    checks = result.checks
    largest, smallest, static = (
        np.array(list(checks[name].values()))
        for name in ("largest_contact_force", "smallest_contact_force", "static_contact_force")
    )
    row: dict[str, Any] = {
        name: float(checks[name]) if checks.get(name) is not None else None
        for name in ("compatibility_residual", "equilibrium_residual", "energy_residual")
    }
    row["tension_episodes"] = int(checks.get("tension_episodes") or 0)
    if len(largest):
        row |= {"contact_force_max_N": float(largest.max()), "contact_force_min_N": float(smallest.min())}
        with np.errstate(divide="ignore", invalid="ignore"):
            unloading = np.where(static > 0.0, 1.0 - smallest / static, np.nan)
        row["unloading_max"] = float(np.nanmax(unloading)) if np.any(static > 0.0) else None
    return row


def _bodies(result: Result) -> dict[str, float]:
    """Largest vertical acceleration of the bodies of vehicles, bogies and wheels left out."""
    dofs = [i for i, name in enumerate(result.vehicle_dof) if _is_body(name)]
    if not dofs or not len(result.time):
        return {}
    return {"body_acceleration_max_m_per_s2": float(_largest(result.vehicle_acceleration[:, dofs]).max())}


def _is_body(name: str) -> bool:
    part, _, component = name.partition(".")[2].rpartition(".")
    return component == "z" and not part.startswith(("wheel", "bogie"))


def has_passed(plan: Plan) -> bool:
    """Whether no wheel is on the structure at the end, nor will come onto it."""
    end = plan.times_of(np.array([plan.settings.steps]))
    paths = [path.free for path in plan.rows.paths]
    low, high = min(path.start for path in paths), max(path.stop for path in paths)
    for train in plan.rows.trains:
        tail = train.positions(end)[0]
        if train.course.direction > 0 and tail.min() < high * (1.0 - 1e-12):
            return False
        if train.course.direction < 0 and tail.max() > low + 1e-9:
            return False
    return True
