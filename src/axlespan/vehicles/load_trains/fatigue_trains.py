"""The fatigue trains of EN 1991-2, annex D."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from axlespan.errors import InputError
from axlespan.vehicles.load_trains.load_train import VERIFIED, LoadTrain, from_strings
from axlespan.vehicles.train import Train
from axlespan.vehicles.vehicle import Vehicle

_Car = tuple[Sequence[float], float]  # overhang, distances, overhang [m]; force of an axle [N]


def _mirrored(car: _Car) -> _Car:
    return tuple(reversed(car[0])), car[1]


# Locomotives, coaches and wagons: front overhang, distances from axle to axle, rear overhang [m].
_LOCO_6A = ((1.4, 2.2, 2.2, 6.9, 2.2, 2.2, 1.4), 225e3)
_LOCO_6B = ((2.0, 2.1, 2.1, 4.4, 2.1, 2.1, 2.0), 225e3)
_LOCO_4 = ((1.4, 3.3, 6.7, 3.3, 1.4), 225e3)
_ICE_LOCO = ((4.7, 3.0, 8.46, 3.0, 2.0), 200e3)
_TGV_LOCO, _TGV_END = ((3.5, 3.0, 11.0, 3.0, 1.65), 170e3), ((1.65, 3.0, 15.7, 1.5), 170e3)
_A, _B, _C = ((1.9, 6.5, 1.9), 70e3), ((1.8, 1.8, 12.8, 1.8, 1.8), 225e3), ((1.6, 1.8, 8.0, 1.8, 1.6), 225e3)
_MOTOR, _TRAILER = ((2.15, 2.5, 14.0, 2.5, 2.15), 130e3), ((2.15, 2.5, 11.5, 2.5, 2.15), 110e3)
_METRO = (1.75, 2.4, 7.9, 2.4, 1.75)
# An underground motor car has axles of 150, 100, 100 and 150 kN: as four cars of one axle each.
_METRO_A = (((1.75, 1.2), 150e3), ((1.2, 3.95), 100e3), ((3.95, 1.2), 100e3), ((1.2, 1.75), 150e3))
_METRO_B = ((_METRO, 100e3),)
_MIXED = {"A": _A, "B": _B, "C": _C}

#: Consists of types 1 to 12.
CONSISTS: tuple[tuple[_Car, ...], ...] = (
    (_LOCO_6A, *(((1.8, 2.6, 11.5, 2.6, 1.8), 110e3),) * 12),
    (_LOCO_4, *(((2.5, 2.5, 16.5, 2.5, 2.5), 110e3),) * 10),
    (_ICE_LOCO, *(((2.45, 2.5, 16.5, 2.5, 2.45), 150e3),) * 13, _mirrored(_ICE_LOCO)),
    (
        _TGV_LOCO,
        _TGV_END,
        *(((1.5, 15.7, 1.5), 170e3),) * 8,
        _mirrored(_TGV_END),
        _mirrored(_TGV_LOCO),
    ),
    (_LOCO_6B, *(((2.0, 1.8, 1.8, 5.7, 1.8, 1.8, 2.0), 225e3),) * 15),
    (_LOCO_6B, *(_MIXED[wagon] for wagon in "AABACCABBBAACCABCAACCB")),
    (_LOCO_6A, *(((1.6, 1.8, 11.0, 1.8, 1.6), 225e3),) * 10),
    (_LOCO_6A, *(((2.1, 5.5, 2.1), 225e3),) * 20),
    (_MOTOR, _TRAILER, _MOTOR) * 2,
    (*_METRO_A, *_METRO_B, *_METRO_B, *_METRO_A) * 2,
    (_LOCO_6A, *(((1.5, 2.0, 11.0, 2.0, 1.5), 250e3),) * 10),
    (_LOCO_6A, *(((2.1, 5.5, 2.1), 250e3),) * 20),
)

#: What each type is, and its speed [km/h].
TITLES = (
    ("passenger train with locomotive", 200),
    ("passenger train with locomotive", 160),
    ("high-speed passenger train", 250),
    ("high-speed passenger train with shared bogies", 250),
    ("freight train with locomotive", 80),
    ("freight train with locomotive", 100),
    ("freight train with locomotive", 120),
    ("freight train with locomotive", 100),
    ("suburban multiple unit", 120),
    ("underground", 120),
    ("freight train of 250 kN axles", 120),
    ("freight train of 250 kN axles", 100),
)


def fatigue(number: int) -> Train:
    """Fatigue train of type 1 to 12, as moving forces.

    Parameters
    ----------
    number : int
        1 to 12.

    Raises
    ------
    InputError
        If there is no such type.

    Examples
    --------
    >>> train = fatigue(1)
    >>> round(sum(train.static_forces()) / 1e3), train.placements[0].vehicle.length
    (6630, 262.1)
    """
    return Train.of(_fatigue(number))


def _fatigue(number: int) -> Vehicle:
    if isinstance(number, bool) or number not in range(1, len(CONSISTS) + 1):
        raise InputError(f"must be 1 to {len(CONSISTS)}", field="number", value=number)
    return replace(from_strings(*CONSISTS[number - 1]), name=f"fatigue-{number}")


def load_trains() -> list[LoadTrain]:
    """Types 1 to 12."""
    return [
        LoadTrain(
            f"fatigue-{i + 1}",
            f"EN 1991-2 fatigue train, type {i + 1}: {title}, {speed} km/h",
            partial(_fatigue, i + 1),
            "EN 1991-2:2003, annex D.3",
            VERIFIED,
            "total force and length equal those of the standard"
            + ("; speed: check against the standard" if i + 1 in (5, 7) else ""),
            speed / 3.6,
        )
        for i, (title, speed) in enumerate(TITLES)
    ]
