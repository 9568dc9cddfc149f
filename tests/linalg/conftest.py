"""Matrices that the tests of the factors share: each a plain construction of its own."""

import numpy as np
import pytest
import scipy.sparse as sp

from axlespan.linalg import available

KINDS = ("pardiso", "cholmod", "superlu", "banded")


def assemble(element, connectivity, n):
    """Sum one element matrix over a table of d.o.f."""
    size = connectivity.shape[1]
    rows = np.repeat(connectivity, size, axis=1).ravel()
    columns = np.tile(connectivity, (1, size)).ravel()
    data = np.tile(np.asarray(element).ravel(), len(connectivity))
    return sp.csr_array(sp.coo_array((data, (rows, columns)), shape=(n, n)))


def beam_matrices(elements, length=25.0, EI=2.87e9 * 2.90, m=2303.0, fixed=()):
    """K and M of a Bernoulli beam along x with d.o.f. (w, dw/dx) at each node, some of them removed."""
    h = length / elements
    k = [[12, 6 * h, -12, 6 * h], [6 * h, 4 * h * h, -6 * h, 2 * h * h]]
    k = np.array([*k, [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h * h, -6 * h, 4 * h * h]]) * EI / h**3
    c = [[156, 22 * h, 54, -13 * h], [22 * h, 4 * h * h, 13 * h, -3 * h * h]]
    c = np.array([*c, [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h * h, -22 * h, 4 * h * h]]) * m * h / 420
    table = 2 * np.arange(elements)[:, None] + np.arange(4)
    n = 2 * elements + 2
    free = np.setdiff1d(np.arange(n), np.asarray(fixed, dtype=int) % n)
    return tuple(sp.csr_array(assemble(e, table, n)[free][:, free]) for e in (k, c))


def simple_beam(elements):
    return beam_matrices(elements, fixed=(0, -2))[0]


def laplace(rows, columns):
    """Five-point Laplace operator on a grid with fixed edges."""

    def line(n):
        return sp.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(n, n))

    return sp.csr_array(
        sp.kron(line(rows), sp.eye_array(columns)) + sp.kron(sp.eye_array(rows), line(columns))
    )


def random_spd(n, seed=4):
    """Sparse, diagonally dominant, in an order that has no band."""
    rng = np.random.default_rng(seed)
    off = sp.random_array(
        (n, n), density=4.0 / n, rng=rng, data_sampler=lambda size: rng.uniform(-1, 1, size)
    )
    off = off + off.T
    return sp.csr_array(off + sp.diags_array(np.asarray(abs(off).sum(axis=1)).ravel() + 1.0))


def shuffled_band(n, half_bandwidth, seed=5):
    rng = np.random.default_rng(seed)
    bands = [rng.uniform(-1, 0, n - d) for d in range(1, half_bandwidth + 1)]
    upper = sp.diags_array(bands, offsets=range(1, half_bandwidth + 1), shape=(n, n))
    matrix = sp.csr_array(upper + upper.T + 2.5 * half_bandwidth * sp.eye_array(n))
    order = rng.permutation(n)
    return sp.csr_array(matrix[order][:, order])


MATRICES = {
    "random": lambda: random_spd(150),
    "laplace": lambda: laplace(14, 11),
    "beam": lambda: simple_beam(40),
    "shuffled band": lambda: shuffled_band(120, 4),
    "dense": lambda: random_spd(12).toarray(),
    "one by one": lambda: np.array([[4.0]]),
}


@pytest.fixture(params=KINDS)
def kind(request):
    if request.param not in available():
        pytest.skip(f"{request.param} is not installed")
    return request.param


@pytest.fixture(params=list(MATRICES))
def matrix(request):
    return MATRICES[request.param]()


@pytest.fixture
def beam():
    return beam_matrices


@pytest.fixture
def grid():
    return laplace


@pytest.fixture
def band():
    return shuffled_band
