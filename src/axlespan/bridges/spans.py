"""Beam bridges: a simple span and continuous beams."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from axlespan.bridges.girder import girder_of
from axlespan.bridges.stations import Station
from axlespan.model.compile import compile_model
from axlespan.model.damping import Damping
from axlespan.model.model import Model
from axlespan.model.motions import Motion
from axlespan.running.line import path_on_beams
from axlespan.running.structure import MAIN_LINE, Structure


@dataclass(frozen=True)
class SupportAt:
    """A support at a position [m] along the beam; see :meth:`axlespan.model.model.Model.with_support`."""

    position: float  # [m]
    fixed: Sequence[str] | None = None  # z, unless it is elastic or moved
    stiffness: Mapping[str, float] | None = None  # by component, to the ground [N/m], [N m/rad]
    damping: Mapping[str, float] | None = None  # [N s/m], [N m s/rad]
    motion: Mapping[str, Motion] | None = None  # displacement over time, by component [m], [rad]
    name: str | None = None  # support1, support2, … when left out


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
    stations: Sequence[Station] | None = None,
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
        Replace the two pins, which are called ``left`` and ``right``; bearings on springs and dashpots
        too, and rotational springs of integral abutments (``stiffness={"z": ..., "ry": ...}``).
    stations : sequence of Station, optional
        Second moment and mass per length where they vary along the beam, in place of those above.
    name : str
        Of the structure.

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
        stations=stations,
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
    stations: Sequence[Station] | None = None,
    name: str = "continuous beam",
) -> Structure:
    """A beam over several spans; properties are common or given span by span.

    The supports are called ``left``, ``support2``, …, ``right``.

    Parameters
    ----------
    spans : sequence of float
        From left to right [m].
    youngs_modulus, poisson_ratio : float or sequence of float
        E [Pa] and ν [-]; ν matters with a shear area only.
    second_moment : float or sequence of float
        For vertical bending [m^4].
    mass_per_length : float or sequence of float
        [kg/m].
    elements : int or sequence of int
        Of each span.
    area : float or sequence of float, optional
        [m^2]; with it there are d.o.f. along x.
    shear_area : float or sequence of float, optional
        [m^2]; without it the beam does not shear.
    damping : Rayleigh or Modal, optional
    supports : sequence of SupportAt, optional
        In place of a pin at each end of a span.
    stations : sequence of Station, optional
        Second moment and mass per length where they vary along the beam [m, m^4, kg/m].
    name : str
        Of the structure.

    Raises
    ------
    InputError
        If a value is not positive, lists have other lengths than the spans, or a support is not on the beam.
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
    ends, n = girder.ends, girder.n_span
    chosen = _default_supports(ends, girder.has_area) if supports is None else list(supports)
    x = girder.grid([support.position for support in chosen])
    model = Model(plane=True).with_nodes(np.column_stack([x, np.zeros_like(x)]))
    span_of = girder.span_of(x)
    pairs = np.column_stack([np.arange(len(x) - 1), np.arange(1, len(x))])
    for i in range(n):
        own = x[np.append(span_of == i, False) | np.concatenate([[False], span_of == i])]
        properties = girder.span_properties(i, own)
        model = model.with_beams(pairs[span_of == i], properties, name="beam" if n == 1 else f"span{i + 1}")
    model = supported(model, x, chosen).with_damping(damping)
    compiled = compile_model(model)
    path = path_on_beams(model, compiled.table, range(len(x)))
    return Structure(
        system=compiled.system,
        lines={MAIN_LINE: path.transformed(compiled.system.elimination)},
        name=name,
        model=model,
        facts={"length": float(ends[-1])},
    )


def _default_supports(ends: np.ndarray, has_area: bool) -> list[SupportAt]:
    last = len(ends) - 1
    names = ["left", *(f"support{i + 1}" for i in range(1, last)), "right"]
    first = ("x", "z") if has_area else ("z",)
    return [SupportAt(float(x), first if i == 0 else ("z",), name=names[i]) for i, x in enumerate(ends)]


def _fixed(support: SupportAt) -> Sequence[str]:
    if support.fixed is not None:
        return support.fixed
    held = {*(support.stiffness or {}), *(support.damping or {}), *(support.motion or {})}
    return () if "z" in held else ("z",)


def supported(model: Model, x: np.ndarray, supports: list[SupportAt]) -> Model:
    """The model with supports at the nearest of its nodes at x (n,), the first ones of the model."""
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
