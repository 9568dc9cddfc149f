"""From rows with a file's own numbers to a Mesh: labels to positions, blocks by kind, sets, checks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError, Place
from axlespan.io.lines import at
from axlespan.model.mesh import CellBlock, ElementSet, Mesh

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: No bridge is larger [m]; a larger coordinate is a damaged file or a wrong unit.
LARGEST_COORDINATE = 1e9


@dataclass(frozen=True, eq=False)
class NodeRows:
    """Nodes as they stand in a file."""

    labels: IntArray  # (n,)
    points: FloatArray  # (n, 3) [m]
    lines: IntArray  # (n,) line numbers of the labels, 0 where unknown
    point_lines: IntArray  # (n,) of the coordinates

    @classmethod
    def joined(cls, parts: Sequence[NodeRows]) -> NodeRows:
        """All rows of some parts."""
        return cls(
            np.concatenate([np.empty(0, dtype=np.int64), *(part.labels for part in parts)]),
            np.concatenate([np.empty((0, 3)), *(part.points for part in parts)]),
            np.concatenate([np.empty(0, dtype=np.int64), *(part.lines for part in parts)]),
            np.concatenate([np.empty(0, dtype=np.int64), *(part.point_lines for part in parts)]),
        )


@dataclass(frozen=True, eq=False)
class ElementRows:
    """Elements of one kind as they stand in a file."""

    kind: str
    labels: IntArray  # (n,)
    nodes: IntArray  # (n, n_node) labels of nodes, in VTK's order
    lines: IntArray  # (n,) line numbers, 0 where unknown


@dataclass(frozen=True)
class Unsupported:
    """Elements of a type that isn't supported."""

    name: str
    count: int
    line: int
    remedy: str = ""


def refuse(file: str, found: Iterable[Unsupported]) -> None:
    """Raise an error that names every type of element that isn't supported, and how many there are."""
    types: dict[str, Unsupported] = {}
    for item in found:
        first = types.get(item.name, Unsupported(item.name, 0, item.line))
        types[item.name] = Unsupported(item.name, first.count + item.count, first.line, item.remedy)
    if types:
        listed = ", ".join(
            f"{item.name} ({item.count} element{'s' * (item.count != 1)})" for item in types.values()
        )
        remedies = " ".join(dict.fromkeys(item.remedy for item in types.values() if item.remedy))
        place = at(file, next(iter(types.values())).line)
        fix = remedies or "Mesh this part with a supported element, or leave it out of the export."
        raise InputError("is not a supported element type", field=listed, place=place, fix=fix)


class Lookup:
    """Positions of labels in an array of distinct labels."""

    def __init__(self, labels: IntArray, lines: IntArray, file: str, what: str) -> None:
        self._order = np.argsort(labels, kind="stable")
        self._sorted = labels[self._order]
        self._file, self._what = file, what
        twice = np.flatnonzero(np.diff(self._sorted) == 0)
        if len(twice):
            again = self._order[twice + 1]
            row = int(again[np.argmin(lines[again])])
            rule = f"is already the number of another {what}"
            raise InputError(rule, field=f"{what} number", value=int(labels[row]), place=at(file, lines[row]))

    def known(self, labels: IntArray) -> npt.NDArray[np.bool_]:
        """Whether each label is there."""
        if not len(self._sorted):
            return np.zeros(labels.shape, dtype=bool)
        found = np.searchsorted(self._sorted, labels).clip(max=len(self._sorted) - 1)
        return np.asarray(self._sorted[found] == labels)

    def positions(self, labels: IntArray, lines: IntArray, user: str) -> IntArray:
        """Positions of labels (n, …) that stand on lines (n,).

        Raises
        ------
        InputError
            If a label isn't there.
        """
        known = self.known(labels)
        if not known.all():
            row = int(np.flatnonzero(~known.reshape(len(known), -1).all(axis=1))[0])
            bad = int(np.atleast_1d(labels[row])[~np.atleast_1d(known[row])][0])
            rule = f"must be a {self._what} of the file ({user})"
            raise InputError(rule, field=f"{self._what} number", value=bad, place=at(self._file, lines[row]))
        return np.asarray(self._order[np.searchsorted(self._sorted, labels)])


def assemble(
    file: str,
    nodes: NodeRows,
    elements: Sequence[ElementRows],
    node_sets: Mapping[str, IntArray],
    element_sets: Mapping[str, IntArray],
) -> Mesh:
    """Build a mesh from rows; sets are given by labels, all of which must be known.

    Raises
    ------
    InputError
        For a number used twice, a node or element that isn't there, or an impossible coordinate.
    """
    bad = ~(np.abs(nodes.points) <= LARGEST_COORDINATE).all(axis=1)  # catches NaN as well
    if bad.any():
        row = int(np.flatnonzero(bad)[0])
        rule = f"must be finite and at most {LARGEST_COORDINATE:g} m in size"
        field = f"coordinates of node {nodes.labels[row]}"
        raise InputError(
            rule, field=field, value=nodes.points[row].tolist(), place=at(file, nodes.point_lines[row])
        )
    lookup = Lookup(nodes.labels, nodes.lines, file, "node")
    blocks, places = _blocks(elements, lookup)
    labels = np.concatenate([np.empty(0, dtype=np.int64), *(block.labels for block in blocks)])
    lines = np.concatenate([np.empty(0, dtype=np.int64), *places])
    finder = Lookup(labels, lines, file, "element")
    bounds = np.cumsum([0, *(len(block) for block in blocks)])
    try:
        return Mesh(
            points=nodes.points,
            blocks=tuple(blocks),
            node_sets={
                name: lookup.positions(chosen, np.zeros_like(chosen), f"set '{name}'")
                for name, chosen in node_sets.items()
            },
            element_sets={
                name: split_by_block(finder.positions(chosen, np.zeros_like(chosen), f"set '{name}'"), bounds)
                for name, chosen in element_sets.items()
            },
            node_labels=nodes.labels,
        )
    except InputError as error:
        raise error.located(Place(file)) from None


def _blocks(elements: Sequence[ElementRows], lookup: Lookup) -> tuple[list[CellBlock], list[IntArray]]:
    """One block for each kind, in the order in which the kinds come; line numbers of their elements."""
    blocks, lines = [], []
    for kind in dict.fromkeys(rows.kind for rows in elements):
        same = [rows for rows in elements if rows.kind == kind]
        nodes = [lookup.positions(rows.nodes, rows.lines, f"{kind} element") for rows in same]
        blocks.append(CellBlock(kind, np.concatenate(nodes), np.concatenate([rows.labels for rows in same])))
        lines.append(np.concatenate([rows.lines for rows in same]))
    return blocks, lines


def split_by_block(positions: IntArray, bounds: IntArray) -> ElementSet:
    """Positions among all elements as pairs of block and positions in it."""
    parts = []
    for block, (start, end) in enumerate(pairwise(bounds.tolist())):
        inside = positions[(positions >= start) & (positions < end)] - start
        if len(inside):
            parts.append((block, inside))
    return tuple(parts)
