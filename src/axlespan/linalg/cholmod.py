"""CHOLMOD through cvxopt, if the user has installed it: it is under the GPL, so it is no part of axlespan."""

from __future__ import annotations

import importlib.util
from functools import cache
from typing import Any, NoReturn

import numpy as np
import scipy.sparse as sp

from axlespan.errors import InputError
from axlespan.linalg.arrays import CsrMatrix, FloatArray, estimated_fill, right_hand_side
from axlespan.linalg.definiteness import PivotBreakdown
from axlespan.linalg.protocol import refuse_pickling

# Systems of cvxopt.cholmod.solve: A x = b; L x = b; Lᵀ x = b; x = P b; x = Pᵀ b.
_A, _L, _LT, _P, _PT = 0, 4, 5, 7, 8


@cache
def installed() -> bool:
    """Whether cvxopt is there."""
    return importlib.util.find_spec("cvxopt") is not None


class CholmodFactor:
    """Supernodal Cholesky factor.

    Parameters
    ----------
    matrix : csr_array, shape (n, n)
        Symmetric matrix in canonical form.

    Raises
    ------
    InputError
        When cvxopt is not installed.
    PivotBreakdown
        When a pivot is not positive.
    """

    name = "cholmod"

    def __init__(self, matrix: CsrMatrix) -> None:
        try:
            import cvxopt
            import cvxopt.cholmod
        except ImportError as error:
            raise InputError(
                "needs the package cvxopt", field="kind", value=self.name, fix="Write pip install cvxopt."
            ) from error
        self._dense, self._cholmod = cvxopt.matrix, cvxopt.cholmod
        self.n: int = matrix.shape[0]
        lower: Any = sp.coo_array(sp.tril(matrix))
        rows, columns = (cvxopt.matrix(np.asarray(index, dtype=np.int64)) for index in lower.coords)
        sparse = cvxopt.spmatrix(cvxopt.matrix(lower.data), rows, columns, (self.n, self.n))
        self._nbytes = int(8.0 * estimated_fill(matrix))
        before = dict(self._cholmod.options)
        self._cholmod.options["supernodal"] = (
            2  # A = L Lᵀ: fastest, and the only kind whose diagonal can be read
        )
        try:
            self._factor = self._cholmod.symbolic(sparse)
            self._cholmod.numeric(sparse, self._factor)
        except ArithmeticError as error:
            raise PivotBreakdown(f"pivot {error} of {self.n} is not positive") from error
        finally:
            self._cholmod.options.clear()
            self._cholmod.options.update(before)

    @property
    def nbytes(self) -> int:
        """Memory of the factor [byte], estimated: cvxopt would destroy the factor to count it."""
        return self._nbytes

    def solve(self, b: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Solve A x = b; see :meth:`axlespan.linalg.Factor.solve`."""
        return self._apply((_A,), b, out)

    def forward(self, b: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Solve C y = b; see :class:`axlespan.linalg.SplitFactor`."""
        return self._apply((_P, _L), b, out)

    def backward(self, b: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Solve Cᵀ x = b; see :class:`axlespan.linalg.SplitFactor`."""
        return self._apply((_LT, _PT), b, out)

    def _apply(self, systems: tuple[int, ...], b: FloatArray, out: FloatArray | None) -> FloatArray:
        out = right_hand_side(b, self.n, out)
        if b.size:
            x = self._dense(b)  # column-major, so a transposed copy
            for system in systems:
                self._cholmod.solve(self._factor, x, system)
            np.copyto(out, np.asarray(x).reshape(out.shape))
        return out

    def __reduce__(self) -> NoReturn:
        refuse_pickling(self.name)
