"""Beam frequencies against tabulated roots, the determinant done by hand and a solid model's frequency."""

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.reference import euler_bernoulli_frequencies, euler_bernoulli_roots, timoshenko_frequencies

# roots as textbooks print them (Blevins, Formulas for natural frequency and mode shape, table 8-1)
TABLES = {
    "pinned-pinned": [np.pi, 2 * np.pi, 3 * np.pi],
    "fixed-free": [1.875104, 4.694091, 7.854757, 10.995541],
    "fixed-fixed": [4.730041, 7.853205, 10.995608],
    "free-free": [4.730041, 7.853205, 10.995608],
    "fixed-pinned": [3.926602, 7.068583, 10.210176],
}


@pytest.mark.parametrize("supports", TABLES)
def test_roots_are_the_tabulated_ones(supports):
    table = TABLES[supports]
    np.testing.assert_allclose(euler_bernoulli_roots(len(table), supports), table, atol=6e-7)  # six decimals


def test_high_roots_approach_odd_multiples_without_overflow():
    assert euler_bernoulli_roots(300, "fixed-fixed")[-1] == pytest.approx(300.5 * np.pi, rel=1e-15)
    assert euler_bernoulli_roots(300, "fixed-pinned")[-1] == pytest.approx(300.25 * np.pi, rel=1e-15)


def test_frequencies_scale_with_stiffness_and_mass():
    omega = euler_bernoulli_frequencies(2.0, 9.0, 4.0, 2, "fixed-free")
    np.testing.assert_allclose(omega, (np.array([1.875104, 4.694091]) / 2.0) ** 2 * 1.5, rtol=1e-6)


def test_timoshenko_frequencies_of_a_steel_bar():
    # L 10 m, 0.5 m x 1.0 m, E 210 GPa, nu 0.3, rho 7850, kappa 5/6: the exact quadratic, three decimals
    bar = {
        "length": 10.0,
        "bending_stiffness": 210e9 / 24,
        "shear_stiffness": 5 / 6 * 210e9 / 2.6 * 0.5,
        "mass_per_length": 7850 * 0.5,
        "rotary_inertia": 7850 / 24,
    }
    frequencies = timoshenko_frequencies(**bar, count=5) / (2 * np.pi)
    np.testing.assert_allclose(frequencies, [23.068, 88.152, 185.720, 305.751, 440.375], atol=5.1e-4)
    # and the 2 x 2 system for w = sin, psi = cos, solved as an eigenproblem
    k = 3 * np.pi / 10.0
    shear = bar["shear_stiffness"]
    stiffness = np.array([[shear * k**2, -shear * k], [-shear * k, shear + bar["bending_stiffness"] * k**2]])
    mass = np.diag([bar["mass_per_length"], bar["rotary_inertia"]])
    omega2 = np.linalg.eigvals(np.linalg.solve(mass, stiffness)).min()
    assert frequencies[2] == pytest.approx(np.sqrt(omega2) / (2 * np.pi), rel=1e-10)


def test_a_beam_stiff_in_shear_is_a_thin_beam():
    thick = timoshenko_frequencies(25.0, 8.323e9, 1e20, 2303.0, 1e-9, 5)
    # what is left: EI k^2 / kGA, 1e-9 at most
    np.testing.assert_allclose(thick, euler_bernoulli_frequencies(25.0, 8.323e9, 2303.0, 5), rtol=1e-8)


def test_the_solid_model_of_the_second_example_lies_near_the_timoshenko_beam():
    # N12's solid mesh, 2.2272 m x 2.5 m, vibrates at 29.59 rad/s; a beam theory with kappa = 5/6 gets
    # shear and rotary inertia nearly right: 29.56 rad/s
    area, inertia = 2.2272 * 2.5, 2.2272 * 2.5**3 / 12
    shear = 5 / 6 * 2.87e9 / 2.4 * area
    omega = timoshenko_frequencies(25.0, 2.87e9 * inertia, shear, 2303.0, 2303.0 * inertia / area, 1)[0]
    assert omega == pytest.approx(29.59, rel=2e-3)
    assert omega < 30.02 * 0.99


def test_unknown_supports_are_named():
    with pytest.raises(InputError, match="must be one of pinned-pinned, fixed-free"):
        euler_bernoulli_roots(1, "glued")
