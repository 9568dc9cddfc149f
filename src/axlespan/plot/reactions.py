"""Support reactions over time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from axlespan.errors import InputError
from axlespan.interaction.result import Result
from axlespan.io.dof_units import is_rotation
from axlespan.io.thinning import thinned
from axlespan.plot.curves import FEW
from axlespan.plot.histories import inside
from axlespan.plot.style import COLORS, axes_or_new, finish

# A reaction so much smaller than the largest is none.
_NOTHING = 1e-9


def reactions(
    result: Result,
    supports: str | Sequence[str] | None = None,
    *,
    window: tuple[float, float] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw support reactions [kN] (moments [kN m]) over time, upward positive.

    Parameters
    ----------
    result : Result
    supports : str or sequence of str, optional
        At most six. When left out, the six largest forces that are not zero throughout.
    window : (float, float), optional
        Times shown [s].
    ax : Axes, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If a name is unknown, there is none, there are too many, or forces and moments are mixed.
    """
    names = [supports] if isinstance(supports, str) else list(supports or _largest(result))
    if not 1 <= len(names) <= FEW:
        raise InputError(f"must be one to {FEW} supports", field="supports", value=len(names))
    turning = {is_rotation(name) for name in names}
    if len(turning) > 1:
        raise InputError("must not mix forces and moments", field="supports", value=names)
    rows = inside(result.time, window)
    histories = {name: 1e-3 * result.at("support_reaction", name)[rows] for name in names}
    axes = axes_or_new(ax)
    for color, (name, history) in zip(COLORS, histories.items(), strict=False):
        axes.plot(*thinned(result.time[rows], history), color=color, label=name)
    unit = "kN m" if turning.pop() else "kN"
    left = sum(not is_rotation(name) for name in result.support) - len(names)
    label = "Support reaction" if supports is not None or left <= 0 else "Largest support reactions"
    return finish(axes, "Time [s]", f"{label} [{unit}]", window)


def _largest(result: Result) -> list[str]:
    """The largest forces, in the order of the supports."""
    forces = [i for i, name in enumerate(result.support) if not is_rotation(name)]
    peaks = np.abs(result.support_reaction[:, forces]).max(axis=0, initial=0.0)
    order = np.argsort(-peaks, kind="stable")[:FEW]
    kept = [k for k in sorted(order.tolist()) if peaks[k] > _NOTHING * peaks.max()]
    return [result.support[forces[k]] for k in kept]
