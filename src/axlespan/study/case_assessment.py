"""What a run is assessed for: what is accepted stands at the top."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from axlespan.errors import InputError
from axlespan.standards.assessment import CHECKS, COMFORT_LEVELS, DECKS, MAINTENANCE
from axlespan.standards.assessment import Assessment as Wanted
from axlespan.standards.bridge_values import BRIDGE_TYPES
from axlespan.study.check_lists import Several
from axlespan.study.checks import Measured, OneOf, Part
from axlespan.study.faults import InputErrors
from axlespan.study.quantities import Distance, Factor, Flag, Frequency, Line, SpanLength
from axlespan.units import ACCELERATION, ANGLE, FORCE, LENGTH, SPEED

_Acceleration = Annotated[float, Measured(ACCELERATION, above=0.0, believable=(0.01, 100.0))]
_Small = Annotated[float, Measured(LENGTH, above=0.0, believable=(1e-5, 0.1))]


class Limits(Part):
    """Limits that replace those of the standards."""

    deck_acceleration: Annotated[_Acceleration | None, Field(examples=["3.5 m/s^2"])] = None
    """Vertical acceleration of the deck."""
    deck_frequency: Frequency | None = None
    """Up to which the deck's acceleration counts at least."""
    deflection_ratio: Annotated[Factor | None, Field(examples=["600"])] = None
    """L over the vertical deflection; the smallest that passes."""
    end_rotation: Annotated[float, Measured(ANGLE, above=0.0)] | None = None
    """Rotation of the deck's ends."""
    end_offset: _Small | None = None
    """Vertical offset of the deck's end."""
    twist: _Small | None = None
    """Twist of the track over 3 m."""
    body_acceleration: _Acceleration | None = None
    """Vertical acceleration of car bodies."""
    wheel_unloading: Factor | None = None
    """Unloading over the static wheel force."""
    contact_force: Annotated[float, Measured(FORCE, above=0.0, believable=(1e3, 1e6))] | None = None
    """Vertical force of a wheel."""
    derailment: Factor | None = None
    """Quotient of lateral and vertical wheel force."""
    dynamic_effect: Factor | None = None
    """Dynamic effect of the train over that of load model 71."""
    damping_excess: Factor | None = None
    """Damping ratio of the model over the lower bound."""
    continuous_comfort: _Acceleration | None = None
    """C_Cz of EN 12299."""
    mean_comfort: Factor | None = None
    """N_MV of EN 12299."""
    weighted_rms: _Acceleration | None = None
    """Weighted acceleration of ISO 2631-1."""
    sperling: Factor | None = None
    """Sperling's ride index."""


class Assessment(Part):
    """Rules of the code: without this section nothing is assessed."""

    line_speed: Annotated[
        float | None, Measured(SPEED, above=0.0, believable=(5.0, 170.0)), Field(examples=["300 km/h"])
    ] = None
    """Maximum line speed at the site."""
    deck: Annotated[str, OneOf(DECKS)] = "ballasted"
    """How the track lies on the deck."""
    bridge_type: Annotated[str, OneOf(BRIDGE_TYPES)] | None = None
    """Type of the bridge, for the damping that may be taken."""
    spans: (
        Annotated[
            tuple[float, ...],
            Several(Measured(LENGTH, above=0.0, believable=(0.5, 5e3)), "[18 m, 24 m, 18 m]", alone=True),
        ]
        | None
    ) = None
    """Spans along the deck; those between the supports of beams when left out."""
    continuous: Flag | None = None
    """Whether the deck runs on over its supports; more than one span does when left out."""
    simple: Flag = True
    """Whether it behaves like a simple beam or plate."""
    determinant_length: SpanLength | None = None
    """L_phi of EN 1991-2 table 6.2; by the spans when left out."""
    first_frequency: Frequency | None = None
    """First frequency of vertical bending; that of the model when left out."""
    torsional_frequency: Frequency | None = None
    """First frequency of torsion."""
    maintenance: Annotated[str, OneOf(MAINTENANCE)] = "careful"
    """Of the track."""
    overhang: Distance | None = None
    """From the bearing to the end of the deck."""
    coach_length: SpanLength | None = None
    """Regular distance of the train's axle groups; that of equal vehicles when left out."""
    alpha: Factor = 1.0
    """Classification factor of load model 71."""
    comfort: Annotated[str, OneOf(COMFORT_LEVELS)] = "very-good"
    """Level of comfort that is asked for."""
    limits: Annotated[Limits, Field(examples=["{deck_acceleration: 3.5 m/s^2}"])] = Limits()
    """Values that replace those of the standards."""
    national: Line = ""
    """Where they come from, such as NA to BS EN 1990."""
    checks: Annotated[
        tuple[Annotated[str, OneOf(CHECKS)], ...], Field(examples=["[deck_acceleration, wheel_unloading]"])
    ] = CHECKS
    """What is assessed; everything when left out."""

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        faults = [
            InputError("is named twice", field=f"checks.{number}")
            for number, name in enumerate(self.checks)
            if name in self.checks[:number]
        ]
        if not self.checks:
            faults.append(
                InputError("must name at least one check", field="checks", fix="Leave it out for all")
            )
        if faults:
            raise InputErrors(faults)
        return self

    def wanted(self) -> Wanted:
        """Return the assessment in the terms of :mod:`axlespan.standards`."""
        own = {name: value for name, value in self if name != "limits"}
        return Wanted(**own, limits=self.limits.given())
