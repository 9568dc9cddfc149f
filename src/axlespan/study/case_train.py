"""Trains: entries of equal vehicles that follow each other.

Where vehicles stand: ``spacing`` is the distance from the first wheel of one vehicle of an entry to the first
wheel of the next. The first vehicle of a later entry follows the last one of the entry before at that entry's
``spacing``, first wheel to first wheel, unless it has a word of its own: ``gap``, the distance of its first
wheel behind the last wheel ahead, or ``offset``, that behind the first wheel of the train.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Discriminator, ValidationInfo, model_validator

from axlespan.errors import InputError
from axlespan.study.case_multibody import Multibody
from axlespan.study.case_placing import Placed
from axlespan.study.case_vehicle_imported import MatricesVehicle, MeshVehicle
from axlespan.study.check_lists import Several
from axlespan.study.faults import InputErrors, listed, nearest
from axlespan.study.kinds import Kinds, tag
from axlespan.study.quantities import (
    AXLE_LOAD,
    DISTANCE,
    SPACING,
    BodyMass,
    Dashpot,
    PartMass,
    Stiffness,
    Text,
)


class SprungMass(Placed):
    """A mass on a spring and a dashpot over one wheel."""

    vehicle: Literal["sprung-mass"]
    mass: BodyMass
    """Sprung mass."""
    stiffness: Stiffness
    """Stiffness of the spring."""
    damping: Dashpot = 0.0
    """Damping of the dashpot."""
    unsprung_mass: PartMass = 0.0
    """Mass of the wheel."""

    @property
    def wheel_positions(self) -> tuple[float, ...]:
        """Distances of the wheels behind the first [m]."""
        return (0.0,)


class RigidMass(Placed):
    """A wheel with mass and nothing on it: a mass that moves over the structure."""

    vehicle: Literal["rigid-mass"]
    mass: BodyMass
    """Mass of the wheel and all that is rigidly bound to it."""

    @property
    def wheel_positions(self) -> tuple[float, ...]:
        """Distances of the wheels behind the first [m]."""
        return (0.0,)


class AxleLoads(Placed):
    """Forces that move over the structure, without masses: one vehicle is one group of axles."""

    vehicle: Literal["axle-loads"]
    loads: Annotated[tuple[float, ...], Several(AXLE_LOAD, example="[170 kN, 170 kN]", alone=True)]
    """Weight on each axle, positive; one value holds for all axles."""
    positions: Annotated[tuple[float, ...], Several(DISTANCE, "[0 m, 3 m]", increasing=True)] | None = None
    """Distance of each axle behind the first."""
    spacings: Annotated[tuple[float, ...], Several(SPACING, "[3 m, 11 m, 3 m]")] | None = None
    """Distances from each axle to the next, in place of positions."""

    @property
    def wheel_positions(self) -> tuple[float, ...]:
        """Distances of the axles behind the first [m]."""
        if self.positions is not None:
            return self.positions
        at = [0.0]
        for spacing in self.spacings or ():
            at.append(at[-1] + spacing)
        return tuple(at)

    @property
    def axle_loads(self) -> tuple[float, ...]:
        """Weight on each axle [N]."""
        return self.loads if len(self.loads) > 1 else self.loads * len(self.wheel_positions)

    @model_validator(mode="after")
    def _as_many(self) -> Self:
        if self.positions is not None and self.spacings is not None:
            raise InputError("says again what positions say", field="spacings", fix="Keep one of the two")
        if self.positions is not None and self.positions[0] != 0.0:
            raise InputError("must begin with 0: positions count from the first axle", field="positions.0")
        axles = len(self.wheel_positions)
        if len(self.loads) not in (1, axles):
            if axles == 1:
                some = ", ".join(["3 m"] * min(len(self.loads) - 1, 3))
                fix = f"Add spacings: [{some}{', ...' if len(self.loads) > 4 else ''}]"
                raise InputError(f"needs spacings or positions for its {len(self.loads)} axles", fix=fix)
            raise InputError(
                f"has {len(self.loads)} values for {axles} axles",
                field="loads",
                fix="Write one for each axle, or one",
            )
        self.require_room(self.wheel_positions[-1])
        return self


class LibraryVehicle(Placed):
    """A vehicle or a whole train from the library, by its name; ``axlespan library`` lists them."""

    vehicle: Text
    """Name in the library: ``ice3``, ``hslm-a1``, ..."""

    @property
    def needs_spacing(self) -> bool:
        """Whether several such vehicles need a spacing: the library knows it."""
        return False


KINDS = Kinds(
    "vehicle",
    ("sprung-mass", "axle-loads", "rigid-mass", "multibody", "mesh", "matrices"),
    "{vehicle: ice3, count: 8}",
    key="vehicle",
)


def _known(raw: Any, info: ValidationInfo) -> Any:
    """Check the word under ``vehicle``: a kind, or a name in the library (context ``vehicles``)."""
    word = raw.get("vehicle") if isinstance(raw, dict) else None
    library: Sequence[str] = tuple((info.context or {}).get("vehicles", ()))
    if not isinstance(word, str) or word in KINDS.names:
        return KINDS.checked(raw)
    near = nearest(word, (*KINDS.names, *library))
    if word in library or (not library and near is None):
        return raw
    others = f"Kinds are {listed(KINDS.names)}; axlespan library lists the vehicles"
    raise InputError(
        "no such kind of vehicle, and none in the library",
        field="vehicle",
        value=word,
        fix=f"Did you mean {near}?" if near else others,
    )


def _kind(raw: Any) -> str:
    word = raw["vehicle"] if isinstance(raw, dict) else getattr(raw, "vehicle", "")
    return f"<{word if word in KINDS.names else 'library'}>"


Entry = Annotated[
    Annotated[SprungMass, tag("sprung-mass")]
    | Annotated[AxleLoads, tag("axle-loads")]
    | Annotated[RigidMass, tag("rigid-mass")]
    | Annotated[Multibody, tag("multibody")]
    | Annotated[MeshVehicle, tag("mesh")]
    | Annotated[MatricesVehicle, tag("matrices")]
    | Annotated[LibraryVehicle, tag("library")],
    Discriminator(_kind),
    BeforeValidator(_known),
]


def check_order(train: Sequence[Placed]) -> None:
    """Require each entry after the first to say where it stands.

    Raises
    ------
    InputErrors
        Fields count from the train: ``"1.gap"``.
    """
    faults: list[InputError] = []
    for number, entry in enumerate(train):
        if number == 0:
            faults += [
                InputError(
                    "is for later entries: nothing runs ahead of this one",
                    field=f"0.{name}",
                    fix="Leave it out; start, of the crossing, moves the whole train",
                )
                for name, value in (("gap", entry.gap), ("offset", entry.offset or None))
                if value is not None
            ]
        elif entry.gap is None and entry.offset is None:
            ahead = train[number - 1]
            if ahead.spacing is None and ahead.needs_spacing:
                faults.append(
                    InputError(
                        f"does not say where it stands, and train.{number - 1} has no spacing",
                        field=str(number),
                        fix="Add gap: 3 m, its distance behind the last wheel ahead",
                    )
                )
    if faults:
        raise InputErrors(faults)


def first_wheels(
    train: Sequence[Placed], wheelbases: Sequence[float], pitches: Sequence[float | None]
) -> tuple[tuple[float, ...], ...]:
    """Return how far the first wheel of each vehicle is behind the first wheel of the train [m].

    Parameters
    ----------
    train : sequence of Placed
        The entries.
    wheelbases : sequence of float, shape (n_entry,)
        Distance from first to last wheel of a vehicle of each entry [m].
    pitches : sequence of float or None, shape (n_entry,)
        Spacing that the library gives where the entry has none [m].

    Returns
    -------
    tuple of tuple of float
        For each entry, for each of its vehicles.
    """
    placed: list[tuple[float, ...]] = []
    last, room = 0.0, 0.0
    for number, (entry, wheelbase, pitch) in enumerate(zip(train, wheelbases, pitches, strict=True)):
        spacing = entry.spacing if entry.spacing is not None else pitch
        if entry.offset is not None:
            head = entry.offset
        elif entry.gap is not None:
            head = last + wheelbases[number - 1] + entry.gap
        else:
            head = last + room if number else 0.0
        placed.append(tuple(head + vehicle * (spacing or 0.0) for vehicle in range(entry.count)))
        last, room = placed[-1][-1], spacing if spacing is not None else wheelbase
    return tuple(placed)
