"""Nodes of the beams under a line at given positions, so that what stands on them stands on nodes.

A beam's stiffness grows as the third power of 1 / length, and that of a short one drowns in its rounding what all others
carry. So a node that only joins two equal beams moves to a position near to it; elsewhere beams are cut, unless too
short a piece were left.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass, fields, replace

import numpy as np
import numpy.typing as npt

from axlespan.model.compile import Compiled, compile_model
from axlespan.model.model import Model
from axlespan.model.parts import BeamPart, Part
from axlespan.running.beams import BeamTable, carriers, taken
from axlespan.running.joined import joined
from axlespan.running.line import path_on_beams
from axlespan.running.path import PolynomialPath
from axlespan.running.structure import MAIN_LINE, Structure

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Positions closer to a node than this share of a beam are at the node.
_AT_NODE = 1e-6


@dataclass(frozen=True, eq=False)
class _Carried:
    """A line of which every segment runs on one beam: nodes (n_segment, 2) in its direction, and the beams."""

    breaks: FloatArray
    nodes: IntArray
    beam: IntArray
    backward: npt.NDArray[np.bool_]


def cut_at(
    bridge: Structure, positions: FloatArray, line: str = MAIN_LINE, *, shortest: float = 0.0
) -> Structure:
    """The structure with nodes at positions (n,) [m] of a line, but where a piece shorter than the shortest were left.

    A structure of which some line does not run on single beams throughout (solids, shells, matrices) is
    returned as it is.
    """
    if bridge.model is None:
        return bridge
    beams = BeamTable.of(bridge.model)
    found = {name: _carried(bridge, path, beams) for name, path in bridge.lines.items()}
    if any(item is None for item in found.values()):
        return bridge
    lines = {name: item for name, item in found.items() if item is not None}
    main = lines.get(line, next(iter(lines.values())))
    breaks = _moved(main, beams, positions)
    moved = not np.array_equal(breaks, main.breaks)
    if moved:
        beams = BeamTable.of(_with_moved_nodes(beams.model, main, breaks))
    segment = np.clip(np.searchsorted(breaks, positions, side="right") - 1, 0, len(breaks) - 2)
    begin, end = breaks[segment], breaks[segment + 1]
    share = (positions - begin) / (end - begin)
    least = np.maximum(_AT_NODE, shortest / (end - begin))
    inside = (share > least) & (share < 1.0 - least)
    if not np.any(inside) and not moved:
        return bridge
    cuts: dict[int, list[float]] = {}
    for where, at in zip(segment[inside], share[inside], strict=True):
        xi = 1.0 - float(at) if main.backward[where] else float(at)
        cuts.setdefault(int(main.beam[where]), []).append(xi)
    model, chains = _cut(beams, cuts) if cuts else (beams.model, {})
    compiled = compile_model(model)
    paths = {name: _path(model, compiled, item, chains) for name, item in lines.items()}
    return replace(bridge, system=compiled.system, model=model, lines=paths)


def _carried(bridge: Structure, path: PolynomialPath, beams: BeamTable) -> _Carried | None:
    pairs = carriers(bridge, path, beams)
    n = len(path.breaks) - 1
    if len(pairs.segment) != n or not np.array_equal(pairs.segment, np.arange(n)):
        return None
    if any(part.offset is not None for part in beams.parts):
        return None
    nodes = np.concatenate([part.nodes for part in beams.parts])[pairs.beam]
    nodes = np.where(pairs.backward[:, None], nodes[:, ::-1], nodes)
    return _Carried(path.breaks, nodes, pairs.beam, pairs.backward)


def _moved(line: _Carried, beams: BeamTable, positions: FloatArray) -> FloatArray:
    """The breaks (n_segment + 1,) of a line when nodes that may move do so, each to the position next to it.

    They move by half the way to the next break at most.
    """
    result, order = line.breaks.copy(), np.sort(positions)
    inner = np.flatnonzero(_may_move(line, beams)) + 1
    if not len(inner) or not len(order):
        return result
    at = line.breaks[inner]
    nearest = np.searchsorted(0.5 * (order[:-1] + order[1:]), at)
    way = np.abs(order[nearest] - at)
    free = way <= 0.5 * np.minimum(at - line.breaks[inner - 1], line.breaks[inner + 1] - at)
    for place in np.unique(nearest[free]):  # of several nodes, the nearest one
        wanting = np.flatnonzero(free & (nearest == place))
        result[inner[wanting[np.argmin(way[wanting])]]] = order[place]
    return result


def _may_move(line: _Carried, beams: BeamTable) -> npt.NDArray[np.bool_]:
    """Which nodes (n_segment - 1,) inside a line only join two equal beams, one straight behind the other."""
    model = beams.model
    first, second = line.beam[:-1], line.beam[1:]
    node, points = line.nodes[:-1, 1], model.points[line.nodes]
    along = points[:, 1] - points[:, 0]
    along /= np.linalg.norm(along, axis=1)[:, None]
    straight = np.abs(along[1:] - along[:-1]).max(axis=1, initial=0.0) < 1e-9
    properties = np.concatenate([_properties(part) for part in beams.parts])
    equal = (properties[first] == properties[second]).all(axis=1)
    owner = np.searchsorted(beams.begin, line.beam, side="right")
    equal &= owner[:-1] == owner[1:]
    used = np.bincount(
        np.concatenate([np.asarray(part.nodes).ravel() for part in model.parts]), minlength=len(model.points)
    )
    named = [*model.node_names.values(), *(node for nodes in model.node_sets.values() for node in nodes)]
    named += [support.node for support in model.supports] + [load.node for load in model.loads]
    named += [end[0] for tie in model.ties for end in (tie.slave, *tie.masters)]
    used[np.array(named, dtype=np.int64)] += 1
    return np.asarray(straight & equal & (line.nodes[1:, 0] == node) & (used[node] == 2))


def _properties(part: BeamPart) -> FloatArray:
    """What makes two beams equal (n_element, …)."""
    count = len(part.nodes)
    values = part.properties.broadcast(count)
    up = np.zeros(3) if part.up is None else part.up
    columns = [np.asarray(getattr(values, field.name)) for field in fields(values)]
    return np.column_stack([*columns, np.broadcast_to(up, (count, 3))])


def _with_moved_nodes(model: Model, line: _Carried, breaks: FloatArray) -> Model:
    """The model with the nodes of a line at new breaks of it."""
    points = model.points.copy()
    for i in np.flatnonzero(breaks != line.breaks):
        a, b = line.nodes[i - 1]
        begin, end = line.breaks[i - 1], line.breaks[i]
        points[b] = model.points[a] + (breaks[i] - begin) / (end - begin) * (
            model.points[b] - model.points[a]
        )
    return replace(model, points=points)


def _cut(beams: BeamTable, cuts: dict[int, list[float]]) -> tuple[Model, dict[int, list[int]]]:
    """The model with some beams cut at shares of their lengths; the chain of nodes of each beam that is cut."""
    model = beams.model
    ends = np.concatenate([part.nodes for part in beams.parts])
    new: list[FloatArray] = []
    chains: dict[int, list[int]] = {}
    for beam, shares in cuts.items():
        a, b = (model.points[i] for i in ends[beam])
        first = len(model.points) + len(new)
        chosen = sorted(set(shares))
        new += [(1.0 - xi) * a + xi * b for xi in chosen]
        chains[beam] = [int(ends[beam, 0]), *range(first, first + len(chosen)), int(ends[beam, 1])]
    number = 0
    parts: list[Part] = []
    for part in model.parts:
        if isinstance(part, BeamPart):
            parts.append(_pieces(part, number, chains))
            number += len(part.nodes)
        else:
            parts.append(part)
    extended = model.with_nodes(np.array(new))
    return replace(extended, parts=tuple(parts)), chains


def _pieces(part: BeamPart, first: int, chains: dict[int, list[int]]) -> BeamPart:
    own = [
        list(itertools.pairwise(chains[first + i])) if first + i in chains else [tuple(pair)]
        for i, pair in enumerate(part.nodes.tolist())
    ]
    repeats = np.repeat(np.arange(len(part.nodes)), [len(pairs) for pairs in own])
    nodes = np.array([pair for pairs in own for pair in pairs], dtype=np.int64)
    return replace(taken(part, repeats), nodes=nodes)


def _path(model: Model, compiled: Compiled, item: _Carried, chains: dict[int, list[int]]) -> PolynomialPath:
    """The line again: over chains of nodes, one for each stretch without a joint."""
    stretches: list[list[int]] = []
    starts: list[float] = []
    for i, (a, b) in enumerate(item.nodes.tolist()):
        chain = chains.get(int(item.beam[i]), [a, b])
        chain = chain[::-1] if chain[0] != a else chain
        if stretches and stretches[-1][-1] == a:
            stretches[-1] += chain[1:]
        else:
            stretches.append(list(chain))
            starts.append(float(item.breaks[i]))
    paths = [
        path_on_beams(model, compiled.table, nodes, start=start)
        for nodes, start in zip(stretches, starts, strict=True)
    ]
    return joined(paths).transformed(compiled.system.elimination)
