"""From the train of a case to a train: vehicles of each kind, and where they stand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from axlespan import vehicles
from axlespan.errors import InputError
from axlespan.running.structure import MAIN_LINE, Structure
from axlespan.study import case_train
from axlespan.study.build_multibody import loaded_train, require_line, vehicle_of_bodies
from axlespan.study.build_wheels import with_own_wheels
from axlespan.study.case_multibody import Multibody
from axlespan.study.case_placing import Unit, first_wheels
from axlespan.study.case_vehicle_imported import MatricesVehicle, MeshVehicle
from axlespan.study.faults import InputErrors
from axlespan.study.imported_vehicles import vehicle_of_matrices, vehicle_of_mesh
from axlespan.study.loader import LoadedCase
from axlespan.study.pointing import pointing
from axlespan.vehicles import Placement, Train, Vehicle, library, load_trains
from axlespan.vehicles.library.trains import train_of as library_train
from axlespan.vehicles.load_trains.table import axle_table
from axlespan.vehicles.vehicle import WheelLaw


@dataclass(frozen=True, eq=False)
class _Built:
    """An entry, built: the train that repeats, and what is known about it."""

    train: Train
    unit: Unit


def train_of(
    loaded: LoadedCase,
    structure: Structure,
    path: str = "train",
    entries: Sequence[case_train.Entry] | None = None,
    lines: Mapping[str, str] | None = None,
    first: int = 0,
) -> Train:
    """Build a train of a case, as the vehicles that the analysis wants.

    Parameters
    ----------
    loaded : LoadedCase
    structure : Structure
        That it crosses.
    path, entries
        Where the train stands in the file, and its entries; those of the first train when left out.
    lines : mapping, optional
        Lines of the structure by those that the wheels name, where they differ.
    first : int
        Vehicles of the trains before, which the names of wheels count.

    Raises
    ------
    InputError
        If something is wrong that only shows now; it points to the place in the file.
    """
    case = loaded.case
    entries = case.train if entries is None else entries
    built = []
    for number, entry in enumerate(entries):
        with pointing(loaded, f"{path}.{number}"):
            made = _entry(entry, loaded)
            for item in made.train.placements:
                item.vehicle.static_forces(case.analysis.gravity)  # it stands, and no wheel pulls
                for point in item.vehicle.contacts:
                    require_line(structure, (lines or {}).get(point.line, point.line))
            built.append(made)
    with pointing(loaded, path):
        heads = first_wheels(entries, [one.unit for one in built])
    placed = [
        (Placement(item.vehicle, behind + item.behind), number)
        for number, (one, places) in enumerate(zip(built, heads, strict=True))
        for behind in places
        for item in one.train.placements
    ]
    ordered = sorted(placed, key=lambda pair: pair[0].behind)
    placements = [item for item, _ in ordered]
    train = Train(tuple(placements), _name(placements, built))
    with pointing(loaded, path):
        train.require_apart()
        train = _as_wanted(train, case.analysis.vehicles, case.analysis.gravity)
    return with_own_wheels(train, entries, [number for _, number in ordered], loaded, path, first)


def _name(placed: Sequence[Placement], built: Sequence[_Built]) -> str:
    if len(built) == 1 and len(built[0].train.placements) > 1:
        count, name = built[0].unit.count, built[0].train.name
        return name if count == 1 else f"{count} × {name}"
    names = list(dict.fromkeys(item.vehicle.name for one in built for item in one.train.placements))
    return f"{len(placed)} × {', '.join(names)}" if len(placed) > 1 else names[0]


def _as_wanted(train: Train, vehicles: str, gravity: float) -> Train:
    """The train as the vehicles of ``analysis.vehicles``."""
    if vehicles == "axle-loads":
        return train.as_axle_loads(gravity)
    return train.as_moving_masses(gravity) if vehicles == "moving-masses" else train


# --- entries -----------------------------------------------------------------------------------


def _entry(case: case_train.Entry, loaded: LoadedCase) -> _Built:
    gravity = loaded.case.analysis.gravity
    pitch: float | None = None
    if isinstance(case, case_train.LibraryVehicle):
        train, pitch = _of_library(case, loaded)
    else:
        train = Train.of(_vehicle(case, gravity))
    each = len(train.placements)
    if each > 1 and case.count > 1 and case.count % each:
        raise InputError(
            f"counts vehicles, and {case.vehicle} has {each}",
            field="count",
            fix=f"Write count: {each * max(1, round(case.count / each))}, or leave it out for one train",
        )
    if case.reversed:
        train = train.reversed()
    if isinstance(case, case_train.LibraryVehicle):
        train = loaded_train(train, case.loads)
    if case.line is not None:
        train = _on_line(train, case.line)
    if case.contact is not None:
        train = _in_contact(train, case.contact.law)
    return _Built(train, _unit(train, case.count // each if each <= case.count else 1, pitch))


def _unit(train: Train, count: int, pitch: float | None) -> Unit:
    first, last = train.placements[0].vehicle, train.placements[-1].vehicle
    front = None if first.length is None else first.front_overhang
    rear = None if last.length is None else last.rear_overhang
    if pitch is None and front is not None and rear is not None:
        pitch = front + train.wheelbase + rear
    return Unit(train.wheelbase, count, pitch, front, rear)


def _of_library(case: case_train.LibraryVehicle, loaded: LoadedCase) -> tuple[Train, float | None]:
    if case.vehicle in load_trains.names():
        return Train.of(load_trains.vehicle(case.vehicle)), None
    name = case.vehicle
    entry = library.load(loaded.folder / name) if case.is_file else library.entry(name)
    train = library_train(entry)
    if entry.model is None:
        return train, entry.pitch
    if entry.model.length is None and entry.length is not None:
        train = Train.of(replace(entry.model, length=entry.length))
    return train, entry.pitch


def _in_contact(train: Train, law: WheelLaw) -> Train:
    """The train with a law of contact for all its wheels."""
    changed: dict[int, Vehicle] = {}
    for item in train.placements:
        if id(item.vehicle) not in changed:
            points = tuple(replace(point, law=law) for point in item.vehicle.contacts)
            changed[id(item.vehicle)] = replace(item.vehicle, contacts=points)
    placements = (Placement(changed[id(item.vehicle)], item.behind) for item in train.placements)
    return replace(train, placements=tuple(placements))


def _on_line(train: Train, line: str) -> Train:
    """The train with the wheels that name no line on a line of the structure."""
    moved: dict[int, Vehicle] = {}
    for item in train.placements:
        points = tuple(
            replace(point, line=line) if point.line == MAIN_LINE else point for point in item.vehicle.contacts
        )
        moved.setdefault(id(item.vehicle), replace(item.vehicle, contacts=points))
    return Train(
        tuple(Placement(moved[id(item.vehicle)], item.behind) for item in train.placements), train.name
    )


def _vehicle(case: case_train.Entry, gravity: float) -> Vehicle:
    if isinstance(case, case_train.SprungMass):
        return vehicles.sprung_mass(
            mass=case.mass, stiffness=case.stiffness, damping=case.damping, unsprung_mass=case.unsprung_mass
        )
    if isinstance(case, case_train.RigidMass):
        return vehicles.rigid_mass(mass=case.mass)
    if isinstance(case, case_train.AxleLoads):
        return _axle_loads(case)
    if isinstance(case, case_train.HslmB):
        made = vehicles.axle_loads(loads=case.load, positions=list(case.wheel_positions), name="hslm-b")
        return made
    if isinstance(case, Multibody):
        return vehicle_of_bodies(case)
    if isinstance(case, MeshVehicle):
        return vehicle_of_mesh(case, gravity)
    assert isinstance(case, MatricesVehicle)
    return vehicle_of_matrices(case, gravity)


def _axle_loads(case: case_train.AxleLoads) -> Vehicle:
    if case.file is None:
        return vehicles.axle_loads(loads=list(case.axle_loads), positions=list(case.wheel_positions))
    positions, loads = axle_table(case.file)
    if case.spacing is not None and case.count > 1 and case.spacing <= positions[-1]:
        raise InputErrors(
            [
                InputError(
                    f"must be more than {positions[-1]:g} m, which is from the first axle of the file to the last",
                    field="spacing",
                )
            ]
        )
    return vehicles.axle_loads(loads=loads, positions=positions, name=case.file.stem)
