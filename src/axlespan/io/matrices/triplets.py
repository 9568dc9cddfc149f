"""Square matrices from triplets of row, column and value; half of a symmetric one is enough."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_array, csr_array, tril, triu

from axlespan.errors import InputError, Place
from axlespan.io.lines import at

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


def check_size(size: int, entries: int, place: Place) -> None:
    """Refuse a size that the file's entries cannot fill, before memory is asked for it.

    Raises
    ------
    InputError
        If the size is not positive or beyond 1000 and a hundred times the number of entries.
    """
    if not 0 < size <= 1000 + 100 * entries:
        rule = f"must fit the {entries} entries of the matrix"
        raise InputError(rule, field="number of rows", value=size, place=place)


def square(
    rows: IntArray, columns: IntArray, values: FloatArray, size: int, lines: IntArray, file: str
) -> csr_array:
    """A matrix (size, size) from triplets that count from 0; entries at one place add up.

    Where of every two places (i, j) and (j, i) only one has an entry, the matrix is half of a symmetric one
    and is completed: lower, upper or mixed. Otherwise it is taken as it is.

    Parameters
    ----------
    rows, columns, values : array (n,)
        Triplets.
    size : int
        Number of rows and columns.
    lines : array (n,)
        Line numbers of the triplets, for errors.
    file : str
        Name of the file, for errors.

    Raises
    ------
    InputError
        If a row or column is beyond the size or a value isn't finite.
    """
    bad = (rows < 0) | (rows >= size) | (columns < 0) | (columns >= size)
    if bad.any():
        i = int(np.flatnonzero(bad)[0])
        entry = (int(rows[i]) + 1, int(columns[i]) + 1)
        raise InputError(
            f"must lie between 1 and {size}", field="row and column", value=entry, place=at(file, lines[i])
        )
    if not np.isfinite(values).all():
        i = int(np.flatnonzero(~np.isfinite(values))[0])
        raise InputError(
            "must be finite", field="matrix entry", value=float(values[i]), place=at(file, lines[i])
        )
    matrix = csr_array(coo_array((values, (rows, columns)), shape=(size, size)))
    lower, upper = csr_array(tril(matrix, -1)), csr_array(triu(matrix, 1))
    if overlap(lower, csr_array(upper.T)):
        return matrix
    return csr_array(matrix + lower.T + upper.T)


def overlap(first: csr_array, second: csr_array) -> bool:
    """Whether two matrices have an entry, be it zero, at the same place."""
    if not first.nnz or not second.nnz:
        return False
    ones = [
        csr_array((np.ones(m.nnz, dtype=np.int8), m.indices, m.indptr), shape=m.shape)
        for m in (first, second)
    ]
    return bool(ones[0].multiply(ones[1]).nnz)
