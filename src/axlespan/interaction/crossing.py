"""A crossing: a train, a structure, a speed and what lies between wheel and rail."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from axlespan.contact.motion import SpeedHistory
from axlespan.errors import InputError
from axlespan.irregularity import Profile, Smooth
from axlespan.running.structure import Structure
from axlespan.vehicles.train import Train
from axlespan.vehicles.vehicle import GRAVITY


@dataclass(frozen=True, eq=False)
class Crossing:
    """A train crosses a structure.

    Parameters
    ----------
    structure : Structure
        With at least one running line.
    train : Train
        Its first wheel is the head.
    speed : float, optional
        Constant speed [m/s]; or give ``speed_history``.
    speed_history : sequence of (time, speed), optional
        Linear in between, constant outside [s, m/s].
    start : float
        Position of the head at time zero [m]; 0 is the start of the line, negative is before it.
    irregularity : Profile
        r(x) of the line; r > 0 lifts the wheel.
    gravity : float
        [m/s^2].

    Raises
    ------
    InputError
        If the speed is given twice or not at all, or a value is out of range.
    """

    structure: Structure
    train: Train
    speed: float | None = None
    speed_history: Sequence[Sequence[float]] | None = None
    start: float = 0.0
    irregularity: Profile = field(default_factory=Smooth)
    gravity: float = GRAVITY

    def __post_init__(self) -> None:
        if (self.speed is None) == (self.speed_history is None):
            raise InputError("must be given either as speed or as speed_history", field="crossing.speed")
        if not abs(self.start) < float("inf"):
            raise InputError("must be a finite number", field="crossing.start", value=self.start)
        if not 0.0 <= self.gravity < float("inf"):
            raise InputError("must be zero or positive", field="gravity", value=self.gravity)
        _ = self.motion

    @property
    def motion(self) -> SpeedHistory:
        """Speed over time."""
        if self.speed_history is not None:
            return SpeedHistory.through(self.speed_history)
        assert self.speed is not None
        return SpeedHistory.constant(self.speed)
