"""Piers, legs and struts: beams of a plane model that do not lie along the deck."""

from __future__ import annotations

import numpy as np

from axlespan.io.drawing import Drawing

# A beam is a leg if it is steeper than this and longer [m]; so many are drawn.
_STEEP, _LONG, _MOST = 0.2, 0.3, 400


def legs(drawing: Drawing | None) -> list[list[float]]:
    """Rows x, z, x, z of both ends [m], heights over the deck; none of models in space.

    Pieces of one leg stay apart: they are drawn one by one.
    """
    beams = None if drawing is None else drawing.arrays.get("beams")
    if drawing is None or beams is None or not len(beams) or np.ptp(drawing.arrays["points"][:, 1]) > 0.0:
        return []
    level = deck_height(drawing)
    ends = drawing.arrays["points"][beams][:, :, [0, 2]]
    run, rise = np.abs(ends[:, 1] - ends[:, 0]).T
    steep = (rise > _STEEP * run) & (np.hypot(run, rise) > _LONG)
    chosen = ends[steep][:_MOST]
    chosen[:, :, 1] -= level
    rows: list[list[float]] = np.round(chosen.reshape(-1, 4), 4).tolist()
    return rows


def deck_height(drawing: Drawing) -> float:
    """Height of the deck's line where it begins [m]."""
    lines = drawing.content.get("lines", {})
    rows = lines.get(drawing.content.get("deck") or "") or next(iter(lines.values()), [[0.0] * 4])
    return float(rows[0][3])
