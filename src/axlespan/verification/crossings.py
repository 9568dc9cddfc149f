"""The two examples of N12 on beam elements, against the semi-analytical solution and the peaks known of it."""

from __future__ import annotations

import axlespan as asp
from axlespan.reference import CrossingResponse
from axlespan.reference.neves2012 import TIME_STEP, mass_train, single_mass
from axlespan.verification.case import Row, case, history, value
from axlespan.verification.models import LENGTH, beam, sprung_masses

_N12 = (
    "S.G.M. Neves, A.F.M. Azevedo, R. Calçada, A direct method for analyzing the vertical vehicle-structure "
    "interaction, Engineering Structures (2012)"
)
_MODES = "N12 (38) to (42), 20 modes, the same Newmark steps"
_PEAKS = "peaks of an independent solution of N12 (41, 42), four digits"
_NEWMARK = asp.Alpha(0.0, beta=0.25, gamma=0.5)

# Of the peak. Beam elements differ from 20 modes by some 1e-5; accelerations feel the cut-off more.
_DISPLACEMENT, _ACCELERATION = 1e-4, 5e-4


@case("neves-3.1", "One sprung mass crosses a simple span", f"{_N12}, example 3.1, figures 3 to 6")
def example_31() -> list[Row]:
    """A sprung mass (16.66 rad/s) crosses a simply supported beam (30.02 rad/s) at 100 km/h.

    50 beam elements, 900 steps of 1 ms. The acceleration at mid-span depends on how many modes take part, so it is
    not compared.
    """
    crossing = asp.Crossing(beam(), sprung_masses(), speed=100.0 / 3.6)
    result = asp.simulate(
        crossing, time_step=TIME_STEP, steps=900, method=_NEWMARK, sensors={"midspan": 0.5 * LENGTH}
    )
    exact = single_mass()
    deflection = 1e3 * result.at("sensor_displacement", "midspan")
    rows = [
        history(
            "mid-span displacement",
            "mm",
            result.time,
            1e3 * exact.beam.displacement_at(0.5 * LENGTH),
            deflection,
            _DISPLACEMENT,
            _MODES,
        ),
        *_mass_rows("mass", result, exact, 0, slice(None), _ACCELERATION),
    ]
    for name, expected, obtained in (
        ("mid-span displacement, lowest", -2.4069, deflection.min()),
        ("mid-span displacement, highest", 0.1643, deflection.max()),
    ):
        rows.append(value(name, "mm", expected, obtained, _DISPLACEMENT, _PEAKS, scale=2.4069, of="peak"))
    return rows + _peak_rows("mass", result, 0, slice(None), (-2.5899, 0.4986), (-0.1421, 0.1480))


@case("neves-3.2", "Fifty sprung masses over an uneven span", f"{_N12}, example 3.2, figures 7 to 10")
def example_32() -> list[Row]:
    """Fifty sprung masses, 3 m apart, at 47.7 km/h over waves of 0.5 mm and 5 m on the beam: in resonance.

    50 beam elements, 14 000 steps of 1 ms; the first mass until 3 s, the last from 11 to 14 s.
    """
    irregularity = asp.irregularity.Harmonic(amplitude=0.5e-3, wavelength=5.0, start=0.0, stop=LENGTH)
    crossing = asp.Crossing(beam(), sprung_masses(50), speed=47.7 / 3.6, irregularity=irregularity)
    result = asp.simulate(crossing, time_step=TIME_STEP, steps=14_000, method=_NEWMARK)
    exact = mass_train()
    first, last = slice(0, 3001), slice(11_000, 14_001)
    return [
        *_mass_rows("first mass", result, exact, 0, first, 1e-4),
        *_mass_rows("last mass", result, exact, 49, last, 1e-4),
        *_peak_rows("first mass", result, 0, first, (-12.840, 7.345), (-2.037, 2.037)),
        *_peak_rows("last mass", result, 49, last, (-11.593, 7.152), (-1.984, 1.984)),
    ]


def _mass_rows(
    who: str, result: asp.Result, exact: CrossingResponse, vehicle: int, window: slice, acceleration: float
) -> list[Row]:
    """Histories of a mass and of its contact force."""
    name = f"{vehicle + 1}.body.z"
    time = result.time[window]
    return [
        history(
            f"{who}, displacement",
            "mm",
            time,
            1e3 * exact.body_displacement[window, vehicle],
            1e3 * result.at("vehicle_displacement", name)[window],
            _DISPLACEMENT,
            _MODES,
        ),
        history(
            f"{who}, acceleration",
            "m/s2",
            time,
            exact.body_acceleration[window, vehicle],
            result.at("vehicle_acceleration", name)[window],
            acceleration,
            _MODES,
        ),
        history(
            f"{who}, contact force",
            "kN",
            time,
            1e-3 * exact.contact_force[window, vehicle],
            1e-3 * result.at("contact_force", f"{vehicle + 1}.1")[window],
            1e-4,
            _MODES,
        ),
    ]


def _peak_rows(
    who: str,
    result: asp.Result,
    vehicle: int,
    window: slice,
    displacements: tuple[float, float],
    accelerations: tuple[float, float],
) -> list[Row]:
    """Lowest and highest displacement [mm] and acceleration [m/s2] of a mass, as printed.

    Accelerations are known to four digits, up to 3.5e-4 of the peak, hence their tolerance.
    """
    rows = []
    for what, unit, factor, printed, tolerance in (
        ("displacement", "mm", 1e3, displacements, _DISPLACEMENT),
        ("acceleration", "m/s2", 1.0, accelerations, _ACCELERATION),
    ):
        obtained = factor * result.at(f"vehicle_{what}", f"{vehicle + 1}.body.z")[window]
        scale = max(abs(number) for number in printed)
        for end, expected, found in zip(
            ("lowest", "highest"), printed, (obtained.min(), obtained.max()), strict=True
        ):
            quantity = f"{who}, {what}, {end}"
            rows.append(value(quantity, unit, expected, found, tolerance, _PEAKS, scale=scale, of="peak"))
    return rows


CASES = (example_31, example_32)
