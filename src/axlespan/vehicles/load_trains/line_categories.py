"""Reference wagons of the line categories of EN 15528."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from axlespan.model.dofs import nearest
from axlespan.vehicles.load_trains.load_train import VERIFIED, LoadTrain, from_strings
from axlespan.vehicles.train import Train
from axlespan.vehicles.vehicle import GRAVITY, Vehicle

#: Mass on an axle [t] and distance of the inner axles [m]; EN 15528:2021, table A.1.
WAGONS = {
    "a": (16.0, 6.20),
    "b1": (18.0, 7.80),
    "b2": (18.0, 4.65),
    "c2": (20.0, 5.90),
    "c3": (20.0, 4.50),
    "c4": (20.0, 3.40),
    "d2": (22.5, 7.45),
    "d3": (22.5, 5.90),
    "d4": (22.5, 4.65),
    "d5": (22.5, 3.62),
    "e4": (25.0, 5.90),
    "e5": (25.0, 4.75),
}

# Distance of the axles of a bogie, and from the outer axle to the end of the wagon [m].
_BOGIE, _OVERHANG = 1.80, 1.50


def en15528(category: str, count: int = 1) -> Train:
    """Reference wagons of a line category, as moving forces.

    Parameters
    ----------
    category : str
        ``"a"``, ``"b1"``, … ``"e5"``.
    count : int
        Number of wagons.

    Raises
    ------
    InputError
        If there is no such category.
    """
    wagon = _wagon(category.lower())
    return Train.of(wagon, count, wagon.length)


def _wagon(category: str) -> Vehicle:
    if category not in WAGONS:
        raise nearest(category, list(WAGONS), "line category")
    mass, inner = WAGONS[category]
    lengths = (_OVERHANG, _BOGIE, inner, _BOGIE, _OVERHANG)
    return replace(from_strings((lengths, 1e3 * mass * GRAVITY)), name=f"en15528-{category}")


def load_trains() -> list[LoadTrain]:
    """All categories."""
    found = []
    for category, (mass, _) in WAGONS.items():
        wagon = _wagon(category)
        assert wagon.length is not None
        per_meter = 4.0 * mass / wagon.length
        title = f"EN 15528 wagon of line category {category.upper()}: {mass:g} t an axle, {per_meter:.1f} t/m"
        source, note = "EN 15528:2021, table A.1", "mass per meter equals that of the category"
        make = partial(_wagon, category)
        found.append(LoadTrain(f"en15528-{category}", title, make, source, VERIFIED, note, wagon=True))
    return found
