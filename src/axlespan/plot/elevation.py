"""Structure and train from the side, to scale."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, FancyBboxPatch, Rectangle

from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing
from axlespan.io.drawing import Drawing, drawing_of
from axlespan.io.train_shapes import WHEEL_RADIUS, Unit, units_of
from axlespan.plot.style import COLORS, GUIDE, SIZE, axes_or_new

_DECK, _EARTH, _BODY, _BOGIE = "#B9C3CC", "#D9D2C5", "#3F6FA3", "#56636F"

# Share of the structure's length shown before and after it; where the head stands on it.
_MARGIN, _HEAD = 0.15, 0.85


def elevation(
    crossing: Crossing,
    *,
    head: float | None = None,
    window: tuple[float, float] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw the structure and its first train from the side, to scale.

    Bodies are as long as their wheels say; the depth of a structure that is a line is a symbol.

    Parameters
    ----------
    crossing : Crossing
    head : float, optional
        Position of the first wheel [m]; most of the way over the structure when left out.
    window : (float, float), optional
        Positions shown [m]; the structure and a little on both sides when left out.
    ax : Axes, optional
        Drawn into; a new pyplot figure, as high as it needs, when left out.

    Raises
    ------
    InputError
        If the window is empty.
    """
    drawing = drawing_of(crossing)
    rows = drawing.content["lines"][drawing.content["deck"] or next(iter(drawing.content["lines"]))]
    begin, end = float(rows[0][0]), float(rows[-1][0])
    length = end - begin
    left, right = window or (begin - _MARGIN * length, end + _MARGIN * length)
    if not right > left:
        raise InputError("must hold positions that increase", field="window", value=window)
    way = int(drawing.content["trains"][0]["direction"])
    if head is None:
        head = begin + (_HEAD if way > 0 else 1.0 - _HEAD) * length
    depth = _depth(drawing, length)
    top, bottom = max(4.8, 0.02 * length), -depth - max(0.03 * length, 1.2)
    height = float(np.clip(SIZE[0] * (top - bottom) / (right - left), 0.5, 4.0))
    axes = axes_or_new(ax, (SIZE[0], height + 0.75))
    _ground(axes, (left, begin, end, right), depth)
    _deck(axes, drawing, begin, end, depth)
    for unit in units_of(drawing.content):
        if unit.train == 0:
            _vehicle(axes, unit, head, way)
    axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal", yticks=[], xlabel="Position [m]")
    axes.grid(visible=False)
    axes.spines[["left", "right", "top"]].set_visible(False)
    return axes


def _depth(drawing: Drawing, length: float) -> float:
    points = drawing.arrays.get("points")
    if drawing.content.get("space") and points is not None:
        return float(np.ptp(points[:, 2])) or 0.3
    return float(np.clip(0.05 * length, 0.3, 2.2))


def _ground(ax: Axes, places: tuple[float, float, float, float], depth: float) -> None:
    left, begin, end, right = places
    for a, b in ((left, begin), (end, right)):
        ax.add_patch(Rectangle((a, -depth), b - a, depth, facecolor=_EARTH, edgecolor="none"))
    ax.plot([left, right], [0.0, 0.0], color="black", linewidth=1.2)


def _deck(ax: Axes, drawing: Drawing, begin: float, end: float, depth: float) -> None:
    ax.add_patch(
        Rectangle((begin, -depth), end - begin, depth, facecolor=_DECK, edgecolor="black", linewidth=0.8)
    )
    places = {
        round(float(item["point"][0]), 3)
        for item in drawing.content["supports"]
        if item["point"] and "z" in item["components"]
    }
    inside = [x for x in places if begin - 1e-3 <= x <= end + 1e-3]
    ax.plot(
        inside, [-depth] * len(inside), linestyle="", marker=6, markersize=8, color="black", clip_on=False
    )


def _vehicle(ax: Axes, unit: Unit, head: float, way: int) -> None:
    for box in sorted(unit.boxes, key=lambda item: not item.low):
        corner = (head - way * box.center - 0.5 * box.length, box.bottom)
        ax.add_patch(
            FancyBboxPatch(
                corner,
                box.length,
                box.top - box.bottom,
                boxstyle=f"round,pad=0,rounding_size={0.1 * (box.top - box.bottom):g}",
                facecolor=_BOGIE if box.low else _BODY,
                edgecolor="black",
                linewidth=0.6,
            )
        )
    low = min((box.bottom for box in unit.boxes), default=0.0)
    for _, behind, *_ in unit.wheels:
        x = head - way * behind
        if not unit.boxes:
            _arrow(ax, x)
            continue
        if low > 2.0 * WHEEL_RADIUS:  # a suspension between wheel and body
            ax.plot([x, x], [WHEEL_RADIUS, low], color=GUIDE, linewidth=1.2)
        ax.add_patch(
            Circle((x, WHEEL_RADIUS), WHEEL_RADIUS, facecolor="white", edgecolor="black", linewidth=0.8)
        )


def _arrow(ax: Axes, x: float) -> None:
    style: dict[str, Any] = {
        "arrowstyle": "-|>",
        "color": COLORS[1],
        "linewidth": 1.2,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    ax.annotate("", (x, 0.0), (x, 2.6), arrowprops=style, annotation_clip=True)
