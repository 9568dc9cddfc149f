"""From the structure of a case to a structure: beams, meshes, matrices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from axlespan.bridges import (
    Column,
    GridBeam,
    Station,
    beam_grid,
    continuous_beam,
    frame,
    simple_span,
    simple_spans,
)
from axlespan.bridges.condition import Damage, in_condition
from axlespan.bridges.spring_laws import with_spring_law
from axlespan.bridges.unilateral import with_unilateral_springs
from axlespan.errors import InputError
from axlespan.model.parts import SpringPart
from axlespan.running.structure import Structure
from axlespan.study import case_laws, case_structure
from axlespan.study.build_elements import with_elements
from axlespan.study.build_matrices import structure_of_matrices
from axlespan.study.build_mesh import structure_of_mesh
from axlespan.study.build_supports import damping_of, supports_of_beams
from axlespan.study.build_track import laid_on, structure_of_track
from axlespan.study.built import BuiltStructure
from axlespan.study.case_grid import BeamGrid
from axlespan.study.case_imported import MeshStructure
from axlespan.study.case_track import TrackStructure


def structure_of(case: case_structure.Structure) -> BuiltStructure:
    """Build a structure.

    Raises
    ------
    InputError
        If something is wrong that only shows now; fields are paths under the structure.
    """
    built = _structure_of(case)
    for number, name in enumerate(getattr(case, "may_lift", ())):
        try:
            structure = with_unilateral_springs(built.structure, f"support {name}")
        except InputError as error:
            if name in case.may_lift[:number]:  # type: ignore[union-attr]
                raise InputError("is named twice", field=f"may_lift.{number}", value=name) from error
            raise InputError(
                "must be a support with a stiffness along z",
                field=f"may_lift.{number}",
                value=name,
                fix="Give it stiffness: {z: 1 GN/m} in place of fixed",
            ) from error
        built = replace(built, structure=structure)
    built = _with_laws(built, getattr(case, "nonlinear_springs", ()))
    own = getattr(case, "own_elements", ())
    facts = tuple(f"element     {item.element} of {item.file.name} on {', '.join(item.dofs)}" for item in own)
    structure = with_elements(built.structure, own)
    return replace(built, structure=structure, facts=(*built.facts, *facts))


def _with_laws(built: BuiltStructure, springs: Sequence[case_laws.SpringsWithLaw]) -> BuiltStructure:
    """The structure with springs that follow laws; a group of a track in space is meant with all its sides."""
    model = built.structure.model
    names = dict.fromkeys(p.name for p in model.parts if isinstance(p, SpringPart)) if model else {}
    for number, item in enumerate(springs):
        whole = [name for name in names if name == item.springs or name.partition("-")[0] == item.springs]
        try:
            structure = built.structure
            for name in whole or [item.springs]:
                gap = case_laws.gap_of(item.law)
                one_sided = isinstance(item.law, case_laws.UnilateralLaw)
                law = item.law.law if one_sided else item.law.law()
                structure = with_spring_law(structure, name, law, component=item.direction, gap=gap)
        except InputError as error:
            across = error.rule.startswith("has no springs along")
            field, fix = ("direction", "Use direction: z") if across else ("springs", error.fix)
            raise InputError(
                error.rule, field=f"nonlinear_springs.{number}.{field}", value=getattr(item, field), fix=fix
            ) from error
        count = len(structure.system.nonlinear) - len(built.structure.system.nonlinear)
        n = sum(len(springs.gap) for springs in structure.system.nonlinear[-count:])
        fact = f"law         {item.law.kind}: {n} springs of {item.springs} along {item.direction}"
        built = replace(built, structure=structure, facts=(*built.facts, fact))
    return built


def _structure_of(case: case_structure.Structure) -> BuiltStructure:
    if isinstance(case, case_structure.SimpleSpan):
        return laid_on(_as_it_is(_simple_span(case), case), case.track)
    if isinstance(case, case_structure.ContinuousBeam):
        return laid_on(_as_it_is(_continuous_beam(case), case), case.track)
    if isinstance(case, case_structure.SimpleSpans):
        return laid_on(_as_it_is(_simple_spans(case), case), case.track)
    if isinstance(case, case_structure.Frame):
        return laid_on(_as_it_is(_frame(case), case), case.track)
    if isinstance(case, BeamGrid):
        return laid_on(BuiltStructure(_grid(case)), case.track)
    if isinstance(case, TrackStructure):
        return structure_of_track(case)
    if isinstance(case, MeshStructure):
        return laid_on(structure_of_mesh(case), case.track)
    return structure_of_matrices(case)


def _as_it_is(
    structure: Structure,
    case: case_structure.SimpleSpan
    | case_structure.ContinuousBeam
    | case_structure.SimpleSpans
    | case_structure.Frame,
) -> BuiltStructure:
    """The structure with its damage, at its temperature."""
    zones = [Damage(zone.from_, zone.to, zone.stiffness) for zone in case.damage]
    factor = 1.0 if case.temperature is None else case.temperature.factor
    return BuiltStructure(in_condition(structure, zones, factor))


def _simple_span(case: case_structure.SimpleSpan) -> Structure:
    return simple_span(
        length=case.length,
        youngs_modulus=case.youngs_modulus,
        second_moment=case.second_moment,
        mass_per_length=case.mass_per_length,
        elements=case.elements,
        area=case.area,
        shear_area=case.shear_area,
        poisson_ratio=0.2 if case.poisson_ratio is None else case.poisson_ratio,
        damping=damping_of(case.damping),
        supports=supports_of_beams(case.supports),
    )


def _continuous_beam(case: case_structure.ContinuousBeam) -> Structure:
    return continuous_beam(**_spans(case), supports=supports_of_beams(case.supports))


def _simple_spans(case: case_structure.SimpleSpans) -> Structure:
    bearings = case.bearings
    return simple_spans(
        **_spans(case),
        bearing_stiffness=bearings.stiffness if bearings else None,
        bearing_damping=bearings.damping if bearings else None,
    )


def _frame(case: case_structure.Frame) -> Structure:
    columns = [
        Column(
            position=column.at,
            height=column.height,
            youngs_modulus=column.youngs_modulus,
            second_moment=column.second_moment,
            area=column.area,
            mass_per_length=column.mass_per_length or 0.0,
            top=column.top,
            base=column.base,
            base_stiffness=column.base_stiffness.given() if column.base_stiffness else None,
        )
        for column in case.columns
    ]
    return frame(**_spans(case), columns=columns, supports=supports_of_beams(case.supports) or ())


def _spans(
    case: case_structure.ContinuousBeam | case_structure.SimpleSpans | case_structure.Frame,
) -> dict[str, Any]:
    """What the decks of several spans have in common."""
    spans = case.spans
    stations = [Station(item.at, item.second_moment, item.mass_per_length) for item in case.stations or ()]
    return {
        "spans": [span.length for span in spans],
        "youngs_modulus": [_given(span.youngs_modulus) for span in spans],
        "second_moment": [_given(span.second_moment) for span in spans],
        "mass_per_length": [_given(span.mass_per_length) for span in spans],
        "elements": [int(_given(span.elements)) for span in spans],
        "area": [span.area for span in spans],
        "shear_area": [span.shear_area for span in spans],
        "poisson_ratio": [0.2 if span.poisson_ratio is None else span.poisson_ratio for span in spans],
        "damping": damping_of(case.damping),
        "stations": stations if case.stations is not None else None,
    }


def _grid(case: BeamGrid) -> Structure:
    sections = [
        GridBeam(
            section.second_moment, section.torsion_constant, section.area, section.mass_per_length or 0.0
        )
        for section in (case.girder, case.cross_beam, case.end_beam or case.cross_beam)
    ]
    girder, cross_beam, end_beam = sections
    return beam_grid(
        length=case.length,
        girders=case.girders,
        girder=girder,
        cross_beam=cross_beam,
        end_beam=end_beam,
        youngs_modulus=case.youngs_modulus,
        poisson_ratio=case.poisson_ratio,
        elements=case.elements,
        cross_beams=case.cross_beams,
        skew=case.skew,
        track_centers=case.track_centers,
        bearing_stiffness=case.bearings.stiffness if case.bearings else None,
        bearing_damping=case.bearings.damping if case.bearings else None,
        damping=damping_of(case.damping),
    )


def _given(value: float | None) -> float:
    assert value is not None  # the schema completes the spans
    return value
