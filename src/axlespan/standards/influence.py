"""Influence lines of a structure's deflection and moment, by one static solve for each point."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.elements.beam_sections import QUANTITIES
from axlespan.interaction.line_points import deck_line
from axlespan.linalg.factor import factorize
from axlespan.running.sections import BeamSections
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
    rows = deck_line(structure).rows(np.asarray(points, float), structure.system.size)
    places = _places(structure, points)
    return _lines(places, _by_displacements(structure, rows, places))


def moment_lines(structure: Structure, points: FloatArray) -> list[InfluenceLine]:
    """Bending moment of the deck's beams at points (n,) [m], sagging positive, for a downward force of 1 N.

    Raises
    ------
    InputError
        If the deck's line does not run on beams.
    """
    name = structure.sensor_line
    segments, xi = structure.line(name).locate(np.asarray(points, float))
    sections = BeamSections.at(structure, segments, xi, name, wanted="assessment")
    of_moment = slice(QUANTITIES.index("moment"), None, len(QUANTITIES))
    places = _places(structure, points)
    effect = _by_displacements(structure, sp.csr_array(sections.rows()[0][of_moment]), places)
    own = sections.influence()  # of a force in the beam of the section itself
    if own is not None:
        effect = effect + own.rows(places, sections.n_row)[:, of_moment].toarray()
    return _lines(places, effect)


def _places(structure: Structure, points: FloatArray) -> FloatArray:
    """Places of the force [m]: close enough, and where the effect may have kinks."""
    track = structure.line()
    count = min(_MOST, max(201, int(np.ceil((track.stop - track.start) / _SPACING)) + 1))
    inside = np.clip(np.asarray(points, float), track.start, track.stop)
    return np.unique(np.concatenate([np.linspace(track.start, track.stop, count), track.breaks, inside]))


def _by_displacements(structure: Structure, rows: sp.csr_array, places: FloatArray) -> FloatArray:
    """What rows (n, n_dof) read from the displacements under the force, by its places (n_place, n)."""
    free = structure.system.free
    wanted = np.ascontiguousarray(rows[:, free].toarray().T)
    columns = factorize(structure.system.partition.K_FF).solve(wanted)
    force = structure.line().rows(places, structure.system.size)[:, free]
    return -np.asarray(force @ columns)


def _lines(places: FloatArray, effect: FloatArray) -> list[InfluenceLine]:
    return [InfluenceLine(places, effect[:, i]) for i in range(effect.shape[1])]
