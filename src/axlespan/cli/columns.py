"""Rows of words as aligned columns."""

from __future__ import annotations

from collections.abc import Sequence


def columns(rows: Sequence[Sequence[str]], right: Sequence[int] = (), indent: str = "  ") -> list[str]:
    """Return the rows with their words in columns, those numbered in ``right`` to the right.

    Examples
    --------
    >>> columns([["name", "mass"], ["ice3", "62"]], right=[1], indent="")
    ['name  mass', 'ice3    62']
    """
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))] if rows else []
    lines = []
    for row in rows:
        words = [
            word.rjust(width) if i in right else word.ljust(width)
            for i, (word, width) in enumerate(zip(row, widths, strict=True))
        ]
        lines.append((indent + "  ".join(words)).rstrip())
    return lines
