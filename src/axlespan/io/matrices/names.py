"""Which d.o.f. the rows of a matrix are, and where its nodes stand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.model.dofs import nearest

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class DofMap:
    """Which node and component each row of a matrix is.

    Raises
    ------
    InputError
        If a d.o.f. occurs twice.
    """

    nodes: IntArray  # (n_dof,) numbers of nodes; negative: a node inside an element (Abaqus)
    components: tuple[str, ...]  # (n_dof,) x, y, z, rx, ry, rz or another program's name in lower case

    def __post_init__(self) -> None:
        nodes = np.array(self.nodes, dtype=np.int64)
        object.__setattr__(self, "nodes", nodes)
        if nodes.shape != (len(self.components),):
            raise InputError("must have as many nodes as components", field="d.o.f. map", value=nodes.shape)
        index = {name: i for i, name in enumerate(self.names)}
        if len(index) < len(nodes):
            twice = next(name for i, name in enumerate(self.names) if index[name] != i)
            raise InputError("occurs twice", field="d.o.f.", value=f"{twice[0]}.{twice[1]}")
        object.__setattr__(self, "_index", index)

    def __len__(self) -> int:
        return len(self.nodes)

    @property
    def names(self) -> tuple[tuple[int, str], ...]:
        """Pairs (node, component) of all rows."""
        return tuple(zip(self.nodes.tolist(), self.components, strict=True))

    def label(self, row: int) -> str:
        """Name of a row: ``12.z``."""
        return f"{self.nodes[row]}.{self.components[row]}"

    def row(self, node: int, component: str) -> int | None:
        """Row of a d.o.f.; None if the matrices don't have it."""
        index: dict[tuple[int, str], int] = self.__dict__["_index"]
        return index.get((int(node), component))

    def rows_of(self, component: str) -> IntArray:
        """Rows of a component, in the order of the matrix."""
        return np.flatnonzero(np.array(self.components) == component)

    def taken(self, rows: npt.ArrayLike) -> DofMap:
        """Return the map of some rows."""
        chosen = np.asarray(rows, dtype=np.int64)
        return DofMap(self.nodes[chosen], tuple(self.components[i] for i in chosen.tolist()))


@dataclass(frozen=True, eq=False)
class NodeTable:
    """Places of nodes by their numbers, and named sets of nodes.

    Raises
    ------
    InputError
        If a number occurs twice or a coordinate isn't finite.
    """

    labels: IntArray  # (n_node,)
    points: FloatArray  # (n_node, 3) [m]
    sets: Mapping[str, IntArray] = field(default_factory=dict)  # numbers of nodes by name

    def __post_init__(self) -> None:
        labels, points = np.array(self.labels, dtype=np.int64), np.array(self.points, dtype=np.float64)
        if labels.ndim != 1 or points.shape != (len(labels), 3):
            raise InputError("must be an array (n_node, 3)", field="coordinates", value=points.shape)
        if not np.isfinite(points).all():
            bad = int(labels[~np.isfinite(points).all(axis=1)][0])
            raise InputError("must have finite coordinates", field="node", value=bad)
        order = np.argsort(labels, kind="stable")
        twice = np.flatnonzero(np.diff(labels[order]) == 0)
        if len(twice):
            raise InputError("occurs twice", field="node", value=int(labels[order[twice[0]]]))
        for name, value in (("labels", labels[order]), ("points", points[order])):
            object.__setattr__(self, name, value)

    def positions(self, labels: npt.ArrayLike) -> IntArray:
        """Positions of nodes in the table.

        Raises
        ------
        InputError
            If a node isn't there.
        """
        wanted = np.asarray(labels, dtype=np.int64)
        found = np.searchsorted(self.labels, wanted)
        missing = ~np.isin(wanted, self.labels)
        if missing.any():
            raise InputError("has no coordinates", field="node", value=int(wanted[missing][0]))
        return np.asarray(found)

    def points_of(self, labels: npt.ArrayLike) -> FloatArray:
        """Coordinates (n, 3) [m] of nodes."""
        return self.points[self.positions(labels)]

    def nodes_of_set(self, name: str) -> IntArray:
        """Numbers of the nodes of a set; an unknown name is an InputError that suggests the nearest."""
        if name not in self.sets:
            raise nearest(name, sorted(self.sets), "node set")
        return self.sets[name]


def joined_dofs(maps: Sequence[DofMap]) -> DofMap:
    """All d.o.f. of some maps, one after the other."""
    nodes = np.concatenate([np.empty(0, dtype=np.int64), *(part.nodes for part in maps)])
    return DofMap(nodes, tuple(name for part in maps for name in part.components))
