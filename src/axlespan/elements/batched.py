"""Matrices of many continuum elements: checks, batches that fit the cache, congruent elements once.

``weight`` multiplies each element's integral: the density of solids, the thickness of plane elements.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from axlespan.elements import kernels
from axlespan.elements.congruence import congruent
from axlespan.elements.continuum import (
    ContinuumElement,
    Formulation,
    checked_coordinates,
    checked_formulation,
)
from axlespan.elements.elasticity import PAIRS, check_elasticity
from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Bytes of the largest temporary of a batch: what stays in a core's cache is fastest.
_BATCH_BYTES = 2e6


def stiffness(
    element: ContinuumElement,
    coordinates: npt.ArrayLike,
    elasticity: npt.ArrayLike,
    formulation: Formulation,
    weight: npt.ArrayLike = 1.0,
) -> FloatArray:
    """Stiffness matrices (n_element, n_dof, n_dof)."""
    x, d = _checked(element, coordinates, elasticity, formulation)
    w = _per_element(weight, len(x))
    result = np.empty((len(x), element.dof_count, element.dof_count))
    for elements, distinct, position, material in _batches(x, d, _doubles(element, 0)):
        matrices = kernels.condensed_stiffness(element, x[distinct], material, formulation, distinct)
        result[elements] = matrices[position] * w[elements, None, None]
    return result


def mass(
    element: ContinuumElement, coordinates: npt.ArrayLike, weight: npt.ArrayLike, lumped: bool
) -> FloatArray:
    """Mass matrices (n_element, n_dof, n_dof), consistent or lumped."""
    x = checked_coordinates(element, coordinates)
    w = _per_element(weight, len(x))
    result = np.empty((len(x), element.dof_count, element.dof_count))
    for elements, distinct, position, _ in _batches(x, None, element.dof_count**2):
        products = kernels.shape_products(element, x[distinct], distinct)
        if lumped:
            products = kernels.lumped(element, products)[:, :, None] * np.eye(element.node_count)
        products = products[position] * w[elements, None, None]
        result[elements] = kernels.on_each_component(products, element.dimension)
    return result


def lumped_mass(element: ContinuumElement, coordinates: npt.ArrayLike, weight: npt.ArrayLike) -> FloatArray:
    """Diagonals (n_element, n_dof) of the lumped mass matrices."""
    x = checked_coordinates(element, coordinates)
    w = _per_element(weight, len(x))
    result = np.empty((len(x), element.dof_count))
    for elements, distinct, position, _ in _batches(x, None, element.node_count**2):
        nodal = kernels.lumped(element, kernels.shape_products(element, x[distinct], distinct))
        result[elements] = np.repeat(nodal[position] * w[elements, None], element.dimension, axis=1)
    return result


def stress_matrix(
    element: ContinuumElement,
    coordinates: npt.ArrayLike,
    elasticity: npt.ArrayLike,
    points: npt.ArrayLike | None,
    formulation: Formulation,
) -> FloatArray:
    """Matrices S (n_element, n_point, n_strain, n_dof) with σ = S u."""
    x, d = _checked(element, coordinates, elasticity, formulation)
    at = element.stress_points if points is None else np.asarray(points, float)
    result = np.empty((len(x), len(at), len(PAIRS[element.dimension]), element.dof_count))
    for elements, distinct, position, material in _batches(x, d, _doubles(element, len(at))):
        matrices = kernels.stress_matrix(element, x[distinct], material, at, formulation, distinct)
        result[elements] = matrices[position]
    return result


def stress(
    element: ContinuumElement,
    coordinates: npt.ArrayLike,
    elasticity: npt.ArrayLike,
    displacements: npt.ArrayLike,
    points: npt.ArrayLike | None,
    formulation: Formulation,
) -> FloatArray:
    """Stresses (n_element, n_point, n_strain)."""
    x, d = _checked(element, coordinates, elasticity, formulation)
    u = np.asarray(displacements, float)
    if u.shape != (len(x), element.dof_count):
        raise InputError(
            f"must be an array {(len(x), element.dof_count)}",
            field="displacements",
            value=u.shape,
            fix="Give one row of nodal displacements per element",
        )
    at = element.stress_points if points is None else np.asarray(points, float)
    result = np.empty((len(x), len(at), len(PAIRS[element.dimension])))
    for elements, distinct, position, material in _batches(x, d, _doubles(element, len(at))):
        matrices = kernels.stress_matrix(element, x[distinct], material, at, formulation, distinct)
        result[elements] = (matrices[position] @ u[elements, None, :, None])[..., 0]
    return result


def shape_integrals(element: ContinuumElement, coordinates: npt.ArrayLike) -> FloatArray:
    """∫ N_a dV (n_element, n_node) of any geometry, also an inverted one."""
    x = checked_coordinates(element, coordinates)
    result = np.empty((len(x), element.node_count))
    for elements, distinct, position, _ in _batches(x, None, len(element.mass_rule) * element.dimension**2):
        result[elements] = kernels.shape_integrals(element, x[distinct])[position]
    return result


def body_force(
    element: ContinuumElement,
    coordinates: npt.ArrayLike,
    force_density: npt.ArrayLike,
    weight: npt.ArrayLike = 1.0,
) -> FloatArray:
    """Nodal forces (n_element, n_dof) equivalent to forces per volume (d,) or (n_element, d)."""
    nodal = shape_integrals(element, coordinates)
    nodal *= _per_element(weight, len(nodal))[:, None]
    force = np.broadcast_to(np.asarray(force_density, float), (len(nodal), element.dimension))
    return np.asarray((nodal[:, :, None] * force[:, None, :]).reshape(len(nodal), element.dof_count))


def _batches(
    coordinates: FloatArray, elasticity: FloatArray | None, doubles: int
) -> Iterator[tuple[IntArray, IntArray, IntArray, FloatArray]]:
    """Yield batches: (elements, distinct ones, position of each in these, elasticity of the distinct)."""
    material = np.zeros(0) if elasticity is None else elasticity
    varies = material.ndim == 3
    classes = congruent(coordinates, material) if varies else congruent(coordinates)
    for elements, distinct, position in classes.batches(max(1, int(_BATCH_BYTES / (8 * doubles)))):
        yield elements, distinct, position, material[distinct] if varies else material


def _doubles(element: ContinuumElement, n_point: int) -> int:
    """Size of the strain matrix of one element, the largest temporary, with room for the modes."""
    rows = max(n_point, len(element.stiffness_rule)) * len(PAIRS[element.dimension])
    return rows * (element.dof_count + 12)


def _checked(
    element: ContinuumElement, coordinates: npt.ArrayLike, elasticity: npt.ArrayLike, formulation: str
) -> tuple[FloatArray, FloatArray]:
    checked_formulation(formulation)
    x = checked_coordinates(element, coordinates)
    d = check_elasticity(elasticity, len(PAIRS[element.dimension]))
    if d.ndim == 3 and len(d) != len(x):
        raise InputError(
            f"must be one matrix or one for each of the {len(x)} elements",
            field="elasticity",
            value=d.shape,
            fix="Repeat the matrix of each material for its elements",
        )
    return x, d


def _per_element(weight: npt.ArrayLike, n_element: int) -> FloatArray:
    array = np.asarray(weight, float)
    if array.shape not in ((), (n_element,)):
        raise InputError(
            f"must be a number or an array ({n_element},)",
            field="density or thickness",
            value=array.shape,
            fix="Give one value per element",
        )
    if not (np.isfinite(array).all() and (array >= 0.0).all()):
        raise InputError(
            "must be finite and not negative",
            field="density or thickness",
            value=float(array.min(initial=np.inf)),
            fix="Give it in SI units",
        )
    return np.broadcast_to(array, (n_element,))
