"""Small tables beside matrices: node coordinates and d.o.f. maps, as CSV or as Ansys writes them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from os import PathLike
from pathlib import Path
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.io.lines import LARGEST_INTEGER, Lines, table_of
from axlespan.io.matrices.names import DofMap, NodeTable
from axlespan.io.meshes.assemble import LARGEST_COORDINATE
from axlespan.model.dofs import COMPONENTS

IntArray = npt.NDArray[np.int64]

_SEPARATOR = re.compile(r"[,;\s]+")

_COMPONENT_OF: Mapping[str, str] = MappingProxyType(
    {
        word: name
        for words in (
            "x y z rx ry rz",
            "ux uy uz rotx roty rotz",  # Ansys
            "1 2 3 4 5 6",  # Abaqus
            "u1 u2 u3 ur1 ur2 ur3",  # Abaqus
            "u1 u2 u3 r1 r2 r3",  # SAP2000
            "dx dy dz rx ry rz",  # midas
        )
        for word, name in zip(words.split(), COMPONENTS, strict=True)
    }
)


def component_of(word: str) -> str:
    """Component that a program's word stands for; its own word in lower case if it is none of the six.

    >>> component_of("ROTX"), component_of("3"), component_of("TEMP")
    ('rx', 'z', 'temp')
    """
    return _COMPONENT_OF.get(word.lower(), word.lower())


def rows_of(lines: Lines) -> Iterator[list[str]]:
    """Words of each line, apart from a heading and comments (#)."""
    first = True
    while lines.remaining:
        words = _SEPARATOR.split(lines.next("rows").strip().strip(",;"))
        words = [word.strip('"') for word in words]
        heading = first and table_of([words[0]], 1) is None
        if not words[0].startswith("#") and not heading:
            yield words
        first = first and words[0].startswith("#")


def whole_number(lines: Lines, word: str, what: str) -> int:
    """A whole number in the line read last."""
    values = table_of([word], 1)
    value = float(values[0, 0]) if values is not None else np.nan
    if not (abs(value) <= LARGEST_INTEGER and value == np.floor(value)):
        raise lines.error(f"must have a whole number ({what})")
    return int(value)


def read_coordinates(path: str | PathLike[str]) -> NodeTable:
    """Read node coordinates: lines ``node, x, y, z``, which the names of sets may follow.

    Commas, semicolons or blanks separate; a heading and lines with # are passed over.

    Raises
    ------
    InputError
        If a line is malformed, a node occurs twice or a coordinate is impossible.
    """
    lines = Lines.of_file(path)
    labels: dict[int, list[float]] = {}
    sets: dict[str, list[int]] = {}
    for words in rows_of(lines):
        values = table_of(words[1:4], 1) if len(words) >= 4 else None
        if values is None or not np.all(np.abs(values) <= LARGEST_COORDINATE):
            fix = f"Coordinates are finite and at most {LARGEST_COORDINATE:g} m."
            raise lines.error("must be a node and three coordinates: 12, 3.5, 0.0, 1.2", fix=fix)
        node = whole_number(lines, words[0], "node")
        if node in labels:
            raise lines.error("is a node that stands there already")
        labels[node] = values[:, 0].tolist()
        for name in words[4:]:
            sets.setdefault(name, []).append(node)
    if not labels:
        raise lines.error("has no nodes")
    points = np.array(list(labels.values()))
    named = {name: np.array(nodes, dtype=np.int64) for name, nodes in sets.items()}
    return NodeTable(np.array(list(labels), dtype=np.int64), points, named)


def read_dof_map(path: str | PathLike[str]) -> DofMap:
    """Read a d.o.f. map: lines ``row, node, component``; rows count from 1, in any order.

    The mapping file of Ansys (HBMAT, ``Matrix Eqn  Node  DOF``) is such a table. Components are named as in
    `axlespan` (x, y, z, rx, ry, rz), Ansys (UX … ROTZ), Abaqus (1 … 6) or SAP2000 (U1 … R3).

    Raises
    ------
    InputError
        If a line is malformed, or rows or d.o.f. are missing or occur twice.
    """
    lines = Lines.of_file(path)
    rows: dict[int, tuple[int, str]] = {}
    seen: set[tuple[int, str]] = set()
    for words in rows_of(lines):
        if len(words) != 3:
            raise lines.error("must be a row, a node and a component: 7, 12, z")
        row, node = whole_number(lines, words[0], "row"), whole_number(lines, words[1], "node")
        name = (node, component_of(words[2]))
        if row in rows or name in seen:
            raise lines.error(f"repeats {f'row {row}' if row in rows else f'd.o.f. {node}.{name[1]}'}")
        if row < 1:
            raise lines.error("must count rows from 1")
        rows[row] = name
        seen.add(name)
    if not rows:
        raise lines.error("has no rows")
    if max(rows) != len(rows):
        missing = next(row for row in range(1, len(rows) + 1) if row not in rows)
        raise InputError("is missing", field="d.o.f. map, row", value=missing, place=lines.place())
    ordered = [rows[row] for row in range(1, len(rows) + 1)]
    return DofMap(np.array([node for node, _ in ordered], dtype=np.int64), tuple(name for _, name in ordered))


def write_coordinates(table: NodeTable, path: str | PathLike[str]) -> None:
    """Write node coordinates as CSV: ``node,x,y,z``, and the names of the node's sets."""
    names: dict[int, list[str]] = {}
    for name, nodes in table.sets.items():
        for node in nodes.tolist():
            names.setdefault(node, []).append(name)
    rows = (
        ",".join([str(label), f"{x:.17g}", f"{y:.17g}", f"{z:.17g}", *names.get(label, ())])
        for label, (x, y, z) in zip(table.labels.tolist(), table.points.tolist(), strict=True)
    )
    Path(path).write_text("\n".join(["node,x,y,z,sets", *rows]) + "\n", encoding="utf-8")


def write_dof_map(dofs: DofMap, path: str | PathLike[str]) -> None:
    """Write a d.o.f. map as CSV: ``row,node,component``."""
    rows = (f"{row},{node},{component}" for row, (node, component) in enumerate(dofs.names, start=1))
    Path(path).write_text("\n".join(["row,node,component", *rows]) + "\n", encoding="utf-8")
