"""What the element sets of a mesh are made of: from the case to the sections of a model."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from axlespan.elements.continuum import Formulation
from axlespan.errors import InputError
from axlespan.model import from_mesh
from axlespan.model.continuum_parts import PlaneState
from axlespan.model.materials import BeamSection, Material
from axlespan.model.mesh import CELL_KINDS
from axlespan.model.mesh import Mesh as MeshValue
from axlespan.study.case_imported import Mesh, Section
from axlespan.study.faults import InputErrors, listed, nearest

#: Values that each kind of section may have beside material and kind; those with True it must have.
VALUES: Mapping[str, Mapping[str, bool]] = MappingProxyType(
    {
        "solid": {"formulation": False, "lumped_mass": False},
        "shell": {"thickness": True, "offset": False, "lumped_mass": False},
        "plane": {"thickness": True, "state": False, "formulation": False, "lumped_mass": False},
        "beam": {
            **{"area": True, "second_moment_y": True, "second_moment_z": True, "torsion_constant": True},
            **{"shear_area_y": False, "shear_area_z": False, "mass_per_length": False},
            **{"orientation": False, "offset": False},
        },
        "bar": {"area": True},
    }
)
# What beams in a plane can do without.
_LATERAL = ("second_moment_z", "torsion_constant", "shear_area_y")
_DIMENSION = {"solid": 3, "shell": 2, "plane": 2, "beam": 1, "bar": 1}
_EXAMPLE = {
    "thickness": "300 mm",
    "area": "0.5 m^2",
    "second_moment_y": "0.9 m^4",
    "second_moment_z": "0.9 m^4",
    "torsion_constant": "0.4 m^4",
}


def sections_of(case: Mesh, mesh: MeshValue) -> dict[str, from_mesh.Section]:
    """Sections by element set, for :meth:`axlespan.model.model.Model.with_mesh`.

    Raises
    ------
    InputErrors
        For sets that the mesh doesn't have, and values that the elements need or cannot have.
    """
    faults: list[InputError] = []
    made: dict[str, from_mesh.Section] = {}
    for name, section in case.sections.items():
        try:
            kind = section_kind(case, mesh, name, section)
            material = case.materials[section.material]
            made[name] = _made(
                section, kind, Material(material.youngs_modulus, material.poisson_ratio, material.density)
            )
        except InputError as error:
            faults.append(error)
    if faults:
        raise InputErrors(faults)
    return made


def section_kind(case: Mesh, mesh: MeshValue, name: str, section: Section) -> str:
    """What the elements of a set are: solid, shell, plane, beam or bar.

    Raises
    ------
    InputError
        If there is no such set, or the section doesn't fit its elements.
    """
    place = f"sections.{name}"
    if name not in mesh.element_sets:
        known = sorted(mesh.element_sets)
        near = nearest(name, known, likeness=0.6)
        fix = f"Did you mean {near}?" if near else f"Sets are {listed(known)}" if known else None
        raise InputError("the mesh has no such set of elements", field=place, fix=fix)
    kinds = list(dict.fromkeys(mesh.blocks[block].kind for block, _ in mesh.element_sets[name]))
    dimensions = {CELL_KINDS[kind].dimension for kind in kinds}
    if len(dimensions) != 1 or dimensions == {0}:
        what = " and ".join(kinds) or "no elements"
        raise InputError(f"must have elements of one dimension, and has {what}", field=place)
    (dimension,) = dimensions
    kind = section.kind or _usual(section, dimension, case.plane)
    if _DIMENSION[kind] != dimension:
        fitting = listed(name for name, of in _DIMENSION.items() if of == dimension)
        rule = f"must be {fitting}: the elements of '{name}' are {' and '.join(kinds)}"
        raise InputError(rule, field=f"{place}.kind")
    if (kind == "plane") != case.plane and kind in ("plane", "solid", "shell"):
        fix = "Write plane: true" if kind == "plane" else "Delete plane: true"
        rule = "needs a plane model" if kind == "plane" else f"must not be {kind} in a plane model"
        raise InputError(rule, field=place, fix=fix)
    _check_values(section, kind, place, case.plane)
    return kind


def _usual(section: Section, dimension: int, in_plane: bool) -> str:
    if dimension == 1:
        return "bar" if section.second_moment_y is None and section.area is not None else "beam"
    if dimension == 2:
        return "plane" if in_plane else "shell"
    return "solid"


def _check_values(section: Section, kind: str, place: str, in_plane: bool) -> None:
    values, faults = VALUES[kind], []
    for name in section.given():
        if name not in ("material", "kind", *values):
            rule = f"is not for {kind}s, which these elements are"
            faults.append(
                InputError(rule, field=f"{place}.{name}", fix=f"Values of {kind}s are {listed(values)}")
            )
    free = (*_LATERAL, "area") if in_plane and kind == "beam" else ()
    for name, needed in values.items():
        if needed and getattr(section, name) is None and name not in free:
            fix = f"Add {name}: {_EXAMPLE[name]}"
            faults.append(InputError(f"is missing for {kind}s", field=f"{place}.{name}", fix=fix))
    wanted = {"shell": 1, "beam": 3}.get(kind)
    if section.offset is not None and wanted and len(section.offset) != wanted:
        fix = "Write offset: 0.3 m" if wanted == 1 else "Write offset: [0 m, 0 m, 0.3 m]"
        rule = "must be one length, along the normal" if wanted == 1 else "must be three lengths, x, y and z"
        faults.append(InputError(rule, field=f"{place}.offset", fix=fix))
    if faults:
        raise InputErrors(faults)


def _made(section: Section, kind: str, material: Material) -> from_mesh.Section:
    formulation: Formulation = "full" if section.formulation == "full" else "incompatible"
    lumped = bool(section.lumped_mass)
    if kind == "solid":
        return from_mesh.Solids(material, formulation=formulation, lumped_mass=lumped)
    thickness, offset = section.thickness or 0.0, section.offset or (0.0, 0.0, 0.0)
    if kind == "shell":
        return from_mesh.Shells(material, thickness, offset[0], lumped_mass=lumped)
    if kind == "plane":
        state: PlaneState = "strain" if section.state == "strain" else "stress"
        return from_mesh.Planes(material, thickness, state=state, formulation=formulation, lumped_mass=lumped)
    if kind == "bar":
        return from_mesh.Bars(material, section.area or 0.0)
    beam = BeamSection(
        second_moment=section.second_moment_y or 0.0,
        area=section.area,
        lateral_second_moment=section.second_moment_z or 0.0,
        torsion_constant=section.torsion_constant or 0.0,
        shear_area=section.shear_area_z,
        lateral_shear_area=section.shear_area_y,
        mass_per_length=section.mass_per_length,
    )
    return from_mesh.Beams(material, beam, section.orientation, offset)
