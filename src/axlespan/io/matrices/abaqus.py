"""Matrices that Abaqus writes as text (*MATRIX OUTPUT), in and out.

Read are the layouts MATRIX INPUT and LABELS (row node, d.o.f., column node, d.o.f., value) and COORDINATE
(row, column, value), all entries or one triangle.

Source: Abaqus Analysis Guide, "Generating matrices"; Abaqus Keywords Guide, *MATRIX OUTPUT and *MATRIX INPUT.
A d.o.f. held by a boundary condition has 1e36 on the diagonal of the stiffness; nodes inside elements have
negative numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_array, tril

from axlespan.errors import InputError
from axlespan.io.lines import Lines, load_bytes, text_of, whole
from axlespan.io.matrices.names import DofMap
from axlespan.io.matrices.triplets import check_size, square
from axlespan.model.dofs import COMPONENTS

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Diagonal entry by which Abaqus holds a d.o.f.
HELD = 1e36
# Abaqus Analysis Guide, "Conventions"; others are called dof12, …
_COMPONENTS = {**dict(enumerate(COMPONENTS, start=1)), 7: "warp", 8: "pres", 11: "temp"}


@dataclass(frozen=True, eq=False)
class NodalEntries:
    """Entries of a matrix by nodes and d.o.f. numbers."""

    file: str
    rows: IntArray  # (n, 2) node, d.o.f.
    columns: IntArray  # (n, 2)
    values: FloatArray  # (n,)
    lines: IntArray  # (n,)


def read_abaqus_entries(path: str | PathLike[str], size: int | None = None) -> NodalEntries | csr_array:
    """Read the entries of a matrix by nodes; a COORDINATE file has none and gives the matrix.

    Parameters
    ----------
    path : path
        The file.
    size : int, optional
        Number of rows for a COORDINATE file, which doesn't tell it; the highest row when left out.

    Raises
    ------
    InputError
        If a line is malformed.
    """
    lines = _data(path)
    width = len(lines.lines[0].replace(",", " ").split())
    if width == 6:
        fix = "Leave out ELEMENT BY ELEMENT, so that Abaqus assembles the matrix."
        raise lines.error("is a matrix by elements, which is not supported", position=0, fix=fix)
    if width not in (3, 5):
        rule = "must be row, column, value; or node, d.o.f., node, d.o.f., value (Abaqus *MATRIX OUTPUT)"
        raise lines.error(rule, position=0)
    table, numbers = lines.table(lines.remaining, width, "matrix entry", ",")
    indices = whole(table[:, :-1], numbers, lines.file, "row and column")
    if width == 3:
        size = int(indices.max()) if size is None else size
        check_size(size, len(indices), lines.place())
        return square(indices[:, 0] - 1, indices[:, 1] - 1, table[:, 2], size, numbers, lines.file)
    rows, columns = indices[:, :2], indices[:, 2:]
    for pair in (rows, columns):
        bad = (pair[:, 0] == 0) | (pair[:, 1] < 1) | (pair[:, 1] > 999)
        if bad.any():
            raise lines.error("must name nodes other than 0 and d.o.f. from 1", position=int(np.argmax(bad)))
    return NodalEntries(lines.file, rows, columns, table[:, -1], numbers)


def _data(path: str | PathLike[str]) -> Lines:
    """Data lines; comments and keyword lines, which begin with *, are left out."""
    file = str(path)
    text = text_of(load_bytes(path), file).upper().replace("D", "E")  # Fortran's double exponent
    every = Lines(file, text.split("\n"))
    if "*" in text:
        kept = [i for i, line in enumerate(every.lines) if line.lstrip()[0] != "*"]
        every.lines, every.numbers = [every.lines[i] for i in kept], every.numbers[kept]
    if not every.lines:
        raise every.error("has no entries")
    return every


def matrices_of(parts: Sequence[NodalEntries]) -> tuple[DofMap, list[csr_array]]:
    """The d.o.f. of some matrices together, nodes in ascending order, and the matrices.

    Nodes inside elements come last.
    """
    pairs = np.concatenate([np.concatenate([part.rows, part.columns]) for part in parts])
    keys, member = np.unique(pairs[:, 0] * 1000 + pairs[:, 1], return_inverse=True)  # d.o.f. are below 1000
    distinct = np.column_stack(np.divmod(keys, 1000))
    order = np.argsort(distinct[:, 0] < 0, kind="stable")
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    names = distinct[order]
    dofs = DofMap(
        names[:, 0], tuple(_COMPONENTS.get(number, f"dof{number}") for number in names[:, 1].tolist())
    )
    matrices, start = [], 0
    for part in parts:
        count = len(part.values)
        rows, columns = rank[member.reshape(-1)[start : start + 2 * count]].reshape(2, count)
        matrices.append(square(rows, columns, part.values, len(dofs), part.lines, part.file))
        start += 2 * count
    return dofs, matrices


def held_rows(stiffness: csr_array) -> IntArray:
    """Rows that Abaqus holds by a huge diagonal entry."""
    return np.flatnonzero(stiffness.diagonal() >= 0.99 * HELD)


def write_abaqus(
    matrix: csr_array, path: str | PathLike[str], dofs: DofMap | None = None, *, layout: str = "matrix-input"
) -> None:
    """Write the lower triangle of a symmetric matrix as Abaqus does, with 16 digits.

    Parameters
    ----------
    matrix : sparse array (n_dof, n_dof)
        The matrix.
    path : path
        The file.
    dofs : DofMap
        Node and component of each row; not needed for coordinates.
    layout : {"matrix-input", "coordinate"}
        ``node,dof, node,dof, value`` or ``row column value``.

    Raises
    ------
    InputError
        If the layout is another, or a component has no number in Abaqus.
    """
    lower = tril(matrix, format="coo")
    values = [f"{value:.15e}" for value in lower.data.tolist()]
    if layout == "coordinate":
        names = [str(row + 1) for row in range(matrix.shape[0])]
        pattern = "{} {} {}"
    elif layout == "matrix-input" and dofs is not None:
        numbers = {name: number for number, name in _COMPONENTS.items()}
        numbers |= {
            name: int(name[3:]) for name in dofs.components if name[:3] == "dof" and name[3:].isdecimal()
        }
        unknown = [name for name in dofs.components if name not in numbers]
        if unknown:
            raise InputError("has no number in Abaqus", field="component", value=unknown[0])
        names = [f"{node},{numbers[component]}" for node, component in dofs.names]
        pattern = "{}, {}, {}"
    else:
        rule = "must be 'matrix-input' with a d.o.f. map, or 'coordinate'"
        raise InputError(rule, field="layout", value=layout)
    rows = zip(lower.row.tolist(), lower.col.tolist(), values, strict=True)
    text = "\n".join(pattern.format(names[row], names[column], value) for row, column, value in rows)
    Path(path).write_text(text + "\n", encoding="ascii")
