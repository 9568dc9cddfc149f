"""Analysis and output: what is accepted stands at the top."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Final, Literal, Self

from pydantic import BeforeValidator, ConfigDict, Discriminator, Field, model_validator

from axlespan.errors import InputError
from axlespan.interaction.outputs import ENVELOPES
from axlespan.interaction.settings import CUTS, LOST_AFTER, MOST_CUTS
from axlespan.study.case_contact import KINDS as CONTACT_KINDS
from axlespan.study.case_contact import Contact, RigidContact
from axlespan.study.check_lists import Several
from axlespan.study.checks import Location, Measured, OneOf, Part, Whole
from axlespan.study.faults import InputErrors, listed, nearest
from axlespan.study.kinds import LIST, MAPPING, Kinds, list_or_mapping, tag
from axlespan.study.quantities import Count, Duration, Factor, Flag, Footprint, Gravity, Text
from axlespan.units import LENGTH, NUMBER, RATIO, TIME

METHODS: Final = ("direct", "iterative", "refactored")
BASES: Final = ("full", "reduced")
VEHICLES: Final = ("full", "moving-masses", "axle-loads")
COMPARISONS: Final = ("neves2012-3.1", "neves2012-3.2")
SOLVERS: Final = ("auto", "banded", "superlu", "pardiso", "cholmod")
AUTO: Final = "auto"


def _read_footprint(raw: Any) -> Any:
    if isinstance(raw, str) and raw.strip().isalpha() and raw != AUTO:
        raise InputError("must be a length, or auto", value=raw, fix="Write auto, or a length such as 300 mm")
    return raw


def _either_end(schema: dict[str, Any]) -> None:
    schema["oneOf"] = [{"required": ["steps"]}, {"required": ["duration"]}]


class ThreeSleepers(Part):
    """25, 50 and 25 % of a wheel's force on three sleepers, EN 1991-2 6.3.6.1; they move with the wheel."""

    kind: Literal["sleepers"]
    spacing: Annotated[float, Measured(LENGTH, above=0.0, believable=(0.2, 3.0))] = 0.6
    """Spacing of the sleepers."""


_DISTRIBUTIONS = Kinds(
    "load distribution", ("sleepers",), "{kind: sleepers, spacing: 0.6 m}", words_alone=("point", "sleepers")
)


def _read_distribution(raw: Any) -> Any:
    return None if raw is None or raw == "point" else _DISTRIBUTIONS.checked(raw)


class Analysis(Part):
    """Time integration by the alpha method, and how contact is treated."""

    model_config = ConfigDict(json_schema_extra=_either_end)

    time_step: Duration
    """Time step."""
    steps: Annotated[Count | None, Field(examples=["14000"])] = None
    """Number of time steps."""
    duration: Duration | None = None
    """Time that is simulated, in place of steps; rounded up to whole steps."""
    alpha: Annotated[float, Measured(NUMBER, at_least=-1.0 / 3.0, at_most=0.0)] | None = None
    """Numerical damping, N12 (1): from 0, none, to -1/3; when left out, some where wheels have mass."""
    beta: Annotated[float, Measured(NUMBER, above=0.0, at_most=1.0)] | None = None
    """Parameter of N12 (17); (1 - alpha)^2 / 4 when left out."""
    gamma: Annotated[float, Measured(NUMBER, above=0.0, at_most=2.0)] | None = None
    """Parameter of N12 (16); 1/2 - alpha when left out."""
    method: Annotated[str, OneOf(METHODS)] = "direct"
    """How structure and vehicles are solved together."""
    basis: Annotated[str, OneOf(BASES)] = "full"
    """All d.o.f. of the structure, or a reduced basis of modes."""
    modes: Count | None = None
    """Number of modes that a reduced basis holds beside its Ritz vectors; none when left out."""
    basis_tolerance: Annotated[float, Measured(RATIO, above=0.0, at_most=0.5)] | None = None
    """Estimated error, relative to the largest displacement, that a reduced basis must reach by itself."""
    contact: Annotated[Contact, Field(json_schema_extra=CONTACT_KINDS.words_in_schema)] = RigidContact(
        kind="rigid"
    )
    """Contact of wheel and surface, where an entry of the train says nothing else."""
    lost_after: Duration = LOST_AFTER
    """Time for which all wheels of a vehicle may be in the air before the run stops."""
    cuts: Annotated[int, Whole(at_least=0, at_most=MOST_CUTS)] = CUTS
    """How often the time step may be halved where nonlinear springs or contact do not converge: 4 for 16 parts, 0 for none."""
    vehicles: Annotated[str, OneOf(VEHICLES)] = "full"
    """Vehicles as they are, as masses that follow the line, or as moving forces of their axle loads."""
    footprint: Annotated[
        Annotated[Literal["auto"], tag("word")] | Annotated[Footprint, tag("length")],
        Discriminator(lambda raw: "<word>" if raw == AUTO else "<length>"),
        BeforeValidator(_read_footprint),
    ] = AUTO
    """Length over which a wheel spreads its force; 0 for a point."""
    load_distribution: Annotated[
        ThreeSleepers | None,
        BeforeValidator(_read_distribution),
        Field(examples=["sleepers"], json_schema_extra=_DISTRIBUTIONS.words_in_schema),
    ] = None
    """How an axle load reaches a structure without track: in one point, or by three sleepers."""
    tolerance: Factor | None = None
    """Of the iterative method: change of the contact forces, relative to the largest, at which it stops."""
    relaxation: Annotated[float, Measured(NUMBER, above=0.0, at_most=1.0)] | None = None
    """Of the iterative method: share of the new contact forces that is taken over."""
    max_iterations: Count | None = None
    """Of the iterative method."""
    solver: Annotated[str, OneOf(SOLVERS)] = "auto"
    """Solver of the linear systems."""
    threads: Count | None = None
    """Threads of the solver, where it can use them (PARDISO); AXLESPAN_THREADS or one when left out."""
    gravity: Gravity = 9.81
    """Acceleration of gravity, positive."""

    @property
    def step_count(self) -> int:
        """Number of time steps."""
        if self.steps is not None:
            return self.steps
        return max(1, math.ceil((self.duration or 0.0) / self.time_step * (1.0 - 1e-12)))

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.steps is None and self.duration is None:
            raise InputError("is missing", field="steps", fix="Add steps: 14000, or duration: 14 s")
        if self.steps is not None and self.duration is not None:
            raise InputError("says again what steps say", field="duration", fix="Keep one of the two")
        if self.step_count > 10**9:
            raise InputError(
                f"takes {self.step_count:.0e} steps", field="duration", fix="Use a longer time step"
            )
        for name, key, wanted in (
            ("tolerance", "method", "iterative"),
            ("relaxation", "method", "iterative"),
            ("max_iterations", "method", "iterative"),
            ("modes", "basis", "reduced"),
            ("basis_tolerance", "basis", "reduced"),
        ):
            if getattr(self, name) is not None and getattr(self, key) != wanted:
                raise InputError(
                    f"is only for {key}: {wanted}", field=name, fix=f"Write {key}: {wanted}, or leave it out"
                )
        return self


