"""Semi-analytical and closed-form solutions that the rest is checked against; no solver uses them.

Each is derived in ``docs/theory/reference-solutions.md``, whose equations the docstrings cite as (R1) and on.
"""

from .beam_frequencies import euler_bernoulli_frequencies, euler_bernoulli_roots, timoshenko_frequencies
from .beam_modes import ModalResponse, SimplySupportedBeam
from .dof_systems import BodyMotion, SuspendedBody
from .motion import Motion
from .moving_force import cross_forces, midspan_amplification
from .moving_wheels import cross_wheel_units
from .plain_crossing import PlainResponse, cross_plain_vehicles
from .plain_vehicles import Axle, PlainVehicle, articulated_truck, coach, half_car, quarter_car
from .profiles import Profile, harmonic, level
from .responses import CrossingResponse, Impact
from .rides import ride
from .sleepers import SleeperTrack
from .sprung_masses import Newmark, cross_sprung_masses, cross_sprung_masses_newmark
from .static_beams import point_load_deflection, point_load_moment, uniform_load_deflection
from .wheel_unit import WheelUnit
from .winkler import WinklerBeam

__all__ = [
    "Axle",
    "BodyMotion",
    "CrossingResponse",
    "Impact",
    "ModalResponse",
    "Motion",
    "Newmark",
    "PlainResponse",
    "PlainVehicle",
    "Profile",
    "SimplySupportedBeam",
    "SleeperTrack",
    "SuspendedBody",
    "WheelUnit",
    "WinklerBeam",
    "articulated_truck",
    "coach",
    "cross_forces",
    "cross_plain_vehicles",
    "cross_sprung_masses",
    "cross_sprung_masses_newmark",
    "cross_wheel_units",
    "euler_bernoulli_frequencies",
    "euler_bernoulli_roots",
    "half_car",
    "harmonic",
    "level",
    "midspan_amplification",
    "point_load_deflection",
    "point_load_moment",
    "quarter_car",
    "ride",
    "timoshenko_frequencies",
    "uniform_load_deflection",
]
