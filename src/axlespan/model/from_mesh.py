"""Parts of a model from a mesh: what the elements of each named set are made of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from axlespan.elements import plane, shells
from axlespan.elements.continuum import Formulation
from axlespan.elements.shells import ShellMaterial
from axlespan.errors import InputError
from axlespan.model.continuum_parts import PlanePart, PlaneState, SolidPart
from axlespan.model.dofs import COMPONENTS
from axlespan.model.materials import BeamSection, Material, require_positive
from axlespan.model.mesh import CELL_KINDS, Mesh
from axlespan.model.parts import BarPart, BeamPart, Part, checked_offset
from axlespan.model.shell_parts import ShellPart

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Local nodes of a plane element in the opposite order, from the same first corner.
_MIRRORED = {
    "tri3": [0, 2, 1],
    "tri6": [0, 2, 1, 5, 4, 3],
    "quad4": [0, 3, 2, 1],
    "quad8": [0, 3, 2, 1, 7, 6, 5, 4],
}


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
_MeshPart = SolidPart | PlanePart | ShellPart | BeamPart | BarPart
_SHAPES: Mapping[type, tuple[str, ...]] = {
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
    """Parts of a model, one for each element set (one for each kind, where a set has several).

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
    parts: list[_MeshPart] = []
    for name, section in sections.items():
        if in_plane != isinstance(section, Planes) and not isinstance(section, (Beams, Bars)):
            fix = "Planes go with a plane model, solids and shells with one in space"
            raise InputError("does not fit the model", field=f"section of '{name}'", fix=fix)
        parts += _parts(section, _blocks(mesh, name, section, taken), mesh.points, name, in_plane)
    _check_all_taken(mesh, taken)
    parts = _curved(parts, mesh.points)
    return tuple(replace(part, nodes=part.nodes + first_node) for part in parts)


def _blocks(mesh: Mesh, name: str, section: Section, taken: list[npt.NDArray[np.bool_]]) -> list[_Block]:
    by_kind: dict[str, list[tuple[IntArray, IntArray]]] = {}
    for number, elements in mesh.elements_of_set(name):
        cells, fitting = mesh.blocks[number], _SHAPES[type(section)]
        if cells.kind not in fitting:
            raise InputError(
                f"can't be {type(section).__name__.lower()}",
                field=f"elements of '{name}'",
                value=cells.kind,
                fix=f"Those are {', '.join(fitting)}",
            )
        twice = elements[taken[number][elements]]
        if len(twice):
            raise InputError(
                "has two sections", field=f"element of '{name}'", value=int(cells.labels[twice[0]])
            )
        taken[number][elements] = True
        if len(elements):
            by_kind.setdefault(cells.kind, []).append((cells.nodes[elements], cells.labels[elements]))
    if not by_kind:
        raise InputError("has no elements", field="element set", value=name)
    return [
        _Block(
            name if len(by_kind) == 1 else f"{name}/{kind}",
            kind,
            *(np.concatenate(arrays) for arrays in zip(*found, strict=True)),
        )
        for kind, found in by_kind.items()
    ]


def _check_all_taken(mesh: Mesh, taken: list[npt.NDArray[np.bool_]]) -> None:
    """Elements of the highest dimension without a section would be a hole in the structure."""
    highest = max((CELL_KINDS[block.kind].dimension for block in mesh.blocks), default=0)
    for number, block in enumerate(mesh.blocks):
        left = np.flatnonzero(~taken[number])
        if CELL_KINDS[block.kind].dimension < highest or not len(left):
            continue
        names = [
            name
            for name, parts in mesh.element_sets.items()
            if any(own == number and left[0] in elements for own, elements in parts)
        ]
        raise InputError(
            f"must have a section, as {len(left)} more {block.kind} must"
            if len(left) > 1
            else "must have a section",
            field="element",
            value=int(block.labels[left[0]]),
            fix=f"It is in the set '{names[0]}'" if names else "It is in no element set: put it in one",
        )


