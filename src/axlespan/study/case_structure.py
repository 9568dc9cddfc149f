"""Structures: beams that are described in the case file itself."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from axlespan.errors import InputError
from axlespan.study.case_condition import DamagedZone, Temperature
from axlespan.study.case_damping import StructuralDamping
from axlespan.study.case_elements import OwnElements
from axlespan.study.case_grid import BeamGrid
from axlespan.study.case_imported import MeshStructure
from axlespan.study.case_laws import NonlinearSprings
from axlespan.study.case_matrices import MatricesStructure
from axlespan.study.case_support import Bearing, MayLift, Springs, Support
from axlespan.study.case_track import Laid, TrackStructure
from axlespan.study.checks import OneOf, Part
from axlespan.study.faults import InputErrors
from axlespan.study.kinds import Kinds, tag
from axlespan.study.quantities import (
    Area,
    Elements,
    Length,
    MassPerLength,
    Modulus,
    PoissonRatio,
    SecondMoment,
    SpanLength,
)
from axlespan.units import LENGTH, show

_REQUIRED_OF_SPANS = ("youngs_modulus", "second_moment", "mass_per_length", "elements")
_APART = 1e-5  # share of the length; supports that are closer are at one place
_EXAMPLES = {
    "youngs_modulus": "34 GPa",
    "second_moment": "2.90 m^4",
    "mass_per_length": "12 t/m",
    "elements": "20",
}


class SimpleSpan(Part):
    """A beam on two supports; ``supports`` replaces them where it is given."""

    kind: Literal["simple-span"]
    length: SpanLength
    """Span."""
    youngs_modulus: Annotated[Modulus, Field(examples=["34 GPa"])]
    """Young's modulus."""
    second_moment: SecondMoment
    """Second moment of area for bending in the vertical plane."""
    mass_per_length: MassPerLength
    """Mass of the beam and all that it carries for good."""
    elements: Annotated[Elements, Field(examples=["20"])]
    """Number of beam elements."""
    damping: StructuralDamping | None = None
    """Structural damping; none when left out."""
    area: Area | None = None
    """Area of the cross-section, for axial stiffness and with ``mass_per_length`` for rotary inertia."""
    shear_area: Area | None = None
    """Shear area: makes it a Timoshenko beam; needs ``poisson_ratio``."""
    poisson_ratio: PoissonRatio | None = None
    """Poisson's ratio, for the shear modulus."""
    supports: tuple[Support, ...] | None = None
    """Supports in place of the two at the ends."""
    damage: Annotated[
        tuple[DamagedZone, ...], Field(examples=["[{from: 10 m, to: 12 m, stiffness: 0.8}]"])
    ] = ()
    """Zones that have lost stiffness."""
    temperature: Annotated[Temperature | None, Field(examples=["{value: 25, coefficient: -0.003}"])] = None
    """Temperature that the stiffness follows; no effect when left out."""
    may_lift: MayLift = ()
    """Supports on springs that only push: bearings that may lift. Own weight acts first then."""
    nonlinear_springs: NonlinearSprings = ()
    """Springs and dashpots that follow a law: pads, ballast, supports. Own weight acts first then."""
    own_elements: OwnElements = ()
    """Nonlinear elements of one's own, written in Python. Own weight acts first then."""
    track: Laid = None
    """Track on the bridge, before and behind it; wheels run on the deck when left out."""

    @model_validator(mode="after")
    def _fits(self) -> Self:
        _check_shear(self)
        _check_supports(self.supports, self.length)
        return self


class BeamProperties(Part):
    """What a span of a continuous beam is made of; each may stand in the span or in the structure."""

    youngs_modulus: Modulus | None = None
    """Young's modulus."""
    second_moment: SecondMoment | None = None
    """Second moment of area for bending in the vertical plane."""
    mass_per_length: MassPerLength | None = None
    """Mass of the beam and all that it carries for good."""
    elements: Elements | None = None
    """Number of beam elements of a span."""
    area: Area | None = None
    """Area of the cross-section."""
    shear_area: Area | None = None
    """Shear area: makes it a Timoshenko beam; needs ``poisson_ratio``."""
    poisson_ratio: PoissonRatio | None = None
    """Poisson's ratio, for the shear modulus."""


