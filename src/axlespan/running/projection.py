"""Points on facets, seen along the direction of the contact force.

Seen that way a facet is a flat figure (a piece of a line in a plane model): x(ξ) in one or two coordinates,
with a height above it. A point belongs to the facet whose ξ is in the reference domain.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.elements.shape_functions import EDGES
from axlespan.running.facets import Facets

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_NEWTON_STEPS = 30


@dataclass(frozen=True, eq=False)
class View:
    """Coordinates across and along a direction."""

    across: FloatArray  # (3, d) orthonormal columns
    along: FloatArray  # (3,)

    @classmethod
    def of(cls, direction: FloatArray, in_plane: bool) -> View:
        """The view along a unit vector; in a plane model what is across is one coordinate, along x."""
        if in_plane:
            return cls(np.array([[direction[2]], [0.0], [-direction[0]]]), direction)
        first = np.cross([0.0, 1.0, 0.0] if abs(direction[1]) < 0.9 else [0.0, 0.0, 1.0], direction)
        first = first / np.linalg.norm(first)
        return cls(np.column_stack([first, np.cross(direction, first)]), direction)


@dataclass(frozen=True, eq=False)
class Figures:
    """Facets in a view."""

    facets: Facets
    nodes: FloatArray  # (n_facet, n_node, d) across [m]
    heights: FloatArray  # (n_facet, n_node) along [m]

    @classmethod
    def of(cls, facets: Facets, view: View) -> Figures:
        """Facets seen in a view."""
        return cls(facets, facets.coordinates @ view.across, facets.coordinates @ view.along)

    def centers(self) -> FloatArray:
        """Means (n_facet, d) of the nodes [m]."""
        return np.asarray(self.nodes.mean(axis=1))

    def radii(self) -> FloatArray:
        """Largest distances (n_facet,) of a node from the center [m]."""
        return np.asarray(np.linalg.norm(self.nodes - self.centers()[:, None], axis=2).max(axis=1))

    def crossings(self, which: IntArray, begin: FloatArray, step: FloatArray, margin: float) -> FloatArray:
        """Where lines begin + t step (n, d) cross the sides of facets: t (n, n_crossing), nan where they don't.

        Sides reach a margin [m] beyond their ends; curved ones are met twice.
        """
        x = self.nodes[which] - begin[:, None]
        if x.shape[2] == 1:
            return np.asarray(x[:, :2, 0] / step)
        n_corner = self.facets.n_corner
        a, b = np.array(EDGES["tri" if n_corner == 3 else "quad"]).T
        middle = x[:, n_corner:] if x.shape[1] > n_corner else 0.5 * (x[:, a] + x[:, b])
        # A side is M + η (B - A)/2 + η² ((A + B)/2 - M); its distance from the line is c0 + c1 η + c2 η².
        half, bow = 0.5 * (x[:, b] - x[:, a]), 0.5 * (x[:, a] + x[:, b]) - middle
        c0, c1, c2 = (
            v[..., 0] * step[:, None, 1] - v[..., 1] * step[:, None, 0] for v in (middle, half, bow)
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            q = -0.5 * (c1 + np.copysign(np.sqrt(c1**2 - 4.0 * c0 * c2), c1))
            eta = np.stack([c0 / q, q / c2])
            eta[np.abs(eta) > 1.0 + margin / np.linalg.norm(half, axis=2)] = np.nan
            at = middle + eta[..., None] * half + eta[..., None] ** 2 * bow
        t = (at * step[:, None]).sum(axis=3) / (step**2).sum(axis=1)[None, :, None]
        return np.asarray(np.concatenate(list(t), axis=1))

    def natural(self, which: IntArray, target: FloatArray) -> FloatArray:
        """Natural coordinates ξ (n, d) of points (n, d) on facets, by Newton's method; nan where it fails."""
        shape = self.facets.shape
        nodes = self.nodes[which]
        xi = np.tile(shape.nodes[: self.facets.n_corner].mean(axis=0), (len(which), 1))
        left = np.arange(len(which))
        for _ in range(_NEWTON_STEPS):
            values, slopes = shape.values(xi[left]), shape.derivatives(xi[left])
            miss = target[left] - np.einsum("pn,pni->pi", values, nodes[left])
            jacobian = np.einsum("pan,pni->pia", slopes, nodes[left])
            step = np.clip(_solved(jacobian, miss), -1.0, 1.0)
            xi[left] += step
            # Newton's method doubles the digits: the step after one of 1e-9 is rounding.
            left = left[~(np.abs(step).max(axis=1) < 1e-9)]
            if not len(left):
                break
        xi[left] = np.nan
        return xi

    def positions(self, which: IntArray, xi: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Points across (n, d) and heights (n,) at natural coordinates (n, d)."""
        values = self.facets.shape.values(xi)
        return (
            np.einsum("pn,pni->pi", values, self.nodes[which]),
            np.asarray((values * self.heights[which]).sum(axis=1)),
        )

    def clamped(self, xi: FloatArray) -> FloatArray:
        """The natural coordinates, moved into the reference domain."""
        if self.facets.n_corner != 3:
            return np.clip(xi, -1.0, 1.0)
        inside = np.maximum(xi, 0.0)
        return np.asarray(inside / np.maximum(inside.sum(axis=1, keepdims=True), 1.0))


def _solved(jacobian: FloatArray, right: FloatArray) -> FloatArray:
    """J⁻¹ b for matrices of one or two rows; large where singular."""
    if jacobian.shape[1] == 1:
        determinant = jacobian[:, 0, 0]
        adjoint = right
    else:
        a, b, c, d = (jacobian[:, i, j] for i, j in ((0, 0), (0, 1), (1, 0), (1, 1)))
        determinant = a * d - b * c
        adjoint = np.stack([d * right[:, 0] - b * right[:, 1], a * right[:, 1] - c * right[:, 0]], axis=1)
    return adjoint / np.where(determinant == 0.0, 1e-300, determinant)[:, None]
