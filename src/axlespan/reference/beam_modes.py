"""Modes of the simply supported Euler-Bernoulli beam, and motions written in them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

from ._inputs import FloatArray, require_count, require_positive


@dataclass(frozen=True)
class SimplySupportedBeam:
    """A uniform Euler-Bernoulli beam on two simple supports, with its modes.

    The modes are ``phi_n = sin(n pi x / L)`` with ``omega_n = (n pi / L)^2 sqrt(EI / m)`` and the
    modal mass ``M_n = m L / 2`` (theory, (R1) to (R3)).

    Examples
    --------
    >>> beam = SimplySupportedBeam(length=25.0, bending_stiffness=2.87e9 * 2.90, mass_per_length=2303.0)
    >>> beam.angular_frequencies(2).round(3).tolist()
    [30.02, 120.081]
    """

    length: float  # [m]
    bending_stiffness: float  # E I [N m2]
    mass_per_length: float  # [kg/m]

    def __post_init__(self) -> None:
        require_positive("length", self.length)
        require_positive("bending_stiffness", self.bending_stiffness)
        require_positive("mass_per_length", self.mass_per_length)

    @property
    def modal_mass(self) -> float:
        """Modal mass, the same for all modes [kg]."""
        return 0.5 * self.mass_per_length * self.length

    @property
    def critical_speed(self) -> float:
        """Speed at which a force loads the first mode in its own period, ``2 f_1 L`` [m/s]."""
        return float(self.angular_frequencies(1)[0]) * self.length / np.pi

    def wave_numbers(self, modes: int) -> FloatArray:
        """``n pi / L`` for n = 1 to ``modes``, shape (mode,) [1/m]."""
        require_count("modes", modes)
        numbers: FloatArray = np.arange(1, modes + 1) * (np.pi / self.length)
        return numbers

    def angular_frequencies(self, modes: int) -> FloatArray:
        """Angular frequencies, shape (mode,) [rad/s]."""
        stiffness_per_mass = self.bending_stiffness / self.mass_per_length
        return self.wave_numbers(modes) ** 2 * float(np.sqrt(stiffness_per_mass))

    def shapes(self, x: npt.ArrayLike, modes: int) -> FloatArray:
        """``phi_n(x)``, shape (..., mode); the sine goes on outside the beam, the caller keeps x on it."""
        return np.sin(_phase(x, self.wave_numbers(modes)))

    def slopes(self, x: npt.ArrayLike, modes: int) -> FloatArray:
        """First derivatives of the modes, shape (..., mode) [1/m]."""
        waves = self.wave_numbers(modes)
        return waves * np.cos(_phase(x, waves))

    def curvatures(self, x: npt.ArrayLike, modes: int) -> FloatArray:
        """Second derivatives of the modes, shape (..., mode) [1/m2]."""
        waves = self.wave_numbers(modes)
        return -(waves**2) * np.sin(_phase(x, waves))


def _phase(x: npt.ArrayLike, waves: FloatArray) -> FloatArray:
    return np.asarray(x, dtype=np.float64)[..., np.newaxis] * waves


@dataclass(frozen=True)
class ModalResponse:
    """The motion of a simply supported beam as modal coordinates over time, upward positive."""

    beam: SimplySupportedBeam
    time: FloatArray  # (time,) [s]
    modal_displacement: FloatArray  # (time, mode) [m]
    modal_velocity: FloatArray  # (time, mode) [m/s]
    modal_acceleration: FloatArray  # (time, mode) [m/s2]

    @property
    def modes(self) -> int:
        """Number of modes."""
        return int(self.modal_displacement.shape[1])

    def displacement_at(self, x: npt.ArrayLike) -> FloatArray:
        """Displacement at the points ``x``, shape (time, ...) [m]."""
        return _sum(self.modal_displacement, self.beam.shapes(self._on_beam(x), self.modes))

    def velocity_at(self, x: npt.ArrayLike) -> FloatArray:
        """Velocity at the points ``x``, shape (time, ...) [m/s]."""
        return _sum(self.modal_velocity, self.beam.shapes(self._on_beam(x), self.modes))

    def acceleration_at(self, x: npt.ArrayLike) -> FloatArray:
        """Acceleration at the points ``x``, shape (time, ...) [m/s2]."""
        return _sum(self.modal_acceleration, self.beam.shapes(self._on_beam(x), self.modes))

    def slope_at(self, x: npt.ArrayLike) -> FloatArray:
        """Slope dw/dx at the points ``x``, shape (time, ...) [rad]."""
        return _sum(self.modal_displacement, self.beam.slopes(self._on_beam(x), self.modes))

    def moment_at(self, x: npt.ArrayLike) -> FloatArray:
        """Bending moment ``EI d2w/dx2``, sagging positive, shape (time, ...) [Nm].

        The series converges only like 1/modes under a force: take many modes.
        """
        curvatures = self.beam.curvatures(self._on_beam(x), self.modes)
        return self.beam.bending_stiffness * _sum(self.modal_displacement, curvatures)

    def _on_beam(self, x: npt.ArrayLike) -> FloatArray:
        points = np.asarray(x, dtype=np.float64)
        if np.any(points < 0.0) or np.any(points > self.beam.length):
            raise InputError(
                f"must lie on the beam, 0 to {self.beam.length:g} m",
                field="x",
                value=x,
                fix="Ask for points between the supports",
            )
        return points


def _sum(coordinates: FloatArray, functions: FloatArray) -> FloatArray:
    total: FloatArray = np.tensordot(coordinates, functions, axes=(1, functions.ndim - 1))
    return total
