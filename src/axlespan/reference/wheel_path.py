"""The path of the wheels: rigid ground, the beam between, the irregularity on both."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ._inputs import FloatArray, require_same_length
from .beam_modes import ModalResponse, SimplySupportedBeam
from .motion import Motion
from .profiles import Profile
from .responses import CrossingResponse, Impact
from .wheel_unit import UnitTable


@dataclass(frozen=True)
class WheelPath:
    """Kinematics of wheels that follow beam and irregularity: theory, (R9) to (R11).

    A wheel at xi is at ``y = r(xi) + theta w(xi, t)``, theta = 1 on the beam and 0 off it.
    """

    beam: SimplySupportedBeam
    modes: int
    motion: Motion
    profile: Profile
    units: UnitTable

    def __post_init__(self) -> None:
        require_same_length("motion.offsets", len(self.motion.offsets), self.units.mass.size)
        for order in range(self.units.profile_derivatives + 1):
            self.profile.derivative(order, np.zeros(1))
        if self.units.profile_derivatives > 0:
            self.profile.require_continuous()

    def on_beam(self, position: FloatArray) -> FloatArray:
        """Theta: 1 on the beam, its ends included, 0 off it."""
        slack = 1e-9 * self.beam.length
        return ((position >= -slack) & (position <= self.beam.length + slack)).astype(np.float64)

    def shapes(self, position: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Modes, slopes and curvatures under the wheels, zero off the beam, each (..., vehicle, mode)."""
        theta = self.on_beam(position)[..., np.newaxis]
        waves = self.beam.wave_numbers(self.modes)
        phase = np.where(theta > 0.0, position[..., np.newaxis], 0.0) * waves
        phi = np.sin(phase)
        return phi, theta * waves * np.cos(phase), -(waves**2) * phi

    def ground(self, time: FloatArray, missing: float = 0.0) -> FloatArray:
        """Irregularity and its first two rates under the wheels, (..., 3, vehicle) [m, m/s, m/s2].

        What the profile does not give and the units do not need becomes ``missing``.
        """
        x = self.motion.position(time)
        speed = self.motion.speed_at(time)[..., np.newaxis]
        curves = (self.profile.height, self.profile.slope, self.profile.curvature)
        r, slope, curvature = (
            np.full_like(x, missing) if curve is None else self.profile.derivative(order, x)
            for order, curve in enumerate(curves)
        )
        return np.stack((r, speed * slope, speed**2 * curvature + self.motion.acceleration * slope), axis=-2)

    def event_times(self, until: float) -> FloatArray:
        """Times in (0, until) at which a wheel enters, leaves or passes a kink, sorted."""
        places = (0.0, self.beam.length, *self.profile.kinks)
        times = np.concatenate([self.motion.times_at(x) for x in places])
        return np.unique(times[(times > 0.0) & (times < until)])


@dataclass(frozen=True)
class States:
    """Modal and body coordinates at the times asked for, and what happened on the way."""

    time: FloatArray  # (time,) [s]
    modal_displacement: FloatArray  # (time, mode) [m]
    modal_velocity: FloatArray  # (time, mode) [m/s]
    body_displacement: FloatArray  # (time, vehicle) [m]
    body_velocity: FloatArray  # (time, vehicle) [m/s]
    impacts: tuple[Impact, ...] = ()


def respond(path: WheelPath, states: States, ratios: FloatArray, gravity: float) -> CrossingResponse:
    """Return the accelerations, wheel motions and contact forces that go with ``states``.

    Theory, (R12) and (R13): the contact forces of wheels with mass depend on each other through the
    accelerations of the beam, so they come from a small system at each time.
    """
    per_time = path.units.mass.size * path.modes
    block = max(1, 1_000_000 // per_time)
    parts = [
        _respond_block(path, states, ratios, gravity, slice(i, i + block))
        for i in range(0, states.time.size, block)
    ]
    force, wheel, modal_acceleration = (np.concatenate([part[i] for part in parts]) for i in range(3))
    units = path.units
    sprung = force - units.mass * gravity - units.wheel_mass * wheel[:, 2]
    body = np.stack((states.body_displacement, states.body_velocity, units.body_rate(sprung)), axis=1)
    body = np.where(units.body_mass > 0.0, body, wheel)  # a rigid mass is its own body
    q, v = states.modal_displacement, states.modal_velocity
    return CrossingResponse(
        time=states.time,
        position=path.motion.position(states.time),
        beam=ModalResponse(path.beam, states.time, q, v, modal_acceleration),
        body_displacement=body[:, 0],
        body_velocity=body[:, 1],
        body_acceleration=body[:, 2],
        wheel_displacement=wheel[:, 0],
        wheel_velocity=wheel[:, 1],
        wheel_acceleration=wheel[:, 2],
        contact_force=force,
        impacts=states.impacts,
    )


def _respond_block(
    path: WheelPath, states: States, ratios: FloatArray, gravity: float, rows: slice
) -> tuple[FloatArray, FloatArray, FloatArray]:
    units, modal_mass = path.units, path.beam.modal_mass
    time, q, v = states.time[rows], states.modal_displacement[rows], states.modal_velocity[rows]
    z, z_rate = states.body_displacement[rows], states.body_velocity[rows]
    omega = path.beam.angular_frequencies(path.modes)
    phi, slope, curvature = path.shapes(path.motion.position(time))
    speed = path.motion.speed_at(time)[:, np.newaxis]
    acceleration = path.motion.acceleration

    def under(functions: FloatArray, coordinates: FloatArray) -> FloatArray:
        total: FloatArray = np.einsum("tvn,tn->tv", functions, coordinates)
        return total

    # motion of the wheels, but for the part of the beam's acceleration that the contact forces cause
    unloaded = -2.0 * ratios * omega * v - omega**2 * q
    w_slope = under(slope, q)
    wheel = path.ground(time, missing=np.nan)
    wheel[:, 0] += under(phi, q)
    wheel[:, 1] += under(phi, v) + speed * w_slope
    wheel[:, 2] += under(phi, unloaded) + 2.0 * speed * under(slope, v)
    wheel[:, 2] += speed**2 * under(curvature, q) + acceleration * w_slope

    force: FloatArray = units.mass * gravity + units.stiffness * (wheel[:, 0] - z)
    if np.any(units.damping > 0.0):
        force = force + units.damping * (wheel[:, 1] - z_rate)
    compliance = phi @ np.swapaxes(phi, 1, 2) / modal_mass  # beam accelerations per contact force
    if np.any(units.wheel_mass > 0.0):
        force = force + units.wheel_mass * wheel[:, 2]
        system = np.eye(units.mass.size) + units.wheel_mass[:, np.newaxis] * compliance
        force = np.linalg.solve(system, force[..., np.newaxis])[..., 0]
    wheel[:, 2] -= np.einsum("tij,tj->ti", compliance, force)
    return force, wheel, unloaded - np.einsum("tvn,tv->tn", phi, force) / modal_mass
