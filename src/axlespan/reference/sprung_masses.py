"""N12's sprung masses on a simply supported beam, by Newmark steps as there or converged in time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

from ._inputs import (
    STANDARD_GRAVITY,
    FloatArray,
    damping_ratios,
    require_count,
    require_not_negative,
    require_positive,
)
from .beam_modes import SimplySupportedBeam
from .motion import Motion
from .moving_wheels import cross_wheel_units
from .profiles import Profile, level
from .responses import CrossingResponse
from .wheel_path import States, WheelPath, respond
from .wheel_unit import UnitTable, WheelUnit


@dataclass(frozen=True)
class Newmark:
    """Newmark's method as N12 (16) to (24) writes it; 1/4 and 1/2 are the constant average acceleration."""

    beta: float = 0.25
    gamma: float = 0.5

    def __post_init__(self) -> None:
        if not (self.gamma >= 0.5 and self.beta >= 0.5 * self.gamma):
            raise InputError(
                "must be unconditionally stable: gamma >= 1/2 and beta >= gamma / 2",
                field="beta, gamma",
                value=(self.beta, self.gamma),
                fix="Write 0.25 and 0.5",
            )

    def coefficients(self, step: float) -> tuple[float, float, float, float, float, float]:
        """A0 to A5 of N12 (24)."""
        beta, gamma = self.beta, self.gamma
        return (
            1.0 / (beta * step**2),
            gamma / (beta * step),
            1.0 / (beta * step),
            0.5 / beta - 1.0,
            gamma / beta - 1.0,
            step * (0.5 * gamma / beta - 1.0),
        )


def cross_sprung_masses(
    beam: SimplySupportedBeam,
    masses: Sequence[WheelUnit],
    motion: Motion,
    time: npt.ArrayLike,
    *,
    modes: int = 20,
    profile: Profile | None = None,
    modal_damping: float | Sequence[float] = 0.0,
    gravity: float = STANDARD_GRAVITY,
    max_step: float = 1e-4,
    stages: int = 3,
) -> CrossingResponse:
    """Return the solution of N12 (41, 42) converged in time, with dashpots and modal damping if wanted.

    Gauss collocation of order ``2 stages``, restarted where a mass enters or leaves: theory, (R14) to (R17).

    Parameters
    ----------
    beam : SimplySupportedBeam
    masses : sequence of WheelUnit
        Made by `WheelUnit.sprung_mass`, from the head of the row.
    motion : Motion
        One offset per mass.
    time : array_like
        Increasing times from zero or later, (time,) [s]. The masses stand in static equilibrium on the
        irregularity at t = 0, without vertical velocity.
    modes : int, optional
    profile : Profile, optional
        Level when left out. The irregularity holds off the beam too: N12's ``theta_i r_i`` is a profile
        that ends with the beam.
    modal_damping : float or sequence of float, optional
    gravity : float, optional
        [m/s2].
    max_step : float, optional
        Longest step of the integration [s]. Motions of beam and masses need no more than 1e-3 (2 parts in
        10^6); the beam's accelerations need about 1 / omega of the highest mode.
    stages : int, optional

    Returns
    -------
    CrossingResponse
    """
    _require_sprung(masses)
    return cross_wheel_units(
        beam,
        masses,
        motion,
        time,
        modes=modes,
        profile=profile,
        modal_damping=modal_damping,
        gravity=gravity,
        max_step=max_step,
        stages=stages,
    )


