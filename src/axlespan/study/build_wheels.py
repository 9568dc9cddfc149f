"""From the wheels' own flats, waves and patches of a case to a train that has them."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from axlespan.errors import InputError
from axlespan.study.case_placing import Placed
from axlespan.study.case_wheels import OfWheels, OutOfRound, WheelFlat
from axlespan.study.faults import listed, nearest
from axlespan.study.loader import LoadedCase
from axlespan.study.pointing import pointing
from axlespan.vehicles import Train
from axlespan.vehicles.vehicle import ContactPoint


def with_own_wheels(
    train: Train,
    entries: Sequence[Placed],
    entry_of: Sequence[int],
    loaded: LoadedCase,
    path: str,
    first: int,
) -> Train:
    """Return a train whose wheels have what its entries say.

    Parameters
    ----------
    train : Train
    entries : sequence of Placed
    entry_of : sequence of int
        Entry of each vehicle of the train.
    loaded : LoadedCase
    path : str
        Where the train stands in the file.
    first : int
        Vehicles of the trains before, which are counted in the names of wheels.

    Raises
    ------
    InputError
        If a wheel is unknown or has no radius, or is a force; it points to the place in the file.
    """
    for number, entry in enumerate(entries):
        here = f"{path}.{number}"
        own = _wheels(train, entry_of, number, first)
        if entry.contact_patch is not None:
            with pointing(loaded, here):
                _require_wheels(own, loaded, "contact_patch")
            train = train.with_wheels([name for name, _, _ in own.values()], patch=entry.contact_patch)
        for field, one in _defects(entry):
            with pointing(loaded, here):
                _require_wheels(own, loaded, field)
                train = _with_defect(train, one, own, _named(loaded, f"{here}.{field}", one), field)
    return train


# A wheel of an entry by its name in the result: its name in the train, the point, whether it is a force.
_Wheels = dict[str, tuple[str, ContactPoint, bool]]


def _wheels(train: Train, entry_of: Sequence[int], number: int, first: int) -> _Wheels:
    return {
        f"{first + i + 1}.{point.name}": (f"{i + 1}.{point.name}", point, item.vehicle.is_force)
        for i, item in enumerate(train.placements)
        if entry_of[i] == number
        for point in item.vehicle.contacts
    }


def _defects(entry: Placed) -> Iterator[tuple[str, WheelFlat | OutOfRound]]:
    """Flats and waves of an entry, with their paths under it."""
    both: tuple[tuple[str, WheelFlat | OutOfRound | tuple[WheelFlat | OutOfRound, ...] | None], ...] = (
        ("wheel_flat", entry.wheel_flat),
        ("out_of_round", entry.out_of_round),
    )
    for field, given in both:
        if isinstance(given, (WheelFlat, OutOfRound)):
            yield field, given
        elif given is not None:
            yield from ((f"{field}.{i}", one) for i, one in enumerate(given))


def _require_wheels(own: _Wheels, loaded: LoadedCase, field: str) -> None:
    """Moving forces feel no surface; where the analysis wants forces, that is what it asks for."""
    if loaded.case.analysis.vehicles != "axle-loads" and all(force for _, _, force in own.values()):
        raise InputError(
            "has no effect: these are moving forces, which feel no surface",
            field=field,
            fix="Take a vehicle with masses, or analysis: {vehicles: moving-masses}",
        )


def _named(loaded: LoadedCase, path: str, case: OfWheels) -> tuple[str, ...] | None:
    """Names of wheels as they are written: as a number, 1.10 would be 1.1."""
    if case.wheels is None:
        return None
    written = (loaded.source.word(f"{path}.wheels.{i}") for i in range(len(case.wheels)))
    return tuple((word or name).strip("'\"") for word, name in zip(written, case.wheels, strict=True))


def _with_defect(
    train: Train,
    case: WheelFlat | OutOfRound,
    own: _Wheels,
    names: Collection[str] | None,
    field: str,
) -> Train:
    groups: dict[float, list[str]] = {}
    for number, name in enumerate(own if names is None else names):
        if name not in own:
            near = nearest(name, own)
            known = f"Those of this entry are {listed(own)}"
            fix = f"Did you mean {near}? {known}" if near else known
            raise InputError("no such wheel", field=f"{field}.wheels.{number}", value=name, fix=fix)
        inner, point, _ = own[name]
        radius = point.radius if case.radius is None else case.radius
        if radius is None:
            raise InputError(
                "is missing: the vehicle does not know it", field=f"{field}.radius", fix="Add radius: 460 mm"
            )
        groups.setdefault(radius, []).append(inner)
    for radius, wheels in groups.items():
        try:
            train = train.with_wheels(wheels, profile=case.profile(radius))
        except InputError as error:
            if error.field != "length":
                raise
            raise InputError(error.rule, field=f"{field}.length", fix=error.fix) from error
    return train
