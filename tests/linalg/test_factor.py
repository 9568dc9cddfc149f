"""Every factor solves the same systems and keeps the same promises."""

import copy
import pickle
import subprocess
import sys

import numpy as np
import pytest
import scipy.sparse as sp

from axlespan.errors import InputError
from axlespan.linalg import Choice, Factor, SplitFactor, available, choose, factorize


def dense(matrix):
    return matrix.toarray() if sp.issparse(matrix) else matrix


def close_to_exact(matrix, x, b):
    """Backward error: |A x − b| within rounding of |A| |x| + |b|, for any condition number."""
    A = dense(matrix)
    bound = np.abs(A) @ np.abs(x) + np.abs(b)
    return (np.abs(A @ x - b) <= 1e-14 * len(A) * bound).all()


@pytest.mark.parametrize("columns", [None, 1, 2, 7, 16, 33])
def test_solves_any_number_of_right_hand_sides(kind, matrix, columns):
    n = matrix.shape[0]
    b = np.random.default_rng(1).standard_normal(n if columns is None else (n, columns))
    before = b.copy()
    x = factorize(matrix, kind=kind).solve(b)
    assert close_to_exact(matrix, x, b)
    assert x.shape == b.shape
    assert np.array_equal(b, before)


def test_agrees_with_the_dense_solution(kind, grid):
    A = grid(9, 13)
    b = np.random.default_rng(2).standard_normal((117, 5))
    x = np.linalg.solve(A.toarray(), b)
    assert np.abs(factorize(A, kind=kind).solve(b) - x).max() < 1e-13 * np.abs(x).max()


@pytest.mark.parametrize("columns", [2, 24])
def test_columns_agree_with_one_at_a_time(kind, band, columns):
    b = np.random.default_rng(3).standard_normal((200, columns))
    factor = factorize(band(200, 6), kind=kind)
    together = factor.solve(b)
    for j in range(columns):
        alone = factor.solve(np.ascontiguousarray(b[:, j]))
        assert np.abs(together[:, j] - alone).max() <= 1e-13 * np.abs(alone).max()


@pytest.mark.parametrize("shape", [(150,), (150, 1), (150, 20)])
def test_solves_in_place_and_into_a_given_array(kind, band, shape):
    factor = factorize(band(150, 5), kind=kind)
    b = np.random.default_rng(4).standard_normal(shape)
    x = factor.solve(b)
    out = np.full(shape, np.nan)
    assert factor.solve(b, out) is out
    assert factor.solve(b, b) is b
    assert np.array_equal(out, x)
    assert np.array_equal(b, x)


def test_no_right_hand_side_is_no_solution(kind, grid):
    factor = factorize(grid(4, 5), kind=kind)
    assert factor.solve(np.empty((20, 0))).shape == (20, 0)


def test_the_same_input_gives_the_same_bits(kind, grid):
    b = np.random.default_rng(5).standard_normal((240, 9))
    first, second = (factorize(grid(15, 16), kind=kind).solve(b.copy()) for _ in range(2))
    assert np.array_equal(first, second)


def test_halves_make_the_whole(kind, matrix):
    factor = factorize(matrix, kind=kind)
    if not isinstance(factor, SplitFactor):
        assert kind == "superlu"
        return
    n = matrix.shape[0]
    for shape in ((n,), (n, 4), (n, 0)):
        b, c = np.random.default_rng(6).standard_normal((2, *shape))
        y, z = factor.forward(b), factor.forward(c)
        x = factor.solve(b)
        np.testing.assert_allclose(factor.backward(y), x, rtol=1e-9, atol=1e-12 * np.abs(x).max(initial=1.0))
        energy = np.sqrt((b * x).sum() * (c * factor.solve(c)).sum())
        assert (y * z).sum() == pytest.approx((c * x).sum(), abs=1e-11 * energy)


def test_tells_what_it_is(kind, grid):
    factor = factorize(grid(20, 20), kind=kind)
    assert isinstance(factor, Factor)
    assert (factor.name, factor.n) == (kind, 400)
    # at least the lower triangle of A: 400 + 2·380 entries; at most a full triangle, three times
    assert 8 * 1160 < factor.nbytes < 3 * 8 * 400 * 401


@pytest.mark.parametrize("act", [pickle.dumps, copy.copy, copy.deepcopy])
def test_refuses_to_be_pickled_or_copied(kind, grid, act):
    factor = factorize(grid(3, 3), kind=kind)
    with pytest.raises(
        TypeError, match=f"a {kind} factor can be neither pickled nor copied.*each worker call"
    ):
        act(factor)


@pytest.mark.parametrize(
    ("b", "out", "message"),
    [
        (np.ones(8), None, r"b = \(8,\): must have the shape \(9,\) or \(9, k\)"),
        (np.ones((3, 9)), None, r"b = \(3, 9\): must have the shape"),
        (np.ones(9, dtype=np.float32), None, "b: must be a C-contiguous float64 array"),
        (np.ones(18)[::2], None, "b: must be a C-contiguous float64 array"),
        (np.ones((9, 4), order="F"), None, r"np.ascontiguousarray\(b, dtype=np.float64\)"),
        ([1.0] * 9, None, "b: must be a C-contiguous float64 array"),
        (np.ones(9), np.ones((9, 1)), r"out = \(9, 1\): must have the shape of b, \(9,\)"),
        (np.ones(9), np.ones(9, dtype=int), "out: must be a C-contiguous float64 array"),
    ],
)
def test_refuses_right_hand_sides_that_compiled_code_would_misread(kind, grid, b, out, message):
    with pytest.raises(InputError, match=message):
        factorize(grid(3, 3), kind=kind).solve(b, out)


