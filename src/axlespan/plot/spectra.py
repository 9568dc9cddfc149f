"""Which frequencies are in a history."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from axlespan.errors import InputError
from axlespan.interaction.result import Result
from axlespan.io.amplitudes import amplitudes
from axlespan.plot.histories import history_table, inside
from axlespan.plot.style import COLORS, axes_or_new, finish

# Times that are too few; share of the largest amplitude below which nothing is shown.
_FEW, _QUIET = 16, 0.01


def spectrum(
    result: Result,
    names: str | Sequence[str] | None = None,
    quantity: str = "acceleration",
    *,
    window: tuple[float, float] | None = None,
    highest: float | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw amplitudes of histories over frequency, under a Hann window: a steady tone shows its amplitude.

    Parameters
    ----------
    result : Result
        At even times.
    names : str or sequence of str, optional
        Up to six sensors or vehicle d.o.f., or contacts for contact forces; all sensors when left out.
    quantity : {"acceleration", "velocity", "displacement", "contact_force"}
    window : (float, float), optional
        Times that count [s]; all when left out.
    highest : float, optional
        Last frequency shown [Hz]; where amplitudes fall below a hundredth of the largest when left out.
    ax : Axes, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If a name or the quantity is unknown, there are too many, or times are few or uneven.
    """
    chosen, table, unit = history_table(result, quantity, names)
    if len(chosen) > len(COLORS):
        raise InputError(f"must be at most {len(COLORS)} names", field="names", value=len(chosen))
    rows = inside(result.time, window)
    time = result.time[rows]
    steps = np.diff(time)
    if len(time) < _FEW or np.ptp(steps) > 1e-6 * steps.mean() + 1e-9:
        rule = f"must hold {_FEW} times or more, evenly spaced"
        raise InputError(
            rule, field="result", value=len(time), fix="Use a longer window, or an even time step"
        )
    frequencies, found, _ = amplitudes(table[rows], float(steps.mean()))
    axes = axes_or_new(ax)
    for color, name, curve in zip(COLORS, chosen, found.T, strict=False):
        axes.plot(frequencies, curve, color=color, label=name)
    if highest is None:
        busy = np.flatnonzero((found >= _QUIET * found.max(axis=0)).any(axis=1))
        highest = float(min(frequencies[-1], 1.25 * frequencies[busy[-1]] + frequencies[2]))
    label = quantity.replace("_", " ").capitalize()
    return finish(axes, "Frequency [Hz]", f"{label}, amplitude [{unit}]", (0.0, highest))
