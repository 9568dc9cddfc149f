"""Verdicts on a run's self-checks."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Check:
    """A self-check: its key in ``Result.checks``, the limit of a pass, and what it says."""

    key: str
    name: str
    limit: float
    meaning: str
    remedy: str


# A solution by a factor carries an error of about 1e-16 times the condition of the matrix, which is below
# 1e8 for the usual beams, shells and solids with a time step in milliseconds. Sums over the whole structure
# (reactions, energy) lose two more digits. The iterative coupling stops at 1e-10 of the static force.
CHECKS = (
    Check(
        "compatibility_residual",
        "compatibility",
        1e-8,
        "gap between wheel and rail, over the largest displacement",
        "Write method: direct, or a smaller tolerance of the iterative method",
    ),
    Check(
        "equilibrium_residual",
        "equilibrium",
        1e-6,
        "reactions, loads and inertia out of balance, over the largest",
        "Look for very large or very small stiffnesses and masses",
    ),
    Check(
        "energy_residual",
        "energy",
        1e-6,
        "energy that appears in a step, over the largest energy",
        "Look for very large or very small stiffnesses and masses",
    ),
    Check(
        "force_noise",
        "clean forces",
        0.1,
        "contact force that alternates from step to step, over the static one",
        "Leave alpha and footprint out, use a smaller time step, or contact: hertz; landings and kinks ring too",
    ),
)


def verdicts(checks: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Self-checks with values, limits and verdicts: pass, attention, or not checked.

    Examples
    --------
    >>> found = verdicts({"finite_values": True, "compatibility_residual": 1e-3, "tension_episodes": 0})
    >>> [(check["name"], check["verdict"]) for check in found]
    [('finite', 'pass'), ('compatibility', 'attention'), ('equilibrium', 'not checked'),
     ('energy', 'not checked'), ('clean forces', 'not checked'), ('tension', 'pass')]
    """
    finite = checks.get("finite_values")
    found = [
        _row(
            "finite",
            finite,
            True,
            finite is True if finite is not None else None,
            "all values are finite",
            "",
        )
    ]
    for check in CHECKS:
        value = checks.get(check.key)
        good = None if value is None else math.isfinite(value) and value <= check.limit
        found.append(_row(check.name, value, check.limit, good, check.meaning, check.remedy))
    episodes = checks.get("tension_episodes")
    good = None if episodes is None else episodes == 0
    meaning = "no wheel has to pull at the rail to stay on it"
    remedy = "The forces are those of wheels held to the rail; without that they would lift off there"
    return [*found, _row("tension", episodes, 0, good, meaning, remedy)]


def _row(name: str, value: Any, limit: Any, good: bool | None, meaning: str, remedy: str) -> dict[str, Any]:
    verdict = "not checked" if good is None else "pass" if good else "attention"
    row = {"name": name, "value": value, "limit": limit, "verdict": verdict, "meaning": meaning}
    return row | ({"remedy": remedy} if verdict == "attention" and remedy else {})
