"""Families of continuum elements and their geometry; the dimension d is that of the coordinates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from axlespan.elements.quadrature import Rule
from axlespan.elements.shape_functions import ShapeFunctions, shape_functions
from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Formulation = Literal["incompatible", "full"]


@dataclass(frozen=True, eq=False)
class ContinuumElement:
    """What tells one family of continuum elements from another."""

    name: str
    stiffness_rule: Rule  # integrates the stiffness of an undistorted element exactly
    mass_rule: Rule  # integrates mass and volume of any element with straight edges exactly
    stress_points: FloatArray  # (n_point, d) where stresses are most accurate
    edges: tuple[tuple[int, ...], ...]  # local nodes: the two corners, then the middle where there is one
    quadratic: bool = False
    has_modes: bool = False  # whether there are incompatible modes

    @property
    def shape(self) -> ShapeFunctions:
        """Shape functions."""
        return shape_functions(self.name)

    @property
    def nodes(self) -> FloatArray:
        """Reference coordinates of the nodes (n_node, d)."""
        return self.shape.nodes

    @property
    def node_count(self) -> int:
        """Number of nodes."""
        return self.shape.node_count

    @property
    def dimension(self) -> int:
        """Number of coordinates of a node, d."""
        return self.shape.dimension

    @property
    def dof_count(self) -> int:
        """Number of d.o.f. of an element."""
        return self.node_count * self.dimension


@dataclass(frozen=True, eq=False)
class Geometry:
    """The map of elements at points: J_ai = ∂x_i/∂ξ_a."""

    jacobian: FloatArray  # (n_element, n_point, d, d) J
    cofactor: FloatArray  # (n_element, n_point, d, d) J⁻¹ det J
    determinant: FloatArray  # (n_element, n_point) det J

    def gradients(self, derivatives: FloatArray) -> FloatArray:
        """Gradients ∂N/∂x_i (n_element, n_point, d, n_node) from the derivatives (n_point, d, n_node)."""
        inverse = self.cofactor / self.determinant[:, :, None, None]
        return np.asarray(inverse @ derivatives)


def geometry(element: ContinuumElement, coordinates: FloatArray, points: FloatArray) -> Geometry:
    """Jacobians of elements with coordinates (n_element, n_node, d) at reference points (n_point, d)."""
    d = element.dimension
    derivatives = element.shape.derivatives(points).reshape(-1, element.node_count)
    jacobian = (derivatives @ coordinates).reshape(len(coordinates), -1, d, d)
    cofactor = np.empty_like(jacobian)
    if d == 2:
        cofactor[..., 0, 0], cofactor[..., 0, 1] = jacobian[..., 1, 1], -jacobian[..., 0, 1]
        cofactor[..., 1, 0], cofactor[..., 1, 1] = -jacobian[..., 1, 0], jacobian[..., 0, 0]
    else:
        for a in range(3):
            # Row vectors of J: column a of the cofactor matrix is the cross product of the two others.
            cofactor[..., :, a] = _cross(jacobian[..., (a + 1) % 3, :], jacobian[..., (a + 2) % 3, :])
    determinant = (jacobian[..., 0, :] * cofactor[..., :, 0]).sum(axis=-1)
    return Geometry(jacobian, cofactor, determinant)


def positive(geometry: Geometry, elements: IntArray) -> Geometry:
    """Return the geometry if det J > 0 everywhere; raise InputError with the numbers of the elements else."""
    bad = ~(geometry.determinant > 0.0).all(axis=1)
    if bad.any():
        raise InputError(
            "must have a positive Jacobian in every element",
            field="coordinates",
            value=f"elements {', '.join(str(i) for i in np.sort(elements[bad])[:8])}",
            fix="Repair the mesh or the order of the nodes; check_geometry lists all such elements",
        )
    return geometry


def bad_elements(element: ContinuumElement, coordinates: FloatArray) -> IntArray:
    """Indices of elements that are inverted or degenerate at a node or a quadrature point.

    The measure is det J over the product of the lengths of the rows of J: 1 for a box however thin, 0 when
    flat. A row shorter than 1e-10 of the element's size counts as zero.
    """
    points = np.vstack([element.nodes, element.stiffness_rule.points, element.mass_rule.points])
    result = [np.empty(0, np.int64)]
    size = 1024  # elements at a time, to keep the temporaries small
    for start in range(0, len(coordinates), size):
        part = coordinates[start : start + size]
        at = geometry(element, part, points)
        lengths = np.linalg.norm(at.jacobian, axis=3)
        extent = np.linalg.norm(part.max(axis=1) - part.min(axis=1), axis=1)
        good = (lengths > 1e-10 * extent[:, None, None]).all(axis=(1, 2))
        good &= (at.determinant > 1e-8 * lengths.prod(axis=2)).all(axis=1)
        result.append(start + np.flatnonzero(~good))
    return np.concatenate(result)


def checked_coordinates(element: ContinuumElement, coordinates: npt.ArrayLike) -> FloatArray:
    """Return the coordinates as an array (n_element, n_node, d), or raise InputError."""
    array = np.asarray(coordinates, float)
    if array.ndim != 3 or array.shape[1:] != (element.node_count, element.dimension):
        raise InputError(
            f"must be an array (n_element, {element.node_count}, {element.dimension}) for {element.name}",
            field="coordinates",
            value=array.shape,
            fix="Give one row of node coordinates per node",
        )
    if not np.isfinite(array).all():
        raise InputError("must be finite", field="coordinates", fix="Look for nan in the mesh")
    return array


def checked_formulation(formulation: str) -> None:
    """Raise InputError for anything but the two formulations."""
    if formulation not in ("incompatible", "full"):
        raise InputError(
            "is not a formulation", field="formulation", value=formulation, fix="Use 'incompatible' or 'full'"
        )


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    # np.cross is three times slower for many short vectors.
    return np.stack(
        [
            a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1],
            a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
            a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0],
        ],
        axis=-1,
    )
