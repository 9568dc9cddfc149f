"""The page of a result: what goes on it, and how its parts become one file."""

from __future__ import annotations

import os
import secrets
from collections.abc import Mapping
from html import escape
from os import PathLike
from pathlib import Path
from typing import Any

import axlespan
from axlespan.errors import InputError
from axlespan.io.drawing import Drawing
from axlespan.io.results import read_result
from axlespan.io.strict_json import json_ready
from axlespan.io.summary import summary as summary_of
from axlespan.io.train_shapes import Unit
from axlespan.report.assembly import assembled
from axlespan.report.forces import forces_over_position
from axlespan.report.maps import maps
from axlespan.report.pack import Pack
from axlespan.report.panels import panels
from axlespan.report.scene import scene
from axlespan.report.shapes import units_of
from axlespan.report.sketch import sketch
from axlespan.report.space import space
from axlespan.report.spectra import spectra
from axlespan.report.stored import Stored, is_study, opened
from axlespan.report.tables import badge, check_table, peak_tables, verdict_table
from axlespan.report.units import number
from axlespan.report.words import case_content, given_values, sentences, shortened

#: Name of the page beside the result.
PAGE = "report.html"

_SCRIPTS = ("inflate", "data", "export", "plots", "maps", "player", "flat", "space", "chrome", "main")


def write_report(folder: str | PathLike[str], page: str | PathLike[str] | None = None) -> Path:
    """Write the page of a stored result or study; the path of the page.

    Parameters
    ----------
    folder : path
        Folder of a run, or its result.nc, that of a failed run too; or the store of a study.
    page : path, optional
        Of the page; report.html in the folder when left out.

    Raises
    ------
    InputError
        If there is no result to report.
    OSError
        If the page cannot be written.
    """
    return write_told(folder, page)[0]


def write_told(
    folder: str | PathLike[str], page: str | PathLike[str] | None = None
) -> tuple[Path, list[str]]:
    """Write a page as :func:`write_report` does; its path, and what it says that its source lacks."""
    place = Path(folder)
    target = Path(page) if page is not None else (place if place.is_dir() else place.parent) / PAGE
    text, notices = _told(place)
    part = target.with_name(f".{target.name}.{os.getpid()}-{secrets.token_hex(4)}.part")
    try:
        part.write_text(text, encoding="utf-8")
        os.replace(part, target)
    finally:
        part.unlink(missing_ok=True)
    return target, notices


def result_page(folder: str | PathLike[str]) -> str:
    """The page of a stored result or study as text; see :func:`write_report`.

    Parameters
    ----------
    folder : path
        Of a result or a study.
    """
    return _told(Path(folder))[0]


def _told(folder: Path) -> tuple[str, list[str]]:
    """The page, and what its source lacks."""
    if is_study(folder):
        from axlespan.report.study_page import study_page

        return study_page(folder)
    with opened(folder) as stored:
        return _page(stored), stored.notices


def _page(stored: Stored) -> str:
    summary = _summary(stored)
    case = case_content(stored.text("case"))
    drawing = stored.drawing()
    units = units_of(stored, drawing)
    # without the file nobody knows what of the running line is bridge and what is track on the ground
    ends = None if stored.file is None else _ends(drawing, summary)
    pack = Pack()
    content: dict[str, Any] = {"title": _title(summary, stored)}
    if len(stored.time) > 1:
        content |= {
            "scene": scene(stored, pack, drawing, units, ends),
            "space": space(stored, pack, drawing),
            "panels": panels(stored, pack),
            "force": forces_over_position(stored, pack, ends),
            "maps": maps(stored, pack),
            "spectra": spectra(stored, pack),
        }
    if content.get("scene") is None:
        content["space"] = None
    content["arrays"] = pack.directory()
    values = {
        "title": shortened(content["title"]),
        "version": escape(str(summary.get("version") or axlespan.__version__)),
        "badge": _outcome_badge(summary),
        "notices": _notices(stored, summary, content),
        "words": _words(summary, case, units, ends) + _trains(drawing),
        "cards": _cards(summary),
        "sketch": sketch(drawing, units, ends),
        "given": _given(case, stored),
        "verdicts": verdict_table(summary) or "<p>No limits of standards were checked in this run.</p>",
        "checks": check_table(summary),
        "peaks": peak_tables(summary),
        "notes": "".join(f"<li>{escape(str(note))}</li>" for note in summary.get("notes") or []),
    }
    return assembled("page", values, content, pack, _SCRIPTS)


