"""What Newmark's method does to the acceleration of a contact point without mass."""

import numpy as np

from axlespan.bridges.spans import simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.simulate import simulate
from axlespan.vehicles.simple import sprung_mass
from axlespan.vehicles.train import Train

CROSSING = Crossing(
    simple_span(length=25.0, youngs_modulus=2.87e9, second_moment=2.9, mass_per_length=2303.0, elements=8),
    Train.of(sprung_mass(mass=5750.0, stiffness=1.595e6)),
    speed=30.0,
)


def wheel(method, time_step, coupling="direct"):
    """Acceleration of the wheel, and second differences of its displacement."""
    result = simulate(
        CROSSING, time_step=time_step, steps=round(0.8 / time_step), method=method, coupling=coupling
    )
    u = result.at("vehicle_displacement", "1.wheel1.z")
    differences = (u[2:] - 2.0 * u[1:-1] + u[:-2]) / time_step**2
    return result.at("vehicle_acceleration", "1.wheel1.z")[1:-1], differences


def test_newmark_lets_it_ring():
    """Nothing damps it, and it is the method's, not rounding: the equations by hand give the same."""
    direct, differences = wheel(Alpha(0.0), 1e-3)
    literal, _ = wheel(Alpha(0.0), 1e-3, "literal")
    assert np.abs(differences).max() < 0.5
    assert np.abs(direct).max() > 2.0
    assert np.abs(direct - literal).max() < 1e-5


def test_alpha_damps_it():
    """Then it is the second difference of the path, but for the kinks at both ends of the span."""
    acceleration, differences = wheel(Alpha(-0.1), 1e-3)
    assert np.median(np.abs(acceleration - differences)) < 0.01 * np.abs(differences).max()
    assert np.abs(acceleration - differences).max() < 0.1 * np.abs(differences).max()


def test_contact_force_and_body_are_untouched():
    """α = 0 and α = -0.1 agree there: the ringing has no force behind it."""
    newmark, damped = (
        simulate(CROSSING, time_step=1e-3, steps=800, method=Alpha(alpha)) for alpha in (0.0, -0.1)
    )
    force = newmark.contact_force - 5750.0 * 9.81
    assert np.abs(newmark.contact_force - damped.contact_force).max() < 2e-3 * np.abs(force).max()
    body = newmark.at("vehicle_displacement", "1.body.z")
    assert np.abs(body - damped.at("vehicle_displacement", "1.body.z")).max() < 2e-3 * np.abs(body).max()
