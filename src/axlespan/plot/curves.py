"""Curves of one quantity: a few with names, or many as a band with those of interest on top."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from axlespan.io.thinning import band, thinned
from axlespan.plot.style import BAND, COLORS

FloatArray = npt.NDArray[np.float64]

# Histories with more points than this get finer lines.
_LONG = 6000

#: More curves than this become a band.
FEW = len(COLORS)


def draw(
    ax: Axes,
    x: FloatArray,
    table: FloatArray,
    names: Sequence[str],
    what: str,
    *,
    base: FloatArray | float = 0.0,
    ends: bool = True,
) -> None:
    """Draw the columns of ``table`` (n, n_curve) over ``x`` (n,).

    Parameters
    ----------
    what : str
        What there are many of, for the legend: ``"wheels"``.
    base : float or array (n_curve,)
        Values at rest, from which the largest curve is told.
    ends : bool
        Of many, whether the first and the last are worth a curve.
    """
    sizes = np.abs(table - base).max(axis=0)
    if len(names) > FEW:
        at, low, high = band(x, table)
        ax.fill_between(at, low, high, color=BAND, linewidth=0.0, label=f"all {len(names)} {what}")
    width = 0.8 if len(x) > _LONG else 1.2
    for color, (column, label) in zip(COLORS, shown(names, sizes, ends=ends), strict=False):
        curve = ax.plot(*thinned(x, table[:, column]), color=color, linewidth=width, label=label)
        # small ones on top of large ones
        curve[0].set_zorder(2.0 + 0.9 / (1.0 + sizes[column] / (sizes.max() or 1.0)))


def shown(names: Sequence[str], sizes: FloatArray, *, ends: bool = True) -> list[tuple[int, str]]:
    """Columns to draw and their labels: all of a few; of many the first, the last and the largest."""
    if len(names) <= FEW:
        return list(enumerate(names))
    roles: dict[int, str] = {0: "first", len(names) - 1: "last"} if ends else {}
    peak = int(sizes.argmax())
    if sizes[peak] > 0.0:
        roles[peak] = f"{roles[peak]}, largest" if peak in roles else "largest"
    return [(column, f"{names[column]} ({role})") for column, role in roles.items()]
