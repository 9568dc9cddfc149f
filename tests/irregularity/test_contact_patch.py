"""The mean over a tyre's contact patch."""

from __future__ import annotations

import numpy as np
import pytest

from axlespan import irregularity as ir

X = np.random.default_rng(9).uniform(-6.0, 12.0, 300)
PATCH = 0.24

INNER = {
    "harmonic, bounded": ir.Harmonic(1e-3, 0.9, 0.7, -3.0, 11.0),
    "table": ir.Table([-2.0, 1.0, 4.0, 4.001], [5e-3, 2e-3, -1e-3, 0.0]),
    "pothole": ir.Pothole(5.0, 0.05, 1.0, 0.05),
    "joint": ir.DippedJoint(4.0, 0.01, 3.0),
    "half-sine": ir.Bump(4.0, 0.01, 3.0, "half-sine"),
    "ramp": ir.Ramp(0.0, 3.0, 0.01),
    "settlement": ir.SettlementDip(3.0, 0.02, 1.0),
    "squat": ir.Squat(3.0, 0.02, 2.0),
    "realization": ir.realize("iso8608-c", 30.0, seed=4, wavelengths=(0.1, 20.0)),
    "spline": ir.Spline([-2.0, 1.0, 4.0, 9.0], [0.0, 2e-3, -1e-3, 0.0]),
    "cut": ir.Bounded(ir.Harmonic(1e-3, 0.9, 0.7), 0.3, 7.0),
    "sum": ir.Sum((ir.Scaled(ir.Ramp(0.0, 3.0, 0.01), -2.0), ir.Shifted(ir.Bump(1.0, 0.02, 0.5), 2.0))),
    "tapered": ir.Bounded(ir.realize("iso8608-c", 30.0, seed=4, wavelengths=(0.3, 20.0)), -2.0, 9.0, 3.0),
}


@pytest.mark.parametrize("name", INNER)
def test_value_is_the_mean_over_the_patch(name):
    inner = INNER[name]
    got = ir.FiniteContact(inner, PATCH).value(X)
    # A plain mean of 4000 midpoints meets a step within 1/4000 of it.
    offsets = PATCH * ((np.arange(4000) + 0.5) / 4000 - 0.5)
    expected = np.array([inner.value(x + offsets).mean() for x in X])
    np.testing.assert_allclose(got, expected, atol=3e-4 * np.abs(inner.value(X)).max())


def test_harmonic_is_damped_by_the_sinc():
    profile = ir.Harmonic(1e-3, 1.2, 0.3)
    damped = ir.FiniteContact(profile, PATCH)
    factor = np.sin(np.pi * PATCH / 1.2) / (np.pi * PATCH / 1.2)
    np.testing.assert_allclose(damped.value(X), factor * profile.value(X), atol=1e-16)
    np.testing.assert_allclose(damped.slope(X), factor * profile.slope(X), atol=1e-15)
    np.testing.assert_allclose(damped.curvature(X), factor * profile.curvature(X), atol=1e-13)


def test_gauss_points_agree_with_the_antiderivative():
    # A tapered bound hides the antiderivative; far from the taper both ways give the same mean.
    inner = ir.realize("iso8608-c", 30.0, seed=4, wavelengths=(0.1, 20.0))
    hidden = ir.FiniteContact(ir.Bounded(inner, -50.0, 50.0, taper=5.0), PATCH)
    np.testing.assert_allclose(hidden.value(X), ir.FiniteContact(inner, PATCH).value(X), atol=1e-9 * 1e-2)


def test_step_becomes_a_ramp():
    step = ir.Table([0.0, 1e-12, 50.0], [0.0, 0.01, 0.01])
    felt = ir.FiniteContact(step, 0.2)
    np.testing.assert_allclose(
        felt.value([-0.1, -0.05, 0.0, 0.05, 0.1]), [0.0, 0.0025, 0.005, 0.0075, 0.01], atol=1e-12
    )
    np.testing.assert_allclose(felt.slope([-0.2, 0.0, 0.2]), [0.0, 0.05, 0.0], atol=1e-12)
