"""Verdicts of scenarios, as columns of the table."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from axlespan.standards.assessment import CHECKS
from axlespan.standards.verdict import FAIL, NOT_ASSESSED, PASS, REPORTED, Verdict
from axlespan.study.case import Case

# The worst first.
_ORDER = (FAIL, NOT_ASSESSED, PASS, REPORTED)


def verdict_columns(case: Case) -> dict[str, str]:
    """Columns of the checks that a case asks for: outcome and utilization of each."""
    if case.assessment is None:
        return {}
    checks = case.assessment.wanted().checks or CHECKS
    return {
        name: kind
        for check in checks
        for name, kind in ((f"verdict.{check}", "text"), (f"utilization.{check}", "number"))
    }


def verdict_row(verdicts: Iterable[Verdict]) -> dict[str, Any]:
    """The values of these columns; of several verdicts of one check the worst counts.

    A scenario fails if one check does; it passes if one does and none fails. What cannot be assessed, as comfort in
    a train of axle loads, counts for neither.
    """
    row: dict[str, Any] = {}
    for verdict in verdicts:
        name = f"verdict.{verdict.check}"
        if name not in row or _ORDER.index(verdict.outcome) < _ORDER.index(row[name]):
            row[name] = verdict.outcome
        share = verdict.utilization
        if share is not None and np.isfinite(share):
            key = f"utilization.{verdict.check}"
            row[key] = max(share, row.get(key, -np.inf))
    found = {value for key, value in row.items() if key.startswith("verdict.")}
    row["verdict"] = FAIL if FAIL in found else PASS if PASS in found else NOT_ASSESSED
    return row
