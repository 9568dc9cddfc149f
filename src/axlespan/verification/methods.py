"""Properties of the methods: order in the time step, and four ways to the same numbers."""

from __future__ import annotations

import numpy as np

import axlespan as asp
from axlespan.reference import Motion, SuspendedBody, cross_sprung_masses
from axlespan.reference.neves2012 import BEAM, MASS
from axlespan.verification.case import Row, case, history, value
from axlespan.verification.models import LENGTH, beam, sprung_masses

_HHT = (
    "H.M. Hilber, T.J.R. Hughes, R.L. Taylor, Improved numerical dissipation for time integration algorithms in "
    "structural dynamics, Earthquake Eng. Struct. Dyn. 5 (1977) 283-292"
)
_N12 = "N12, section 2 and appendix A: one system of equations, solved in four ways"


@case("alpha-order", "The alpha method is of second order", _HHT)
def alpha_order() -> list[Row]:
    """Halving the time step divides the error by four, with α = 0 (Newmark) and with α = -0.1.

    A sprung mass over waves on rigid ground (4 and 2 ms, closed form), and over the beam (10 and 5 ms, modes).
    """
    rows = []
    for alpha in (0.0, -0.1):
        for where, compute, steps in (("waves", _error_on_waves, 4e-3), ("beam", _error_on_beam, 1e-2)):
            order = np.log2(compute(alpha, steps) / compute(alpha, 0.5 * steps))
            origin = "theory of the method"
            rows.append(
                value(
                    f"order on {where}, alpha = {alpha:g}", "-", 2.0, order, 0.05, origin, scale=1.0, of="1"
                )
            )
    return rows


def _error_on_waves(alpha: float, step: float) -> float:
    """Largest error of the mass over waves of 1 mm, at 2 Hz for 1 s, before it comes to the beam [m]."""
    waves = asp.irregularity.Harmonic(amplitude=1e-3, wavelength=10.0)
    crossing = asp.Crossing(beam(2), sprung_masses(), speed=20.0, start=-20.0, irregularity=waves)
    result = asp.simulate(crossing, time_step=step, steps=round(1.0 / step), method=asp.Alpha(alpha))
    body = SuspendedBody(MASS.body_mass, MASS.stiffness)
    exact = body.over_harmonic(1e-3, 4.0 * np.pi, result.time)
    return float(np.abs(result.at("vehicle_displacement", "1.body.z") - exact.displacement).max())


def _error_on_beam(alpha: float, step: float) -> float:
    """Largest error of the mass that crosses the beam at 25 m/s [m]."""
    crossing = asp.Crossing(beam(), sprung_masses(), speed=25.0)
    result = asp.simulate(crossing, time_step=step, steps=round(1.0 / step), method=asp.Alpha(alpha))
    exact = cross_sprung_masses(BEAM, [MASS], Motion(25.0), result.time, max_step=5e-4)
    return float(np.abs(result.at("vehicle_displacement", "1.body.z") - exact.body_displacement[:, 0]).max())


@case("couplings", "Direct, literal, iterative and refactored coupling agree", _N12)
def couplings() -> list[Row]:
    """Two vehicles with heavy wheels and dashpots cross a damped beam of 10 elements over waves.

    The iterative coupling stops at 1e-10 of the static load in each step; the others differ by rounding.
    """
    train = sprung_masses(2, damping=20e3, unsprung_mass=500.0)
    waves = asp.irregularity.Harmonic(amplitude=1e-3, wavelength=6.0)
    structure = beam(10, damping=asp.Rayleigh(0.5, 1e-4))
    crossing = asp.Crossing(structure, train, speed=25.0, irregularity=waves)
    return _compared(crossing, 1e-3, 600, None, 1e-8)


@case("couplings-train", "The four couplings agree on example 3.2", _N12, long=True)
def couplings_train() -> list[Row]:
    """N12's fifty sprung masses over the uneven beam, 14 000 steps."""
    waves = asp.irregularity.Harmonic(amplitude=0.5e-3, wavelength=5.0, start=0.0, stop=LENGTH)
    crossing = asp.Crossing(beam(), sprung_masses(50), speed=47.7 / 3.6, irregularity=waves)
    return _compared(crossing, 1e-3, 14_000, asp.Alpha(0.0), 1e-8)


def _compared(
    crossing: asp.Crossing, step: float, steps: int, method: asp.Alpha | None, tolerance: float
) -> list[Row]:
    """Contact forces and mid-span motion of three couplings against the direct one."""
    results = {
        coupling: asp.simulate(
            crossing,
            time_step=step,
            steps=steps,
            method=method,
            coupling=coupling,
            sensors={"midspan": 0.5 * LENGTH},
        )
        for coupling in ("direct", "literal", "iterative", "refactored")
    }
    direct = results.pop("direct")
    rows = []
    for coupling, result in results.items():
        for quantity, name, unit in (
            ("contact forces", "contact_force", "N"),
            ("mid-span displacement", "sensor_displacement", "m"),
            ("support reactions", "support_reaction", "N"),
        ):
            expected = getattr(direct, name)
            time = np.broadcast_to(direct.time[:, np.newaxis], expected.shape).ravel()
            obtained = getattr(result, name).ravel()
            rows.append(
                history(
                    f"{coupling}: {quantity}",
                    unit,
                    time,
                    expected.ravel(),
                    obtained,
                    tolerance,
                    "direct coupling",
                )
            )
    return rows


CASES = (alpha_order, couplings, couplings_train)
