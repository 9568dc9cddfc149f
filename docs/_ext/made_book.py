"""The verification book: run, and printed as it comes out."""

from __future__ import annotations

import os
from pathlib import Path

from axlespan.verification.book import CASES, as_markdown, run, select

INTRODUCTION = """# Verification

Every case is computed while this page is made, by `axlespan verify`; expected values come from where the last
column says. An error is a part of what the column *of* names. The cases below are the quick ones; with
`AXLESPAN_DOCS_FULL=1` a build computes all of them, with `AXLESPAN_DOCS_QUICK=1` two. {left}

"""


#: What a quick build computes.
FEW = ("neves-3.1", "moving-force")


def page(_path: Path) -> str:
    """Return the book, of a few cases when the build asks for speed."""
    chosen = select(full=bool(os.environ.get("AXLESPAN_DOCS_FULL")))
    if os.environ.get("AXLESPAN_DOCS_QUICK"):
        chosen = tuple(item for item in chosen if item.name in FEW)
    left = [item.name for item in CASES if item not in chosen]
    said = (
        f"Left out here: {', '.join(f'`{name}`' for name in left)} (`axlespan verify --full`)."
        if left
        else ""
    )
    reports = list(run(chosen))
    bad = [report.case.name for report in reports if not report.ok]
    if bad:
        raise RuntimeError(f"the verification book fails in {', '.join(bad)}")
    return INTRODUCTION.format(left=said) + as_markdown(reports)
