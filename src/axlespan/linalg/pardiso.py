"""PARDISO of Intel's Math Kernel Library, called directly: the fastest factor of large solid models."""

from __future__ import annotations

import ctypes
import threading
import weakref
from collections.abc import Iterator
from typing import NoReturn

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.errors import AnalysisError, InputError
from axlespan.linalg.arrays import CsrMatrix, FloatArray, right_hand_side
from axlespan.linalg.definiteness import PivotBreakdown
from axlespan.linalg.mkl_library import find_mkl, load_mkl
from axlespan.linalg.protocol import refuse_pickling

Int64Array = npt.NDArray[np.int64]

_SPD = 2  # matrix type: real, symmetric, positive definite
_ANALYZE_AND_FACTORIZE, _SOLVE, _FORWARD, _BACKWARD, _RELEASE = 12, 33, 331, 333, -1
_BAD_PIVOT = -4

# The error codes of pardiso, Intel oneMKL developer reference for C.
_ERRORS = {
    -1: "its input is inconsistent",
    -2: "there is not enough memory",
    -3: "the reordering failed",
    -4: "a pivot is not positive",
    -5: "an internal error occurred",
    -6: "the reordering failed",
    -7: "the diagonal matrix is singular",
    -8: "an integer overflowed",
    -9: "there is not enough memory for the out-of-core mode",
    -10: "its temporary files could not be opened",
    -11: "its temporary files could not be read or written",
    -12: "a 64-bit call was made in a 32-bit library",
    -13: "it was interrupted",
    -15: "an internal error occurred",
}


def installed() -> bool:
    """Whether the library is there (it is not loaded by asking)."""
    return find_mkl() is not None


