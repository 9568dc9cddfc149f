"""Integral bridges: a deck and the columns under it, joined stiffly or by hinges."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from axlespan.bridges.girder import Girder, girder_of
from axlespan.bridges.spans import SupportAt, supported
from axlespan.bridges.stations import Station
from axlespan.errors import InputError
from axlespan.model.compile import compile_model
from axlespan.model.damping import Damping
from axlespan.model.materials import BeamSection, Material, require_positive
from axlespan.model.model import Model
from axlespan.running.line import path_on_beams
from axlespan.running.structure import MAIN_LINE, Structure

_TOPS, _BASES = ("rigid", "hinged"), ("fixed", "pinned")


@dataclass(frozen=True)
class Column:
    """A column, pier or abutment wall under a deck."""

    position: float  # along the deck [m]
    height: float  # [m]
    youngs_modulus: float  # [Pa]
    second_moment: float  # [m^4]
    area: float  # [m^2]
    mass_per_length: float = 0.0  # [kg/m]
    top: str = "rigid"  # rigid or hinged joint with the deck
    base: str = "fixed"  # fixed or pinned
    base_stiffness: Mapping[str, float] | None = None  # springs of the foundation, in place of base
    elements: int = 8
    name: str | None = None

    def __post_init__(self) -> None:
        for field in ("height", "youngs_modulus", "second_moment", "area"):
            require_positive(getattr(self, field), f"columns.{field}")
        require_positive(self.mass_per_length, "columns.mass_per_length", zero=True)
        for field, words in (("top", _TOPS), ("base", _BASES)):
            if getattr(self, field) not in words:
                raise InputError(
                    f"must be {' or '.join(words)}", field=f"columns.{field}", value=getattr(self, field)
                )


def frame(
    *,
    spans: Sequence[float],
    youngs_modulus: float | Sequence[float],
    second_moment: float | Sequence[float],
    mass_per_length: float | Sequence[float],
    area: float | Sequence[float | None],
    elements: int | Sequence[int],
    columns: Sequence[Column],
    shear_area: float | Sequence[float | None] | None = None,
    poisson_ratio: float | Sequence[float] = 0.2,
    damping: Damping | None = None,
    supports: Sequence[SupportAt] = (),
    stations: Sequence[Station] | None = None,
    name: str = "frame",
) -> Structure:
    """A deck on columns: portal frames, integral bridges, viaducts.

    The deck has axial stiffness, so ``area`` is needed.

    Parameters
    ----------
    columns : sequence of Column
        Under the deck; the feet are called ``column1``, … in the list of supports.
    supports : sequence of SupportAt
        Other supports of the deck: bearings on abutments, springs of the soil behind an integral abutment. None
        by default.
    spans, youngs_modulus, second_moment, mass_per_length, elements
        Of the deck, as for :func:`~axlespan.bridges.continuous_beam`.
    area, shear_area, poisson_ratio, damping, stations, name
        Likewise.

    Raises
    ------
    InputError
        If a value is out of range, or there is no column.
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
    if not girder.has_area:
        raise InputError("is missing; columns and deck push each other", field="area")
    if not columns:
        raise InputError(
            "must be at least one", field="columns", value=0, fix="Use continuous_beam without them"
        )
    x = girder.grid([*(column.position for column in columns), *(support.position for support in supports)])
    model = _deck(girder, x)
    for number, column in enumerate(columns):
        model = _with_column(model, column, int(np.argmin(np.abs(x - column.position))), number)
    model = supported(model, x, list(supports)).with_damping(damping)
    compiled = compile_model(model)
    path = path_on_beams(model, compiled.table, range(len(x)))
    line = path.transformed(compiled.system.elimination)
    return Structure(compiled.system, {MAIN_LINE: line}, name, model, {"length": girder.length})


def _deck(girder: Girder, x: np.ndarray) -> Model:
    model = Model(plane=True).with_nodes(np.column_stack([x, np.zeros_like(x)]))
    pairs = np.column_stack([np.arange(len(x) - 1), np.arange(1, len(x))])
    return model.with_beams(pairs, girder.element_properties(x), name="deck")


def _with_column(model: Model, column: Column, deck: int, number: int) -> Model:
    """Beams from the deck down to the foot; a hinge has a node of its own."""
    x, z = model.points[deck, 0], model.points[deck, 2]
    depth = np.linspace(0.0, column.height, column.elements + 1)[1:]
    title = column.name or f"column{number + 1}"
    top = deck
    if column.top == "hinged":
        top = len(model.points)
        model = model.with_nodes([[x, z]]).with_rigid_link(deck, [top], ("x", "z"))
    first = len(model.points)
    model = model.with_nodes(np.column_stack([np.full(len(depth), x), z - depth]))
    nodes = np.array([top, *range(first, first + len(depth))])
    section = BeamSection(column.second_moment, column.area, mass_per_length=column.mass_per_length)
    properties = section.properties(Material(column.youngs_modulus))
    model = model.with_beams(np.column_stack([nodes[:-1], nodes[1:]]), properties, name=title)
    foot = int(nodes[-1])
    if column.base_stiffness is None:
        fixed = ("x", "z", "ry") if column.base == "fixed" else ("x", "z")
        return model.with_support(foot, fixed, name=title)
    return model.with_support(
        foot,
        [part for part in ("x", "z") if part not in column.base_stiffness],
        stiffness=column.base_stiffness,
        name=title,
    )
