"""The crossing: how the train moves, and on what surface."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, ConfigDict, Field, ValidationInfo, field_validator, model_validator

from axlespan.errors import InputError
from axlespan.study.check_lists import Several, Table
from axlespan.study.checks import Measured, Part
from axlespan.study.faults import listed, nearest
from axlespan.study.kinds import ExistingFile, Kinds, tag
from axlespan.study.quantities import (
    TRAIN_SPEED,
    UNEVENNESS,
    Angle,
    Count,
    Factor,
    Length,
    Seed,
    Speed,
    Text,
    Unevenness,
    Wavelength,
)
from axlespan.units import LENGTH, TIME


class Bounded(Part):
    """An irregularity that is zero outside ``from`` .. ``to``; everywhere there when they are left out."""

    from_: Annotated[Length | None, Field(alias="from")] = None
    """Where it begins."""
    to: Length | None = None
    """Where it ends."""

    @model_validator(mode="after")
    def _forward(self) -> Self:
        if self.from_ is not None and self.to is not None and self.to <= self.from_:
            raise InputError("must be greater than from", field="to", fix="Exchange the two")
        return self


class NoIrregularity(Part):
    """An even surface."""

    kind: Literal["none"]


class HarmonicIrregularity(Bounded):
    """The profile r = a sin(2 pi x / wavelength + phase), N12 (40)."""

    kind: Literal["harmonic"]
    amplitude: Annotated[Unevenness, Field(examples=["0.5 mm"])]
    """Amplitude a; positive lifts the wheel in the first half wave."""
    wavelength: Annotated[Wavelength, Field(examples=["5 m"])]
    """Wavelength."""
    phase: Angle = 0.0
    """Phase at x = 0."""


class TableIrregularity(Bounded):
    """A measured profile, linear between its points."""

    kind: Literal["table"]
    points: Annotated[tuple[tuple[float, float], ...], Table(Measured(LENGTH), UNEVENNESS)] | None = None
    """Pairs of position and height."""
    file: Annotated[Path, ExistingFile()] | None = None
    """Text file with a position and a height [m] in each line, in place of points."""

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        if (self.points is None) == (self.file is None):
            both = self.points is not None
            rule = "says again what points say" if both else "is missing"
            fix = (
                "Keep one of the two"
                if both
                else "Add points: [[0 m, 0 mm], [1 m, 2 mm]], or file: profile.csv"
            )
            raise InputError(rule, field="file" if both else "points", fix=fix)
        return self


class SpectrumIrregularity(Bounded):
    """A random profile with the spectrum of a class of track or road."""

    kind: Literal["spectrum"]
    name: Annotated[Text, Field(examples=["german-low"])]
    """Name of the spectrum."""
    seed: Annotated[Seed, Field(examples=["1"])]
    """Seed of the random phases: the same seed gives the same profile."""
    wavelengths: Annotated[
        tuple[float, ...] | None,
        Several(Measured(LENGTH, above=0.0), "[1 m, 80 m]", exactly=2, increasing=True),
    ] = None
    """Shortest and longest wavelength; those of the spectrum when left out."""
    components: Count | None = None
    """Number of harmonics."""
    scale: Factor = 1.0
    """Factor on the heights."""

    @field_validator("name", mode="after")
    @classmethod
    def _known(cls, name: str, info: ValidationInfo) -> str:
        spectra: Sequence[str] = tuple((info.context or {}).get("spectra", ()))
        if spectra and name not in spectra:
            near = nearest(name, spectra)
            raise InputError(
                "no such spectrum",
                value=name,
                fix=f"Did you mean {near}?" if near else f"Known are {listed(spectra)}",
            )
        return name


KINDS = Kinds(
    "irregularity",
    ("none", "harmonic", "table", "spectrum"),
    "{kind: harmonic, amplitude: 0.5 mm, wavelength: 5 m}",
    words_alone=("none",),
)
Irregularity = Annotated[
    Annotated[NoIrregularity, tag("none")]
    | Annotated[HarmonicIrregularity, tag("harmonic")]
    | Annotated[TableIrregularity, tag("table")]
    | Annotated[SpectrumIrregularity, tag("spectrum")],
    KINDS.discriminator(),
    BeforeValidator(KINDS.checked),
]


def _either_speed(schema: dict[str, Any]) -> None:
    schema["oneOf"] = [{"required": ["speed"]}, {"required": ["speed_history"]}]


class Crossing(Part):
    """How the train moves: at one speed, or by a history of it."""

    model_config = ConfigDict(json_schema_extra=_either_speed)

    speed: Annotated[Speed | None, Field(examples=["80 km/h"])] = None
    """Constant speed."""
    speed_history: (
        Annotated[tuple[tuple[float, float], ...], Table(Measured(TIME, at_least=0.0), TRAIN_SPEED)] | None
    ) = None
    """Pairs of time and speed, linear between them and constant after the last."""
    start: Length = 0.0
    """Position of the first wheel at t = 0: negative before the structure."""
    irregularity: Annotated[Irregularity, Field(json_schema_extra=KINDS.words_in_schema)] = NoIrregularity(
        kind="none"
    )
    """Irregularity of the surface; none when left out."""

    @model_validator(mode="after")
    def _moves(self) -> Self:
        if self.speed is None and self.speed_history is None:
            raise InputError("is missing", field="speed", fix="Add speed: 80 km/h, or a speed_history")
        if self.speed is not None and self.speed_history is not None:
            raise InputError("says again what speed says", field="speed_history", fix="Keep one of the two")
        if self.speed_history is not None and self.speed_history[0][0] != 0.0:
            raise InputError("must begin at 0 s", field="speed_history.0.0", fix="Add the speed at 0 s")
        standing = self.speed == 0.0 or (
            self.speed_history is not None and not any(v for _, v in self.speed_history)
        )
        if standing and "start" not in self.model_fields_set:
            field = "speed" if self.speed_history is None else "speed_history"
            raise InputError(
                "must be positive for a train that crosses",
                field=field,
                fix="A train that stands needs start: 12.5 m",
            )
        return self
