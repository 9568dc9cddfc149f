"""Modes of the simply supported beam against the differential equation and against sums done by hand."""

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.reference import ModalResponse, SimplySupportedBeam

BEAM = SimplySupportedBeam(length=25.0, bending_stiffness=2.87e9 * 2.90, mass_per_length=2303.0)


def test_the_first_frequency_is_the_published_one():
    # N12 prints 30.02 rad/s; 30.0201 is the closed form with four more digits
    assert BEAM.angular_frequencies(1)[0] == pytest.approx(30.0201, abs=5e-5)
    assert BEAM.critical_speed == pytest.approx(2.0 * 4.77785 * 25.0, rel=1e-5)


def test_modes_are_orthogonal_with_the_modal_mass():
    x = np.linspace(0.0, 25.0, 2001)
    phi = BEAM.shapes(x, 6)
    # the trapezoidal rule is exact for these products up to rounding
    gram = BEAM.mass_per_length * np.trapezoid(phi[:, :, None] * phi[:, None, :], x, axis=0)
    np.testing.assert_allclose(gram, BEAM.modal_mass * np.eye(6), atol=1e-9 * BEAM.modal_mass)


def test_slopes_and_curvatures_are_the_derivatives():
    x, h = np.linspace(1.0, 24.0, 12), 1e-4
    phi = [BEAM.shapes(x + s * h, 5) for s in (-1, 0, 1)]
    # central differences: error k^3 h^2 / 6 for the slope, rounding 1e-16 / h^2 for the curvature
    np.testing.assert_allclose(BEAM.slopes(x, 5), (phi[2] - phi[0]) / (2 * h), atol=1e-8)
    np.testing.assert_allclose(BEAM.curvatures(x, 5), (phi[2] - 2 * phi[1] + phi[0]) / h**2, atol=1e-6)


def test_frequencies_satisfy_the_beam_equation():
    waves, omega = BEAM.wave_numbers(4), BEAM.angular_frequencies(4)
    np.testing.assert_allclose(BEAM.bending_stiffness * waves**4, BEAM.mass_per_length * omega**2, rtol=1e-14)


def test_a_response_sums_the_modes_at_points_of_any_shape():
    q = np.array([[1.0, 0.5], [0.0, -2.0], [0.3, 0.0]])
    response = ModalResponse(BEAM, np.arange(3.0), q, 10.0 * q, 100.0 * q)
    points = np.array([[0.0, 6.25], [12.5, 25.0]])
    expected = q[:, 0, None, None] * np.sin(np.pi * points / 25.0)
    expected = expected + q[:, 1, None, None] * np.sin(2 * np.pi * points / 25.0)
    np.testing.assert_allclose(response.displacement_at(points), expected, atol=1e-14)
    np.testing.assert_allclose(response.velocity_at(points), 10 * expected, atol=1e-13)
    np.testing.assert_allclose(response.acceleration_at(points), 100 * expected, atol=1e-12)
    slope = q[:, 0] * np.pi / 25.0 + q[:, 1] * 2 * np.pi / 25.0
    np.testing.assert_allclose(response.slope_at(0.0), slope, atol=1e-14)
    # only the first mode bends at mid-span
    np.testing.assert_allclose(
        response.moment_at(12.5),
        -BEAM.bending_stiffness * (np.pi / 25.0) ** 2 * q[:, 0],
        rtol=1e-9,
        atol=1e-5,
    )


def test_points_off_the_beam_and_wrong_data_are_refused():
    response = ModalResponse(BEAM, np.zeros(1), np.zeros((1, 2)), np.zeros((1, 2)), np.zeros((1, 2)))
    with pytest.raises(InputError, match="must lie on the beam, 0 to 25 m"):
        response.displacement_at(25.1)
    with pytest.raises(InputError, match=r"length = 0.0: must be a positive number"):
        SimplySupportedBeam(length=0.0, bending_stiffness=1.0, mass_per_length=1.0)
    with pytest.raises(InputError, match="modes = 0: must be a whole number"):
        BEAM.angular_frequencies(0)
