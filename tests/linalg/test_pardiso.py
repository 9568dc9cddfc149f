"""What only PARDISO has: threads, a memory of its own, error codes."""

import gc
import importlib.metadata
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from axlespan.errors import AnalysisError, InputError
from axlespan.linalg import available, factorize
from axlespan.linalg.arrays import symmetric_csr
from axlespan.linalg.pardiso import PardisoFactor

needs_mkl = pytest.mark.skipif("pardiso" not in available(), reason="MKL is not installed")


@needs_mkl
def test_threads_give_the_same_solution(grid):
    A, b = grid(30, 31), np.random.default_rng(1).standard_normal((930, 3))
    one, two = (factorize(A, kind="pardiso", threads=n).solve(b) for n in (1, 2))
    np.testing.assert_allclose(two, one, rtol=1e-12)
    with pytest.raises(InputError, match="threads = 0: must be at least 1"):
        factorize(A, kind="pardiso", threads=0)


@needs_mkl
def test_threads_of_python_take_turns(grid):
    A = grid(20, 21)
    factor = factorize(A, kind="pardiso")
    sides = [np.random.default_rng(seed).standard_normal((420, 1 + seed % 5)) for seed in range(40)]
    with ThreadPoolExecutor(4) as pool:
        solutions = list(pool.map(factor.solve, sides))
    for b, x in zip(sides, solutions, strict=True):
        np.testing.assert_allclose(A @ x, b, atol=1e-11)


@needs_mkl
def test_closed_factor_says_so(grid):
    factor = PardisoFactor(symmetric_csr(grid(5, 5)))
    assert factor.entries >= 25 + 40
    factor.close()
    factor.close()
    with pytest.raises(InputError, match=r"factor: is closed. Factorize the matrix again"):
        factor.solve(np.ones(25))


@needs_mkl
def test_memory_comes_back_when_the_factor_goes(grid):
    def resident():  # [byte]
        with open("/proc/self/statm") as statm:
            return 4096 * int(statm.read().split()[1])

    try:
        resident()
    except OSError:
        pytest.skip("no /proc here")
    A = grid(60, 60)
    size = factorize(A, kind="pardiso").nbytes
    gc.collect()
    before = resident()
    for _ in range(60):
        factorize(A, kind="pardiso")
    assert resident() - before < 10 * size  # kept, it would be sixty times


@needs_mkl
@pytest.mark.parametrize(
    ("code", "words"), [(-2, "there is not enough memory"), (-99, "of an unknown error")]
)
def test_error_codes_become_words(grid, monkeypatch, code, words):
    monkeypatch.setattr("axlespan.linalg.pardiso._pardiso", lambda *_: code)
    with pytest.raises(AnalysisError, match=f"could not factorize a matrix of 9 equations: {words}"):
        factorize(grid(3, 3), kind="pardiso")


@needs_mkl
def test_diagonal_must_be_stored():
    matrix = symmetric_csr(np.array([[0.0, 1.0], [1.0, 2.0]]))
    with pytest.raises(InputError, match="must store every entry of its diagonal"):
        PardisoFactor(matrix)


@pytest.mark.parametrize(("kind", "package"), [("pardiso", "mkl"), ("cholmod", "cvxopt")])
def test_missing_package_is_named(kind, package, monkeypatch):
    import sys

    def missing():
        raise OSError("libmkl_rt was not found")

    monkeypatch.setattr("axlespan.linalg.pardiso.load_mkl", missing)
    monkeypatch.setitem(sys.modules, "cvxopt", None)
    with pytest.raises(InputError, match=f"pip install {package}"):
        factorize(np.eye(3), kind=kind)


def test_library_is_looked_for_in_the_environment_when_the_package_is_unknown(monkeypatch, tmp_path):
    from axlespan.linalg import mkl_library

    def unknown(name):
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr("importlib.metadata.files", unknown)
    monkeypatch.setattr("sys.prefix", str(tmp_path))
    (tmp_path / "lib").mkdir()
    for name in ("libmkl_rt.so.2", "libmkl_rt_not.so", "libmkl_core.so.2"):
        (tmp_path / "lib" / name).touch()
    assert mkl_library.find_mkl.__wrapped__() == str(tmp_path / "lib" / "libmkl_rt.so.2")
