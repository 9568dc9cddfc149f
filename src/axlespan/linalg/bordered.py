"""N12's complete system of equations and its block factorization, written as the paper writes them.

Source: S. G. M. Neves, A. F. M. Azevedo, R. Calçada, A direct method for analyzing the vertical vehicle-
structure interaction, Engineering Structures 34 (2012), equations (35) and (A.1) to (A.13), cited as N12.
Dense, for reading, for tests and for systems of modest size: the time integration solves the same equations
with a sparse factor of K̄.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.linalg import cholesky, solve_triangular

from axlespan.errors import InputError
from axlespan.linalg.arrays import FloatArray, MatrixLike, symmetric_csr
from axlespan.linalg.banded import BandedFactor
from axlespan.linalg.definiteness import check_diagonal, diagnosed


@dataclass(frozen=True, eq=False)
class BlockFactors:
    """The blocks of A = L D Lᵀ, N12 (A.3): L = [L11 0; L21 L22], D = diag(D11, D22).

    L11 and L22 are unit lower triangular, D11 > 0 and D22 < 0 are diagonal.
    """

    L11: FloatArray  # (n, n)
    D11: FloatArray  # (n,), the diagonal
    L21: FloatArray  # (m, n)
    L22: FloatArray  # (m, m)
    D22: FloatArray  # (m,), the diagonal

    @property
    def matrix(self) -> FloatArray:
        """L D Lᵀ, shape (n + m, n + m)."""
        n, m = len(self.D11), len(self.D22)
        L = np.block([[self.L11, np.zeros((n, m))], [self.L21, self.L22]])
        return np.asarray((L * np.concatenate([self.D11, self.D22])) @ L.T)

    def solve(self, b1: FloatArray, b2: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Solve A x = b by N12 (A.10) to (A.13).

        Parameters
        ----------
        b1 : ndarray, shape (n,) or (n, k)
            F̄_F of N12 (35).
        b2 : ndarray, shape (m,) or (m, k)
            r̄_X of N12 (35).

        Returns
        -------
        x1 : ndarray, shape of b1
            u_F, the displacements.
        x2 : ndarray, shape of b2
            X_X, the contact forces.
        """
        y1 = _forward(self.L11, b1)  # (A.10)  L11 y1 = b1
        y2 = _forward(self.L22, b2 - self.L21 @ y1)  # (A.11)  L22 y2 = b2 − L21 y1
        x2 = _backward(self.L22, (y2.T / self.D22).T)  # (A.12)  L22ᵀ x2 = D22⁻¹ y2
        x1 = _backward(self.L11, (y1.T / self.D11).T - self.L21.T @ x2)  # (A.13)
        return x1, x2


def complete_matrix(K_bar: MatrixLike, G_bar: MatrixLike) -> FloatArray:
    """Return the symmetric matrix of the complete system, N12 (35): [K̄ Ḡ; Ḡᵀ 0].

    Parameters
    ----------
    K_bar : array, shape (n, n)
        Effective stiffness matrix K̄_FF, N12 (22).
    G_bar : array, shape (n, m)
        Ḡ_FX = −(1 + α) G_FX, a column for each contact force; H̄_XF is its transpose by Betti's theorem.

    Returns
    -------
    ndarray, shape (n + m, n + m)
    """
    K, G = _dense(K_bar), _dense(G_bar)
    if G.ndim != 2 or G.shape[0] != K.shape[0]:
        raise InputError(f"must have {K.shape[0]} rows, as K_bar has", field="G_bar", value=G.shape)
    m = G.shape[1]
    return np.block([[K, G], [G.T, np.zeros((m, m))]])


def block_factorization(A11: MatrixLike, A21: MatrixLike) -> BlockFactors:
    """Factorize A = [A11 A21ᵀ; A21 0] = L D Lᵀ by blocks, N12 (A.4) to (A.7).

    No pivots are exchanged: A11 is positive definite, and so is −Ã22, which is why the order of the blocks is
    safe where an unpivoted factorization of the whole matrix is not.

    Parameters
    ----------
    A11 : array, shape (n, n)
        K̄_FF, symmetric and positive definite.
    A21 : array, shape (m, n)
        H̄_XF, of full rank: every contact point has its own place.

    Raises
    ------
    NotPositiveDefinite
        When A11 is not positive definite.
    InputError
        When A11 is not symmetric, the shapes do not match, or A21 has not full rank.
    """
    csr = symmetric_csr(A11, field="A11")
    check_diagonal(csr)
    A11, A21 = csr.toarray(), _dense(A21)
    if A21.ndim != 2 or A21.shape[1] != A11.shape[0]:
        raise InputError(f"must have {A11.shape[0]} columns, as A11 has", field="A21", value=A21.shape)
    try:
        L11, D11 = _unit_lower(A11)  # (A.4)  A11 = L11 D11 L11ᵀ
    except np.linalg.LinAlgError as error:
        raise diagnosed(csr, BandedFactor) from error
    L21 = (_forward(L11, A21.T).T) / D11  # (A.5)  A21 = L21 D11 L11ᵀ
    A22 = -(L21 * D11) @ L21.T  # (A.7)  Ã22 = −L21 D11 L21ᵀ
    try:
        L22, minus_D22 = _unit_lower(-A22)  # (A.6)  Ã22 = L22 D22 L22ᵀ
    except np.linalg.LinAlgError as error:
        raise InputError(
            "must have full rank",
            field="A21",
            value=A21.shape,
            fix="Two wheels on one point, or a wheel on prescribed d.o.f., give dependent rows.",
        ) from error
    return BlockFactors(L11=L11, D11=D11, L21=L21, L22=L22, D22=-minus_D22)


def symmetry_error(matrix: MatrixLike) -> float:
    """Return max |a_ij − a_ji| / max |a_ij|: zero for a symmetric matrix.

    Examples
    --------
    >>> symmetry_error(np.array([[4.0, 1.0], [1.5, 2.0]]))
    0.125
    """
    A: Any = matrix if sp.issparse(matrix) else np.asarray(matrix)
    largest = float(abs(A).max())
    return float(abs(A - A.T).max()) / largest if largest > 0.0 else 0.0


def _unit_lower(A: FloatArray) -> tuple[FloatArray, FloatArray]:
    """L and the diagonal of D of A = L D Lᵀ from Cholesky's C: L = C diag(C)⁻¹, D = diag(C)²."""
    C = cholesky(A, lower=True)
    diagonal = C.diagonal()
    if A.size and (diagonal**2 <= 1e-14 * A.diagonal()).any():
        raise np.linalg.LinAlgError("a pivot vanishes")
    return C / diagonal, diagonal**2


def _forward(L: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(solve_triangular(L, b, lower=True, unit_diagonal=True))


def _backward(L: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(solve_triangular(L, b, lower=True, unit_diagonal=True, trans="T"))


def _dense(matrix: MatrixLike) -> FloatArray:
    is_sparse = bool(sp.issparse(matrix))
    return np.asarray(matrix.toarray() if is_sparse else matrix, dtype=np.float64)
