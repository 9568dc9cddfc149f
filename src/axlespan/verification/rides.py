"""Vehicles on rigid ground: nothing on a level line, and closed forms on waves, rough roads and under wind."""

from __future__ import annotations

import numpy as np

import axlespan as asp
from axlespan.bridges import GridBeam, beam_grid
from axlespan.reference import SuspendedBody, quarter_car, ride
from axlespan.vehicles import Body, BodyLoad, Suspension, Wheel, library, multibody
from axlespan.verification.case import Row, case, history, value
from axlespan.verification.models import GRAVITY, beam

_THEORY = "theory page 'Reference solutions', (R36)"


@case("level-ground", "Trains on level ground feel nothing", "statics")
def level_ground() -> list[Row]:
    """Vehicles of the library, in the plane and in space, approach at 60 m/s from -80 m on rigid level ground.

    Contact forces until the first wheel reaches the span, over the static ones.
    """
    rows = []
    for name in ("ice3-heavy", "truck-2a3", "sgns", "ice-3d-motor", "hs20-3d"):
        vehicle = library.vehicle(name)
        lines = {"left": "main", "right": "main"} if "3d" in name else None
        crossing = asp.Crossing(beam(10), asp.Train.of(vehicle), speed=60.0, start=-80.0, line=lines)
        result = asp.simulate(crossing, time_step=2e-3, steps=670)
        before = result.time < (80.0 - 1.2) / 60.0
        ratio = result.contact_force[before] / vehicle.static_forces()
        worst = float(ratio.ravel()[np.abs(ratio - 1.0).argmax()])
        rows.append(value(f"{name}: worst contact force over static", "-", 1.0, worst, 1e-9, "equilibrium"))
    return rows


@case("rough-road", "A quarter car on a rough road", _THEORY)
def rough_road() -> list[Row]:
    """The quarter car of the library at 20 m/s on a seeded road of class B (ISO 8608), 0.5 to 50 m, on the ground.

    Steps of 0.5 ms. The road's cosines are answered one by one, and the start by the car's own motions.
    """
    profile = asp.irregularity.realize("iso8608-b", 150.0, seed=3, wavelengths=(0.5, 50.0))
    start, speed, steps = -100.0, 20.0, 10_000
    crossing = asp.Crossing(
        beam(10),
        asp.Train.of(library.vehicle("quarter-car")),
        speed=speed,
        start=start,
        irregularity=profile,
    )
    result = asp.simulate(crossing, time_step=5e-4, steps=steps + 20, every=4)
    before = slice(0, steps // 4)
    waves = profile.waves()
    car = quarter_car(17_300.0, 700.0, (4e5, 1e4), (1.75e6, 0.0))
    frequencies = 2.0 * np.pi * speed * waves.frequencies
    amplitudes = waves.amplitudes * np.exp(1j * (2.0 * np.pi * waves.frequencies * start + waves.phases))
    motion, force = ride(car, frequencies, amplitudes[:, np.newaxis], result.time[before])
    rows = [
        history(
            f"displacement of the {name}",
            "mm",
            result.time[before],
            1e3 * motion[:, i],
            1e3 * result.vehicle_displacement[before, i],
            3e-4,
            "closed form, cosine by cosine",
        )
        for i, name in enumerate(("body", "axle"))
    ]
    static = 18_000.0 * GRAVITY
    return [
        *rows,
        history(
            "contact force",
            "kN",
            result.time[before],
            1e-3 * (static + force[:, 0]),
            1e-3 * result.contact_force[before, 0],
            1e-4,
            "closed form, cosine by cosine",
            scale=1e-3 * static,
            of="static",
        ),
    ]


@case(
    "roll", "A tram rolls: cross-wind, and waves that lift left and right in turn", "theory, (R27) to (R29)"
)
def roll() -> list[Row]:
    """Cross-wind shifts load from the left wheels to the right ones; waves of 1 mm, opposite on both sides, roll it.

    The waves are as long as the wheelbase, 4 m, so that both wheelsets roll alike. Rigid ground, 10 m/s, 1 ms steps.
    """
    inertia, stiffness, damping, spread, gauge = 14e3, 0.8e6, 15e3, 1.9, 1.5
    wheels = [Wheel(x, 900.0, gauge=gauge, roll_inertia=400.0) for x in (0.0, 4.0)]
    tram = multibody(
        bodies=[Body("body", 12e3, 2.0, 60e3, roll_inertia=inertia, height=1.5)],
        wheels=wheels,
        suspensions=[Suspension(("body", f"wheel{i}"), stiffness, damping, spread=spread) for i in (1, 2)],
    )
    wind = 15e3 * 1.9 / gauge / 2.0  # [N] of each wheelset
    blown = tram.loaded([BodyLoad("body", y=-15e3, height=1.9)])
    even = (12e3 + 2.0 * 900.0) * GRAVITY / 4.0
    rows = [
        value(f"in wind, wheel {name}", "kN", 1e-3 * (even + sign * wind), 1e-3 * load, 1e-9, "moments")
        for name, sign, load in zip(("1l", "1r"), (-1.0, 1.0), blown.static_forces()[:2], strict=True)
    ]
    amplitude, speed, start = 1e-3, 10.0, -20.0
    waves = asp.irregularity.Harmonic(amplitude=amplitude, wavelength=4.0)
    opposite = asp.irregularity.Harmonic(amplitude=-amplitude, wavelength=4.0)
    beams = GridBeam(second_moment=0.5, torsion_constant=0.05, area=1.0, mass_per_length=5e3)
    grid = beam_grid(
        length=10.0, girders=[-1.0, 1.0], girder=beams, cross_beam=beams, youngs_modulus=34e9, elements=4
    )
    crossing = asp.Crossing(
        grid,
        asp.Train.of(tram),
        speed=speed,
        start=start,
        irregularity={"left": waves, "right": opposite},
    )
    result = asp.simulate(crossing, time_step=1e-3, steps=2050)
    before = result.time < 1.9
    arm = 2.0 * 2.0 * (0.5 * spread) ** 2  # two wheelsets, two sides
    body = SuspendedBody(inertia, arm * stiffness, arm * damping)
    foot, frequency = 2.0 * amplitude / gauge, 2.0 * np.pi * speed / 4.0
    motion = body.over_harmonic(foot, frequency, result.time[before])
    static = inertia * motion.acceleration / gauge / 2.0  # [N] from right to left by the body alone
    own = -400.0 * foot * frequency**2 * np.sin(frequency * result.time[before]) / gauge
    origin = "closed form"
    return [
        *rows,
        history(
            "roll of the body",
            "mrad",
            result.time[before],
            1e3 * motion.displacement,
            1e3 * result.at("vehicle_displacement", "1.body.roll")[before],
            2e-3,
            origin,
        ),
        history(
            "half the difference of wheels 1l and 1r",
            "kN",
            result.time[before],
            1e-3 * (static + own),
            0.5e-3 * (result.at("contact_force", "1.1l") - result.at("contact_force", "1.1r"))[before],
            2e-3,
            origin,
            scale=1e-3 * even,
            of="static",
        ),
    ]


CASES = (level_ground, rough_road, roll)
