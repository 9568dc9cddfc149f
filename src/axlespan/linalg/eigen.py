"""Natural frequencies and mode shapes: the lowest eigenpairs of K φ = ω² M φ."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.linalg import cholesky, eigh, solve_triangular, svd
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from axlespan.errors import AnalysisError, InputError
from axlespan.linalg.arrays import CsrMatrix, FloatArray, MatrixLike, symmetric_csr
from axlespan.linalg.factor import Factor, NotPositiveDefinite, factorize

_DENSE_UP_TO = 400  # [d.o.f.]; up to here the dense decomposition takes less than half a second
_SHIFT = 1e-6
"""|shift| over the smallest k_ii / m_ii: K + |shift| M is then positive definite by a wide margin, and the
zero frequencies of free bodies come out below 1e-7 of the first elastic one."""


@dataclass(frozen=True, eq=False)
class Modes:
    """The lowest modes, in ascending order, normalized to φᵀ M φ = 1.

    Of each shape the largest component is positive; of components of equal size the first counts.
    """

    angular_frequencies: FloatArray  # ω (n_modes,) [rad/s]; 0 for rigid-body motions
    shapes: FloatArray  # φ (n, n_modes) [kg^-1/2 for displacements]

    @property
    def frequencies(self) -> FloatArray:
        """Natural frequencies, shape (n_modes,) [Hz]."""
        return np.asarray(self.angular_frequencies / (2.0 * np.pi))

    def __len__(self) -> int:
        return len(self.angular_frequencies)


def lowest_modes(
    stiffness: MatrixLike,
    mass: MatrixLike,
    count: int | None = None,
    *,
    kind: str = "auto",
    threads: int = 1,
) -> Modes:
    """Return the lowest modes of K φ = ω² M φ.

    Up to 400 d.o.f., or when more than a third of the modes are asked for, by a dense singular value
    decomposition, which loses only half as many digits of the lowest frequencies as a dense eigenvalue
    solver; else by shift-invert Lanczos (ARPACK). A singular K (free bodies) is shifted; M may be singular
    (massless d.o.f.), which lowers the number of modes that there are.

    Parameters
    ----------
    stiffness : sparse array or ndarray, shape (n, n)
        K, symmetric and positive semidefinite.
    mass : sparse array or ndarray, shape (n, n)
        M, symmetric and positive semidefinite.
    count : int, optional
        Number of modes; all when left out, which is for a few thousand d.o.f. at most.
    kind, threads
        The factor, see :func:`axlespan.linalg.factorize`.

    Returns
    -------
    Modes

    Raises
    ------
    InputError
        When there are not so many modes, or a matrix is not what it should be.
    NotPositiveDefinite
        When d.o.f. have neither stiffness nor mass, or K is indefinite.
    AnalysisError
        When Lanczos' method does not converge.
    """
    K, M = symmetric_csr(stiffness, "stiffness"), symmetric_csr(mass, "mass")
    massive = _check(K, M, count)
    n = K.shape[0]
    if count is None or n <= _DENSE_UP_TO or 3 * count > n:
        shifted, shift, _ = _definite(K, M, kind, threads)
        squares, shapes = _dense_modes(shifted, M, shift, count)
    else:
        _, shift, factor = _definite(K, M, kind, threads)
        squares, shapes = _lanczos(K, M, min(count, massive), shift, factor)
    omega = np.sqrt(np.maximum(squares, 0.0))
    return Modes(angular_frequencies=omega, shapes=_signed(shapes))


def _check(K: CsrMatrix, M: CsrMatrix, count: int | None) -> int:
    """Return the number of d.o.f. with mass."""
    if M.shape != K.shape:
        raise InputError(f"must have the shape of the stiffness, {K.shape}", field="mass", value=M.shape)
    diagonal = M.diagonal()
    if (diagonal < 0.0).any():
        raise InputError(f"must not be negative at d.o.f. {int(diagonal.argmin())}", field="mass")
    massive = int((diagonal > 0.0).sum())
    if massive == 0:
        raise InputError("must not be zero everywhere", field="mass", fix="Give a density or point masses.")
    if count is not None and count < 1:
        raise InputError("must be at least 1", field="count", value=count)
    if count is not None and count > massive:
        raise _too_many(count, massive)
    return massive


def _too_many(count: int, there: int) -> InputError:
    return InputError(
        f"must be at most {there}, the number of modes that there are",
        field="count",
        value=count,
        fix="Massless d.o.f. have none. Ask for fewer modes.",
    )


def _definite(K: CsrMatrix, M: CsrMatrix, kind: str, threads: int) -> tuple[CsrMatrix, float, Factor]:
    """Return K − σ M, σ ≤ 0 and the factor: σ = 0 when K is positive definite, else slightly negative."""
    try:
        return K, 0.0, factorize(K, kind=kind, threads=threads)
    except NotPositiveDefinite as error:
        if error.kind == "indefinite":
            raise
    k, m = K.diagonal(), M.diagonal()
    both = (k > 0.0) & (m > 0.0)
    shift = -_SHIFT * float((k[both] / m[both]).min()) if both.any() else -1.0
    shifted = sp.csr_array(K - shift * M)
    return shifted, shift, factorize(shifted, kind=kind, threads=threads)


def _dense_modes(
    shifted: CsrMatrix, M: CsrMatrix, shift: float, count: int | None
) -> tuple[FloatArray, FloatArray]:
    """Eigenpairs from the singular values s of C⁻¹ F, with C Cᵀ = K − σ M and F Fᵀ = M: ω² = 1/s² + σ."""
    C = cholesky(shifted.toarray(), lower=True)
    F = _mass_root(M)
    U, s, _ = svd(solve_triangular(C, F, lower=True), full_matrices=False)
    count = F.shape[1] if count is None else count
    if count > F.shape[1]:
        raise _too_many(count, F.shape[1])
    s = s[:count]
    shapes = solve_triangular(C, U[:, :count], lower=True, trans="T") / s
    return 1.0 / s**2 + shift, shapes


def _mass_root(M: CsrMatrix) -> FloatArray:
    """Return F of full column rank with F Fᵀ = M, shape (n, rank of M)."""
    scale = np.sqrt(M.diagonal())
    inverse = np.divide(1.0, scale, out=np.zeros_like(scale), where=scale > 0.0)
    values, vectors = eigh(inverse[:, None] * M.toarray() * inverse)
    if values[0] < -1e-10 * values[-1]:
        worst = int(np.abs(vectors[:, 0]).argmax())
        raise InputError(
            f"must be positive semidefinite, but has a negative direction at d.o.f. {worst}", field="mass"
        )
    positive = values > 1e-12 * values[-1]
    return np.asarray(scale[:, None] * vectors[:, positive] * np.sqrt(values[positive]))


def _lanczos(
    K: CsrMatrix, M: CsrMatrix, count: int, shift: float, factor: Factor
) -> tuple[FloatArray, FloatArray]:
    n = K.shape[0]
    inverse = LinearOperator((n, n), matvec=lambda b: factor.solve(np.ascontiguousarray(b)), dtype=np.float64)
    start = np.random.default_rng(3).standard_normal(n)
    try:
        squares, shapes = eigsh(K, count, M, sigma=shift, OPinv=inverse, v0=start, ncv=min(n, 2 * count + 20))
    except ArpackNoConvergence as error:
        raise AnalysisError(
            f"Lanczos' method found {len(error.eigenvalues)} of {count} modes. Ask for fewer modes, or check "
            "the model for bodies that nothing holds"
        ) from error
    order = np.argsort(squares, kind="stable")
    shapes = shapes[:, order]
    shapes /= np.sqrt((shapes * np.asarray(M @ shapes)).sum(axis=0))
    return np.asarray(squares[order]), np.asarray(shapes)


def _signed(shapes: FloatArray) -> FloatArray:
    """Make the first of the largest components of each shape positive."""
    size = np.abs(shapes)
    first = np.argmax(size >= (1.0 - 1e-6) * size.max(axis=0), axis=0)
    return np.ascontiguousarray(shapes * np.sign(shapes[first, np.arange(shapes.shape[1])]))
