"""Laws of nonlinear springs and dashpots: of suspensions, pads, ballast, bearings."""

from __future__ import annotations

from typing import Annotated, Final, Literal, Self

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from axlespan.bridges.spring_laws import shares
from axlespan.errors import InputError
from axlespan.model.nonlinear import (
    BilinearHysteresis,
    FloatArray,
    MultilinearDashpot,
    MultilinearSpring,
    PowerDashpot,
    PowerSpring,
    SpringLaw,
    UnilateralSpring,
)
from axlespan.study.case_support import Direction
from axlespan.study.check_lists import Table
from axlespan.study.checks import Measured, Part
from axlespan.study.kinds import Kinds, tag
from axlespan.study.quantities import Dashpot, SpringStiffness, Stiffness, Text
from axlespan.units import FORCE, LENGTH, NUMBER, SPEED

LAWS: Final = ("unilateral", "power", "multilinear", "power-dashpot", "multilinear-dashpot", "hysteresis")

Gap = Annotated[float, Measured(LENGTH, at_least=0.0, below=1.0, believable=(1e-5, 0.3))]
_Force = Annotated[float, Measured(FORCE, above=0.0, believable=(10.0, 1e8))]
_Exponent = Annotated[float, Measured(NUMBER, at_least=1.0, below=10.0)]


class UnilateralLaw(Part):
    """A spring that only pushes: a bump stop, a bearing that may lift."""

    kind: Literal["unilateral"]
    stiffness: Stiffness | None = None
    """Stiffness in compression; that of the springs that follow the law when left out."""
    damping: Dashpot | None = None
    """Damping while it touches."""
    gap: Gap = 0.0
    """How far it is compressed before it touches."""

    def law(self, stiffness: float | FloatArray = 0.0, damping: float | FloatArray = 0.0) -> SpringLaw:
        """The law of springs of a stiffness [N/m] and damping [N s/m]."""
        k: float | FloatArray = stiffness if self.stiffness is None else self.stiffness
        if self.stiffness is not None and np.ndim(stiffness):  # as stiff as the group in zones and run-ins
            k = self.stiffness * shares(np.asarray(stiffness))
        return UnilateralSpring(k, damping if self.damping is None else self.damping)


class PowerLaw(Part):
    """A spring that grows stiffer: its force is proportional to a power of the elongation."""

    kind: Literal["power"]
    force: Annotated[_Force, Field(examples=["100 kN"])]
    """Force at an elongation."""
    at: Annotated[float, Measured(LENGTH, above=0.0, believable=(1e-6, 1.0)), Field(examples=["2 mm"])]
    """That elongation."""
    exponent: Annotated[_Exponent, Field(examples=["2"])]
    """The power."""

    def law(self, stiffness: float | FloatArray = 0.0, damping: float | FloatArray = 0.0) -> SpringLaw:
        """The law."""
        return PowerSpring(self.force / self.at**self.exponent, self.exponent, self.at)


class MultilinearLaw(Part):
    """A spring whose force is linear between points, and on beyond them; tension is positive."""

    kind: Literal["multilinear"]
    points: Annotated[
        tuple[tuple[float, float], ...],
        Table(Measured(LENGTH, believable=(1e-6, 1.0)), Measured(FORCE, believable=(1.0, 1e9))),
        Field(examples=["[[-2 mm, -200 kN], [0 mm, 0 kN], [2 mm, 50 kN]]"]),
    ]
    """Pairs of elongation and force; the force must not fall."""

    @model_validator(mode="after")
    def _rises(self) -> Self:
        _require_rising(self.points)
        return self

    def law(self, stiffness: float | FloatArray = 0.0, damping: float | FloatArray = 0.0) -> SpringLaw:
        """The law."""
        return MultilinearSpring(self.points)


class PowerDashpotLaw(Part):
    """A dashpot whose force is proportional to a power of the velocity."""

    kind: Literal["power-dashpot"]
    force: Annotated[_Force, Field(examples=["10 kN"])]
    """Force at a velocity."""
    at: Annotated[float, Measured(SPEED, above=0.0, believable=(1e-4, 10.0)), Field(examples=["0.1 m/s"])]
    """That velocity."""
    exponent: Annotated[_Exponent, Field(examples=["2"])]
    """The power."""

    def law(self, stiffness: float | FloatArray = 0.0, damping: float | FloatArray = 0.0) -> SpringLaw:
        """The law."""
        return PowerDashpot(self.force / self.at**self.exponent, self.exponent)


