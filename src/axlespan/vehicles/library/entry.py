"""An entry of the library: a vehicle or a train, with the source of each of its numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from axlespan.vehicles.vehicle import Vehicle


@dataclass(frozen=True)
class Origin:
    """Where numbers come from."""

    key: str
    text: str
    check: bool = False  # to be checked against the source before it is relied upon


@dataclass(frozen=True)
class Value:
    """A number of an entry as it is written, with its source."""

    path: str  # what it is: bodies.body.mass
    written: str  # with its unit
    origin: Origin | None = None
    note: str = ""
    check: bool = False


@dataclass(frozen=True)
class Stated:
    """What the source itself says about the whole, to compare with what is computed."""

    total_mass: float | None = None  # [kg]
    axle_loads: tuple[float, ...] = ()  # [N], of all axles, or of each
    frequencies: tuple[float, ...] = ()  # [Hz], each of which the vehicle must have
    tolerance: float = 1e-3  # relative [-]


@dataclass(frozen=True)
class Group:
    """Equal vehicles that follow each other within a train."""

    entry: LibraryEntry
    count: int
    spacing: float | None  # first wheel to first wheel of the next [m]
    to_next: float | None = (
        None  # from the last one's first wheel to that of the next group, where it differs [m]
    )

    @property
    def reach(self) -> float | None:
        """From the first wheel of the group to that of the next [m]; None if a spacing is not known."""
        last = self.spacing if self.to_next is None else self.to_next
        if last is None or (self.spacing is None and self.count > 1):
            return None
        return (self.count - 1) * (self.spacing or 0.0) + last


@dataclass(frozen=True, eq=False)
class LibraryEntry:
    """A vehicle or a train of the library, or of a user's file.

    Attributes
    ----------
    kind : str
        ``vehicle``, or ``train`` for vehicles in a fixed order.
    group : str
        ``rail`` or ``road``.
    pitch : float or None
        Distance from first wheel to first wheel of equal vehicles that follow each other [m].
    length : float or None
        Over buffers [m].
    model : Vehicle or None
        The vehicle; None for a train.
    groups : tuple of Group
        What a train is made of.
    """

    name: str
    kind: str
    title: str
    group: str
    text: str  # of the file
    file: str
    values: tuple[Value, ...] = ()
    origins: Mapping[str, Origin] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    stated: Stated = Stated()
    pitch: float | None = None
    length: float | None = None
    model: Vehicle | None = None
    groups: tuple[Group, ...] = ()

    @property
    def front_overhang(self) -> float | None:
        """From the front buffer to the first wheel [m], where it is known."""
        if self.model is None:
            return self.groups[0].entry.front_overhang if self.groups else None
        return None if self.model.length is None else self.model.front_overhang

    @property
    def is_spatial(self) -> bool:
        """Whether wheels run on a left and a right line."""
        vehicle = self.model or next((group.entry.model for group in self.groups), None)
        return vehicle is not None and len({point.line for point in vehicle.contacts}) > 1

    @property
    def to_check(self) -> bool:
        """Whether some number is to be checked against its source."""
        return any(value.check for value in self.values) or any(g.entry.to_check for g in self.groups)
