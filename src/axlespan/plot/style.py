"""How figures look: sizes, colors, axes and legends."""

from __future__ import annotations

import math
from typing import Any

import matplotlib as mpl
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

#: Okabe and Ito's colors, told apart by color-blind readers too (Nature Methods 8, 441, 2011).
COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00")

#: Bands of many curves, and lines that only guide the eye.
BAND, GUIDE = "#C9D6E2", "#666666"

#: Of a figure with one pair of axes [inch], and of its image.
SIZE, DPI = (7.2, 3.6), 150

# Characters that a row of a legend holds, of which each entry's sample takes six.
_LEGEND = 110

# Curves whose range is so small a share of their size are shown as constant, and so are values below the
# noise (of mm, m/s², kN): computed motions carry rounding errors of some 1e-12.
_FLAT, _NOISE = 1e-6, 1e-9

_RC: Any = {
    "font.size": 10.0,
    "axes.grid": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.xmargin": 0.0,
    "axes.ymargin": 0.06,
    "axes.formatter.useoffset": False,
    "axes.unicode_minus": True,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.2,
    "legend.frameon": False,
    "legend.fontsize": 9.0,
}


def new_figure(size: tuple[float, float] = SIZE) -> tuple[Figure, Axes]:
    """A figure that no window shows and nobody has to close."""
    with mpl.rc_context(_RC):
        figure = Figure(figsize=size, layout="constrained")
        return figure, figure.subplots()


def axes_or_new(ax: Axes | None, size: tuple[float, float] = SIZE) -> Axes:
    """The axes given, or those of a new pyplot figure of a size [inch]."""
    if ax is not None:
        return ax
    with mpl.rc_context(_RC):
        _, fresh = plt.subplots(figsize=size, layout="constrained")
        return fresh


def figure_of(ax: Axes) -> Figure:
    """The figure that axes belong to."""
    found = ax.figure
    return found if isinstance(found, Figure) else found.figure


def finish(ax: Axes, xlabel: str, ylabel: str, window: tuple[float, float] | None = None) -> Axes:
    """Label axes, and put the legend above them, where it hides nothing."""
    ax.set_xlabel(xlabel)
    ax.set_ylabel(ylabel)
    if window is not None:
        ax.set_xlim(window)
    _calm(ax)
    handles, labels = ax.get_legend_handles_labels()
    if handles:
        columns = max(1, min(len(labels), _LEGEND // (max(map(len, labels)) + 6)))
        ax.legend(
            handles,
            labels,
            loc="lower left",
            bbox_to_anchor=(0.0, 1.0),
            borderaxespad=0.2,
            ncols=columns,
            frameon=False,
            fontsize=9.0,
            handlelength=1.6,
            columnspacing=1.4,
        )
    return ax


def _calm(ax: Axes) -> None:
    """Plain numbers, and no limits so close that rounding errors look like motion."""
    ax.ticklabel_format(axis="y", style="plain")
    low, high = ax.dataLim.intervaly
    size = max(abs(low), abs(high))
    if not math.isfinite(size) or high - low > _FLAT * size > _NOISE:
        return
    middle = 0.5 * (low + high)
    reach = max(0.05 * size, _NOISE / _FLAT)
    ax.set_ylim(middle - reach, middle + reach)
