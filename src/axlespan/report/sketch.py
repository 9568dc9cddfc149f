"""Bridge and train from the side, to scale, as SVG."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np

from axlespan.io.drawing import Drawing
from axlespan.io.train_shapes import WHEEL_RADIUS, Unit
from axlespan.report.legs import deck_height, legs
from axlespan.report.units import plain

_WIDTH = 1000.0  # of the drawing, in its own units
_ROUND = (1.0, 2.0, 5.0)


def sketch(drawing: Drawing | None, units: Sequence[Unit], ends: tuple[float, float] | None) -> str:
    """An SVG drawing; empty if the geometry is not known.

    Parameters
    ----------
    drawing : Drawing or None
    units : sequence of Unit
        The vehicles.
    ends : (float, float) or None
        Of the running line [m].
    """
    if ends is None or ends[1] <= ends[0]:
        return ""
    begin, end = ends
    units = [unit for unit in units if unit.train == 0]
    length = end - begin
    head = begin + 0.82 * length
    train = max((unit.rear for unit in units), default=0.0)
    left = min(begin - 0.12 * length, max(head - train - 0.05 * length, begin - 0.9 * length))
    right = end + 0.12 * length
    scale = _WIDTH / (right - left)
    depth = _depth(drawing, length)
    props = legs(drawing)
    lowest = min((min(z0, z1) for _, z0, _, z1 in props), default=0.0)
    below = max(0.09 * length, depth + 0.05 * length, 0.05 * length - lowest)
    shown = [unit for unit in units if head - unit.front > left and head - unit.rear < right]
    above = max(4.6 if any(unit.boxes for unit in shown) else 2.4, 0.05 * length)

    def x(value: float) -> float:
        return (value - left) * scale

    def y(value: float) -> float:
        return (above - value) * scale

    height = (above + below) * scale + 54.0
    parts = [_ground(x, y, left, right, begin, end, scale), _deck(x, y, begin, end, depth)]
    parts += [
        f'<path class="sk-leg" d="M{x(a):.1f} {y(b):.1f}L{x(c):.1f} {y(d):.1f}"/>' for a, b, c, d in props
    ]
    parts += [
        _support(x, y, item, max(depth, item["below"]), scale) for item in _vertical(drawing, begin, end)
    ]
    parts += [_vehicle(x, y, unit, head, scale) for unit in shown]
    parts.append(_dimensions(x, (above + below) * scale + 14.0, _stations(drawing, begin, end)))
    parts.append(_scale_bar(right - left, scale, height))
    hidden = len(units) - len(shown)
    note = ""
    if hidden > 0:
        below_text = f'x="{_WIDTH - 6:g}" y="{height - 8:.1f}"'
        note = f'<text class="sk-note" {below_text}>{hidden} more vehicles follow; the train is {plain(train)} m long</text>'
    title = f"Side view to scale: structure of {plain(length)} m with the train on it"
    return (
        f'<svg class="sketch" viewBox="0 0 {_WIDTH:g} {height:.1f}" role="img" aria-label="{escape(title)}" '
        f'xmlns="http://www.w3.org/2000/svg"><title>{escape(title)}</title>{"".join(parts)}{note}</svg>'
    )


def _depth(drawing: Drawing | None, length: float) -> float:
    """Depth of the structure: that of its mesh, or a symbolic one of a line [m]."""
    points = None if drawing is None else drawing.arrays.get("points")
    if drawing is not None and drawing.content.get("space") and points is not None:
        return float(np.ptp(points[:, 2])) or 0.3
    return float(np.clip(0.05 * length, 0.3, 2.2))


def _ground(x: Any, y: Any, left: float, right: float, begin: float, end: float, scale: float) -> str:
    drop = 0.6 * scale
    pieces = []
    for a, b in ((left, begin), (end, right)):
        pieces.append(
            f'<path class="sk-earth" d="M{x(a):.1f} {y(0):.1f}H{x(b):.1f}v{drop:.1f}H{x(a):.1f}z"/>'
            f'<path class="sk-rail" d="M{x(a):.1f} {y(0):.1f}H{x(b):.1f}"/>'
        )
    return "".join(pieces)


def _deck(x: Any, y: Any, begin: float, end: float, depth: float) -> str:
    return (
        f'<rect class="sk-deck" x="{x(begin):.1f}" y="{y(0):.1f}" width="{x(end) - x(begin):.1f}" '
        f'height="{y(-depth) - y(0):.1f}"/><path class="sk-rail" d="M{x(begin):.1f} {y(0):.1f}H{x(end):.1f}"/>'
    )


def _vertical(drawing: Drawing | None, begin: float, end: float) -> list[dict[str, Any]]:
    """Supports that carry vertically, one for each place along the line."""
    found: dict[float, dict[str, Any]] = {}
    if drawing is None:
        return []
    for item in drawing.content.get("supports", []):
        point = item.get("point")
        if point is None or "z" not in item["components"]:
            continue
        place = round(float(point[0]), 3)
        known = found.setdefault(place, {"x": place, "fixed": False, "below": 0.0})
        if not drawing.content.get("space"):
            known["below"] = max(known["below"], deck_height(drawing) - float(point[2]))
        known["fixed"] = known["fixed"] or "x" in item["components"]
    inside = [item for item in found.values() if begin - 1.0 <= item["x"] <= end + 1.0]
    return sorted(inside, key=lambda item: float(item["x"]))[:40]


def _support(x: Any, y: Any, item: dict[str, Any], depth: float, scale: float) -> str:
    center, top, size = x(item["x"]), y(-depth), min(max(0.9 * scale, 9.0), 16.0)
    shape = f"M{center:.1f} {top:.1f}l{-0.6 * size:.1f} {size:.1f}h{1.2 * size:.1f}z"
    roller = ""
    if not item["fixed"]:
        roller = (
            f'<path class="sk-line" d="M{center - 0.8 * size:.1f} {top + 1.3 * size:.1f}h{1.6 * size:.1f}"/>'
        )
    return f'<path class="sk-support" d="{shape}"/>{roller}'


def _vehicle(x: Any, y: Any, unit: Unit, head: float, scale: float) -> str:
    pieces = []
    for box in unit.boxes:
        begin, width = x(head - box.center - 0.5 * box.length), box.length * scale
        kind = "sk-bogie" if box.low else "sk-body"
        round_ = 0.12 * (box.top - box.bottom) * scale
        pieces.append(
            f'<rect class="{kind}" x="{begin:.1f}" y="{y(box.top):.1f}" width="{width:.1f}" '
            f'height="{(box.top - box.bottom) * scale:.1f}" rx="{round_:.1f}"/>'
        )
    for _, behind, *_ in unit.wheels:
        center = x(head - behind)
        radius = max(WHEEL_RADIUS * scale, 2.0)
        if not unit.boxes:
            top = y(2.2)
            pieces.append(
                f'<path class="sk-load" d="M{center:.1f} {top:.1f}V{y(0) - 2.0:.1f}m-4 -8l4 8l4 -8"/>'
            )
            continue
        low = min(box.bottom for box in unit.boxes)
        if low > 2.0 * WHEEL_RADIUS:  # a suspension between wheel and body
            pieces.append(f'<path class="sk-spring" d="M{center:.1f} {y(WHEEL_RADIUS):.1f}V{y(low):.1f}"/>')
        pieces.append(
            f'<circle class="sk-wheel" cx="{center:.1f}" cy="{y(WHEEL_RADIUS):.1f}" r="{radius:.1f}"/>'
        )
    return f"<g><title>vehicle {unit.number}: {escape(unit.name)}</title>{''.join(pieces)}</g>"


def _stations(drawing: Drawing | None, begin: float, end: float) -> list[float]:
    places = [begin, *(item["x"] for item in _vertical(drawing, begin, end)), end]
    return [a for i, a in enumerate(sorted(places)) if i == 0 or a - sorted(places)[i - 1] > 1e-3]


def _dimensions(x: Any, level: float, stations: Sequence[float]) -> str:
    pieces = []
    for a, b in itertools.pairwise(stations):
        pieces.append(
            f'<path class="sk-line" d="M{x(a):.1f} {level:.1f}H{x(b):.1f}M{x(a):.1f} {level - 5:.1f}v10'
            f'M{x(b):.1f} {level - 5:.1f}v10"/>'
        )
        if x(b) - x(a) > 45.0:
            middle = 0.5 * (x(a) + x(b))
            pieces.append(
                f'<text class="sk-text" x="{middle:.1f}" y="{level - 4:.1f}">{plain(b - a)} m</text>'
            )
    return "".join(pieces)


def _scale_bar(width: float, scale: float, height: float) -> str:
    rough = 0.12 * width
    power = 10.0 ** np.floor(np.log10(rough))
    size = float(max(step * power for step in _ROUND if step * power <= rough))
    level = height - 12.0
    return (
        f'<path class="sk-line" d="M6 {level:.1f}h{size * scale:.1f}M6 {level - 5:.1f}v10M{6 + size * scale:.1f} '
        f'{level - 5:.1f}v10"/><text class="sk-text sk-start" x="{14 + size * scale:.1f}" y="{level + 4:.1f}">'
        f"{plain(size)} m, same scale in both directions</text>"
    )