def test_refuses_to_write_to_a_read_only_array(kind, grid):
    b = np.ones(9)
    b.flags.writeable = False
    factor = factorize(grid(3, 3), kind=kind)
    assert factor.solve(b)[4] == pytest.approx(1.125)  # the value at the middle of the 3 x 3 grid: 9/8
    with pytest.raises(InputError, match="out: must be writeable"):
        factor.solve(b, b)


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        (np.ones((2, 3)), r"matrix = \(2, 3\): must be a square matrix"),
        (np.ones((0, 0)), "must be a square matrix with at least one row"),
        (np.ones(4), "must be a square matrix"),
        (np.array([[2.0, 1.0], [1.5, 2.0]]), r"symmetric, but entry \(0, 1\) is 1 and entry \(1, 0\) is 1.5"),
        (np.array([[2.0, 1.0], [0.0, 2.0]]), r"symmetric, but entry \(0, 1\) is 1 and entry \(1, 0\) is 0"),
        (np.array([[2.0, np.nan], [0.0, 2.0]]), r"must be finite, but entry \(0, 1\) is nan"),
        (np.array([[2.0, 0.0], [0.0, np.inf]]), r"must be finite, but entry \(1, 1\) is inf"),
        (np.eye(2) * 1j, "must be real"),
    ],
)
@pytest.mark.parametrize("form", [np.asarray, "sparse"])
def test_refuses_matrices_that_are_not_symmetric_and_finite(kind, bad, message, form):
    if form == "sparse":
        if bad.ndim != 2 or 0 in bad.shape:
            return
        bad = sp.csc_array(bad)
    with pytest.raises(InputError, match=message):
        factorize(bad, kind=kind)


def test_takes_rounding_for_symmetry_and_scales_it_by_the_diagonal(kind):
    stiff, soft = 1e12, 1e-3
    A = np.diag([stiff, soft, soft])
    A[0, 1] = A[1, 0] = 1e3
    A[0, 1] *= 1.0 + 1e-13
    assert factorize(A, kind=kind).solve(np.array([0.0, 0.0, 1.0]))[2] == pytest.approx(1.0 / soft)
    A[1, 2] = 1e-9  # far below the largest entry, but not below those beside it
    with pytest.raises(InputError, match=r"entry \(1, 2\) is 1e-09"):
        factorize(A, kind=kind)


def test_leaves_the_callers_matrix_alone(kind):
    rows, columns = np.array([0, 1, 0, 1, 0]), np.array([1, 0, 0, 1, 0])
    A = sp.csr_array(sp.coo_array((np.array([1.0, 1.0, 2.0, 5.0, 3.0]), (rows, columns))))
    A.indices, A.data = A.indices[[1, 0, 2, 3]], A.data[[1, 0, 2, 3]]  # unsorted
    A.has_sorted_indices = A.has_canonical_format = False
    data, indices = A.data.copy(), A.indices.copy()
    x = factorize(A, kind=kind).solve(np.array([24.0, 0.0]))
    np.testing.assert_allclose(x, [5.0, -1.0])
    assert np.array_equal(A.data, data)
    assert np.array_equal(A.indices, indices)


def test_explicit_zeros_do_no_harm(kind, grid):
    A = grid(5, 5)
    extra = sp.coo_array((np.zeros(2), ([0, 24], [24, 0])), shape=(25, 25))
    padded = sp.csr_array(sp.coo_array(
        (np.r_[sp.coo_array(A).data, extra.data],
         tuple(np.r_[a, b] for a, b in zip(sp.coo_array(A).coords, extra.coords, strict=True))),
        shape=(25, 25),
    ))  # fmt: skip
    b = np.arange(25.0)
    np.testing.assert_allclose(
        factorize(padded, kind=kind).solve(b), np.linalg.solve(A.toarray(), b), rtol=1e-12
    )


def test_unknown_kind_is_named():
    with pytest.raises(InputError, match=r"kind = 'umfpack': must be a kind of factor. Write auto, banded, "):
        factorize(np.eye(2), kind="umfpack")


def test_optional_packages_are_not_imported_before_they_are_used():
    code = (
        "import sys, axlespan.linalg as la; la.available(); la.choose([[1.0]]); "
        "print(sorted({'numba', 'cvxopt', 'matplotlib'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_always_offers_superlu_and_banded():
    assert available()[-2:] == ("superlu", "banded")
    assert set(available()) <= {"pardiso", "cholmod", "superlu", "banded"}


def test_chooses_a_band_where_there_is_one(band, beam):
    for matrix, half_bandwidth, n in ((beam(50, fixed=(0, -2))[0], 3, 100), (band(800, 4), 4, 800)):
        choice = choose(matrix)
        assert choice == "banded"
        assert choice.reason == f"narrow band: half-bandwidth {half_bandwidth} of {n} equations"
        assert factorize(matrix).name == "banded"


@pytest.mark.parametrize(
    ("installed", "reason"),
    [
        (("pardiso", "cholmod", "superlu", "banded"), "MKL is installed"),
        (("cholmod", "superlu", "banded"), "cvxopt is installed, MKL is not"),
        (("superlu", "banded"), "always there; pip install mkl"),
    ],
)
def test_chooses_the_best_sparse_factor_where_the_band_is_wide(grid, monkeypatch, installed, reason):
    monkeypatch.setattr("axlespan.linalg.factor.available", lambda: installed)
    wide = sp.csr_array(sp.kron(grid(24, 24), sp.eye_array(24)) + sp.kron(sp.eye_array(576), grid(4, 6)))
    choice = choose(wide)
    assert choice == installed[0]
    assert choice.reason.startswith("wide band: half-bandwidth ")
    assert reason in choice.reason
    assert pickle.loads(pickle.dumps(choice)).reason == choice.reason
    assert isinstance(choice, Choice)
