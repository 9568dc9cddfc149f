"""The two examples of Neves, Azevedo and Calçada (2012), semi-analytically.

S.G.M. Neves, A.F.M. Azevedo, R. Calçada, A direct method for analyzing the vertical vehicle-structure
interaction, Engineering Structures 34 (2012), cited as N12.
"""

from __future__ import annotations

import numpy as np

from .beam_modes import SimplySupportedBeam
from .motion import Motion
from .profiles import Profile, harmonic
from .responses import CrossingResponse
from .sprung_masses import cross_sprung_masses, cross_sprung_masses_newmark
from .wheel_unit import WheelUnit

BEAM = SimplySupportedBeam(length=25.0, bending_stiffness=2.87e9 * 2.90, mass_per_length=2303.0)
MASS = WheelUnit.sprung_mass(mass=5750.0, stiffness=1.595e6)
IRREGULARITY = harmonic(0.5e-3, 5.0, start=0.0, end=25.0)
TIME_STEP = 1e-3  # [s]


def single_mass(*, converged: bool = False, modes: int = 20) -> CrossingResponse:
    """Return example 3.1: one sprung mass at 100 km/h, 900 steps of 1 ms.

    Parameters
    ----------
    converged : bool, optional
        Converged in time instead of N12's Newmark steps.
    modes : int, optional
    """
    return _cross(1, 100.0 / 3.6, 900, None, modes, 1e-4 if converged else None)


def mass_train(*, converged: bool = False, modes: int = 20) -> CrossingResponse:
    """Return example 3.2: 50 sprung masses at 47.7 km/h over a harmonic irregularity, 14 000 steps of 1 ms.

    Parameters
    ----------
    converged : bool, optional
        Converged in time instead of N12's Newmark steps: to 4 parts in 10^6 for motions and contact forces
        of the masses; the beam's accelerations would need shorter steps.
    modes : int, optional
    """
    return _cross(50, 47.7 / 3.6, 14_000, IRREGULARITY, modes, 1e-3 if converged else None)


def _cross(
    count: int, speed: float, steps: int, profile: Profile | None, modes: int, max_step: float | None
) -> CrossingResponse:
    masses, motion = [MASS] * count, Motion.spaced(speed, count, 3.0)
    if max_step is not None:
        time = TIME_STEP * np.arange(steps + 1)
        return cross_sprung_masses(
            BEAM, masses, motion, time, modes=modes, profile=profile, max_step=max_step
        )
    return cross_sprung_masses_newmark(BEAM, masses, motion, TIME_STEP, steps, modes=modes, profile=profile)
