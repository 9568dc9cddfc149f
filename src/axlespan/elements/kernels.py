"""Integrals over continuum elements, for all elements given at once.

Strain-displacement matrices follow Voigt's order of `axlespan.elements.elasticity`; d.o.f. are node-major:
x, y(, z) of the first node, x, y(, z) of the second, and so on. Derivation: docs/theory/solid-elements.md.
``elements`` are the numbers by which an error names the elements.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.elements.continuum import ContinuumElement, Formulation, Geometry, geometry, positive
from axlespan.elements.elasticity import PAIRS

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


def strain_matrix(gradients: FloatArray) -> FloatArray:
    """B (n_element, n_point, n_strain, n d) from gradients (n_element, n_point, d, n): ε = B u."""
    n_element, n_point, d, n = gradients.shape
    matrix = np.zeros((n_element, n_point, len(PAIRS[d]), n, d))
    for row, (i, j) in enumerate(PAIRS[d]):
        matrix[:, :, row, :, i] = gradients[:, :, j]
        if i != j:
            matrix[:, :, row, :, j] = gradients[:, :, i]
    return matrix.reshape(n_element, n_point, len(PAIRS[d]), n * d)


def mode_strain_matrix(
    element: ContinuumElement, coordinates: FloatArray, points: FloatArray, at_points: Geometry
) -> FloatArray:
    """Strains B_α (n_element, n_point, n_strain, n_mode) of the incompatible modes.

    The displacement modes 1 - ξ_a² have the gradient -2 ξ_a J₀⁻¹ e_a det J₀/det J, with J₀ at the center
    (Taylor, Beresford and Wilson 1976), so that they do no work on a constant stress. In space three more
    modes set the dilatations ξ_a ξ_b free, which the other modes cannot make vanish (Simo, Armero and
    Taylor 1993).
    """
    n_element, n_point, d = len(coordinates), len(points), element.dimension
    center = geometry(element, coordinates, np.zeros((1, d)))
    # Only the direction of a mode counts, its size is condensed out: unit vectors keep that well conditioned.
    directions = center.cofactor[:, 0] / np.linalg.norm(center.cofactor[:, 0], axis=1, keepdims=True)
    ratio = center.determinant / at_points.determinant
    modes = strain_matrix(directions[:, None] * (points * ratio[:, :, None])[:, :, None, :])
    if d == 2:
        return modes
    dilatations = np.zeros((n_element, n_point, 6, 3))
    products = points[:, [1, 2, 0]] * points[:, [2, 0, 1]]
    dilatations[:, :, :3] = (ratio[:, :, None] * products)[:, :, None, :]
    return np.concatenate([modes, dilatations], axis=3)


def condensed_stiffness(
    element: ContinuumElement,
    coordinates: FloatArray,
    elasticity: FloatArray,
    formulation: Formulation,
    elements: IntArray,
) -> FloatArray:
    """K = ∫ Bᵀ D B dV (n_element, n_dof, n_dof), the incompatible modes condensed out."""
    rule, n_dof = element.stiffness_rule, element.dof_count
    at = positive(geometry(element, coordinates, rule.points), elements)
    strains = strain_matrix(at.gradients(element.shape.derivatives(rule.points)))
    with_modes = element.has_modes and formulation == "incompatible"
    if with_modes:
        strains = np.concatenate([strains, mode_strain_matrix(element, coordinates, rule.points, at)], axis=3)
    stresses = _per_point(elasticity) @ strains
    stresses *= (rule.weights * at.determinant)[:, :, None, None]
    n_all = strains.shape[3]
    rows = (len(coordinates), -1, n_all)
    matrix = strains.reshape(rows).transpose(0, 2, 1) @ stresses.reshape(rows)
    if with_modes:
        coupling = matrix[:, n_dof:, :n_dof]
        matrix = matrix[:, :n_dof, :n_dof] - matrix[:, :n_dof, n_dof:] @ np.linalg.solve(
            matrix[:, n_dof:, n_dof:], coupling
        )
    return np.asarray(0.5 * (matrix + matrix.transpose(0, 2, 1)))


def stress_matrix(
    element: ContinuumElement,
    coordinates: FloatArray,
    elasticity: FloatArray,
    points: FloatArray,
    formulation: Formulation,
    elements: IntArray,
) -> FloatArray:
    """S (n_element, n_point, n_strain, n_dof): σ = S u at reference points, incompatible modes recovered."""
    at = positive(geometry(element, coordinates, points), elements)
    strains = strain_matrix(at.gradients(element.shape.derivatives(points)))
    if element.has_modes and formulation == "incompatible":
        rule = element.stiffness_rule
        inner = positive(geometry(element, coordinates, rule.points), elements)
        modes = mode_strain_matrix(element, coordinates, rule.points, inner)
        weighted = _per_point(elasticity) @ modes * (rule.weights * inner.determinant)[:, :, None, None]
        work = weighted.reshape(len(coordinates), -1, modes.shape[3]).transpose(0, 2, 1)
        nodal = strain_matrix(inner.gradients(element.shape.derivatives(rule.points)))
        amplitudes = np.linalg.solve(
            work @ modes.reshape(len(coordinates), -1, modes.shape[3]),
            work @ nodal.reshape(len(coordinates), -1, element.dof_count),
        )
        strains -= mode_strain_matrix(element, coordinates, points, at) @ amplitudes[:, None]
    return np.asarray(_per_point(elasticity) @ strains)


def shape_products(element: ContinuumElement, coordinates: FloatArray, elements: IntArray) -> FloatArray:
    """∫ N_a N_b dV (n_element, n_node, n_node)."""
    rule, n = element.mass_rule, element.node_count
    at = positive(geometry(element, coordinates, rule.points), elements)
    shapes = element.shape.values(rule.points)
    products = (shapes[:, :, None] * shapes[:, None, :]).reshape(-1, n * n)
    matrix = ((rule.weights * at.determinant) @ products).reshape(-1, n, n)
    return np.asarray(0.5 * (matrix + matrix.transpose(0, 2, 1)))


def lumped(element: ContinuumElement, products: FloatArray) -> FloatArray:
    """Diagonal (n_element, n_node) from ∫ N_a N_b dV: row sums, for quadratic elements scaled diagonals.

    Row sums of quadratic elements can be negative; there the diagonal is scaled to the volume (Hinton,
    Rock and Zienkiewicz 1976).
    """
    if not element.quadratic:
        return np.asarray(products.sum(axis=2))
    diagonal = np.diagonal(products, axis1=1, axis2=2)
    return np.asarray(diagonal * (products.sum(axis=(1, 2)) / diagonal.sum(axis=1))[:, None])


def on_each_component(scalar: FloatArray, dimension: int) -> FloatArray:
    """Matrices (n_element, n d, n d) that act alike on x, y(, z), from scalar ones (n_element, n, n)."""
    n_element, n, _ = scalar.shape
    matrix = np.zeros((n_element, n, dimension, n, dimension))
    for i in range(dimension):
        matrix[:, :, i, :, i] = scalar
    return matrix.reshape(n_element, n * dimension, n * dimension)


def shape_integrals(element: ContinuumElement, coordinates: FloatArray) -> FloatArray:
    """∫ N_a dV (n_element, n_node); negative where elements are inverted."""
    rule = element.mass_rule
    determinant = geometry(element, coordinates, rule.points).determinant
    return np.asarray((rule.weights * determinant) @ element.shape.values(rule.points))


def _per_point(elasticity: FloatArray) -> FloatArray:
    return elasticity[:, None] if elasticity.ndim == 3 else elasticity
