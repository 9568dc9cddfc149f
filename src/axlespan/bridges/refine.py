"""Cut the beams under a line at given positions, so that what stands on them stands on nodes."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace

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


def cut_at(bridge: Structure, positions: FloatArray, line: str = MAIN_LINE) -> Structure:
    """The structure with nodes at positions (n,) [m] of a line.

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
    segment = np.clip(np.searchsorted(main.breaks, positions, side="right") - 1, 0, len(main.breaks) - 2)
    begin, end = main.breaks[segment], main.breaks[segment + 1]
    share = (positions - begin) / (end - begin)
    inside = (share > _AT_NODE) & (share < 1.0 - _AT_NODE)
    if not np.any(inside):
        return bridge
    cuts: dict[int, list[float]] = {}
    for where, at in zip(segment[inside], share[inside], strict=True):
        xi = 1.0 - float(at) if main.backward[where] else float(at)
        cuts.setdefault(int(main.beam[where]), []).append(xi)
    model, chains = _cut(beams, cuts)
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
