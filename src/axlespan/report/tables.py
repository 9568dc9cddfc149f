"""Verdicts, self-checks and peaks as tables."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from axlespan.report.units import number, shown_unit

Summary = Mapping[str, Any]

# Rows of a table; the rest is told.
_ROWS = 60

_MEMORY = "from memory"
_UNCHECKED = (
    "* Numbers of the standard from memory: check against the standard, replace them under assessment.limits."
)

_BADGES = {
    "pass": ("good", "✓", "passed"),
    "fulfilled": ("good", "✓", "passed"),
    "ok": ("good", "✓", "passed"),
    "fail": ("bad", "✗", "failed"),
    "failed": ("bad", "✗", "failed"),
    "exceeded": ("bad", "✗", "exceeded"),
    "attention": ("warn", "!", "attention"),
    "not checked": ("none", "–", "not checked"),
    "not applicable": ("none", "–", "not applicable"),
    "reported": ("none", "i", "reported"),
    "not assessed": ("none", "–", "not assessed"),
}


def badge(word: str) -> str:
    """A word with a sign and a color, so that neither alone carries the meaning.

    Examples
    --------
    >>> badge("pass")
    '<span class="badge good"><span aria-hidden="true">✓</span> passed</span>'
    """
    kind, sign, text = _BADGES.get(word.lower(), ("none", "·", word))
    return f'<span class="badge {kind}"><span aria-hidden="true">{sign}</span> {escape(text)}</span>'


def verdict_table(summary: Summary) -> str:
    """Limits of standards with how far they are used; empty if none were checked."""
    rows = []
    unchecked = False
    for verdict in sorted(summary.get("verdicts") or [], key=_order)[:_ROWS]:
        unit = _unit_text(str(verdict.get("unit") or ""))
        factor = shown_unit(str(verdict.get("unit") or ""))[0]
        if verdict.get("unit") == "m/s":  # of a train
            factor, unit = 3.6, "km/h"
        clause = escape(str(verdict.get("clause") or ""))
        source = verdict.get("source")
        memory = verdict.get("outcome") != "not assessed" and _MEMORY in str(source)
        unchecked |= memory
        title = f' title="{escape(str(source), quote=True)}"' if source else ""
        reason = verdict.get("reason") or verdict.get("note")
        why = f'<div class="why">{escape(str(reason))}</div>' if reason else ""
        least = "at least " if verdict.get("at_least") and verdict.get("limit") is not None else ""
        name = f"{escape(str(verdict.get('quantity') or ''))}{'*' if memory else ''}"
        rows.append(
            f'<tr><td data-label="Quantity"><div>{name}{why}</div></td>'
            f'<td data-label="Clause"{title}>{clause}</td>'
            f'<td class="n" data-label="Value">{_amount(verdict.get("value"), factor, unit)}</td>'
            f'<td class="n" data-label="Limit">{least}{_amount(verdict.get("limit"), factor, unit)}</td>'
            f'<td data-label="Used">{bar(verdict.get("utilization"))}</td>'
            f'<td data-label="Where, when">{_place(verdict)}</td>'
            f'<td data-label="Verdict">{badge(str(verdict.get("outcome") or ""))}</td></tr>'
        )
    if not rows:
        return ""
    heads = ("Quantity", "Clause", "Value", "Limit", "Used", "Where, when", "Verdict")
    table = _table("Verdicts against limits of standards", heads, rows, numeric=(2, 3))
    return table + (f'<p class="note">{_UNCHECKED}</p>' if unchecked else "")


def _order(verdict: Mapping[str, Any]) -> tuple[int, float]:
    """What fails first, then by how much of the limit is used; what was not assessed last."""
    used = verdict.get("utilization")
    if verdict.get("outcome") == "fail":
        return 0, -(math.inf if used is None else float(used))
    if used is not None:
        return 1, -float(used)
    return (3 if verdict.get("outcome") == "not assessed" else 2), 0.0


def bar(share: Any) -> str:
    """A bar for how much of a limit is used, with its percentage.

    Examples
    --------
    >>> "width:50.0%" in bar(0.5), "over" in bar(1.3)
    (True, True)
    """
    if not isinstance(share, (int, float)) or isinstance(share, bool) or not math.isfinite(share):
        return "–"
    state = "over" if share > 1.0 else "near" if share > 0.9 else "under"
    width = min(max(100.0 * share, 0.0), 100.0)
    return (
        f'<span class="share"><span class="bar {state}" role="img" aria-label="{100.0 * share:.0f} percent of the limit">'
        f'<span style="width:{width:.1f}%"></span></span> <span class="n">{100.0 * share:.0f} %</span></span>'
    )


def check_table(summary: Summary) -> str:
    """Self-checks of the computation."""
    rows = []
    for check in summary.get("checks") or []:
        value, limit = check.get("value"), check.get("limit")
        plain = isinstance(value, bool) or value is None
        shown = ("yes" if value else "no") if isinstance(value, bool) else number(value, 2)
        remedy = f'<div class="why">{escape(str(check["remedy"]))}</div>' if check.get("remedy") else ""
        rows.append(
            f'<tr><td data-label="Check">{escape(str(check.get("name")))}</td>'
            f'<td data-label="Meaning">{escape(str(check.get("meaning")))}{remedy}</td>'
            f'<td class="n" data-label="Value">{shown}</td>'
            f'<td class="n" data-label="Limit">{"" if plain else number(limit, 2)}</td>'
            f'<td data-label="Verdict">{badge(str(check.get("verdict")))}</td></tr>'
        )
    return (
        _table(
            "Self-checks of the computation",
            ("Check", "What it says", "Value", "Limit", "Verdict"),
            rows,
            (2, 3),
        )
        if rows
        else ""
    )


def peak_tables(summary: Summary) -> str:
    """Extremes of sensors, wheels, vehicles and supports with their times."""
    return "".join((_sensors(summary), _wheels(summary), _vehicles(summary), _reactions(summary)))


def _sensors(summary: Summary) -> str:
    rows = []
    for name, found in list((summary.get("sensors") or {}).items())[:_ROWS]:
        if not found:
            continue
        cells = [f"<td>{escape(name)}</td>"]
        cells += [
            _extreme(found.get(f"{quantity}_{end}_{unit}"), found.get(f"{quantity}_{end}_time_s"), factor)
            for quantity, unit, factor in (("displacement", "m", 1e3), ("acceleration", "m_per_s2", 1.0))
            for end in ("min", "max")
        ]
        rows.append(f"<tr>{''.join(cells)}</tr>")
    heads = ("Sensor", "Lowest [mm]", "Highest [mm]", "Lowest [m/s²]", "Highest [m/s²]")
    return _table("Extremes at the sensors", heads, rows, (1, 2, 3, 4)) if rows else ""


def _wheels(summary: Summary) -> str:
    forces = summary.get("contact_forces") or {}
    rows = []
    for key, words in (
        ("largest", "largest"),
        ("smallest", "smallest"),
        ("largest_on_structure", "largest on the structure"),
        ("smallest_on_structure", "smallest on the structure"),
        ("largest_ratio_to_static", "most added"),
        ("smallest_ratio_to_static", "most unloaded"),
    ):
        row = forces.get(key)
        if row:
            rows.append(
                f'<tr><td>{words}</td><td class="n">{_amount(row.get("force_N"), 1e-3)}</td>'
                f'<td class="n">{number(row["ratio_to_static"])}</td><td>{escape(str(row["contact"]))}</td>'
                f'<td class="n">{number(row["position_m"])}</td><td class="n">{number(row["time_s"])}</td></tr>'
            )
    heads = ("Contact force", "[kN]", "over static [-]", "Wheel", "at [m]", "at [s]")
    return _table("Extremes of the contact forces", heads, rows, (1, 2, 4, 5)) if rows else ""


def _vehicles(summary: Summary) -> str:
    rows = []
    for part, found in list((summary.get("vehicle_accelerations") or {}).items())[:_ROWS]:
        unit = _unit_text(str(found["unit"]))
        cells = "".join(
            _extreme(found[end], found[f"{end}_time_s"], 1.0)
            + f"<td>{escape(str(found[f'{end}_vehicle']))}</td>"
            for end in ("min", "max")
        )
        rows.append(f"<tr><td>{escape(part)} [{unit}]</td>{cells}</tr>")
    heads = ("Part", "Lowest", "Vehicle", "Highest", "Vehicle")
    return _table("Extremes of the vehicles' accelerations", heads, rows, (1, 3)) if rows else ""


def _reactions(summary: Summary) -> str:
    found = {
        name: row
        for name, row in (summary.get("support_reactions") or {}).items()
        if "min_N" in row or "min_N_m" in row
    }
    rows = []
    for name, row in list(found.items())[:_ROWS]:
        unit = "N" if "min_N" in row else "N_m"
        label = name if unit == "N" else f"{name} [kN m]"
        cells = "".join(_extreme(row[f"{end}_{unit}"], row[f"{end}_time_s"], 1e-3) for end in ("min", "max"))
        rows.append(f"<tr><td>{escape(label)}</td>{cells}</tr>")
    if len(found) > _ROWS:
        rows.append(f'<tr><td colspan="3">and {len(found) - _ROWS} more in summary.json</td></tr>')
    return (
        _table("Extremes of the support reactions", ("Support", "Lowest [kN]", "Highest [kN]"), rows, (1, 2))
        if rows
        else ""
    )


def _extreme(value: Any, time: Any, factor: float) -> str:
    if value is None:
        return '<td class="n">–</td>'
    exact = f' data-value="{value!r}"'
    return f'<td class="n"{exact}>{number(factor * value)} <span class="at">at {number(time)} s</span></td>'


def _table(caption: str, heads: Sequence[str], rows: Sequence[str], numeric: Sequence[int] = ()) -> str:
    top = "".join(
        f'<th scope="col"{" class=n" if i in numeric else ""}>{escape(head)}</th>'
        for i, head in enumerate(heads)
    )
    kind = ' class="cards-on-phone"' if rows and "data-label" in rows[0] else ""
    return (
        f'<div class="scroll" tabindex="0" role="region" aria-label="{escape(caption)}"><table{kind}><caption>{escape(caption)}'
        f"</caption><thead><tr>{top}</tr></thead><tbody>{''.join(rows)}</tbody></table></div>"
    )


def _amount(value: Any, factor: float, unit: str = "") -> str:
    """A value with its unit; a dash where there is none."""
    if not isinstance(value, (int, float)) or isinstance(value, bool):
        return "–"
    return f"{number(factor * value)} {unit}".rstrip()


def _unit_text(unit: str) -> str:
    return escape(shown_unit(unit)[1].replace("^2", "²").replace("^3", "³").replace("m_per_s2", "m/s²"))


def _place(verdict: Mapping[str, Any]) -> str:
    where, when = verdict.get("where"), verdict.get("when")
    words = []
    if where is not None:
        words.append(f"{number(where)} m" if isinstance(where, (int, float)) else escape(str(where)))
    if when is not None:
        words.append(f"{number(when)} s" if isinstance(when, (int, float)) else escape(str(when)))
    return ", ".join(words)
