"""The crossing: how trains move, and on what surface."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, ConfigDict, Field, ValidationInfo, field_validator, model_validator

from axlespan.errors import InputError
from axlespan.study.check_lists import Several, Table
from axlespan.study.checks import Measured, OneOf, Part
from axlespan.study.faults import listed, nearest
from axlespan.study.kinds import ExistingFile, Kinds, tag
from axlespan.study.quantities import (
    TRAIN_SPEED,
    UNEVENNESS,
    Angle,
    Count,
    Delay,
    Distance,
    Factor,
    Length,
    Name,
    Seed,
    SpanLength,
    Speed,
    Text,
    TrainAcceleration,
    Unevenness,
    Wavelength,
)
from axlespan.units import LENGTH, SPEED, TIME, show


class Bounded(Part):
    """An irregularity that is zero outside ``from`` .. ``to``; everywhere there when they are left out."""

    from_: Annotated[Length | None, Field(alias="from")] = None
    """Where it begins."""
    to: Length | None = None
    """Where it ends."""
    taper: Distance = 0.0
    """Length behind from, and before to, over which it fades in and out; without it the surface may step there."""

    @model_validator(mode="after")
    def _forward(self) -> Self:
        if self.from_ is not None and self.to is not None and self.to <= self.from_:
            raise InputError("must be greater than from", field="to", fix="Exchange the two")
        if self.taper and self.from_ is None and self.to is None:
            raise InputError("goes with from and to", field="taper", fix="Add from: -20 m, or to: 60 m")
        if self.from_ is not None and self.to is not None and 2.0 * self.taper > self.to - self.from_:
            half = show(0.5 * (self.to - self.from_), LENGTH)
            raise InputError(f"must be at most {half}, half the way from from to to", field="taper")
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
    """A measured profile, linear between its points; the heights at its ends go on."""

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


def _name_or_file(schema: dict[str, Any]) -> None:
    schema["oneOf"] = [{"required": ["name"]}, {"required": ["file"]}]


class SpectrumIrregularity(Bounded):
    """A random profile with the spectrum of a class of track or road."""

    model_config = ConfigDict(json_schema_extra=_name_or_file)

    kind: Literal["spectrum"]
    name: Annotated[Text | None, Field(examples=["german-low"])] = None
    """Name of the spectrum."""
    file: Annotated[Path, ExistingFile()] | None = None
    """Text file with a spectrum of one's own, in place of a name: ``n [1/m]; S [mm^2/(1/m)]``."""
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
    rails: Annotated[tuple[Name, ...] | None, Field(examples=["[left, right]"])] = None
    """Lines of the left and the right rail, whose profiles the level and the cross level of the track make."""
    base: Annotated[SpanLength | None, Field(examples=["1.5 m"])] = None
    """Distance of the rails, for spectra of the cross level that are angles; 1.5 m when left out."""

    @model_validator(mode="after")
    def _one_spectrum(self) -> Self:
        if self.name is None and self.file is None:
            raise InputError("is missing", field="name", fix="Add name: german-low, or file: spectrum.csv")
        if self.name is not None and self.file is not None:
            raise InputError("says again what name says", field="file", fix="Keep one of the two")
        if self.file is not None and self.rails is not None:
            raise InputError(
                "needs the level and the cross level, and the file has one spectrum",
                field="rails",
                fix="Use a name, or give each line its own: {kind: lines, lines: {left: ..., right: ...}}",
            )
        return self

    @model_validator(mode="after")
    def _two_rails(self) -> Self:
        if self.rails is not None and (len(self.rails) != 2 or self.rails[0] == self.rails[1]):
            raise InputError("must be two different lines", field="rails", fix="Write [left, right]")
        if self.base is not None and self.rails is None:
            raise InputError("goes with rails", field="base", fix="Add rails: [left, right]")
        return self

    @field_validator("name", mode="after")
    @classmethod
    def _known(cls, name: str | None, info: ValidationInfo) -> str | None:
        spectra: Sequence[str] = tuple((info.context or {}).get("spectra", ()))
        if name is not None and spectra and name not in spectra:
            near = nearest(name, spectra)
            raise InputError(
                "no such spectrum",
                value=name,
                fix=f"Did you mean {near}?" if near else f"Known are {listed(spectra)}",
            )
        return name


_ONE = Kinds(
    "irregularity",
    ("none", "harmonic", "table", "spectrum"),
    "{kind: harmonic, amplitude: 0.5 mm, wavelength: 5 m}",
    words_alone=("none",),
)
_OfOneLine = Annotated[
    Annotated[NoIrregularity, tag("none")]
    | Annotated[HarmonicIrregularity, tag("harmonic")]
    | Annotated[TableIrregularity, tag("table")]
    | Annotated[SpectrumIrregularity, tag("spectrum")],
    _ONE.discriminator(),
    BeforeValidator(_ONE.checked),
]


