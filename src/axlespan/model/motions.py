"""Prescribed motions u_P(t) and load histories: value, velocity and acceleration at a time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]


class Motion(Protocol):
    """A history of one d.o.f.; vectorized over times [s]."""

    def value(self, time: FloatArray) -> FloatArray:
        """Displacement [m or rad]."""
        ...

    def velocity(self, time: FloatArray) -> FloatArray:
        """Velocity [m/s or rad/s]."""
        ...

    def acceleration(self, time: FloatArray) -> FloatArray:
        """Acceleration [m/s^2 or rad/s^2]."""
        ...


@dataclass(frozen=True)
class Constant:
    """A displacement that stays, such as a settlement; zero is a fixed support."""

    amount: float = 0.0  # [m or rad]

    def value(self, time: FloatArray) -> FloatArray:
        """Displacement."""
        return np.full(np.shape(time), self.amount)

    def velocity(self, time: FloatArray) -> FloatArray:
        """Zero."""
        return np.zeros(np.shape(time))

    def acceleration(self, time: FloatArray) -> FloatArray:
        """Zero."""
        return np.zeros(np.shape(time))


@dataclass(frozen=True)
class HarmonicMotion:
    """amplitude · sin(2π f t + phase)."""

    amplitude: float  # [m or rad]
    frequency: float  # [Hz]
    phase: float = 0.0  # [rad]

    def _angle(self, time: FloatArray) -> FloatArray:
        return 2.0 * np.pi * self.frequency * np.asarray(time, float) + self.phase

    def value(self, time: FloatArray) -> FloatArray:
        """Displacement."""
        return np.asarray(self.amplitude * np.sin(self._angle(time)))

    def velocity(self, time: FloatArray) -> FloatArray:
        """Velocity."""
        return np.asarray(self.amplitude * 2.0 * np.pi * self.frequency * np.cos(self._angle(time)))

    def acceleration(self, time: FloatArray) -> FloatArray:
        """Acceleration."""
        return np.asarray(-self.amplitude * (2.0 * np.pi * self.frequency) ** 2 * np.sin(self._angle(time)))


class TableMotion:
    """A displacement history through given points, as a natural cubic spline; constant outside them.

    The spline has a continuous acceleration, which prescribed supports with mass need; a table that
    jumps in slope asks for an impulse and is smoothed over its neighboring points.

    Parameters
    ----------
    times : sequence of float
        Strictly increasing [s].
    values : sequence of float
        Displacements [m or rad].
    """

    def __init__(self, times: Sequence[float], values: Sequence[float]) -> None:
        t, u = np.asarray(times, float), np.asarray(values, float)
        if t.ndim != 1 or t.shape != u.shape or len(t) < 2:
            raise InputError("must be at least two pairs of time and value", field="motion")
        if not (np.all(np.isfinite(t)) and np.all(np.isfinite(u))):
            raise InputError("must be finite", field="motion")
        if np.any(np.diff(t) <= 0.0):
            raise InputError(
                "must have strictly increasing times",
                field="motion",
                value=float(t[1 + np.argmin(np.diff(t))]),
            )
        self.times, self.values = t, u
        # Clamped ends: at rest before the first and after the last point.

        self._spline = CubicSpline(t, u, bc_type="clamped")

    def _inside(self, time: FloatArray, order: int) -> FloatArray:
        time = np.asarray(time, float)
        clipped = np.clip(time, self.times[0], self.times[-1])
        result = np.asarray(self._spline(clipped, order))
        if order:
            result = np.where((time >= self.times[0]) & (time <= self.times[-1]), result, 0.0)
        return result

    def value(self, time: FloatArray) -> FloatArray:
        """Displacement."""
        return self._inside(time, 0)

    def velocity(self, time: FloatArray) -> FloatArray:
        """Velocity; zero outside the table."""
        return self._inside(time, 1)

    def acceleration(self, time: FloatArray) -> FloatArray:
        """Acceleration; zero outside the table."""
        return self._inside(time, 2)


@dataclass(frozen=True)
class FunctionMotion:
    """A displacement history given by functions of time [s]."""

    displacement: Callable[[FloatArray], FloatArray]
    rate: Callable[[FloatArray], FloatArray]
    second_rate: Callable[[FloatArray], FloatArray]

    def value(self, time: FloatArray) -> FloatArray:
        """Displacement."""
        return np.asarray(self.displacement(time), float)

    def velocity(self, time: FloatArray) -> FloatArray:
        """Velocity."""
        return np.asarray(self.rate(time), float)

    def acceleration(self, time: FloatArray) -> FloatArray:
        """Acceleration."""
        return np.asarray(self.second_rate(time), float)