# --- what the page says ------------------------------------------------------------------------


def _summary(stored: Stored) -> Mapping[str, Any]:
    """The stored summary, or one made from the result; that of a page without either is empty."""
    if stored.summary:
        return stored.summary
    path = Path(stored.file.filename) if stored.file is not None else None
    head = {
        "outcome": {key: stored.text(name) for key, name in _OUTCOME.items()},
        "version": stored.text("version"),
    }
    if path is not None:
        if not any(notice.startswith("summary.json") for notice in stored.notices):
            stored.notices.append(
                "There is no summary.json: the run may have been stopped. Tables are made from result.nc."
            )
        try:
            made: dict[str, Any] = json_ready(summary_of(read_result(path)))
            return made | head
        except InputError as error:
            stored.notices.append(f"Tables of extremes are missing: {error.rule}.")
    return head


_OUTCOME = {"code": "outcome", "message": "outcome_message", "remedy": "outcome_remedy"}


def _title(summary: Mapping[str, Any], stored: Stored) -> str:
    return str((summary.get("run") or {}).get("title") or stored.folder.resolve().name or "Crossing")


def _ends(drawing: Drawing | None, summary: Mapping[str, Any]) -> tuple[float, float] | None:
    """Ends of the deck's line, or else of the main running line [m]."""
    lines = {} if drawing is None else drawing.content.get("lines", {})
    if drawing is not None and lines:
        rows = lines.get(drawing.content.get("deck") or "") or next(iter(lines.values()))
        return float(rows[0][0]), float(rows[-1][0])
    run = summary.get("run") or {}
    begin, end = run.get("structure_from_m"), run.get("structure_to_m")
    return None if begin is None or end is None else (float(begin), float(end))


def _outcome_badge(summary: Mapping[str, Any]) -> str:
    code = (summary.get("outcome") or {}).get("code") or "unknown"
    if code != "completed":
        return badge("failed") if code == "failed" else f'<span class="badge bad">{escape(str(code))}</span>'
    verdicts = [str(item.get("outcome")).lower() for item in summary.get("verdicts") or []]
    if any(word in ("fail", "failed", "exceeded") for word in verdicts):
        return '<span class="badge bad"><span aria-hidden="true">✗</span> a limit is exceeded</span>'
    if summary.get("verdict") == "pass" and "pass" in verdicts:
        return '<span class="badge good"><span aria-hidden="true">✓</span> completed, self-checks and limits passed</span>'
    if summary.get("verdict") == "pass":
        return '<span class="badge good"><span aria-hidden="true">✓</span> completed, all self-checks passed</span>'
    return '<span class="badge warn"><span aria-hidden="true">!</span> completed, needs attention</span>'


def _notices(stored: Stored, summary: Mapping[str, Any], content: Mapping[str, Any]) -> str:
    outcome = summary.get("outcome") or {}
    found = []
    if outcome.get("code") not in (None, "", "completed"):
        said = [str(outcome[key]).rstrip(".") for key in ("message", "remedy") if outcome.get(key)]
        found.append(
            "The analysis did not reach its end, and what follows is what was computed until then. "
            + " ".join(f"{text[:1].upper()}{text[1:]}." for text in said)
        )
    found += stored.notices
    if stored.file is not None and len(stored.time) > 1 and not content.get("maps"):
        found.append(
            "Motions along the line were not kept, so there are no maps over space and time (output: line: 41)."
        )
    items = "".join(f"<li>{escape(text)}</li>" for text in found)
    return f'<aside class="notices" aria-label="Notices"><ul>{items}</ul></aside>' if items else ""


