"""Prescribed motions u_P(t) and load histories: value, velocity and acceleration at a time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline, PPoly

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
    """A displacement history through given points, constant outside them.

    Parameters
    ----------
    times : sequence of float
        Strictly increasing [s].
    values : sequence of float
        Displacements [m or rad].
    smooth : bool
        False: linear between the points; the velocity then jumps at them, and the impulses that this
        asks of a moving mass are left out. True: a cubic spline, at rest at both ends; right for measured
        ground motion, whose acceleration matters.

    Raises
    ------
    InputError
        If there are fewer than two points, times don't increase or a value is not finite.
    """

    def __init__(self, times: Sequence[float], values: Sequence[float], *, smooth: bool = False) -> None:
        t, u = np.asarray(times, float), np.asarray(values, float)
        if t.ndim != 1 or t.shape != u.shape or len(t) < 2:
            raise InputError("must be at least two pairs of time and value", field="motion")
        if not (np.all(np.isfinite(t)) and np.all(np.isfinite(u))):
            raise InputError("must be finite", field="motion")
        if np.any(np.diff(t) <= 0.0):
            late = float(t[1 + np.argmin(np.diff(t))])
            raise InputError("must have strictly increasing times", field="motion", value=late)
        self.times, self.values = t, u
        if smooth:
            self._curve: CubicSpline | PPoly = CubicSpline(t, u, bc_type="clamped")
        else:
            self._curve = PPoly(np.array([np.diff(u) / np.diff(t), u[:-1]]), t)

    def _inside(self, time: FloatArray, order: int) -> FloatArray:
        time = np.asarray(time, float)
        result = np.asarray(self._curve(np.clip(time, self.times[0], self.times[-1]), order))
        if order:
            result = np.where((time >= self.times[0]) & (time < self.times[-1]), result, 0.0)
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
