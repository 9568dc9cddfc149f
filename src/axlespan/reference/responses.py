"""What a crossing of vehicles gives: motions of beam, wheels and bodies, and contact forces."""

from __future__ import annotations

from dataclasses import dataclass

from ._inputs import FloatArray
from .beam_modes import ModalResponse


@dataclass(frozen=True)
class Impact:
    """The impulse that a kink in the path gives to a wheel with mass, upward positive."""

    time: float  # [s]
    vehicle: int  # counts from 0, the head of the row
    impulse: float  # [Ns]


@dataclass(frozen=True)
class CrossingResponse:
    """A crossing in the semi-analytical model; all motions upward positive.

    Displacements of bodies are from the static position on level ground. ``contact_force`` acts on the
    vehicle, so compression is positive; the impulses of `Impact` come on top of it.
    """

    time: FloatArray  # (time,) [s]
    position: FloatArray  # (time, vehicle) [m]
    beam: ModalResponse
    body_displacement: FloatArray  # (time, vehicle) [m]
    body_velocity: FloatArray  # (time, vehicle) [m/s]
    body_acceleration: FloatArray  # (time, vehicle) [m/s2]
    wheel_displacement: FloatArray  # (time, vehicle) [m]
    wheel_velocity: FloatArray  # (time, vehicle) [m/s]
    wheel_acceleration: FloatArray  # (time, vehicle) [m/s2], nan where the profile gives no curvature
    contact_force: FloatArray  # (time, vehicle) [N]
    impacts: tuple[Impact, ...] = ()
