"""Types of the values in a case file, with the magnitudes that they have in practice."""

from __future__ import annotations

from typing import Annotated

from pydantic import Strict

from axlespan.study.checks import Measured, Whole, Word
from axlespan.units import (
    ACCELERATION,
    ANGLE,
    AREA,
    DAMPING,
    DENSITY,
    FORCE,
    FREQUENCY,
    INERTIA,
    LENGTH,
    MASS,
    MASS_PER_LENGTH,
    MOMENT,
    NUMBER,
    PER_TIME,
    PRESSURE,
    RATIO,
    ROTATIONAL_DAMPING,
    ROTATIONAL_STIFFNESS,
    SECOND_MOMENT,
    SPEED,
    STIFFNESS,
    TIME,
)

# What a plain number must lie between: wide enough for laboratory models and the longest bridges, narrow
# enough to catch GPa taken for Pa, t for kg, mm for m, km/h for m/s and percent for ratios.
DISTANCE = Measured(LENGTH, at_least=0.0, believable=(0.01, 1e4))
SPACING = Measured(LENGTH, above=0.0, believable=(0.01, 1e3))
UNEVENNESS = Measured(LENGTH, believable=(0.0, 0.2))
TRAIN_SPEED = Measured(SPEED, at_least=0.0, believable=(0.01, 170.0))
AXLE_LOAD = Measured(FORCE, above=0.0, believable=(1e3, 2e6))

Distance = Annotated[float, DISTANCE]
Spacing = Annotated[float, SPACING]
Unevenness = Annotated[float, UNEVENNESS]
Speed = Annotated[float, TRAIN_SPEED]
TrainAcceleration = Annotated[float, Measured(ACCELERATION, believable=(1e-3, 12.0))]
Length = Annotated[float, Measured(LENGTH)]
SpanLength = Annotated[float, Measured(LENGTH, above=0.0, believable=(0.05, 5e3))]
Wavelength = Annotated[float, Measured(LENGTH, above=0.0, believable=(1e-3, 1e4))]
Thickness = Annotated[float, Measured(LENGTH, above=0.0, believable=(1e-4, 20.0))]
Footprint = Annotated[float, Measured(LENGTH, at_least=0.0, believable=(1e-3, 5.0))]
Area = Annotated[float, Measured(AREA, above=0.0, believable=(1e-7, 1e3))]
SecondMoment = Annotated[float, Measured(SECOND_MOMENT, above=0.0, believable=(1e-14, 1e3))]
Modulus = Annotated[float, Measured(PRESSURE, above=0.0, believable=(1e6, 2e12))]
PoissonRatio = Annotated[float, Measured(NUMBER, above=-1.0, below=0.5)]
Density = Annotated[float, Measured(DENSITY, above=0.0, believable=(20.0, 25e3))]
MassPerLength = Annotated[float, Measured(MASS_PER_LENGTH, above=0.0, believable=(0.1, 1e6))]
BodyMass = Annotated[float, Measured(MASS, above=0.0, believable=(100.0, 1e6))]
PartMass = Annotated[float, Measured(MASS, at_least=0.0, believable=(5.0, 1e6))]
Inertia = Annotated[float, Measured(INERTIA, above=0.0)]
Stiffness = Annotated[float, Measured(STIFFNESS, above=0.0)]
SpringStiffness = Annotated[float, Measured(STIFFNESS, at_least=0.0)]
RotationalStiffness = Annotated[float, Measured(ROTATIONAL_STIFFNESS, above=0.0)]
Dashpot = Annotated[float, Measured(DAMPING, at_least=0.0)]
RollStiffness = Annotated[float, Measured(ROTATIONAL_STIFFNESS, at_least=0.0)]
RollDashpot = Annotated[float, Measured(ROTATIONAL_DAMPING, at_least=0.0)]
BodyForce = Annotated[float, Measured(FORCE, believable=(50.0, 2e6))]
BodyMoment = Annotated[float, Measured(MOMENT, believable=(50.0, 4e6))]
RotationalDashpot = Annotated[float, Measured(ROTATIONAL_DAMPING, at_least=0.0)]
DampingRatio = Annotated[float, Measured(RATIO, at_least=0.0, below=1.0, believable=(1e-6, 0.3))]
Frequency = Annotated[float, Measured(FREQUENCY, above=0.0)]
Rate = Annotated[float, Measured(PER_TIME, at_least=0.0)]
Duration = Annotated[float, Measured(TIME, above=0.0)]
Delay = Annotated[float, Measured(TIME, at_least=0.0)]
Angle = Annotated[float, Measured(ANGLE)]
Gravity = Annotated[float, Measured(ACCELERATION, at_least=0.0)]
Factor = Annotated[float, Measured(NUMBER, above=0.0)]

Count = Annotated[int, Whole()]
Few = Annotated[int, Whole(at_most=100_000)]
Elements = Annotated[int, Whole(at_most=100_000)]  # of a span: beyond, rounding eats its stiffness
Seed = Annotated[int, Whole(at_least=0, at_most=2**63 - 1)]
Text = Annotated[str, Word()]
Line = Annotated[str, Word(folded=True)]
Name = Annotated[str, Word(strict=True)]
Flag = Annotated[bool, Strict()]
