"""Many right-hand sides in a wide band, block by block, against dense algebra."""

import numpy as np
import pytest
import scipy.sparse as sp

from axlespan.linalg.arrays import symmetric_csr
from axlespan.linalg.band_blocks import BandBlocks
from axlespan.linalg.banded import BandedFactor, BandOrder
from axlespan.linalg.factor import factorize


def lower_band(rng, n, half):
    """A lower triangular band matrix, and its storage column after column with numbers that mean nothing at its end."""
    L = np.tril(rng.uniform(-1.0, 1.0, (n, n)), -1) / half + np.diag(rng.uniform(1.0, 2.0, n))
    L[np.subtract.outer(np.arange(n), np.arange(n)) > half] = 0.0
    storage = np.full((half + 1, n), 7.0, order="F")
    for d in range(half + 1):
        storage[d, : n - d] = np.diagonal(L, -d)
    return L, storage


@pytest.mark.parametrize(
    ("n", "half"), [(64, 64), (65, 64), (128, 127), (200, 130), (321, 128), (500, 64), (700, 333)]
)
@pytest.mark.parametrize("columns", [1, 5])
def test_blocks_solve(n, half, columns):
    rng = np.random.default_rng(n + half)
    half = min(half, n - 1)
    L, storage = lower_band(rng, n, half)
    for zeros in (0, n // 3, n - 1):  # what comes first may be zero
        b = rng.standard_normal((n, columns))
        b[:zeros] = 0.0
        expected = np.linalg.solve(L.T, np.linalg.solve(L, b))
        x = b.copy()
        BandBlocks(storage).solve(x)
        np.testing.assert_allclose(x, expected, rtol=0.0, atol=1e-13 * np.abs(expected).max())
    nothing = np.zeros((n, columns))
    BandBlocks(storage).solve(nothing)
    assert not nothing.any()


@pytest.mark.parametrize("shuffled", [False, True])
def test_a_wide_band_solves_many_as_it_solves_one(shuffled):
    """The quickest way for 20 right-hand sides gives what the one for a single one gives, in place too."""
    rng = np.random.default_rng(5)
    n, half = 600, 140
    A = sp.random_array((n, n), density=0.1, rng=rng).toarray()
    A[np.abs(np.subtract.outer(np.arange(n), np.arange(n))) > half] = 0.0
    A = A + A.T + 40.0 * np.eye(n)
    A[np.arange(n - half), np.arange(half, n)] = A[np.arange(half, n), np.arange(n - half)] = 0.5
    order = rng.permutation(n) if shuffled else np.arange(n)
    A = A[order][:, order]
    factor = BandedFactor(symmetric_csr(A))
    assert factor.half_bandwidth >= 128
    b = rng.standard_normal((n, 20))
    expected = np.linalg.solve(A, b)
    kept = b.copy()
    np.testing.assert_allclose(factor.solve(b), expected, rtol=0.0, atol=1e-12)
    assert np.array_equal(b, kept)
    np.testing.assert_allclose(
        factor.solve(np.ascontiguousarray(b[:, 3])), expected[:, 3], rtol=0.0, atol=1e-12
    )
    out = np.empty_like(b)
    assert factor.solve(b, out=out) is out
    np.testing.assert_allclose(out, expected, rtol=0.0, atol=1e-12)
    factor.solve(b, out=b)
    assert np.array_equal(b, out)


def test_parts_are_eliminated_one_after_the_other():
    """Three directions that no entry connects, one after the other at each node: the band is a third as wide."""
    n, half = 120, 10
    one = sp.diags_array([0.1] * half + [3.0] + [0.1] * half, offsets=range(-half, half + 1), shape=(n, n))
    A = symmetric_csr(sp.kron(one, sp.eye_array(3), format="csr"))
    given = int(np.abs(np.subtract(*A.nonzero())).max())
    order = BandOrder.of(A)
    assert (given, order.half_bandwidth) == (3 * half, half)
    b = np.random.default_rng(6).standard_normal((3 * n, 2))
    np.testing.assert_allclose(
        BandedFactor(A, order).solve(b), np.linalg.solve(A.toarray(), b), rtol=0.0, atol=1e-13
    )


def test_a_factor_like_another_has_its_order(grid):
    """Also where the other matrix has fewer or more entries; a factor of another size or kind is no example."""
    A = symmetric_csr(grid(4, 30))
    first = factorize(A, kind="banded")
    diagonal = sp.csr_array(sp.diags_array(np.arange(1.0, 121.0)))
    wider = symmetric_csr(A + sp.diags_array([0.01, 0.01], offsets=[-70, 70], shape=(120, 120)))
    b = np.random.default_rng(7).standard_normal(120)
    for matrix in (A, diagonal, wider):
        factor = factorize(matrix, like=first)
        assert np.array_equal(factor.order, first.order)
        np.testing.assert_allclose(factor.solve(b), np.linalg.solve(matrix.toarray(), b), rtol=1e-10)
    small = symmetric_csr(grid(3, 5))
    assert factorize(small, like=first).n == 15
    assert factorize(A, like=factorize(A, kind="superlu")).name == factorize(A).name
    assert factorize(A, kind="superlu", like=first).name == "superlu"
