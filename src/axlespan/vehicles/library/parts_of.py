"""Bodies, wheels, suspensions, hinges and loads of a library file; one item may stand for several alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from axlespan import units
from axlespan.errors import InputError
from axlespan.units import Dimension
from axlespan.vehicles.library.document import Item
from axlespan.vehicles.library.quantities import Quantities
from axlespan.vehicles.loads import BodyLoad
from axlespan.vehicles.multibody import multibody
from axlespan.vehicles.parts import Body, Hinge, Suspension, Wheel
from axlespan.vehicles.vehicle import Vehicle

_BODY = {
    "inertia": units.INERTIA,
    "roll_inertia": units.INERTIA,
    "height": units.LENGTH,
    "side": units.LENGTH,
}
_WHEEL = {"mass": units.MASS, "gauge": units.LENGTH, "roll_inertia": units.INERTIA, "radius": units.LENGTH}
_SUSPENSION = {
    "stiffness": units.STIFFNESS,
    "damping": units.DAMPING,
    "spread": units.LENGTH,
    "side": units.LENGTH,
    "roll_stiffness": units.ROTATIONAL_STIFFNESS,
    "roll_damping": units.ROTATIONAL_DAMPING,
}
_LOAD = {
    "z": units.FORCE,
    "y": units.FORCE,
    "height": units.LENGTH,
    "roll": units.MOMENT,
    "pitch": units.MOMENT,
}


@dataclass
class _Parts:
    """What was read, and the item that each part came from."""

    parts: dict[str, list[object]] = field(default_factory=dict)
    items: dict[str, list[Item]] = field(default_factory=dict)

    def add(self, section: str, part: object, item: Item) -> None:
        self.parts.setdefault(section, []).append(part)
        self.items.setdefault(section, []).append(item)

    def of(self, section: str) -> list[object]:
        return self.parts.get(section, [])

    def located(self, error: InputError, root: Item) -> InputError:
        """Return an error of ``bodies.1.mass`` with the place where that stands."""
        section, _, rest = (error.field or "").partition(".")
        number, _, key = rest.partition(".")
        items = self.items.get(section, [])
        if number.isdigit() and int(number) < len(items):
            inner = _inside(items[int(number)], key)
            if isinstance(inner.content, str):
                return inner.wrong(error.rule, error.fix)
            named = inner.path if inner is not items[int(number)] or not key else inner.below(key)
            return error.located(inner.place, named)
        keys = root.mapping()
        return error.located(keys[section if section in keys else "bodies"].place, error.field)


def _inside(item: Item, key: str) -> Item:
    """Return the item of a key, of ``value`` where it has a source, or the item itself."""
    inner = item.mapping().get(key, item)
    return inner.mapping().get("value", inner) if inner.is_mapping else inner


def read_vehicle(root: Item, numbers: Quantities, title: str) -> Vehicle:
    """Return the vehicle of a file.

    Raises
    ------
    InputError
        With the place of what is wrong.
    """
    keys, read = root.mapping(), _Parts()
    readers = {
        "bodies": _read_body,
        "wheels": _read_wheel,
        "suspensions": _read_suspension,
        "hinges": _read_hinge,
        "loads": _read_load,
    }
    length = numbers.positive(keys["length"], units.LENGTH, "length") if "length" in keys else None
    overhang = numbers.number(keys["overhang"], units.LENGTH, "overhang") if "overhang" in keys else None
    for section, reader in readers.items():
        for item in keys[section].items() if section in keys else ():
            reader(item, numbers, read)
    try:
        vehicle = multibody(
            bodies=[part for part in read.of("bodies") if isinstance(part, Body)],
            wheels=[part for part in read.of("wheels") if isinstance(part, Wheel)],
            suspensions=[part for part in read.of("suspensions") if isinstance(part, Suspension)],
            hinges=[part for part in read.of("hinges") if isinstance(part, Hinge)],
            loads=[part for part in read.of("loads") if isinstance(part, BodyLoad)],
            name=title,
            length=length,
        )
        vehicle.static_forces()
    except InputError as error:
        raise read.located(error, root) from None
    if length is not None and length < vehicle.wheelbase:
        rule = f"must be at least {vehicle.wheelbase:g} m, which is from the first wheel to the last"
        raise _plain(keys["length"]).wrong(rule)
    if overhang is None:
        return vehicle
    if length is None:
        raise _plain(keys["overhang"]).wrong("needs a length", "Add length, over buffers")
    if not 0.0 <= overhang <= length - vehicle.wheelbase:
        most = f"{length - vehicle.wheelbase:g} m, what the length leaves beside the wheels"
        raise _plain(keys["overhang"]).wrong(f"must be between 0 and {most}")
    return replace(vehicle, overhang=overhang)


def _plain(item: Item) -> Item:
    """The number of an item that may have a source beside it."""
    return item.mapping().get("value", item) if item.is_mapping else item


def _read_body(item: Item, numbers: Quantities, read: _Parts) -> None:
    keys = item.mapping(("name", "names", "mass", "position", "positions", *_BODY), needed=("mass",))
    names = _names(item, "name", "names")
    where = f"bodies.{', '.join(names)}"
    mass = numbers.number(keys["mass"], units.MASS, f"{where}.mass")
    more = _numbers(keys, _BODY, numbers, where)
    places = _places(item, numbers, where, len(names))
    for name, place in zip(names, places, strict=True):
        read.add("bodies", Body(name, mass, place, **more), item)


def _read_wheel(item: Item, numbers: Quantities, read: _Parts) -> None:
    keys = item.mapping(("name", "names", "position", "positions", "independent", *_WHEEL))
    first = len(read.of("wheels")) + 1
    last = first + _how_many(item) - 1
    where = f"wheels.{first} to {last}" if last > first else f"wheels.{first}"
    more = _numbers(keys, _WHEEL, numbers, where)
    places = _places(item, numbers, where, None)
    names = _names(item, "name", "names") if {"name", "names"} & set(keys) else [None] * len(places)
    if len(names) != len(places):
        raise item.wrong(f"has {len(names)} names for {len(places)} positions")
    independent = "independent" in keys and keys["independent"].truth()
    for name, place in zip(names, places, strict=True):
        read.add("wheels", Wheel(place, name=name, independent=independent, **more), item)


def _read_suspension(item: Item, numbers: Quantities, read: _Parts) -> None:
    keys = item.mapping(("name", "between", "at", *_SUSPENSION), needed=("between",))
    pairs = _pairs(keys["between"])
    label = keys["name"].text() if "name" in keys else ", ".join(f"{a} and {b}" for a, b in pairs)
    where = f"suspensions.{label}"
    more = _numbers(keys, _SUSPENSION, numbers, where)
    places: Sequence[float | None] = [None] * len(pairs)
    if "at" in keys:
        places = numbers.several(keys["at"], units.LENGTH, f"{where}.at")
        if len(places) != len(pairs):
            raise keys["at"].wrong(f"has {len(places)} values for {len(pairs)} pairs under between")
    plain = Suspension(pairs[0])
    plain = replace(plain, **more)  # type: ignore[arg-type]  # all of them are numbers
    for pair, place in zip(pairs, places, strict=True):
        read.add("suspensions", replace(plain, between=pair, at=place), item)


def _read_hinge(item: Item, numbers: Quantities, read: _Parts) -> None:
    keys = item.mapping(("name", "between", "at"), needed=("between", "at"))
    (pair,) = _pairs(keys["between"])[:1]
    at = numbers.number(keys["at"], units.LENGTH, f"hinges.{pair[0]} and {pair[1]}.at")
    read.add("hinges", Hinge(pair, at), item)


def _read_load(item: Item, numbers: Quantities, read: _Parts) -> None:
    keys = item.mapping(("body", *_LOAD), needed=("body",))
    body = keys["body"].text()
    read.add("loads", BodyLoad(body, **_numbers(keys, _LOAD, numbers, f"loads.{body}")), item)


def _numbers(
    keys: Mapping[str, Item], dimensions: Mapping[str, Dimension], numbers: Quantities, where: str
) -> dict[str, float]:
    """Return those numbers that are given, by key."""
    return {
        key: numbers.number(keys[key], dimension, f"{where}.{key}")
        for key, dimension in dimensions.items()
        if key in keys
    }


def _names(item: Item, one: str, several: str) -> list[str]:
    keys = item.mapping()
    if (one in keys) == (several in keys):
        raise item.wrong(f"must have {one} or {several}")
    names = [keys[one].text()] if one in keys else [name.text() for name in keys[several].items()]
    for name in names:
        if not name.replace("_", "").replace("-", "").isalnum():
            raise keys[one if one in keys else several].wrong("must be a name of letters, digits, - and _")
    return names


def _places(item: Item, numbers: Quantities, where: str, count: int | None) -> tuple[float, ...]:
    """Return the position of each; as many as there are names."""
    keys = item.mapping()
    if ("position" in keys) == ("positions" in keys):
        raise item.wrong("must have position or positions")
    key = "position" if "position" in keys else "positions"
    places = numbers.several(keys[key], units.LENGTH, f"{where}.{key}")
    if count is not None and len(places) != count:
        raise keys[key].wrong(f"has {len(places)} values for {count} names")
    return places


def _how_many(item: Item) -> int:
    """Return the number of positions that a group of wheels has."""
    listed = item.mapping().get("positions")
    if listed is not None and listed.is_mapping:
        listed = listed.mapping().get("value")
    return len(listed.items()) if listed is not None and listed.is_list else 1


def _pairs(item: Item) -> list[tuple[str, str]]:
    """Return ``[a, b]``, or several such pairs."""
    rows = item.items()
    pairs = [row.items() for row in rows] if rows and rows[0].is_list else [rows]
    for pair in pairs:
        if len(pair) != 2:
            raise item.wrong("must be two names, or a list of such pairs", "Write [body, wheel1]")
    return [(pair[0].text(), pair[1].text()) for pair in pairs]
