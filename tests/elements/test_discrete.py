"""Springs, dashpots, bars, point masses and rigid arms against their definitions."""

import numpy as np

from axlespan.elements import discrete

RNG = np.random.default_rng(4)


def test_coupling_gives_equal_and_opposite_forces():
    coefficients = np.array([[2.0e6, 3.0e4], [5.0e5, 0.0]])
    matrices = discrete.coupling(coefficients)
    assert matrices.shape == (2, 4, 4)
    u = RNG.normal(size=4)
    for matrix, (a, b) in zip(matrices, coefficients, strict=True):
        stretch = u[2:] - u[:2]
        pull = np.array([a, b]) * stretch
        np.testing.assert_allclose(matrix @ u, np.concatenate([-pull, pull]), rtol=1e-14)


def test_directed_spring_resists_only_along_its_direction():
    direction = np.array([[2.0, -1.0, 2.0]]) / 3.0
    matrix = discrete.directed(np.array([7.0e5]), direction)[0]
    u = RNG.normal(size=6)
    pull = 7.0e5 * (u[3:] - u[:3]) @ direction[0] * direction[0]
    np.testing.assert_allclose(matrix @ u, np.concatenate([-pull, pull]), rtol=1e-12)
    assert np.linalg.matrix_rank(matrix) == 1


def test_bar_stiffness():
    ends = RNG.uniform(-3.0, 3.0, (4, 2, 3))
    rigidity = np.array([1e8, 2e8, 3e8, 4e8])
    matrices = discrete.bar_stiffness(ends, rigidity)
    for matrix, (a, b), ea in zip(matrices, ends, rigidity, strict=True):
        length = np.linalg.norm(b - a)
        stretched = np.concatenate([a, b]) * 1e-3  # a uniform strain of 1e-3 about the origin
        force = matrix @ stretched
        np.testing.assert_allclose(force[3:], ea * 1e-3 * (b - a) / length, rtol=1e-11)
        np.testing.assert_allclose(force[:3], -force[3:], rtol=1e-13)
        values = np.linalg.eigvalsh(matrix)
        assert np.all(np.abs(values[:5]) < 1e-12 * values[5])
        assert np.isclose(values[5], 2.0 * ea / length)


def test_bar_mass_is_the_same_in_all_directions():
    ends = np.array([[[0.0, 0.0, 0.0], [3.0, 0.0, 4.0]]])
    matrix = discrete.bar_mass(ends, np.array([60.0]))[0]
    for axis in range(3):
        shift = np.tile(np.eye(3)[axis], 2)
        assert np.isclose(shift @ matrix @ shift, 300.0)
        linear = np.concatenate([np.zeros(3), np.eye(3)[axis]])  # ∫ m ξ² dx
        assert np.isclose(linear @ matrix @ linear, 100.0)
    assert matrix[0, 2] == 0.0


def test_point_mass_is_diagonal():
    np.testing.assert_array_equal(discrete.point_mass(np.array([[5.0, 7.0]]))[0], np.diag([5.0, 7.0]))


def test_rigid_arm_is_the_cross_product():
    arms = RNG.normal(size=(5, 3))
    u, theta = RNG.normal(size=3), RNG.normal(size=3)
    moved = discrete.rigid_arm(arms) @ np.concatenate([u, theta])
    np.testing.assert_allclose(moved[:, :3], u + np.cross(theta, arms), rtol=1e-13)
    np.testing.assert_allclose(moved[:, 3:], np.tile(theta, (5, 1)))
