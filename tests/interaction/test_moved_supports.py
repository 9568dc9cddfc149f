"""Supports that move, in closed form: a rigid bridge on springs is an oscillator on a moving foot."""

import numpy as np
import pytest

from axlespan.bridges.spans import SupportAt, continuous_beam, simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.simulate import simulate
from axlespan.model.motions import Constant, HarmonicMotion, TableMotion
from axlespan.reference import SuspendedBody
from axlespan.vehicles.simple import axle_loads, sprung_mass
from axlespan.vehicles.train import Train

STIFFNESS, DAMPING = 2e6, 1e4  # of each bearing
BODY = SuspendedBody(mass=1e4, stiffness=2 * STIFFNESS, damping=2 * DAMPING)  # 20 rad/s, 5 %
FEATHER = Train.of(axle_loads(loads=1e-6))  # the load that a crossing needs


def rigid_bridge(motion):
    """10 m and 10 t, so stiff that it only heaves: its first bending mode has 10 000 rad/s."""
    bearing = {"fixed": (), "stiffness": {"z": STIFFNESS}, "damping": {"z": DAMPING}, "motion": {"z": motion}}
    return simple_span(
        length=10.0,
        youngs_modulus=1e13,
        second_moment=1.0,
        mass_per_length=1e3,
        elements=1,
        supports=[SupportAt(0.0, name="a", **bearing), SupportAt(10.0, name="b", **bearing)],
    )


def run(motion, method, time_step=1e-3, steps=1000):
    crossing = Crossing(rigid_bridge(motion), FEATHER, speed=1.0)
    return simulate(crossing, time_step=time_step, steps=steps, method=method, sensors={"m": 5.0, "e": 0.0})


def check(result, exact, acceleration_tolerance):
    """Displacement, velocity, acceleration and reactions of the oscillator."""
    for quantity, wanted in (
        ("sensor_displacement", exact.displacement),
        ("sensor_velocity", exact.velocity),
    ):
        for sensor in ("m", "e"):
            difference = np.abs(result.at(quantity, sensor) - wanted)
            assert difference.max() < 1e-3 * np.abs(wanted).max(), quantity
    force = exact.acceleration * BODY.mass
    limit = acceleration_tolerance * np.abs(force).max()
    assert np.abs(result.support_reaction.sum(axis=1) - force).max() < limit
    np.testing.assert_allclose(
        result.at("support_reaction", "a.z"), result.at("support_reaction", "b.z"), atol=1e-3
    )


@pytest.mark.parametrize("method", [Alpha(0.0), Alpha(-0.1)])
@pytest.mark.parametrize("frequency", [1.5, 3.1, 6.0])  # below, near and above resonance at 3.18 Hz
def test_a_harmonic_base(method, frequency):
    """The foot moves off at full speed under a body at rest: the dashpots pull at once."""
    result = run(HarmonicMotion(5e-3, frequency), method)
    exact = BODY.over_harmonic(5e-3, 2 * np.pi * frequency, result.time)
    check(result, exact, 2e-3)


@pytest.mark.parametrize("method", [Alpha(0.0), Alpha(-0.1)])
def test_a_settlement_that_takes_its_time(method):
    """Two centimeters within 0.2 s at constant speed; the kinks of the table lie on time steps."""
    result = run(TableMotion([0.0, 0.2], [0.0, -0.02]), method)
    exact = BODY.over_ramp(-0.02, 0.2, result.time + 1e-12)  # just after the kink at 0.2 s
    check(result, exact, 6e-2)  # the dashpots' force jumps with the speed: a step's worth
    assert result.at("sensor_displacement", "m")[-1] == pytest.approx(-0.02, rel=0.5)


def test_a_settlement_at_the_start_is_static():
    motion = Constant(-0.02)
    result = run(motion, Alpha(0.0), steps=100)
    np.testing.assert_allclose(result.sensor_displacement, -0.02, rtol=1e-9)
    np.testing.assert_allclose(result.support_reaction.sum(axis=1), 1e-6, atol=1e-4)


def test_a_settled_support_of_a_continuous_beam():
    """R = 6 EI δ / L³ of two equal spans, before the train comes; with it, the weight on top."""
    bridge = continuous_beam(
        spans=[10.0, 10.0],
        youngs_modulus=2.87e9,
        second_moment=2.9,
        mass_per_length=2303.0,
        elements=4,
        supports=[SupportAt(0.0), SupportAt(10.0, fixed=(), motion={"z": Constant(-0.01)}), SupportAt(20.0)],
    )
    vehicle = sprung_mass(mass=5750.0, stiffness=1.595e6)
    sensors = {"support": 10.0, "span": 4.0}
    crossing = Crossing(bridge, Train.of(vehicle), speed=20.0, start=-5.0)
    result = simulate(crossing, time_step=1e-3, steps=1500, sensors=sensors)
    pull = 6.0 * 2.87e9 * 2.9 * 0.01 / 10.0**3
    np.testing.assert_allclose(
        result.support_reaction[:250], np.tile([0.5 * pull, -pull, 0.5 * pull], (250, 1)), rtol=1e-8
    )
    np.testing.assert_allclose(result.at("sensor_displacement", "support"), -0.01, rtol=1e-12)
    # Deflection of half of it, a propped beam whose prop goes down: δ (3 x L² - x³) / 2 L³ from the outer end.
    x = 4.0
    shape = -0.01 * (3 * x * 10.0**2 - x**3) / (2 * 10.0**3)
    assert result.at("sensor_displacement", "span")[0] == pytest.approx(shape, rel=1e-9)
    # The wheel follows the settled line: at the support it is 10 mm down.
    at_support = np.argmin(np.abs(result.contact_position[:, 0] - 10.0))
    assert result.at("vehicle_displacement", "1.wheel1.z")[at_support] == pytest.approx(-0.01, rel=1e-6)


def test_a_whole_bridge_that_is_moved():
    """All supports sink alike and slowly: the bridge goes with them, without a reaction to speak of."""
    settle = TableMotion([0.0, 2.0], [0.0, -0.01], smooth=True)
    moved = {"fixed": (), "motion": {"z": settle}}
    bridge = simple_span(
        length=10.0,
        youngs_modulus=2.87e10,
        second_moment=2.9,
        mass_per_length=2303.0,
        elements=2,
        supports=[SupportAt(0.0, **moved), SupportAt(10.0, **moved)],
    )
    sensors = {str(x): x for x in (0.0, 1.0, 5.0, 9.9, 10.0)}
    result = simulate(Crossing(bridge, FEATHER, speed=1.0), time_step=2e-3, steps=1200, sensors=sensors)
    wanted = settle.value(result.time)
    inertia = 2303.0 * 10.0**4 * 5 / 384 / (2.87e10 * 2.9) * 0.015  # sag under the base's acceleration
    np.testing.assert_allclose(result.sensor_displacement, np.tile(wanted[:, None], (1, 5)), atol=3 * inertia)
    rate = settle.velocity(result.time)
    np.testing.assert_allclose(result.at("sensor_velocity", "0.0"), rate, atol=1e-12)
    np.testing.assert_allclose(result.at("sensor_velocity", "1.0"), rate, atol=1e-4)
    np.testing.assert_allclose(
        result.at("sensor_acceleration", "10.0"), settle.acceleration(result.time), atol=1e-12
    )
