"""The surface of shells and solids over time, for the animation in space."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.io.drawing import Drawing
from axlespan.report.pack import Pack
from axlespan.report.stored import Stored

FloatArray = npt.NDArray[np.float64]

# Triangles that a page carries, and values of the motion over all times.
_FACES, _VALUES = 60_000, 1_200_000


def space(stored: Stored, pack: Pack, drawing: Drawing | None) -> dict[str, Any] | None:
    """Points, triangles and their motion; None where the structure is a line or its surface is too large."""
    if drawing is None or not len(drawing.arrays.get("faces", ())):
        return None
    points, faces = drawing.arrays["points"], drawing.arrays["faces"]
    if len(faces) > _FACES:
        stored.notices.append(
            f"The surface has {len(faces)} triangles, more than a page can carry: the animation shows the line only. "
            "axlespan run --paraview writes the whole structure."
        )
        return None
    lines = drawing.content.get("lines", {})
    content: dict[str, Any] = {
        "points": pack.add(points),
        "faces": pack.add(faces, "i4"),
        "lines": lines,
        "main": next(iter(lines), ""),
        "motion": None,
        "stress": None,
    }
    motion = _motion(stored, pack, drawing)
    if motion is not None:
        content["motion"] = motion
        content["stress"] = _stress(stored, pack, drawing, motion["rows"])
        del motion["rows"]
    return content


def _motion(stored: Stored, pack: Pack, drawing: Drawing) -> dict[str, Any] | None:
    """Displacements of the surface's nodes (time, node, 3) at the times of the fields."""
    times = stored.numbers("field_time")
    if stored.file is None or len(times) < 2 or "field_displacement" not in stored.file:
        return None
    dofs = np.asarray(drawing.arrays["dofs"])
    count = int(np.clip(_VALUES // max(dofs.size, 1), 8, len(times)))
    rows = np.unique(np.linspace(0, len(times) - 1, count).round().astype(np.int64))
    data = stored.file["field_displacement"]
    table = np.zeros((len(rows), *dofs.shape))
    there = dofs >= 0
    for i, row in enumerate(rows.tolist()):
        table[i][there] = np.asarray(data[row], dtype=np.float64)[dofs[there]]
    sizes = np.linalg.norm(table, axis=2)
    return {
        "t": pack.add(times[rows], "f8"),
        "u": pack.quantized(table),
        "most": float(sizes.max(initial=0.0)),
        "rows": rows,
    }


def _stress(
    stored: Stored, pack: Pack, drawing: Drawing, rows: npt.NDArray[np.int64]
) -> dict[str, Any] | None:
    """Von Mises stresses (time, triangle) [MPa]."""
    table = drawing.arrays.get("face_stress")
    if table is None or table.ndim != 2 or len(table) <= int(rows.max(initial=0)):
        return None
    values = 1e-6 * np.asarray(table[rows], dtype=np.float64)
    return {**pack.quantized(values), "most": float(np.nanmax(values, initial=0.0)), "unit": "MPa"}
