"""Where along the deck a run records."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from axlespan.errors import InputError
from axlespan.running.path import PolynomialPath
from axlespan.running.structure import DECK_LINE, Structure

_MOST = 10_000


def deck_line(structure: Structure) -> PolynomialPath:
    """The line called ``deck``, or else the first one.

    On a bridge with track wheels run on the rails; criteria for the bridge ask for the deck below them.
    """
    return structure.lines.get(DECK_LINE) or structure.line()


def line_positions(structure: Structure, points: int | Sequence[float] | None) -> tuple[float, ...]:
    """Positions [m] along the deck at which it is recorded.

    Parameters
    ----------
    structure : Structure
    points : int, sequence of float or None
        So many positions evenly from end to end, or the positions themselves; none for None and 0.

    Raises
    ------
    InputError
        If the number is not a whole one, or positions do not increase or are off the line.
    """
    if points is None:
        return ()
    path = deck_line(structure)
    if isinstance(points, (int, float, np.integer)):
        if isinstance(points, bool) or int(points) != points or not (points == 0 or 2 <= points <= _MOST):
            rule = f"must be 0 or a whole number from 2 to {_MOST}"
            raise InputError(rule, field="line_points", value=points, fix="Write for example 41")
        return tuple(np.linspace(path.start, path.stop, int(points)).tolist())
    places = np.asarray(points, dtype=float)
    if places.ndim != 1 or not np.all(np.isfinite(places)) or np.any(np.diff(places) <= 0.0):
        raise InputError("must be positions that increase", field="line_points", value=list(points))
    miss = 1e-9 * (path.stop - path.start)
    if len(places) and not (path.start - miss <= places[0] and places[-1] <= path.stop + miss):
        rule = f"must lie on the structure, between {path.start:g} and {path.stop:g} m"
        raise InputError(rule, field="line_points", value=[float(places[0]), float(places[-1])])
    return tuple(np.clip(places, path.start, path.stop).tolist())