class PardisoFactor:
    """Cholesky factor A = C Cᵀ by PARDISO, fill reduced by nested dissection.

    PARDISO reads and writes at the addresses that it is given, without a check. All that it is given here is
    made here: the upper triangle with sorted columns and a stored diagonal, and aligned work arrays for
    right-hand sides and solutions. A lock keeps two threads from sharing them.

    Parameters
    ----------
    matrix : csr_array, shape (n, n)
        Symmetric matrix in canonical form.
    threads : int, optional
        Threads of MKL that a call of this factor may use; other users of MKL in the process keep their own
        number. With the same number on the same machine, the same input gives the same numbers.

    Raises
    ------
    InputError
        When the library is not installed, or `threads` is not positive.
    PivotBreakdown
        When a pivot is not positive.
    AnalysisError
        When PARDISO fails for another reason, such as a lack of memory.
    """

    name = "pardiso"

    def __init__(self, matrix: CsrMatrix, threads: int = 1) -> None:
        if threads < 1:
            raise InputError("must be at least 1", field="threads", value=threads)
        try:
            self._library = load_mkl()
        except OSError as error:
            raise InputError(
                f"needs Intel's MKL ({error})", field="kind", value=self.name, fix="Write pip install mkl."
            ) from error
        self.n: int = matrix.shape[0]
        self.threads = int(threads)
        self._lock = threading.Lock()
        self._values, self._row_starts, self._columns = _upper_triangle(matrix)
        self._work = _aligned((2, 1, self.n))  # right-hand sides, solutions
        self._handle = np.zeros(64, dtype=np.int64)
        self._iparm = _parameters(self.threads)
        self._close = weakref.finalize(self, _release, self._library, self._handle, self.n)
        error_code = self._call(_ANALYZE_AND_FACTORIZE, 1)
        if error_code != 0:
            pivot = int(self._iparm[29])
            self.close()
            if error_code == _BAD_PIVOT:
                raise PivotBreakdown(f"pivot {pivot} of {self.n} is not positive")
            raise _failure("factorize", error_code, self.n)

    @property
    def nbytes(self) -> int:
        """Memory of the factor [byte]: PARDISO's own, and the upper triangle that it keeps looking at."""
        own = 1024 * int(self._iparm[15] + self._iparm[16])
        return own + sum(a.nbytes for a in (self._values, self._row_starts, self._columns, self._work))

    @property
    def entries(self) -> int:
        """Number of entries of the factor."""
        return int(self._iparm[17])

    def solve(self, b: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Solve A x = b; see :meth:`axlespan.linalg.Factor.solve`."""
        return self._apply(_SOLVE, b, out)

    def forward(self, b: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Solve C y = b; see :class:`axlespan.linalg.SplitFactor`."""
        return self._apply(_FORWARD, b, out)

    def backward(self, b: FloatArray, out: FloatArray | None = None) -> FloatArray:
        """Solve Cᵀ x = b; see :class:`axlespan.linalg.SplitFactor`."""
        return self._apply(_BACKWARD, b, out)

    def close(self) -> None:
        """Give the memory back; also done when the factor is no longer referenced."""
        with self._lock:
            self._close()

    def _apply(self, phase: int, b: FloatArray, out: FloatArray | None) -> FloatArray:
        out = right_hand_side(b, self.n, out)
        count = 1 if b.ndim == 1 else b.shape[1]
        if count == 0:
            return out
        with self._lock:
            if not self._close.alive:
                raise InputError("is closed", field="factor", fix="Factorize the matrix again.")
            if self._work.shape[1] < count:
                self._work = _aligned((2, count, self.n))
            columns = b.reshape(self.n, count)
            for rows in _blocks(self.n, count):
                self._work[0, :count, rows] = columns[rows].T
            error_code = self._call(phase, count)
            if error_code != 0:
                raise _failure("solve", error_code, self.n)
            columns = out.reshape(self.n, count)
            for rows in _blocks(self.n, count):
                columns[rows] = self._work[1, :count, rows].T
        return out

    def _call(self, phase: int, count: int) -> int:
        before = self._library.MKL_Set_Num_Threads_Local(self.threads)
        try:
            return _pardiso(
                self._library, self._handle, phase, self.n, count, self._iparm,
                (self._values, self._row_starts, self._columns), (self._work[0], self._work[1]),
            )  # fmt: skip
        finally:
            self._library.MKL_Set_Num_Threads_Local(before)

    def __reduce__(self) -> NoReturn:
        refuse_pickling(self.name)


def _parameters(threads: int) -> Int64Array:
    """Return PARDISO's ``iparm``, counted from 0."""
    iparm = np.zeros(64, dtype=np.int64)
    iparm[0] = 1  # no defaults
    iparm[1] = 2  # nested dissection
    iparm[7] = 0  # no iterative refinement: two steps would double the time of a solve
    iparm[17] = -1  # report the number of entries
    iparm[26] = 1  # check the matrix
    iparm[33] = threads  # the same numbers at every run, for this number of threads
    iparm[34] = 1  # indices count from 0
    return iparm


def _upper_triangle(matrix: CsrMatrix) -> tuple[FloatArray, Int64Array, Int64Array]:
    """Values, row starts and columns as PARDISO wants them, checked."""
    upper = sp.csr_array(sp.triu(matrix, format="csr"))
    upper.sort_indices()
    values = np.ascontiguousarray(upper.data, dtype=np.float64)
    starts, columns = (np.ascontiguousarray(a, dtype=np.int64) for a in (upper.indptr, upper.indices))
    n = matrix.shape[0]
    stored = np.diff(starts) > 0
    if not stored.all() or not np.array_equal(columns[starts[:-1]], np.arange(n)):
        raise InputError("must store every entry of its diagonal", field="matrix")
    return values, starts, columns


def _pardiso(
    library: ctypes.CDLL,
    handle: Int64Array,
    phase: int,
    n: int,
    count: int,
    iparm: Int64Array,
    matrix: tuple[FloatArray, Int64Array, Int64Array],
    work: tuple[FloatArray, FloatArray],
) -> int:
    """Call ``pardiso_64`` and return its error code."""
    # maxfct, mnum, mtype, phase, n, nrhs, msglvl, error
    scalars = np.array([1, 1, _SPD, phase, n, count, 0, 0], dtype=np.int64)
    address = [scalars.ctypes.data + 8 * i for i in range(scalars.size)]
    values, starts, columns = (a.ctypes.data for a in matrix)
    library.pardiso_64(
        handle.ctypes.data, *address[:5], values, starts, columns, None, address[5], iparm.ctypes.data,
        address[6], work[0].ctypes.data, work[1].ctypes.data, address[7],
    )  # fmt: skip
    return int(scalars[7])


def _release(library: ctypes.CDLL, handle: Int64Array, n: int) -> None:
    nothing = np.zeros(1)
    indices = np.zeros(1, dtype=np.int64)
    _pardiso(library, handle, _RELEASE, n, 1, _parameters(1), (nothing, indices, indices), (nothing, nothing))


def _failure(action: str, code: int, n: int) -> AnalysisError:
    reason = _ERRORS.get(code, "of an unknown error")
    return AnalysisError(
        f"PARDISO could not {action} a matrix of {n} equations: {reason} (code {code}). "
        "Choose another solver, for instance kind='superlu', or a coarser mesh"
    )


def _blocks(n: int, count: int) -> Iterator[slice]:
    """Rows in portions that are transposed within the cache: three times as fast as all at once."""
    size = n if count == 1 else 512
    return (slice(start, start + size) for start in range(0, n, size))


def _aligned(shape: tuple[int, ...]) -> FloatArray:
    """Return an array that starts at a multiple of 64 bytes, which MKL's reproducibility asks for."""
    size = int(np.prod(shape))
    raw = np.empty(size + 8)
    start = (-raw.ctypes.data % 64) // 8
    return raw[start : start + size].reshape(shape)
