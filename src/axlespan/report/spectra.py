"""Amplitude spectra of chosen histories; see :mod:`axlespan.io.amplitudes`."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.io.amplitudes import amplitudes
from axlespan.report.pack import Pack
from axlespan.report.panels import Group, groups, names_of
from axlespan.report.stored import Stored
from axlespan.report.thinning import chosen_columns, rows_for
from axlespan.report.units import shown_unit

FloatArray = npt.NDArray[np.float64]

_SHOWN = ("acceleration", "displacement", "contact", "body-a")
_MOST = 6
_FEW = 16  # times that are too few for a spectrum


def spectra(stored: Stored, pack: Pack) -> list[dict[str, Any]]:
    """Plots of spectra; none where times are few or uneven."""
    n = len(stored.time)
    if n < _FEW:
        return []
    step = float(stored.time[-1] - stored.time[0]) / (n - 1)
    if not step > 0.0 or np.abs(np.diff(stored.time) - step).max() > 1e-6 * step + 1e-9:
        return []
    found = []
    for group in groups(stored):
        if group.key in _SHOWN:
            panel = _spectrum(stored, pack, group, step)
            if panel is not None:
                found.append(panel)
    return found


def _spectrum(stored: Stored, pack: Pack, group: Group, step: float) -> dict[str, Any] | None:
    names = names_of(stored, group)
    factor, unit = shown_unit(group.unit)
    sizes = [_spread(stored.column(group.variable, i)) for i in group.columns]
    found = {}
    bandwidth, f = 1.5, np.zeros(0)
    for i in chosen_columns(sizes, _MOST):
        values = stored.column(group.variable, group.columns[i])
        if np.all(np.isfinite(values)) and np.ptp(values) > 1e-9 * np.abs(values).max():
            f, found[names[i]], bandwidth = amplitudes(factor * values, step)
    if not found:
        return None
    curves = list(found.values())
    rows = rows_for(len(f), range(len(curves)), lambda i: curves[i])
    return {
        "key": f"spectrum-{group.key}",
        "title": f"Spectrum: {group.title[0].lower()}{group.title[1:]}",
        "unit": unit,
        "x": pack.add(f[rows], "f8"),
        "series": [{"name": name, "a": pack.add(curve[rows]), "on": True} for name, curve in found.items()],
        "psd": 1.0 / (2.0 * float(f[1]) * bandwidth),
        "busy": _busy(f, curves),
    }


def _spread(values: FloatArray) -> float:
    finite = values[np.isfinite(values)]
    return float(finite.std()) if len(finite) else 0.0


def _busy(f: FloatArray, curves: list[FloatArray]) -> float:
    """Frequency [Hz] above which nothing exceeds a hundredth of the largest amplitude."""
    last = 1
    for curve in curves:
        last = max(last, int(np.flatnonzero(curve >= 0.01 * curve.max()).max()))
    return float(min(f[-1], 1.25 * f[last] + 2.0 * f[1]))
