"""The book: all cases by theme, running them, and their results as text and as Markdown."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from difflib import get_close_matches

from axlespan.errors import InputError
from axlespan.verification import (
    beams,
    crossings,
    forces,
    methods,
    resonance,
    rides,
    solids,
    supports,
    track,
    trains,
    vehicles,
    wheels,
    yang_yau,
)
from axlespan.verification.case import Case, Row

#: All cases, theme by theme. A new theme is a module with a tuple ``CASES``, named here.
CASES: tuple[Case, ...] = (
    *crossings.CASES,
    *yang_yau.CASES,
    *forces.CASES,
    *trains.CASES,
    *resonance.CASES,
    *wheels.CASES,
    *vehicles.CASES,
    *rides.CASES,
    *supports.CASES,
    *track.CASES,
    *beams.CASES,
    *methods.CASES,
    *solids.CASES,
)


@dataclass(frozen=True)
class Report:
    """What a case gave."""

    case: Case
    rows: tuple[Row, ...]
    seconds: float  # that it took
    failure: str = ""  # why it gave no rows

    @property
    def ok(self) -> bool:
        """Whether it gave rows, all within their tolerances."""
        return not self.failure and bool(self.rows) and all(row.ok for row in self.rows)


def select(only: str | None = None, *, full: bool = False, cases: Sequence[Case] = CASES) -> list[Case]:
    """Choose cases: without the long ones unless ``full``, or those whose name contains ``only``.

    Long cases that ``only`` names and nothing shorter beside them are chosen too.

    Raises
    ------
    InputError
        If no name contains ``only``; the message names the nearest.
    """
    named = [item for item in cases if only is None or only.strip().lower() in item.name]
    if not named:
        raise _unknown(only or "", [item.name for item in cases])
    quick = [item for item in named if not item.long]
    return named if full or (only is not None and not quick) else quick


def _unknown(only: str, names: list[str]) -> InputError:
    # what was written may be near to a part of a name only
    parts = {part for name in names for part in (name, *name.split("-"))}
    close = get_close_matches(only.strip().lower(), sorted(parts), n=6, cutoff=0.5)
    hits = (name for part in close for name in names if part == name or part in name.split("-"))
    near = list(dict.fromkeys(hits))[:3]
    shown = ", ".join(f"'{name}'" for name in near)
    fix = f"Did you mean {shown}?" if near else f"Known: {', '.join(names)}"
    return InputError("is part of no case's name", field="only", value=only, fix=fix)


def run(cases: Iterable[Case]) -> Iterator[Report]:
    """Run cases one after another; one that breaks is reported as failed, and the next one runs."""
    for item in cases:
        begun = time.perf_counter()
        rows: tuple[Row, ...] = ()
        failure = ""
        try:
            rows = tuple(item.compute())
            failure = "" if rows else "it gave no rows"
        except Exception as error:  # whatever breaks an installation must not hide the other cases
            failure = f"{type(error).__name__}: {error}".replace("\n", " ")
        yield Report(item, rows, time.perf_counter() - begun, failure)


def as_markdown(reports: Iterable[Report]) -> str:
    """Return results as Markdown: a section with a table for every case.

    Times are left out, so that equal numbers give equal text.
    """
    return "\n".join(line for report in reports for line in _section(report))


def _section(report: Report) -> list[str]:
    item = report.case
    lines = [f"## {item.title}", "", f"`{item.name}`. Source: {item.source}.", "", item.description, ""]
    if report.failure:
        return [*lines, f"**FAIL**: {report.failure}", ""]
    lines += [
        "| quantity | unit | expected | obtained | error | of | tolerance | verdict | expected from |",
        "|---|---|---:|---:|---:|---|---:|---|---|",
    ]
    for row in report.rows:
        cells = (
            row.quantity,
            row.unit,
            f"{row.expected:.6g}",
            f"{row.obtained:.6g}",
            f"{row.error:.1e}",
            row.of,
            f"{row.tolerance:.1e}",
            row.verdict if row.ok else f"**{row.verdict}**",
            row.origin,
        )
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return [*lines, ""]