def _parts(
    section: Section, blocks: list[_Block], points: FloatArray, name: str, in_plane: bool
) -> list[_MeshPart]:
    if isinstance(section, Shells):
        if section.offset != 0.0:
            _check_oriented(blocks, name)
        return [_shells(section, block) for block in blocks]
    if isinstance(section, Beams):
        return [_beams(section, block, in_plane) for block in blocks]
    if isinstance(section, Bars):
        return [_bars(section, block, in_plane) for block in blocks]
    if isinstance(section, Planes):
        return [_planes(section, block, points) for block in blocks]
    return [
        SolidPart.of(
            block.name,
            block.kind,
            block.nodes,
            section.material,
            elasticity=section.elasticity,
            formulation=section.formulation,
            lumped_mass=section.lumped_mass,
            labels=block.labels,
        )
        for block in blocks
    ]


def _planes(section: Planes, block: _Block, points: FloatArray) -> PlanePart:
    part = PlanePart.of(
        block.name,
        block.kind,
        block.nodes,
        section.material,
        thickness=section.thickness,
        state=section.state,
        elasticity=section.elasticity,
        formulation=section.formulation,
        lumped_mass=section.lumped_mass,
        labels=block.labels,
    )
    if np.all(plane.areas(part.element, part.coordinates(points)) < 0.0):  # drawn seen from the other side
        return replace(part, nodes=part.nodes[:, _MIRRORED[block.kind]])
    return part


def _shells(section: Shells, block: _Block) -> ShellPart:
    return ShellPart.of(
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


def _curved(parts: list[_MeshPart], points: FloatArray) -> list[_MeshPart]:
    """Tell the shells of all sets together how far the surface turns away from them."""
    found: dict[shells.ShellKind, list[ShellPart]] = {}
    for part in parts:
        if isinstance(part, ShellPart):
            part.check(points)
            found.setdefault(part.shell_kind, []).append(part)
    if not found:
        return parts
    tables = {kind: np.concatenate([part.nodes for part in some]) for kind, some in found.items()}
    turning = shells.surface_turning(points, tables)
    both = "shell3" in tables and "shell4" in tables
    sides = shells.mixed_sides(tables["shell3"], tables["shell4"]) if both else None
    turned: dict[int, ShellPart] = {}
    for kind, some in found.items():
        ends = np.cumsum([len(part.nodes) for part in some])
        for part, angle, end in zip(some, np.split(turning[kind], ends[:-1]), ends, strict=True):
            mixed = sides[end - len(part.nodes) : end] if sides is not None and kind == "shell3" else None
            turned[id(part)] = replace(part, turning=angle, mixed=mixed)
    return [turned.get(id(part), part) for part in parts]


def _check_oriented(blocks: list[_Block], name: str) -> None:
    """Neighbors run along their common side in opposite directions where their normals agree."""
    sides = [
        np.stack([block.nodes, np.roll(block.nodes, -1, axis=1)], axis=2).reshape(-1, 2) for block in blocks
    ]
    ends = np.concatenate(sides)
    owners = np.concatenate([np.repeat(block.labels, block.nodes.shape[1]) for block in blocks])
    _, group, count = np.unique(np.sort(ends, axis=1), axis=0, return_inverse=True, return_counts=True)
    direction = np.bincount(group.ravel(), np.where(ends[:, 0] < ends[:, 1], 1.0, -1.0))
    wrong = np.flatnonzero((count == 2) & (direction != 0.0))
    if len(wrong):
        pair = owners[group.ravel() == wrong[0]]
        raise InputError(
            "must have their normals on the same side, for the offset",
            field=f"elements of '{name}'",
            value=", ".join(str(label) for label in pair.tolist()),
            fix="Reverse the order of the nodes of one of them",
        )


def _beams(section: Beams, block: _Block, in_plane: bool) -> BeamPart:
    properties = section.section.properties(section.material)
    components: tuple[str, ...] = COMPONENTS
    if in_plane:
        components = ("x", "z", "ry") if section.section.area is not None else ("z", "ry")
    elif section.section.area is None:
        raise InputError("is needed for beams in space", field=f"area of '{block.name}'", value=None)
    up = None if section.up is None else np.asarray(section.up, float)
    offset = checked_offset(section.offset, len(block.nodes))
    return BeamPart(block.name, block.nodes, properties, components, up, offset)


def _bars(section: Bars, block: _Block, in_plane: bool) -> BarPart:
    area, n = require_positive(section.area, f"area of '{block.name}'"), len(block.nodes)
    return BarPart(
        block.name,
        block.nodes,
        np.full(n, section.material.youngs_modulus * area),
        np.full(n, section.material.density * area),
        ("x", "z") if in_plane else ("x", "y", "z"),
    )
