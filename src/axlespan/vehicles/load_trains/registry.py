"""All load trains by their names."""

from __future__ import annotations

from functools import cache

from axlespan.model.dofs import nearest
from axlespan.vehicles.load_trains import fatigue_trains, hslm, line_categories, real_trains
from axlespan.vehicles.load_trains.load_train import LoadTrain
from axlespan.vehicles.vehicle import Vehicle


@cache
def entries() -> tuple[LoadTrain, ...]:
    """All named load trains, each with its source and how certain it is."""
    rooms = (hslm, fatigue_trains, line_categories, real_trains)
    return tuple(entry for room in rooms for entry in room.load_trains())


def names() -> tuple[str, ...]:
    """Names of the load trains, as case files use them."""
    return tuple(entry.name for entry in entries())


def entry(name: str) -> LoadTrain:
    """A load train by its name.

    Parameters
    ----------
    name : str
        ``hslm-a1``, as ``axlespan library`` lists it.

    Raises
    ------
    InputError
        If there is none, with the name that is most like it.
    """
    for one in entries():
        if one.name == name:
            return one
    raise nearest(name, list(names()), "load train")


def vehicle(name: str) -> Vehicle:
    """All axles of a load train as one group of moving forces.

    Parameters
    ----------
    name : str
        ``hslm-a1``, as ``axlespan library`` lists it.

    Raises
    ------
    InputError
        If there is none of that name.
    """
    return entry(name).vehicle()
