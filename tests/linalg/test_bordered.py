"""N12's complete system (35) and its block factorization (A.3) to (A.13) against plain dense algebra."""

import numpy as np
import pytest
import scipy.sparse as sp

from axlespan.errors import InputError
from axlespan.linalg import NotPositiveDefinite, block_factorization, complete_matrix, symmetry_error


def system(n=30, m=4, seed=1):
    """K̄ symmetric positive definite, Ḡ a few shape functions and a unit entry per column."""
    rng = np.random.default_rng(seed)
    R = rng.standard_normal((n, n))
    G = np.zeros((n, m))
    for j in range(m):
        start = rng.integers(0, n - m - 4)
        G[start : start + 4, j] = -rng.uniform(0, 1, 4)
        G[n - m + j, j] = 1.0
    return R @ R.T + n * np.eye(n), -1.05 * G


def test_complete_matrix_is_symmetric_with_a_zero_block():
    K, G = system()
    A = complete_matrix(sp.csr_array(K), sp.csc_array(G))
    assert A.shape == (34, 34)
    assert symmetry_error(A) < 1e-15
    assert np.array_equal(A[30:, :30], G.T)
    assert not A[30:, 30:].any()
    values = np.linalg.eigvalsh(A)
    assert ((values > 0).sum(), (values < 0).sum()) == (30, 4)


@pytest.mark.parametrize(("n", "m"), [(1, 1), (12, 1), (30, 4), (60, 13)])
def test_factors_multiply_back_to_the_complete_matrix(n, m):
    K, G = system(n, m) if n > 1 else (np.array([[2.0]]), np.array([[3.0]]))
    A = complete_matrix(K, G)
    blocks = block_factorization(K, G.T)
    assert np.abs(blocks.matrix - A).max() < 1e-13 * np.abs(A).max()
    for L in (blocks.L11, blocks.L22):
        assert np.array_equal(np.diag(L), np.ones(len(L)))
        assert not np.triu(L, 1).any()
    assert (blocks.D11 > 0).all()
    assert (blocks.D22 < 0).all()
    # (A.7): the Schur complement, written out
    schur = -G.T @ np.linalg.solve(K, G)
    np.testing.assert_allclose((blocks.L22 * blocks.D22) @ blocks.L22.T, schur, rtol=1e-10, atol=1e-13)


@pytest.mark.parametrize("columns", [None, 3])
def test_solves_as_the_dense_system(columns):
    K, G = system(40, 5, seed=2)
    shape = () if columns is None else (columns,)
    rng = np.random.default_rng(3)
    b1, b2 = rng.standard_normal((40, *shape)), rng.standard_normal((5, *shape))
    x = np.linalg.solve(complete_matrix(K, G), np.concatenate([b1, b2]))
    x1, x2 = block_factorization(K, G.T).solve(b1, b2)
    np.testing.assert_allclose(x1, x[:40], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(x2, x[40:], rtol=1e-9, atol=1e-12)


def test_contact_force_of_a_wheel_on_a_spring_by_hand():
    # A mass on a spring k_v whose foot X must follow a surface spring k: u_X − u_Y = r.
    k, k_v, r = 300.0, 50.0, 0.02
    K = np.diag([k, k_v])  # u_Y of the surface, u_X of the foot (the mass held)
    G = np.array([[-1.0], [1.0]])  # N12 (11)
    x1, x2 = block_factorization(K, -G.T).solve(np.zeros(2), np.array([-r]))  # (35) with α = 0
    assert x1[1] - x1[0] == pytest.approx(r)
    assert x2[0] == pytest.approx(r * k * k_v / (k + k_v))  # springs in series


def test_dependent_wheels_are_refused():
    K, G = system(20, 2)
    with pytest.raises(InputError, match=r"A21 = \(3, 20\): must have full rank. Two wheels on one point"):
        block_factorization(K, np.vstack([G.T, G.T[0]]))


def test_indefinite_effective_matrix_is_refused():
    K, G = system(20, 2)
    K[7, 7] -= 2.0 / np.linalg.inv(K)[7, 7]
    with pytest.raises(NotPositiveDefinite) as caught:
        block_factorization(K, G.T)
    assert caught.value.kind == "indefinite"


def test_shapes_must_match():
    K, G = system(10, 2)
    with pytest.raises(InputError, match=r"G_bar = \(2, 10\): must have 10 rows"):
        complete_matrix(K, G.T)
    with pytest.raises(InputError, match=r"A21 = \(10, 2\): must have 10 columns"):
        block_factorization(K, G)
    with pytest.raises(InputError, match="A11: must be symmetric"):
        block_factorization(np.triu(K), G.T)


def test_symmetry_error_is_relative():
    assert symmetry_error(np.zeros((2, 2))) == 0.0
    assert symmetry_error(sp.csr_array(np.array([[10.0, 2.0], [1.0, 1.0]]))) == pytest.approx(0.1)
