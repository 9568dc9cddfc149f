"""The factor of a symmetric positive definite matrix: what can make one, which is best, and making it."""

from __future__ import annotations

from collections.abc import Callable

from axlespan.errors import InputError
from axlespan.linalg import cholmod, pardiso
from axlespan.linalg.arrays import CsrMatrix, MatrixLike, estimated_fill, symmetric_csr
from axlespan.linalg.banded import BandedFactor, BandOrder
from axlespan.linalg.cholmod import CholmodFactor
from axlespan.linalg.definiteness import (
    SINGULAR,
    NotPositiveDefinite,
    PivotBreakdown,
    check_diagonal,
    diagnosed,
    smallest_scaled_eigenvalue,
)
from axlespan.linalg.pardiso import PardisoFactor
from axlespan.linalg.protocol import Factor, SplitFactor
from axlespan.linalg.superlu import SuperLUFactor

__all__ = ["Choice", "Factor", "NotPositiveDefinite", "SplitFactor", "available", "choose", "factorize"]

# Time of one solve [ns]: a share per equation and a share per entry of the factor. Measured with one thread
# on an x86-64 machine (Xeon, AVX-512) on beams, plates and solids of 100 to 36 597 equations.
_SOLVE_TIME = {
    "banded": (12.0, 0.95),
    "pardiso": (150.0, 1.75),
    "cholmod": (150.0, 2.0),
    "superlu": (50.0, 2.4),
}
# The same for each of many right-hand sides side by side; a kind that is not named gains nothing. PARDISO on the
# solid model: 24 ms for one, 5.5 ms each for 8, 2.9 ms each for 32; a band: 14, 7.5 and 3.4 ms.
_SOLVE_TIME_OF_MANY = {"banded": (1.0, 0.33), "pardiso": (30.0, 0.25)}
_MANY = 8
_SLOW_FACTORIZATION = {"superlu": 1.3}  # SuperLU takes five to twenty times the others' time to factorize
_BAND_OUT_OF_CACHE = 16e6  # [byte]; a wider band is read from memory
_TIME_OUT_OF_CACHE = 1.15  # [ns] per entry
_LARGEST_BAND = 4e9  # [byte]


class Choice(str):
    """The name of a kind of factor, with the reason for choosing it.

    Parameters
    ----------
    kind : str
        ``"banded"``, ``"pardiso"``, ``"cholmod"`` or ``"superlu"``.
    reason : str
        One line for the summary of a run.
    """

    reason: str

    def __new__(cls, kind: str, reason: str = "") -> Choice:
        """Make the name, and keep the reason with it."""
        choice = super().__new__(cls, kind)
        choice.reason = reason
        return choice


def available() -> tuple[str, ...]:
    """Return the kinds of factors that can be made here, best for large solid models first.

    ``"pardiso"`` needs the package ``mkl`` (``pip install axlespan[mkl]``, x86-64), ``"cholmod"`` the package
    ``cvxopt`` (GPL); ``"superlu"`` and ``"banded"`` are always there.
    """
    optional = (("pardiso", pardiso.installed), ("cholmod", cholmod.installed))
    return (*(kind for kind, installed in optional if installed()), "superlu", "banded")


def choose(matrix: MatrixLike, *, columns: int = 1) -> Choice:
    """Return the kind of factor whose solves should be quickest, with the reason.

    The cost of a band is known once its half-bandwidth is: n (kd + 1) entries. The fill of a sparse factor is
    estimated, within a factor of two. Of many right-hand sides at once PARDISO gains more than a wide band does.

    Parameters
    ----------
    matrix : sparse array or ndarray, shape (n, n)
        Symmetric matrix.
    columns : int, optional
        Right-hand sides that are solved for at a time.

    Examples
    --------
    >>> import scipy.sparse as sp
    >>> chain = sp.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(500, 500))
    >>> choice = choose(chain)
    >>> choice, choice.reason
    ('banded', 'narrow band: half-bandwidth 1 of 500 equations')
    """
    csr = symmetric_csr(matrix)
    return _choose(csr, BandOrder.of(csr), columns)


