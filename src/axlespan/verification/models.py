"""The beam that most cases use, N12's, as a finite element model and in closed form; and who crosses it."""

from __future__ import annotations

from collections.abc import Sequence

import axlespan as asp
from axlespan.bridges import SupportAt
from axlespan.model.damping import Damping
from axlespan.reference.neves2012 import BEAM, MASS

LENGTH = BEAM.length  # [m]
YOUNGS_MODULUS, SECOND_MOMENT = 2.87e9, 2.90  # [Pa], [m^4]
BENDING_STIFFNESS = YOUNGS_MODULUS * SECOND_MOMENT  # [N m^2]
MASS_PER_LENGTH = BEAM.mass_per_length  # [kg/m]
GRAVITY = 9.81  # [m/s^2]
WEIGHT = MASS.mass * GRAVITY  # of N12's vehicle [N]


def beam(
    elements: int = 50,
    *,
    spans: int = 1,
    damping: Damping | None = None,
    supports: Sequence[SupportAt] | None = None,
) -> asp.Structure:
    """N12's beam, or several of them in a row as one continuous beam; elements per span."""
    return asp.bridges.continuous_beam(
        spans=[LENGTH] * spans,
        youngs_modulus=YOUNGS_MODULUS,
        second_moment=SECOND_MOMENT,
        mass_per_length=MASS_PER_LENGTH,
        elements=elements,
        damping=damping,
        supports=supports,
    )


def axle(load: float) -> asp.Train:
    """One moving force [N]."""
    return asp.Train.of(asp.vehicles.axle_loads(loads=load))


def sprung_masses(
    count: int = 1, spacing: float = 3.0, *, damping: float = 0.0, unsprung_mass: float = 0.0
) -> asp.Train:
    """N12's vehicles, with a dashpot [N s/m] and a wheel [kg] where wanted."""
    vehicle = asp.vehicles.sprung_mass(
        mass=MASS.body_mass, stiffness=MASS.stiffness, damping=damping, unsprung_mass=unsprung_mass
    )
    return asp.Train.of(vehicle, count, spacing)
