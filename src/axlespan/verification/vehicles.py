"""Cars, trucks and coaches of the library, against matrices written out by hand on the modes of the span."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

import axlespan as asp
from axlespan.reference import (
    Axle,
    Motion,
    PlainResponse,
    PlainVehicle,
    Profile,
    SimplySupportedBeam,
    articulated_truck,
    coach,
    cross_plain_vehicles,
    half_car,
    harmonic,
    level,
)
from axlespan.reference.neves2012 import BEAM
from axlespan.vehicles import library
from axlespan.verification.case import FloatArray, Row, case, history, value
from axlespan.verification.models import GRAVITY, LENGTH, beam

_Positions = npt.NDArray[np.floating[Any]]

_THEORY = "theory page 'Reference solutions', (R32) to (R36)"
_SENSORS = {"midspan": 0.5 * LENGTH}
_BY_HAND = "matrices by hand on modes of the span"

_HALF_CAR = half_car(
    (16_200.0, 93_457.0),
    [(-2.375, 700.0, 4e5, 1e4, 1.75e6, 0.0), (2.375, 1100.0, 1e6, 2e4, 3.5e6, 0.0)],
)
_ICE3 = coach(
    body=(47_800.0, 1_957_888.0),
    bogie=(3500.0, 1715.0),
    wheelset=1800.0,
    primary=(2.4e6, 20e3),
    secondary=(0.70e6, 40e3),
    bogie_centers=17.375,
    wheelbase=2.5,
)
_TRUCK = articulated_truck(
    tractor=(4500.0, 4604.0),
    trailer=(31_450.0, 16_302.0),
    hinge=(2.15, 6.15),
    tractor_axles=[
        Axle(-0.5, 700.0, (400e3, 10e3), (1.75e6, 3e3)),
        Axle(2.5, 1100.0, (1000e3, 10e3), (3.5e6, 3e3)),
    ],
    trailer_axles=[Axle(x, 750.0, (750e3, 10e3), (3.5e6, 3e3)) for x in (1.8, 2.9, 4.0)],
)


def _piece(
    start: float, length: float, of: Callable[[_Positions], tuple[_Positions, _Positions, _Positions]]
) -> Profile:
    """A profile with a kink at both ends of a piece; ``of`` gives r, r' and r'' of the place in it [m]."""

    def part(order: int) -> Callable[[_Positions], _Positions]:
        return lambda x: of(np.clip(np.asarray(x) - start, 0.0, length))[order]

    return Profile(part(0), part(1), part(2), (start, start + length))


@case("half-car-bump", "A half car over a bump on the span", _THEORY)
def half_car_bump() -> list[Row]:
    """The two-axle truck of the library at 20 m/s over a haversine bump of 10 mm and 1.5 m at 10 m, from -5 m on.

    N12's beam, 50 elements, steps of 0.4 ms; tires without dashpots, so α = 0.
    """
    height, length, start = 0.01, 1.5, 9.25
    wave = 2.0 * np.pi / length

    def bump(x: _Positions) -> tuple[_Positions, _Positions, _Positions]:
        r = 0.5 * height * (1.0 - np.cos(wave * x))
        inside = (x > 0.0) & (x < length)
        return (
            r,
            0.5 * height * wave * np.sin(wave * x),
            0.5 * height * wave**2 * np.cos(wave * x) * inside,
        )

    irregularity = asp.irregularity.Bump(10.0, height, length)
    train = asp.Train.of(library.vehicle("half-car"))
    crossing = asp.Crossing(beam(), train, speed=20.0, start=-5.0, irregularity=irregularity)
    result = asp.simulate(crossing, time_step=4e-4, steps=4400, every=4, sensors=_SENSORS)
    exact = cross_plain_vehicles(
        BEAM,
        [_HALF_CAR],
        Motion(20.0, _HALF_CAR.behind, start=-5.0),
        result.time,
        profile=_piece(start, length, bump),
        modes=12,
        max_step=2e-3,
        stages=2,
    )
    return _rows(result, exact, _HALF_CAR, train.static_forces(), "1.body.z", 3e-4)


