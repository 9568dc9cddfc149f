"""Laws of contact between wheel and surface, of the whole analysis or of an entry of a train."""

from __future__ import annotations

from typing import Annotated, Final, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from axlespan.contact.laws import Hertz, Law, LinearSpring, Rigid, Unilateral
from axlespan.errors import InputError
from axlespan.study.checks import Measured, OneOf, Part
from axlespan.study.kinds import Kinds, tag
from axlespan.study.quantities import Dashpot, Flag, Stiffness
from axlespan.units import HERTZ_STIFFNESS, LENGTH

CONTACTS: Final = ("rigid", "unilateral", "hertz", "linear-spring")
TREADS: Final = ("worn", "cone")

WheelRadius = Annotated[float, Measured(LENGTH, above=0.0, believable=(0.1, 1.0))]


class RigidContact(Part):
    """Wheels that never leave the surface; the contact force may pull."""

    kind: Literal["rigid"]

    @property
    def law(self) -> Law:
        """The law."""
        return Rigid()


class UnilateralContact(Part):
    """Wheels that lift off where the contact force would pull, and land without rebound."""

    kind: Literal["unilateral"]

    @property
    def law(self) -> Law:
        """The law."""
        return Unilateral()


class HertzContact(Part):
    """A Hertz spring between wheel and surface: force = stiffness times approach to the power 1.5; it does not pull."""

    kind: Literal["hertz"]
    stiffness: Annotated[float, Measured(HERTZ_STIFFNESS, above=0.0)] | None = None
    """Stiffness; from the radius when left out."""
    radius: Annotated[WheelRadius | None, Field(examples=["460 mm"])] = None
    """Radius of the wheel; that of the vehicle's wheel when left out, 0.46 m where that has none."""
    tread: Annotated[str, OneOf(TREADS)] = "worn"
    """Tread of the wheel."""

    @property
    def law(self) -> Law:
        """The law."""
        return Hertz(self.stiffness, self.radius, self.tread)

    @model_validator(mode="after")
    def _once(self) -> Self:
        if self.stiffness is not None and self.radius is not None:
            raise InputError("says again what stiffness says", field="radius", fix="Keep one of the two")
        return self


class LinearSpringContact(Part):
    """A spring and a dashpot between wheel and surface: a tyre, or Hertz linearized."""

    kind: Literal["linear-spring"]
    stiffness: Annotated[Stiffness | None, Field(examples=["1.4 GN/m"])] = None
    """Stiffness; that of Hertz at the wheel's static force when left out."""
    damping: Dashpot = 0.0
    """Damping of a dashpot beside it."""
    tension: Flag = False
    """Whether it may pull; otherwise the wheel lifts off."""

    @property
    def law(self) -> Law:
        """The law."""
        return LinearSpring(self.stiffness, self.damping, self.tension)


KINDS = Kinds("contact", CONTACTS, "{kind: linear-spring, stiffness: 1.4 GN/m}", words_alone=CONTACTS)
Contact = Annotated[
    Annotated[RigidContact, tag("rigid")]
    | Annotated[UnilateralContact, tag("unilateral")]
    | Annotated[HertzContact, tag("hertz")]
    | Annotated[LinearSpringContact, tag("linear-spring")],
    KINDS.discriminator(),
    BeforeValidator(KINDS.checked),
]
