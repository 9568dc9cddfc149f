"""``axlespan verify``: the verification book as a table."""

from __future__ import annotations

import sys

from axlespan.cli.messages import DONE, FAILED, refuse, say
from axlespan.errors import InputError
from axlespan.verification.book import CASES, run, select
from axlespan.verification.table import heading, lines_of, total


def run_book(*, full: bool, only: str | None) -> int:
    """Run the book, or the cases whose name contains ``only``; the exit code."""
    try:
        cases = select(only, full=full)
    except InputError as error:
        return refuse(error)
    say(heading())
    reports = []
    for report in run(cases):
        reports.append(report)
        for line in lines_of(report):
            say(line)
        sys.stdout.flush()  # a pipe shows each case as it is done
    say(total(reports))
    left = [item.name for item in CASES if item.long and item not in cases]
    if only is None and left:
        say(f"Left out, because they take longer: {', '.join(left)}. Run them with --full.")
    return DONE if all(report.ok for report in reports) else FAILED
