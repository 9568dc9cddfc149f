"""The same quantity from several sources."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from axlespan.errors import InputError
from axlespan.io.thinning import thinned
from axlespan.plot.style import COLORS, axes_or_new, finish

_DASHES = ("-", (0, (5, 2)), (0, (1, 1.2)), (0, (7, 2, 1, 2)), (0, (3, 1.5)), (0, (9, 2)))


def comparison(
    time: npt.ArrayLike,
    curves: Mapping[str, npt.ArrayLike],
    *,
    ylabel: str = "",
    xlabel: str = "Time [s]",
    window: tuple[float, float] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw curves over each other, the first one broad and whole, the others dashed on top.

    Parameters
    ----------
    time : array (n,)
        [s]
    curves : mapping of name to array (n,)
        At most six.
    ylabel, xlabel : str, optional
        With units.
    window : (float, float), optional
        Shown of the abscissa.
    ax : Axes, optional
        Drawn into; a new pyplot figure when left out.

    Raises
    ------
    InputError
        If a curve does not have one value for each time, or there are none or too many.
    """
    x = np.asarray(time, dtype=np.float64)
    if not 1 <= len(curves) <= len(COLORS):
        rule = f"must be one to {len(COLORS)} curves"
        raise InputError(rule, field="curves", value=len(curves))
    tables = {name: np.asarray(given, dtype=np.float64) for name, given in curves.items()}
    for name, values in tables.items():
        if values.shape != x.shape:
            rule = f"must have one value for each time, {x.shape[0]} in all"
            raise InputError(rule, field=f"curves.{name}", value=values.shape)
    axes = axes_or_new(ax)
    for i, (name, values) in enumerate(tables.items()):
        width = 2.2 if i == 0 and len(curves) > 1 else 1.1
        axes.plot(*thinned(x, values), color=COLORS[i], linestyle=_DASHES[i], linewidth=width, label=name)
    return finish(axes, xlabel, ylabel, window)
