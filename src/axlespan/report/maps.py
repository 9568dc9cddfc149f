"""Space-time maps of deflection and acceleration along the line."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.report.pack import Pack
from axlespan.report.stored import Stored

FloatArray = npt.NDArray[np.float64]

# Columns of a map: times.
_TIMES = 420

_MAPS = (
    ("line_displacement", "Deflection along the line over time", 1e3, "mm"),
    ("line_acceleration", "Acceleration along the line over time", 1.0, "m/s²"),
)


def maps(stored: Stored, pack: Pack) -> list[dict[str, Any]]:
    """The maps of a result; none where motions along the line were not kept."""
    positions = stored.numbers("line_position")
    if len(positions) < 2 or len(stored.time) < 3:
        return []
    found = []
    for name, title, factor, unit in _MAPS:
        if not stored.has(name):
            continue
        try:
            times, table = _thinned(stored, name)
        except (OSError, RuntimeError, ValueError) as error:
            stored.miss(name, error)
            continue
        found.append(
            {
                "key": name,
                "title": title,
                "unit": unit,
                "t": pack.add(times, "f8"),
                "x": pack.add(positions, "f8"),
                "values": pack.quantized(factor * table),
                "wheels": _tracks(stored, pack, times),
            }
        )
    return found


def _thinned(stored: Stored, name: str) -> tuple[FloatArray, FloatArray]:
    """Times and, in each bin of time and at each point, the value that is largest in size."""
    n, count = len(stored.time), stored.file[name].shape[1] if stored.file is not None else 0
    if n <= _TIMES:
        return stored.time, stored.rows(name, np.arange(n))
    edges = np.linspace(0, n, _TIMES + 1).astype(np.int64)
    table = np.empty((_TIMES, count))
    for i in range(count):
        values = stored.column(name, i)
        low, high = np.minimum.reduceat(values, edges[:-1]), np.maximum.reduceat(values, edges[:-1])
        table[:, i] = np.where(np.abs(low) > np.abs(high), low, high)
    return 0.5 * (stored.time[edges[:-1]] + stored.time[edges[1:] - 1]), table


def _tracks(stored: Stored, pack: Pack, times: FloatArray) -> list[dict[str, Any]]:
    """Where the first and the last wheel are."""
    if not stored.has("contact_position"):
        return []
    wheels = dict.fromkeys((0, len(stored.names("contact")) - 1))
    found = []
    for i in wheels:
        path = np.interp(times, stored.time, stored.column("contact_position", i))
        found.append({"name": f"wheel {stored.names('contact')[i]}", "a": pack.add(path)})
    return found
