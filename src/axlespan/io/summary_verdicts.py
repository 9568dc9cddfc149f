"""Verdicts by the rules of codes, in one word and as lines of text."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

# Units that people read, with the factor from SI.
_SHOWN = {"m": ("mm", 1e3), "N": ("kN", 1e-3), "rad": ("mrad", 1e3), "m/s": ("km/h", 3.6), "": ("", 1.0)}

# What the source of a limit says that nobody has compared with the standard.
_UNCHECKED = "check against the standard"


def assessed(verdicts: Sequence[Mapping[str, Any]]) -> str | None:
    """All verdicts in one word: fail, pass, or not assessed; None where nothing was asked for.

    Examples
    --------
    >>> assessed([{"outcome": "pass"}, {"outcome": "not assessed"}]), assessed([])
    ('pass', None)
    """
    outcomes = {verdict["outcome"] for verdict in verdicts}
    for word in ("fail", "pass"):
        if word in outcomes:
            return word
    return "not assessed" if outcomes else None


def verdict_lines(summary: Mapping[str, Any]) -> list[str]:
    """The verdicts of a summary: those that fail first, then by utilization."""
    verdicts = list(summary.get("verdicts") or ())
    if not verdicts:
        return []
    rows = [verdict for verdict in verdicts if verdict["outcome"] != "not assessed"]
    rows.sort(key=_order)
    lines = [_headline(verdicts)]
    for row in rows:
        word = "FAIL" if row["outcome"] == "fail" else row["outcome"]
        star = "*" if _UNCHECKED in (row.get("source") or "") else ""
        name = f"{row['check'].replace('_', ' ')}{star}"
        lines.append(f"  {word:<13}{_used(row):>7}  {name:<21}{_numbers(row):<34}{row['clause']}")
        told = "; ".join(text for text in (_place(row), row.get("note") or "") if text)
        if told:
            lines.append(f"  {'':<22}{told}")
    for row in verdicts:
        if row["outcome"] == "not assessed":
            name = row["check"].replace("_", " ")
            lines.append(f"  {'not assessed':<13}{'':>7}  {name:<21}{row['reason']}")
    if any(_UNCHECKED in (row.get("source") or "") for row in rows):
        lines.append(
            f"  * numbers of the standard from memory: {_UNCHECKED}, replace them under assessment.limits"
        )
    return lines


def _headline(verdicts: Sequence[Mapping[str, Any]]) -> str:
    word = assessed(verdicts) or ""
    judged = sum(verdict["outcome"] in ("pass", "fail") for verdict in verdicts)
    failed = sum(verdict["outcome"] == "fail" for verdict in verdicts)
    left = sum(verdict["outcome"] == "not assessed" for verdict in verdicts)
    parts = [f"{failed} of {judged} fail" if failed else f"{judged} pass"] if judged else []
    parts += [f"{left} not assessed"] if left and judged else []
    return (
        f"Rules: {'FAIL' if word == 'fail' else word}{f' ({chr(44).join(parts)})' if parts else ''}".replace(
            ",", ", "
        )
    )


def _order(row: Mapping[str, Any]) -> tuple[int, float]:
    used = row.get("utilization")
    if row["outcome"] == "fail":
        return 0, -(math.inf if used is None else used)
    return (1, -used) if row["outcome"] == "pass" and used is not None else (2, 0.0)


def _used(row: Mapping[str, Any]) -> str:
    used = row.get("utilization")
    if row.get("limit") is None:
        return "-"
    if used is None:  # beyond all numbers
        return "> 100" if row["outcome"] == "fail" else ""
    if row["outcome"] == "fail" and 1.0 < used < 1.005:  # not 100 %, which passes
        return "> 100 %"
    return f"{100.0 * used:.0f} %" if math.isfinite(used) and used < 100.0 else "> 100"


def _numbers(row: Mapping[str, Any]) -> str:
    unit, factor = _SHOWN.get(row.get("unit") or "", (row.get("unit") or "", 1.0))
    unit = unit.replace("^", "")
    value, limit = row.get("value"), row.get("limit")
    text = "" if value is None else f"{factor * value:.4g} {unit}".strip()
    if limit is None:
        return text
    return f"{text}, {'at least' if row.get('at_least') else 'limit'} {factor * limit:.4g} {unit}".strip()


def _place(row: Mapping[str, Any]) -> str:
    where, when = row.get("where") or "", row.get("when")
    time = "" if when is None else f"{when:.4g} s"
    return f"at {where}, {time}" if where and time else f"at {where or time}" if where or time else ""
