"""Track: on a bridge of the case file, and as a structure of its own."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Discriminator, Field, model_validator

from axlespan.bridges.rails import RAILS
from axlespan.bridges.track_presets import PRESETS
from axlespan.errors import InputError
from axlespan.study.case_elements import OwnElements
from axlespan.study.case_laws import NonlinearSprings
from axlespan.study.check_lists import Several
from axlespan.study.checks import Checked, Measured, OneOf, Part, Whole
from axlespan.study.faults import InputErrors, listed, nearest
from axlespan.study.kinds import LIST, Kinds, tag
from axlespan.study.quantities import (
    Dashpot,
    Distance,
    Flag,
    Length,
    PartMass,
    SpanLength,
    SpringStiffness,
    Text,
)
from axlespan.units import (
    BENDING_STIFFNESS,
    DAMPING_PER_LENGTH,
    LENGTH,
    MASS,
    MASS_PER_LENGTH,
    NUMBER,
    PRESSURE,
    STIFFNESS,
)

NO_PRESET = "none"

_Spring = Annotated[float, Measured(STIFFNESS, above=0.0, believable=(1e6, 1e11))]
_SupportSpacing = Annotated[float, Measured(LENGTH, above=0.0, believable=(0.2, 3.0))]
_SleeperMass = Annotated[float, Measured(MASS, above=0.0, believable=(20.0, 2000.0))]
_Modulus = Annotated[float, Measured(PRESSURE, above=0.0, believable=(1e6, 1e11))]
_Damping = Annotated[float, Measured(DAMPING_PER_LENGTH, at_least=0.0)]
_Factor = Measured(NUMBER, at_least=0.0)


class RailName(Checked):
    """A rail by its name; names like 60E1 are numbers to YAML, and are taken all the same."""

    def read(self, raw: Any) -> str:
        """Return the name."""
        if isinstance(raw, str) and raw.strip() in RAILS:
            return raw.strip()
        if isinstance(raw, (int, float)) and not isinstance(raw, bool):
            for name in RAILS:
                if re.fullmatch(r"\d+E\d+", name) and float(name) == raw:
                    return name
        near = nearest(raw, RAILS) if isinstance(raw, str) else None
        raise InputError(
            "no such rail", value=raw, fix=f"Did you mean {near}?" if near else f"Known are {listed(RAILS)}"
        )

    def json_schema(self) -> dict[str, Any]:
        """Return the JSON Schema: a name, or the number that YAML makes of it."""
        return {"enum": [*RAILS, *(float(name) for name in RAILS if re.fullmatch(r"\d+E\d+", name))]}


class TrackZone(Part):
    """A stretch of track with another stiffness; its dashpots go with it."""

    from_: Annotated[Length, Field(alias="from", examples=["-10 m"])]
    """Where it begins."""
    to: Annotated[Length, Field(examples=["0 m"])]
    """Where it ends."""
    factor: Annotated[
        Annotated[float, _Factor, tag("number")]
        | Annotated[tuple[float, ...], Several(_Factor, "[1, 3]", exactly=2), LIST],
        Discriminator(lambda raw: LIST.tag if isinstance(raw, (list, tuple)) else "<number>"),
        Field(examples=["[1, 3]"]),
    ]
    """Factor on the stiffness of the layer, or its values at both ends; 0 makes sleepers hang."""
    layer: Text = "ballast"
    """Layer: pads, ballast, subgrade; fastenings, foundation, mortar of slab tracks."""

    @model_validator(mode="after")
    def _forward(self) -> Self:
        if self.to <= self.from_:
            raise InputError("must be greater than from", field="to", fix="Exchange the two")
        return self


BALLASTS = ("linear", "unilateral")


class HangingSleeper(Part):
    """A sleeper that stands off its ballast while the track carries nothing, not even itself."""

    at: Annotated[Length, Field(examples=["5.4 m"])]
    """Position along the track; the nearest sleeper is meant."""
    gap: Annotated[float, Measured(LENGTH, above=0.0, believable=(1e-5, 0.05)), Field(examples=["1 mm"])]
    """Gap under it."""


class _AnyTrack(Part):
    rail: Annotated[str | None, RailName()] = None
    """Rail: 60E1, 54E1, ...; that of the preset when left out."""
    approach: Annotated[Distance | None, Field(examples=["50 m"])] = None
    """Track before the bridge; the run-in, 10 characteristic lengths and 25 m when left out."""
    exit: Annotated[Distance | None, Field(examples=["50 m"])] = None
    """Track behind the bridge; as the approach when left out."""
    run_in: Distance = 15.0
    """Length at the far ends over which the track grows soft, so that wheels come gently from rigid ground."""
    zones: tuple[TrackZone, ...] = ()
    """Stretches of another stiffness."""
    rail_elements: Annotated[int, Whole(at_most=20)] = 2
    """Beam elements of the rail between two supports."""

    @model_validator(mode="after")
    def _known(self) -> Self:
        kind, word = self.kind, self.preset  # type: ignore[attr-defined]
        known = [*(preset.name for preset in PRESETS.values() if preset.kind == kind), NO_PRESET]
        if word not in known:
            near = nearest(word, known)
            fix = f"Did you mean {near}?" if near else f"Known are {listed(known)}"
            raise InputError(f"no such preset of {kind} track", field="preset", fix=fix)
        return self

    def values(self) -> dict[str, float]:
        """Values of the track that are given, by their names in Python."""
        shared = {*_AnyTrack.model_fields, "kind", "preset"}
        return {name: value for name, value in self.given().items() if name not in shared}


class BallastedTrack(_AnyTrack):
    """Rails, pads, sleepers and ballast; all values are those of a whole sleeper, both rail seats together."""

    kind: Literal["ballasted"]
    preset: Text = "zhai-2004"
    """Where values come from that are left out: zhai-2004, ttb-2d, railfe, or none."""
    sleeper_spacing: _SupportSpacing | None = None
    """Distance of the sleepers."""
    pad_stiffness: Annotated[_Spring | None, Field(examples=["130 MN/m"])] = None
    """Both pads of a sleeper."""
    pad_damping: Dashpot | None = None
    """Both pads of a sleeper."""
    sleeper_mass: _SleeperMass | None = None
    """A whole sleeper."""
    ballast_stiffness: _Spring | None = None
    """Ballast under a whole sleeper."""
    ballast_damping: Dashpot | None = None
    """Ballast under a whole sleeper."""
    ballast_mass: PartMass | None = None
    """Ballast that moves with a sleeper, on the ground; on a bridge it belongs to the deck's mass."""
    shear_stiffness: SpringStiffness | None = None
    """Between neighboring ballast masses."""
    shear_damping: Dashpot | None = None
    """Between neighboring ballast masses."""
    subgrade_stiffness: SpringStiffness | None = None
    """Under a ballast mass on the ground; 0 leaves out ballast masses and subgrade."""
    subgrade_damping: Dashpot | None = None
    """Under a ballast mass on the ground."""
    deck_ballast_stiffness: _Spring | None = None
    """Ballast under a sleeper on the bridge; as on the ground when left out."""
    deck_ballast_damping: Dashpot | None = None
    """Ballast under a sleeper on the bridge."""
    ballast: Annotated[str, OneOf(BALLASTS)] = "linear"
    """Whether the ballast holds its sleepers down too, or can only push: unilateral."""
    hanging_sleepers: Annotated[tuple[HangingSleeper, ...], Field(examples=["[{at: 5.4 m, gap: 1 mm}]"])] = ()
    """Sleepers with a gap under them, which makes the ballast unilateral."""

    @property
    def is_unilateral(self) -> bool:
        """Whether sleepers may part from the ballast."""
        return self.ballast == "unilateral" or bool(self.hanging_sleepers)

    def values(self) -> dict[str, float]:
        """Values of the track that are given, by their names in Python."""
        own = {"ballast", "hanging_sleepers"}
        return {name: value for name, value in super().values().items() if name not in own}


