"""A crossing: trains, a structure, how they move and what lies between wheel and rail."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

from axlespan.card import Card, Shown
from axlespan.contact.motion import Course, SpeedHistory
from axlespan.errors import InputError
from axlespan.irregularity import FiniteContact, Profile, Smooth, Sum
from axlespan.model.dofs import nearest
from axlespan.running.structure import MAIN_LINE, Structure
from axlespan.vehicles.train import Placement, Train
from axlespan.vehicles.vehicle import GRAVITY, LEFT, RIGHT

#: Directions of a train, by their words.
DIRECTIONS = {"forward": 1, "backward": -1}

#: r(x) of one line or of all, or of lines by their names; lines that are not named are even.
Irregularity = Profile | Mapping[str, Profile]


@dataclass(frozen=True, eq=False, kw_only=True)
class Movement:
    """How a train moves; the parameters are those of :class:`Crossing`."""

    _called: ClassVar[str] = "crossing"  # in errors

    speed: float | None = None
    speed_history: Sequence[Sequence[float]] | None = None
    acceleration: float | None = None
    to_speed: float | None = None
    start: float | None = None
    direction: str = "forward"
    line: str | Mapping[str, str] | None = None
    delay: float = 0.0
    irregularity: Irregularity | None = None

    def __post_init__(self) -> None:
        if (self.speed is None) == (self.speed_history is None):
            raise InputError(
                "must be given either as speed or as speed_history", field=f"{self._called}.speed"
            )
        if self.start is not None and not abs(self.start) < float("inf"):
            raise InputError("must be a finite number", field=f"{self._called}.start", value=self.start)
        if not 0.0 <= self.delay < float("inf"):
            raise InputError("must be zero or positive", field="delay", value=self.delay)
        if self.direction not in DIRECTIONS:
            raise nearest(self.direction, list(DIRECTIONS), "direction")
        for name in ("acceleration", "to_speed"):
            if self.speed_history is not None and getattr(self, name) is not None:
                raise InputError("goes with speed, not with speed_history", field=name)
        if self.to_speed is not None and self.acceleration is None:
            raise InputError("needs an acceleration", field="to_speed", value=self.to_speed)
        _ = self.motion

    @property
    def motion(self) -> SpeedHistory:
        """Speed over time, which begins at the delay."""
        if self.speed_history is not None:
            return SpeedHistory.through(self.speed_history)
        assert self.speed is not None
        if self.acceleration is not None:
            return SpeedHistory.accelerating(self.speed, self.acceleration, self.to_speed)
        return SpeedHistory.constant(self.speed)

    def on_line(self, name: str) -> str:
        """The structure's line that wheels of a vehicle's line run on."""
        if isinstance(self.line, str):
            return self.line if name == MAIN_LINE else name
        return name if self.line is None else self.line.get(name, name)


@dataclass(frozen=True, eq=False)
class OtherTrain(Movement):
    """A further train of a crossing; see :class:`Crossing` for what is said of its movement.

    Parameters
    ----------
    train : Train
    irregularity : Profile or mapping, optional
        That of the crossing when left out.
    """

    _called: ClassVar[str] = "other train"

    train: Train


@dataclass(frozen=True, eq=False)
class Run:
    """One train of a crossing: where it is, which lines its wheels run on, and how even they are."""

    train: Train
    course: Course
    lines: tuple[str, ...]  # (n_contact,) names of running lines
    surfaces: tuple[Profile, ...]  # (n_contact,) of the lines, as the wheels feel them over their patches
    profiles: tuple[Profile, ...]  # (n_contact,) those and what the wheels have of their own
    first: int  # vehicles of the trains before


@dataclass(frozen=True, eq=False, repr=False)
class Crossing(Shown, Movement):
    """One or several trains cross a structure.

    Parameters
    ----------
    structure : Structure
        With at least one running line.
    train : Train
        Its first wheel is the head.
    speed : float, optional
        Speed [m/s]; or give ``speed_history``.
    speed_history : sequence of (time, speed), optional
        Linear in between, constant outside [s, m/s].
    acceleration, to_speed : float, optional
        The speed changes from ``speed`` at time zero with a constant acceleration [m/s^2] until it is ``to_speed``
        [m/s]; without ``to_speed`` a train that brakes stops and stands.
    start : float, optional
        Position of the head at time zero [m]: 0 when left out, the end of its line for a train that runs backward.
    direction : {"forward", "backward"}
        Backward trains run along decreasing positions. Left wheels of vehicles in space then run on the line
        ``right``, unless ``line`` says otherwise.
    line : str or mapping, optional
        Running line of the wheels that name none; or lines of the structure by those that the wheels name.
    delay : float
        The train is at its start this much later than time zero [s]; before, it runs at its first speed.
    irregularity : Profile or mapping of Profile, optional
        r(x); r > 0 lifts the wheel. By names of lines, or one for all; even when left out.
    gravity : float
        [m/s^2].
    others : sequence of OtherTrain
        Further trains, on this line or others. Their vehicles are numbered on.

    Raises
    ------
    InputError
        If the speed is given twice or not at all, a value is out of range, or a line is unknown.
    """

    structure: Structure
    train: Train
    gravity: float = GRAVITY
    others: Sequence[OtherTrain] = ()

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0.0 <= self.gravity < float("inf"):
            raise InputError("must be zero or positive", field="gravity", value=self.gravity)

    @cached_property
    def runs(self) -> tuple[Run, ...]:
        """All trains, this one first.

        Raises
        ------
        InputError
            If a line is unknown.
        """
        runs: list[Run] = []
        trains: list[tuple[Movement, Train]] = [(self, self.train)]
        trains += [(other, other.train) for other in self.others]
        for moving, train in trains:
            first = sum(len(run.train.placements) for run in runs)
            runs.append(self._run(moving, train, first))
        return tuple(runs)

    def _run(self, moving: Movement, train: Train, first: int) -> Run:
        lines = tuple(_lines(moving, train))
        for name in dict.fromkeys(lines):
            self.structure.line(name)  # it is there
        direction, start = DIRECTIONS[moving.direction], moving.start
        if start is None:
            start = 0.0 if direction > 0 else self.structure.line(lines[0]).stop
        irregularity = moving.irregularity if moving.irregularity is not None else self.irregularity
        surfaces, profiles = _under_wheels(train, lines, self._profiles(irregularity, lines))
        return Run(
            train,
            Course(moving.motion, float(start), direction, moving.delay),
            lines,
            surfaces,
            profiles,
            first,
        )

    def _profiles(self, irregularity: Irregularity | None, lines: Sequence[str]) -> dict[str, Profile]:
        """Profiles of some lines by their names."""
        even = Smooth()
        if irregularity is None:
            return dict.fromkeys(lines, even)
        if not isinstance(irregularity, Mapping):
            return dict.fromkeys(lines, irregularity)
        own = {self.line_name(name): profile for name, profile in irregularity.items()}
        return {name: own.get(self.line_name(name), even) for name in dict.fromkeys(lines)}

    def line_name(self, name: str) -> str:
        """First name of a line in the structure: one line may have several names, as the rails of a track in the plane."""
        path = self.structure.line(name)
        return next(other for other, line in self.structure.lines.items() if line is path)

    @property
    def train_names(self) -> str:
        """Names of all trains."""
        return "; ".join(run.train.name for run in self.runs)

    @property
    def placements(self) -> tuple[Placement, ...]:
        """Vehicles of all trains."""
        return tuple(item for run in self.runs for item in run.train.placements)

    @property
    def contact_lines(self) -> tuple[str, ...]:
        """Lines (n_contact,) that the wheels of all trains run on."""
        return tuple(line for run in self.runs for line in run.lines)

    @property
    def contact_names(self) -> tuple[str, ...]:
        """Names of the contacts, ``vehicle.wheel``; vehicles count from the head of the first train on."""
        return tuple(name for run in self.runs for name in run.train.names_from(run.first))

    def card(self) -> Card:
        """Return what is shown of it, with a time step and as many steps as the last wheel needs to leave."""
        top = float(self.motion.speeds.max())
        line = self.structure.line()
        facts = [
            ("structure", f"{self.structure.name}, {line.start:g} to {line.stop:g} m"),
            ("train", self.train_names),
            (
                "speed",
                f"{3.6 * float(self.motion.speeds[0]):.6g} km/h at first, {3.6 * top:.6g} km/h at most",
            ),
            ("irregularity", "none" if self.irregularity is None else type(self.irregularity).__name__),
        ]
        way = line.stop - line.start + self.train.wheelbase
        after = (
            ""
            if top == 0.0
            else f"asp.simulate(crossing, time_step=1e-3, steps={int(1e3 * way / top) + 1000})"
        )
        return Card("Crossing", facts, after)


def _under_wheels(
    train: Train, lines: Sequence[str], of_lines: Mapping[str, Profile]
) -> tuple[tuple[Profile, ...], tuple[Profile, ...]]:
    """What the lines are under all wheels of a train, and what these feel with their own profiles.

    Wheels that feel the same share one profile: it is read once for all of them.
    """
    surfaces: dict[tuple[str, float | None], Profile] = {}
    profiles: dict[tuple[str, float | None, int | None], Profile] = {}
    under: list[Profile] = []
    felt: list[Profile] = []
    for line, (_, _, point, _) in zip(lines, train.contacts, strict=True):
        surface, own = of_lines[line], point.profile
        if point.patch is not None and not isinstance(surface, Smooth):
            surface = surfaces.setdefault((line, point.patch), FiniteContact(surface, point.patch))
        even = isinstance(surface, Smooth)
        both = surface if own is None else own if even else Sum((surface, own))
        under.append(surface)
        felt.append(profiles.setdefault((line, point.patch, None if own is None else id(own)), both))
    return tuple(under), tuple(felt)


def _lines(moving: Movement, train: Train) -> Iterator[str]:
    """Lines of the structure under all wheels of a train."""
    turned = {LEFT: RIGHT, RIGHT: LEFT} if moving.direction == "backward" and moving.line is None else {}
    for item in train.placements:
        names = [point.line for point in item.vehicle.contacts]
        sides = turned if set(names) == {LEFT, RIGHT} else {}
        yield from (sides.get(name, moving.on_line(name)) for name in names)