def _words(
    summary: Mapping[str, Any], case: Mapping[str, Any], units: list[Unit], ends: tuple[float, float] | None
) -> str:
    wheels = [behind for unit in units if unit.train == 0 for _, behind, *_ in unit.wheels]
    base = max(wheels) - min(wheels) if wheels else None
    length = None if ends is None else ends[1] - ends[0]
    return "".join(f"<p>{escape(text)}</p>" for text in sentences(summary, case, base, length))


def _trains(drawing: Drawing | None) -> str:
    """All trains of a crossing, where there are several."""
    trains = [] if drawing is None else drawing.content.get("trains", [])
    if len(trains) < 2:
        return ""
    ways = {1: "forward", -1: "backward"}
    words = "; ".join(f"{train['name']} ({ways[train['direction']]})" for train in trains)
    return f"<p>{escape(f'{len(trains)} trains run: {words}.')}</p>"


def _cards(summary: Mapping[str, Any]) -> str:
    """The few numbers that a reader wants first."""
    found = []
    sensors = {name: row for name, row in (summary.get("sensors") or {}).items() if row}
    for quantity, unit, words, factor, shown in (
        ("displacement", "m", "Largest displacement of a sensor", 1e3, "mm"),
        ("acceleration", "m_per_s2", "Largest acceleration of a sensor", 1.0, "m/s²"),
    ):
        ends = [
            (abs(row[f"{quantity}_{end}_{unit}"]), row[f"{quantity}_{end}_{unit}"], name)
            for name, row in sensors.items()
            for end in ("min", "max")
            if row.get(f"{quantity}_{end}_{unit}") is not None
        ]
        if ends:
            _, value, name = max(ends)
            found.append((words, f"{number(factor * value)} {shown}", f"at {name}"))
    forces = summary.get("contact_forces") or {}
    if forces.get("largest"):
        row = forces["largest"]
        if row.get("force_N") is not None:
            found.append(
                ("Largest contact force", f"{number(1e-3 * row['force_N'])} kN", f"wheel {row['contact']}")
            )
        lost = forces.get("largest_unloading")
        if lost is not None:
            found.append(("Largest unloading", f"{number(100.0 * lost, 3)} %", "of the static force"))
    body = (summary.get("vehicle_accelerations") or {}).get("body.z")
    if body:
        peaks = [
            (body[end], body.get(f"{end}_vehicle")) for end in ("min", "max") if body.get(end) is not None
        ]
        if peaks:
            value, vehicle = max(peaks, key=lambda found: abs(found[0]))
            where = "vertical, at its center" if vehicle is None else f"vehicle {vehicle}, at its center"
            found.append(("Largest acceleration of a body", f"{number(value)} m/s²", where))
    return "".join(
        f'<div class="card"><div class="what">{escape(a)}</div><div class="value">{escape(b)}</div>'
        f'<div class="where">{escape(c)}</div></div>'
        for a, b, c in found
    )


def _given(case: Mapping[str, Any], stored: Stored) -> str:
    """Values of the case file, and the file itself."""
    blocks = []
    for name, rows in given_values(case).items():
        cells = "".join(f"<dt>{escape(key)}</dt><dd>{escape(value)}</dd>" for key, value in rows)
        blocks.append(f"<section><h3>{escape(name)}</h3><dl>{cells}</dl></section>")
    text = stored.text("case")
    whole = (
        f"<details><summary>The case file</summary><pre tabindex=0>{escape(text)}</pre></details>"
        if text
        else ""
    )
    return f'<div class="given">{"".join(blocks)}</div>{whole}' if blocks or whole else ""
