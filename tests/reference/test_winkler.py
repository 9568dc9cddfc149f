"""The Winkler beam against printed numbers, its differential equation and a Fourier integral."""

import numpy as np
import pytest
from scipy.integrate import quad

from axlespan.errors import InputError
from axlespan.reference import WinklerBeam

RAIL = WinklerBeam(bending_stiffness=210e9 * 3.0383e-5, foundation_modulus=50e6, mass_per_length=60.21)
FORCE = 85e3


def test_the_rail_of_a_textbook_check():
    # 60E1 on 50 MN/m2 under 85 kN; the digits given
    assert RAIL.characteristic == pytest.approx(1.18308, abs=5e-6)
    assert RAIL.static_deflection(FORCE) == pytest.approx(1.00562e-3, abs=5e-9)
    assert RAIL.static_moment(FORCE) == pytest.approx(17.9616e3, abs=0.05)
    assert RAIL.critical_speed == pytest.approx(770.26, abs=5e-3)


@pytest.mark.parametrize("part", [0.0, 0.5, 0.9])
def test_the_depth_grows_with_the_speed(part):
    speed = part * RAIL.critical_speed
    depth = RAIL.static_deflection(FORCE) / np.sqrt(1.0 - part**2)
    assert RAIL.deflection(0.0, FORCE, speed) == pytest.approx(-depth, rel=1e-14)


@pytest.mark.parametrize("speed", [0.0, 300.0, 700.0])
def test_deflection_is_the_fourier_integral(speed):
    # w(x) = -P / pi  integral of cos(s x) / (EI s^4 - m v^2 s^2 + k) over s > 0
    def spectrum(s):
        inertia = RAIL.mass_per_length * speed**2
        return 1.0 / (RAIL.bending_stiffness * s**4 - inertia * s**2 + RAIL.foundation_modulus)

    for x in (0.0, 0.4, 1.7, 3.0):
        integral = quad(lambda s: np.cos(s * x) * spectrum(s), 0.0, 200.0, limit=800, epsabs=1e-16)[0]  # noqa: B023
        # the tail beyond 200 rad/m is 1 / (3 EI 200^3), below 1e-11 m here
        assert RAIL.deflection(x, FORCE, speed) == pytest.approx(-FORCE / np.pi * integral, abs=2e-10)


@pytest.mark.parametrize("speed", [0.0, 500.0])
def test_moment_is_the_second_derivative_and_carries_the_force(speed):
    x, h = np.array([0.3, 1.0, 2.2]), 1e-4
    w = [RAIL.deflection(x + s * h, FORCE, speed) for s in (-1, 0, 1)]
    second = RAIL.bending_stiffness * (w[2] - 2 * w[1] + w[0]) / h**2
    # differences of 1e-3 m lose digits: 1e-19 / 1e-8 * EI = 1e-4 Nm at best, some Nm with rounding
    np.testing.assert_allclose(RAIL.moment(x, FORCE, speed), second, atol=2.0)
    # the shear force jumps by P under the force
    shear = (RAIL.moment(1e-6, FORCE, speed) - RAIL.moment(0.0, FORCE, speed)) / 1e-6
    assert shear == pytest.approx(-FORCE / 2.0, rel=1e-5)
    assert RAIL.moment(0.0, FORCE) == pytest.approx(RAIL.static_moment(FORCE), rel=1e-13)


def test_above_the_critical_speed_there_is_no_answer():
    with pytest.raises(InputError, match="must stay below the critical speed"):
        RAIL.deflection(0.0, FORCE, 800.0)
