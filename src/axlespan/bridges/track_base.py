"""What a track stands on: the ground before and behind a bridge, and points of the bridge's lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.bridges.track_layout import Layout
from axlespan.model.dofs import COMPONENTS, DofTable
from axlespan.model.model import Model, Tie
from axlespan.running.geometry import LineGeometry
from axlespan.running.structure import Structure

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class _Places:
    """Nodes and components of a model's d.o.f. by their numbers."""

    node: IntArray
    component: IntArray

    @classmethod
    def of(cls, table: DofTable) -> _Places:
        nodes, components = np.nonzero(table.number >= 0)
        order = np.argsort(table.number[nodes, components])
        return cls(nodes[order], components[order])


def on_ground(model: Model, point: FloatArray, name: str) -> tuple[Model, int]:
    """A node of the ground, with one support for all that stands on it."""
    node = len(model.points)
    model = model.with_nodes(point[None], [f"{name}:ground"])
    return model.with_support(node, ("z",), name=name), node


def bases_under(
    model: Model,
    bridge: Structure,
    layout: Layout,
    names: Sequence[str],
    geometry: Sequence[LineGeometry],
    table: DofTable,
) -> tuple[Model, list[IntArray]]:
    """What the last springs stand on: the ground before and behind the bridge, and points of its lines."""
    model, before = on_ground(model, geometry[0].at(layout.start), "approach")
    model, behind = on_ground(model, geometry[0].at(layout.stop), "exit")
    deck = np.flatnonzero(layout.on_deck)
    places = _Places.of(table)
    bases = []
    for name, where in zip(names, geometry, strict=True):
        first = len(model.points)
        model = model.with_nodes(where.at(layout.position[deck]))
        rows = sp.csr_array(bridge.line(name).rows(layout.position[deck], bridge.system.size))
        ties = []
        for i in range(len(deck)):
            own = slice(rows.indptr[i], rows.indptr[i + 1])
            numbers, weights = bridge.system.independent[rows.indices[own]], rows.data[own]
            large = np.abs(weights) > 1e-12
            masters = tuple(
                (int(places.node[k]), COMPONENTS[places.component[k]], float(weight))
                for k, weight in zip(numbers[large], weights[large], strict=True)
            )
            ties.append(Tie((first + i, "z"), masters))
        model = replace(model, ties=(*model.ties, *ties))
        base = np.where(layout.before, before, behind)
        base[deck] = np.arange(first, first + len(deck))
        bases.append(base)
    return model, bases
