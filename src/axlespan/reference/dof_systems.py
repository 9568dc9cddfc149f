"""One mass on a spring and a dashpot whose foot moves: closed forms for checking vehicles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

from ._inputs import ComplexArray, FloatArray, require_not_negative, require_positive
from .duhamel import oscillator_pole, sine_driven


@dataclass(frozen=True)
class BodyMotion:
    """The motion of a body, upward positive, from its static position."""

    time: FloatArray  # (time,) [s]
    displacement: FloatArray  # (time,) [m]
    velocity: FloatArray  # (time,) [m/s]
    acceleration: FloatArray  # (time,) [m/s2]


@dataclass(frozen=True)
class SuspendedBody:
    """A body on a spring and a dashpot in parallel, less than critically damped."""

    mass: float  # [kg]
    stiffness: float  # [N/m]
    damping: float = 0.0  # [Ns/m]

    def __post_init__(self) -> None:
        require_positive("mass", self.mass)
        require_positive("stiffness", self.stiffness)
        require_not_negative("damping", self.damping)
        if self.damping_ratio >= 1.0:
            raise InputError(
                "must be below critical damping",
                field="damping",
                value=self.damping,
                fix=f"Write less than {2.0 * self.mass * self.angular_frequency:.6g} Ns/m",
            )

    @property
    def angular_frequency(self) -> float:
        """Undamped [rad/s]."""
        return float(np.sqrt(self.stiffness / self.mass))

    @property
    def damping_ratio(self) -> float:
        """Part of critical damping [-]."""
        return self.damping / (2.0 * self.mass * self.angular_frequency)

    def transmissibility(self, frequency: npt.ArrayLike) -> FloatArray:
        """Steady amplitude of the body over that of the foot at ``frequency`` [rad/s]: theory, (R29)."""
        ratio = np.asarray(frequency, dtype=np.float64) / self.angular_frequency
        damped = 2j * self.damping_ratio * ratio
        return np.abs((1.0 + damped) / (1.0 - ratio**2 + damped))

    def free_vibration(self, displacement: float, velocity: float, time: npt.ArrayLike) -> BodyMotion:
        """Return the motion after letting go over a foot at rest."""
        t, pole = np.asarray(time, dtype=np.float64), self._pole
        phase = 1j * (pole.real * displacement - velocity) / pole.imag
        amplitude = (displacement + phase) * np.exp(pole * t)
        zero = np.zeros_like(t)
        return self._over_foot(t, zero, zero, amplitude)

    def over_harmonic(self, amplitude: float, frequency: float, time: npt.ArrayLike) -> BodyMotion:
        """Return the motion over a foot at ``amplitude sin(frequency t)``, the body at rest at t = 0.

        This is a wheel on rigid ground with ``r = amplitude sin(2 pi x / wavelength)`` when
        ``frequency = 2 pi v / wavelength`` [rad/s]: theory, (R27), (R28).
        """
        t, pole = np.asarray(time, dtype=np.float64), self._pole
        driven = sine_driven(
            np.array(self.angular_frequency), np.array(self.damping_ratio), np.array(frequency), t
        )
        start = 1j * amplitude * frequency / pole.imag * np.exp(pole * t)
        relative = amplitude * frequency**2 * driven + start
        foot = amplitude * np.sin(frequency * t), amplitude * frequency * np.cos(frequency * t)
        return self._over_foot(t, *foot, relative)

    def over_ramp(self, rise: float, duration: float, time: npt.ArrayLike) -> BodyMotion:
        """Return the motion over a foot that rises by ``rise`` at constant speed within ``duration``.

        A settlement has a negative rise: theory, (R30).
        """
        require_positive("duration", duration)
        t, pole = np.asarray(time, dtype=np.float64), self._pole
        rate = rise / duration
        later = np.maximum(t - duration, 0.0)
        kicks = np.exp(pole * t) - np.where(t >= duration, np.exp(pole * later), 0.0)
        foot = rise * np.clip(t / duration, 0.0, 1.0), np.where(t < duration, rate, 0.0)
        return self._over_foot(t, *foot, 1j * rate / pole.imag * kicks)

    @property
    def _pole(self) -> ComplexArray:
        return oscillator_pole(np.array(self.angular_frequency), np.array(self.damping_ratio))

    def _over_foot(
        self, time: FloatArray, foot: FloatArray, foot_rate: FloatArray, relative: ComplexArray
    ) -> BodyMotion:
        """Add the motion of the foot to the complex amplitude of the body's motion relative to it."""
        u, u_rate = relative.real, (self._pole * relative).real
        acceleration = -(self.stiffness * u + self.damping * u_rate) / self.mass
        return BodyMotion(time, foot + u, foot_rate + u_rate, acceleration)
