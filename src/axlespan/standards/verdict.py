"""A verdict: what a clause asks for, what was found, and whether that will do."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Any

from axlespan.errors import InputError

#: Status of a number that nobody has compared with the text of the standard yet.
FROM_MEMORY = "from memory: check against the standard"

PASS, FAIL, REPORTED, NOT_ASSESSED = "pass", "fail", "reported", "not assessed"

#: What a verdict may say. "reported" is a value for which there is no limit.
OUTCOMES = (PASS, FAIL, REPORTED, NOT_ASSESSED)


@dataclass(frozen=True)
class Verdict:
    """One quantity against one limit.

    Utilization is value over limit, so that 1 is reached at the limit; where more is better (``at_least``)
    it is limit over value.
    """

    check: str  # its name in case files: deck_acceleration
    clause: str  # EN 1990 A2.4.4.2.1
    quantity: str  # in words
    outcome: str  # pass, fail, reported, not assessed
    value: float | None = None  # [unit]
    limit: float | None = None  # [unit]
    unit: str = ""  # SI: m/s^2
    at_least: bool = False  # whether the limit is the smallest value that passes
    reason: str = ""  # why it was not assessed
    where: str = ""  # place, in words
    when: float | None = None  # [s]
    source: str = ""  # where the limit comes from, and how sure it is
    note: str = ""  # how it was found

    def __post_init__(self) -> None:
        if self.outcome not in OUTCOMES:
            raise InputError(f"must be one of {', '.join(OUTCOMES)}", field="outcome", value=self.outcome)
        if self.outcome == NOT_ASSESSED and not self.reason:
            raise InputError("must say why it was not assessed", field="reason", value=self.check)

    @property
    def utilization(self) -> float | None:
        """Share of the limit that is used [-]; None without value or limit."""
        if self.value is None or self.limit is None:
            return None
        over, under = (self.limit, self.value) if self.at_least else (self.value, self.limit)
        if under == 0.0:
            return 0.0 if over == 0.0 else math.inf
        return over / under

    def as_dict(self) -> dict[str, Any]:
        """Names and plain values, with the utilization; ready for JSON."""
        return asdict(self) | {"utilization": self.utilization}


def judged(
    check: str,
    clause: str,
    quantity: str,
    value: float,
    limit: float | None,
    unit: str,
    *,
    at_least: bool = False,
    where: str = "",
    when: float | None = None,
    source: str = "",
    note: str = "",
) -> Verdict:
    """Compare a value with its limit; at the limit it passes. Without limit it is reported.

    A value that is not finite is no value: it fails.

    Examples
    --------
    >>> judged("deck_acceleration", "EN 1990 A2.4.4.2.1", "acceleration", 3.5, 3.5, "m/s^2").outcome
    'pass'
    """
    if limit is None:
        outcome = REPORTED
    else:
        good = value >= limit if at_least else value <= limit
        outcome = PASS if good and math.isfinite(value) else FAIL
    return Verdict(
        check,
        clause,
        quantity,
        outcome,
        float(value),
        None if limit is None else float(limit),
        unit,
        at_least,
        where=where,
        when=when,
        source=source,
        note=note,
    )


def not_assessed(check: str, clause: str, quantity: str, reason: str, *, source: str = "") -> Verdict:
    """A verdict that cannot be given, and why."""
    return Verdict(check, clause, quantity, NOT_ASSESSED, reason=reason, source=source)


def overall(verdicts: Iterable[Verdict]) -> str:
    """All verdicts in one word: fail if one fails, pass if one passes and none fails, else not assessed.

    Parameters
    ----------
    verdicts : iterable of Verdict
    """
    outcomes = {verdict.outcome for verdict in verdicts}
    return FAIL if FAIL in outcomes else PASS if PASS in outcomes else NOT_ASSESSED


def envelope(runs: Iterable[Iterable[Verdict]]) -> tuple[Verdict, ...]:
    """The worst verdict on each check over several runs, such as all speeds of a sweep; see :func:`worst`.

    Parameters
    ----------
    runs : iterable of iterables of Verdict
        Verdicts of each run.
    """
    by_check: dict[str, list[Verdict]] = {}
    for run in runs:
        for verdict in run:
            by_check.setdefault(verdict.check, []).append(verdict)
    return tuple(worst(verdicts) for verdicts in by_check.values())


def worst(verdicts: Iterable[Verdict]) -> Verdict:
    """The verdict of several runs on one check: the one with the highest utilization.

    Verdicts that could not be given count only if none could.

    Parameters
    ----------
    verdicts : iterable of Verdict
        On one check.

    Raises
    ------
    InputError
        If there is none, or they are of different checks.
    """
    found = list(verdicts)
    if not found:
        raise InputError("must be at least one", field="verdicts")
    if len({verdict.check for verdict in found}) > 1:
        raise InputError("must all be of one check", field="verdicts", value=sorted({v.check for v in found}))

    def rank(verdict: Verdict) -> tuple[float, float]:
        if verdict.outcome == NOT_ASSESSED:
            return -1.0, 0.0
        used = verdict.utilization
        if used is not None:
            return 1.0 if math.isfinite(used) else 2.0, used if math.isfinite(used) else 0.0
        return 0.0, abs(verdict.value or 0.0)

    return max(found, key=rank)
