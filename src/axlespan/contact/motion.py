"""How trains move along lines: their speeds over time, and the courses of their heads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SpeedHistory:
    """Speed that is linear in time between given points, constant before them, and constant after them or changing on."""

    times: FloatArray  # (n,) [s], increasing
    speeds: FloatArray  # (n,) [m/s]
    beyond: float = 0.0  # acceleration after the last point [m/s^2]

    @classmethod
    def constant(cls, speed: float) -> SpeedHistory:
        """One speed [m/s]; zero is a train that stands."""
        if not np.isfinite(speed) or speed < 0.0:
            raise InputError(
                "must be zero or positive: trains run in the direction of the line",
                field="speed",
                value=speed,
                fix="A train against it has direction: backward" if speed < 0.0 else None,
            )
        return cls(np.zeros(1), np.array([float(speed)]))

    @classmethod
    def accelerating(cls, speed: float, acceleration: float, to_speed: float | None = None) -> SpeedHistory:
        """From a speed at time zero with a constant acceleration, until another speed is reached.

        Parameters
        ----------
        speed : float
            At time zero and before [m/s].
        acceleration : float
            Negative: the train brakes [m/s^2].
        to_speed : float, optional
            Speed that it keeps then [m/s]. Without it a train that brakes stops and stands, and one that
            accelerates goes on to do so.

        Raises
        ------
        InputError
            If a speed is negative, or the acceleration leads away from ``to_speed``.
        """
        start = cls.constant(speed)
        if not np.isfinite(acceleration) or acceleration == 0.0:
            raise InputError("must be finite and not zero", field="acceleration", value=acceleration)
        if to_speed is None and acceleration > 0.0:
            return cls(start.times, start.speeds, float(acceleration))
        end = 0.0 if to_speed is None else float(to_speed)
        if not np.isfinite(end) or end < 0.0:
            raise InputError("must be zero or positive", field="to_speed", value=to_speed)
        if (end - speed) * acceleration < 0.0:
            way = "more" if acceleration > 0.0 else "less"
            raise InputError(
                f"must be {way} than the speed that the train has, {speed:g} m/s",
                field="to_speed",
                value=to_speed,
                fix="Change the sign of the acceleration" if end != speed else None,
            )
        if end == speed:
            return start
        return cls(np.array([0.0, (end - speed) / acceleration]), np.array([float(speed), end]))

    @classmethod
    def through(cls, points: Sequence[Sequence[float]]) -> SpeedHistory:
        """Pairs of time [s] and speed [m/s].

        Raises
        ------
        InputError
            If times don't increase, or a speed is negative or not finite.
        """
        try:
            table = np.asarray(points, float)
        except (TypeError, ValueError):
            table = np.empty(0)
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
        time = np.asarray(time, float)
        after = np.maximum(time - self.times[-1], 0.0)
        return np.asarray(np.interp(time, self.times, self.speeds) + self.beyond * after)

    def acceleration(self, time: FloatArray) -> FloatArray:
        """Acceleration [m/s^2] at times [s]; at a corner, that of the piece that begins there."""
        time = np.asarray(time, float)
        rates = np.concatenate([[0.0], np.diff(self.speeds) / np.diff(self.times), [self.beyond]])
        return np.asarray(rates[np.searchsorted(self.times, time, side="right")])

    def distance(self, time: FloatArray) -> FloatArray:
        """Distance [m] traveled from time zero until times [s]; negative before."""
        return self._from_first(np.asarray(time, float)) - self._from_first(np.zeros(()))

    def largest(self, end: float) -> float:
        """Largest speed [m/s] until a time [s]."""
        inside = self.times[self.times < end]
        return float(self.speed(np.concatenate([inside, [0.0, end]])).max())

    def _from_first(self, time: FloatArray) -> FloatArray:
        """∫ of the speed from the first point of the table."""
        if len(self.times) == 1 and self.beyond == 0.0:
            return np.asarray(self.speeds[0] * (time - self.times[0]))
        steps = 0.5 * (self.speeds[1:] + self.speeds[:-1]) * np.diff(self.times)
        traveled = np.concatenate([[0.0], np.cumsum(steps)])
        i = np.clip(np.searchsorted(self.times, time, side="right") - 1, 0, len(self.times) - 1)
        elapsed = time - self.times[i]
        before = elapsed < 0.0
        mean = np.where(before, self.speeds[0], 0.5 * (self.speeds[i] + self.speed(time)))
        return np.asarray(traveled[i] + mean * elapsed)


@dataclass(frozen=True, eq=False)
class Course:
    """Where the head of a train is: a speed history from a place, in one direction, perhaps later than others."""

    speeds: SpeedHistory
    start: float = 0.0  # position of the head when the history is at its time zero [m]
    direction: int = 1  # +1 with the line, -1 against it
    delay: float = 0.0  # time at which the history is at its time zero [s]

    def head(self, time: FloatArray) -> FloatArray:
        """Position of the head [m] at times [s]."""
        return np.asarray(self.start + self.direction * self.speeds.distance(np.asarray(time) - self.delay))

    def velocity(self, time: FloatArray) -> FloatArray:
        """Velocity along the line [m/s], negative against it."""
        return np.asarray(self.direction * self.speeds.speed(np.asarray(time) - self.delay))

    def acceleration(self, time: FloatArray) -> FloatArray:
        """Acceleration along the line [m/s^2]."""
        return np.asarray(self.direction * self.speeds.acceleration(np.asarray(time) - self.delay))

    def largest_speed(self, end: float) -> float:
        """Largest speed [m/s] until a time [s]."""
        return self.speeds.largest(end - self.delay)
