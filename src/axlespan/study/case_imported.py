"""Structures and vehicles that come from files: finite element meshes and matrices."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Literal, Self

from pydantic import Discriminator, Field, model_validator

from axlespan.errors import InputError
from axlespan.study.case_damping import StructuralDamping
from axlespan.study.case_support import Support
from axlespan.study.check_lists import Several
from axlespan.study.checks import Measured, Part
from axlespan.study.faults import InputErrors, listed, nearest
from axlespan.study.kinds import ExistingFile, tag
from axlespan.study.quantities import (
    Area,
    Density,
    Modulus,
    PoissonRatio,
    SecondMoment,
    Text,
    Thickness,
)
from axlespan.units import LENGTH, NUMBER

File = Annotated[Path, ExistingFile(), Field(examples=["bridge.msh"])]
Point = Annotated[tuple[float, ...], Several(Measured(LENGTH), exactly=3, example="[0 m, 0 m, 0 m]")]
Positions = Annotated[tuple[float, ...], Several(Measured(LENGTH), increasing=True, example="[0 m, 5 m]")]


class Material(Part):
    """A linear elastic, isotropic material."""

    youngs_modulus: Modulus
    """Young's modulus."""
    poisson_ratio: Annotated[PoissonRatio, Field(examples=["0.2"])]
    """Poisson's ratio."""
    density: Density
    """Mass per volume."""


class Section(Part):
    """What the elements of one set of the mesh are made of; which values it needs depends on their type."""

    material: Annotated[Text, Field(examples=["concrete"])]
    """Name of one of the materials."""
    thickness: Thickness | None = None
    """Of shells."""
    area: Area | None = None
    """Of beams."""
    second_moment_y: SecondMoment | None = None
    """Of beams: bending in the local x-z plane."""
    second_moment_z: SecondMoment | None = None
    """Of beams: bending in the local x-y plane."""
    torsion_constant: SecondMoment | None = None
    """Of beams."""
    shear_area_y: Area | None = None
    """Of Timoshenko beams."""
    shear_area_z: Area | None = None
    """Of Timoshenko beams."""
    orientation: (
        Annotated[tuple[float, ...], Several(Measured(NUMBER), exactly=3, example="[0, 0, 1]")] | None
    ) = None
    """Of beams: a vector in the local x-z plane; vertical when left out."""


class MeshLine(Part):
    """Where wheels run on a mesh: along named nodes, or straight from one point to another."""

    nodes: Text | None = None
    """Name of the set of nodes in the mesh file."""
    from_: Annotated[Point | None, Field(alias="from")] = None
    """First point, x, y and z."""
    to: Point | None = None
    """Last point."""

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        points = (self.from_ is not None) + (self.to is not None)
        if (self.nodes is not None and points) or (self.nodes is None and points != 2):
            raise InputError(
                "must be given by nodes, or by from and to",
                fix="Write {from: [0 m, 0 m, 0 m], to: [25 m, 0 m, 0 m]}, or {nodes: rail}",
            )
        return self


class Mesh(Part):
    """A finite element mesh with its materials and sections."""

    file: File
    """Mesh file."""
    materials: Annotated[
        Mapping[str, Material],
        Field(examples=["{concrete: {youngs_modulus: 34 GPa, poisson_ratio: 0.2, density: 2500 kg/m^3}}"]),
    ]
    """Materials by their names."""
    sections: Annotated[Mapping[str, Section], Field(examples=["{deck: {material: concrete}}"])]
    """Sections by the names of the element sets of the mesh."""

    @model_validator(mode="after")
    def _materials_known(self) -> Self:
        faults = []
        for name, section in self.sections.items():
            if section.material not in self.materials:
                near = nearest(section.material, self.materials)
                known = f"Known are {listed(self.materials)}" if self.materials else "Add it to materials"
                faults.append(
                    InputError(
                        "no such material",
                        field=f"sections.{name}.material",
                        fix=f"Did you mean {near}?" if near else known,
                    )
                )
        if faults:
            raise InputErrors(faults)
        return self


class MeshStructure(Mesh):
    """A structure from a mesh file."""

    kind: Literal["mesh"]
    supports: Annotated[tuple[Support, ...], Field(examples=["[{at: bearings, fixed: [x, y, z]}]"])]
    """Supports, at sets of nodes of the mesh."""
    running_line: Annotated[MeshLine, Field(examples=["{nodes: rail}"])]
    """Where wheels run."""
    damping: StructuralDamping | None = None
    """Structural damping; none when left out."""


class MatricesLine(Part):
    """Where wheels run on a structure of matrices: vertical d.o.f. along the line and their positions."""

    dofs: tuple[Text, ...] | None = None
    """Numbers (from 0) or names of the vertical d.o.f., in the direction of travel."""
    positions: Positions | None = None
    """Position of each."""
    file: Annotated[Path, ExistingFile()] | None = None
    """Table of two columns, d.o.f. and position, in place of the two lists."""

    @model_validator(mode="after")
    def _as_many(self) -> Self:
        if (self.file is None) == (self.dofs is None and self.positions is None):
            raise InputError(
                "must be given by file, or by dofs and positions",
                fix="Write {dofs: [0, 2], positions: [0 m, 5 m]}",
            )
        if self.file is None and len(self.dofs or ()) != len(self.positions or ()):
            raise InputError(
                "must have as many positions as dofs: "
                f"there are {len(self.positions or ())} and {len(self.dofs or ())}"
            )
        return self


class MatricesStructure(Part):
    """A structure given by its matrices, from any finite element program."""

    kind: Literal["matrices"]
    stiffness: File
    """Stiffness matrix."""
    mass: File
    """Mass matrix."""
    damping: (
        Annotated[
            Annotated[Path, ExistingFile(), tag("file")] | Annotated[StructuralDamping, tag("law")],
            Discriminator(lambda raw: "<file>" if isinstance(raw, (str, Path)) else "<law>"),
        ]
        | None
    ) = None
    """Damping matrix, or damping as for other structures; none when left out."""
    coordinates: Annotated[Path, ExistingFile()] | None = None
    """Coordinates of the nodes, for plots."""
    running_line: Annotated[MatricesLine, Field(examples=["{dofs: [0, 2], positions: [0 m, 5 m]}"])]
    """Where wheels run."""
    supports: tuple[Support, ...] = ()
    """Supports, at named d.o.f.; none when the matrices hold them already."""