class EveryFew(Part):
    """Whole fields at every so many steps."""

    every: Annotated[Count, Field(examples=["100"])]
    """Steps from one field to the next."""


class SensorOnLine(Part):
    """A place on a running line that it names."""

    at: Annotated[float | str, Location(), Field(examples=["12.5 m"])]
    """Position along the line, or the name of a node of a mesh."""
    line: Annotated[Text, Field(examples=["rail"])]
    """Running line: rail, deck; left and right of two rails; those of a mesh by their names."""


SensorPlace = Annotated[
    Annotated[float | str, Location(), tag("place")] | Annotated[SensorOnLine, MAPPING],
    Discriminator(lambda raw: MAPPING.tag if isinstance(raw, (Mapping, Part)) else "<place>"),
]


class Output(Part):
    """What is recorded."""

    sensors: Annotated[dict[Text, SensorPlace], Field(examples=["{midspan: 12.5 m}"])] = {}  # noqa: RUF012
    """Places on the structure by their names: a position along it (on the deck where it has a track), the name of
    a node of a mesh, or {at: 12.5 m, line: rail}."""
    compare: Annotated[str, OneOf(COMPARISONS)] | None = None
    """A published example whose figures are drawn beside its semi-analytical solution."""
    every: Count = 1
    """Steps from one record to the next."""
    reactions: Flag = True
    """Whether support reactions are recorded."""
    line: Annotated[int, Whole(at_least=0, at_most=2000)] = 41
    """Points along the deck at which displacement and acceleration are recorded; 0 for none."""
    fields: (
        Annotated[
            Annotated[
                tuple[float, ...],
                Several(Measured(TIME, at_least=0.0), "[0.5 s, 1 s], or {every: 100}", increasing=True),
                LIST,
            ]
            | Annotated[EveryFew, MAPPING],
            Discriminator(list_or_mapping),
        ]
        | None
    ) = None
    """Whole fields of displacements and velocities, at a list of times or at every so many steps."""
    section_forces: Annotated[tuple[Text, ...], Field(examples=["[midspan]"])] = ()
    """Sensors at which moment, shear, normal force and torsion of the beams are recorded."""
    stresses: Annotated[tuple[Text, ...], Field(examples=["[midspan]"])] = ()
    """Sensors at which stresses of solids or resultants of shells under the line are recorded."""
    envelopes: Annotated[
        tuple[Annotated[str, OneOf(ENVELOPES)], ...], Field(examples=["[moment, shear]"])
    ] = ()
    """Quantities whose extremes along the running line are recorded."""

    @model_validator(mode="after")
    def _named(self) -> Self:
        faults = []
        if self.line == 1:
            faults.append(InputError("must be 0 or at least 2", field="line", fix="Write 41, or 0 for none"))
        sensors = (("section_forces", self.section_forces), ("stresses", self.stresses))
        for key, number, name in ((key, i, name) for key, names in sensors for i, name in enumerate(names)):
            if name not in self.sensors:
                near = nearest(name, self.sensors)
                known = f"Sensors are {listed(self.sensors)}" if self.sensors else "Add it to the sensors"
                fix = f"Did you mean {near}?" if near else known
                faults.append(InputError("no such sensor", field=f"{key}.{number}", fix=fix))
        for key, names in (*sensors, ("envelopes", self.envelopes)):
            for number, name in enumerate(names):
                if name in names[:number]:
                    faults.append(InputError("is named twice", field=f"{key}.{number}"))
        if faults:
            raise InputErrors(faults)
        return self
