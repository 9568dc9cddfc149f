"""Motions of supports: velocity and acceleration are the derivatives of the value."""

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.model.motions import Constant, FunctionMotion, HarmonicMotion, TableMotion

MOTIONS = {
    "constant": Constant(-0.02),
    "harmonic": HarmonicMotion(0.01, 1.7, 0.4),
    "table": TableMotion([0.0, 0.5, 0.9, 2.0], [0.0, 0.01, -0.004, 0.002]),
    "spline": TableMotion([0.0, 0.5, 0.9, 2.0], [0.0, 0.01, -0.004, 0.002], smooth=True),
    "function": FunctionMotion(lambda t: t**3, lambda t: 3.0 * t**2, lambda t: 6.0 * t),
}


@pytest.mark.parametrize("name", MOTIONS)
def test_derivatives(name):
    motion, h = MOTIONS[name], 1e-5
    t = np.array([-0.4, 0.13, 0.31, 0.62, 0.81, 1.3, 1.7, 2.6])
    rate = (motion.value(t + h) - motion.value(t - h)) / (2.0 * h)
    np.testing.assert_allclose(motion.velocity(t), rate, atol=1e-7)
    second = (motion.velocity(t + h) - motion.velocity(t - h)) / (2.0 * h)
    np.testing.assert_allclose(motion.acceleration(t), second, atol=1e-6)
    assert motion.value(t).shape == motion.velocity(t).shape == motion.acceleration(t).shape == (8,)


def test_a_table_goes_through_its_points_and_stays_at_its_ends():
    for name in ("table", "spline"):
        motion = MOTIONS[name]
        np.testing.assert_allclose(motion.value(motion.times), motion.values, atol=1e-15)
        np.testing.assert_allclose(motion.value(np.array([-1.0, 3.0])), [0.0, 0.002], atol=1e-15)
        np.testing.assert_array_equal(motion.velocity(np.array([-1.0, 3.0])), 0.0)
    np.testing.assert_allclose(MOTIONS["table"].value(np.array([0.25, 0.7])), [0.005, 0.003])
    np.testing.assert_allclose(MOTIONS["spline"].velocity(np.array([0.0, 2.0])), 0.0, atol=1e-15)


@pytest.mark.parametrize(
    ("times", "values", "rule"),
    [
        ([0.0], [1.0], "must be at least two pairs"),
        ([0.0, 1.0], [1.0], "must be at least two pairs"),
        ([0.0, 1.0], [1.0, float("nan")], "must be finite"),
        ([0.0, 2.0, 2.0], [0.0, 1.0, 2.0], r"motion = 2\.0: must have strictly increasing times"),
    ],
)
def test_table_errors(times, values, rule):
    with pytest.raises(InputError, match=rule):
        TableMotion(times, values)
