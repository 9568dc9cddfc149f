"""Where wheels are, and what lies under them."""

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.reference import Motion, Profile, WheelUnit, harmonic, level
from axlespan.reference.wheel_unit import UnitTable


def test_times_at_a_place_invert_the_position():
    for acceleration in (0.0, 1e-12, 1.5, -0.8):
        motion = Motion(20.0, offsets=(0.0, 3.0, 17.5), acceleration=acceleration, start=-2.0)
        for x in (0.0, 25.0, 60.0):
            times = motion.times_at(x)
            np.testing.assert_allclose(np.diag(motion.position(times)), x, atol=1e-11)
        assert motion.speed_at(2.0) == pytest.approx(20.0 + 2.0 * acceleration)


def test_a_wheel_that_stops_short_never_arrives():
    motion = Motion(10.0, offsets=(0.0, 30.0), acceleration=-1.0)  # stops after 50 m
    assert motion.times_at(40.0)[0] == pytest.approx(10.0 - np.sqrt(20.0))
    assert np.isnan(motion.times_at(40.0)[1])
    motion.require_forward(9.9)
    with pytest.raises(InputError, match="must keep the wheels moving forward"):
        motion.require_forward(10.0)


def test_harmonic_derivatives_and_bounds():
    r = harmonic(2e-3, 5.0, start=0.0, end=12.5, phase=0.3)
    x, h = np.linspace(0.5, 12.0, 24), 1e-4
    values = [r.height(x + s * h) for s in (-1, 0, 1)]
    # truncation k^3 h^2 / 6 and k^4 h^2 / 12 times the amplitude
    np.testing.assert_allclose(r.derivative(1, x), (values[2] - values[0]) / (2 * h), atol=1e-11)
    np.testing.assert_allclose(r.derivative(2, x), (values[2] - 2 * values[1] + values[0]) / h**2, atol=1e-9)
    outside = np.array([-0.1, 12.6, 40.0])
    for order in range(3):
        assert not r.derivative(order, outside).any()
        assert not level().derivative(order, x).any()
    assert r.kinks == (0.0, 12.5)
    assert harmonic(1e-3, 5.0).kinks == ()


def test_profiles_that_wheels_cannot_follow_are_refused():
    with pytest.raises(InputError, match="must not jump under a dashpot or a wheel with mass"):
        harmonic(1e-3, 5.0, start=1.0, end=25.0).require_continuous()
    harmonic(1e-3, 5.0, start=0.0, end=25.0).require_continuous()
    with pytest.raises(InputError, match=r"profile.slope = None: must give the slope"):
        Profile(np.sin).derivative(1, np.zeros(1))
    with pytest.raises(InputError, match="must lie before the end"):
        harmonic(1e-3, 5.0, start=3.0, end=3.0)


def test_units_know_what_they_need():
    assert UnitTable.of([WheelUnit.sprung_mass(1.0, 1.0)]).profile_derivatives == 0
    assert UnitTable.of([WheelUnit.sprung_mass(1.0, 1.0, 1.0)]).profile_derivatives == 1
    assert UnitTable.of([WheelUnit.sprung_mass(1.0, 1.0), WheelUnit.rigid_mass(2.0)]).profile_derivatives == 2
    assert WheelUnit(500.0, 5750.0, 1e6).mass == 6250.0
    for wrong, rule in (
        ({"wheel_mass": 0.0}, "must have some mass"),
        ({"wheel_mass": 1.0, "stiffness": 5.0}, "must be positive where there is a spring"),
        ({"wheel_mass": 1.0, "body_mass": 5.0}, "stiffness = 0.0: must be a positive number"),
        ({"wheel_mass": -1.0}, "must not be negative"),
    ):
        with pytest.raises(InputError, match=rule):
            WheelUnit(**wrong)
    with pytest.raises(InputError, match="must name one unit at least"):
        UnitTable.of([])
