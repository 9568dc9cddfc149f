"""Quadrature rules with positive weights on the reference domains of elements.

The domains are those of `axlespan.elements.shape_functions`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import permutations
from math import sqrt

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Rule:
    """∫ f dξ ≈ Σ_q w_q f(ξ_q)."""

    points: FloatArray  # (n_point, dimension)
    weights: FloatArray  # (n_point,); they sum up to the size of the reference domain

    def __len__(self) -> int:
        return len(self.weights)


@cache
def gauss(dimension: int, count: int) -> Rule:
    """Gauss-Legendre product rule on [-1, 1]^dimension: exact for degree 2 count - 1 in each coordinate."""
    x, w = np.polynomial.legendre.leggauss(count)
    points = np.stack(np.meshgrid(*[x] * dimension, indexing="ij"), axis=-1).reshape(-1, dimension)
    weights = (
        np.stack(np.meshgrid(*[w] * dimension, indexing="ij"), axis=-1).reshape(-1, dimension).prod(axis=1)
    )
    return Rule(points, weights)


@cache
def triangle(degree: int) -> Rule:
    """Symmetric rule on the unit triangle, exact for polynomials of degree 1, 2 or 5.

    1, 3 or 7 points; degree 5 is Radon's rule (Stroud 1971, T2: 5-1).
    """
    if degree == 1:
        return _simplex(2, [((1 / 3, 1 / 3, 1 / 3), 1.0)])
    if degree == 2:
        return _simplex(2, [((2 / 3, 1 / 6, 1 / 6), 1 / 3)])
    if degree == 5:
        r = sqrt(15.0)
        orbits: list[tuple[tuple[float, ...], float]] = [((1 / 3, 1 / 3, 1 / 3), 9 / 40)]
        for sign in (-1.0, 1.0):
            a = (6.0 + sign * r) / 21.0
            orbits.append(((1.0 - 2.0 * a, a, a), (155.0 + sign * r) / 1200.0))
        return _simplex(2, orbits)
    raise InputError("has no rule on the triangle", field="degree", value=degree, fix="Use 1, 2 or 5")


@cache
def tetrahedron(degree: int) -> Rule:
    """Symmetric rule on the unit tetrahedron, exact for polynomials of degree 1, 2 or 5.

    1, 4 or 15 points; degree 5 is Stroud 1971, T3: 5-1.
    """
    if degree == 1:
        return _simplex(3, [((0.25, 0.25, 0.25, 0.25), 1.0)])
    if degree == 2:
        a = (5.0 - sqrt(5.0)) / 20.0
        return _simplex(3, [((1.0 - 3.0 * a, a, a, a), 0.25)])
    if degree == 5:
        r = sqrt(15.0)
        orbits: list[tuple[tuple[float, ...], float]] = [((0.25, 0.25, 0.25, 0.25), 16 / 135)]
        for sign in (-1.0, 1.0):
            a = (7.0 + sign * r) / 34.0
            orbits.append(((1.0 - 3.0 * a, a, a, a), (2665.0 - sign * 14.0 * r) / 37800.0))
        b = (10.0 - 2.0 * r) / 40.0
        orbits.append(((b, b, 0.5 - b, 0.5 - b), 10 / 189))
        return _simplex(3, orbits)
    raise InputError("has no rule on the tetrahedron", field="degree", value=degree, fix="Use 1, 2 or 5")


@cache
def wedge(degree: int, count: int) -> Rule:
    """Product of `triangle` (degree) and the Gauss-Legendre rule with ``count`` points."""
    base, line = triangle(degree), gauss(1, count)
    points = np.hstack([np.tile(base.points, (count, 1)), np.repeat(line.points, len(base), axis=0)])
    return Rule(points, np.tile(base.weights, count) * np.repeat(line.weights, len(base)))


def _simplex(dimension: int, orbits: list[tuple[tuple[float, ...], float]]) -> Rule:
    """Rule from orbits: barycentric coordinates, all distinct permutations of them, and their weight."""
    points: list[tuple[float, ...]] = []
    weights: list[float] = []
    for barycentric, weight in orbits:
        images = sorted(set(permutations(barycentric)))
        points += images
        weights += [weight] * len(images)
    size = 1.0 / (2.0 if dimension == 2 else 6.0)
    return Rule(np.asarray(points)[:, 1:].copy(), np.asarray(weights) * size)
