r"""Running lines over matrices: the vertical displacement between nodes, interpolated from their d.o.f.

Between two nodes at a distance L, with t from one to the other and ξ from 0 to 1, displacements along t are
linear and those across it cubic by the rotations θ:

.. math::
   u(ξ) &= t\,t^T [(1-ξ) u_1 + ξ u_2]
           + (1 - t\,t^T) [(1 - 3ξ^2 + 2ξ^3) u_1 + (3ξ^2 - 2ξ^3) u_2] \\
        &\quad + L\,[(ξ - 2ξ^2 + ξ^3)\, θ_1 + (ξ^3 - ξ^2)\, θ_2] \times t

That is exact for thin beams. Without rotations all is linear, which is exact along edges of linear solids.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.io.lines import Lines, table_of
from axlespan.model.dofs import COMPONENTS
from axlespan.running.path import PolynomialPath
from axlespan.study.case_matrices import MatricesLine
from axlespan.study.matrix_body import RowBook

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Powers of ξ: linear functions of the two ends, cubic ones, and those of the slopes.
_LINEAR = np.array([[1.0, -1.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]])
_CUBIC = np.array([[1.0, 0.0, -3.0, 2.0], [0.0, 0.0, 3.0, -2.0]])
_SLOPE = np.array([[0.0, 1.0, -2.0, 1.0], [0.0, 0.0, -1.0, 1.0]])


@dataclass(frozen=True, eq=False)
class Stations:
    """Points of a line and the rows of the d.o.f. there, -1 where there is none."""

    points: FloatArray  # (k, 3) [m]
    positions: FloatArray  # (k,) along the line [m]
    rows: Mapping[str, IntArray]  # (k,) by component


def path_over(case: MatricesLine, book: RowBook, place: str) -> tuple[PolynomialPath, str]:
    """A running line in the rows of the matrices, and how it is interpolated, in words.

    Raises
    ------
    InputError
        If nodes or d.o.f. are not there, or the line has no vertical d.o.f.
    """
    by_nodes = case.nodes is not None
    stations = _of_nodes(case, book, f"{place}.nodes") if by_nodes else _of_dofs(case, book, place)
    vertical = stations.rows["z"]
    if np.all(vertical < 0):
        raise InputError("has no vertical d.o.f. at any of its nodes", field=place)
    cubic = _is_cubic(case, stations, place)
    held = int(np.count_nonzero(vertical < 0))
    words = f"{len(vertical)} nodes, {'cubic by their rotations' if cubic else 'linear'}"
    if held:
        words += f"; {held} of them have no vertical d.o.f. and are held"
    return _path(stations, cubic), words


def _of_nodes(case: MatricesLine, book: RowBook, place: str) -> Stations:
    if not book.is_named:
        raise InputError("needs dofs: which d.o.f. the rows are", field=place, fix="Add dofs: rows.csv")
    if not book.has_places:
        fix = "Add coordinates: nodes.csv, or write {dofs: [12.z, ...], positions: [0 m, ...]}"
        raise InputError("needs coordinates of the nodes", field=place, fix=fix)
    assert case.nodes is not None  # the caller has looked
    if isinstance(case.nodes, tuple):
        chain = np.array([book.nodes.one(word, f"{place}.{i}") for i, word in enumerate(case.nodes)])
        if len(chain) < 2:
            raise InputError("must be at least two nodes", field=place)
    else:
        chain = book.nodes.chosen(case.nodes, place)
        chain = book.nodes.along(chain, place)
    points = book.nodes.points[chain]
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    if np.any(steps == 0.0):
        same = chain[np.flatnonzero(steps == 0.0)[0] :][:2]
        raise InputError(f"has two nodes at the same place, {book.nodes.shown(same)}", field=place)
    positions = case.start + np.concatenate([[0.0], np.cumsum(steps)])
    return Stations(points, positions, {name: book.rows(chain, name) for name in COMPONENTS})


def _of_dofs(case: MatricesLine, book: RowBook, place: str) -> Stations:
    """Stations by the names or numbers of vertical d.o.f.; the line is straight, along x."""
    if case.file is not None:
        words, given = _table(case)
        places = [f"{place}.file"] * len(words)
    else:
        words, given = list(case.dofs or ()), list(case.positions or ())
        places = [f"{place}.dofs.{i}" for i in range(len(words))]
    found = [book.row_of(word, where) for word, where in zip(words, places, strict=True)]
    vertical = np.array(found, dtype=np.int64)
    if len(set(found)) < len(found):
        twice = next(i for i, row in enumerate(found) if row in found[:i])
        raise InputError(f"names the d.o.f. {words[twice]} twice", field=places[twice])
    positions = case.start + np.array(given)
    points = np.column_stack([positions, np.zeros((len(positions), 2))])
    rows = {name: np.full(len(vertical), -1, dtype=np.int64) for name in COMPONENTS} | {"z": vertical}
    if book.is_named:
        other = [i for i, row in enumerate(found) if book.dofs.components[row] != "z"]
        if other:
            raise InputError(f"must be vertical: {words[other[0]]} is not", field=places[other[0]])
        nodes = book.dofs.nodes[vertical].tolist()
        turning = [book.dofs.row(node, "ry") for node in nodes]
        rows["ry"] = np.array([-1 if row is None else row for row in turning], dtype=np.int64)
    return Stations(points, positions, rows)


def _table(case: MatricesLine) -> tuple[list[str], list[float]]:
    """D.o.f. and positions of a file of two columns; a first line without number is a heading."""
    assert case.file is not None  # the caller has looked
    lines = Lines.of_file(case.file)
    words: list[str] = []
    positions: list[float] = []
    while lines.remaining:
        row = lines.next("rows").replace(",", " ").replace(";", " ").split()
        if not row or row[0].startswith("#"):
            continue
        values = table_of(row[1:2], 1) if len(row) == 2 else None
        if values is None and not words and lines.position == 1:
            continue
        if values is None:
            raise lines.error("must be a d.o.f. and its position [m]: 12.z, 5.0")
        if positions and values[0, 0] <= positions[-1]:
            raise lines.error("must have a larger position than the line before")
        words.append(row[0])
        positions.append(float(values[0, 0]))
    if len(words) < 2:
        raise lines.error("must have at least two d.o.f.")
    return words, positions


def _is_cubic(case: MatricesLine, stations: Stations, place: str) -> bool:
    """Whether to interpolate by rotations: where all nodes that move up and down also turn."""
    turning = (stations.rows["ry"] >= 0) | (stations.rows["rx"] >= 0)
    if case.interpolation == "linear":
        return False
    if case.interpolation == "cubic":
        if not turning.any():
            raise InputError("needs rotations, which no node of the line has", field=f"{place}.interpolation")
        return True
    return bool(turning.any() and np.all(turning[stations.rows["z"] >= 0]))


def _path(stations: Stations, cubic: bool) -> PolynomialPath:
    steps = np.diff(stations.points, axis=0)
    length = np.linalg.norm(steps, axis=1)
    t = steps / length[:, None]
    up = np.array([0.0, 0.0, 1.0])
    dofs, coefficients = [], []
    for end in (0, 1):
        for axis, name in enumerate("xyz"):
            rows = stations.rows[name]
            along = t[:, 2] * t[:, axis]
            across = up[axis] - along
            bent = _CUBIC[end] if cubic else _LINEAR[end]
            coefficients.append(along[:, None] * _LINEAR[end] + across[:, None] * bent)
            dofs.append(rows[end : len(rows) - 1 + end])
        for axis, name in enumerate(("rx", "ry")) if cubic else ():
            rows = stations.rows[name]
            lift = t[:, 1] if axis == 0 else -t[:, 0]  # vertical part of θ × t
            coefficients.append((length * lift)[:, None] * _SLOPE[end])
            dofs.append(rows[end : len(rows) - 1 + end])
    numbers, weights = np.stack(dofs, axis=1), np.stack(coefficients, axis=1)
    there = numbers >= 0
    weights = np.where(there[:, :, None], weights, 0.0)
    used = np.any(weights != 0.0, axis=(0, 2))
    filler = int(stations.rows["z"].max())
    numbers, weights = np.where(there, numbers, filler)[:, used], weights[:, used]
    return PolynomialPath(
        stations.positions, numbers, np.ascontiguousarray(weights[:, :, : 4 if cubic else 2])
    )
