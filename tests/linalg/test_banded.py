"""The band's order of elimination, its two ways of solving, and their agreement."""

import numpy as np
import pytest
import scipy.sparse as sp

from axlespan.linalg.arrays import symmetric_csr
from axlespan.linalg.band_kernel import (
    compiled_single,
    compiled_solver,
    padded_width,
    scaled_rows,
    single,
    substitute,
)
from axlespan.linalg.banded import BandedFactor, BandOrder


def half_bandwidth(matrix):
    i, j = matrix.nonzero()
    return int(np.abs(i - j).max())


def test_finds_the_band_of_a_shuffled_chain_again():
    rng = np.random.default_rng(1)
    chain = sp.diags_array([-1.0, 2.5, -1.0], offsets=[-1, 0, 1], shape=(300, 300)).tocsr()
    order = rng.permutation(300)
    shuffled = symmetric_csr(chain[order][:, order])
    found = BandOrder.of(shuffled)
    assert half_bandwidth(shuffled) > 250
    assert found.half_bandwidth == 1
    assert half_bandwidth(shuffled[found.rows][:, found.rows]) == 1


def test_keeps_the_given_order_where_it_is_as_narrow(grid):
    found = BandOrder.of(symmetric_csr(grid(30, 4)))
    assert found.rows is None
    assert found.half_bandwidth == 4
    assert BandOrder.of(symmetric_csr(np.eye(5))).half_bandwidth == 0


def test_a_reordered_solve_gives_the_given_order_back(grid):
    A = grid(4, 30)  # bandwidth 30 as given, about 4 when reordered
    factor = BandedFactor(symmetric_csr(A))
    assert factor.half_bandwidth <= 8
    b = np.random.default_rng(2).standard_normal(120)
    np.testing.assert_allclose(factor.solve(b), np.linalg.solve(A.toarray(), b), rtol=1e-12)


@pytest.mark.parametrize(
    ("n", "half", "columns"), [(1, 0, 3), (7, 0, 2), (40, 1, 2), (40, 3, 5), (60, 11, 8)]
)
def test_substitution_as_written_solves(band, n, half, columns):
    rng = np.random.default_rng(3)
    L = np.tril(rng.uniform(-1, 1, (n, n)), -1) + np.diag(rng.uniform(1, 2, n))
    L[np.subtract.outer(np.arange(n), np.arange(n)) > half] = 0.0
    lower = np.zeros((n, half + 1))
    for d in range(half + 1):
        lower[: n - d, d] = np.diagonal(L, -d)
    rows = rng.permutation(n)
    b = rng.standard_normal((n, columns))
    expected = np.empty_like(b)
    expected[rows] = np.linalg.solve(L.T, np.linalg.solve(L, b[rows]))
    for solver in (substitute, compiled_solver() or substitute):
        x = b.copy()
        solver(lower, rows, x)
        np.testing.assert_allclose(x, expected, rtol=1e-9, atol=1e-12 * np.abs(expected).max())


@pytest.mark.parametrize(("n", "half"), [(20, 0), (40, 3), (60, 8), (70, 9)])
def test_a_single_right_hand_side_as_written(n, half):
    rng = np.random.default_rng(5)
    L = np.tril(rng.uniform(-1, 1, (n, n)), -1) + np.diag(rng.uniform(1, 2, n))
    L[np.subtract.outer(np.arange(n), np.arange(n)) > half] = 0.0
    lower = np.zeros((n, half + 1))
    for d in range(half + 1):
        lower[: n - d, d] = np.diagonal(L, -d)
    width = padded_width(half)
    scaled, rows, b = scaled_rows(lower, width), rng.permutation(n), rng.standard_normal(n)
    expected = np.empty(n)
    expected[rows] = np.linalg.solve(L.T, np.linalg.solve(L, b[rows]))
    for solver in (single(width), compiled_single(width) or single(width)):
        x = np.empty(n)
        solver(*scaled, rows, b, x, np.zeros(n + 2 * width))
        np.testing.assert_allclose(x, expected, rtol=1e-9, atol=1e-12 * np.abs(expected).max())
        in_place = b.copy()
        solver(*scaled, rows, in_place, in_place, np.zeros(n + 2 * width))
        assert np.array_equal(in_place, x)


def test_solves_alike_without_numba(band, monkeypatch):
    A = symmetric_csr(band(150, 6))
    b = np.random.default_rng(4).standard_normal((150, 20))
    factor = BandedFactor(A)
    with_numba = factor.solve(b)
    monkeypatch.setattr("axlespan.linalg.banded.compiled_solver", lambda: None)
    np.testing.assert_allclose(factor.solve(b), with_numba, rtol=0, atol=1e-13 * np.abs(with_numba).max())
    in_place = b.copy()
    factor.solve(in_place, in_place)
    assert np.array_equal(in_place, factor.solve(b))