def _choose(csr: CsrMatrix, order: BandOrder, columns: int) -> Choice:
    times = _SOLVE_TIME | (_SOLVE_TIME_OF_MANY if columns >= _MANY else {})
    n, half_bandwidth = csr.shape[0], order.half_bandwidth
    sparse = available()[0]  # the best one of those that are there
    fill = min(estimated_fill(csr) / n, half_bandwidth + 1)
    per_equation, per_entry = times[sparse]
    sparse_time = _SLOW_FACTORIZATION.get(sparse, 1.0) * (per_equation + per_entry * fill)
    per_equation, per_entry = times["banded"]
    band_bytes = 8.0 * n * (half_bandwidth + 1)
    if band_bytes > _BAND_OUT_OF_CACHE and columns < _MANY:
        per_entry = _TIME_OUT_OF_CACHE
    if per_equation + per_entry * (half_bandwidth + 1) <= sparse_time and band_bytes <= _LARGEST_BAND:
        return Choice("banded", f"narrow band: half-bandwidth {half_bandwidth} of {n} equations")
    why = {
        "pardiso": "MKL is installed",
        "cholmod": "cvxopt is installed, MKL is not",
        "superlu": "always there; pip install mkl gives a faster solver on x86-64",
    }[sparse]
    return Choice(sparse, f"wide band: half-bandwidth {half_bandwidth} of {n} equations; {why}")


def factorize(
    matrix: MatrixLike, *, kind: str = "auto", threads: int = 1, columns: int = 1, like: Factor | None = None
) -> Factor:
    """Factorize a symmetric positive definite matrix: A = L D Lᵀ.

    Parameters
    ----------
    matrix : sparse array or ndarray, shape (n, n)
        The matrix, both triangles.
    kind : str, optional
        ``"auto"`` (see :func:`choose`) or one of :func:`available`.
    threads : int, optional
        Threads for PARDISO; the others do not use it.
    columns : int, optional
        Right-hand sides that will be solved for at a time, for the choice of a kind.
    like : Factor, optional
        Of a matrix with the same pattern. If it is of a band, so is this one, in the same order.

    Returns
    -------
    Factor
        To be held by the caller: nothing is cached.

    Raises
    ------
    InputError
        When the matrix is not square, finite and symmetric, or the kind is not available.
    NotPositiveDefinite
        When the matrix is singular, so nearly singular that a solution has no sure digit, or indefinite. All
        kinds refuse the same matrices.

    Examples
    --------
    >>> import numpy as np
    >>> factor = factorize(np.array([[4.0, -2.0], [-2.0, 3.0]]))
    >>> factor.solve(np.array([2.0, 3.0]))
    array([1.5, 2. ])
    """
    csr = symmetric_csr(matrix)
    check_diagonal(csr)
    order = None
    if kind in ("auto", "banded") and isinstance(like, BandedFactor) and like.n == csr.shape[0]:
        kind, order = "banded", like.band_order.on(csr)
    elif kind in ("auto", "banded"):
        order = BandOrder.of(csr)
    if kind == "auto":
        assert order is not None
        kind = _choose(csr, order, columns)
    builders: dict[str, Callable[[CsrMatrix], Factor]] = {
        "banded": lambda a: BandedFactor(a, order),
        "pardiso": lambda a: PardisoFactor(a, threads),
        "cholmod": CholmodFactor,
        "superlu": SuperLUFactor,
    }
    if kind not in builders:
        raise InputError(
            "must be a kind of factor", field="kind", value=kind, fix=f"Write auto, {', '.join(builders)}."
        )
    try:
        factor = builders[kind](csr)
    except PivotBreakdown as error:
        raise diagnosed(csr, builders[kind]) from error
    if smallest_scaled_eigenvalue(csr, factor) < SINGULAR:
        raise diagnosed(csr, builders[kind])
    return factor
