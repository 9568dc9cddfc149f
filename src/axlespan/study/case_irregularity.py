"""The irregularity of a surface: profiles, spectra, single defects, sums of them, and one for each line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, ConfigDict, Field, ValidationInfo, field_validator, model_validator

from axlespan.errors import InputError
from axlespan.study.case_defects import (
    DEFECTS,
    BumpIrregularity,
    DippedJointIrregularity,
    PotholeIrregularity,
    RampIrregularity,
    SettlementIrregularity,
    SquatIrregularity,
)
from axlespan.study.check_lists import Several, Table
from axlespan.study.checks import Measured, Part
from axlespan.study.faults import listed, nearest
from axlespan.study.filters import Band, Detrended
from axlespan.study.kinds import ExistingFile, Kinds, tag
from axlespan.study.quantities import (
    UNEVENNESS,
    Angle,
    Count,
    Distance,
    Factor,
    Flag,
    Length,
    Name,
    Seed,
    SpanLength,
    Text,
    Unevenness,
    Wavelength,
)
from axlespan.units import LENGTH, NUMBER, show


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
    """A measured profile, linear between its points; the heights at its ends go on.

    First it loses its trend, then a band of wavelengths is taken, then it is scaled and shifted; ``from`` and ``to``
    are positions on the line.
    """

    kind: Literal["table"]
    points: Annotated[tuple[tuple[float, float], ...], Table(Measured(LENGTH), UNEVENNESS)] | None = None
    """Pairs of position and height."""
    file: Annotated[Path, ExistingFile()] | None = None
    """Text file with a position and a height [m] in each line, in place of points."""
    smooth: Flag = False
    """Whether it is a smooth curve through its points, without kinks; straight between them when left out."""
    detrend: Annotated[int | None, Detrended()] = None
    """Degree of the polynomial that is taken away: 0 the mean, 1 a straight line; true is 1."""
    band: Annotated[str | tuple[float, float] | None, Band()] = None
    """Wavelengths that are kept: D1, D2 or D3 of EN 13848-1, or the shortest and the longest."""
    scale: Annotated[float, Measured(NUMBER)] = 1.0
    """Factor on the heights; -1 for a record that counts downward."""
    shift: Length = 0.0
    """How far it is moved along the line: what the record has at 0 comes here."""

    @property
    def is_filtered(self) -> bool:
        """Whether its points must be at equal distances."""
        return self.detrend is not None or self.band is not None

    @field_validator("scale", mode="after")
    @classmethod
    def _not_even(cls, scale: float) -> float:
        if scale == 0.0:
            raise InputError("must not be zero", value=scale, fix="Write irregularity: none")
        return scale

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


_EXAMPLE = "{kind: harmonic, amplitude: 0.5 mm, wavelength: 5 m}"
_SINGLE = ("none", "harmonic", "table", "spectrum", *DEFECTS)
_TERM = Kinds("irregularity", _SINGLE, _EXAMPLE, words_alone=("none",))


def _no_sum_in_a_sum(raw: Any) -> Any:
    """Refuse what has no place in a sum, with a word on where it has one."""
    kind = raw.get("kind") if isinstance(raw, Mapping) else None
    if kind == "lines":
        fix = "Write a sum for each line: {kind: lines, lines: {left: {kind: sum, of: [...]}}}"
        raise InputError("must not stand in a sum", field="kind", value=kind, fix=fix)
    if kind == "sum":
        raise InputError(
            "must not stand in a sum", field="kind", value=kind, fix="Write its parts into the sum around it"
        )
    return _TERM.checked(raw)


# All kinds that are no collections of others.
_Single = (
    Annotated[NoIrregularity, tag("none")]
    | Annotated[HarmonicIrregularity, tag("harmonic")]
    | Annotated[TableIrregularity, tag("table")]
    | Annotated[SpectrumIrregularity, tag("spectrum")]
    | Annotated[BumpIrregularity, tag("bump")]
    | Annotated[RampIrregularity, tag("ramp")]
    | Annotated[DippedJointIrregularity, tag("dipped-joint")]
    | Annotated[SquatIrregularity, tag("squat")]
    | Annotated[PotholeIrregularity, tag("pothole")]
    | Annotated[SettlementIrregularity, tag("settlement")]
)
_Term = Annotated[
    _Single,
    _TERM.discriminator(),
    BeforeValidator(_no_sum_in_a_sum),
]


class SumIrregularity(Part):
    """Several irregularities added up: a spectrum with a dipped joint in it."""

    kind: Literal["sum"]
    of: Annotated[
        tuple[Annotated[_Term, Field(json_schema_extra=_TERM.words_in_schema)], ...],
        Field(
            examples=["[{kind: spectrum, name: german-low, seed: 1}, {kind: bump, at: 12 m, ...}]"],
            json_schema_extra={"minItems": 1},
        ),
    ]
    """What is added up."""

    @model_validator(mode="after")
    def _of_one_line_each(self) -> Self:
        if not self.of:
            raise InputError("adds up nothing", field="of", fix="Write irregularity: none, or fill the list")
        for number, one in enumerate(self.of):
            if isinstance(one, SpectrumIrregularity) and one.rails is not None:
                raise InputError(
                    "goes with a spectrum that stands alone",
                    field=f"of.{number}.rails",
                    fix="Leave rails out, or give each line its sum: {kind: lines, lines: {left: ..., right: ...}}",
                )
        return self


_ONE = Kinds("irregularity", (*_SINGLE, "sum"), _EXAMPLE, words_alone=("none",))
_OfOneLine = Annotated[
    _Single | Annotated[SumIrregularity, tag("sum")],
    _ONE.discriminator(),
    BeforeValidator(_ONE.checked),
]


class LinesIrregularity(Part):
    """An irregularity for each of several running lines; lines that are not named are even."""

    kind: Literal["lines"]
    lines: Annotated[
        dict[str, Annotated[_OfOneLine, Field(json_schema_extra=_ONE.words_in_schema)]],
        Field(
            examples=["{left: {kind: harmonic, amplitude: 1 mm, wavelength: 5 m}}"],
            json_schema_extra={"minProperties": 1},
        ),
    ]
    """Irregularities by the names of lines."""

    @model_validator(mode="after")
    def _of_one_each(self) -> Self:
        if not self.lines:
            raise InputError(
                "names no line", field="lines", fix="Write irregularity: none, or name lines: {main: {...}}"
            )
        for name, one in self.lines.items():
            if isinstance(one, SpectrumIrregularity) and one.rails is not None:
                raise InputError(
                    "goes with a spectrum for the whole track",
                    field=f"lines.{name}.rails",
                    fix="Write irregularity: {kind: spectrum, ..., rails: [left, right]}",
                )
        return self


KINDS = Kinds("irregularity", (*_SINGLE, "sum", "lines"), _EXAMPLE, words_alone=("none",))
Irregularity = Annotated[
    _Single | Annotated[SumIrregularity, tag("sum")] | Annotated[LinesIrregularity, tag("lines")],
    KINDS.discriminator(),
    BeforeValidator(KINDS.checked),
]
