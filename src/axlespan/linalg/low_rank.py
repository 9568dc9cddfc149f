"""Symmetric matrices of low rank, kept as their factors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import cho_factor, cho_solve

from axlespan.linalg.factor import Factor

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LowRank:
    """The matrix U diag(c) Uᵀ, never formed; modal damping has U = M φ and c = 2 ζ ω."""

    vectors: FloatArray  # U (n, m)
    coefficients: FloatArray  # c (m,)

    def apply(self, x: FloatArray) -> FloatArray:
        """U diag(c) Uᵀ x for x (n,) or (n, k)."""
        inner = self.vectors.T @ x
        scale = self.coefficients if x.ndim == 1 else self.coefficients[:, None]
        return np.asarray(self.vectors @ (scale * inner))


class UpdatedFactor:
    """The factor of A + U diag(c) Uᵀ from the factor of A, by Woodbury's identity.

    Parameters
    ----------
    base : Factor
        Factor of A.
    update : LowRank
        U (n, m) and c (m,) > 0.
    """

    def __init__(self, base: Factor, update: LowRank) -> None:
        keep = update.coefficients > 0.0
        self.base, self._u = base, np.ascontiguousarray(update.vectors[:, keep])
        self._w = base.solve(self._u.copy())
        inner = np.diag(1.0 / update.coefficients[keep]) + self._u.T @ self._w
        self._inner = cho_factor(inner)
        self.name, self.n = base.name, base.n
        self.nbytes = base.nbytes + self._u.nbytes + self._w.nbytes

    @property
    def parts(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """U and W = A⁻¹ U (n, m), and (diag(1/c) + Uᵀ W)⁻¹ (m, m)."""
        return self._u, self._w, np.asarray(cho_solve(self._inner, np.eye(self._u.shape[1])))

    def solve(self, b: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """(A + U diag(c) Uᵀ)⁻¹ b."""
        x = self.base.solve(b, out=out)
        x -= self._w @ cho_solve(self._inner, self._u.T @ x)
        return x
