"""Single defects of the surface: bumps, ramps, dipped joints, squats, potholes, settlements."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from axlespan import irregularity as profiles
from axlespan.errors import InputError
from axlespan.irregularity import Profile
from axlespan.study.checks import Measured, OneOf, Part
from axlespan.study.quantities import Length, Unevenness
from axlespan.units import LENGTH, RATIO, show

#: How deep a defect is; wheels fall into none of more than 0.2 m.
Depth = Annotated[float, Measured(LENGTH, above=0.0, believable=(1e-6, 0.2)), Field(examples=["5 mm"])]
#: How long a defect is along the line, from a squat to a settlement.
DefectLength = Annotated[
    float, Measured(LENGTH, above=0.0, believable=(5e-3, 500.0)), Field(examples=["1 m"])
]
Place = Annotated[Length, Field(examples=["12.5 m"])]


class BumpIrregularity(Part):
    """A single bump; with a negative height, a dip."""

    kind: Literal["bump"]
    at: Place
    """Position of its top."""
    height: Annotated[Unevenness, Field(examples=["10 mm"])]
    """Height of the top; negative for a dip."""
    length: DefectLength
    """Length from foot to foot."""
    shape: Annotated[str, OneOf(("haversine", "half-sine"))] = "haversine"
    """``haversine`` has no kinks, ``half-sine`` one at each foot."""

    @property
    def profile(self) -> Profile:
        """The profile."""
        shape: Literal["haversine", "half-sine"] = "half-sine" if self.shape == "half-sine" else "haversine"
        return profiles.Bump(self.at, self.height, self.length, shape)


class RampIrregularity(Part):
    """A rise from one level to another, which goes on behind it."""

    kind: Literal["ramp"]
    from_: Annotated[Length, Field(alias="from", examples=["-5 m"])]
    """Where it begins."""
    to: Annotated[Length, Field(examples=["0 m"])]
    """Where it ends."""
    height: Annotated[Unevenness, Field(examples=["10 mm"])]
    """Height behind it; negative for a ramp down."""
    shape: Annotated[str, OneOf(("linear", "cosine"))] = "linear"
    """``linear`` has a kink at both ends, ``cosine`` none."""

    @model_validator(mode="after")
    def _forward(self) -> Self:
        if self.to <= self.from_:
            fix = "Exchange the two, and the sign of height"
            raise InputError("must be greater than from", field="to", fix=fix)
        return self

    @property
    def profile(self) -> Profile:
        """The profile."""
        return profiles.Ramp(
            self.from_, self.to, self.height, "cosine" if self.shape == "cosine" else "linear"
        )


class DippedJointIrregularity(Part):
    """A dipped rail joint: two parabolas that meet in a kink."""

    kind: Literal["dipped-joint"]
    at: Place
    """Position of the joint."""
    depth: Depth
    """Depth at the joint."""
    length: DefectLength
    """Length from undisturbed rail to undisturbed rail."""

    @property
    def profile(self) -> Profile:
        """The profile."""
        return profiles.DippedJoint(self.at, self.depth, self.length)


class SquatIrregularity(Part):
    """A squat on the rail head: a short dip with two bottoms."""

    kind: Literal["squat"]
    at: Place
    """Position of its middle."""
    depth: Annotated[Depth, Field(examples=["0.5 mm"])]
    """Depth of the bottoms."""
    length: Annotated[DefectLength, Field(examples=["40 mm"])]
    """Length along the rail."""
    crest: Annotated[float, Measured(RATIO, at_least=0.0, at_most=1.0)] = 0.3
    """Height of the crest between the bottoms, as a share of the depth; 0 is one flat bottom."""

    @property
    def profile(self) -> Profile:
        """The profile."""
        return profiles.Squat(self.at, self.depth, self.length, self.crest)


class PotholeIrregularity(Part):
    """A hole in a road: a flat bottom between two rounded edges."""

    kind: Literal["pothole"]
    at: Place
    """Position of its middle."""
    depth: Annotated[Depth, Field(examples=["40 mm"])]
    """Depth of the bottom."""
    length: DefectLength
    """Length from rim to rim."""
    edge: Annotated[DefectLength, Field(examples=["100 mm"])]
    """Length of either edge, at most half of the length."""

    @model_validator(mode="after")
    def _bottom(self) -> Self:
        if 2.0 * self.edge > self.length:
            half = show(0.5 * self.length, LENGTH)
            raise InputError(f"must be at most {half}, half of the length", field="edge")
        return self

    @property
    def profile(self) -> Profile:
        """The profile."""
        return profiles.Pothole(self.at, self.depth, self.length, self.edge)


class SettlementIrregularity(Part):
    """A settlement trough in the shape of a bell."""

    kind: Literal["settlement"]
    at: Place
    """Position of the deepest point."""
    depth: Annotated[Depth, Field(examples=["20 mm"])]
    """Depth there."""
    inflection: Annotated[DefectLength, Field(examples=["5 m"])]
    """Distance from there to the steepest slope; the trough is about six times as long."""

    @property
    def profile(self) -> Profile:
        """The profile."""
        return profiles.SettlementDip(self.at, self.depth, self.inflection)


Defect = (
    BumpIrregularity
    | RampIrregularity
    | DippedJointIrregularity
    | SquatIrregularity
    | PotholeIrregularity
    | SettlementIrregularity
)

#: Kinds of defects, by their words in a case file.
DEFECTS = ("bump", "ramp", "dipped-joint", "squat", "pothole", "settlement")
