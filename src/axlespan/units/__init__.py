"""Numbers with units, as engineers write them: ``47.7 km/h``, ``2.87 GPa``, ``1595 kN/m``, ``20 kNs/m``.

SI inside, units at the edges. A plain number is taken as SI. Angles are kept apart from pure numbers, so that
``5 deg`` is no damping ratio and ``30 rad/s`` is no frequency in hertz.
"""

from axlespan.units.dimensions import (
    ACCELERATION,
    ANGLE,
    AREA,
    DAMPING,
    DENSITY,
    FORCE,
    FREQUENCY,
    HERTZ_STIFFNESS,
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
    Dimension,
)
from axlespan.units.quantity import Reading, factor, parse, read, show
from axlespan.units.symbols import Exponents

__all__ = [
    "ACCELERATION",
    "ANGLE",
    "AREA",
    "DAMPING",
    "DENSITY",
    "FORCE",
    "FREQUENCY",
    "HERTZ_STIFFNESS",
    "INERTIA",
    "LENGTH",
    "MASS",
    "MASS_PER_LENGTH",
    "MOMENT",
    "NUMBER",
    "PER_TIME",
    "PRESSURE",
    "RATIO",
    "ROTATIONAL_DAMPING",
    "ROTATIONAL_STIFFNESS",
    "SECOND_MOMENT",
    "SPEED",
    "STIFFNESS",
    "TIME",
    "Dimension",
    "Exponents",
    "Reading",
    "factor",
    "parse",
    "read",
    "show",
]
