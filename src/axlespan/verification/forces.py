"""Moving forces on a simple span, against the closed form."""

from __future__ import annotations

import numpy as np

import axlespan as asp
from axlespan.reference import Motion, cross_forces
from axlespan.reference.neves2012 import BEAM
from axlespan.verification.case import Row, case, history, value
from axlespan.verification.models import BENDING_STIFFNESS, LENGTH, WEIGHT, axle, beam

_FRYBA = "L. Frýba, Vibration of Solids and Structures under Moving Loads, 3rd ed. (1999)"
_CLOSED = "closed form, 51 modes"
_TOLERANCE = 1e-4  # closed form and 50 elements differ by less; steps of 0.1 ms leave 4e-5

# α = v / 2 f1 L: largest mid-span deflection during the crossing over P L^3 / 48 EI, 51 modes
_AMPLIFICATION = {
    0.1: 1.09645,
    0.2: 1.06527,
    0.25: 1.25761,
    0.3: 1.41049,
    0.4: 1.61289,
    0.5: 1.70545,
    0.6: 1.73113,
    0.617: 1.73167,
    0.7: 1.72040,
    0.8: 1.67617,
    0.9: 1.61268,
    1.0: 1.54807,
}


@case("moving-force", "A force crosses a simple span", _FRYBA)
def moving_force() -> list[Row]:
    """The weight of N12's vehicle as a force at 100 km/h, and the free vibration that it leaves.

    50 elements, steps of 0.1 ms.
    """
    sensors = {"midspan": 0.5 * LENGTH, "0.28 L": 0.28 * LENGTH}
    crossing = asp.Crossing(beam(), axle(WEIGHT), speed=100.0 / 3.6)
    result = asp.simulate(crossing, time_step=1e-4, steps=12_000, sensors=sensors)
    exact = cross_forces(BEAM, [WEIGHT], Motion(100.0 / 3.6), result.time)
    rows = [
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
    lowest = 1e3 * result.at("sensor_displacement", "midspan").min()
    return [*rows, value("displacement at midspan, lowest", "mm", -2.39683, lowest, _TOLERANCE, _CLOSED)]


@case("moving-force-speeds", "Dynamic amplification of a force over its speed", _FRYBA)
def moving_force_speeds() -> list[Row]:
    """Largest mid-span deflection during the crossing over the static one, from a tenth of the critical speed on.

    50 elements, 2000 steps or more in a crossing.
    """
    structure, train = beam(), axle(WEIGHT)
    static = WEIGHT * LENGTH**3 / (48.0 * BENDING_STIFFNESS)
    rows = []
    for alpha, expected in _AMPLIFICATION.items():
        crossing = asp.Crossing(structure, train, speed=alpha * BEAM.critical_speed)
        duration = LENGTH / (alpha * BEAM.critical_speed)
        steps = max(2000, int(np.ceil(duration / 1e-4)))
        sensors = {"midspan": 0.5 * LENGTH}
        result = asp.simulate(crossing, time_step=duration / steps, steps=steps, sensors=sensors)
        obtained = -result.sensor_displacement.min() / static
        rows.append(value(f"amplification, alpha = {alpha:g}", "-", expected, obtained, _TOLERANCE, _CLOSED))
    return rows


@case("axle-row", "A power car of four axles, damped beam", _FRYBA)
def axle_row() -> list[Row]:
    """Four axles of 170 kN at 0, 3, 14 and 17 m (the power car of HSLM-A1) at 50 m/s; 2 % damping in every mode.

    50 elements, steps of 0.2 ms.
    """
    loads, behind = [170e3] * 4, (0.0, 3.0, 14.0, 17.0)
    train = asp.Train.of(asp.vehicles.axle_loads(loads=loads, positions=behind))
    sensors = {"midspan": 0.5 * LENGTH, "quarter": 0.25 * LENGTH}
    crossing = asp.Crossing(beam(damping=asp.Modal(0.02)), train, speed=50.0)
    result = asp.simulate(crossing, time_step=2e-4, steps=6000, sensors=sensors)
    exact = cross_forces(BEAM, loads, Motion(50.0, behind), result.time, modal_damping=0.02)
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


CASES = (moving_force, moving_force_speeds, axle_row)
