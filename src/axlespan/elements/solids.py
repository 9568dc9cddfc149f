"""Solid elements in space: hexahedra, tetrahedra and wedges.

Coordinates are arrays (n_element, n_node, 3) [m]; d.o.f. are node-major: x, y, z of the first node,
x, y, z of the second, and so on. Stress and strain are ordered xx, yy, zz, xy, yz, zx. Node numbering: see
`axlespan.elements.shape_functions`. All functions are pure and integrate congruent elements once.

Linear tetrahedra and wedges are stiff in bending and lock for nearly incompressible materials: prefer hex8
with incompatible modes, hex20 or tet10.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.elements import batched
from axlespan.elements.continuum import ContinuumElement, Formulation, bad_elements, checked_coordinates
from axlespan.elements.quadrature import Rule, gauss, tetrahedron, wedge
from axlespan.elements.shape_functions import edge_nodes

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_HEX_FACES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
_TET_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
_WEDGE_FACES = ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5))


@dataclass(frozen=True)
class Face:
    """A face of a solid element; the right-hand rule gives the outward normal."""

    kind: str  # "tri3", "quad4", "tri6" or "quad8"
    nodes: tuple[int, ...]  # local numbers: corners, then the middles of the sides


@dataclass(frozen=True, eq=False, kw_only=True)
class SolidElement(ContinuumElement):
    """A family of solid elements."""

    faces: tuple[Face, ...]


def _element(
    name: str,
    faces: tuple[tuple[int, ...], ...],
    stiffness_rule: Rule,
    mass_rule: Rule,
    stress_rule: Rule,
    *,
    quadratic: bool = False,
    has_modes: bool = False,
) -> SolidElement:
    edges = edge_nodes(name)
    middle = {frozenset(edge[:2]): edge[2] for edge in edges if len(edge) == 3}

    def complete(corners: tuple[int, ...]) -> Face:
        sides = zip(corners, corners[1:] + corners[:1], strict=True)
        nodes = corners + tuple(middle[frozenset(side)] for side in sides) if quadratic else corners
        return Face(f"{'tri' if len(corners) == 3 else 'quad'}{len(nodes)}", nodes)

    return SolidElement(
        name,
        stiffness_rule,
        mass_rule,
        stress_rule.points,
        edges,
        quadratic,
        has_modes,
        faces=tuple(complete(corners) for corners in faces),
    )


#: the families by name.
SOLIDS: dict[str, SolidElement] = {
    e.name: e
    for e in (
        _element("hex8", _HEX_FACES, gauss(3, 2), gauss(3, 3), gauss(3, 2), has_modes=True),
        _element("hex20", _HEX_FACES, gauss(3, 3), gauss(3, 4), gauss(3, 2), quadratic=True),
        _element("tet4", _TET_FACES, tetrahedron(1), tetrahedron(2), tetrahedron(1)),
        _element("tet10", _TET_FACES, tetrahedron(2), tetrahedron(5), tetrahedron(2), quadratic=True),
        _element("wedge6", _WEDGE_FACES, wedge(2, 2), wedge(5, 3), wedge(1, 2)),
    )
}


def stiffness(
    element: SolidElement,
    coordinates: npt.ArrayLike,
    elasticity: npt.ArrayLike,
    formulation: Formulation = "incompatible",
) -> FloatArray:
    """Stiffness matrices (n_element, n_dof, n_dof) [N/m].

    Parameters
    ----------
    element : SolidElement
        One of `SOLIDS`.
    coordinates : array (n_element, n_node, 3)
        Node coordinates [m].
    elasticity : array (6, 6) or (n_element, 6, 6)
        Elasticity [N/m^2], see `axlespan.elements.elasticity`.
    formulation : {"incompatible", "full"}
        Incompatible modes, condensed out, cure hex8 of locking in bending and for nearly incompressible
        materials; "full" is plain displacements with full integration. No difference for the others.

    Raises
    ------
    InputError
        If an element is inverted or the elasticity is not symmetric and positive definite.
    """
    return batched.stiffness(element, coordinates, elasticity, formulation)


def mass(
    element: SolidElement, coordinates: npt.ArrayLike, density: npt.ArrayLike, lumped: bool = False
) -> FloatArray:
    """Mass matrices (n_element, n_dof, n_dof) [kg], consistent or lumped (diagonal).

    Parameters
    ----------
    element : SolidElement
        One of `SOLIDS`.
    coordinates : array (n_element, n_node, 3)
        Node coordinates [m].
    density : float or array (n_element,)
        Mass per volume [kg/m^3].
    lumped : bool
        Row sums for linear elements; for quadratic ones the diagonal, scaled to the mass of the element.
        `lumped_mass` returns the diagonals alone.
    """
    return batched.mass(element, coordinates, density, lumped)


def lumped_mass(element: SolidElement, coordinates: npt.ArrayLike, density: npt.ArrayLike) -> FloatArray:
    """Diagonals (n_element, n_dof) [kg] of the lumped mass matrices of `mass`."""
    return batched.lumped_mass(element, coordinates, density)


def stress_matrix(
    element: SolidElement,
    coordinates: npt.ArrayLike,
    elasticity: npt.ArrayLike,
    points: npt.ArrayLike | None = None,
    formulation: Formulation = "incompatible",
) -> FloatArray:
    """Matrices S (n_element, n_point, 6, n_dof) [N/m^3] with σ = S u; for stresses at many instants.

    Parameters are those of `stress`.
    """
    return batched.stress_matrix(element, coordinates, elasticity, points, formulation)


def stress(
    element: SolidElement,
    coordinates: npt.ArrayLike,
    elasticity: npt.ArrayLike,
    displacements: npt.ArrayLike,
    points: npt.ArrayLike | None = None,
    formulation: Formulation = "incompatible",
) -> FloatArray:
    """Stresses (n_element, n_point, 6) [N/m^2], ordered xx, yy, zz, xy, yz, zx.

    Parameters
    ----------
    element, coordinates, elasticity, formulation
        As in `stiffness`; incompatible modes are recovered from the displacements.
    displacements : array (n_element, n_dof)
        Displacements of the nodes of each element [m].
    points : array (n_point, 3), optional
        Reference coordinates; the points of best accuracy (``element.stress_points``) when left out;
        ``element.nodes`` for the nodes.
    """
    return batched.stress(element, coordinates, elasticity, displacements, points, formulation)


def body_force(element: SolidElement, coordinates: npt.ArrayLike, force_density: npt.ArrayLike) -> FloatArray:
    """Nodal forces (n_element, n_dof) [N] equivalent to forces per volume (3,) or (n_element, 3) [N/m^3]."""
    return batched.body_force(element, coordinates, force_density)


def volumes(element: SolidElement, coordinates: npt.ArrayLike) -> FloatArray:
    """Volumes (n_element,) [m^3]; negative for inverted elements."""
    return np.asarray(batched.shape_integrals(element, coordinates).sum(axis=1))


def check_geometry(element: SolidElement, coordinates: npt.ArrayLike) -> IntArray:
    """Indices of elements that are inverted or degenerate: det J ≤ 0 at a node or a quadrature point.

    The bound is relative, so thin elements pass: see `axlespan.elements.continuum.bad_elements`.
    """
    return bad_elements(element, checked_coordinates(element, coordinates))
