"""The case in plain words, and the values that its file gives."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from html import escape
from io import StringIO
from typing import Any

from axlespan.report.units import plain

# Rows of the table of given values, and characters of one of them; characters of a title.
_ROWS, _LONG = 80, 120
_TITLE = 160

_PROFILES = {
    "harmonic": "regular waves",
    "table": "a profile given point by point",
    "spectrum": "a random profile made from a spectrum",
    "bump": "a bump",
    "ramp": "a ramp",
    "dipped-joint": "a dipped joint",
    "squat": "a squat",
    "pothole": "a pothole",
    "settlement": "a settlement",
    "none": "none",
}


def shortened(title: str) -> str:
    """A title as HTML, its end cut off where it is longer than anybody reads.

    Examples
    --------
    >>> shortened("a < b"), len(shortened("x" * 1000))
    ('a &lt; b', 160)
    """
    return escape(title if len(title) <= _TITLE else f"{title[: _TITLE - 1].rstrip()}…")


def case_content(text: str) -> dict[str, Any]:
    """The case file as plain data; empty if it cannot be read."""
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    try:
        found = YAML(typ="safe", pure=True).load(StringIO(text))
    except (YAMLError, ValueError):
        return {}
    return found if isinstance(found, dict) else {}


def sentences(
    summary: Mapping[str, Any], case: Mapping[str, Any], wheelbase: float | None, length: float | None
) -> list[str]:
    """What was computed, as a few sentences; wheelbase of the train and length of the structure in m."""
    run = summary.get("run") or {}
    found = [_crossing(run, wheelbase, length)]
    found.append(_irregularity(case))
    found.append(_computation(run, summary))
    return [sentence for sentence in found if sentence]


def _crossing(run: Mapping[str, Any], wheelbase: float | None, length: float | None) -> str:
    train, structure = run.get("train"), run.get("structure")
    if not train or not structure:
        return ""
    wheels = run.get("contacts") or 0
    count = f"{wheels} wheel{'s' if wheels != 1 else ''}"
    base = f", {plain(wheelbase)} m from the first to the last" if wheelbase else ""
    long = f", {plain(length)} m long" if length else ""
    return f"A train ({train}; {count}{base}) crosses a structure ({structure}{long}) {_speed(run)}."


def _speed(run: Mapping[str, Any]) -> str:
    first, last = run.get("speed_start_m_per_s"), run.get("speed_end_m_per_s")
    if first is None:
        return ""
    if last is None or last == first:
        return f"at {plain(3.6 * first)} km/h ({plain(first)} m/s)"
    return f"at a speed that changes from {plain(3.6 * first)} to {plain(3.6 * last)} km/h"


def _irregularity(case: Mapping[str, Any]) -> str:
    crossing = case.get("crossing")
    given = crossing.get("irregularity") if isinstance(crossing, dict) else None
    if not case:
        return ""
    kind = given.get("kind") if isinstance(given, dict) else None
    if kind in (None, "none"):
        return "The running surface is even." if given is None or kind == "none" else ""
    assert isinstance(given, dict)  # it has a kind
    return f"The running surface is uneven: {_profile(given)}."


def _profile(given: object) -> str:
    """One irregularity in words; of a sum and of lines, all that they hold."""
    if not isinstance(given, dict):
        return str(given)
    kind = str(given.get("kind"))
    parts, lines = given.get("of"), given.get("lines")
    if kind == "sum" and isinstance(parts, list):
        return ", and ".join(_profile(part) for part in parts)
    if kind == "lines" and isinstance(lines, dict):
        return "; ".join(f"on the line {name} {_profile(one)}" for name, one in lines.items())
    details = ", ".join(
        f"{key} {_plain(value)}" for key, value in given.items() if key not in ("kind", "points")
    )
    return _PROFILES.get(kind, kind) + (f" ({details})" if details else "")


def _computation(run: Mapping[str, Any], summary: Mapping[str, Any]) -> str:
    step, steps, done = run.get("time_step_s"), run.get("steps"), run.get("completed_steps")
    if step is None or steps is None:
        return ""
    coupling = (summary.get("computation") or {}).get("coupling") or "direct"
    taken = f"{steps:,} step{'s' if steps != 1 else ''}".replace(",", "\u202f")
    if done is not None and done != steps:
        taken = f"{done} of {steps} steps"
    return (
        f"The response was computed over {plain(run.get('simulated_s'))} s in {taken} of {plain(1e3 * step)} ms, "
        f"with wheel and rail coupled by the {coupling} method."
    )


def given_values(case: Mapping[str, Any]) -> dict[str, list[tuple[str, str]]]:
    """Rows (name, value) of each block of a case file, as they were written there."""
    found: dict[str, list[tuple[str, str]]] = {}
    for block in ("structure", "train", "crossing", "analysis", "output"):
        if block in case:
            rows = list(_rows(case[block], ""))
            left = len(rows) - _ROWS
            found[block] = rows[:_ROWS] + ([("…", f"{left} more in the case file")] if left > 0 else [])
    return found


def _rows(value: Any, name: str) -> Iterator[tuple[str, str]]:
    if isinstance(value, Mapping):
        for key, item in value.items():
            yield from _rows(item, f"{name} › {key}" if name else str(key))
    elif (
        isinstance(value, Sequence)
        and not isinstance(value, str)
        and any(isinstance(v, Mapping) for v in value)
    ):
        for i, item in enumerate(value):
            yield from _rows(item, f"{name} {i + 1}".strip())
    else:
        yield name.replace("_", " "), _plain(value)


def _plain(value: Any) -> str:
    if isinstance(value, bool) or value is None:
        return {True: "yes", False: "no", None: "none"}[value]
    if isinstance(value, Mapping):
        return ", ".join(f"{key}: {_plain(item)}" for key, item in value.items())
    if isinstance(value, (list, tuple)):
        text = ", ".join(_plain(item) for item in value[:24])
        text = f"[{text}{', …' if len(value) > 24 else ''}]"
    else:
        text = str(value)
    return text if len(text) <= _LONG else text[: _LONG - 1] + "…"
