"""From the text of a library file to an entry: a vehicle of bodies, wheels and suspensions, or a train."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from axlespan import units
from axlespan.errors import InputError
from axlespan.vehicles.library.document import Item, read_document
from axlespan.vehicles.library.entry import Group, LibraryEntry, Origin, Stated
from axlespan.vehicles.library.parts_of import read_vehicle
from axlespan.vehicles.library.quantities import Quantities

KINDS = ("vehicle", "train")
_COMMON = ("title", "kind", "group", "sources", "source", "notes", "pitch", "stated")
_OF_VEHICLES = ("length", "overhang", "bodies", "wheels", "suspensions", "hinges", "loads")
_STATED = ("total_mass", "axle_loads", "frequencies", "tolerance")


def read_entry(text: str, file: str, name: str, other: Callable[[str], LibraryEntry]) -> LibraryEntry:
    """Return the entry that a text describes.

    Parameters
    ----------
    file, name : str
        Of the file in messages, and of the entry.
    other : callable
        Gives the entry of another name, for trains.

    Raises
    ------
    InputError
        If something is wrong, with file, line and column.
    """
    root = read_document(text, file)
    keys = root.mapping()
    kind = _kind(root)
    own = _OF_VEHICLES if kind == "vehicle" else ("vehicles",)
    root.mapping((*_COMMON, *own), needed=("title", *(("bodies", "wheels") if kind == "vehicle" else own)))
    origins = _origins(root)
    numbers = Quantities(origins, _default(root, origins))
    group = keys["group"].text() if "group" in keys else "own"
    title = keys["title"].text()
    model = read_vehicle(root, numbers, title) if kind == "vehicle" else None
    groups = _groups(keys["vehicles"], numbers, other) if kind == "train" else ()
    pitch = numbers.positive(keys["pitch"], units.LENGTH, "pitch") if "pitch" in keys else None
    stated = _stated(keys["stated"], numbers) if "stated" in keys else Stated()
    if model is not None and len(stated.axle_loads) > 1:
        axles = len({point.behind for point in model.contacts})
        if len(stated.axle_loads) != axles:
            rule = f"has {len(stated.axle_loads)} values for {axles} axles"
            raise (
                keys["stated"].mapping()["axle_loads"].wrong(rule, "Write one for each axle, or one for all")
            )
    return LibraryEntry(
        name=name,
        kind=kind,
        title=title,
        group=group,
        text=text,
        file=file,
        values=tuple(numbers.values),
        origins=origins,
        notes=tuple(note.text() for note in keys["notes"].items()) if "notes" in keys else (),
        stated=stated,
        pitch=pitch if pitch is not None or not groups else _pitch(groups),
        length=None if model is None else model.length,
        model=model,
        groups=groups,
    )


def _kind(root: Item) -> str:
    keys = root.mapping()
    if "kind" not in keys:
        return "train" if "vehicles" in keys else "vehicle"
    word = keys["kind"].text()
    if word not in KINDS:
        raise keys["kind"].wrong(f"must be {' or '.join(KINDS)}")
    return word


def _origins(root: Item) -> dict[str, Origin]:
    keys = root.mapping()
    if "sources" not in keys:
        return {}
    result = {}
    for key, item in keys["sources"].mapping().items():
        if not item.is_mapping:
            result[key] = Origin(key, item.text())
            continue
        inner = item.mapping(("text", "check"), needed=("text",))
        result[key] = Origin(key, inner["text"].text(), "check" in inner and inner["check"].truth())
    return result


def _default(root: Item, origins: dict[str, Origin]) -> Origin | None:
    """Return the source of the values that name none."""
    keys = root.mapping()
    if "source" not in keys:
        return next(iter(origins.values())) if len(origins) == 1 else None
    word = keys["source"].text()
    return origins.get(word) or Origin("source", word)


def _stated(item: Item, numbers: Quantities) -> Stated:
    keys = item.mapping(_STATED)
    mass = keys.get("total_mass")
    loads, frequencies = keys.get("axle_loads"), keys.get("frequencies")
    tolerance = keys["tolerance"].quantity(units.RATIO) if "tolerance" in keys else Stated.tolerance
    if tolerance <= 0.0:
        raise keys["tolerance"].wrong("must be positive")
    return Stated(
        numbers.positive(mass, units.MASS, "stated.total_mass") if mass else None,
        numbers.several(loads, units.FORCE, "stated.axle_loads") if loads else (),
        numbers.several(frequencies, units.FREQUENCY, "stated.frequencies") if frequencies else (),
        tolerance,
    )


def _groups(item: Item, numbers: Quantities, other: Callable[[str], LibraryEntry]) -> tuple[Group, ...]:
    groups: list[Group] = []
    listed = item.items()
    if not listed:
        raise item.wrong("must name at least one vehicle")
    for number, inner in enumerate(listed):
        keys = inner.mapping(("vehicle", "count", "spacing"), needed=("vehicle",))
        try:
            entry = other(keys["vehicle"].text())
        except InputError as error:
            if error.place is not None and error.place.line is not None:
                raise
            raise keys["vehicle"].wrong(error.rule, error.fix) from None
        count = keys["count"].whole() if "count" in keys else 1
        path = f"vehicles.{number}.spacing"
        spacing = numbers.positive(keys["spacing"], units.LENGTH, path) if "spacing" in keys else entry.pitch
        if spacing is None and (count > 1 or number < len(listed) - 1):
            raise inner.wrong("needs a spacing, first wheel to first wheel of the next")
        groups.append(Group(entry, count, spacing))
    given = ["spacing" in inner.mapping() for inner in listed]
    return tuple(
        group if said else replace(group, to_next=_buffer_to_buffer(group, after))
        for group, said, after in zip(groups, given, (*groups[1:], groups[0]), strict=True)
    )


def _buffer_to_buffer(group: Group, after: Group) -> float | None:
    """The spacing of a group's last vehicle to one that has another overhang; None where that is not known [m]."""
    own, other = group.entry.front_overhang, after.entry.front_overhang
    if group.spacing is None or own is None or other is None or own == other:
        return None
    return group.spacing - own + other


def _pitch(groups: tuple[Group, ...]) -> float | None:
    """Distance to the first wheel of the next train, if all spacings are known [m]."""
    reaches = [group.reach for group in groups]
    return None if None in reaches else sum(reach for reach in reaches if reach is not None)
