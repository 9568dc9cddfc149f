"""Contact rows of a train on two lines, one of them over a support that moves."""

import numpy as np

from axlespan.contact.motion import Course, SpeedHistory
from axlespan.contact.rows import TrainRows, WheelPath, Wheels
from axlespan.irregularity import Harmonic, Smooth
from axlespan.running.path import PolynomialPath

# Two linear elements with nodes at 0, 2, 5 and d.o.f. 0, 1, 2; and one from 1 to 4 with d.o.f. 3, 4.
LONG = PolynomialPath(
    np.array([0.0, 2.0, 5.0]), np.array([[0, 1], [1, 2]]), np.array([[[1.0, -1.0], [0.0, 1.0]]] * 2)
)
SHORT = PolynomialPath(
    np.array([1.0, 4.0]),
    np.array([[3, 4, 4]]),
    np.array([[[1.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]]]),
)
WAVE = Harmonic(amplitude=2e-3, wavelength=3.0)
ROWS = TrainRows(
    (Wheels(Course(SpeedHistory.through([[0.0, 2.0], [1.0, 4.0]]), 0.5), np.array([0.0, 1.0, 1.0, 6.0])),),
    paths=(
        # Free d.o.f. 0, 2 → 0, 1 on the long line; its d.o.f. 1 is prescribed number 0.
        WheelPath(
            np.array([0, 3]),
            LONG.renumbered(np.array([0, -1, 1, -1, -1])),
            LONG.renumbered(np.array([-1, 0, -1, -1, -1])),
            WAVE,
        ),
        WheelPath(np.array([1, 2]), SHORT.renumbered(np.array([-1, -1, -1, 2, 3])), None, Smooth()),
    ),
)
TIMES = np.array([0.0, 0.5, 1.0, 1.5])
HEAD = 0.5 + np.array([0.0, 1.25, 3.0, 5.0])


def dense(dofs, weights, n):
    result = np.zeros((*dofs.shape[:2], n))
    for t in range(dofs.shape[0]):
        for w in range(dofs.shape[1]):
            np.add.at(result[t, w], dofs[t, w], weights[t, w])
    return result


def test_positions():
    np.testing.assert_allclose(ROWS.positions(TIMES), HEAD[:, None] - [0.0, 1.0, 1.0, 6.0])
    assert ROWS.n_contact == 4


def test_who_is_on_the_structure():
    on = ROWS.on_structure(ROWS.positions(TIMES))
    expected = [
        [True, False, False, False],
        [True, False, False, False],
        [True, True, True, False],
        [False, False, False, False],
    ]
    np.testing.assert_array_equal(on, expected)


def test_rows_of_each_wheel_follow_its_own_line():
    positions = ROWS.positions(TIMES)
    block = ROWS.rows(positions, np.arange(4))
    free = dense(block.dofs, block.weights, 4)
    np.testing.assert_allclose(free[0, 0], [0.75, 0.0, 0.0, 0.0])  # at 0.5 of 0 … 2
    np.testing.assert_allclose(free[2, 0], [0.0, 0.5, 0.0, 0.0])  # at 3.5 of 2 … 5
    np.testing.assert_allclose(free[2, 1], [0.0, 0.0, 0.5, 0.5])  # at 2.5 of 1 … 4
    np.testing.assert_array_equal(free[2, 1], free[2, 2])
    np.testing.assert_array_equal(free[:, 3], 0.0)
    prescribed = dense(block.prescribed_dofs, block.prescribed_weights, 1)[..., 0]
    np.testing.assert_allclose(prescribed[:, 0], [0.25, 0.875, 0.5, 0.0])
    np.testing.assert_array_equal(prescribed[:, 1:], 0.0)


def test_rows_of_some_wheels_in_any_order():
    positions = ROWS.positions(TIMES)
    every = ROWS.rows(positions, np.arange(4))
    some = np.array([2, 0])
    block = ROWS.rows(positions[:, some], some)
    np.testing.assert_array_equal(
        dense(block.dofs, block.weights, 4), dense(every.dofs, every.weights, 4)[:, some]
    )


def test_derivatives_along_the_line():
    positions = ROWS.positions(TIMES)
    block = ROWS.rows(positions, np.arange(4), 1)
    slope = dense(block.dofs, block.weights, 4)
    np.testing.assert_allclose(slope[0, 0], [-0.5, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(slope[2, 2], [0.0, 0.0, -1 / 3, 1 / 3])
    np.testing.assert_allclose(block.prescribed_weights[0, 0].sum(), 0.5)


def test_irregularity_is_that_of_the_line():
    positions = ROWS.positions(TIMES)
    r = ROWS.irregularity(positions)
    k = 2.0 * np.pi / 3.0
    np.testing.assert_allclose(r[:, [0, 3]], 2e-3 * np.sin(k * positions[:, [0, 3]]), atol=1e-18)
    np.testing.assert_array_equal(r[:, 1:3], 0.0)
    np.testing.assert_allclose(ROWS.irregularity(positions, 1)[:, 0], 2e-3 * k * np.cos(k * positions[:, 0]))
    np.testing.assert_allclose(
        ROWS.irregularity(positions, 2)[:, 0], -2e-3 * k**2 * np.sin(k * positions[:, 0])
    )
