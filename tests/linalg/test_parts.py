"""Factors of the parts of a matrix that loads touch, against the whole matrix solved densely."""

import pickle

import numpy as np
import pytest
import scipy.sparse as sp

from axlespan.linalg import Factor, NotPositiveDefinite, factorize
from axlespan.linalg.parts import FactorOfParts, factor_for_loads_on, rows_connected_with

SIZE, PARTS = 50, 4


@pytest.fixture
def shuffled():
    """Four chains of 50 rows each, shuffled, and the chain of each row."""
    chain = sp.diags_array([-1.0, 2.5, -1.0], offsets=[-1, 0, 1], shape=(SIZE, SIZE))
    blocks = sp.block_diag([(1.0 + i) * chain for i in range(PARTS)], format="csr")
    order = np.random.default_rng(5).permutation(SIZE * PARTS)
    return sp.csr_array(blocks[order][:, order]), order // SIZE


class Maker:
    """Factors matrices and remembers their sizes."""

    def __init__(self):
        self.sizes = []

    def __call__(self, matrix):
        self.sizes.append(matrix.shape[0])
        return factorize(matrix)


def loads_on(rows, n, count):
    loads = np.zeros((n, count))
    loads[rows] = np.random.default_rng(6).standard_normal((len(rows), count))
    return loads


@pytest.mark.parametrize("chains", [(2,), (0, 3), (1, 2, 3)])
def test_rows_of_the_parts_that_some_belong_to(shuffled, chains):
    A, chain = shuffled
    one_of_each = np.array([np.flatnonzero(chain == c)[7] for c in chains])
    found = rows_connected_with(A, np.concatenate([one_of_each, one_of_each[:1]]))
    np.testing.assert_array_equal(found, np.flatnonzero(np.isin(chain, chains)))


def test_of_many_parts_it_is_the_whole():
    lumped = sp.csr_array(sp.eye_array(40))
    np.testing.assert_array_equal(rows_connected_with(lumped, np.arange(6)), np.arange(6))
    np.testing.assert_array_equal(rows_connected_with(lumped, np.arange(7)), np.arange(40))
    np.testing.assert_array_equal(rows_connected_with(lumped, np.array([9, 3])), [3, 9])


@pytest.mark.parametrize("chains", [(2,), (0, 3)])
@pytest.mark.parametrize("in_place", [False, True])
def test_loads_inside_ask_for_these_parts_alone(shuffled, chains, in_place):
    A, chain = shuffled
    inside, make = np.flatnonzero(np.isin(chain, chains)), Maker()
    factor = FactorOfParts(A, inside, make)
    assert isinstance(factor, Factor)
    assert factor.nbytes == 0
    for b in (loads_on(inside, len(chain), 3), loads_on(inside[4:9], len(chain), 1)[:, 0]):
        expected = np.linalg.solve(A.toarray(), b)
        given = b.copy()
        found = factor.solve(given, given) if in_place else factor.solve(given)
        assert (found is given) == in_place
        np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-14)
        assert np.all(found[~np.isin(chain, chains)] == 0.0)
        if not in_place:
            np.testing.assert_array_equal(given, b)
    assert make.sizes == [len(inside)]
    assert factor.nbytes == factorize(A[inside][:, inside]).nbytes


def test_a_load_elsewhere_asks_for_the_whole(shuffled):
    A, chain = shuffled
    inside, make = np.flatnonzero(chain == 1), Maker()
    factor = FactorOfParts(A, inside, make)
    b = loads_on(inside, len(chain), 2)
    before = factor.solve(b)
    b[np.flatnonzero(chain == 3)[5], 1] = 1e-30  # however small
    after = factor.solve(b)
    np.testing.assert_allclose(after, np.linalg.solve(A.toarray(), b), rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(after[inside], before[inside], rtol=1e-12)
    assert after[chain == 3, 1].any()
    assert make.sizes == [SIZE, SIZE * PARTS]
    assert factor.nbytes == factor.inside.nbytes + factor.whole.nbytes


def test_no_load_no_motion(shuffled):
    A, chain = shuffled
    factor = FactorOfParts(A, np.flatnonzero(chain == 1), factorize)
    np.testing.assert_array_equal(factor.solve(np.zeros((len(chain), 2))), 0.0)


def test_parts_only_of_large_matrices_that_have_them(shuffled, monkeypatch):
    A, chain = shuffled
    rows = np.flatnonzero(chain == 2)[:3]
    assert not isinstance(factor_for_loads_on(rows, A, factorize), FactorOfParts)
    monkeypatch.setattr("axlespan.linalg.parts._FEWEST", 100)
    found = factor_for_loads_on(rows, A, factorize)
    assert isinstance(found, FactorOfParts)
    np.testing.assert_array_equal(found.rows, np.flatnonzero(chain == 2))
    for touched in (np.arange(0), np.array([np.argmax(chain == c) for c in range(3)])):  # none, three of four
        assert not isinstance(factor_for_loads_on(touched, A, factorize), FactorOfParts)


def test_rows_to_blame_are_those_of_the_whole(shuffled):
    A, chain = shuffled
    inside = np.flatnonzero(chain == 2)
    mechanism = A.copy()
    row = inside[20]
    mechanism.data[mechanism.indptr[row] : mechanism.indptr[row + 1]] *= -1.0
    mechanism = sp.csr_array(0.5 * (mechanism + mechanism.T))
    factor = FactorOfParts(mechanism, inside, factorize)
    with pytest.raises(NotPositiveDefinite) as error:
        factor.solve(loads_on(inside, len(chain), 1))
    with pytest.raises(NotPositiveDefinite) as of_whole:
        factorize(mechanism)
    assert error.value.kind == of_whole.value.kind == "indefinite"
    np.testing.assert_array_equal(error.value.suspects, of_whole.value.suspects)
    assert error.value.suspects[0] == row


def test_it_stays_in_its_process(shuffled):
    A, chain = shuffled
    with pytest.raises(TypeError, match="can be neither pickled nor copied"):
        pickle.dumps(FactorOfParts(A, np.flatnonzero(chain == 1), factorize))
