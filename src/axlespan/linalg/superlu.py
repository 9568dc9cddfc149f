"""SciPy's SuperLU in symmetric mode: always there, for matrices without a narrow band."""

from __future__ import annotations

from typing import NoReturn

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from axlespan.linalg.arrays import CsrMatrix, FloatArray, right_hand_side
from axlespan.linalg.definiteness import PivotBreakdown
from axlespan.linalg.protocol import refuse_pickling


class SuperLUFactor:
    """A = L U with diagonal pivots only, so that U = D Lᵀ.

    Parameters
    ----------
    matrix : csr_array, shape (n, n)
        Symmetric matrix in canonical form.

    Raises
    ------
    PivotBreakdown
        When a pivot, an entry of the diagonal of U, is not positive.
    """

    name = "superlu"

    def __init__(self, matrix: CsrMatrix) -> None:
        self.n: int = matrix.shape[0]
        csc = sp.csc_array(matrix.T)  # the same matrix, by columns without a copy
        try:
            self._lu = splu(
                csc, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
            )
        except RuntimeError as error:  # "Factor is exactly singular"
            raise PivotBreakdown(str(error)) from error
        if not np.array_equal(self._lu.perm_r, self._lu.perm_c):
            raise PivotBreakdown("a pivot on the diagonal is zero")
        if not (self._lu.U.diagonal() > 0.0).all():
            raise PivotBreakdown("a pivot is not positive")

    @property
    def nbytes(self) -> int:
        """Memory of the factor [byte]: SuperLU's own L and U, and the copy read for the pivots."""
        return int(self._lu.nnz) * (8 + 8 + 4)

    def solve(self, b: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Solve A x = b; see :meth:`axlespan.linalg.Factor.solve`."""
        out = right_hand_side(b, self.n, out)
        if b.size:
            np.copyto(out, self._lu.solve(b))
        return out

    def __reduce__(self) -> NoReturn:
        refuse_pickling(self.name)
