"""Structures that come from finite element meshes: read from a file, or made of equal cells."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from axlespan.errors import InputError
from axlespan.study.case_damping import StructuralDamping
from axlespan.study.case_elements import OwnElements
from axlespan.study.case_laws import NonlinearSprings
from axlespan.study.case_made_mesh import MadeMesh
from axlespan.study.case_nodes import (
    Nodes,
    NodeSupport,
    Offset,
    Point,
    PointMass,
    RigidLink,
    Spring,
    Start,
    Tie,
)
from axlespan.study.case_support import MayLift
from axlespan.study.case_track import Laid
from axlespan.study.check_lists import Several
from axlespan.study.checks import Measured, OneOf, Part
from axlespan.study.faults import InputErrors, listed, nearest
from axlespan.study.kinds import ExistingFile
from axlespan.study.quantities import (
    Area,
    Density,
    Flag,
    MassPerLength,
    Modulus,
    Name,
    PoissonRatio,
    SecondMoment,
    Text,
    Thickness,
)
from axlespan.units import LENGTH, NUMBER

File = Annotated[Path, ExistingFile(), Field(examples=["bridge.msh"])]

#: What the elements of a set may be.
SECTION_KINDS = ("solid", "shell", "plane", "beam", "bar")
LENGTH_UNITS = ("m", "cm", "mm", "ft", "in")


class Material(Part):
    """A linear elastic, isotropic material."""

    youngs_modulus: Modulus
    """Young's modulus."""
    poisson_ratio: Annotated[PoissonRatio, Field(examples=["0.2"])]
    """Poisson's ratio."""
    density: Density
    """Mass per volume."""


class Section(Part):
    """What the elements of one set of the mesh are made of; which values it needs depends on its kind."""

    material: Annotated[Text, Field(examples=["concrete"])]
    """Name of one of the materials."""
    kind: Annotated[str, OneOf(SECTION_KINDS)] | None = None
    """When left out: solid; shell (plane in a plane model); beam, or bar where there is an area only."""
    formulation: Annotated[str, OneOf(("incompatible", "full"))] | None = None
    """Of solids and planes: with incompatible modes, good in bending, or fully integrated displacements."""
    thickness: Thickness | None = None
    """Of shells, and of planes along y."""
    offset: Offset | None = None
    """From the nodes to the middle surface of shells along their normal; to the axis of beams [x, y, z]."""
    state: Annotated[str, OneOf(("stress", "strain"))] | None = None
    """Of planes: plane stress, as in walls, or plane strain."""
    area: Area | None = None
    """Of beams and bars."""
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
    mass_per_length: MassPerLength | None = None
    """Of beams, in place of density times area."""
    orientation: (
        Annotated[tuple[float, ...], Several(Measured(NUMBER), exactly=3, example="[0, 0, 1]")] | None
    ) = None
    """Of beams: a vector in the local x-z plane; vertical when left out."""
    lumped_mass: Flag | None = None
    """Of solids, planes and shells: whether the mass stands at the nodes alone."""


class MeshLine(Part):
    """Where wheels run on a mesh: along nodes, along a polyline, or straight from one point to another."""

    nodes: Nodes | None = None
    """Set of nodes, or coordinates of the nodes; they are ordered along the line that they form."""
    from_: Annotated[Point | None, Field(alias="from")] = None
    """First point, x, y and z."""
    to: Point | None = None
    """Last point."""
    points: Annotated[tuple[Point, ...] | None, Field(examples=["[[0 m, 0 m, 0 m], [25 m, 0 m, 0 m]]"])] = (
        None
    )
    """Points of a polyline in the direction of travel."""
    start: Start = 0.0
    """Position of its first point along the line."""
    surface: Text | None = None
    """Set of elements or of nodes on whose surface it runs; all surfaces that look up when left out."""
    tolerance: Annotated[float, Measured(LENGTH, above=0.0)] | None = None
    """Largest distance from that surface; 5 % of the size of an element's face when left out."""

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        ends = (self.from_ is not None) + (self.to is not None)
        ways = (self.nodes is not None) + (self.points is not None) + (ends > 0)
        if ways != 1 or ends == 1:
            raise InputError(
                "must be given by nodes, or by from and to",
                fix="Write {from: [0 m, 0 m, 0 m], to: [25 m, 0 m, 0 m]}, or {nodes: rail}",
            )
        if self.points is not None and len(self.points) < 2:
            raise InputError("must be at least two points", field="points")
        return self


