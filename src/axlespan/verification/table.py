"""The book as lines of plain text: fixed columns, one line per row."""

from __future__ import annotations

from collections.abc import Sequence

from axlespan.verification.book import CASES, Report

# heading, width; negative widths are set to the left
_COLUMNS = (
    ("case", -max(len(item.name) for item in CASES)),
    ("quantity", -44),
    ("unit", -4),
    ("expected", 12),
    ("obtained", 12),
    ("error", 8),
    ("of", -6),
    ("allowed", 8),
    ("verdict", -7),
    ("time", 8),
)


def heading() -> str:
    """The line above the rows."""
    return _line([name for name, _ in _COLUMNS])


def lines_of(report: Report) -> list[str]:
    """One line per row; the time of the case stands in its first one."""
    seconds = f"{report.seconds:.2f} s"
    if report.failure:
        return [_line([report.case.name, "", "", "", "", "", "", "", "FAIL", seconds, report.failure])]
    return [
        _line(
            [
                report.case.name,
                row.quantity,
                row.unit,
                f"{row.expected:.6g}",
                f"{row.obtained:.6g}",
                f"{row.error:.1e}",
                row.of,
                f"{row.tolerance:.1e}",
                row.verdict,
                seconds if i == 0 else "",
                "" if row.ok else f"expected from: {row.origin}",
            ]
        )
        for i, row in enumerate(report.rows)
    ]


def total(reports: Sequence[Report]) -> str:
    """The last line: how many rows and cases, how many fail, how long it took."""
    rows = [row for report in reports for row in report.rows]
    off = sum(not row.ok for row in rows)
    bad = [report.case.name for report in reports if not report.ok]
    seconds = sum(report.seconds for report in reports)
    verdict = f"FAIL in {', '.join(bad)}" if bad else "ok"
    return f"{len(rows)} rows in {len(reports)} cases, {off} off, {seconds:.1f} s: {verdict}"


def _line(cells: Sequence[str]) -> str:
    parts = [
        cell.ljust(-width) if width < 0 else cell.rjust(width)
        for cell, (_, width) in zip(cells, _COLUMNS, strict=False)
    ]
    return "  ".join([*parts, *cells[len(_COLUMNS) :]]).rstrip()
