"""Load trains, and trains that meet, on a simple span: against the closed form."""

from __future__ import annotations

import numpy as np

import axlespan as asp
from axlespan.reference import Motion, cross_forces
from axlespan.reference.neves2012 import BEAM
from axlespan.vehicles import load_trains
from axlespan.verification.case import Row, case, history
from axlespan.verification.models import LENGTH, beam

_HSLM = "EN 1991-2:2003, 6.4.6.1.1"
_FRYBA = "L. Frýba, Vibration of Solids and Structures under Moving Loads, 3rd ed. (1999)"
_CLOSED = "closed form, 51 modes"
_TOLERANCE = 1e-4  # closed form and 50 elements differ by less; steps of 0.2 ms leave 6e-5
_RATIO = 0.01


@case("hslm-a1", "HSLM-A1 crosses a simple span", _HSLM)
def hslm_a1() -> list[Row]:
    """The 50 axles of HSLM-A1 at 200 km/h; 1 % damping in every mode.

    50 elements, steps of 0.2 ms.
    """
    train, speed = load_trains.hslm_a(1), 200.0 / 3.6
    steps = int(np.ceil((train.wheelbase + LENGTH) / speed / 2e-4)) + 1000
    sensors = {"midspan": 0.5 * LENGTH, "quarter": 0.25 * LENGTH}
    crossing = asp.Crossing(beam(damping=asp.Modal(_RATIO)), train, speed=speed)
    result = asp.simulate(crossing, time_step=2e-4, steps=steps, every=50, sensors=sensors)
    forces, behind = train.static_forces().tolist(), tuple(train.offsets.tolist())
    exact = cross_forces(BEAM, forces, Motion(speed, behind), result.time, modal_damping=_RATIO)
    return [
        history(
            f"displacement at {name}",
            "mm",
            result.time,
            1e3 * exact.displacement_at(x),
            1e3 * result.at("sensor_displacement", name),
            _TOLERANCE,
            _CLOSED,
        )
        for name, x in sensors.items()
    ]


@case("meeting-trains", "Two load trains meet on a simple span", _FRYBA)
def meeting_trains() -> list[Row]:
    """A power car of HSLM-A1 at 50 m/s meets five wagons of line category D4 that come at 30 m/s, 0.1 s later.

    Each is a sum of closed forms, the second one mirrored; 50 elements, steps of 0.2 ms.
    """
    first = asp.Train.of(asp.vehicles.axle_loads(loads=170e3, positions=(0.0, 3.0, 14.0, 17.0)))
    second = load_trains.en15528("d4", 5)
    other = asp.OtherTrain(train=second, speed=30.0, direction="backward", delay=0.1)
    crossing = asp.Crossing(beam(damping=asp.Modal(_RATIO)), first, speed=50.0, others=(other,))
    sensors = {"midspan": 0.5 * LENGTH, "0.28 L": 0.28 * LENGTH}
    result = asp.simulate(crossing, time_step=2e-4, steps=16_000, every=25, sensors=sensors)
    forth, back = (
        cross_forces(
            BEAM,
            train.static_forces().tolist(),
            Motion(speed, tuple(train.offsets.tolist()), start=start),
            result.time,
            modal_damping=_RATIO,
        )
        for train, speed, start in ((first, 50.0, 0.0), (second, 30.0, -0.1 * 30.0))
    )
    return [
        history(
            f"displacement at {name}",
            "mm",
            result.time,
            1e3 * (forth.displacement_at(x) + back.displacement_at(LENGTH - x)),
            1e3 * result.at("sensor_displacement", name),
            _TOLERANCE,
            _CLOSED,
        )
        for name, x in sensors.items()
    ]


CASES = (hslm_a1, meeting_trains)
