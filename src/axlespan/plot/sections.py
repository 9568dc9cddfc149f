"""Section forces over time, and envelopes along the line."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from axlespan.errors import InputError
from axlespan.interaction.result import Result
from axlespan.plot.curves import draw
from axlespan.plot.histories import inside
from axlespan.plot.style import BAND, COLORS, GUIDE, axes_or_new, finish

# quantity -> scale and label of the axis
_SHOWN = {
    "moment": (1e-3, "Bending moment [kN m]"),
    "shear": (1e-3, "Shear force [kN]"),
    "normal": (1e-3, "Normal force [kN]"),
    "torsion": (1e-3, "Torsional moment [kN m]"),
    "deflection": (1e3, "Deflection [mm]"),
    "acceleration": (1.0, "Acceleration [m/s²]"),
}
_FORCES = ("moment", "shear", "normal", "torsion")


def section_force(
    result: Result,
    quantity: str = "moment",
    names: Sequence[str] | None = None,
    *,
    window: tuple[float, float] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw a section force at sensors over time.

    Parameters
    ----------
    result : Result
        With ``section_forces``.
    quantity : {"moment", "shear", "normal", "torsion"}
    names : sequence of str, optional
        Sensors; all that have section forces when left out.
    window : (float, float), optional
        Times shown [s].
    ax : Axes, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If the quantity or a name is unknown, or the result has no section forces.
    """
    if quantity not in _FORCES:
        raise InputError(f"must be one of {', '.join(_FORCES)}", field="quantity", value=quantity)
    chosen = list(result.section if names is None else names)
    if not chosen:
        fix = "Ask for them: section_forces=['midspan']"
        raise InputError("has no section forces", field="result", fix=fix)
    scale, label = _SHOWN[quantity]
    table = np.column_stack([result.at(f"section_{quantity}", name) for name in chosen])
    axes, rows = axes_or_new(ax), inside(result.time, window)
    draw(axes, result.time[rows], scale * table[rows], chosen, "sensors", ends=False)
    return finish(axes, "Time [s]", label, window)


def envelope(result: Result, quantity: str = "moment", *, ax: Axes | None = None) -> Axes:
    """Draw the extremes of a quantity along the line, over all steps; moments downward, as engineers do.

    Parameters
    ----------
    result : Result
        With this envelope.
    quantity : str
        "moment", "shear", "normal", "torsion", "deflection" or "acceleration".
    ax : Axes, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If the result has no such envelope.
    """
    if result.envelopes is None:
        fix = f"Ask for them: envelopes=['{quantity}']"
        raise InputError("has no envelopes", field="result", fix=fix)
    table, (scale, label) = result.envelopes.of(quantity), _SHOWN[quantity]
    axes, s = axes_or_new(ax), result.envelopes.position
    axes.axhline(0.0, color=GUIDE, linewidth=0.8)
    axes.fill_between(s, scale * table.smallest, scale * table.largest, color=BAND, linewidth=0.0)
    axes.plot(s, scale * table.largest, color=COLORS[0], label="largest")
    axes.plot(s, scale * table.smallest, color=COLORS[1], label="smallest")
    finish(axes, "Position along the line [m]", label)
    if quantity == "moment":
        axes.invert_yaxis()
    return axes
