"""Where every wheel is at every time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from axlespan.errors import InputError

from ._inputs import FloatArray, require_positive


@dataclass(frozen=True)
class Motion:
    """Wheels that follow each other along the beam, at constant speed or constant acceleration.

    Wheel i is at ``xi_i = start + speed t + acceleration t^2 / 2 - offsets[i]``; the beam is 0 to L.

    Examples
    --------
    >>> Motion(speed=20.0, offsets=(0.0, 3.0)).position(0.5).tolist()
    [10.0, 7.0]
    """

    speed: float  # at t = 0 [m/s]
    offsets: tuple[float, ...] = (0.0,)  # distance of each wheel behind the head [m]
    acceleration: float = 0.0  # along the line [m/s2]
    start: float = 0.0  # where the head is at t = 0 [m]

    def __post_init__(self) -> None:
        require_positive("speed", self.speed)
        object.__setattr__(self, "offsets", tuple(float(offset) for offset in self.offsets))
        if not self.offsets or not np.all(np.isfinite([*self.offsets, self.acceleration, self.start])):
            raise InputError(
                "must be finite, one offset per wheel at least", field="offsets", value=self.offsets
            )

    @classmethod
    def spaced(cls, speed: float, count: int, spacing: float) -> Motion:
        """Return the motion of ``count`` wheels ``spacing`` metres apart, the first at x = 0 when t = 0."""
        return cls(speed=speed, offsets=tuple(spacing * i for i in range(count)))

    def position(self, time: float | FloatArray) -> FloatArray:
        """Positions of the wheels, shape (..., wheel) [m]."""
        t = np.asarray(time, dtype=np.float64)[..., np.newaxis]
        x: FloatArray = self.start + self.speed * t + 0.5 * self.acceleration * t**2 - self.offsets
        return x

    def speed_at(self, time: float | FloatArray) -> FloatArray:
        """Speed, in the shape of ``time`` [m/s]."""
        return self.speed + self.acceleration * np.asarray(time, dtype=np.float64)

    def times_at(self, x: float) -> FloatArray:
        """Time at which each wheel passes ``x``, shape (wheel,) [s]; nan where it never does."""
        distance = x - self.start + np.asarray(self.offsets)
        root = self.speed**2 + 2.0 * self.acceleration * distance
        # 2 d / (v + sqrt(...)) is the root that stays exact as the acceleration goes to zero
        with np.errstate(invalid="ignore"):
            return 2.0 * distance / (self.speed + np.sqrt(root))

    def require_forward(self, until: float) -> None:
        """Raise `InputError` if the wheels stop before the time ``until``."""
        if self.speed_at(until) <= 0.0:
            raise InputError(
                "must keep the wheels moving forward until the last time asked for",
                field="acceleration",
                value=self.acceleration,
                fix=f"Stop the analysis before t = {self.speed / -self.acceleration:.6g} s",
            )
