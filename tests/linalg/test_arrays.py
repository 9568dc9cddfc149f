"""Matrices put together and taken apart, against SciPy's own."""

import numpy as np
import pytest
import scipy.sparse as sp

from axlespan.linalg.arrays import block_diagonal
from axlespan.linalg.products import half_of


def symmetric(n, seed, diagonal=True):
    A = np.random.default_rng(seed).standard_normal((n, n))
    A[np.abs(A) < 0.8] = 0.0
    A += A.T
    np.fill_diagonal(A, 1.0 if diagonal else 0.0)
    return sp.csr_array(A)


@pytest.mark.parametrize("sizes", [(3,), (1, 4, 1, 6)])
def test_blocks_on_the_diagonal(sizes):
    blocks = [symmetric(n, i) for i, n in enumerate(sizes)]
    blocks.insert(1, sp.csr_array((2, 2)))  # no entries
    found, expected = block_diagonal(blocks), sp.csr_array(sp.block_diag(blocks))
    for name in ("data", "indices", "indptr"):
        np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))
        assert getattr(found, name).dtype == getattr(expected, name).dtype
    assert found.shape == expected.shape


@pytest.mark.parametrize("diagonal", [True, False])
@pytest.mark.parametrize("is_sorted", [True, False])
def test_half_of_a_symmetric_matrix(diagonal, is_sorted):
    A = symmetric(30, 3, diagonal)
    if not is_sorted:
        backward = [np.arange(a, b)[::-1] for a, b in zip(A.indptr[:-1], A.indptr[1:], strict=True)]
        order = np.concatenate(backward)
        A = sp.csr_array((A.data[order], A.indices[order], A.indptr), shape=A.shape)
    on, starts, columns, entries = half_of(A, 30)
    above = sp.csr_array((entries, columns.astype(np.int32), starts.astype(np.int32)), shape=A.shape)
    np.testing.assert_array_equal(on, A.diagonal())
    np.testing.assert_array_equal(above.toarray(), np.triu(A.toarray(), 1))
    assert (starts.dtype, columns.dtype) == (np.uint32, np.uint32)
