"""Sparse matrices as SciPy writes them (scipy.sparse.save_npz)."""

from __future__ import annotations

import io
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.sparse import bsr_array, coo_array, csc_array, csr_array, dia_array, save_npz

from axlespan.errors import InputError, Place
from axlespan.io.lines import load_bytes
from axlespan.io.matrices.triplets import check_size, square

_FIX = "Write it with scipy.sparse.save_npz."


def load_arrays(path: str | PathLike[str], fix: str) -> dict[str, npt.NDArray[Any]]:
    """All arrays of an npz file; it may not hold Python objects.

    Raises
    ------
    InputError
        If the file is damaged.
    """
    data, file = load_bytes(path), str(path)
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            return {name: np.asarray(archive[name]) for name in archive.files}
    except Exception as error:  # whatever a damaged archive makes zipfile, zlib or numpy raise
        rule = f"cannot be read as an npz archive ({type(error).__name__})"
        raise InputError(rule, place=Place(file), fix=fix) from None


def read_npz(path: str | PathLike[str]) -> csr_array:
    """Read a square matrix that `scipy.sparse.save_npz` wrote: full, or one triangle of a symmetric one.

    Raises
    ------
    InputError
        If the file is damaged or the matrix is not square and real.
    """
    file, arrays = str(path), load_arrays(path, _FIX)
    try:
        matrix = _sparse(arrays)
    except Exception as error:  # shapes, types or indices that don't fit each other
        rule = f"does not hold a sparse matrix ({type(error).__name__}: {str(error)[:80]})"
        raise InputError(rule, place=Place(file), fix=_FIX) from None
    if matrix.shape[0] != matrix.shape[1]:
        raise InputError("must be square", field="matrix", value=matrix.shape, place=Place(file))
    check_size(matrix.shape[0], matrix.nnz, Place(file))
    none = np.zeros(matrix.nnz, dtype=np.int64)
    row, column = matrix.row.astype(np.int64), matrix.col.astype(np.int64)
    return square(row, column, matrix.data.astype(np.float64), matrix.shape[0], none, file)


def _sparse(arrays: dict[str, npt.NDArray[Any]]) -> coo_array:
    """The matrix, its indices checked: SciPy's own loader trusts them."""
    layout = arrays["format"].item()
    name = layout.decode("ascii") if isinstance(layout, bytes) else str(layout)
    rows, columns = (int(n) for n in arrays["shape"].tolist())
    data = arrays["data"]
    if not (np.issubdtype(data.dtype, np.floating) or np.issubdtype(data.dtype, np.integer)):
        raise TypeError(f"entries are {data.dtype}")
    check_size(max(rows, columns), data.size, Place("npz"))
    if name == "coo":
        return coo_array((data, (arrays["row"], arrays["col"])), shape=(rows, columns))
    if name == "dia":
        return dia_array((data, arrays["offsets"]), shape=(rows, columns)).tocoo()
    kinds: dict[str, Any] = {"csr": csr_array, "csc": csc_array, "bsr": bsr_array}
    compressed = kinds[name]((data, arrays["indices"], arrays["indptr"]), shape=(rows, columns))
    compressed.check_format(full_check=True)
    return coo_array(compressed)


def write_npz(matrix: csr_array, path: str | PathLike[str]) -> None:
    """Write a matrix with `scipy.sparse.save_npz`, under just this name."""
    with Path(path).open("wb") as stream:
        save_npz(stream, csr_array(matrix))