@case("truck-brakes", "An articulated truck brakes on a wavy span", _THEORY)
def truck_brakes() -> list[Row]:
    """The 2A3 truck of the library (tractor and trailer on a hinge) brakes from 25 m/s by 6 m/s2, from -2 m on.

    Waves of 1 mm and 6 m, N12's beam with 1 % damping, 50 elements, steps of 0.5 ms; tires with dashpots, so α = -0.1.
    """
    irregularity = asp.irregularity.Harmonic(amplitude=1e-3, wavelength=6.0)
    train = asp.Train.of(library.vehicle("truck-2a3"))
    crossing = asp.Crossing(
        beam(damping=asp.Modal(0.01)),
        train,
        speed=25.0,
        acceleration=-6.0,
        start=-2.0,
        irregularity=irregularity,
    )
    result = asp.simulate(crossing, time_step=5e-4, steps=4000, every=4, sensors=_SENSORS)
    exact = cross_plain_vehicles(
        BEAM,
        [_TRUCK],
        Motion(25.0, _TRUCK.behind, -6.0, start=-2.0),
        result.time,
        profile=harmonic(1e-3, 6.0),
        modal_damping=0.01,
        modes=12,
        max_step=2e-3,
        stages=2,
    )
    return _rows(result, exact, _TRUCK, train.static_forces(), "1.tractor.z", 1.5e-3)


@case("coach", "An ICE 3 coach crosses a concrete span", _THEORY)
def ice3_coach() -> list[Row]:
    """A coach of ten d.o.f., wheelsets of 1.8 t, at 300 km/h over a span of 30 m with 1 % damping, from -2 m on.

    30 elements, steps of 0.5 ms, everything left to the defaults (α = -0.1, a footprint of 0.6 m): the span and the
    bodies as by hand; contact forces from 25 ms after a wheel enters or leaves until the next one does. Wheels with
    mass bump at the supports; what the footprint does is spread the bump.
    """
    length, speed = 30.0, 300.0 / 3.6
    bridge = asp.bridges.simple_span(
        length=length,
        youngs_modulus=34e9,
        second_moment=3.0,
        mass_per_length=15e3,
        elements=30,
        damping=asp.Modal(0.01),
    )
    train = asp.Train.of(library.vehicle("ice3-heavy"))
    crossing = asp.Crossing(bridge, train, speed=speed, start=-2.0)
    sensors = {"midspan": 15.0}
    result = asp.simulate(crossing, time_step=5e-4, steps=1600, sensors=sensors)
    exact = cross_plain_vehicles(
        SimplySupportedBeam(length, 34e9 * 3.0, 15e3),
        [_ICE3],
        Motion(speed, _ICE3.behind, start=-2.0),
        result.time,
        profile=level(),
        modal_damping=0.01,
        modes=16,
        stages=2,
    )
    away = np.ones(result.time.size, dtype=bool)
    for behind in _ICE3.behind:
        for end in (0.0, length):
            since = result.time - (2.0 + end + behind) / speed
            away &= (since < -4e-3) | (since > 25e-3)
    return _rows(
        result, exact, _ICE3, train.static_forces(), "1.body.z", 2e-3, away, middle=15.0, acceleration=5e-3
    )


def _rows(
    result: asp.Result,
    exact: PlainResponse,
    vehicle: PlainVehicle,
    loads: FloatArray,
    body: str,
    tolerance: float,
    window: FloatArray | slice = slice(None),
    *,
    middle: float = 0.5 * LENGTH,
    acceleration: float | None = None,
) -> list[Row]:
    """Mid-span, first body, and the contact force of the wheel where it is farthest off."""
    static = vehicle.static_loads(GRAVITY)
    off = np.abs(result.contact_force - exact.contact_force)[window].max(axis=0)
    wheel = int((off / static).argmax())
    rows = [
        value(f"static contact force {i + 1}", "kN", 1e-3 * load, 1e-3 * found, 1e-9, "matrices by hand")
        for i, (load, found) in enumerate(zip(static, loads, strict=True))
    ]
    rows += [
        history(
            "mid-span displacement",
            "mm",
            result.time,
            1e3 * exact.beam.displacement_at(middle),
            1e3 * result.at("sensor_displacement", "midspan"),
            tolerance,
            _BY_HAND,
        ),
        history(
            f"displacement {body}",
            "mm",
            result.time,
            1e3 * exact.displacement[:, 0],
            1e3 * result.at("vehicle_displacement", body),
            tolerance,
            _BY_HAND,
        ),
        history(
            f"acceleration {body}",
            "m/s2",
            result.time,
            exact.acceleration[:, 0],
            result.at("vehicle_acceleration", body),
            acceleration or 2.0 * tolerance,
            _BY_HAND,
        ),
        history(
            f"contact force {result.contact[wheel]}, the worst",
            "kN",
            result.time[window],
            1e-3 * exact.contact_force[window, wheel],
            1e-3 * result.contact_force[window, wheel],
            tolerance,
            _BY_HAND,
            scale=1e-3 * float(static[wheel]),
            of="static",
        ),
    ]
    return rows


CASES = (half_car_bump, truck_brakes, ice3_coach)
