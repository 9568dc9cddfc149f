"""Harwell-Boeing files in and out, as Ansys writes them with HBMAT (.matrix and .mapping).

Source: Duff, Grimes, Lewis, "Users' Guide for the Harwell-Boeing Sparse Matrix Collection", CERFACS
TR/PA/92/86 (1992); Ansys Command Reference, HBMAT. Ansys writes one number to a line, (I14) and (D25.15),
the lower triangle as type RSA, a right-hand side behind it, and a mapping file with the columns Matrix Eqn,
Node, DOF.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.sparse import csc_array, csr_array, tril

from axlespan.errors import InputError
from axlespan.io.lines import Lines, load_bytes, table_of, text_of, whole
from axlespan.io.matrices.names import DofMap
from axlespan.io.matrices.triplets import check_size, square
from axlespan.model.dofs import COMPONENTS

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_FORMAT = re.compile(r"(?:\d*P,?)?(\d*)[IEDFG](\d+)(?:\.\d+)?(?:E\d+)?", re.IGNORECASE)
_BARE_EXPONENT = re.compile(
    r"(?<=[\d.])([+-]\d{3})(?!\d)"
)  # Fortran leaves out the letter before three digits
_ANSYS_NAMES = dict(zip(COMPONENTS, ("UX", "UY", "UZ", "ROTX", "ROTY", "ROTZ"), strict=True))


@dataclass(frozen=True, eq=False)
class HarwellBoeing:
    """Content of a Harwell-Boeing file."""

    title: str
    matrix: csr_array  # (n, n)
    right_hand_sides: FloatArray  # (n, n_side), none: (n, 0)


@dataclass(frozen=True)
class _Field:
    """A Fortran format: so many numbers of so many characters to a line."""

    repeat: int
    width: int


def read_harwell_boeing(path: str | PathLike[str]) -> HarwellBoeing:
    """Read an assembled real matrix (RSA, RUA or RRA), with right-hand sides where there are any.

    Raises
    ------
    InputError
        If the file is damaged, or the matrix is of another type or not square.
    """
    file = str(path)
    first, _, rest = text_of(load_bytes(path), file).partition("\n")
    rest = rest.upper().replace("D", "E")  # Fortran's double exponent
    lines = Lines(file, [first if first.strip() else "untitled", *rest.split("\n")])
    title = lines.next("title")[:72].strip()
    cards = lines.integers("line counts: total, pointers, indices, values, right-hand sides")
    if not 4 <= len(cards) <= 5 or min(cards) < 0:
        raise lines.error("must be four or five line counts (Harwell-Boeing)")
    has_sides = len(cards) == 5 and cards[4] > 0
    words = lines.next("matrix type and size").split()
    kind, size, entries = _kind(lines, words)
    fields = _fields(lines)
    sides = 0
    if has_sides:
        words = lines.next("type and number of right-hand sides").split()
        if not words or words[0][:1].upper() != "F" or len(words) < 2 or not words[1].isdecimal():
            raise lines.error("must be F and the number of right-hand sides, which are full")
        sides = int(words[1]) if len(words[1]) < 10 else -1
        if not 0 <= sides <= max(lines.remaining, 1):
            raise lines.error("must announce as many right-hand sides as the file holds")
    pointers, _ = _numbers(lines, size + 1, cards[1], fields[0], "column pointers")
    indices, index_lines = _numbers(lines, entries, cards[2], fields[1], "row indices")
    values, value_lines = _numbers(lines, entries, cards[3], fields[2], "values")
    starts = whole(pointers, np.zeros(len(pointers), dtype=np.int64), file, "column pointers")
    if starts[0] != 1 or starts[-1] != entries + 1 or np.any(np.diff(starts) < 0):
        raise lines.error(f"must have column pointers that rise from 1 to {entries + 1}", position=4)
    rows = whole(indices, index_lines, file, "row index") - 1
    columns = np.repeat(np.arange(size), np.diff(starts))
    if kind[1] == "S" and np.any(rows < columns) and np.any(rows > columns):
        i = int(np.argmax(rows < columns))
        position = int(np.searchsorted(lines.numbers, index_lines[i]))
        raise lines.error("must be in the lower triangle, as the matrix is symmetric", position=position)
    matrix = square(rows, columns, values, size, value_lines, file)
    block = np.empty((0,))
    if sides:
        block, _ = _numbers(lines, size * sides, cards[4], fields[3], "right-hand sides")
    return HarwellBoeing(title, matrix, block.reshape(sides, size).T)


def _kind(lines: Lines, words: list[str]) -> tuple[str, int, int]:
    """Type, number of rows and number of entries, from the third line."""
    kind = words[0].upper()
    if len(kind) != 3 or len(words) < 4:
        raise lines.error("must be a type and four numbers to be Harwell-Boeing: RSA 200 200 596 0")
    if kind not in ("RSA", "RUA", "RRA"):
        fix = "Export an assembled real matrix (RSA or RUA)."
        raise lines.error("is not a supported type; RSA and RUA are", fix=fix)
    sizes = table_of(words[1:4], 1)
    if sizes is None:
        raise lines.error("must have whole numbers for rows, columns and entries")
    rows, columns, entries = whole(sizes[:, 0], np.repeat(lines.numbers[2:3], 3), lines.file, "size").tolist()
    if rows != columns:
        raise lines.error("must be square: as many rows as columns")
    if entries < 0:
        raise lines.error("must count the entries by a number that is not negative")
    check_size(rows, entries, lines.place())
    return kind, rows, entries


def _fields(lines: Lines) -> list[_Field]:
    """The four Fortran formats; the last is that of the values where it is left out."""
    line = lines.next("Fortran formats")
    matches = [_FORMAT.fullmatch(text.replace(" ", "")) for text in re.findall(r"\(([^()]*)\)", line)]
    fields = [_Field(int(match[1] or 1), int(match[2])) for match in matches if match and len(match[1]) < 5]
    sound = all(1 <= field.repeat <= 1000 and 1 <= field.width <= 100 for field in fields)
    if len(fields) != len(matches) or not 3 <= len(fields) <= 4 or not sound:
        raise lines.error("must be Fortran formats for pointers, indices and values: (10I8) (10I8) (4E20.12)")
    return [*fields, fields[2]][:4]


def _numbers(lines: Lines, count: int, cards: int, field: _Field, what: str) -> tuple[FloatArray, IntArray]:
    """So many numbers in fixed columns, and the line (n,) of each."""
    if cards != -(-count // field.repeat):
        rule = f"must announce {-(-count // field.repeat)} lines of {what} for {count} numbers, not {cards}"
        raise lines.error(rule, position=1)
    start = lines.position
    chunk, numbers = lines.take(cards, what)
    rows = [line.split() for line in chunk] if field.repeat > 1 else []
    if (
        field.repeat > 1 and sum(map(len, rows)) != count
    ):  # numbers that touch are told apart by their columns
        ends = [min(len(line.rstrip()), field.width * field.repeat) for line in chunk]
        rows = [
            [line[i : i + field.width] for i in range(0, end, field.width)]
            for line, end in zip(chunk, ends, strict=True)
        ]
    words = [word for row in rows for word in row] if rows else chunk
    owner = np.repeat(np.arange(cards), [len(row) for row in rows]) if rows else np.arange(cards)
    values = table_of(words, 1)
    if values is None:
        words = [_BARE_EXPONENT.sub(r"E\1", word) for word in words]
        values = table_of(words, 1)
    if values is None:
        bad = next(i for i, word in enumerate(words) if not word.strip() or table_of([word], 1) is None)
        raise lines.error(f"must be numbers ({what})", position=start + int(owner[bad]))
    if len(values) != count:
        raise lines.error(f"must hold {count} {what}, not {len(values)}", position=start + max(0, cards - 1))
    return values[:, 0], numbers[owner]


def write_harwell_boeing(
    matrix: csr_array,
    path: str | PathLike[str],
    *,
    dofs: DofMap | None = None,
    right_hand_side: npt.ArrayLike | None = None,
    title: str = "Symmetric matrix in Harwell-Boeing format",
) -> None:
    """Write the lower triangle of a symmetric matrix as Ansys does, with 16 digits.

    Parameters
    ----------
    matrix : sparse array (n, n)
        The matrix.
    path : path
        The file; a mapping file stands beside it under the same name with the extension ``.mapping``.
    dofs : DofMap, optional
        Node and component of each row; without it no mapping file is written.
    right_hand_side : array (n,), optional
        A load vector.
    title : str
        First line, at most 72 characters.
    """
    lower = csc_array(tril(matrix, format="csc"))
    lower.sort_indices()
    size = int(matrix.shape[0])
    side = np.empty(0) if right_hand_side is None else np.asarray(right_hand_side, dtype=np.float64)
    if side.size not in (0, size):
        raise InputError(f"must have {size} numbers", field="right_hand_side", value=side.shape)
    counts = (size + 1, lower.nnz, lower.nnz, side.size)
    lines = [
        f"{title[:72]:<80}",
        "".join(f"{number:14d}" for number in (sum(counts), *counts)),
        f"{'RSA':<14}" + "".join(f"{number:14d}" for number in (size, size, lower.nnz, 0)),
        f"{'(I14)':<16}{'(I14)':<16}{'(D25.15)':<20}{'(D25.15)':<20}",
    ]
    if side.size:
        lines.append(f"{'F':<14}{1:14d}{size:14d}")
    lines += [f"{number:14d}" for part in (lower.indptr, lower.indices) for number in (part + 1).tolist()]
    lines += [f"{value:25.15E}".replace("E", "D") for part in (lower.data, side) for value in part.tolist()]
    Path(path).write_text("\n".join(lines) + "\n", encoding="ascii", errors="replace")
    if dofs is not None:
        rows = [
            f"{row:14d}{node:14d}    {_ANSYS_NAMES.get(component, component.upper()):<4}"
            for row, (node, component) in enumerate(dofs.names, start=1)
        ]
        head = f"{'Matrix Eqn':>14}{'Node':>14}    {'DOF':<8}"
        Path(path).with_suffix(".mapping").write_text("\n".join([head, *rows]) + "\n", encoding="ascii")
