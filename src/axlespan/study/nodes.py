"""Choosing nodes: by the name of a set or a point, by number, or by coordinates."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.spatial import cKDTree

from axlespan.errors import InputError
from axlespan.running.chain import ordered_along
from axlespan.study.case_nodes import NodesAt
from axlespan.study.faults import InputErrors, listed, nearest

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Coordinates agree when they differ by less than this share of the size of the body.
_SAME = 1e-5


@contextmanager
def under(place: str) -> Iterator[None]:
    """Give errors of the layers below the place in the case that they come from, and keep their words."""
    try:
        yield
    except InputErrors:
        raise
    except InputError as error:
        if error.place is not None:
            raise
        more = {"value": error.value} if error.has_value else {}
        words = str(InputError(error.rule, field=error.field, **more))
        raise InputError(words, field=place, fix=error.fix) from error


@dataclass(frozen=True, eq=False)
class NodeBook:
    """Nodes by set, name and number (12 or n12)."""

    points: FloatArray  # (n_node, 3) [m]
    labels: IntArray  # (n_node,) their numbers; -1 for points that have names only
    sets: Mapping[str, IntArray]  # positions by the name of a set
    names: Mapping[str, int] = field(default_factory=dict)  # positions of points by their names

    @cached_property
    def size(self) -> float:
        """Diagonal of the box that holds all nodes [m]."""
        return float(np.linalg.norm(np.ptp(self.points, axis=0))) if len(self.points) else 0.0

    @property
    def tolerance(self) -> float:
        """Distance at which coordinates are the same [m]."""
        return _SAME * self.size

    @cached_property
    def _position(self) -> dict[int, int]:
        return {label: i for i, label in enumerate(self.labels.tolist()) if label >= 0}

    def chosen(self, choice: str | NodesAt, place: str) -> IntArray:
        """Positions of the nodes of a choice, at least one.

        Parameters
        ----------
        choice : str or NodesAt
            As the case has it.
        place : str
            Its dotted path in the case, for errors.

        Raises
        ------
        InputError
            If there are none; the message names the nearest set, or the nearest node.
        """
        if isinstance(choice, NodesAt):
            return self._at(choice, place)
        if choice in self.names:
            return np.array([self.names[choice]])
        if choice in self.sets:
            if not len(self.sets[choice]):
                raise InputError("is a set without nodes", field=place)
            return self.sets[choice]
        number = re.fullmatch(r"n?(-?\d+)", choice)
        if number:
            return np.array([self._numbered(int(number[1]), place)])
        raise self._unknown(choice, place)

    def one(self, choice: str, place: str) -> int:
        """Position of a single node.

        Raises
        ------
        InputError
            If there is none, or there are several.
        """
        found = self.chosen(choice, place)
        if len(found) > 1:
            shown = self.shown(found)
            raise InputError(f"must be one node, and has {len(found)}: {shown}", field=place)
        return int(found[0])

    def along(self, nodes: IntArray, place: str, *, twins: bool = False) -> IntArray:
        """Nodes in the order of the line that they form, from its end with the lower x.

        Parameters
        ----------
        nodes : array (n,)
            Positions of nodes.
        place : str
            Path in the case, for errors.
        twins : bool
            Whether of nodes at the same place the first one counts; they are refused otherwise.

        Raises
        ------
        InputError
            If they form no single line.
        """
        pairs = cKDTree(self.points[nodes]).query_pairs(self.tolerance, output_type="ndarray")
        if len(pairs) and not twins:
            pair = nodes[np.sort(pairs[0])]
            raise InputError(f"has two nodes at the same place, {self.shown(pair)}", field=place)
        nodes = np.delete(nodes, np.unique(pairs.max(axis=1, initial=0))) if len(pairs) else nodes
        with under(place):
            return np.asarray(nodes[ordered_along(self.points[nodes], "nodes")])

    def shown(self, nodes: IntArray, limit: int = 6) -> str:
        """Numbers (or names) of nodes for a message."""
        names = {i: name for name, i in self.names.items()}
        words = [
            names.get(i, str(label))
            for i, label in zip(nodes[:limit].tolist(), self.labels[nodes[:limit]].tolist(), strict=True)
        ]
        return f"{', '.join(words)}{', …' if len(nodes) > limit else ''}"

    def _numbered(self, label: int, place: str) -> int:
        if label not in self._position:
            known = self.labels[self.labels >= 0]
            fix = f"Nodes have numbers from {known.min()} to {known.max()}" if len(known) else None
            raise InputError("is not the number of a node", field=place, fix=fix)
        return self._position[label]

    def _unknown(self, name: str, place: str) -> InputError:
        known = [*self.names, *self.sets]
        near = nearest(name, known, likeness=0.6)
        if near:
            fix = f"Did you mean {near}?"
        elif known:
            fix = f"Sets are {listed(sorted(known))}; or write coordinates: {{x: 0 m, z: 1.25 m}}"
        else:
            fix = "There are no sets: write the number of a node, or coordinates: {x: 0 m, z: 1.25 m}"
        return InputError("no such set of nodes", field=place, fix=fix)

    def _at(self, choice: NodesAt, place: str) -> IntArray:
        wanted = {axis: getattr(choice, name) for axis, name in enumerate("xyz")}
        pool = np.arange(len(self.points))
        if choice.within is not None:
            pool = self.chosen(choice.within, f"{place}.within")
        away = np.zeros((len(pool), 3))
        for axis, given in wanted.items():
            if given is not None:
                x = self.points[pool, axis]
                away[:, axis] = np.maximum(np.maximum(given[0] - x, x - given[-1]), 0.0)
        found = pool[np.all(away <= self.tolerance, axis=1)]
        if not len(found):
            close = int(pool[np.argmin(np.linalg.norm(away, axis=1))])
            at = ", ".join(f"{x:.6g}" for x in self.points[close])
            rule = (
                f"there is no node at these coordinates; the nearest, {self.shown(np.array([close]))}, is at"
            )
            raise InputError(f"{rule} ({at}) m", field=place)
        return np.asarray(found)
