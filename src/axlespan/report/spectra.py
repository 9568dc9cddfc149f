r"""Amplitude spectra of chosen histories.

A history without its mean, under a Hann window $w$, has the amplitudes
$A_k = 2 |\sum_j w_j u_j e^{-2\pi i jk/n}| / \sum_j w_j$:
a steady harmonic motion shows its amplitude. The power spectral density is
$A_k^2 / (2 \Delta f N_e)$ with the noise bandwidth $N_e = n \sum w^2 / (\sum w)^2$ of the window
(Harris, Proc. IEEE 66, 51, 1978).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.report.pack import Pack
from axlespan.report.panels import Group, groups, names_of
from axlespan.report.stored import Stored
from axlespan.report.thinning import chosen_columns, rows_for
from axlespan.report.units import shown_unit

FloatArray = npt.NDArray[np.float64]

_SHOWN = ("acceleration", "displacement", "contact", "body-a")
_MOST = 6
_FEW = 16  # times that are too few for a spectrum


def amplitudes(values: FloatArray, time_step: float) -> tuple[FloatArray, FloatArray, float]:
    """Frequencies [Hz], amplitudes, and the noise bandwidth of the window in bins [-].

    Examples
    --------
    >>> t = np.arange(1000) * 0.01
    >>> f, a, _ = amplitudes(3.0 * np.sin(2.0 * np.pi * 5.0 * t), 0.01)
    >>> float(f[a.argmax()]), round(float(a.max()), 6)
    (5.0, 3.0)
    """
    n = len(values)
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(n) / n)
    weight = window.sum()
    bandwidth = float(n * (window**2).sum() / weight**2)
    spectrum = np.abs(np.fft.rfft((values - values.mean()) * window)) * 2.0 / weight
    return np.asarray(np.fft.rfftfreq(n, time_step), dtype=np.float64), np.asarray(spectrum), bandwidth


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
    sizes = [float(np.nanstd(stored.column(group.variable, i))) for i in group.columns]
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


def _busy(f: FloatArray, curves: list[FloatArray]) -> float:
    """Frequency [Hz] above which nothing exceeds a hundredth of the largest amplitude."""
    last = 1
    for curve in curves:
        last = max(last, int(np.flatnonzero(curve >= 0.01 * curve.max()).max()))
    return float(min(f[-1], 1.25 * f[last] + 2.0 * f[1]))