class SlabTrack(_AnyTrack):
    """Rails, fastenings and a slab; all values are those of the whole track, both rail seats together."""

    kind: Literal["slab"]
    preset: Text = "slab"
    """Where values come from that are left out: slab, or none."""
    fastening_spacing: _SupportSpacing | None = None
    """Distance of the rail seats."""
    fastening_stiffness: Annotated[_Spring | None, Field(examples=["80 MN/m"])] = None
    """Both rail seats."""
    fastening_damping: Dashpot | None = None
    """Both rail seats."""
    slab_bending_stiffness: Annotated[float, Measured(BENDING_STIFFNESS, above=0.0)] | None = None
    """EI of the slab."""
    slab_mass: Annotated[float, Measured(MASS_PER_LENGTH, above=0.0, believable=(50.0, 1e5))] | None = None
    """Mass of the slab."""
    foundation_modulus: _Modulus | None = None
    """All that lies under the slab on the ground, stiffness per length."""
    foundation_damping: _Damping | None = None
    """All that lies under the slab on the ground."""
    mortar_modulus: _Modulus | None = None
    """Layer between slab and deck, stiffness per length."""
    mortar_damping: _Damping | None = None
    """Layer between slab and deck."""
    panel_length: SpanLength | None = None
    """Length of slabs with joints; one slab when left out."""


_NAMES = ("ballasted", "slab")
KINDS = Kinds("track", _NAMES, "{kind: ballasted, preset: zhai-2004}", words_alone=_NAMES)

Track = Annotated[
    Annotated[BallastedTrack, tag("ballasted")] | Annotated[SlabTrack, tag("slab")],
    KINDS.discriminator(),
    BeforeValidator(KINDS.checked),
]

_IN_SCHEMA: Any = {"json_schema_extra": KINDS.words_in_schema}
Laid = Annotated[Track | None, Field(examples=["{kind: ballasted, preset: zhai-2004}"], **_IN_SCHEMA)]


class TrackStructure(Part):
    """A track on the ground, with no bridge."""

    kind: Literal["track"]
    length: SpanLength
    """Length from end to end, a whole number of spacings."""
    track: Annotated[Track, Field(examples=["{kind: ballasted, preset: zhai-2004}"], **_IN_SCHEMA)]
    """What it is made of."""
    space: Flag = False
    """Whether there are two rails, left and right, on sleepers that roll."""
    nonlinear_springs: NonlinearSprings = ()
    """Springs and dashpots that follow a law: pads, ballast. Own weight acts first then."""
    own_elements: OwnElements = ()
    """Nonlinear elements of one's own, written in Python. Own weight acts first then."""

    @model_validator(mode="after")
    def _no_bridge(self) -> Self:
        faults = [
            InputError("is for tracks on bridges", field=f"track.{name}", fix="Leave it out; length says it")
            for name in ("approach", "exit")
            if getattr(self.track, name) is not None
        ]
        if faults:
            raise InputErrors(faults)
        return self


__all__ = ["BallastedTrack", "SlabTrack", "Track", "TrackStructure", "TrackZone"]
