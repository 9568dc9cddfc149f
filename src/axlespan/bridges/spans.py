"""Beam bridges: a simple span and continuous beams."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from axlespan.errors import InputError
from axlespan.model.compile import compile_model
from axlespan.model.damping import Damping
from axlespan.model.materials import BeamSection, Material, require_positive
from axlespan.model.model import Model
from axlespan.model.motions import Motion
from axlespan.running.line import path_on_beams
from axlespan.running.structure import MAIN_LINE, Structure

T = TypeVar("T")


@dataclass(frozen=True)
class SupportAt:
    """A support at a position [m] along the beam; see :meth:`axlespan.model.model.Model.with_support`."""

    position: float
    fixed: Sequence[str] | None = None  # z, unless it is elastic or moved
    stiffness: Mapping[str, float] | None = None
    damping: Mapping[str, float] | None = None
    motion: Mapping[str, Motion] | None = None
    name: str | None = None


def simple_span(
    *,
    length: float,
    youngs_modulus: float,
    second_moment: float,
    mass_per_length: float,
    elements: int,
    area: float | None = None,
    shear_area: float | None = None,
    poisson_ratio: float = 0.2,
    damping: Damping | None = None,
    supports: Sequence[SupportAt] | None = None,
    name: str = "simple span",
) -> Structure:
    """A beam on two supports, pinned at its ends unless ``supports`` says otherwise.

    Parameters
    ----------
    length : float
        Span [m].
    youngs_modulus, poisson_ratio : float
        E [Pa] and ν [-]; ν matters with a shear area only.
    second_moment : float
        Second moment of area for vertical bending [m^4].
    mass_per_length : float
        [kg/m].
    elements : int
        Number of beam elements.
    area : float, optional
        [m^2]; adds the axial d.o.f. and, with a shear area, the rotary inertia of the section.
    shear_area : float, optional
        κA [m^2]; makes it a Timoshenko beam.
    damping : Rayleigh or Modal, optional
        None by default.
    supports : sequence of SupportAt, optional
        Replace the two pins, which are called ``left`` and ``right``.

    Raises
    ------
    InputError
        If a value is not positive, or a support is not on the beam.
    """
    return continuous_beam(
        spans=[length],
        youngs_modulus=youngs_modulus,
        second_moment=second_moment,
        mass_per_length=mass_per_length,
        elements=elements,
        area=area,
        shear_area=shear_area,
        poisson_ratio=poisson_ratio,
        damping=damping,
        supports=supports,
        name=name,
    )


def continuous_beam(
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
    supports: Sequence[SupportAt] | None = None,
    name: str = "continuous beam",
) -> Structure:
    """A beam over several spans; properties are common or given span by span.

    Parameters are those of :func:`simple_span`, with ``spans`` [m] from left to right and
    ``elements`` per span. The supports are called ``left``, ``support2``, …, ``right``.
    """
    lengths = [
        require_positive(span, "length" if len(spans) == 1 else f"spans.{i}") for i, span in enumerate(spans)
    ]
    if not lengths:
        raise InputError("must name at least one span", field="spans", value=list(spans))
    n = len(lengths)
    counts = [_count(c) for c in _per_span(elements, n, "elements")]
    moduli, moments, masses = (
        [require_positive(v, field, zero=field == "mass_per_length") for v in _per_span(values, n, field)]
        for values, field in (
            (youngs_modulus, "youngs_modulus"),
            (second_moment, "second_moment"),
            (mass_per_length, "mass_per_length"),
        )
    )
    areas, shear_areas = (
        _per_span(values, n, field) for values, field in ((area, "area"), (shear_area, "shear_area"))
    )
    if any(value is None for value in areas) and any(value is not None for value in areas):
        raise InputError("must be given for all spans or for none", field="area", value=areas)
    ratios = _per_span(poisson_ratio, n, "poisson_ratio")
    properties = [
        BeamSection(
            second_moment=moments[i],
            area=areas[i],
            shear_area=shear_areas[i],
            mass_per_length=masses[i],
            rotary_inertia=areas[i] is not None and shear_areas[i] is not None,
        ).properties(Material(moduli[i], ratios[i]))
        for i in range(n)
    ]
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    grid = [np.linspace(a, b, count + 1) for a, b, count in zip(ends[:-1], ends[1:], counts, strict=True)]
    chosen = _default_supports(ends, areas[0]) if supports is None else list(supports)
    x = _with_positions(np.unique(np.concatenate(grid)), [support.position for support in chosen])
    model = Model(plane=True).with_nodes(np.column_stack([x, np.zeros_like(x)]))
    middle = 0.5 * (x[1:] + x[:-1])
    span_of = np.clip(np.searchsorted(ends, middle, side="right") - 1, 0, n - 1)
    pairs = np.column_stack([np.arange(len(x) - 1), np.arange(1, len(x))])
    for i in range(n):
        model = model.with_beams(
            pairs[span_of == i], properties[i], name="beam" if n == 1 else f"span{i + 1}"
        )
    model = _supported(model, x, chosen).with_damping(damping)
    compiled = compile_model(model)
    path = path_on_beams(model, compiled.table, range(len(x)))
    return Structure(
        system=compiled.system,
        lines={MAIN_LINE: path.transformed(compiled.system.elimination)},
        name=name,
        model=model,
        facts={"length": float(ends[-1])},
    )


def _per_span(values: T | Sequence[T] | np.ndarray, n: int, field: str) -> list[T]:
    if isinstance(values, Sequence | np.ndarray):
        if len(values) != n:
            raise InputError(
                f"must be one value or one for each of the {n} spans", field=field, value=list(values)
            )
        return list(values)
    return [values] * n


def _count(elements: int) -> int:
    if isinstance(elements, bool) or not np.isfinite(elements) or int(elements) != elements or elements < 1:
        raise InputError("must be a whole number of at least 1", field="elements", value=elements)
    if elements > 1_000_000:
        raise InputError("must be at most 1 000 000", field="elements", value=elements)
    return int(elements)


def _default_supports(ends: np.ndarray, area: float | None) -> list[SupportAt]:
    last = len(ends) - 1
    names = ["left", *(f"support{i + 1}" for i in range(1, last)), "right"]
    first = ("z",) if area is None else ("x", "z")
    return [SupportAt(float(x), first if i == 0 else ("z",), name=names[i]) for i, x in enumerate(ends)]


def _with_positions(grid: np.ndarray, positions: list[float]) -> np.ndarray:
    """The grid with nodes added where supports stand between nodes."""
    length = grid[-1]
    for position in positions:
        if not 0.0 <= position <= length:
            raise InputError(f"must be between 0 and {length:g} m", field="support position", value=position)
        if np.min(np.abs(grid - position)) > 1e-9 * length:
            grid = np.sort(np.append(grid, position))
    return grid


def _fixed(support: SupportAt) -> Sequence[str]:
    if support.fixed is not None:
        return support.fixed
    held = {*(support.stiffness or {}), *(support.damping or {}), *(support.motion or {})}
    return () if "z" in held else ("z",)


def _supported(model: Model, x: np.ndarray, supports: list[SupportAt]) -> Model:
    for i, support in enumerate(supports):
        node = int(np.argmin(np.abs(x - support.position)))
        model = model.with_support(
            node,
            _fixed(support),
            stiffness=support.stiffness,
            damping=support.damping,
            motion=support.motion,
            name=support.name or f"support{i + 1}",
        )
    return model