def cross_sprung_masses_newmark(
    beam: SimplySupportedBeam,
    masses: Sequence[WheelUnit],
    motion: Motion,
    time_step: float,
    steps: int,
    *,
    modes: int = 20,
    profile: Profile | None = None,
    modal_damping: float | Sequence[float] = 0.0,
    gravity: float = STANDARD_GRAVITY,
    newmark: Newmark | None = None,
) -> CrossingResponse:
    """Return the solution of N12 (41, 42) by the same Newmark steps as a finite element model takes.

    The coupled equations of modes and masses are solved at every step, theta taken at its end: theory,
    (R20) to (R22). Parameters as in `cross_sprung_masses`, with equal steps [s].

    Examples
    --------
    >>> beam = SimplySupportedBeam(length=25.0, bending_stiffness=2.87e9 * 2.90, mass_per_length=2303.0)
    >>> mass = WheelUnit.sprung_mass(mass=5750.0, stiffness=1.595e6)
    >>> crossing = cross_sprung_masses_newmark(beam, [mass], Motion(100 / 3.6), 1e-3, 900)
    >>> f"{1e3 * crossing.beam.displacement_at(12.5).min():.4f} mm"
    '-2.4069 mm'
    """
    _require_sprung(masses)
    require_positive("time_step", time_step)
    require_count("steps", steps)
    require_not_negative("gravity", gravity)
    motion.require_forward(steps * time_step)
    path = WheelPath(beam, modes, motion, profile or level(), UnitTable.of(masses))
    ratios = damping_ratios(modal_damping, modes)
    states = _newmark_march(path, ratios, gravity, time_step, steps, newmark or Newmark())
    return respond(path, states, ratios, gravity)


def _require_sprung(masses: Sequence[WheelUnit]) -> None:
    for unit in masses:
        if unit.wheel_mass > 0.0:
            raise InputError(
                "must have wheels without mass",
                field="masses",
                value=unit,
                fix="Use cross_wheel_units, or WheelUnit.sprung_mass",
            )


def _newmark_march(
    path: WheelPath, ratios: FloatArray, gravity: float, step: float, steps: int, newmark: Newmark
) -> States:
    """March modes and masses together: theory, (R20) to (R22)."""
    a0, a1, a2, a3, a4, a5 = newmark.coefficients(step)
    units, omega = path.units, path.beam.angular_frequencies(path.modes)
    m, k, c = units.body_mass, units.stiffness, units.damping
    spring = k + a1 * c
    share = m * a0 / (m * a0 + spring)  # what is left of a wheel's push when the mass gives way
    own = path.beam.modal_mass * (a0 + 2.0 * ratios * omega * a1 + omega**2)
    time = step * np.arange(steps + 1)
    u = np.zeros((steps + 1, 2, path.modes))
    z = np.zeros((steps + 1, 2, m.size))
    z[0, 0] = path.ground(np.zeros(1))[0, 0]
    u_acc = np.zeros(path.modes)
    z_acc = c / m * path.ground(np.zeros(1))[0, 1]
    chunk = max(1, 500_000 // (m.size * path.modes))
    for first in range(1, steps + 1, chunk):
        rows = slice(first, min(first + chunk, steps + 1))
        phi, slope, _ = path.shapes(path.motion.position(time[rows]))
        speed = path.motion.speed_at(time[rows])
        push = spring[:, np.newaxis] * phi + (c * speed[:, np.newaxis])[..., np.newaxis] * slope
        matrix = np.matmul(np.swapaxes(phi, 1, 2) * share, push)
        matrix[:, range(path.modes), range(path.modes)] += own
        ground = path.ground(time[rows])
        for i, now in enumerate(range(first, rows.stop)):
            past_u, past_z = u[now - 1], z[now - 1]
            u_rate = -a1 * past_u[0] - a4 * past_u[1] - a5 * u_acc
            u_inertia = -a0 * past_u[0] - a2 * past_u[1] - a3 * u_acc
            z_rate = -a1 * past_z[0] - a4 * past_z[1] - a5 * z_acc
            z_inertia = -a0 * past_z[0] - a2 * past_z[1] - a3 * z_acc
            # push of each wheel on its mass but for the modes' displacements, then the modes
            pushed = k * ground[i, 0] + c * (ground[i, 1] + phi[i] @ u_rate - z_rate)
            force = m * gravity + m * z_inertia + share * (pushed - m * z_inertia)
            load = -phi[i].T @ force
            load -= path.beam.modal_mass * (u_inertia + 2.0 * ratios * omega * u_rate)
            u[now, 0] = np.linalg.solve(matrix[i], load)
            z[now, 0] = (pushed + push[i] @ u[now, 0] - m * z_inertia) / (m * a0 + spring)
            u[now, 1], u_acc = a1 * u[now, 0] + u_rate, a0 * u[now, 0] + u_inertia
            z[now, 1], z_acc = a1 * z[now, 0] + z_rate, a0 * z[now, 0] + z_inertia
    return States(time, u[:, 0], u[:, 1], z[:, 0], z[:, 1])
