"""The summary of a run as lines of text, for a terminal, a pipe or a log."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.text import Text

from axlespan.io.summary_verdicts import verdict_lines

Summary = Mapping[str, Any]

# Rows shown of each table; summary.json has them all.
_ROWS = 8

# Width of the first column of the tables, so that they stand below each other.
_FIRST = 24

_STYLES = {
    "pass": "green",
    "attention": "bold yellow",
    "not checked": "dim",
    "not assessed": "dim",
    "failed": "bold red",
    "FAIL": "bold red",
}


def print_summary(summary: Summary, console: Console | None = None) -> None:
    """Print a summary; colors only where the console shows them."""
    out = console or Console()
    for line in summary_lines(summary):
        text = Text(line)
        if line and not line.startswith(" "):
            text.stylize("bold")
        word = line[2:15].strip()
        if line.startswith("  ") and word in _STYLES:
            text.stylize(_STYLES[word], 2, 2 + len(word))
        out.print(text, soft_wrap=True, highlight=False)


def summary_lines(summary: Summary) -> list[str]:
    """A summary, as :func:`axlespan.io.summary.summary` makes it, in lines of plain text."""
    parts = (
        _head,
        _sensors,
        _forces,
        _tension,
        _flights,
        _vehicles,
        _reactions,
        verdict_lines,
        _checks,
        _notes,
        _files,
    )
    lines: list[str] = []
    for part in parts:
        block = part(summary)
        if block and lines:
            lines.append("")
        lines += block
    return lines


# --- blocks --------------------------------------------------------------------------------------


def _head(summary: Summary) -> list[str]:
    run, outcome = summary["run"], summary["outcome"]
    title = run["title"] or "Crossing"
    length = None if run["structure"] is None else run["structure_to_m"] - run["structure_from_m"]
    lines = [f"{title}: {outcome['code']}"]
    if outcome["code"] != "completed":
        lines += [f"  {'failed':<13}{outcome['message']}"]
        lines += [f"  {'remedy':<13}{outcome['remedy']}"] if outcome.get("remedy") else []
    rows = [
        ("structure", _joined(run["structure"], _with(length, "{:.6g} m"), _dofs(summary))),
        ("train", _joined(run["train"], _wheels(run))),
        ("speed", _speed(run)),
        *(
            ("and", _joined(other["train"], _wheels(other), _speed(other)))
            for other in run.get("other_trains") or ()
        ),
        ("time", _time(run)),
        ("computed", _computed(summary["computation"])),
    ]
    return lines + [f"  {name:<13}{text}" for name, text in rows if text]


def _sensors(summary: Summary) -> list[str]:
    known = {name: found for name, found in summary["sensors"].items() if found}
    rows = [
        [name, *_pair(found, "displacement", "m", 1e3), *_pair(found, "acceleration", "m_per_s2", 1.0)]
        for name, found in known.items()
    ]
    header = ["Sensors"]
    for unit in ("mm", "m/s2"):
        header += [f"min [{unit}]", "at [s]", f"max [{unit}]", "at [s]"]
    sizes = [max(abs(found[f"displacement_{end}_m"]) for end in ("min", "max")) for found in known.values()]
    return _table(header, rows, "sensors with less", sizes)


def _pair(found: Mapping[str, Any], quantity: str, unit: str, scale: float) -> list[str]:
    cells = []
    for end in ("min", "max"):
        cells.append(_number(scale * found[f"{quantity}_{end}_{unit}"], 4))
        cells.append(f"{found[f'{quantity}_{end}_time_s']:.4g}")
    return cells


def _forces(summary: Summary) -> list[str]:
    forces, run = summary["contact_forces"], summary["run"]
    if not forces:
        return []
    top, bottom = forces["largest_ratio_to_static"], forces["smallest_ratio_to_static"]
    if max(abs(end["ratio_to_static"] - 1.0) for end in (top, bottom)) < 1e-9:
        span = _between(forces["smallest"]["force_N"], forces["largest"]["force_N"])
        return ["Contact forces", f"  {'constant':<13}{span} kN: the static ones"]
    rows = [("largest", forces["largest"]), ("smallest", forces["smallest"])]
    for end in ("largest", "smallest"):
        on = forces[f"{end}_on_structure"]
        if on is not None and on != forces[end]:
            rows.append((f"{end} on structure", on))
    if (top["contact"], top["time_s"]) != (rows[0][1]["contact"], rows[0][1]["time_s"]):
        rows.append(("most added", top))
    if (bottom["contact"], bottom["time_s"]) != (rows[1][1]["contact"], rows[1][1]["time_s"]):
        rows.append(("most unloaded", bottom))
    header = ["Contact forces", "[kN]", "of static", "wheel", "at [m]", "at [s]", ""]
    lines = _table(header, [[name, *_wheel_cells(row, run)] for name, row in rows], "wheels")
    if forces["largest_unloading"] <= 1.0:
        lines.append(f"  unloading at most {100.0 * forces['largest_unloading']:.1f} % of the static force")
    else:
        lines.append("  unloading complete: see tension")
    missed = [
        f"{end} {forces[f'{end}_over_all_steps_N'] / 1e3:.3f} kN"
        for end in ("largest", "smallest")
        if abs(forces[f"{end}_over_all_steps_N"] - forces[end]["force_N"])
        > 1e-6 * abs(forces[end]["force_N"])
    ]
    return lines + ([f"  over all steps, kept or not: {', '.join(missed)}"] if missed else [])


def _wheel_cells(row: Mapping[str, Any], run: Mapping[str, Any]) -> list[str]:
    position = row["position_m"]
    off = run["structure"] is not None and not run["structure_from_m"] <= position <= run["structure_to_m"]
    return [
        _number(row["force_N"] / 1e3, 3),
        _number(row["ratio_to_static"], 4),
        row["contact"],
        f"{position:.3f}",
        f"{row['time_s']:.4g}",
        "off the structure" if off else "",
    ]


def _tension(summary: Summary) -> list[str]:
    tension = summary["tension"]
    if not tension["episodes"]:
        return []
    shown = tension["first"][:_ROWS]
    lines = [f"Tension: {tension['episodes']} episodes" if tension["episodes"] > 1 else "Tension: 1 episode"]
    lines += [
        f"  wheel {row['contact']:<7}{row['start_s']:.5g} to {row['stop_s']:.5g} s, "
        f"up to {row['largest_tension_N'] / 1e3:.3f} kN at {row['position_m']:.3f} m"
        for row in shown
    ]
    left = tension["episodes"] - len(shown)
    return lines + ([f"  and {left} more"] if left else [])


def _flights(summary: Summary) -> list[str]:
    flights = summary.get("flights")
    if not flights or not flights["count"]:
        return []
    shown = flights["longest"][:_ROWS]
    count = flights["count"]
    title = f"Wheels in the air: {count} flights, the longest" if count > 1 else "Wheels in the air: 1 flight"
    lines = [title if count <= len(shown) else f"{title} {len(shown)}"]
    for row in shown:
        landing = row["closing_speed_m_per_s"]
        end = "does not land" if landing is None else f"lands at {landing:.4g} m/s"
        lines.append(
            f"  wheel {row['contact']:<7}{row['start_s']:.5g} to {row['stop_s']:.5g} s, "
            f"{row['start_position_m']:.3f} to {row['stop_position_m']:.3f} m, "
            f"up to {1e3 * row['largest_gap_m']:.4g} mm, {end}"
        )
    return lines


def _vehicles(summary: Summary) -> list[str]:
    rows = [
        [
            f"{part} [{row['unit'].replace('^', '')}]",
            _number(row["min"], 4),
            row["min_vehicle"],
            f"{row['min_time_s']:.4g}",
            _number(row["max"], 4),
            row["max_vehicle"],
            f"{row['max_time_s']:.4g}",
        ]
        for part, row in summary["vehicle_accelerations"].items()
    ]
    header = ["Vehicle accelerations", "min", "vehicle", "at [s]", "max", "vehicle", "at [s]"]
    return _table(header, rows, "parts")


def _reactions(summary: Summary) -> list[str]:
    rows, sizes = [], []
    for name, found in summary["support_reactions"].items():
        unit = "N" if "min_N" in found else "N_m"
        low, high = found[f"min_{unit}"] / 1e3, found[f"max_{unit}"] / 1e3
        label = name if unit == "N" else f"{name} [kN m]"
        times = [f"{found[f'{end}_time_s']:.4g}" for end in ("min", "max")]
        rows.append([label, _number(low, 3), times[0], _number(high, 3), times[1]])
        sizes.append(max(abs(low), abs(high)))
    header = ["Support reactions", "min [kN]", "at [s]", "max [kN]", "at [s]"]
    return _table(header, rows, "supports with less", sizes)


def _checks(summary: Summary) -> list[str]:
    lines = [f"Checks: {summary['verdict']}"]
    for check in summary["checks"]:
        value, numbers = check["value"], ""
        if isinstance(value, float):
            numbers = f"{value:.1e}, limit {check['limit']:.0e}"
        elif check["name"] == "tension" and value:
            numbers = f"{value} episodes"
        lines.append(f"  {check['verdict']:<13}{check['name']:<15}{numbers:<22}{check['meaning']}")
        if check.get("remedy"):
            lines.append(f"  {'':<13}{check['remedy']}")
    return lines


def _notes(summary: Summary) -> list[str]:
    return ["Notes", *(f"  {note}" for note in summary["notes"])] if summary["notes"] else []


def _files(summary: Summary) -> list[str]:
    return ["Files", *(f"  {file}" for file in summary["files"])] if summary["files"] else []


# --- words ---------------------------------------------------------------------------------------


def _table(
    header: Sequence[str], rows: Sequence[Sequence[str]], what: str, sizes: Sequence[float] = ()
) -> list[str]:
    """Columns flush right, the first one flush left; no more than a few rows, the largest ones."""
    if not rows:
        return []
    order = sorted(range(len(rows)), key=lambda i: -sizes[i]) if sizes else range(len(rows))
    shown = [rows[i] for i in sorted(order[:_ROWS])]
    first = max(_FIRST, len(header[0]), *(len(row[0]) + 2 for row in shown))
    widths = [max(len(row[i]) for row in [header, *shown]) + 2 for i in range(1, len(header))]

    def line(name: str, cells: Sequence[str]) -> str:
        text = "".join(cell.rjust(width) for cell, width in zip(cells, widths, strict=True))
        return (name.ljust(first) + text).rstrip()

    lines = [line(header[0], header[1:]), *(line(f"  {row[0]}", row[1:]) for row in shown)]
    left = len(rows) - len(shown)
    return lines + ([f"  and {left} more {what}"] if left else [])


def _dofs(summary: Summary) -> str:
    return _with(summary["computation"].get("structure_dofs"), "{} d.o.f.")


def _wheels(run: Mapping[str, Any]) -> str:
    count = run.get("wheels", run.get("contacts")) - sum(o["wheels"] for o in run.get("other_trains") or ())
    return f"{count} wheel" if count == 1 else f"{count} wheels"


def _speed(run: Mapping[str, Any]) -> str:
    first, last = run["speed_start_m_per_s"], run["speed_end_m_per_s"]
    if first is None:
        return ""
    if last is None or last == first:
        return f"{3.6 * first:.5g} km/h ({first:.5g} m/s)"
    return f"from {3.6 * first:.5g} to {3.6 * last:.5g} km/h"


def _time(run: Mapping[str, Any]) -> str:
    if run["time_step_s"] is None or run["steps"] is None:
        return f"{run['simulated_s']:.6g} s computed"
    done = run["completed_steps"]
    steps = f"{run['steps']} steps" if done in (None, run["steps"]) else f"{done} of {run['steps']} steps"
    parts = [f"{steps} of {1e3 * run['time_step_s']:g} ms, to {run['simulated_s']:.6g} s"]
    if run["alpha"] is not None:
        parts.append(f"alpha {run['alpha']:g}, beta {run['beta']:g}, gamma {run['gamma']:g}")
    return "; ".join(parts)


def _computed(computation: Mapping[str, Any]) -> str:
    wall, rate = computation.get("wall_time_s"), computation.get("steps_per_s")
    threads = computation.get("threads")
    parts = [
        _with(computation.get("coupling"), "{} method"),
        _with(computation.get("solver"), "{} factorization"),
        _with(threads if threads and threads > 1 else None, "{} threads"),
        _with(computation.get("iterations"), "{} iterations"),
        _with(computation.get("factorizations"), "{} factorizations"),
        _with(computation.get("cut_steps") or None, "{} steps cut"),
        _with(wall, "{:.3g} s"),
        _with(rate, "{:.0f} steps/s"),
    ]
    return _joined(*parts)


def _between(low: float, high: float) -> str:
    ends = f"{low / 1e3:.3f}", f"{high / 1e3:.3f}"
    return ends[0] if ends[0] == ends[1] else " to ".join(ends)


def _number(value: float, decimals: int) -> str:
    """Fixed decimals for most values, fewer for huge ones, and no minus before a zero."""
    text = f"{value:.{decimals}f}" if abs(value) < 1e5 else f"{value:.5g}"
    return text.removeprefix("-") if not text.strip("-0.") else text


def _with(value: Any, form: str) -> str:
    return "" if value is None else form.format(value)


def _joined(*parts: str) -> str:
    return ", ".join(part for part in parts if part)
