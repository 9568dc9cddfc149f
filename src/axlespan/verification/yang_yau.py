"""The sprung mass of Yang and Yau in numbers: the whole beam, a few of its modes, and with a stiff dashpot."""

from __future__ import annotations

import numpy as np

import axlespan as asp
from axlespan.dynamics.reduction import ReducedBasis
from axlespan.interaction.simulate import reduce_structure
from axlespan.linalg.eigen import lowest_modes
from axlespan.reference import Motion, WheelUnit, cross_sprung_masses
from axlespan.reference.neves2012 import BEAM, MASS
from axlespan.verification.case import Row, case, history, value
from axlespan.verification.models import LENGTH, WEIGHT, beam, sprung_masses

_YANG = (
    "Y.B. Yang, J.D. Yau, Vehicle-bridge interaction element for dynamic analysis, "
    "J. Struct. Eng. 123 (1997) 1512-1518: the problem; numbers by modes"
)
_SPEED = 100.0 / 3.6  # [m/s]
_SENSORS = {"midspan": 0.5 * LENGTH}
_MODAL = "modal solution, five digits"

# Every 0.1 s, with 21 modes [mm]
_TIMES = np.arange(1, 9) * 0.1
_MIDSPAN = (0.69711, 1.43738, 1.84991, 2.30548, 2.10969, 1.98538, 1.30386, 0.86360)
_MASS = (0.05183, 0.86495, 2.09082, 2.55617, 2.21105, 1.64224, 1.35380, 0.35893)

# Modes: largest mid-span deflection [mm], upward and downward acceleration there [m/s2],
# deflection of the mass [mm], its upward and downward acceleration [m/s2]
_COLUMNS = {
    1: (2.38389, 0.27309, 0.23363, 2.65768, 0.18361, 0.12983),
    3: (2.40973, 0.35199, 0.30896, 2.58968, 0.14865, 0.14446),
    5: (2.40826, 0.37497, 0.33236, 2.58967, 0.14809, 0.14297),
}


@case("yang-yau", "A sprung mass on a simple span, in numbers", _YANG)
def yang_yau() -> list[Row]:
    """N12's example 3.1 at eight instants and by its largest values, as 21 modes give them.

    50 beam elements, steps of 0.2 ms.
    """
    crossing = asp.Crossing(beam(), sprung_masses(), speed=_SPEED)
    result = asp.simulate(crossing, time_step=2e-4, steps=4500, sensors=_SENSORS, reactions=False)
    at = np.rint(_TIMES / 2e-4).astype(int)
    deflection = -1e3 * result.at("sensor_displacement", "midspan")
    mass = -1e3 * result.at("vehicle_displacement", "1.body.z")
    acceleration = result.at("vehicle_acceleration", "1.body.z")
    return [
        history("mid-span at eight instants", "mm", _TIMES, _MIDSPAN, deflection[at], 1e-4, _MODAL),
        history("mass at eight instants", "mm", _TIMES, _MASS, mass[at], 1e-4, _MODAL),
        value("largest mid-span deflection", "mm", 2.40731, deflection.max(), 1e-4, _MODAL),
        value("its time", "s", 0.3710, result.time[deflection.argmax()], 1e-3, _MODAL),
        value("largest deflection of the mass", "mm", 2.58998, mass.max(), 1e-4, _MODAL),
        value("acceleration of the mass, highest", "m/s2", 0.14797, acceleration.max(), 5e-4, _MODAL),
        value("acceleration of the mass, lowest", "m/s2", -0.14219, acceleration.min(), 5e-4, _MODAL),
    ]


@case("yang-yau-modes", "A sprung mass on a few modes of the span", _YANG)
def yang_yau_modes() -> list[Row]:
    """The same crossing, solved in the space of the finite element model's first 1, 3 and 5 modes.

    Steps of 0.2 ms. The beam's accelerations ring with the highest mode and need shorter ones for more digits.
    """
    structure = beam()
    whole = reduce_structure(structure)
    matrices = structure.system.partition
    rows = []
    for count, numbers in _COLUMNS.items():
        modes = lowest_modes(matrices.K_FF, matrices.M_FF, count)
        shapes = np.ascontiguousarray(modes.shapes)
        basis = ReducedBasis(shapes, modes.angular_frequencies, whole.path_dofs, whole.static_factor)
        crossing = asp.Crossing(structure, sprung_masses(), speed=_SPEED)
        result = asp.simulate(
            crossing, time_step=2e-4, steps=4500, sensors=_SENSORS, basis=basis, reactions=False
        )
        there = result.at("sensor_acceleration", "midspan")
        body = result.at("vehicle_acceleration", "1.body.z")
        found = (
            ("mid-span deflection", "mm", -1e3 * result.sensor_displacement.min(), 1e-4),
            ("mid-span acceleration, upward", "m/s2", there.max(), 3e-2),
            ("mid-span acceleration, downward", "m/s2", -there.min(), 3e-2),
            (
                "deflection of the mass",
                "mm",
                -1e3 * result.at("vehicle_displacement", "1.body.z").min(),
                1e-4,
            ),
            ("acceleration of the mass, upward", "m/s2", body.max(), 5e-4),
            ("acceleration of the mass, downward", "m/s2", -body.min(), 5e-4),
        )
        word = f"{count} mode{'s' if count > 1 else ''}: "
        rows += [
            value(word + name, unit, expected, obtained, tolerance, _MODAL)
            for expected, (name, unit, obtained, tolerance) in zip(numbers, found, strict=True)
        ]
    return rows


@case(
    "stiff-dashpot", "A sprung mass with a stiff dashpot", "the problem of VBI-2D, V02; theory, (R9) to (R18)"
)
def stiff_dashpot() -> list[Row]:
    """N12's vehicle with a dashpot of 400 kNs/m, twice its critical damping, at 100 km/h.

    50 elements, steps of 0.2 ms, α = -0.1 by default. As the wheel leaves, the slope under it ends, and the dashpot's
    force with it: the contact force there settles within some steps.
    """
    crossing = asp.Crossing(beam(), sprung_masses(damping=400e3), speed=_SPEED)
    result = asp.simulate(crossing, time_step=2e-4, steps=6000, sensors=_SENSORS)
    exact = cross_sprung_masses(
        BEAM,
        [WheelUnit.sprung_mass(MASS.body_mass, MASS.stiffness, 400e3)],
        Motion(_SPEED),
        result.time,
        max_step=4e-4,
    )
    settled = np.abs(result.time - LENGTH / _SPEED) > 5e-3
    settled &= result.time > 5e-3
    origin = "20 modes, converged in time"
    return [
        history(
            "mid-span displacement",
            "mm",
            result.time,
            1e3 * exact.beam.displacement_at(0.5 * LENGTH),
            1e3 * result.at("sensor_displacement", "midspan"),
            1e-4,
            origin,
        ),
        history(
            "displacement of the mass",
            "mm",
            result.time,
            1e3 * exact.body_displacement[:, 0],
            1e3 * result.at("vehicle_displacement", "1.body.z"),
            1e-4,
            origin,
        ),
        history(
            "contact force, but for 5 ms about entry and exit",
            "kN",
            result.time[settled],
            1e-3 * exact.contact_force[settled, 0],
            1e-3 * result.contact_force[settled, 0],
            5e-4,  # the slope under the wheel converges slowly with the modes
            origin,
            scale=1e-3 * WEIGHT,
            of="static",
        ),
    ]


CASES = (yang_yau, yang_yau_modes, stiff_dashpot)
