"""Parts of a model from a mesh: what the elements of each named set are made of."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.elements import plane
from axlespan.elements.continuum import Formulation
from axlespan.elements.shell_material import ShellMaterial
from axlespan.elements.shell_normals import side_normals
from axlespan.errors import InputError
from axlespan.model.continuum_parts import PlanePart, PlaneState, SolidPart
from axlespan.model.dofs import COMPONENTS
from axlespan.model.materials import BeamSection, Material, require_positive
from axlespan.model.mesh import CELL_KINDS, Mesh
from axlespan.model.parts import BarPart, BeamPart, Part
from axlespan.model.shell_parts import ShellPart

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Solids:
    """Solid elements: hex8, hex20, tet4, tet10, wedge6."""

    material: Material
    elasticity: npt.ArrayLike | None = None  # (6, 6), of an anisotropic material [N/m^2]
    formulation: Formulation = "incompatible"
    lumped_mass: bool = False


@dataclass(frozen=True, eq=False)
class Planes:
    """Plane elements of a plane model: quad4, quad8, tri3, tri6."""

    material: Material
    thickness: float = 1.0  # width along y [m]
    state: PlaneState = "stress"
    elasticity: npt.ArrayLike | None = None  # (6, 6), of an anisotropic material [N/m^2]
    formulation: Formulation = "incompatible"
    lumped_mass: bool = False


@dataclass(frozen=True, eq=False)
class Shells:
    """Shell elements: quad4, tri3."""

    material: Material | ShellMaterial
    thickness: float  # [m]
    offset: float = 0.0  # from the nodes to the mid-surface, along the normal [m]
    density: float | None = None  # [kg/m^3]; that of the material when left out
    curved: bool = False  # the elements approximate a curved surface; flat parts may fold all the same
    lumped_mass: bool = False


@dataclass(frozen=True, eq=False)
class Beams:
    """Beam elements: line2."""

    material: Material
    section: BeamSection
    up: Sequence[float] | None = None  # a direction in the local x-z plane; vertical when left out
    offset: Sequence[float] = (0.0, 0.0, 0.0)  # from the nodes to the axis, in global axes [m]


@dataclass(frozen=True, eq=False)
class Bars:
    """Bars (trusses): line2."""

    material: Material
    area: float  # [m^2]


#: What the elements of a set are made of.
Section = Solids | Planes | Shells | Beams | Bars
_SHAPES = {
    Solids: ("hex8", "hex20", "tet4", "tet10", "wedge6"),
    Planes: ("quad4", "quad8", "tri3", "tri6"),
    Shells: ("quad4", "tri3"),
    Beams: ("line2",),
    Bars: ("line2",),
}


@dataclass(frozen=True, eq=False)
class _Block:
    """The elements of one kind in a set."""

    name: str  # of the part
    kind: str
    nodes: IntArray
    labels: IntArray


def parts_from_mesh(
    mesh: Mesh, sections: Mapping[str, Section], *, first_node: int = 0, in_plane: bool = False
) -> tuple[Part, ...]:
    """Parts of a model, one for each element set (for each kind, where a set has several).

    Parameters
    ----------
    mesh : Mesh
        Its nodes are those of the model from ``first_node`` on.
    sections : mapping of str to Section
        What the elements of a set are made of, by the name of the set. A part has the name of its set,
        ``set/kind`` where the set has several kinds of elements.
    first_node : int
        Number of the mesh's first node in the model.
    in_plane : bool
        Whether the model is a plane one, in x and z.

    Raises
    ------
    InputError
        If there is no such set, its elements don't fit the section, an element has two sections, or
        elements of the highest dimension have none.
    """
    taken = [np.zeros(len(block), dtype=bool) for block in mesh.blocks]
    parts: list[Part] = []
    for name, section in sections.items():
        if isinstance(section, Planes) != in_plane and isinstance(section, (Solids, Planes, Shells)):
            fix = "Planes go with a plane model, solids and shells with one in space"
            raise InputError("does not fit the model", field=f"section of '{name}'", fix=fix)
        blocks = list(_blocks(mesh, name, section, taken))
        parts += _parts(section, blocks, mesh, name, in_plane)
    _check_all_taken(mesh, taken)
    return tuple(_moved(part, first_node) for part in parts)


def _blocks(
    mesh: Mesh, name: str, section: Section, taken: list[npt.NDArray[np.bool_]]
) -> Iterator[_Block]:
    chosen = [(block, elements) for block, elements in mesh.elements_of_set(name) if len(elements)]
    if not chosen:
        raise InputError("has no elements", field="element set", value=name)
    several = len({mesh.blocks[block].kind for block, _ in chosen}) < len(chosen)
    names = [name] * len(chosen)
    if len(chosen) > 1:
        names = [f"{name}/{mesh.blocks[block].kind}" for block, _ in chosen]
    if several:  # blocks of the same kind
        names = [f"{own}/{i + 1}" for i, own in enumerate(names)]
    for own, (block, elements) in zip(names, chosen, strict=True):
        cells = mesh.blocks[block]
        if cells.kind not in _SHAPES[type(section)]:
            raise InputError(
                f"can't be {type(section).__name__.lower()}",
                field=f"elements of '{name}'",
                value=cells.kind,
                fix=f"Those are {', '.join(_SHAPES[type(section)])}",
            )
        twice = elements[taken[block][elements]]
        if len(twice):
            raise InputError(
                "has two sections", field=f"element of '{name}'", value=int(cells.labels[twice[0]])
            )
        taken[block][elements] = True
        yield _Block(own, cells.kind, cells.nodes[elements], cells.labels[elements])


def _parts(section: Section, blocks: list[_Block], mesh: Mesh, name: str, in_plane: bool) -> Iterator[Part]:
    if isinstance(section, Shells):
        yield from _shells(section, blocks, mesh, name)
        return
    for block in blocks:
        if isinstance(section, Solids):
            yield SolidPart.of(
                block.name,
                block.kind,
                block.nodes,
                section.material,
                elasticity=section.elasticity,
                formulation=section.formulation,
                lumped_mass=section.lumped_mass,
                labels=block.labels,
            )
        elif isinstance(section, Planes):
            yield PlanePart.of(
                block.name,
                block.kind,
                _counterclockwise(block, mesh.points),
                section.material,
                thickness=section.thickness,
                state=section.state,
                elasticity=section.elasticity,
                formulation=section.formulation,
                lumped_mass=section.lumped_mass,
                labels=block.labels,
            )
        elif isinstance(section, Beams):
            yield _beams(section, block, in_plane)
        elif isinstance(section, Bars):
            yield _bars(section, block, in_plane)


def _shells(section: Shells, blocks: list[_Block], mesh: Mesh, name: str) -> Iterator[Part]:
    if section.offset != 0.0:
        _check_oriented(blocks, name)
    for block in blocks:
        part = ShellPart.of(
            block.name,
            block.kind,
            block.nodes,
            section.material,
            thickness=section.thickness,
            density=section.density,
            offset=section.offset,
            lumped_mass=section.lumped_mass,
            labels=block.labels,
        )
        yield part if not section.curved else part.with_curvature(mesh.points)


def _beams(section: Beams, block: _Block, in_plane: bool) -> BeamPart:
    properties = section.section.properties(section.material)
    components: tuple[str, ...] = COMPONENTS
    if in_plane:
        components = ("x", "z", "ry") if section.section.area is not None else ("z", "ry")
    elif section.section.area is None:
        raise InputError("is needed for beams in space", field=f"area of '{block.name}'", value=None)
    up = None if section.up is None else np.asarray(section.up, float)
    offset = np.asarray(section.offset, float)
    return BeamPart(
        block.name, block.nodes, properties, components, up, offset if np.any(offset != 0.0) else None
    )


def _bars(section: Bars, block: _Block, in_plane: bool) -> BarPart:
    area, n = require_positive(section.area, f"area of '{block.name}'"), len(block.nodes)
    return BarPart(
        block.name,
        block.nodes,
        np.full(n, section.material.youngs_modulus * area),
        np.full(n, section.material.density * area),
        ("x", "z") if in_plane else ("x", "y", "z"),
    )