class LinesIrregularity(Part):
    """An irregularity for each of several running lines; lines that are not named are even."""

    kind: Literal["lines"]
    lines: Annotated[
        dict[str, Annotated[_OfOneLine, Field(json_schema_extra=_ONE.words_in_schema)]],
        Field(examples=["{left: {kind: harmonic, amplitude: 1 mm, wavelength: 5 m}}"]),
    ]
    """Irregularities by the names of lines."""

    @model_validator(mode="after")
    def _of_one_each(self) -> Self:
        for name, one in self.lines.items():
            if isinstance(one, SpectrumIrregularity) and one.rails is not None:
                raise InputError(
                    "goes with a spectrum for the whole track",
                    field=f"lines.{name}.rails",
                    fix="Write irregularity: {kind: spectrum, ..., rails: [left, right]}",
                )
        return self


KINDS = Kinds(
    "irregularity",
    ("none", "harmonic", "table", "spectrum", "lines"),
    "{kind: harmonic, amplitude: 0.5 mm, wavelength: 5 m}",
    words_alone=("none",),
)
Irregularity = Annotated[
    Annotated[NoIrregularity, tag("none")]
    | Annotated[HarmonicIrregularity, tag("harmonic")]
    | Annotated[TableIrregularity, tag("table")]
    | Annotated[SpectrumIrregularity, tag("spectrum")]
    | Annotated[LinesIrregularity, tag("lines")],
    KINDS.discriminator(),
    BeforeValidator(KINDS.checked),
]


def _either_speed(schema: dict[str, Any]) -> None:
    schema["oneOf"] = [{"required": ["speed"]}, {"required": ["speed_history"]}]


class Movement(Part):
    """How a train moves: at one speed, with an acceleration, or by a history of its speed."""

    model_config = ConfigDict(json_schema_extra=_either_speed)

    speed: Annotated[Speed | None, Field(examples=["80 km/h"])] = None
    """Speed, constant unless there is an acceleration."""
    speed_history: (
        Annotated[tuple[tuple[float, float], ...], Table(Measured(TIME, at_least=0.0), TRAIN_SPEED)] | None
    ) = None
    """Pairs of time and speed, linear between them and constant after the last."""
    acceleration: Annotated[TrainAcceleration | None, Field(examples=["0.5 m/s^2"])] = None
    """Constant acceleration from t = 0 on; negative brakes, to a stop unless to_speed is given."""
    to_speed: Annotated[Speed | None, Field(examples=["120 km/h"])] = None
    """Speed at which the acceleration ends."""
    start: Length | None = None
    """Position of the first wheel at t = 0, negative before the structure; 0 or, backward, the end of the line."""
    direction: Annotated[str, OneOf(("forward", "backward"))] = "forward"
    """Along increasing positions, or against them."""
    line: Annotated[Name | None, Field(examples=["track2"])] = None
    """Running line of the wheels that name none."""
    lines: Annotated[dict[str, Name] | None, Field(examples=["{left: left2, right: right2}"])] = None
    """Running lines of the structure, by the lines that the wheels name."""
    delay: Delay = 0.0
    """The train is at its start this much later than t = 0; before, it runs at its first speed."""

    @property
    def stands(self) -> bool:
        """Whether it never moves."""
        if self.speed_history is not None:
            return not any(v for _, v in self.speed_history)
        return self.speed == 0.0 and (self.acceleration or 0.0) <= 0.0

    @model_validator(mode="after")
    def _moves(self) -> Self:
        if self.speed is None and self.speed_history is None:
            raise InputError("is missing", field="speed", fix="Add speed: 80 km/h, or a speed_history")
        if self.speed is not None and self.speed_history is not None:
            raise InputError("says again what speed says", field="speed_history", fix="Keep one of the two")
        if self.speed_history is not None and self.speed_history[0][0] != 0.0:
            raise InputError("must begin at 0 s", field="speed_history.0.0", fix="Add the speed at 0 s")
        if self.line is not None and self.lines is not None:
            raise InputError("says again what line says", field="lines", fix="Keep one of the two")
        self._accelerates()
        if self.stands and "start" not in self.model_fields_set:
            field = "speed" if self.speed_history is None else "speed_history"
            raise InputError(
                "must be positive for a train that crosses",
                field=field,
                fix="A train that stands needs start: 12.5 m",
            )
        return self

    def _accelerates(self) -> None:
        """Check acceleration and to_speed."""
        if self.acceleration is None:
            if self.to_speed is not None:
                fix = "Add acceleration: 0.5 m/s^2"
                raise InputError("needs an acceleration", field="to_speed", fix=fix)
            return
        if self.speed is None:
            raise InputError(
                "goes with speed", field="acceleration", fix="Leave it out: speed_history says it"
            )
        if self.acceleration == 0.0:
            raise InputError(
                "must not be zero", field="acceleration", fix="Leave it out for a constant speed"
            )
        if self.to_speed is not None and (self.to_speed - self.speed) * self.acceleration <= 0.0:
            way = "more" if self.acceleration > 0.0 else "less"
            raise InputError(
                f"must be {way} than the speed, {show(self.speed, SPEED)}",
                field="to_speed",
                fix="A train that brakes has a negative acceleration" if way == "more" else None,
            )


class Crossing(Movement):
    """How the first train moves, and on what surface."""

    irregularity: Annotated[Irregularity, Field(json_schema_extra=KINDS.words_in_schema)] = NoIrregularity(
        kind="none"
    )
    """Irregularity of the surface; none when left out."""
