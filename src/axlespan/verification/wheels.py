"""Wheels with mass, dashpots, ramps and changing speed, against semi-analytical solutions converged in time."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

import axlespan as asp
from axlespan.reference import (
    CrossingResponse,
    Motion,
    Profile,
    WheelUnit,
    cross_sprung_masses,
    cross_wheel_units,
    harmonic,
)
from axlespan.reference.neves2012 import BEAM, MASS
from axlespan.verification.case import Row, case, history, value
from axlespan.verification.models import (
    BENDING_STIFFNESS,
    GRAVITY,
    LENGTH,
    MASS_PER_LENGTH,
    WEIGHT,
    beam,
    sprung_masses,
)

_AKIN = (
    "J.E. Akin, M. Mofid, Numerical solution for response of beams with moving mass, "
    "J. Struct. Eng. 115 (1989) 120-131: the problem; numbers by modes"
)
_THEORY = "theory page 'Reference solutions', (R9) to (R18)"
_Positions = npt.NDArray[np.floating[Any]]

_SENSORS = {"midspan": 0.5 * LENGTH}


@case("moving-mass", "A heavy mass follows the beam", _AKIN)
def moving_mass() -> list[Row]:
    """A mass of 0.1, 0.5 and 1 times the beam's runs on it at 0.25, 0.5 and 0.75 of the critical speed.

    Everything left to the defaults (α = -0.1, a footprint of 3 % of the span), 1000 steps: the largest deflection
    at mid-span is within 0.5 %. Where the contact force turns to tension the mass is held, as in the reference.
    """
    structure, rows = beam(), []
    for ratio in (0.1, 0.5, 1.0):
        mass = ratio * MASS_PER_LENGTH * LENGTH
        train = asp.Train.of(asp.vehicles.rigid_mass(mass=mass))
        static = mass * GRAVITY * LENGTH**3 / (48.0 * BENDING_STIFFNESS)
        for alpha in (0.25, 0.5, 0.75):
            speed = alpha * BEAM.critical_speed
            duration = LENGTH / speed
            crossing = asp.Crossing(structure, train, speed=speed)
            result = asp.simulate(crossing, time_step=duration / 1000, steps=1000, sensors=_SENSORS)
            exact = cross_wheel_units(
                BEAM,
                [WheelUnit.rigid_mass(mass)],
                Motion(speed),
                result.time,
                modes=20,
                max_step=duration / 2000,
            )
            rows.append(
                value(
                    f"amplification, mass {ratio:g}, alpha = {alpha:g}",
                    "-",
                    -exact.beam.displacement_at(0.5 * LENGTH).min() / static,
                    -result.sensor_displacement.min() / static,
                    5e-3,
                    "20 modes, converged in time",
                )
            )
    return rows


@case("wheels-with-mass", "Two units with heavy wheels on a wavy line", _THEORY)
def wheels_with_mass() -> list[Row]:
    """Two units (5750 kg on 1595 kN/m and 20 kNs/m over 500 kg), 3 m apart, at 20 m/s over waves of 0.1 mm and 4 m.

    Everything left to the defaults, steps of 1 ms: contact forces from 50 ms after each entry until the first exit.
    Nothing grows when steps are halved.
    """
    speed, spacing, unsprung = 20.0, 3.0, 500.0
    damping = 20e3
    train = sprung_masses(2, spacing, damping=damping, unsprung_mass=unsprung)
    irregularity = asp.irregularity.Harmonic(amplitude=0.1e-3, wavelength=4.0)
    crossing = asp.Crossing(beam(), train, speed=speed, irregularity=irregularity)
    coarse, fine = (
        asp.simulate(crossing, time_step=step, steps=round(1.5 / step), sensors=_SENSORS)
        for step in (1e-3, 5e-4)
    )
    unit = WheelUnit(unsprung, MASS.body_mass, MASS.stiffness, damping)
    time = coarse.time[coarse.time < LENGTH / speed - 1e-9]
    motion = Motion.spaced(speed, 2, spacing)
    exact = cross_wheel_units(BEAM, [unit] * 2, motion, time, modes=40, profile=harmonic(0.1e-3, 4.0))
    static = unit.mass * GRAVITY
    rows = []
    for wheel in range(2):
        window = np.flatnonzero(time > wheel * spacing / speed + 0.05)
        rows.append(
            history(
                f"contact force {wheel + 1}.1",
                "kN",
                time[window],
                1e-3 * exact.contact_force[window, wheel],
                1e-3 * coarse.contact_force[window, wheel],
                3e-3,
                "40 modes, converged in time",
                scale=1e-3 * static,
                of="static",
            )
        )
    coarse_peak, fine_peak = (1e-3 * result.contact_force.max() for result in (coarse, fine))
    name = "largest contact force, half the step"
    return [*rows, value(name, "kN", coarse_peak, fine_peak, 0.02, "steps of 1 ms")]


@case("suspension-damping", "A sprung mass with a dashpot on a wavy line", _THEORY)
def suspension_damping() -> list[Row]:
    """N12's vehicle with a dashpot of 20 kNs/m at 20 m/s over waves of 1 mm and 6 m; α = -0.1 by default.

    50 elements, steps of 0.2 ms, until the mass has left.
    """
    irregularity = asp.irregularity.Harmonic(amplitude=1e-3, wavelength=6.0)
    crossing = asp.Crossing(beam(), sprung_masses(damping=20e3), speed=20.0, irregularity=irregularity)
    result = asp.simulate(crossing, time_step=2e-4, steps=6500, sensors=_SENSORS)
    exact = cross_sprung_masses(
        BEAM,
        [WheelUnit.sprung_mass(MASS.body_mass, MASS.stiffness, 20e3)],
        Motion(20.0),
        result.time,
        profile=harmonic(1e-3, 6.0),
        max_step=2e-4,
    )
    return _crossing_rows(result, exact, 1e-4)


@case("speed-changes", "Two sprung masses brake and gather speed on a wavy line", _THEORY)
def speed_changes() -> list[Row]:
    """Two of N12's vehicles, 3 m apart, brake from 30 m/s by 8 m/s2, or gather speed from 10 m/s.

    Waves of 1 mm and 6 m, 50 elements, steps of 0.2 ms for 1.2 s.
    """
    rows, duration = [], 1.2
    irregularity = asp.irregularity.Harmonic(amplitude=1e-3, wavelength=6.0)
    for word, speed, acceleration in (("braking", 30.0, -8.0), ("gathering speed", 10.0, 8.0)):
        speeds = [[0.0, speed], [duration, speed + acceleration * duration]]
        crossing = asp.Crossing(beam(), sprung_masses(2), speed_history=speeds, irregularity=irregularity)
        result = asp.simulate(crossing, time_step=2e-4, steps=6000, sensors=_SENSORS)
        exact = cross_sprung_masses(
            BEAM,
            [MASS] * 2,
            Motion(speed, (0.0, 3.0), acceleration),
            result.time,
            profile=harmonic(1e-3, 6.0),
            max_step=2e-4,
        )
        rows += _crossing_rows(result, exact, 1e-4, f"{word}: ")
    return rows


@case("ramp", "A dashpot on a massless contact runs over a ramp", _THEORY)
def ramp() -> list[Row]:
    """A rise of 10 mm within 3.025 m (121 steps) under N12's vehicle with a dashpot of 400 kNs/m at 25 m/s.

    With α = 0 the velocity of the massless contact would ring for ever, and the contact force by more than the
    static load. By default α = -0.1: within 0.6 % of it soon after, be the ramp on the ground or on the span.
    """
    first = _ramp_crossing(rise_at=-15.0, start=-20.0, steps=800)
    second = _ramp_crossing(rise_at=10.0, start=0.0, steps=1500)
    rows = []
    for where, (result, exact), since in (
        ("ramp on the ground", first, (20.0 - 15.0 + 3.025) / 25.0 + 0.05),
        ("ramp on the span, left", second, LENGTH / 25.0 + 0.1),
    ):
        window = np.flatnonzero(result.time > since)
        rows.append(
            history(
                f"{where}: contact force",
                "kN",
                result.time[window],
                1e-3 * exact.contact_force[window, 0],
                1e-3 * result.contact_force[window, 0],
                6e-3,
                "20 modes, converged in time",
                scale=1e-3 * WEIGHT,
                of="static",
            )
        )
    result, exact = second
    rows.append(
        history(
            "ramp on the span: displacement of the mass",
            "mm",
            result.time,
            1e3 * exact.body_displacement[:, 0],
            1e3 * result.at("vehicle_displacement", "1.body.z"),
            1e-3,
            "20 modes, converged in time",
        )
    )
    return rows


def _ramp_crossing(rise_at: float, start: float, steps: int) -> tuple[asp.Result, CrossingResponse]:
    length, height, speed, damping = 3.025, 10e-3, 25.0, 400e3
    crossing = asp.Crossing(
        beam(),
        sprung_masses(damping=damping),
        speed=speed,
        start=start,
        irregularity=asp.irregularity.Ramp(rise_at, rise_at + length, height),
    )
    result = asp.simulate(crossing, time_step=1e-3, steps=steps, sensors=_SENSORS)

    def rise(x: _Positions) -> _Positions:
        return np.asarray(height * np.clip((x - rise_at) / length, 0.0, 1.0))

    def slope(x: _Positions) -> _Positions:
        return np.where((x >= rise_at) & (x <= rise_at + length), height / length, 0.0)

    exact = cross_sprung_masses(
        BEAM,
        [WheelUnit.sprung_mass(MASS.body_mass, MASS.stiffness, damping)],
        Motion(speed, start=start),
        result.time,
        profile=Profile(rise, slope, None, (rise_at, rise_at + length)),
        max_step=2e-4,
    )
    return result, exact


def _crossing_rows(
    result: asp.Result, exact: CrossingResponse, tolerance: float, word: str = ""
) -> list[Row]:
    """Histories of mid-span, and of the last vehicle and its contact force."""
    last = exact.contact_force.shape[1]
    origin = "20 modes, converged in time"
    return [
        history(
            f"{word}mid-span displacement",
            "mm",
            result.time,
            1e3 * exact.beam.displacement_at(0.5 * LENGTH),
            1e3 * result.at("sensor_displacement", "midspan"),
            tolerance,
            origin,
        ),
        history(
            f"{word}displacement of mass {last}",
            "mm",
            result.time,
            1e3 * exact.body_displacement[:, last - 1],
            1e3 * result.at("vehicle_displacement", f"{last}.body.z"),
            tolerance,
            origin,
        ),
        history(
            f"{word}contact force {last}.1",
            "kN",
            result.time,
            1e-3 * exact.contact_force[:, last - 1],
            1e-3 * result.at("contact_force", f"{last}.1"),
            tolerance,
            origin,
        ),
    ]


CASES = (moving_mass, wheels_with_mass, suspension_damping, speed_changes, ramp)
