"""The library of vehicles: one YAML file each, every number with its source.

>>> from axlespan.vehicles import library
>>> library.entry("ice3").title
'ICE 3 (Velaro E, AVE S-103), eight cars'
>>> train = library.train("ice3")
>>> len(train.placements), round(train.wheelbase, 1)
(8, 193.3)

Names are those of the files; :func:`load` reads a file of your own, which may name those of the library.
"""

from __future__ import annotations

import os
from functools import cache
from importlib.resources import files
from pathlib import Path

from axlespan.errors import InputError, Place
from axlespan.model.dofs import nearest
from axlespan.vehicles.library.entry import Group, LibraryEntry, Origin, Stated, Value
from axlespan.vehicles.library.reading import read_entry
from axlespan.vehicles.library.trains import train_of
from axlespan.vehicles.train import Train
from axlespan.vehicles.vehicle import Vehicle

__all__ = [
    "Group",
    "LibraryEntry",
    "Origin",
    "Stated",
    "Value",
    "entry",
    "load",
    "names",
    "train",
    "vehicle",
]

_LARGEST = 1_000_000  # [byte] of a file


@cache
def names() -> tuple[str, ...]:
    """Names of all entries, in alphabetical order."""
    found = (item.name for item in files(__package__).iterdir())
    return tuple(sorted(name.removesuffix(".yaml") for name in found if name.endswith(".yaml")))


@cache
def entry(name: str) -> LibraryEntry:
    """Return an entry of the library.

    Raises
    ------
    InputError
        If there is none of that name; the message names the nearest.
    """
    if name not in names():
        error = nearest(name, list(names()), "vehicle of the library")
        raise InputError(error.rule, field="vehicle", value=name, fix=error.fix)
    text = (files(__package__) / f"{name}.yaml").read_text(encoding="utf-8")
    return read_entry(text, f"{name}.yaml", name, _other)


def vehicle(name: str) -> Vehicle:
    """Return a vehicle of the library.

    Parameters
    ----------
    name : str
        As ``axlespan library`` lists it.

    Raises
    ------
    InputError
        If there is none of that name, or it is a train.
    """
    found = entry(name)
    if found.model is None:
        parts = ", ".join(dict.fromkeys(group.entry.name for group in found.groups))
        raise InputError(
            "is a train of several vehicles", field="vehicle", value=name, fix=f"Its vehicles are {parts}"
        )
    return found.model


def train(name: str, count: int = 1, spacing: float | None = None) -> Train:
    """Return a train of the library, or several of its vehicles one behind another.

    Parameters
    ----------
    name : str
        As ``axlespan library`` lists it.
    count : int
        Number of vehicles, or of trains.
    spacing : float, optional
        From first wheel to first wheel [m]; that of the library when left out.

    Raises
    ------
    InputError
        If there is none of that name, or a spacing is needed and not known.
    """
    return train_of(entry(name), count, spacing)


def load(path: str | os.PathLike[str]) -> LibraryEntry:
    """Read a vehicle or a train from a file of one's own.

    Vehicles of a train are names of the library, or files beside this one.

    Parameters
    ----------
    path : path
        A YAML file.

    Raises
    ------
    InputError
        If the file cannot be read or is wrong, with line and column.
    """
    return _loaded(Path(path), ())


def _loaded(path: Path, on_the_way: tuple[Path, ...]) -> LibraryEntry:
    here = Place(str(path))
    if path.resolve() in on_the_way:
        raise InputError("is a train that names itself", place=here)
    try:
        if path.stat().st_size > _LARGEST:
            raise InputError(f"is larger than {_LARGEST / 1e6:g} MB", place=here)
        text = path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise InputError("is not UTF-8", place=here, fix="Save it as UTF-8") from None
    except FileNotFoundError:
        raise InputError(
            "no such file", place=here, fix="axlespan library lists the names that need none"
        ) from None
    except OSError as error:
        raise InputError(f"cannot be read: {error.strerror}", place=here) from None

    def other(name: str) -> LibraryEntry:
        if name.endswith((".yaml", ".yml")):
            return _loaded(path.parent / name, (*on_the_way, path.resolve()))
        return entry(name)

    return read_entry(text, str(path), path.stem, other)


def _other(name: str) -> LibraryEntry:
    return entry(name)
