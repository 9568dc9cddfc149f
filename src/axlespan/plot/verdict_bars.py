"""Verdicts of the rules as bars."""

from __future__ import annotations

import math
from collections.abc import Iterable

from matplotlib.axes import Axes

from axlespan.errors import InputError
from axlespan.plot.style import BAND, COLORS, SIZE, axes_or_new
from axlespan.standards.verdict import FAIL, PASS, Verdict

_COLORS = {PASS: COLORS[2], FAIL: COLORS[1]}

# How units of verdicts are shown: factor and unit.
_UNITS = {"m": (1e3, "mm"), "N": (1e-3, "kN"), "m/s^2": (1.0, "m/s²"), "-": (1.0, "")}

# Longest bar: utilizations beyond are cut, with their number beside them.
_LONGEST = 2.0


def verdict_bars(verdicts: Iterable[Verdict], *, ax: Axes | None = None) -> Axes:
    """Draw how much of each limit is used, the largest on top; 100 % is the limit.

    Values without a limit and what was not assessed have no bar; how many they are stands below.

    Parameters
    ----------
    verdicts : iterable of Verdict
        As from :func:`axlespan.standards.assess`.
    ax : Axes, optional
        Drawn into; a new pyplot figure, as high as it needs, when left out.

    Raises
    ------
    InputError
        If no verdict has a limit.
    """
    everything = list(verdicts)
    shown = [(v.utilization, v) for v in everything if v.utilization is not None]
    if not shown:
        fix = "Look at reason and outcome of each verdict"
        raise InputError("have no limit to draw", field="verdicts", value=len(everything), fix=fix)
    shown.sort(key=lambda pair: pair[0])
    axes = axes_or_new(ax, (SIZE[0], 1.3 + 0.34 * len(shown)))
    longest = min(max([1.0] + [used for used, _ in shown if math.isfinite(used)]), _LONGEST)
    for row, (used, verdict) in enumerate(shown):
        length = min(used, longest)
        axes.barh(row, 100.0 * longest, color=BAND, height=0.62, alpha=0.35)
        axes.barh(row, 100.0 * length, color=_COLORS.get(verdict.outcome, COLORS[0]), height=0.62)
        axes.annotate(
            _said(used, verdict),
            (100.0 * longest, row),
            xytext=(6, 0),
            textcoords="offset points",
            va="center",
            fontsize=8.5,
        )
    axes.set_yticks(range(len(shown)), [verdict.check.replace("_", " ") for _, verdict in shown])
    axes.axvline(100.0, color="black", linewidth=1.0, linestyle=(0, (4, 3)))
    axes.grid(axis="y", visible=False)
    label = "Share of the limit [%]"
    hidden = len(everything) - len(shown)
    if hidden:
        label += f"   ({hidden} without limit or not assessed)"
    axes.set_xlabel(label)
    axes.set_xlim(0.0, 100.0 * longest)
    axes.set_ylim(-0.6, len(shown) - 0.4)
    return axes


def _said(used: float, verdict: Verdict) -> str:
    """Value and limit in words: ``109 %: 3.81, limit 3.5 m/s²``."""
    assert verdict.value is not None  # there is no utilization without
    assert verdict.limit is not None
    share = f"{100.0 * used:.0f} %" if math.isfinite(used) else "beyond"
    least = "at least " if verdict.at_least else ""
    scale, unit = _UNITS.get(verdict.unit, (1.0, verdict.unit))
    return f"{share}: {scale * verdict.value:.3g}, limit {least}{scale * verdict.limit:.3g} {unit}".rstrip()
