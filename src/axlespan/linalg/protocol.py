"""What every factor can do, whichever library computed it."""

from __future__ import annotations

from typing import NoReturn, Protocol, runtime_checkable

from axlespan.linalg.arrays import FloatArray


@runtime_checkable
class Factor(Protocol):
    """A factorization A = L D Lᵀ of a symmetric positive definite matrix, held and passed by the caller.

    A factor belongs to the process that made it: none can be pickled, and a worker makes its own.
    """

    @property
    def name(self) -> str:
        """The kind: ``"pardiso"``, ``"cholmod"``, ``"superlu"`` or ``"banded"``."""
        ...

    @property
    def n(self) -> int:
        """Number of equations."""
        ...

    @property
    def nbytes(self) -> int:
        """Memory of the factor [byte]."""
        ...

    def solve(self, b: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Solve A x = b.

        Parameters
        ----------
        b : ndarray, shape (n,) or (n, k)
            Right-hand sides, C-contiguous float64: side by side, k innermost.
        out : ndarray, shape of b, optional
            Where the solution goes; may be `b` itself. A new array when left out.

        Returns
        -------
        ndarray, shape of b
        """
        ...


@runtime_checkable
class SplitFactor(Factor, Protocol):
    """A factor A = C Cᵀ whose two halves can be applied alone (C includes the permutation).

    ``backward(forward(b))`` equals ``solve(b)``, and ``forward(b) @ forward(c)`` equals ``b @ solve(c)``: the
    order of the entries between the halves is the factor's own.
    """

    def forward(self, b: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Solve C y = b."""
        ...

    def backward(self, b: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Solve Cᵀ x = b."""
        ...


def refuse_pickling(name: str) -> NoReturn:
    """Raise the TypeError of a factor that someone tries to pickle or to copy."""
    raise TypeError(
        f"a {name} factor can be neither pickled nor copied: it lives in the memory of the process that "
        "computed it. Send the matrix, and let each worker call factorize()"
    )
