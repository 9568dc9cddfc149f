"""Crossings against the semi-analytical and closed-form solutions."""

import numpy as np
import pytest

from axlespan.bridges.spans import simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.simulate import simulate
from axlespan.irregularity import Harmonic
from axlespan.model.damping import Rayleigh
from axlespan.reference import (
    Motion,
    WheelUnit,
    cross_forces,
    cross_sprung_masses_newmark,
    cross_wheel_units,
    harmonic,
    neves2012,
    point_load_deflection,
)
from axlespan.vehicles.simple import axle_loads, rigid_mass, sprung_mass
from axlespan.vehicles.train import Train

SPAN = {"length": 25.0, "youngs_modulus": 2.87e9, "second_moment": 2.9, "mass_per_length": 2303.0}
BEAM = neves2012.BEAM
BRIDGE = simple_span(elements=50, **SPAN)
MASS = sprung_mass(mass=5750.0, stiffness=1.595e6)
MIDSPAN = {"midspan": 12.5}


def error(computed, exact):
    """Largest difference relative to the peak."""
    return np.abs(computed - exact).max() / np.abs(exact).max()


class TestNeves2012:
    def test_example_3_1(self):
        """A sprung mass at 100 km/h; twenty modes, the same Newmark steps. Peaks from the literature's setup."""
        reference = neves2012.single_mass()
        crossing = Crossing(BRIDGE, Train.of(MASS), speed=100.0 / 3.6)
        result = simulate(crossing, time_step=1e-3, steps=900, method=Alpha(0.0, 0.25, 0.5), sensors=MIDSPAN)
        middle = result.at("sensor_displacement", "midspan")
        body = result.at("vehicle_displacement", "1.body.z")
        assert error(middle, reference.beam.displacement_at(12.5)) < 1e-4
        assert error(body, reference.body_displacement[:, 0]) < 1e-4
        acceleration = result.at("vehicle_acceleration", "1.body.z")
        assert error(acceleration, reference.body_acceleration[:, 0]) < 5e-4
        assert error(result.contact_force, reference.contact_force) < 1e-5
        np.testing.assert_allclose([middle.min(), middle.max()], [-2.4069e-3, 0.1643e-3], atol=5e-8)
        np.testing.assert_allclose([body.min(), body.max()], [-2.5899e-3, 0.4986e-3], atol=1e-7)
        np.testing.assert_allclose([acceleration.min(), acceleration.max()], [-0.1421, 0.1480], atol=1e-4)

    def test_example_3_2_shortened(self):
        """Ten sprung masses 3 m apart at 47.7 km/h over an irregularity."""
        motion, steps = Motion.spaced(47.7 / 3.6, 10, 3.0), 3200
        reference = cross_sprung_masses_newmark(
            BEAM, [neves2012.MASS] * 10, motion, 1e-3, steps, profile=neves2012.IRREGULARITY
        )
        irregularity = Harmonic(amplitude=0.5e-3, wavelength=5.0, start=0.0, stop=25.0)
        crossing = Crossing(BRIDGE, Train.of(MASS, 10, 3.0), speed=47.7 / 3.6, irregularity=irregularity)
        result = simulate(crossing, time_step=1e-3, steps=steps, sensors=MIDSPAN)
        assert error(result.at("sensor_displacement", "midspan"), reference.beam.displacement_at(12.5)) < 2e-5
        bodies = [result.vehicle_dof.index(f"{i + 1}.body.z") for i in range(10)]
        assert error(result.vehicle_displacement[:, bodies], reference.body_displacement) < 5e-5
        assert error(result.vehicle_acceleration[:, bodies], reference.body_acceleration) < 2e-4
        assert error(result.contact_force, reference.contact_force) < 2e-5
        np.testing.assert_allclose(result.contact_position, reference.position, atol=1e-9)


def test_moving_forces():
    """Two forces in closed form; 0.25 ms resolves the second mode, whose period error counts here."""
    loads, positions = [6e4, 8e4], (0.0, 4.0)
    time = 2.5e-4 * np.arange(4001)
    exact = cross_forces(BEAM, loads, Motion(30.0, positions), time)
    train = Train.of(axle_loads(loads=loads, positions=positions))
    sensors = {"midspan": 12.5, "fifth": 5.0}
    result = simulate(Crossing(BRIDGE, train, speed=30.0), time_step=2.5e-4, steps=4000, sensors=sensors)
    assert error(result.at("sensor_displacement", "midspan"), exact.displacement_at(12.5)) < 1e-4
    assert error(result.at("sensor_displacement", "fifth"), exact.displacement_at(5.0)) < 2e-4
    np.testing.assert_array_equal(result.contact_force, np.tile(loads, (4001, 1)))


