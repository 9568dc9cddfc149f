"""Speed histories against quadrature and kinematics."""

import numpy as np
import pytest

from axlespan.contact.motion import SpeedHistory
from axlespan.errors import InputError

HISTORY = SpeedHistory.through([[0.5, 20.0], [2.0, 26.0], [2.75, 26.0], [6.0, 0.0], [8.0, 4.0]])


def quadrature(history, time):
    """∫ v dt from 0, by the trapezoidal rule on a grid that holds the corners."""
    t = np.unique(np.concatenate([np.linspace(0.0, time, 4001), history.times[history.times < time]]))
    return np.trapezoid(history.speed(t), t)


@pytest.mark.parametrize("time", [0.0, 0.2, 0.5, 1.1, 2.0, 2.5, 4.0, 6.0, 7.9, 8.0, 12.0])
def test_distance_is_the_integral_of_the_speed(time):
    assert HISTORY.distance(np.array(time)) == pytest.approx(quadrature(HISTORY, time), rel=1e-12, abs=1e-12)


def test_a_history_may_begin_before_time_zero():
    history = SpeedHistory.through([[-2.0, 10.0], [2.0, 30.0]])
    np.testing.assert_allclose(history.distance(np.array([0.0, 1.0, 3.0])), [0.0, 22.5, 50.0 + 30.0])
    later = SpeedHistory.through([[5.0, 10.0], [6.0, 30.0]])
    np.testing.assert_allclose(later.distance(np.array([1.0, 5.0, 6.0])), [10.0, 50.0, 70.0])


def test_speed_and_acceleration():
    t = np.array([0.0, 0.5, 1.25, 2.0, 2.5, 2.75, 5.0, 6.0, 8.0, 9.0])
    np.testing.assert_allclose(HISTORY.speed(t), [20, 20, 23, 26, 26, 26, 8, 0, 4, 4])
    # At a corner the acceleration is that of the piece that begins there.
    np.testing.assert_allclose(HISTORY.acceleration(t), [0, 4, 4, 0, 0, -8, -8, 2, 0, 0])


def test_acceleration_is_the_slope_of_the_speed():
    t, h = np.array([0.3, 0.9, 2.4, 3.3, 6.6, 9.0]), 1e-6
    slope = (HISTORY.speed(t + h) - HISTORY.speed(t - h)) / (2 * h)
    np.testing.assert_allclose(HISTORY.acceleration(t), slope, atol=1e-6)


def test_braking_to_a_stop():
    """From v with deceleration b: v² / 2b, and no step further."""
    history = SpeedHistory.through([[1.0, 30.0], [7.0, 0.0]])
    np.testing.assert_allclose(
        history.distance(np.array([1.0, 7.0, 7.5, 100.0])), [30.0, 120.0, 120.0, 120.0]
    )


def test_constant_speed():
    history = SpeedHistory.constant(25.0)
    np.testing.assert_allclose(history.distance(np.array([[0.0, 2.0], [4.0, 0.1]])), [[0, 50], [100, 2.5]])
    np.testing.assert_array_equal(history.acceleration(np.array([0.0, 1.0])), 0.0)
    assert SpeedHistory.constant(0.0).distance(np.array(9.0)) == 0.0


@pytest.mark.parametrize(
    ("points", "rule"),
    [
        ([], "must be pairs of time and speed"),
        ([[0.0, 1.0, 2.0]], "must be pairs of time and speed"),
        ([[0.0, float("nan")]], "must be finite"),
        ([[0.0, 1.0], [0.0, 2.0]], r"speed_history\.1 = \[0\.0, 2\.0\]: must have increasing times"),
        ([[0.0, 1.0], [1.0, -2.0]], r"speed_history\.1 = \[1\.0, -2\.0\]: must have speeds of zero or more"),
    ],
)
def test_errors(points, rule):
    with pytest.raises(InputError, match=rule):
        SpeedHistory.through(points)


@pytest.mark.parametrize("speed", [-1.0, float("nan"), float("inf")])
def test_constant_errors(speed):
    with pytest.raises(InputError, match="must be zero or positive"):
        SpeedHistory.constant(speed)