class Span(BeamProperties):
    """One span of a continuous beam; what it does not say, the structure says for all spans."""

    length: SpanLength
    """Distance between the supports of the span."""


class SectionAt(Part):
    """A section of a beam at one place; between places it varies linearly."""

    at: Annotated[Length, Field(examples=["0 m"])]
    """Position along the beam."""
    second_moment: SecondMoment | None = None
    """Second moment of area there, in place of that of the span."""
    mass_per_length: MassPerLength | None = None
    """Mass per length there, in place of that of the span."""


class _Spans(BeamProperties):
    """A deck over several spans. Once validated, each span holds all of its properties."""

    spans: Annotated[tuple[Span, ...], Field(examples=["[{length: 20 m}, {length: 25 m}]"])]
    """The spans, in the direction of travel."""
    stations: Annotated[
        tuple[SectionAt, ...] | None, Field(examples=["[{at: 0 m, second_moment: 2 m^4}, ...]"])
    ] = None
    """Sections that vary along the deck."""
    damping: StructuralDamping | None = None
    """Structural damping; none when left out."""
    damage: Annotated[
        tuple[DamagedZone, ...], Field(examples=["[{from: 10 m, to: 12 m, stiffness: 0.8}]"])
    ] = ()
    """Zones that have lost stiffness."""
    temperature: Annotated[Temperature | None, Field(examples=["{value: 25, coefficient: -0.003}"])] = None
    """Temperature that the stiffness follows; no effect when left out."""
    may_lift: MayLift = ()
    """Supports on springs that only push: bearings that may lift. Own weight acts first then."""
    nonlinear_springs: NonlinearSprings = ()
    """Springs and dashpots that follow a law: pads, ballast, supports. Own weight acts first then."""
    own_elements: OwnElements = ()
    """Nonlinear elements of one's own, written in Python. Own weight acts first then."""
    track: Laid = None
    """Track on the bridge, before and behind it; wheels run on the deck when left out."""

    @property
    def length(self) -> float:
        """Length of all spans [m]."""
        return sum(span.length for span in self.spans)

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if not self.spans:
            raise InputError(
                "must have at least one span", field="spans", fix="Write spans: [{length: 20 m}]"
            )
        common = {name: getattr(self, name) for name in BeamProperties.model_fields}
        spans = tuple(
            span.model_copy(
                update={name: value for name, value in common.items() if getattr(span, name) is None}
            )
            for span in self.spans
        )
        missing = [
            InputError(
                "is missing; neither the span nor the structure gives it",
                field=f"spans.{number}.{name}",
                fix=f"Add {name}: {_EXAMPLES[name]} to the span, or to the structure for all spans",
            )
            for number, span in enumerate(spans)
            for name in _REQUIRED_OF_SPANS
            if getattr(span, name) is None
        ]
        if missing:
            raise InputErrors(missing)
        for number, span in enumerate(spans):
            _check_shear(span, f"spans.{number}.")
        return self.model_copy(update={"spans": spans})


class ContinuousBeam(_Spans):
    """A beam over several spans, supported at the ends of each; ``supports`` replaces them where it is given."""

    kind: Literal["continuous-beam"]
    supports: tuple[Support, ...] | None = None
    """Supports in place of those at the ends of the spans."""

    @model_validator(mode="after")
    def _on_the_beam(self) -> Self:
        _check_supports(self.supports, self.length)
        return self


class SimpleSpans(_Spans):
    """Simply supported decks one behind the other, each on its own bearings."""

    kind: Literal["simple-spans"]
    bearings: Bearing | None = None
    """Bearings at both ends of each deck; rigid when left out."""


