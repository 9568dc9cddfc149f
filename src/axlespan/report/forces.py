"""Contact forces over the position of the wheels."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.io.thinning import band_over
from axlespan.report.pack import Pack
from axlespan.report.stored import Stored
from axlespan.report.thinning import chosen_columns, rows_for

FloatArray = npt.NDArray[np.float64]

_MOST, _AT_FIRST = 12, 4
_MARGIN = 0.25  # of the structure's length, shown before and after it


def forces_over_position(
    stored: Stored, pack: Pack, ends: tuple[float, float] | None
) -> dict[str, Any] | None:
    """The plot of contact forces over positions; None where wheels stand or nothing is known."""
    if not (stored.has("contact_force") and stored.has("contact_position")):
        return None
    names = stored.names("contact")
    first, last = stored.rows("contact_position", np.array([0, len(stored.time) - 1]))
    if not np.any(last != first):
        return None
    window = _window(ends, float(first.min()), float(last.max()))
    static = [
        float((stored.content("checks").get("static_contact_force") or {}).get(name) or 0.0) for name in names
    ]
    changes = (stored.column("contact_force", i) - static[i] for i in range(len(names)))
    sizes = [float(np.nanmax(np.abs(change), initial=0.0)) for change in changes]
    kept = chosen_columns(sizes, _MOST)
    shown = set(chosen_columns([sizes[i] for i in kept], _AT_FIRST))
    series = []
    for place, i in enumerate(kept):
        x, force = stored.column("contact_position", i), stored.column("contact_force", i)
        inside = (x >= window[0]) & (x <= window[1])
        if np.count_nonzero(inside) < 2:
            continue
        x, force = x[inside], 1e-3 * force[inside]
        rows = rows_for(len(x), [0] * 4, partial(_same, force))  # a quarter of a full plot each
        series.append(
            {
                "name": f"wheel {names[i]}",
                "x": pack.add(x[rows], "f8"),
                "a": pack.add(force[rows]),
                "on": place in shown,
            }
        )
    if not series:
        return None
    content: dict[str, Any] = {
        "key": "force-position",
        "title": "Contact force over the position of the wheel",
        "unit": "kN",
        "series": series,
        "window": window,
        "ends": ends,
        "static": sorted({round(1e-3 * value, 6) for value in static if value})[:3],
        "note": f"{len(series)} of {len(names)} wheels are on this page." if len(series) < len(names) else "",
    }
    if len(names) > 2 and len(stored.time) * len(names) <= 4_000_000:
        rows = np.arange(len(stored.time))
        positions, table = (stored.rows(name, rows) for name in ("contact_position", "contact_force"))
        at, low, high = band_over(positions, 1e-3 * table, window, 500)
        content["band"] = {"x": pack.add(at, "f8"), "low": pack.add(low), "high": pack.add(high)}
    return content


def _same(values: FloatArray, column: int) -> FloatArray:
    return values


def _window(ends: tuple[float, float] | None, low: float, high: float) -> tuple[float, float]:
    if ends is None:
        return low, high
    margin = _MARGIN * (ends[1] - ends[0])
    return max(ends[0] - margin, low), min(ends[1] + margin, high)
