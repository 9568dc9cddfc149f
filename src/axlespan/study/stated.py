"""Vehicle files that state a mass, axle loads or frequencies other than those of their bodies and springs."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from axlespan.study.case_train import LibraryVehicle
from axlespan.study.loader import LoadedCase
from axlespan.units import FORCE, FREQUENCY, MASS, show
from axlespan.vehicles import Vehicle, library
from axlespan.vehicles.library import LibraryEntry, Stated
from axlespan.vehicles.mode_words import vehicle_modes


def stated_otherwise(loaded: LoadedCase) -> Iterator[str]:
    """Return a warning for each vehicle file of a case that contradicts itself.

    Vehicles of the library are compared by its own tests.
    """
    trains = [("train", loaded.case.train)]
    trains += [(f"other_trains.{i}.train", one.train) for i, one in enumerate(loaded.case.other_trains)]
    seen: set[str] = set()
    for path, train in trains:
        for number, entry in enumerate(train):
            if isinstance(entry, LibraryVehicle) and entry.is_file and entry.vehicle not in seen:
                seen.add(entry.vehicle)
                for said in _differences(library.load(loaded.folder / entry.vehicle)):
                    fix = "Correct the one or the other"
                    yield str(loaded.source.blame(f"{path}.{number}.vehicle", said, fix))


def _differences(entry: LibraryEntry, prefix: str = "") -> Iterator[str]:
    """What a file states that its numbers do not give; of a train, of each of its vehicles."""
    if entry.model is None:
        for inner in {group.entry.name: group.entry for group in entry.groups}.values():
            yield from _differences(inner, f"{inner.name}: ")
        return
    stated, vehicle = entry.stated, entry.model
    mass = stated.total_mass
    if mass is not None and _differ(vehicle.total_mass, mass, stated):
        yield f"{prefix}states a total mass of {show(mass, MASS)}, but its parts have {show(vehicle.total_mass, MASS)}"
    if stated.axle_loads:
        yield from (f"{prefix}{said}" for said in _loads(vehicle, stated))
    found = (
        np.array([mode.frequency for mode in vehicle_modes(vehicle)]) if stated.frequencies else np.empty(0)
    )
    for wanted in stated.frequencies if len(found) else ():
        near = float(found[np.argmin(np.abs(found - wanted))])
        if _differ(near, wanted, stated):
            yield (
                f"{prefix}states a frequency of {show(wanted, FREQUENCY)}, but the nearest that it has is "
                f"{show(near, FREQUENCY)}"
            )


def _loads(vehicle: Vehicle, stated: Stated) -> Iterator[str]:
    """The first axle whose load is another than stated."""
    places, axle = np.unique([point.behind for point in vehicle.contacts], return_inverse=True)
    loads = np.bincount(axle, weights=vehicle.static_forces())
    wanted = stated.axle_loads if len(stated.axle_loads) > 1 else stated.axle_loads * len(places)
    for number, (load, told) in enumerate(zip(loads, wanted, strict=False), start=1):
        if _differ(float(load), told, stated):
            yield (
                f"states {show(told, FORCE)} on axle {number}, but its parts put {show(float(load), FORCE)} there"
            )
            return


def _differ(found: float, told: float, stated: Stated) -> bool:
    return abs(found - told) > stated.tolerance * abs(told)
