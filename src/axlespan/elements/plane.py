"""Plane elements, for plane stress and plane strain: quadrilaterals and triangles in the x-y plane.

Coordinates are arrays (n_element, n_node, 2) [m]; d.o.f. are node-major: x, y of the first node, x, y of
the second, and so on. Stress and strain are ordered xx, yy, xy. Node numbering, counterclockwise: see
`axlespan.elements.shape_functions`. Plane stress or plane strain is a matter of the elasticity:
`axlespan.elements.elasticity.plane_stress`, `plane_strain`.

Linear triangles are stiff in bending: prefer quad4 with incompatible modes, quad8 or tri6.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.elements import batched
from axlespan.elements.continuum import ContinuumElement, Formulation, bad_elements, checked_coordinates
from axlespan.elements.quadrature import Rule, gauss, triangle
from axlespan.elements.shape_functions import edge_nodes

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class PlaneElement(ContinuumElement):
    """A family of plane elements; its edges run counterclockwise, kinds "line2" or "line3"."""


def _element(
    name: str,
    stiffness_rule: Rule,
    mass_rule: Rule,
    stress_rule: Rule,
    *,
    quadratic: bool = False,
    has_modes: bool = False,
) -> PlaneElement:
    return PlaneElement(
        name, stiffness_rule, mass_rule, stress_rule.points, edge_nodes(name), quadratic, has_modes
    )


#: the families by name.
PLANES: dict[str, PlaneElement] = {
    e.name: e
    for e in (
        _element("quad4", gauss(2, 2), gauss(2, 3), gauss(2, 2), has_modes=True),
        _element("quad8", gauss(2, 3), gauss(2, 4), gauss(2, 2), quadratic=True),
        _element("tri3", triangle(1), triangle(2), triangle(1)),
        _element("tri6", triangle(2), triangle(5), triangle(2), quadratic=True),
    )
}


def stiffness(
    element: PlaneElement,
    coordinates: npt.ArrayLike,
    elasticity: npt.ArrayLike,
    thickness: npt.ArrayLike,
    formulation: Formulation = "incompatible",
) -> FloatArray:
    """Stiffness matrices (n_element, n_dof, n_dof) [N/m].

    Parameters
    ----------
    element : PlaneElement
        One of `PLANES`.
    coordinates : array (n_element, n_node, 2)
        Node coordinates [m].
    elasticity : array (3, 3) or (n_element, 3, 3)
        Elasticity in plane stress or plane strain [N/m^2].
    thickness : float or array (n_element,)
        Thickness [m]; 1 for results per unit of width.
    formulation : {"incompatible", "full"}
        Incompatible modes, condensed out, cure quad4 of locking in bending; "full" is plain displacements
        with full integration. No difference for the others.

    Raises
    ------
    InputError
        If an element is inverted or the elasticity is not symmetric and positive definite.
    """
    return batched.stiffness(element, coordinates, elasticity, formulation, thickness)


def mass(
    element: PlaneElement,
    coordinates: npt.ArrayLike,
    density: npt.ArrayLike,
    thickness: npt.ArrayLike,
    lumped: bool = False,
) -> FloatArray:
    """Mass matrices (n_element, n_dof, n_dof) [kg], consistent or lumped (diagonal).

    Parameters
    ----------
    element : PlaneElement
        One of `PLANES`.
    coordinates : array (n_element, n_node, 2)
        Node coordinates [m].
    density : float or array (n_element,)
        Mass per volume [kg/m^3].
    thickness : float or array (n_element,)
        Thickness [m].
    lumped : bool
        Row sums for linear elements; for quadratic ones the diagonal, scaled to the mass of the element.
        `lumped_mass` returns the diagonals alone.
    """
    return batched.mass(element, coordinates, _per_area(density, thickness), lumped)


def lumped_mass(
    element: PlaneElement, coordinates: npt.ArrayLike, density: npt.ArrayLike, thickness: npt.ArrayLike
) -> FloatArray:
    """Diagonals (n_element, n_dof) [kg] of the lumped mass matrices of `mass`."""
    return batched.lumped_mass(element, coordinates, _per_area(density, thickness))


def stress_matrix(
    element: PlaneElement,
    coordinates: npt.ArrayLike,
    elasticity: npt.ArrayLike,
    points: npt.ArrayLike | None = None,
    formulation: Formulation = "incompatible",
) -> FloatArray:
    """Matrices S (n_element, n_point, 3, n_dof) [N/m^3] with σ = S u; for stresses at many instants.

    Parameters are those of `stress`.
    """
    return batched.stress_matrix(element, coordinates, elasticity, points, formulation)


def stress(
    element: PlaneElement,
    coordinates: npt.ArrayLike,
    elasticity: npt.ArrayLike,
    displacements: npt.ArrayLike,
    points: npt.ArrayLike | None = None,
    formulation: Formulation = "incompatible",
) -> FloatArray:
    """Stresses (n_element, n_point, 3) [N/m^2], ordered xx, yy, xy.

    In plane strain there is σ_zz = D_31 ε_xx + D_32 ε_yy besides, ν (σ_xx + σ_yy) for an isotropic material.

    Parameters
    ----------
    element, coordinates, elasticity, formulation
        As in `stiffness`; incompatible modes are recovered from the displacements.
    displacements : array (n_element, n_dof)
        Displacements of the nodes of each element [m].
    points : array (n_point, 2), optional
        Reference coordinates; the points of best accuracy (``element.stress_points``) when left out;
        ``element.nodes`` for the nodes.
    """
    return batched.stress(element, coordinates, elasticity, displacements, points, formulation)


def body_force(
    element: PlaneElement,
    coordinates: npt.ArrayLike,
    force_density: npt.ArrayLike,
    thickness: npt.ArrayLike,
) -> FloatArray:
    """Nodal forces (n_element, n_dof) [N] equivalent to forces per volume (2,) or (n_element, 2) [N/m^3]."""
    return batched.body_force(element, coordinates, force_density, thickness)


def areas(element: PlaneElement, coordinates: npt.ArrayLike) -> FloatArray:
    """Areas (n_element,) [m^2]; negative for inverted (clockwise) elements."""
    return np.asarray(batched.shape_integrals(element, coordinates).sum(axis=1))


def volumes(element: PlaneElement, coordinates: npt.ArrayLike, thickness: npt.ArrayLike) -> FloatArray:
    """Volumes (n_element,) [m^3]: areas times thickness."""
    return np.asarray(areas(element, coordinates) * np.asarray(thickness, float))


def check_geometry(element: PlaneElement, coordinates: npt.ArrayLike) -> IntArray:
    """Indices of elements that are inverted or degenerate: det J ≤ 0 at a node or a quadrature point.

    The bound is relative, so slender elements pass: see `axlespan.elements.continuum.bad_elements`.
    """
    return bad_elements(element, checked_coordinates(element, coordinates))


def _per_area(density: npt.ArrayLike, thickness: npt.ArrayLike) -> FloatArray:
    return np.asarray(np.asarray(density, float) * np.asarray(thickness, float))
