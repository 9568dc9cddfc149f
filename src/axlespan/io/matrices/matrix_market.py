"""Matrix Market files in and out (.mtx).

Source: Boisvert, Pozo, Remington, "The Matrix Market Exchange Formats: Initial Design", NISTIR 5935 (1996).
"""

from __future__ import annotations

from os import PathLike
from pathlib import Path

import numpy as np
from scipy.sparse import csr_array, tril

from axlespan.io.lines import Lines, whole
from axlespan.io.matrices.triplets import check_size, square

_FIX = "Export it as: %%MatrixMarket matrix coordinate real symmetric (or general)."


def read_matrix_market(path: str | PathLike[str]) -> csr_array:
    """Read a square real matrix: coordinate or array; symmetric, or general with all or half of its entries.

    Raises
    ------
    InputError
        If the file is damaged, or complex, skew, a pattern or not square.
    """
    lines = Lines.of_file(path)
    words = lines.next("header").lower().split()
    if len(words) != 5 or words[0] != "%%matrixmarket" or words[1] != "matrix":
        raise lines.error(
            "must begin with %%MatrixMarket matrix and three words to be a Matrix Market file", fix=_FIX
        )
    layout, kind, symmetry = words[2:]
    allowed = {"layout": (layout, ("coordinate", "array")), "type": (kind, ("real", "integer", "double"))}
    allowed["symmetry"] = (symmetry, ("general", "symmetric"))
    for what, (word, choices) in allowed.items():
        if word not in choices:
            raise lines.error(f"must have the {what} {' or '.join(choices)}", fix=_FIX)
    while lines.remaining and lines.lines[lines.position].lstrip().startswith("%"):
        lines.position += 1
    sizes = lines.integers("rows, columns and entries", 3 if layout == "coordinate" else 2)
    if sizes[0] != sizes[1]:
        raise lines.error("must be square: as many rows as columns")
    size, place = sizes[0], lines.place()
    if layout == "array":
        return _dense(lines, size, symmetry)
    lines.require(sizes[2], "entries")
    check_size(size, sizes[2], place)
    table, numbers = lines.table(sizes[2], 3, "row, column and value")
    lines.finish("entries")
    indices = whole(table[:, :2], numbers, lines.file, "row and column") - 1
    return square(indices[:, 0], indices[:, 1], table[:, 2], size, numbers, lines.file)


def _dense(lines: Lines, size: int, symmetry: str) -> csr_array:
    """All entries, or those of the lower triangle, column by column."""
    count = size * size if symmetry == "general" else size * (size + 1) // 2
    lines.require(count, "entries")
    values, numbers = lines.table(count, 1, "value")
    lines.finish("entries")
    columns, rows = np.divmod(np.arange(size * size), max(size, 1))
    if symmetry == "symmetric":
        half = rows >= columns
        rows, columns = rows[half], columns[half]
    check_size(size, count, lines.place())
    return square(rows, columns, values[:, 0], size, numbers, lines.file)


def write_matrix_market(matrix: csr_array, path: str | PathLike[str]) -> None:
    """Write a symmetric matrix: coordinate real symmetric, the lower triangle, 17 digits."""
    lower = tril(matrix, format="coo")
    rows = (
        f"{row} {column} {value:.17g}"
        for row, column, value in zip(
            (lower.row + 1).tolist(), (lower.col + 1).tolist(), lower.data.tolist(), strict=True
        )
    )
    head = [
        "%%MatrixMarket matrix coordinate real symmetric",
        f"{matrix.shape[0]} {matrix.shape[1]} {lower.nnz}",
    ]
    Path(path).write_text("\n".join([*head, *rows]) + "\n", encoding="ascii")