def test_a_slow_force_is_a_static_one():
    """At 0.1 m/s the deflection is the influence line; the step resolves no mode, so α = -0.3."""
    train = Train.of(axle_loads(loads=5e4))
    result = simulate(
        Crossing(BRIDGE, train, speed=0.1, start=5.0),
        time_step=0.5,
        steps=200,
        method=Alpha(-0.3),
        sensors=MIDSPAN,
    )
    exact = point_load_deflection(
        12.5, force=5e4, at=5.0 + 0.1 * result.time, length=25.0, bending_stiffness=2.87e9 * 2.9
    )
    assert error(result.at("sensor_displacement", "midspan"), exact) < 2e-4


def moving_mass(ratio, speed_parameter, start):
    """Mid-span displacement of the run and of the reference for T/1000 steps, from the entry on."""
    mass, speed = ratio * 2303.0 * 25.0, speed_parameter * BEAM.critical_speed
    step = 25.0 / speed / 1000
    before = round(start / (speed * step))  # steps until the entry, negative
    exact = cross_wheel_units(
        BEAM, [WheelUnit.rigid_mass(mass)], Motion(speed), step * np.arange(1001), modes=40, max_step=2 * step
    )
    crossing = Crossing(BRIDGE, Train.of(rigid_mass(mass=mass)), speed=speed, start=before * speed * step)
    result = simulate(crossing, time_step=step, steps=1000 - before, sensors=MIDSPAN)
    return result.sensor_displacement[-1001:, 0], exact.beam.displacement_at(12.5)


@pytest.mark.parametrize("speed_parameter", [0.25, 0.5, 0.75])
@pytest.mark.parametrize("ratio", [0.25, 0.5, 1.0])
@pytest.mark.parametrize("start", [0.0, -1.0])
def test_a_moving_mass(ratio, speed_parameter, start):
    """A quarter to all of the beam's mass, up to three quarters of the critical speed, by the defaults."""
    assert error(*moving_mass(ratio, speed_parameter, start)) < (0.005 if start == 0.0 else 0.001)


def test_wheels_with_mass():
    """Two units over an irregularity by the defaults: the contact force 50 ms after each entry until the first exit."""
    time = 1e-3 * np.arange(1501)
    unit = WheelUnit(500.0, 5750.0, 1.595e6, 20e3)
    exact = cross_wheel_units(
        BEAM,
        [unit] * 2,
        Motion.spaced(20.0, 2, 3.0),
        time,
        modes=60,
        profile=harmonic(0.1e-3, 4.0),
        max_step=2e-3,
    )
    vehicle = sprung_mass(mass=5750.0, stiffness=1.595e6, damping=20e3, unsprung_mass=500.0)
    crossing = Crossing(
        BRIDGE, Train.of(vehicle, 2, 3.0), speed=20.0, irregularity=Harmonic(amplitude=0.1e-3, wavelength=4.0)
    )
    coarse = simulate(crossing, time_step=1e-3, steps=1500)
    fine = simulate(crossing, time_step=5e-4, steps=3000)
    for force in (coarse.contact_force, fine.contact_force[::2]):
        for wheel, entry in enumerate((0.0, 0.15)):
            during = (time >= entry + 0.05) & (time < 1.25)
            worst = np.abs(force - exact.contact_force)[during, wheel].max()
            assert worst < 0.003 * 6250.0 * 9.81
    assert fine.contact_force.max() == pytest.approx(coarse.contact_force.max(), rel=0.02)
    assert coarse.facts["alpha"] == -0.1
    assert coarse.facts["footprint"] == pytest.approx(0.5)


@pytest.mark.parametrize("method", [Alpha(0.0), Alpha(-0.1)])
def test_second_order_in_time(method):
    """Halving the step divides the change by four: displacements, contact force and body acceleration.

    Damping in proportion to stiffness takes the modes away that no step resolves; undamped, their phases
    hide the order. The acceleration of α < 0 is that of t + αΔt and left out.
    """
    crossing = Crossing(
        simple_span(elements=10, damping=Rayleigh(0.0, 1e-3), **SPAN),
        Train.of(MASS),
        speed=25.0,
        start=-1.0,
        irregularity=Harmonic(amplitude=1e-3, wavelength=8.0, start=-8.0),
    )
    runs = [
        simulate(crossing, time_step=0.9 / n, steps=n, method=method, sensors=MIDSPAN)
        for n in (450, 900, 1800)
    ]
    quantities = [
        ("sensor_displacement", "midspan"),
        ("vehicle_displacement", "1.body.z"),
        ("contact_force", "1.1"),
    ]
    if method.alpha == 0.0:
        quantities.append(("vehicle_acceleration", "1.body.z"))
    for quantity, name in quantities:
        a, b, c = (run.at(quantity, name)[:: 2**i] for i, run in enumerate(runs))
        assert np.log2(np.abs(a - b).max() / np.abs(b - c).max()) == pytest.approx(2.0, abs=0.01), quantity
