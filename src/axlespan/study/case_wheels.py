"""What the wheels of an entry have of their own: flats, out-of-roundness, the contact patch of a tyre."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal, Self

from pydantic import Discriminator, Field, model_validator

from axlespan import irregularity as profiles
from axlespan.errors import InputError
from axlespan.irregularity import Profile
from axlespan.study.case_contact import WheelRadius
from axlespan.study.checks import Checked, Measured, OneOf, Part, Whole, Word
from axlespan.study.kinds import LIST, MAPPING, list_or_mapping
from axlespan.study.quantities import Angle, Length
from axlespan.units import LENGTH

Patch = Annotated[float, Measured(LENGTH, above=0.0, believable=(0.01, 1.0)), Field(examples=["0.24 m"])]
FlatLength = Annotated[float, Measured(LENGTH, above=0.0, believable=(1e-3, 0.5))]
FlatDepth = Annotated[float, Measured(LENGTH, above=0.0, believable=(1e-6, 0.02))]


@dataclass(frozen=True)
class WheelNames(Checked):
    """Names of wheels as in the result, ``[1.1, 1.3]``; all is all of the entry."""

    def read(self, raw: Any) -> tuple[str, ...] | None:
        """Return the names, or nothing for all."""
        if raw is None or raw == "all":
            return None
        if not isinstance(raw, (list, tuple)) or not raw:
            raise InputError(
                "must be all, or a list of wheels", value=raw, fix="Write [1.1, 1.3], as contacts are named"
            )
        return tuple(Word().read(one) for one in raw)

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema."""
        names = {"type": "array", "items": Word().json_schema(), "minItems": 1}
        return {"anyOf": [{"enum": ["all"]}, names]}


class OfWheels(Part):
    """Something that wheels of an entry have."""

    wheels: Annotated[tuple[str, ...] | None, WheelNames(), Field(examples=["[1.1]"])] = None
    """Names of the wheels that have it, as contacts are named in the result; all of the entry when left out."""
    radius: Annotated[WheelRadius | None, Field(examples=["460 mm"])] = None
    """Rolling radius; that of the vehicle's wheel when left out."""


class WheelFlat(OfWheels):
    """A flat: the wheel's center drops once in every turn."""

    length: Annotated[FlatLength | None, Field(examples=["50 mm"])] = None
    """Length of the flat; from the depth when left out."""
    depth: Annotated[FlatDepth | None, Field(examples=["0.5 mm"])] = None
    """How far the wheel drops; length squared by eight times the radius, of a fresh flat, when left out."""
    shape: Annotated[str, OneOf(("fresh", "rounded"))] = "fresh"
    """``fresh``, with a kink in the middle, or ``rounded`` by wear."""
    at: Annotated[Length, Field(examples=["12.5 m"])] = 0.0
    """A position along the line where it strikes; it strikes at every circumference from there too."""

    @model_validator(mode="after")
    def _has_a_size(self) -> Self:
        if self.length is None and self.depth is None:
            raise InputError("is missing", field="length", fix="Add length: 50 mm, or depth: 0.5 mm")
        return self

    def profile(self, radius: float) -> Profile:
        """The profile of a wheel of a radius [m]."""
        length = self.length
        if length is None:
            assert self.depth is not None  # one of the two is given
            length = (8.0 * radius * self.depth) ** 0.5
        shape: Literal["fresh", "rounded"] = "rounded" if self.shape == "rounded" else "fresh"
        return profiles.WheelFlat(length, radius, self.depth, shape, self.at)


class OutOfRound(OfWheels):
    """Waves around the circumference of a wheel: r = a sin(order x / R + phase)."""

    amplitude: Annotated[FlatDepth, Field(examples=["0.2 mm"])]
    """Amplitude a."""
    order: Annotated[int, Whole(at_most=1000), Field(examples=["3"])]
    """Waves per turn: 1 is eccentric, 2 oval, about 20 a polygon."""
    phase: Angle = 0.0
    """Phase at x = 0."""

    def profile(self, radius: float) -> Profile:
        """The profile of a wheel of a radius [m]."""
        return profiles.OutOfRound(radius, [self.order], [self.amplitude], [self.phase])  # type: ignore[arg-type]


Flats = Annotated[
    Annotated[tuple[WheelFlat, ...], LIST] | Annotated[WheelFlat, MAPPING], Discriminator(list_or_mapping)
]
Waves = Annotated[
    Annotated[tuple[OutOfRound, ...], LIST] | Annotated[OutOfRound, MAPPING], Discriminator(list_or_mapping)
]