class MultilinearDashpotLaw(Part):
    """A dashpot whose force is linear between points, and on beyond them."""

    kind: Literal["multilinear-dashpot"]
    points: Annotated[
        tuple[tuple[float, float], ...],
        Table(Measured(SPEED, believable=(1e-5, 10.0)), Measured(FORCE, believable=(1.0, 1e9))),
        Field(examples=["[[-0.1 m/s, -4 kN], [0 m/s, 0 kN], [0.1 m/s, 10 kN]]"]),
    ]
    """Pairs of velocity and force, through [0, 0]; the force must not fall."""

    @model_validator(mode="after")
    def _rises(self) -> Self:
        _require_rising(self.points)
        try:
            MultilinearDashpot(self.points)
        except InputError as error:
            raise InputError(error.rule, field="points", fix="Add the point [0 m/s, 0 kN]") from None
        return self

    def law(self, stiffness: float | FloatArray = 0.0, damping: float | FloatArray = 0.0) -> SpringLaw:
        """The law."""
        return MultilinearDashpot(self.points)


class HysteresisLaw(Part):
    """Friction behind a spring: elastic up to a force, then it slides, or goes on with the hardening stiffness."""

    kind: Literal["hysteresis"]
    stiffness: Annotated[Stiffness, Field(examples=["20 MN/m"])]
    """Elastic stiffness."""
    yield_force: Annotated[_Force, Field(examples=["5 kN"])]
    """Force at which it slides."""
    hardening: SpringStiffness = 0.0
    """Stiffness while it slides."""

    @model_validator(mode="after")
    def _softens(self) -> Self:
        if self.hardening >= self.stiffness:
            raise InputError(
                "must be below the stiffness", field="hardening", fix="Leave it out for friction"
            )
        return self

    def law(self, stiffness: float | FloatArray = 0.0, damping: float | FloatArray = 0.0) -> SpringLaw:
        """The law."""
        return BilinearHysteresis(self.stiffness, self.yield_force, self.hardening)


def _require_rising(points: tuple[tuple[float, float], ...]) -> None:
    for row in range(1, len(points)):
        if points[row][1] < points[row - 1][1]:
            raise InputError(
                "must not fall: a law that softens has no unique answer",
                field=f"points.{row}.1",
                fix="Use forces that rise or stay",
            )


KINDS = Kinds("law", LAWS, "{kind: power, force: 100 kN, at: 2 mm, exponent: 2}")
AnyLaw = Annotated[
    Annotated[UnilateralLaw, tag("unilateral")]
    | Annotated[PowerLaw, tag("power")]
    | Annotated[MultilinearLaw, tag("multilinear")]
    | Annotated[PowerDashpotLaw, tag("power-dashpot")]
    | Annotated[MultilinearDashpotLaw, tag("multilinear-dashpot")]
    | Annotated[HysteresisLaw, tag("hysteresis")],
    KINDS.discriminator(),
    BeforeValidator(KINDS.checked),
]
Law = Annotated[AnyLaw, Field(examples=["{kind: power, force: 100 kN, at: 2 mm, exponent: 2}"])]


def gap_of(law: AnyLaw) -> float:
    """The gap of a law [m]."""
    return law.gap if isinstance(law, UnilateralLaw) else 0.0


class BumpStop(Part):
    """A stop that touches when the suspension is compressed by its gap."""

    gap: Annotated[Gap, Field(examples=["30 mm"])]
    """How far the suspension is compressed before it touches, from rest on."""
    stiffness: Annotated[Stiffness, Field(examples=["20 MN/m"])]
    """Stiffness of the stop."""
    damping: Dashpot = 0.0
    """Damping while it touches."""


class SpringsWithLaw(Part):
    """Springs of the structure that follow a law in place of their stiffness; a dashpot's, in place of their damping."""

    springs: Annotated[Text, Field(examples=["ballast"])]
    """Which: ballast, pads or fastening of a track, support and its name, springs.0 of a mesh."""
    law: Law
    """Law of each of them, from the unloaded structure on; where they are stiffer than at most places, it is, too."""
    direction: Direction = "z"
    """Direction in which they act."""


NonlinearSprings = Annotated[
    tuple[SpringsWithLaw, ...],
    Field(examples=["[{springs: pads, law: {kind: power, force: 50 kN, at: 0.5 mm, exponent: 1.5}}]"]),
]
