"""Supports of a structure and what moves them."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from axlespan.errors import InputError
from axlespan.study.check_lists import Table
from axlespan.study.checks import Location, Measured, OneOf, Part
from axlespan.study.kinds import Kinds, tag
from axlespan.study.quantities import (
    Angle,
    Dashpot,
    Flag,
    Frequency,
    Length,
    Name,
    RotationalDashpot,
    RotationalStiffness,
    Stiffness,
)
from axlespan.units import ANGLE, LENGTH, TIME

DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")
Direction = Annotated[str, OneOf(DIRECTIONS)]


class ConstantMotion(Part):
    """A displacement that is there from the beginning: a settlement."""

    kind: Literal["constant"]
    value: Annotated[Length, Field(examples=["-10 mm"])]
    """Displacement, positive up."""


class ConstantRotation(Part):
    """A rotation that is there from the beginning."""

    kind: Literal["constant"]
    value: Angle


class TableMotion(Part):
    """A displacement over time, constant before its first and after its last point."""

    kind: Literal["table"]
    points: Annotated[tuple[tuple[float, float], ...], Table(Measured(TIME), Measured(LENGTH))]
    """Pairs of time and displacement."""
    smooth: Flag = False
    """Whether a cubic spline joins the points, at rest at both ends, in place of straight lines."""


class TableRotation(Part):
    """A rotation over time, constant before its first and after its last point."""

    kind: Literal["table"]
    points: Annotated[tuple[tuple[float, float], ...], Table(Measured(TIME), Measured(ANGLE))]
    """Pairs of time and rotation."""
    smooth: Flag = False
    """Whether a cubic spline joins the points, at rest at both ends, in place of straight lines."""


class HarmonicMotion(Part):
    """The displacement a sin(2 pi f t + phase)."""

    kind: Literal["harmonic"]
    amplitude: Annotated[Length, Field(examples=["1 mm"])]
    frequency: Frequency
    phase: Angle = 0.0


class HarmonicRotation(Part):
    """The rotation a sin(2 pi f t + phase)."""

    kind: Literal["harmonic"]
    amplitude: Angle
    frequency: Frequency
    phase: Angle = 0.0


_MOTIONS = Kinds("motion", ("constant", "table", "harmonic"), "{kind: constant, value: -10 mm}")
Motion = Annotated[
    Annotated[ConstantMotion, tag("constant")]
    | Annotated[TableMotion, tag("table")]
    | Annotated[HarmonicMotion, tag("harmonic")],
    _MOTIONS.discriminator(),
    BeforeValidator(_MOTIONS.checked),
]
Rotation = Annotated[
    Annotated[ConstantRotation, tag("constant")]
    | Annotated[TableRotation, tag("table")]
    | Annotated[HarmonicRotation, tag("harmonic")],
    _MOTIONS.discriminator(),
    BeforeValidator(_MOTIONS.checked),
]


class Motions(Part):
    """What moves a support, for each direction that it moves in."""

    x: Motion | None = None
    y: Motion | None = None
    z: Motion | None = None
    rx: Rotation | None = None
    ry: Rotation | None = None
    rz: Rotation | None = None


MayLift = Annotated[tuple[Name, ...], Field(examples=["[left]"])]
"""Names of supports on springs along z."""


class Springs(Part):
    """Stiffness of an elastic support in each direction that it holds."""

    x: Stiffness | None = None
    y: Stiffness | None = None
    z: Stiffness | None = None
    rx: RotationalStiffness | None = None
    ry: RotationalStiffness | None = None
    rz: RotationalStiffness | None = None


class Dashpots(Part):
    """Damping of an elastic support in each direction."""

    x: Dashpot | None = None
    y: Dashpot | None = None
    z: Dashpot | None = None
    rx: RotationalDashpot | None = None
    ry: RotationalDashpot | None = None
    rz: RotationalDashpot | None = None


class Held(Part):
    """What holds one place: rigidly, elastically, or as its motion prescribes."""

    fixed: tuple[Direction, ...] = ()
    """Directions that do not move: x, y, z and the rotations rx, ry, rz."""
    stiffness: Springs | None = None
    """Springs to the ground."""
    damping: Dashpots | None = None
    """Dashpots to the ground, beside springs."""
    motion: Motions | None = None
    """Prescribed motion: settlements, base excitation."""

    @model_validator(mode="after")
    def _holds_once(self) -> Self:
        springs = self.stiffness.given() if self.stiffness else {}
        dashpots = self.damping.given() if self.damping else {}
        moved = self.motion.given() if self.motion else {}
        if not (self.fixed or springs or dashpots or moved):
            raise InputError("holds nothing", fix="Add fixed: [z], or stiffness: {z: 500 MN/m}")
        for name, held in (("stiffness", springs), ("damping", dashpots), ("motion", moved)):
            for direction in held:
                if direction in self.fixed:
                    raise InputError(
                        f"{direction} is fixed as well",
                        field=f"{name}.{direction}",
                        fix="Keep one of the two",
                    )
                if name == "motion" and direction in (*springs, *dashpots):
                    raise InputError(
                        f"{direction} has a spring or dashpot as well",
                        field=f"motion.{direction}",
                        fix="Keep one of the two",
                    )
        return self


class Support(Held):
    """What holds the structure at one place: rigidly, elastically, or as its motion prescribes.

    A direction may stand under one of ``fixed``, ``stiffness`` (and ``damping``) and ``motion``; one that
    stands nowhere is free.
    """

    at: Annotated[float | str, Location(), Field(examples=["0 m"])]
    """Position along the structure, or the name of a node (set) of a mesh."""


class Bearing(Part):
    """A bearing that gives way."""

    stiffness: Annotated[Stiffness, Field(examples=["2 GN/m"])]
    """Vertical stiffness."""
    damping: Dashpot | None = None
    """Vertical dashpot beside it."""
