"""Contact forces over time or over the position of the wheels."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from axlespan.errors import InputError
from axlespan.interaction.result import Result
from axlespan.io.peaks import static_forces
from axlespan.io.thinning import band_over, thinned
from axlespan.plot.curves import FEW, draw, shown
from axlespan.plot.style import BAND, COLORS, GUIDE, axes_or_new, finish

FloatArray = npt.NDArray[np.float64]

# Where no wheel's force differs from its static one by more than this share, there is nothing to see.
_QUIET = 1e-6

# Share of the window left free on both sides of what happens.
_MARGIN = 0.2


def contact_force(
    result: Result,
    over: str = "time",
    contacts: str | Sequence[str] | None = None,
    *,
    relative: bool = False,
    span: tuple[float, float] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw contact forces on the vehicles [kN], compression positive.

    Parameters
    ----------
    result : Result
    over : {"time", "position"}
        Abscissa; position is that of each wheel.
    contacts : str or sequence of str, optional
        All when left out. More than six become a band, with the first, the last and the one with the
        largest change on top.
    relative : bool, optional
        Over the static force [-].
    span : (float, float), optional
        Ends of the structure [m], for a figure over positions: shown, and the window follows it. When left
        out, the window is where forces differ from the static ones.
    ax : Axes, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If a name is unknown, or there is no contact.
    """
    if over not in ("time", "position"):
        raise InputError("must be time or position", field="over", value=over)
    names = [contacts] if isinstance(contacts, str) else list(contacts or result.contact)
    if not names:
        raise InputError("has no contact to draw", field="result")
    columns = [_column(result, name) for name in names]
    static = static_forces(result)[columns]
    scale = np.full(len(columns), 1e-3)
    if relative:
        scale = np.divide(1.0, static, out=np.zeros(len(columns)), where=static != 0.0)
    table = result.contact_force[:, columns] * scale
    axes = axes_or_new(ax)
    ylabel = "Contact force over static force [-]" if relative else "Contact force [kN]"
    labels = [f"wheel {name}" for name in names]
    if over == "time":
        draw(axes, result.time, table, labels, "wheels", base=static * scale)
        _static_lines(axes, static * scale)
        return finish(axes, "Time [s]", ylabel)
    positions = result.contact_position[:, columns]
    window = _window(positions, table, static * scale, span)
    _draw_over_positions(axes, positions, table, static * scale, labels, window)
    _static_lines(axes, static * scale)
    _span(axes, span)
    return finish(axes, "Position of the wheel [m]", ylabel, window)


def _column(result: Result, name: str) -> int:
    result.at("contact_force", name)  # says what is known if the name is not
    return result.contact.index(name)


def _draw_over_positions(
    ax: Axes,
    positions: FloatArray,
    table: FloatArray,
    static: FloatArray,
    names: Sequence[str],
    window: tuple[float, float],
) -> None:
    if len(names) > FEW:
        at, low, high = band_over(positions, table, window)
        ax.fill_between(at, low, high, color=BAND, linewidth=0.0, label=f"all {len(names)} wheels")
    inside = (positions >= window[0]) & (positions <= window[1])
    sizes = np.where(inside, np.abs(table - static), 0.0).max(axis=0)
    for color, (column, label) in zip(COLORS, shown(names, sizes), strict=False):
        rows = inside[:, column]
        curve = thinned(positions[rows, column], table[rows, column])
        ax.plot(*curve, color=color, label=label, zorder=2.1)


def _window(
    positions: FloatArray, table: FloatArray, static: FloatArray, span: tuple[float, float] | None
) -> tuple[float, float]:
    """Positions to show: the structure, or where something happens, and a margin."""
    if span is None:
        busy = np.abs(table - static) > _QUIET * np.abs(static).max(initial=0.0)
        seen = positions[busy] if busy.any() else positions
        span = float(seen.min()), float(seen.max())
    length = span[1] - span[0] or 1.0
    begin = max(span[0] - _MARGIN * length, float(positions.min()))
    end = min(span[1] + _MARGIN * length, float(positions.max()))
    return (begin, end) if begin < end else (span[0] - _MARGIN * length, span[1] + _MARGIN * length)


def _span(ax: Axes, span: tuple[float, float] | None) -> None:
    for position in span or ():
        ax.axvline(position, color=GUIDE, linewidth=0.8, linestyle=(0, (1, 2)), zorder=1.5)
    if span is not None:
        ax.plot([], [], color=GUIDE, linewidth=0.8, linestyle=(0, (1, 2)), label="ends of the structure")


def _static_lines(ax: Axes, static: FloatArray) -> None:
    """Static forces as guides, if there are few different ones."""
    levels = np.unique(static.round(9))
    if len(levels) > 3:
        return
    for i, level in enumerate(levels):
        label = "static" if i == 0 else None
        ax.axhline(level, color=GUIDE, linewidth=0.9, linestyle=(0, (4, 3)), label=label, zorder=2.0)