class Mesh(Part):
    """A finite element mesh with its materials and sections."""

    file: Annotated[Path | None, ExistingFile(), Field(examples=["bridge.msh"])] = None
    """Mesh file: Gmsh (.msh), Abaqus (.inp), or one of the formats of meshlane."""
    mesh: MadeMesh | None = None
    """A mesh of equal cells, in place of a file."""
    unit: Annotated[str, OneOf(LENGTH_UNITS)] = "m"
    """Unit of the coordinates in the file."""
    up: Annotated[str, OneOf(("y", "z"))] = "z"
    """Axis of the file that points up; y becomes z and z becomes -y."""
    plane: Flag = False
    """Whether the model is a plane one, in x and z."""
    merge: Annotated[float, Measured(LENGTH, above=0.0, believable=(1e-9, 1.0))] | None = None
    """Nodes no farther apart than this become one."""
    points: Annotated[Mapping[Name, Point], Field(examples=["{bearing: [0 m, 0 m, -0.5 m]}"])] = {}
    """Further nodes by their names, for links, springs, masses and supports."""
    materials: Annotated[
        Mapping[str, Material],
        Field(examples=["{concrete: {youngs_modulus: 34 GPa, poisson_ratio: 0.2, density: 2500 kg/m^3}}"]),
    ]
    """Materials by their names."""
    sections: Annotated[Mapping[str, Section], Field(examples=["{deck: {material: concrete}}"])]
    """Sections by the names of the element sets of the mesh."""
    masses: tuple[PointMass, ...] = ()
    """Masses at nodes."""
    springs: tuple[Spring, ...] = ()
    """Springs and dashpots between nodes."""
    rigid_links: tuple[RigidLink, ...] = ()
    """Nodes that follow another one as a rigid body."""
    ties: tuple[Tie, ...] = ()
    """Nodes that are tied to others at the same place."""

    @model_validator(mode="after")
    def _one_mesh(self) -> Self:
        if self.file is None and self.mesh is None:
            raise InputError("is missing", field="file", fix="Add file: bridge.msh, or mesh: {box: ...}")
        if self.file is not None and self.mesh is not None:
            raise InputError("says again what file says", field="mesh", fix="Keep one of the two")
        return self

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


def require_a_line(line: Any, lines: Mapping[str, Any] | None, example: str) -> None:
    """Require one running line, or several with names.

    Raises
    ------
    InputError
        With the field ``running_line`` or ``running_lines``.
    """
    if line is None and not lines:
        raise InputError("is missing", field="running_line", fix=f"Add running_line: {example}")
    if line is not None and lines is not None:
        raise InputError("says again where wheels run", field="running_lines", fix="Keep one of the two")


class MeshStructure(Mesh):
    """A structure from a mesh."""

    kind: Literal["mesh"]
    supports: Annotated[tuple[NodeSupport, ...], Field(examples=["[{at: bearings, fixed: [x, y, z]}]"])]
    """Supports, at nodes of the mesh."""
    running_line: Annotated[MeshLine | None, Field(examples=["{nodes: rail}"])] = None
    """Where wheels run."""
    running_lines: Mapping[Name, MeshLine] | None = None
    """Several running lines by their names, in place of one; the first is the main one."""
    damping: StructuralDamping | None = None
    """Structural damping; none when left out."""
    may_lift: MayLift = ()
    """Supports on springs that only push: bearings that may lift. Own weight acts first then."""
    nonlinear_springs: NonlinearSprings = ()
    """Springs and dashpots that follow a law: pads, ballast, supports. Own weight acts first then."""
    own_elements: OwnElements = ()
    """Nonlinear elements of one's own, written in Python. Own weight acts first then."""
    track: Laid = None
    """Track on the running line, or in space on two running lines left and right; none when left out."""

    @model_validator(mode="after")
    def _runs(self) -> Self:
        require_a_line(self.running_line, self.running_lines, "{nodes: rail}")
        return self
