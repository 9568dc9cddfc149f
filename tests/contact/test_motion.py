"""Speed histories against quadrature and kinematics."""

import numpy as np
import pytest

from axlespan.contact.motion import Course, SpeedHistory
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


# --- accelerations -----------------------------------------------------------------------------------


def test_accelerating_until_a_speed():
    """s = v t + a t²/2 until (v₁ - v)/a, then v₁."""
    history = SpeedHistory.accelerating(10.0, 0.5, 20.0)
    t = np.array([-1.0, 0.0, 8.0, 20.0, 30.0])
    np.testing.assert_allclose(history.distance(t), [-10.0, 0.0, 96.0, 300.0, 500.0])
    np.testing.assert_allclose(history.speed(t), [10.0, 10.0, 14.0, 20.0, 20.0])
    np.testing.assert_allclose(history.acceleration(t), [0.0, 0.5, 0.5, 0.0, 0.0])


def test_accelerating_without_end():
    history = SpeedHistory.accelerating(10.0, 2.0)
    t = np.array([-3.0, 0.0, 5.0, 50.0])
    np.testing.assert_allclose(history.distance(t), [-30.0, 0.0, 75.0, 3000.0])
    np.testing.assert_allclose(history.speed(t), [10.0, 10.0, 20.0, 110.0])
    np.testing.assert_allclose(history.acceleration(t), [0.0, 2.0, 2.0, 2.0])
    assert (history.largest(5.0), SpeedHistory.constant(3.0).largest(9.0)) == (20.0, 3.0)


def test_braking_ends_where_the_train_stands():
    """v² / 2b, reached at v / b, and no step further."""
    history = SpeedHistory.accelerating(30.0, -1.2)
    stop = 30.0**2 / 2.4
    np.testing.assert_allclose(history.distance(np.array([25.0, 26.0, 1e4])), stop, rtol=1e-14)
    np.testing.assert_array_equal(history.speed(np.array([25.0, 1e4])), 0.0)
    assert history.largest(100.0) == 30.0


@pytest.mark.parametrize(
    ("arguments", "rule"),
    [
        ((10.0, 0.0), r"acceleration = 0\.0: must be finite and not zero"),
        ((10.0, float("nan")), "acceleration = nan: must be finite"),
        ((10.0, 0.5, 5.0), r"to_speed = 5\.0: must be more than the speed that the train has, 10 m/s"),
        ((10.0, -0.5, 15.0), r"to_speed = 15\.0: must be less"),
        ((10.0, -0.5, -1.0), r"to_speed = -1\.0: must be zero or positive"),
        ((-10.0, 0.5), r"speed = -10\.0: must be zero or positive"),
    ],
)
def test_accelerations_that_are_wrong(arguments, rule):
    with pytest.raises(InputError, match=rule):
        SpeedHistory.accelerating(*arguments)


@pytest.mark.parametrize("direction", [1, -1])
def test_a_course_has_a_direction_and_a_delay(direction):
    course = Course(HISTORY, start=7.0, direction=direction, delay=1.5)
    t = np.array([0.0, 1.5, 2.4, 5.0, 30.0])
    np.testing.assert_allclose(course.head(t), 7.0 + direction * HISTORY.distance(t - 1.5))
    assert course.head(np.array(1.5)) == 7.0
    assert course.head(np.array(0.0)) == 7.0 - direction * 30.0  # at its first speed until then
    h = 1e-6
    slope = (course.head(t + h) - course.head(t - h)) / (2.0 * h)
    np.testing.assert_allclose(course.velocity(t), slope, atol=1e-5)
    np.testing.assert_allclose(course.acceleration(t), direction * HISTORY.acceleration(t - 1.5))
    assert course.largest_speed(4.0) == 26.0
