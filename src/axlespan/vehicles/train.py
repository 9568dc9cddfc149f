"""A train: vehicles one behind another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.model.materials import require_positive
from axlespan.vehicles.vehicle import GRAVITY, ContactPoint, Vehicle

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Placement:
    """A vehicle and the distance of its first wheel behind the head of the train [m]."""

    vehicle: Vehicle
    behind: float


@dataclass(frozen=True, eq=False)
class Train:
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
        return float(max(self.offsets))

    @property
    def contacts(self) -> list[tuple[str, Vehicle, ContactPoint, float]]:
        """Every contact: its name ``vehicle.wheel``, vehicle, point and distance behind the head [m]."""
        return [
            (f"{i + 1}.{point.name}", item.vehicle, point, item.behind + point.behind)
            for i, item in enumerate(self.placements)
            for point in item.vehicle.contacts
        ]

    @property
    def contact_names(self) -> tuple[str, ...]:
        """Names of the contacts, ``vehicle.wheel``, counted from the head."""
        return tuple(name for name, *_ in self.contacts)

    @property
    def offsets(self) -> FloatArray:
        """Distances (n_contact,) of the wheels behind the head [m]."""
        return np.array([behind for *_, behind in self.contacts])

    def static_forces(self, gravity: float = GRAVITY) -> FloatArray:
        """Static contact forces (n_contact,) [N]."""
        kinds = {id(item.vehicle): item.vehicle for item in self.placements}
        forces = {key: vehicle.static_forces(gravity) for key, vehicle in kinds.items()}
        return np.concatenate([forces[id(item.vehicle)] for item in self.placements])

    def as_axle_loads(self, gravity: float = GRAVITY) -> Train:
        """The same train as moving forces of its static wheel loads."""
        kinds = {id(item.vehicle): item.vehicle for item in self.placements}
        loads = {key: vehicle.as_axle_loads(gravity) for key, vehicle in kinds.items()}
        placements = tuple(Placement(loads[id(item.vehicle)], item.behind) for item in self.placements)
        return Train(placements, f"{self.name} as axle loads")