class ColumnUnder(Part):
    """A column, pier or abutment wall under the deck."""

    at: Annotated[Length, Field(examples=["0 m"])]
    """Position along the deck."""
    height: Annotated[SpanLength, Field(examples=["8 m"])]
    """From the axis of the deck down to the foot."""
    youngs_modulus: Annotated[Modulus, Field(examples=["34 GPa"])]
    """Young's modulus."""
    second_moment: SecondMoment
    """Second moment of area for bending in the plane of the frame."""
    area: Area
    """Area of the cross-section."""
    mass_per_length: MassPerLength | None = None
    """Mass of the column; none when left out."""
    top: Annotated[str, OneOf(("rigid", "hinged"))] = "rigid"
    """Joint with the deck."""
    base: Annotated[str, OneOf(("fixed", "pinned"))] = "fixed"
    """What holds the foot."""
    base_stiffness: Springs | None = None
    """Springs of the foundation, in place of base; x and z are rigid where it does not name them."""


class Frame(_Spans):
    """A deck on columns that it is one with: portal frames, integral bridges, viaducts."""

    kind: Literal["frame"]
    columns: Annotated[
        tuple[ColumnUnder, ...], Field(examples=["[{at: 0 m, height: 8 m, second_moment: 0.2 m^4, ...}]"])
    ]
    """Columns under the deck."""
    supports: tuple[Support, ...] | None = None
    """Other supports of the deck: bearings, springs of the soil behind an abutment."""

    @model_validator(mode="after")
    def _stands(self) -> Self:
        _check_supports(self.supports, self.length)
        faults = []
        if not self.columns:
            faults.append(InputError("has no column", field="columns", fix="Use kind: continuous-beam"))
        for number, column in enumerate(self.columns):
            if not -1e-9 * self.length <= column.at <= (1.0 + 1e-9) * self.length:
                rule = f"must lie on the deck, from 0 to {show(self.length, LENGTH, 6)}"
                faults.append(InputError(rule, field=f"columns.{number}.at"))
        for number, span in enumerate(self.spans):
            if span.area is None:
                rule = "is missing; the deck of a frame is pushed along its axis"
                faults.append(InputError(rule, field=f"spans.{number}.area", fix="Add area: 4 m^2"))
        if faults:
            raise InputErrors(faults)
        return self


def _check_shear(beam: SimpleSpan | Span, prefix: str = "") -> None:
    if beam.shear_area is not None and beam.poisson_ratio is None:
        raise InputError(
            "is missing; shear_area needs it for the shear modulus",
            field=f"{prefix}poisson_ratio",
            fix="Add poisson_ratio: 0.2",
        )


def _check_supports(supports: tuple[Support, ...] | None, length: float) -> None:
    """Require positions on the beam, all different."""
    faults: list[InputError] = []
    seen: list[tuple[float, int]] = []
    for number, support in enumerate(supports or ()):
        at, field = support.at, f"supports.{number}.at"
        if isinstance(at, str):
            rule = "must be a position along the beam; it has no named nodes"
            faults.append(InputError(rule, field=field, fix="Write a length, such as 25 m"))
        elif not -1e-9 * length <= at <= (1.0 + 1e-9) * length:
            faults.append(
                InputError(f"must lie on the beam, from 0 to {show(length, LENGTH, 6)}", field=field)
            )
        elif near := [other for place, other in seen if abs(at - place) <= _APART * length]:
            rule = f"has a support already, supports.{near[0]}"
            faults.append(InputError(rule, field=field, fix="Put all directions into one of them"))
        else:
            seen.append((at, number))
    if supports is not None and not supports:
        faults.append(InputError("holds nothing", field="supports", fix="Add [{at: 0 m, fixed: [z]}, ...]"))
    if faults:
        raise InputErrors(faults)


KINDS = Kinds(
    "structure",
    ("simple-span", "continuous-beam", "mesh", "matrices", "simple-spans", "frame", "beam-grid", "track"),
    "{kind: simple-span, length: 25 m, ...}",
)
Structure = Annotated[
    Annotated[SimpleSpan, tag("simple-span")]
    | Annotated[ContinuousBeam, tag("continuous-beam")]
    | Annotated[MeshStructure, tag("mesh")]
    | Annotated[MatricesStructure, tag("matrices")]
    | Annotated[SimpleSpans, tag("simple-spans")]
    | Annotated[Frame, tag("frame")]
    | Annotated[BeamGrid, tag("beam-grid")]
    | Annotated[TrackStructure, tag("track")],
    KINDS.discriminator(),
    BeforeValidator(KINDS.checked),
]
