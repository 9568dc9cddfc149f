"""``axlespan report``: one HTML page from a folder of results."""

from __future__ import annotations

from pathlib import Path

from axlespan.cli.messages import DONE, FAILED, refuse, say, warn
from axlespan.errors import InputError
from axlespan.report.page import write_told


def make_report(folder: Path, page: Path | None) -> int:
    """Write the page of a stored result; the exit code."""
    try:
        written, notices = write_told(folder, page)
    except InputError as error:
        return refuse(error)
    except OSError as error:
        warn(f"{page or folder}: the page cannot be written: {error.strerror or error}")
        return FAILED
    except MemoryError:
        warn(f"{folder}: there is not enough memory for the page; keep fewer times with every, under output")
        return FAILED
    for notice in notices:
        warn(f"{folder}: {notice}")
    say(f"Written to {written} ({_size(written.stat().st_size)}); open it in a browser")
    return DONE


def _size(size: int) -> str:
    return f"{size / 1e6:.1f} MB" if size >= 1e6 else f"{max(size // 1000, 1)} kB"
