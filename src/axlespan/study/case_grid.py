"""Decks of girders and cross beams in space, right or skew."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from axlespan.study.case_damping import StructuralDamping
from axlespan.study.case_elements import OwnElements
from axlespan.study.case_laws import NonlinearSprings
from axlespan.study.case_support import Bearing
from axlespan.study.case_track import Laid
from axlespan.study.check_lists import Several
from axlespan.study.checks import Measured, Part
from axlespan.study.quantities import (
    Angle,
    Area,
    Elements,
    MassPerLength,
    Modulus,
    PoissonRatio,
    SecondMoment,
    SpanLength,
)
from axlespan.units import LENGTH


class GridSection(Part):
    """Section of the girders or cross beams of a grid."""

    second_moment: SecondMoment
    """Second moment of area for vertical bending."""
    torsion_constant: Annotated[SecondMoment, Field(examples=["0.02 m^4"])]
    """Torsion constant (St. Venant); of a slab strip b t^3 / 6."""
    area: Area
    """Area of the cross-section."""
    mass_per_length: MassPerLength | None = None
    """Mass with all that it carries for good; none when left out."""


class BeamGrid(Part):
    """A simply supported deck of girders and cross beams in space, right or skew."""

    kind: Literal["beam-grid"]
    length: SpanLength
    """Span of each girder."""
    girders: Annotated[
        tuple[float, ...], Several(Measured(LENGTH), "[-3 m, -1 m, 1 m, 3 m]", increasing=True)
    ]
    """Lateral positions of the girders, from right to left."""
    girder: GridSection
    """Section of each girder."""
    cross_beam: GridSection
    """Section of the cross beams."""
    end_beam: GridSection | None = None
    """Section of the cross beams over the bearings; as the others when left out."""
    youngs_modulus: Annotated[Modulus, Field(examples=["34 GPa"])]
    """Young's modulus."""
    poisson_ratio: PoissonRatio = 0.2
    """Poisson's ratio, for torsion."""
    elements: Annotated[Elements, Field(examples=["24"])]
    """Number of elements of a girder."""
    cross_beams: Elements | None = None
    """Number of spaces between cross beams, which divides the elements; one at each node when left out."""
    skew: Angle = 0.0
    """Angle of the bearing lines against the perpendicular of the axis: positive with the left side ahead."""
    track_centers: Annotated[tuple[float, ...] | None, Several(Measured(LENGTH), "[2.2 m, -2.2 m]")] = None
    """Lateral positions of tracks or lanes; their lines are main, left, right, then main2, left2, ..."""
    bearings: Bearing | None = None
    """Bearings at both ends of each girder; rigid when left out."""
    damping: StructuralDamping | None = None
    """Structural damping; none when left out."""
    nonlinear_springs: NonlinearSprings = ()
    """Springs and dashpots that follow a law: pads, ballast, supports. Own weight acts first then."""
    own_elements: OwnElements = ()
    """Nonlinear elements of one's own, written in Python. Own weight acts first then."""
    track: Laid = None
    """Track on the lines left and right of the first track, before and behind the deck."""
