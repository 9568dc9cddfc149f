"""Springs of a structure that only push: ballast under sleepers, bearings that may lift."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from axlespan.bridges.spring_laws import springs_of
from axlespan.errors import InputError
from axlespan.model.nonlinear import UnilateralSpring
from axlespan.model.system import SpringRows
from axlespan.running.structure import Structure

FloatArray = npt.NDArray[np.float64]


def with_unilateral_springs(
    structure: Structure,
    group: str,
    *,
    hanging: Sequence[tuple[float, float]] = (),
    component: str = "z",
) -> Structure:
    """The same structure, with the springs and dashpots of a group that can push only.

    They push with the stiffness and damping that they have, Rayleigh damping included, and the matrices stay; where
    they part, a run takes all of that off.
    Under its own weight the structure rests on those that it presses, and displacements count from there.

    Parameters
    ----------
    structure : Structure
        Of a finite element model.
    group : str
        Name of a group of springs between a lower and an upper node: ``"ballast"``.
    hanging : sequence of (position, gap)
        Places along x [m] where a spring stands off by a gap [m] while nothing is loaded; each means the nearest
        spring.
    component : str
        Direction in which they push.

    Raises
    ------
    InputError
        If there is no such group, it has no such component, or a gap is not positive or named twice for a spring.
    """
    if any(springs.name == group for springs in structure.system.nonlinear):
        raise InputError("follow a law already", field="group", value=group)
    rows: list[SpringRows] = []
    for found in springs_of(structure, group, component, dashpots=False):
        law = UnilateralSpring(found.stiffness, found.drag)
        gaps = _gaps(found.places, hanging)
        rows.append(SpringRows(group, law, found.rows, gaps, law.stiffness, law.damping))
    system = replace(structure.system, nonlinear=(*structure.system.nonlinear, *rows))
    return replace(structure, system=system)


def _gaps(places: FloatArray, hanging: Sequence[tuple[float, float]]) -> FloatArray:
    """Gaps (n_spring,) [m]."""
    gaps = np.zeros(len(places))
    for number, (position, gap) in enumerate(hanging):
        if not 0.0 < gap < 1.0:
            raise InputError(
                "must be positive and below 1 m", field=f"hanging_sleepers.{number}.gap", value=gap
            )
        if not places.min() - 1.0 <= position <= places.max() + 1.0:
            raise InputError(
                f"must lie on the track, between {places.min():g} and {places.max():g} m",
                field=f"hanging_sleepers.{number}.at",
                value=position,
            )
        place = places[int(np.argmin(np.abs(places - position)))]
        nearest_one = np.flatnonzero(np.abs(places - place) < 1e-9)
        if np.any(gaps[nearest_one] > 0.0):
            raise InputError("names a sleeper twice", field=f"hanging_sleepers.{number}.at", value=position)
        gaps[nearest_one] = gap
    return gaps
