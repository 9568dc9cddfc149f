"""Modes against closed forms and against LAPACK's dense eigenvalues."""

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse as sp

from axlespan.errors import InputError
from axlespan.linalg import NotPositiveDefinite, lowest_modes

L, EI, M_LENGTH = 25.0, 2.87e9 * 2.90, 2303.0  # N12, section 3.1


def grid_masses(rows, columns):
    """Diagonal mass matrix that makes no two modes of a grid alike."""
    return sp.diags_array(1.0 + np.linspace(0.0, 0.3, rows * columns))


def check_normalized(modes, K, M):
    gram = modes.shapes.T @ (M @ modes.shapes)
    assert np.abs(gram - np.eye(len(modes))).max() < 1e-9
    first = np.abs(modes.shapes) >= (1 - 1e-6) * np.abs(modes.shapes).max(axis=0)
    for column, mask in zip(modes.shapes.T, first.T, strict=True):
        assert column[np.argmax(mask)] > 0
    force = M @ modes.shapes * modes.angular_frequencies**2
    residual = K @ modes.shapes - force
    assert np.abs(residual).max() <= 1e-8 * np.abs(K.diagonal()).max() * np.abs(modes.shapes).max()


@pytest.mark.parametrize("elements", [20, 50, 260])  # 40 and 100 d.o.f.: dense; 520: Lanczos
def test_simply_supported_beam(beam, elements):
    K, M = beam(elements, fixed=(0, -2))
    modes = lowest_modes(K, M, 5)
    n = np.arange(1, 6)
    exact = (n * np.pi / L) ** 2 * np.sqrt(EI / M_LENGTH)
    # consistent mass: ω is too large by (nπ/N)⁴ / 1440 (leading term, Hermite beam)
    assert (np.abs(modes.angular_frequencies / exact - 1) <= (n * np.pi / elements) ** 4 / 1400 + 1e-7).all()
    assert modes.frequencies[0] == pytest.approx(30.02 / (2 * np.pi), rel=2e-4)  # N12: ω₁ = 30.02 rad/s
    check_normalized(modes, K, M)
    # φ₁ = √(2 / mL) sin(πx/L); the rows are (φ_0, w_1, φ_1, ..)
    w = modes.shapes[1 : 2 * elements - 2 : 2, 0]
    x = np.arange(1, elements) * L / elements
    np.testing.assert_allclose(w, np.sqrt(2 / (M_LENGTH * L)) * np.sin(np.pi * x / L), rtol=1e-4)


@pytest.mark.parametrize("elements", [30, 250])
def test_free_beam_has_two_zero_frequencies(beam, elements):
    K, M = beam(elements)
    modes = lowest_modes(K, M, 4)
    # cosh(λ) cos(λ) = 1: λ₁ = 4.730041, λ₂ = 7.853205
    exact = np.array([4.730041, 7.853205]) ** 2 / L**2 * np.sqrt(EI / M_LENGTH)
    np.testing.assert_allclose(modes.angular_frequencies[2:], exact, rtol=1e-4)
    assert (modes.angular_frequencies[:2] < 1e-3 * exact[0]).all()
    check_normalized(modes, K, M)


def test_all_modes_agree_with_lapack(beam):
    K, M = beam(12, fixed=(0, -2))
    squares = scipy.linalg.eigh(K.toarray(), M.toarray(), eigvals_only=True)
    for count in (None, 24):
        modes = lowest_modes(K, M, count)
        np.testing.assert_allclose(modes.angular_frequencies**2, squares, rtol=1e-9)
        check_normalized(modes, K, M)


@pytest.mark.parametrize("shape", [(9, 14), (25, 26)])  # dense, Lanczos
def test_grid_agrees_with_lapack_and_is_reproducible(grid, shape):
    K, M = grid(*shape), grid_masses(*shape)
    squares = scipy.linalg.eigh(K.toarray(), M.toarray(), eigvals_only=True, subset_by_index=[0, 11])
    modes, again = lowest_modes(K, M, 12), lowest_modes(K, M, 12)
    np.testing.assert_allclose(modes.angular_frequencies**2, squares, rtol=1e-11)
    assert np.array_equal(modes.shapes, again.shapes)
    check_normalized(modes, K, M)


@pytest.mark.parametrize("shape", [(8, 8), (24, 24)])
def test_equal_frequencies_are_all_found(grid, shape):
    n = shape[0]
    K = grid(n, n)
    modes = lowest_modes(K, sp.eye_array(n * n), 10)
    line = 4 * np.sin(np.arange(1, n + 1) * np.pi / (2 * (n + 1))) ** 2
    exact = np.sort(np.add.outer(line, line).ravel())[:10]  # pairs (i, j) and (j, i)
    np.testing.assert_allclose(modes.angular_frequencies**2, exact, rtol=1e-10)
    check_normalized(modes, K, sp.eye_array(n * n))


