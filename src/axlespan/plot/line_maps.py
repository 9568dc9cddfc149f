"""What the whole line does over time: maps of position and time."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from axlespan.errors import InputError
from axlespan.interaction.result import Result
from axlespan.plot.histories import inside
from axlespan.plot.style import axes_or_new, finish

FloatArray = npt.NDArray[np.float64]

# quantity -> array of the result, scale, label
_SHOWN = {
    "displacement": ("line_displacement", 1e3, "Displacement [mm]"),
    "acceleration": ("line_acceleration", 1.0, "Acceleration [m/s²]"),
}

# Rows of times in a map; more are thinned, extremes kept.
_TIMES = 800


def line_map(
    result: Result,
    quantity: str = "displacement",
    *,
    window: tuple[float, float] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw a quantity of the line as a map: position across, time upward; first and last wheel as lines.

    Parameters
    ----------
    result : Result
        With motions along the line: ``line_points`` of :func:`axlespan.simulate`.
    quantity : {"displacement", "acceleration"}
        Vertical, upward positive [mm, m/s²].
    window : (float, float), optional
        Times shown [s].
    ax : Axes, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If the quantity is unknown, the line was not recorded, or no time lies in the window.
    """
    if quantity not in _SHOWN:
        raise InputError(f"must be one of {', '.join(_SHOWN)}", field="quantity", value=quantity)
    if len(result.line_position) < 2:
        fix = "Ask for them: line_points=41, or line: 41 under output"
        raise InputError("has no motions along the line", field="result", fix=fix)
    name, scale, label = _SHOWN[quantity]
    rows = inside(result.time, window)
    time, table = _thinned(result.time[rows], scale * getattr(result, name)[rows])
    size = float(np.abs(table).max(initial=0.0)) or 1.0
    axes = axes_or_new(ax)
    shades = axes.pcolormesh(
        result.line_position,
        time,
        table,
        cmap="RdBu",
        vmin=-size,
        vmax=size,
        shading="nearest",
        rasterized=True,
    )
    axes.figure.colorbar(shades, ax=axes, label=label, pad=0.02)
    _wheels(axes, result, rows)
    axes.grid(visible=False)
    finish(axes, "Position along the line [m]", "Time [s]")
    axes.set_xlim(float(result.line_position[0]), float(result.line_position[-1]))
    axes.set_ylim(*(window or (float(time[0]), float(time[-1]))))
    return axes


def _thinned(time: FloatArray, table: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Times and, of each bin of them, the value that is largest in size at each point."""
    if len(time) <= _TIMES:
        return time, table
    begins = np.linspace(0, len(time), _TIMES + 1).astype(np.int64)[:-1]
    low, high = np.minimum.reduceat(table, begins), np.maximum.reduceat(table, begins)
    return time[begins], np.where(-low > high, low, high)


def _wheels(ax: Axes, result: Result, rows: slice) -> None:
    """Where the first and the last wheel are."""
    ends = dict.fromkeys((0, len(result.contact) - 1)) if result.contact else {}
    for column, style in zip(ends, ("-", "--"), strict=False):
        ax.plot(
            result.contact_position[rows, column],
            result.time[rows],
            color="black",
            linewidth=0.8,
            linestyle=style,
            label=f"wheel {result.contact[column]}",
        )
