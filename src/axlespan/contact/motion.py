"""How a train moves along the line: position, speed and acceleration of its head over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SpeedHistory:
    """Speed that is linear in time between given points, and constant before and after them."""

    times: FloatArray  # (n,) [s], increasing
    speeds: FloatArray  # (n,) [m/s]

    @classmethod
    def constant(cls, speed: float) -> SpeedHistory:
        """One speed [m/s]; zero is a train that stands."""
        if not np.isfinite(speed) or speed < 0.0:
            raise InputError(
                "must be zero or positive: trains run in the direction of the line",
                field="speed",
                value=speed,
            )
        return cls(np.zeros(1), np.array([float(speed)]))

    @classmethod
    def through(cls, points: Sequence[Sequence[float]]) -> SpeedHistory:
        """Pairs of time [s] and speed [m/s].

        Raises
        ------
        InputError
            If times don't increase, or a speed is negative or not finite.
        """
        table = np.asarray(points, float)
        if table.ndim != 2 or table.shape[1] != 2 or not len(table):
            raise InputError("must be pairs of time and speed", field="speed_history", value=list(points))
        if not np.all(np.isfinite(table)):
            raise InputError("must be finite", field="speed_history")
        if np.any(np.diff(table[:, 0]) <= 0.0):
            row = int(np.argmax(np.diff(table[:, 0]) <= 0.0)) + 1
            raise InputError(
                "must have increasing times", field=f"speed_history.{row}", value=table[row].tolist()
            )
        if np.any(table[:, 1] < 0.0):
            row = int(np.argmax(table[:, 1] < 0.0))
            raise InputError(
                "must have speeds of zero or more", field=f"speed_history.{row}", value=table[row].tolist()
            )
        return cls(table[:, 0].copy(), table[:, 1].copy())

    def speed(self, time: FloatArray) -> FloatArray:
        """Speed [m/s] at times [s]."""
        return np.asarray(np.interp(time, self.times, self.speeds))

    def acceleration(self, time: FloatArray) -> FloatArray:
        """Acceleration [m/s^2] at times [s]; at a corner, that of the piece that begins there."""
        time = np.asarray(time, float)
        if len(self.times) == 1:
            return np.zeros(time.shape)
        rates = np.concatenate([[0.0], np.diff(self.speeds) / np.diff(self.times), [0.0]])
        return np.asarray(rates[np.searchsorted(self.times, time, side="right")])

    def distance(self, time: FloatArray) -> FloatArray:
        """Distance [m] traveled from time zero until times [s]."""
        return self._from_first(np.asarray(time, float)) - self._from_first(np.zeros(()))

    def _from_first(self, time: FloatArray) -> FloatArray:
        """∫ of the speed from the first point of the table."""
        steps = 0.5 * (self.speeds[1:] + self.speeds[:-1]) * np.diff(self.times)
        traveled = np.concatenate([[0.0], np.cumsum(steps)])
        i = np.clip(np.searchsorted(self.times, time, side="right") - 1, 0, len(self.times) - 1)
        elapsed = time - self.times[i]
        before = elapsed < 0.0
        mean = np.where(before, self.speeds[0], 0.5 * (self.speeds[i] + self.speed(time)))
        return np.asarray(traveled[i] + mean * elapsed)