@pytest.mark.parametrize("elements", [25, 230])  # dense, Lanczos
def test_massless_rotations_are_condensed(beam, elements):
    K, _ = beam(elements, fixed=(0, -2))
    n = K.shape[0]
    lumped = np.zeros(n)
    lumped[1 : n - 1 : 2] = M_LENGTH * L / elements
    modes = lowest_modes(K, sp.diags_array(lumped), 3)
    w, phi = np.flatnonzero(lumped), np.flatnonzero(lumped == 0.0)
    D = K.toarray()
    condensed = D[np.ix_(w, w)] - D[np.ix_(w, phi)] @ np.linalg.solve(D[np.ix_(phi, phi)], D[np.ix_(phi, w)])
    squares = scipy.linalg.eigh(condensed, np.diag(lumped[w]), eigvals_only=True, subset_by_index=[0, 2])
    np.testing.assert_allclose(modes.angular_frequencies**2, squares, rtol=1e-6)
    check_normalized(modes, K, sp.diags_array(lumped))
    with pytest.raises(InputError, match=rf"count = {n}: must be at most {w.size}, the number of modes"):
        lowest_modes(K, sp.diags_array(lumped), n)
    if elements == 25:
        assert len(lowest_modes(K, sp.diags_array(lumped))) == w.size


def test_mass_of_low_rank_without_massless_degrees_of_freedom():
    # two d.o.f. that share one mass: m (u1 + u2)² / 2, on springs k1 and k2: ω² = 1 / (m (1/k1 + 1/k2))
    modes = lowest_modes(np.diag([3.0, 6.0]), 2.0 * np.ones((2, 2)))
    np.testing.assert_allclose(modes.angular_frequencies, [1.0])
    with pytest.raises(InputError, match="must be at most 1, the number of modes"):
        lowest_modes(np.diag([3.0, 6.0]), 2.0 * np.ones((2, 2)), 2)


def test_two_free_bodies_on_a_spring():
    m1, m2, k = 2.0, 6.0, 12.0
    modes = lowest_modes(np.array([[k, -k], [-k, k]]), np.diag([m1, m2]))
    np.testing.assert_allclose(modes.angular_frequencies, [0.0, np.sqrt(k * (1 / m1 + 1 / m2))], atol=1e-6)
    np.testing.assert_allclose(modes.shapes[:, 0], 1 / np.sqrt(m1 + m2), rtol=1e-5)
    np.testing.assert_allclose(
        lowest_modes(np.zeros((2, 2)), np.diag([1.0, 4.0])).angular_frequencies, 0.0, atol=1e-6
    )


def test_every_factor_gives_the_same_modes(kind, grid):
    K, M = grid(21, 22), grid_masses(21, 22)
    modes, other = lowest_modes(K, M, 6, kind=kind), lowest_modes(K, M, 6, kind="banded")
    np.testing.assert_allclose(modes.angular_frequencies, other.angular_frequencies, rtol=1e-11)
    np.testing.assert_allclose(modes.shapes, other.shapes, rtol=1e-6, atol=1e-8)


@pytest.mark.parametrize(
    ("K", "M", "count", "message"),
    [
        (np.eye(3), np.eye(2), 1, r"mass = \(2, 2\): must have the shape of the stiffness"),
        (np.eye(3), np.eye(3), 0, "count = 0: must be at least 1"),
        (np.eye(3), np.eye(3), 4, "count = 4: must be at most 3"),
        (np.eye(3), np.zeros((3, 3)), 1, "mass: must not be zero everywhere"),
        (np.eye(3), np.diag([1.0, -1.0, 1.0]), 1, "mass: must not be negative at d.o.f. 1"),
        (np.eye(2), np.array([[1.0, 2.0], [2.0, 1.0]]), 1, "must be positive semidefinite"),
        (np.triu(np.ones((2, 2))), np.eye(2), 1, "stiffness: must be symmetric"),
    ],
)
def test_wrong_input_is_named(K, M, count, message):
    with pytest.raises(InputError, match=message):
        lowest_modes(K, M, count)


def test_degrees_of_freedom_with_neither_stiffness_nor_mass():
    with pytest.raises(NotPositiveDefinite) as caught:
        lowest_modes(np.diag([1.0, 0.0, 1.0]), np.diag([1.0, 0.0, 2.0]), 1)
    assert list(caught.value.suspects) == [1]
    with pytest.raises(NotPositiveDefinite) as caught:
        lowest_modes(np.diag([1.0, -1.0]), np.eye(2), 1)
    assert caught.value.kind == "indefinite"
