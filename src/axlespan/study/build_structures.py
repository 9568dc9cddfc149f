"""From the structure of a case to a structure: beams, meshes, matrices."""

from __future__ import annotations

from axlespan.bridges import continuous_beam, simple_span
from axlespan.running.structure import Structure
from axlespan.study import case_structure
from axlespan.study.build_matrices import structure_of_matrices
from axlespan.study.build_mesh import structure_of_mesh
from axlespan.study.build_supports import damping_of, supports_of_beams
from axlespan.study.built import BuiltStructure
from axlespan.study.case_imported import MeshStructure


def structure_of(case: case_structure.Structure) -> BuiltStructure:
    """Build a structure.

    Raises
    ------
    InputError
        If something is wrong that only shows now; fields are paths under the structure.
    """
    if isinstance(case, case_structure.SimpleSpan):
        return BuiltStructure(_simple_span(case))
    if isinstance(case, case_structure.ContinuousBeam):
        return BuiltStructure(_continuous_beam(case))
    if isinstance(case, MeshStructure):
        return structure_of_mesh(case)
    return structure_of_matrices(case)


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
    spans = case.spans
    return continuous_beam(
        spans=[span.length for span in spans],
        youngs_modulus=[_given(span.youngs_modulus) for span in spans],
        second_moment=[_given(span.second_moment) for span in spans],
        mass_per_length=[_given(span.mass_per_length) for span in spans],
        elements=[int(_given(span.elements)) for span in spans],
        area=[span.area for span in spans],
        shear_area=[span.shear_area for span in spans],
        poisson_ratio=[0.2 if span.poisson_ratio is None else span.poisson_ratio for span in spans],
        damping=damping_of(case.damping),
        supports=supports_of_beams(case.supports),
    )


def _given(value: float | None) -> float:
    assert value is not None  # the schema completes the spans
    return value
