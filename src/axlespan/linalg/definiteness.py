"""Why a matrix is not positive definite, and which d.o.f. are to blame: the same answer for every factor.

Rounding makes a mechanism's factorization succeed or break down by chance: of a beam on one pin the last
pivot is anything between −1e-9 and +1e-9 of its diagonal entry. What decides here is therefore not a pivot
but the smallest eigenvalue λ of the matrix scaled to a unit diagonal, D^−½ A D^−½. It does not depend on the
units or on the order of elimination; a mechanism has |λ| ≈ 1e-17, a simply supported beam of n elements
4/n⁴ (first mode; measured up to n = 5000), and a solution keeps about −log10(ε/λ) digits.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from axlespan.errors import AxlespanError
from axlespan.linalg.arrays import CsrMatrix, FloatArray, IntArray, row_indices
from axlespan.linalg.protocol import Factor

SINGULAR = 2e-15
"""Smallest scaled eigenvalue below which a matrix counts as singular: not one digit of a solution is sure
(ε = 2.2e-16, times ten for the length of a row)."""

WELL_CONDITIONED = 1e8
"""Growth of a random vector in one inverse iteration below which no eigenvalue can be near SINGULAR: the
share of a normalized random vector in the null space is hardly ever below 1e-3/√n."""

_NULL = 1e-14  # scaled eigenvalues up to here count as free motions once the matrix is known to be singular
_BLOCK = 12  # vectors iterated at once: a free part in space has six motions
_MOST_SUSPECTS = 20


class PivotBreakdown(AxlespanError):
    """A factorization met a pivot that is not positive; :func:`diagnosed` finds out why."""


class NotPositiveDefinite(AxlespanError):
    """A matrix that should be symmetric positive definite is not.

    Parameters
    ----------
    kind : str
        ``"mechanism"``: a free motion; ``"disconnected"``: the free motion of a set of d.o.f. that is coupled
        to no others; ``"indefinite"``: a negative stiffness.
    suspects : ndarray of int
        The d.o.f. with the largest share in these motions, largest first; at most twenty.
    motions : int
        Number of independent motions found; twelve stands for twelve or more.
    labels : sequence of str, optional
        Names of the suspects.
    """

    def __init__(
        self, kind: str, suspects: IntArray, motions: int = 1, labels: Sequence[str] | None = None
    ) -> None:
        self.kind = kind
        self.suspects = suspects
        self.motions = motions
        self.labels = None if labels is None else tuple(labels)
        super().__init__(kind, suspects, motions, labels)  # what pickle calls the class with

    def named(self, names: Sequence[str]) -> NotPositiveDefinite:
        """Return the same error with names for the suspects; `names` holds one for every d.o.f."""
        return NotPositiveDefinite(self.kind, self.suspects, self.motions, [names[i] for i in self.suspects])

    def __str__(self) -> str:
        labels = self.labels or tuple(str(i) for i in self.suspects)
        shown = ", ".join(labels[:6]) + (", …" if len(labels) > 6 else "")
        what, fix = _WORDS[self.kind]
        plural = "" if self.motions == 1 else "s"
        return (
            f"the matrix is not positive definite: {what.format(n=self.motions, s=plural)}; "
            f"the d.o.f. with the largest share: {shown}. {fix}"
        )


_WORDS = {
    "mechanism": (
        "{n} motion{s} without stiffness (a mechanism, or stiffnesses too far apart for double precision)",
        "Add supports, remove a hinge, or give these d.o.f. a stiffness",
    ),
    "disconnected": (
        "{n} motion{s} without stiffness of a part that is coupled to nothing else",
        "Connect or support this part, or remove it",
    ),
    "indefinite": (
        "{n} motion{s} with negative stiffness",
        "Check the signs of the stiffnesses and the order of the nodes of the elements at these d.o.f.",
    ),
}


def check_diagonal(matrix: CsrMatrix) -> None:
    """Raise when a diagonal entry is not positive: no factorization is needed to see that.

    Raises
    ------
    NotPositiveDefinite
    """
    diagonal = matrix.diagonal()
    negative = np.flatnonzero(diagonal < 0.0)
    if negative.size:
        worst = negative[np.argsort(diagonal[negative], kind="stable")]
        raise NotPositiveDefinite("indefinite", worst[:_MOST_SUSPECTS], min(negative.size, _BLOCK))
    zero = np.flatnonzero(diagonal == 0.0)
    if zero.size == 0:
        return
    coupled = np.bincount(row_indices(matrix)[matrix.data != 0.0], minlength=matrix.shape[0])[zero] > 0
    if coupled.any():  # [[0, a], [a, b]] has a negative determinant
        raise NotPositiveDefinite(
            "indefinite", zero[coupled][:_MOST_SUSPECTS], min(int(coupled.sum()), _BLOCK)
        )
    raise NotPositiveDefinite("disconnected", zero[:_MOST_SUSPECTS], min(zero.size, _BLOCK))


def smallest_scaled_eigenvalue(matrix: CsrMatrix, factor: Factor) -> float:
    """Return the smallest eigenvalue of D^−½ A D^−½, roughly: to its order of magnitude when it matters.

    One inverse iteration in the usual case, four when the matrix is nearly singular.

    Parameters
    ----------
    matrix : csr_array, shape (n, n)
        The matrix A, with a positive diagonal D.
    factor : Factor
        Its factor.
    """
    diagonal = matrix.diagonal()
    v = np.random.default_rng(1).standard_normal(matrix.shape[0]) / np.sqrt(diagonal)
    v /= np.sqrt(v @ (diagonal * v))
    quotient = np.inf
    for iteration in range(4):
        v = factor.solve(diagonal * v)
        growth = np.sqrt(v @ (diagonal * v))
        if not 0.0 < growth < np.inf:
            return 0.0
        v /= growth
        if iteration == 0 and growth < WELL_CONDITIONED:
            return float(1.0 / growth)
        quotient = min(quotient, float(v @ np.asarray(matrix @ v)))
    return quotient


def diagnosed(matrix: CsrMatrix, build: Callable[[CsrMatrix], Factor]) -> NotPositiveDefinite:
    """Return the error that says why a matrix with a positive diagonal is not positive definite.

    Parameters
    ----------
    matrix : csr_array, shape (n, n)
        The matrix.
    build : callable
        Makes a factor of a matrix or raises :class:`PivotBreakdown`.
    """
    scale = 1.0 / np.sqrt(matrix.diagonal())
    scaled = matrix.copy()
    scaled.data *= scale[row_indices(matrix)] * scale[matrix.indices]
    values, vectors = _lowest_eigenpairs(scaled, build)
    if values[0] < -_NULL:
        negative = values < -_NULL
        suspects = _largest((vectors[:, negative] ** 2 * -values[negative]).sum(axis=1))
        return NotPositiveDefinite("indefinite", suspects, int(negative.sum()))
    free = values <= max(_NULL, values[0])
    share = (vectors[:, free] ** 2).sum(axis=1)
    kind = "disconnected" if _is_a_part_of_its_own(scaled, share) else "mechanism"
    return NotPositiveDefinite(kind, _largest(share), int(free.sum()))


def _lowest_eigenpairs(
    scaled: CsrMatrix, build: Callable[[CsrMatrix], Factor]
) -> tuple[FloatArray, FloatArray]:
    """Lowest eigenpairs by subspace iteration, shifted as little as makes the matrix definite."""
    n = scaled.shape[0]
    identity = sp.eye_array(n, format="csr")

    def shifted(shift: float) -> Factor | None:
        try:
            return build(sp.csr_array(scaled + shift * identity))
        except PivotBreakdown:
            return None

    low, high = 0.0, 1e-13
    while (factor := shifted(high)) is None:
        low, high = high, 100.0 * high
    if low > 0.0:  # indefinite: the closer the shift, the faster the iteration
        for _ in range(4):
            middle = np.sqrt(low * high)
            if (closer := shifted(middle)) is None:
                low = middle
            else:
                factor, high = closer, middle
    vectors = np.random.default_rng(2).standard_normal((n, min(n, _BLOCK)))
    for _ in range(8):
        vectors = np.ascontiguousarray(np.linalg.qr(factor.solve(vectors))[0])
    values, rotation = np.linalg.eigh(vectors.T @ np.asarray(scaled @ vectors))
    return values, np.asarray(vectors @ rotation)


def _is_a_part_of_its_own(scaled: CsrMatrix, share: FloatArray) -> bool:
    """Whether the d.o.f. that move are all of some parts of the graph, and others stand still."""
    strong = scaled.copy()
    strong.data[np.abs(strong.data) < 1e-12] = 0.0  # couplings that are rounding
    strong.eliminate_zeros()
    count, part = connected_components(strong, directed=False)
    moves = share > 1e-14 * share.max()
    moving, size = np.bincount(part[moves], minlength=count), np.bincount(part, minlength=count)
    free = np.bincount(part, weights=share, minlength=count) > 1e-6 * share.sum()
    return bool(count > 1 and not free.all() and (moving[free] == size[free]).all())


def _largest(share: FloatArray) -> IntArray:
    rounded = np.round(share / share.max(), 6)  # d.o.f. of equal share in their own order, for every factor
    order = np.argsort(-rounded, kind="stable")[:_MOST_SUSPECTS]
    return np.asarray(order[share[order] >= 0.1 * share[order[0]]])
