"""Trains: entries of equal vehicles that follow each other.

Where vehicles stand: ``spacing`` is the distance from the first wheel of one vehicle of an entry to the first
wheel of the next. The first vehicle of a later entry follows the last one of the entry before at that entry's
``spacing``, first wheel to first wheel, unless it has a word of its own: ``gap``, the distance of its first
wheel behind the last wheel ahead, or ``offset``, that behind the first wheel of the train. Vehicles of the
library know their lengths and need none of these words: they stand buffer to buffer.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Discriminator, ValidationInfo, model_validator

from axlespan.errors import InputError
from axlespan.study.case_multibody import BodyLoad, Multibody
from axlespan.study.case_placing import Placed
from axlespan.study.case_vehicle_imported import MatricesVehicle, MeshVehicle
from axlespan.study.check_lists import Several
from axlespan.study.faults import InputErrors, listed, nearest
from axlespan.study.kinds import ExistingFile, Kinds, tag
from axlespan.study.quantities import (
    AXLE_LOAD,
    DISTANCE,
    SPACING,
    BodyMass,
    Dashpot,
    Few,
    PartMass,
    Spacing,
    Stiffness,
    Text,
)
from axlespan.vehicles import library, load_trains


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
    loads: Annotated[tuple[float, ...], Several(AXLE_LOAD, example="[170 kN, 170 kN]", alone=True)] | None = (
        None
    )
    """Weight on each axle, positive; one value holds for all axles."""
    positions: Annotated[tuple[float, ...], Several(DISTANCE, "[0 m, 3 m]", increasing=True)] | None = None
    """Distance of each axle behind the first."""
    spacings: Annotated[tuple[float, ...], Several(SPACING, "[3 m, 11 m, 3 m]")] | None = None
    """Distances from each axle to the next, in place of positions."""
    file: Annotated[Path, ExistingFile()] | None = None
    """Text file with columns ``position [m]`` and ``load [kN]``, in place of loads and positions."""

    @property
    def wheel_positions(self) -> tuple[float, ...]:
        """Distances of the axles behind the first [m], those of a file excepted."""
        if self.positions is not None:
            return self.positions
        at = [0.0]
        for spacing in self.spacings or ():
            at.append(at[-1] + spacing)
        return tuple(at)

    @property
    def axle_loads(self) -> tuple[float, ...]:
        """Weight on each axle [N]."""
        loads = self.loads or ()
        return loads if len(loads) > 1 else loads * len(self.wheel_positions)

    @model_validator(mode="after")
    def _as_many(self) -> Self:
        if self.file is not None:
            for name in ("loads", "positions", "spacings"):
                if getattr(self, name) is not None:
                    raise InputError("says again what the file says", field=name, fix="Keep one of the two")
            return self
        if self.loads is None:
            raise InputError(
                "is missing", field="loads", fix="Add loads: [170 kN, 170 kN], or file: axles.csv"
            )
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


class HslmB(Placed):
    """Load model HSLM-B of EN 1991-2, 6.4.6.1.1: equal forces at equal distances.

    Their number and distance depend on the span; read them from figure 6.14 of the standard.
    """

    vehicle: Literal["hslm-b"]
    forces: Few | None = None
    """Number of forces, N."""
    distance: Spacing | None = None
    """Distance of the forces, d."""
    load: Annotated[float, AXLE_LOAD] = 170e3
    """Each force."""

    @property
    def wheel_positions(self) -> tuple[float, ...]:
        """Distances of the forces behind the first [m]."""
        return tuple(number * (self.distance or 0.0) for number in range(self.forces or 1))

    @model_validator(mode="after")
    def _given(self) -> Self:
        for name in ("forces", "distance"):
            if getattr(self, name) is None:
                example = "forces: 15" if name == "forces" else "distance: 3.5 m"
                raise InputError(
                    "is missing: it depends on the span, and the figure that gives it is not part of axlespan",
                    field=name,
                    fix=f"Read N and d for your span from EN 1991-2, figure 6.14; then add {example}",
                )
        self.require_room(self.wheel_positions[-1])
        return self


class LibraryVehicle(Placed):
    """A vehicle or a whole train from the library, by its name, or a file of one's own.

    ``axlespan library`` lists the names.
    """

    vehicle: Text
    """Name in the library: ``ice3``, ``hslm-a1``, ...; or a file, relative to this one: ``my-wagon.yaml``."""
    loads: tuple[BodyLoad, ...] = ()
    """Constant loads on bodies of each vehicle, such as cross-wind."""

    @property
    def is_file(self) -> bool:
        """Whether a file describes it."""
        return self.vehicle.endswith(FILES)

    @property
    def needs_spacing(self) -> bool:
        """Whether several such vehicles need a spacing: the library knows it."""
        return False


#: A load train that asks for more than its name.
HSLM_B = "hslm-b"

#: How names of files that describe a vehicle end.
FILES = (".yaml", ".yml")

KINDS = Kinds(
    "vehicle",
    ("sprung-mass", "axle-loads", "rigid-mass", "multibody", "mesh", "matrices"),
    "{vehicle: ice3, count: 8}",
    key="vehicle",
)


def library_names() -> tuple[str, ...]:
    """Names of all vehicles, trains and load trains of the library."""
    return (*library.names(), *load_trains.names(), HSLM_B)


def _known(raw: Any, info: ValidationInfo) -> Any:
    """Check the word under ``vehicle``: a kind, or a name in the library (context ``vehicles``)."""
    if isinstance(raw, Placed):  # it has been checked
        return raw
    word = raw.get("vehicle") if isinstance(raw, dict) else None
    if not isinstance(word, str) or word in KINDS.names:
        return KINDS.checked(raw)
    if word == HSLM_B:
        return raw
    if word.endswith(FILES):
        ExistingFile().read(word, info, "vehicle")
        return raw
    names: Sequence[str] = tuple((info.context or {}).get("vehicles", ())) or library_names()
    if word in names:
        return raw
    near = nearest(word, (*KINDS.names, *names))
    others = f"Kinds are {listed(KINDS.names)}; axlespan library lists the vehicles"
    raise InputError(
        "no such kind of vehicle, and none in the library",
        field="vehicle",
        value=word,
        fix=f"Did you mean {near}?" if near else others,
    )


def _kind(raw: Any) -> str:
    word = raw["vehicle"] if isinstance(raw, dict) else getattr(raw, "vehicle", "")
    return f"<{word if word in (*KINDS.names, HSLM_B) else 'library'}>"


Entry = Annotated[
    Annotated[SprungMass, tag("sprung-mass")]
    | Annotated[AxleLoads, tag("axle-loads")]
    | Annotated[RigidMass, tag("rigid-mass")]
    | Annotated[Multibody, tag("multibody")]
    | Annotated[MeshVehicle, tag("mesh")]
    | Annotated[MatricesVehicle, tag("matrices")]
    | Annotated[HslmB, tag("hslm-b")]
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
