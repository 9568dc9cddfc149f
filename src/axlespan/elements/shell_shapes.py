"""Shape functions of flat shell elements on their reference square [-1, 1]² or triangle ξ, η, 1 - ξ - η ≥ 0.

The natural coordinates of a triangle are the area coordinates of its nodes 2 and 3. Besides the linear or
bilinear functions of the nodes there are the quadratic ones of the sides, 1 - ξ² on their own side and zero
on the others.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.elements.shell_geometry import FlatGeometry

FloatArray = npt.NDArray[np.float64]

_CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
_GAUSS, _WEIGHT = np.polynomial.legendre.leggauss(3)
_NEAR, _FAR = 0.445948490915965, 0.091576213509771  # rule of degree 4 (Dunavant 1985)


def natural_rule(node_count: int) -> tuple[FloatArray, FloatArray]:
    """Points (n_point, 2) and weights (n_point,), exact to degree 5 on the square, 4 on the triangle."""
    if node_count == 4:
        r, s = np.meshgrid(_GAUSS, _GAUSS, indexing="ij")
        return np.stack([r.ravel(), s.ravel()], axis=1), np.outer(_WEIGHT, _WEIGHT).ravel()
    points = [point for a in (_NEAR, _FAR) for point in ((a, a), (1.0 - 2.0 * a, a), (a, 1.0 - 2.0 * a))]
    return np.array(points), 0.5 * np.repeat([0.223381589678011, 0.109951743655322], 3)


def shapes(node_count: int, natural: FloatArray) -> FloatArray:
    """Values (..., n_node) of the nodes' functions at natural points (..., 2)."""
    r, s = natural[..., :1], natural[..., 1:]
    if node_count == 4:
        corner: FloatArray = 0.25 * (1.0 + r * _CORNERS[:, 0]) * (1.0 + s * _CORNERS[:, 1])
        return corner
    return np.concatenate([1.0 - r - s, r, s], axis=-1)


def shape_slopes(node_count: int, natural: FloatArray) -> FloatArray:
    """Derivatives (2, n_point, n_node) of the nodes' functions at natural points (n_point, 2)."""
    r, s = natural[:, :1], natural[:, 1:]
    if node_count == 4:
        a, b = _CORNERS.T
        return np.stack([0.25 * a * (1.0 + s * b), 0.25 * b * (1.0 + r * a)])
    slopes = np.empty((2, len(natural), 3))
    slopes[0], slopes[1] = (-1.0, 1.0, 0.0), (-1.0, 0.0, 1.0)
    return slopes


def bubbles(node_count: int, natural: FloatArray) -> FloatArray:
    """Values (..., n_side) of the sides' functions at natural points (..., 2)."""
    if node_count == 4:
        r, s = natural[..., 0], natural[..., 1]
        x, y = 0.5 * (1.0 - r * r), 0.5 * (1.0 - s * s)
        return np.stack([x * (1.0 - s), y * (1.0 + r), x * (1.0 + s), y * (1.0 - r)], axis=-1)
    value = shapes(3, natural)
    product: FloatArray = 4.0 * value * np.roll(value, -1, axis=-1)
    return product


def integration_rule(geometry: FlatGeometry) -> tuple[FloatArray, FloatArray]:
    """Natural points (n_point, 2) and weights (n_e, n_point) that sum to the areas [m^2]."""
    natural, weight = natural_rule(geometry.node_count)
    slopes = shape_slopes(geometry.node_count, natural)
    return natural, weight * np.linalg.det(np.einsum("apn,eni->epai", slopes, geometry.plane))
