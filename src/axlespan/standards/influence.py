"""Influence lines of a structure's deflection, by one static solve for each point."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.interaction.line_points import deck_line
from axlespan.linalg.factor import factorize
from axlespan.running.structure import Structure
from axlespan.standards.lm71 import InfluenceLine

FloatArray = npt.NDArray[np.float64]

_SPACING = 0.1  # of the ordinates [m]
_MOST = 4001


def deflection_lines(structure: Structure, points: FloatArray) -> list[InfluenceLine]:
    """Upward deflection of the deck at points (n,) [m] for a downward force of 1 N on the first running line.

    By Maxwell's theorem the columns of K⁻¹ at the points hold the deflection for every place of the force; supports
    stand still.
    """
    system, track, deck = structure.system, structure.line(), deck_line(structure)
    free = system.free
    rows = deck.rows(np.asarray(points, float), system.size)[:, free].toarray()
    columns = factorize(system.partition.K_FF).solve(np.ascontiguousarray(rows.T))
    count = min(_MOST, max(201, int(np.ceil((track.stop - track.start) / _SPACING)) + 1))
    places = np.unique(np.concatenate([np.linspace(track.start, track.stop, count), track.breaks]))
    effect = -np.asarray(track.rows(places, system.size)[:, free] @ columns)
    return [InfluenceLine(places, effect[:, i]) for i in range(effect.shape[1])]
