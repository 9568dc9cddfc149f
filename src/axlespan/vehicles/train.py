"""A train: vehicles one behind another."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from axlespan.card import Card, Shown, some
from axlespan.errors import InputError
from axlespan.irregularity import Profile, Sum
from axlespan.model.dofs import nearest
from axlespan.model.materials import require_positive
from axlespan.vehicles.vehicle import GRAVITY, ContactPoint, Vehicle

FloatArray = npt.NDArray[np.float64]

# Buffers give way, and lengths are rounded [m].
_BUFFERS = 0.1


@dataclass(frozen=True, eq=False)
class Placement:
    """A vehicle and the distance of its first wheel behind the head of the train [m]."""

    vehicle: Vehicle
    behind: float  # [m]


@dataclass(frozen=True, eq=False, repr=False)
class Train(Shown):
    """Vehicles in the order from the head; the first wheel of the first one is the head of the train."""

    placements: tuple[Placement, ...]
    name: str = "train"

    def __post_init__(self) -> None:
        if not self.placements:
            raise InputError("must have at least one vehicle", field="train")
        behind = [placement.behind for placement in self.placements]
        if behind[0] != 0.0 or np.any(np.diff(behind) < 0.0):
            raise InputError(
                "must have its vehicles one behind another, the first at 0", field="train", value=behind
            )

    @classmethod
    def of(
        cls, vehicle: Vehicle, count: int = 1, spacing: float | None = None, *, name: str | None = None
    ) -> Train:
        """Equal vehicles at a spacing [m] from first wheel to first wheel.

        Parameters
        ----------
        vehicle : Vehicle
        count : int
            How many.
        spacing : float, optional
            [m]; needed for more than one.
        name : str, optional
            That of the vehicle when left out.

        Raises
        ------
        InputError
            If the count is not a positive whole number, or several vehicles come without a spacing.
        """
        if isinstance(count, bool) or int(count) != count or count < 1:
            raise InputError("must be a whole number of at least 1", field="count", value=count)
        if count > 1:
            if spacing is None:
                raise InputError("is needed for more than one vehicle", field="spacing")
            require_positive(spacing, "spacing")
        step = spacing or 0.0
        placements = tuple(Placement(vehicle, i * step) for i in range(int(count)))
        return cls(placements, name or (vehicle.name if count == 1 else f"{count} × {vehicle.name}"))

    @classmethod
    def joined(cls, trains: Sequence[Train], gaps: Sequence[float], *, name: str = "train") -> Train:
        """Trains one behind another; gaps [m] from each train's last wheel to the next one's first.

        Parameters
        ----------
        trains : sequence of Train
            From the head on.
        gaps : sequence of float
            One fewer than the trains [m].
        name : str

        Raises
        ------
        InputError
            If the gaps are not one fewer than the trains, or negative.
        """
        if len(gaps) != len(trains) - 1:
            raise InputError("must be one fewer than the trains", field="gaps", value=list(gaps))
        placements: list[Placement] = []
        begin = 0.0
        for i, train in enumerate(trains):
            if i:
                begin += require_positive(gaps[i - 1], "gaps", zero=True)
            placements += [Placement(item.vehicle, begin + item.behind) for item in train.placements]
            begin += train.wheelbase
        return cls(tuple(placements), name)

    @property
    def wheelbase(self) -> float:
        """Distance from the first wheel to the last [m]."""
        return float(self.offsets.max())

    @cached_property
    def contacts(self) -> tuple[tuple[str, Vehicle, ContactPoint, float], ...]:
        """Every contact: its name ``vehicle.wheel``, vehicle, point and distance behind the head [m]."""
        return tuple(
            (f"{i + 1}.{point.name}", item.vehicle, point, item.behind + point.behind)
            for i, item in enumerate(self.placements)
            for point in item.vehicle.contacts
        )

    @property
    def contact_names(self) -> tuple[str, ...]:
        """Names of the contacts, ``vehicle.wheel``, counted from the head."""
        return self.names_from(0)

    def names_from(self, first: int) -> tuple[str, ...]:
        """Names of the contacts when so many vehicles of other trains are counted before."""
        return tuple(
            f"{first + i + 1}.{point.name}"
            for i, item in enumerate(self.placements)
            for point in item.vehicle.contacts
        )

    @cached_property
    def offsets(self) -> FloatArray:
        """Distances (n_contact,) of the wheels behind the head [m]; not to be written to."""
        offsets = np.array([behind for *_, behind in self.contacts])
        offsets.setflags(write=False)
        return offsets

    def static_forces(self, gravity: float = GRAVITY) -> FloatArray:
        """Static contact forces (n_contact,) [N]."""
        kinds = {id(item.vehicle): item.vehicle for item in self.placements}
        forces = {key: vehicle.static_forces(gravity) for key, vehicle in kinds.items()}
        return np.concatenate([forces[id(item.vehicle)] for item in self.placements])

    def as_axle_loads(self, gravity: float = GRAVITY) -> Train:
        """The same train as moving forces of its static wheel loads.

        Parameters
        ----------
        gravity : float
            [m/s^2].
        """
        kinds = {id(item.vehicle): item.vehicle for item in self.placements}
        loads = {key: vehicle.as_axle_loads(gravity) for key, vehicle in kinds.items()}
        placements = tuple(Placement(loads[id(item.vehicle)], item.behind) for item in self.placements)
        return Train(placements, f"{self.name} as axle loads")

    def as_moving_masses(self, gravity: float = GRAVITY) -> Train:
        """The same train as masses that follow the line, each wheel with the mass of its static load.

        Wheels of trains that are given as forces become masses of force by gravity.

        Parameters
        ----------
        gravity : float
            [m/s^2].
        """
        kinds = {id(item.vehicle): item.vehicle for item in self.placements}
        masses = {key: vehicle.as_moving_masses(gravity) for key, vehicle in kinds.items()}
        placements = tuple(Placement(masses[id(item.vehicle)], item.behind) for item in self.placements)
        return Train(placements, f"{self.name} as moving masses")

    def with_wheels(
        self,
        wheels: Collection[str] | None = None,
        *,
        profile: Profile | None = None,
        patch: float | None = None,
    ) -> Train:
        """The same train, some wheels of which have profiles of their own, or feel the mean over a patch.

        Parameters
        ----------
        wheels : collection of str, optional
            Names of contacts, as in :attr:`contact_names`; all when left out.
        profile : Profile, optional
            r(x) that these wheels alone feel [m], over their position along the line, on which they roll without
            slip: ``WheelFlat``, ``OutOfRound``. It adds to that of the line, and to those that they have.
        patch : float, optional
            Length of the contact patch of a tyre [m]: the wheel feels the mean of the line's profile over it.

        Raises
        ------
        InputError
            If there is no such wheel, or the patch is not positive.
        """
        if patch is not None:
            require_positive(patch, "patch")
        names = self.contact_names
        for name in wheels or ():
            if name not in names:
                raise nearest(name, list(names), "wheel")
        wanted = set(names if wheels is None else wheels)
        made: dict[tuple[int, tuple[int, ...]], Vehicle] = {}
        placements = []
        for i, item in enumerate(self.placements):
            vehicle, points = item.vehicle, item.vehicle.contacts
            chosen = tuple(n for n, point in enumerate(points) if f"{i + 1}.{point.name}" in wanted)
            key = id(vehicle), chosen
            if chosen and key not in made:
                new = [
                    _changed(point, profile, patch) if n in chosen else point
                    for n, point in enumerate(points)
                ]
                made[key] = replace(vehicle, contacts=tuple(new))
            placements.append(Placement(made[key] if chosen else vehicle, item.behind))
        return Train(tuple(placements), self.name)

    def reversed(self) -> Train:
        """The same train with its tail ahead: the last vehicle leads, every vehicle the other way round."""
        kinds = {id(item.vehicle): item.vehicle for item in self.placements}
        turned = {key: vehicle.reversed() for key, vehicle in kinds.items()}
        ends = [item.behind + item.vehicle.wheelbase for item in self.placements]
        last = max(ends)  # not the wheelbase, whose rounding may differ: the new head is at 0 exactly
        placements = [
            Placement(turned[id(item.vehicle)], last - end)
            for item, end in zip(self.placements, ends, strict=True)
        ]
        return Train(tuple(sorted(placements, key=lambda item: item.behind)), f"{self.name} reversed")

    @property
    def ends(self) -> tuple[float, float]:
        """How far the train reaches ahead of its head and behind it [m], over buffers where they are known."""
        ahead = max(item.vehicle.front_overhang - item.behind for item in self.placements)
        behind = max(
            item.behind + item.vehicle.wheelbase + item.vehicle.rear_overhang for item in self.placements
        )
        return ahead, behind

    def require_apart(self, lines: Sequence[str] | None = None) -> None:
        """Require that no vehicle stands within another one on the same line.

        Groups of moving forces without a length are no bodies: they may lie within each other.

        Parameters
        ----------
        lines : sequence of str, shape (n_contact,), optional
            Running lines of the wheels; those that their vehicles name when left out.

        Raises
        ------
        InputError
            With the vehicles and by how much they overlap.
        """
        lines = [point.line for _, _, point, _ in self.contacts] if lines is None else lines
        foremost: dict[str, tuple[float, float, int]] = {}  # of each line: last buffer, last wheel, vehicle
        wheel = 0
        for number, item in enumerate(self.placements):
            vehicle = item.vehicle
            own = set(lines[wheel : wheel + len(vehicle.contacts)])
            wheel += len(vehicle.contacts)
            if vehicle.is_force and vehicle.length is None:
                continue
            for line in own & foremost.keys():
                buffer, last, ahead = foremost[line]
                if item.behind <= last or item.behind - vehicle.front_overhang < buffer - _BUFFERS:
                    raise self._overlapping(ahead, number)
            end = item.behind + vehicle.wheelbase
            reach = end + vehicle.rear_overhang, end, number
            foremost.update({line: max(reach, foremost.get(line, reach)) for line in own})

    def _overlapping(self, early: int, late: int) -> InputError:
        """What to say of two vehicles within each other."""
        one, other = self.placements[early], self.placements[late]
        pitch = other.behind - one.behind
        if pitch <= one.vehicle.wheelbase:
            known = f"whose last wheel is {one.vehicle.wheelbase:.4g} m behind it"
        else:
            room = one.vehicle.wheelbase + one.vehicle.rear_overhang + other.vehicle.front_overhang
            known = f"which needs {room:.4g} m between buffers"
        return InputError(
            f"vehicle {late + 1} begins {pitch:.4g} m behind the first wheel of vehicle {early + 1}, {known}",
            field="train",
            fix="Look at spacing, gap and offset: vehicles must not overlap",
        )

    def card(self) -> Card:
        """Return what is shown of it."""
        forces = self.static_forces()
        kinds = list(dict.fromkeys(item.vehicle.name for item in self.placements))
        facts = [
            ("vehicles", f"{len(self.placements)}: {some(kinds)}"),
            ("wheels", f"{len(forces)}, {self.wheelbase:g} m from the first to the last"),
            ("static forces", f"{forces.min() / 1e3:.5g} to {forces.max() / 1e3:.5g} kN"),
            ("weight", f"{forces.sum() / 1e3:.6g} kN"),
        ]
        return Card(f"Train: {self.name}", facts, "asp.Crossing(bridge, train, speed=250 / 3.6)")


def _changed(point: ContactPoint, profile: Profile | None, patch: float | None) -> ContactPoint:
    """A contact with a further profile of its wheel, and perhaps another patch."""
    own = point.profile if profile is None else profile
    if profile is not None and point.profile is not None:
        own = Sum((point.profile, profile))
    return replace(point, profile=own, patch=point.patch if patch is None else patch)
