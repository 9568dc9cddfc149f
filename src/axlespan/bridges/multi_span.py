"""Decks one behind the other, each simply supported: their ends meet over the piers and turn freely."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from axlespan.bridges.girder import girder_of
from axlespan.bridges.stations import Station
from axlespan.errors import InputError
from axlespan.model.compile import compile_model
from axlespan.model.damping import Damping
from axlespan.model.model import Model
from axlespan.running.joined import joined
from axlespan.running.line import path_on_beams
from axlespan.running.structure import MAIN_LINE, Structure


def simple_spans(
    *,
    spans: Sequence[float],
    youngs_modulus: float | Sequence[float],
    second_moment: float | Sequence[float],
    mass_per_length: float | Sequence[float],
    elements: int | Sequence[int],
    area: float | Sequence[float | None] | None = None,
    shear_area: float | Sequence[float | None] | None = None,
    poisson_ratio: float | Sequence[float] = 0.2,
    damping: Damping | None = None,
    bearing_stiffness: float | None = None,
    bearing_damping: float | None = None,
    stations: Sequence[Station] | None = None,
    name: str = "simple spans",
) -> Structure:
    """Simply supported decks in a row; properties are common or given span by span.

    Over each pier two deck ends meet, each on a bearing of its own; rails of a track go on over them. The bearings
    are called ``span1.left``,
    ``span1.right``, ``span2.left``, …

    Parameters
    ----------
    bearing_stiffness, bearing_damping : float, optional
        Of each bearing, vertically [N/m], [N s/m]; rigid when left out.
    spans, youngs_modulus, second_moment, mass_per_length, elements
        As for :func:`~axlespan.bridges.continuous_beam`.
    area, shear_area, poisson_ratio, damping, stations, name
        Likewise.

    Raises
    ------
    InputError
        If a value is out of range, or a bearing has a dashpot but no spring.
    """
    girder = girder_of(
        spans=spans,
        youngs_modulus=youngs_modulus,
        second_moment=second_moment,
        mass_per_length=mass_per_length,
        elements=elements,
        area=area,
        shear_area=shear_area,
        poisson_ratio=poisson_ratio,
        stations=stations,
    )
    if bearing_damping is not None and bearing_stiffness is None:
        raise InputError("is missing; bearing_damping stands beside it", field="bearing_stiffness")
    spring: Mapping[str, float] | None = None if bearing_stiffness is None else {"z": bearing_stiffness}
    dashpot: Mapping[str, float] | None = None if bearing_damping is None else {"z": bearing_damping}
    model, chains = Model(plane=True), []
    for i in range(girder.n_span):
        x = np.linspace(girder.ends[i], girder.ends[i + 1], girder.counts[i] + 1)
        first = len(model.points)
        nodes = np.arange(first, first + len(x))
        model = model.with_nodes(np.column_stack([x, np.zeros_like(x)]))
        pairs = np.column_stack([nodes[:-1], nodes[1:]])
        model = model.with_beams(pairs, girder.span_properties(i, x), name=f"span{i + 1}")
        for node, end in ((nodes[0], "left"), (nodes[-1], "right")):
            fixed = ("x",) if girder.has_area and end == "left" else ()
            model = model.with_support(
                int(node),
                fixed if spring else (*fixed, "z"),
                stiffness=spring,
                damping=dashpot,
                name=f"span{i + 1}.{end}",
            )
        chains.append(nodes.tolist())
    model = model.with_damping(damping)
    compiled = compile_model(model)
    paths = [
        path_on_beams(model, compiled.table, nodes, start=float(start))
        for nodes, start in zip(chains, girder.ends[:-1], strict=True)
    ]
    line = joined(paths).transformed(compiled.system.elimination)
    return Structure(compiled.system, {MAIN_LINE: line}, name, model, {"length": girder.length})
