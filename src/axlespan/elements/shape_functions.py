"""Lagrange and serendipity shape functions of lines, triangles, squares, tetrahedra, cubes and wedges.

Each family is a list of nodes and the monomials that its shape functions span; the coefficients follow
from N_a(ξ_b) = δ_ab, so the Kronecker property and the completeness hold by construction.

Reference domains: lines, squares and cubes [-1, 1]^d; triangles and tetrahedra ξ_i ≥ 0, Σ ξ_i ≤ 1; wedges
are the triangle times [-1, 1]. Nodes are numbered as Gmsh and VTK do for linear families, as VTK does for
quadratic ones: corners first, then the middles of the edges in the order of `EDGES`. The triangle of the
first three nodes of a wedge (of a tetrahedron) runs counterclockwise seen from the other nodes.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]

_SIMPLEX_CORNERS = {2: [[0, 0], [1, 0], [0, 1]], 3: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}
_SQUARE_CORNERS = [[-1, -1], [1, -1], [1, 1], [-1, 1]]
_CUBE_CORNERS = [[*xy, z] for z in (-1, 1) for xy in _SQUARE_CORNERS]
_WEDGE_CORNERS = [[*xy, z] for z in (-1, 1) for xy in _SIMPLEX_CORNERS[2]]

#: corners of the edges of each shape, in VTK's order of the mid-edge nodes.
EDGES: dict[str, tuple[tuple[int, int], ...]] = {
    "line": ((0, 1),),
    "tri": ((0, 1), (1, 2), (2, 0)),
    "quad": ((0, 1), (1, 2), (2, 3), (3, 0)),
    "tet": ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)),
    "hex": (
        *((0, 1), (1, 2), (2, 3), (3, 0)),
        *((4, 5), (5, 6), (6, 7), (7, 4)),
        *((0, 4), (1, 5), (2, 6), (3, 7)),
    ),
    "wedge": ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)),
}


@dataclass(frozen=True, eq=False)
class ShapeFunctions:
    """The shape functions of one family: N_a(ξ) = Σ_m c_ma ξ^{p_m}.

    Build your own from nodes and as many monomials with `interpolation`.
    """

    nodes: FloatArray  # (n_node, dimension) reference coordinates of the nodes
    powers: npt.NDArray[np.int64]  # (n_node, dimension) exponents p_m of the monomials
    coefficients: FloatArray  # (n_node, n_node) c_ma

    @property
    def node_count(self) -> int:
        """Number of nodes."""
        return len(self.nodes)

    @property
    def dimension(self) -> int:
        """Number of reference coordinates."""
        return int(self.nodes.shape[1])

    def values(self, points: npt.ArrayLike) -> FloatArray:
        """N_a (n_point, n_node) at reference points (n_point, dimension)."""
        return np.asarray(_monomials(_points(points, self.dimension), self.powers) @ self.coefficients)

    def derivatives(self, points: npt.ArrayLike) -> FloatArray:
        """∂N_a/∂ξ_i (n_point, dimension, n_node) at reference points (n_point, dimension)."""
        at = _points(points, self.dimension)
        result = np.empty((len(at), self.dimension, self.node_count))
        for i in range(self.dimension):
            factor = self.powers[:, i]
            lowered = self.powers.copy()
            lowered[:, i] = np.maximum(factor - 1, 0)
            result[:, i] = (_monomials(at, lowered) * factor) @ self.coefficients
        return result


def interpolation(nodes: npt.ArrayLike, powers: npt.ArrayLike) -> ShapeFunctions:
    """Return the shape functions that span the monomials ``powers`` and are 1 at one of ``nodes`` each."""
    at, exponents = np.asarray(nodes, float), np.asarray(powers, np.int64)
    return ShapeFunctions(at, exponents, np.asarray(np.linalg.inv(_monomials(at, exponents)), float))


@cache
def shape_functions(kind: str) -> ShapeFunctions:
    """Return the shape functions of a kind, one of `KINDS`.

    Examples
    --------
    >>> shape_functions("quad4").values([[0.0, 0.0]])
    array([[0.25, 0.25, 0.25, 0.25]])
    """
    if kind not in KINDS:
        raise InputError(
            "is not a known kind of element", field="kind", value=kind, fix=f"Use one of {KINDS}"
        )
    shape, corners, powers = _FAMILIES[kind]
    nodes = np.asarray(corners, float)
    if len(powers) > len(corners):
        nodes = np.vstack([nodes, [nodes[list(edge)].mean(axis=0) for edge in EDGES[shape]]])
    exact = interpolation(nodes, powers)
    # All coefficients of these families are multiples of 1/8: take the rounding of the inverse away.
    return ShapeFunctions(exact.nodes, exact.powers, np.round(exact.coefficients * 8.0) / 8.0)


def _grid(dimension: int, highest: int) -> list[tuple[int, ...]]:
    return [tuple(p) for p in np.ndindex(*(highest + 1,) * dimension)]


def _complete(dimension: int, degree: int) -> list[tuple[int, ...]]:
    return [p for p in _grid(dimension, degree) if sum(p) <= degree]


def _serendipity(dimension: int) -> list[tuple[int, ...]]:
    # Superlinear degree at most 2 (Arnold and Awanou 2011): factors that stand alone do not count.
    return [p for p in _grid(dimension, 2) if sum(q for q in p if q > 1) <= 2]


_FAMILIES: dict[str, tuple[str, list[list[int]], list[tuple[int, ...]]]] = {
    "line2": ("line", [[-1], [1]], _complete(1, 1)),
    "line3": ("line", [[-1], [1]], _complete(1, 2)),
    "tri3": ("tri", _SIMPLEX_CORNERS[2], _complete(2, 1)),
    "tri6": ("tri", _SIMPLEX_CORNERS[2], _complete(2, 2)),
    "quad4": ("quad", _SQUARE_CORNERS, _grid(2, 1)),
    "quad8": ("quad", _SQUARE_CORNERS, _serendipity(2)),
    "tet4": ("tet", _SIMPLEX_CORNERS[3], _complete(3, 1)),
    "tet10": ("tet", _SIMPLEX_CORNERS[3], _complete(3, 2)),
    "hex8": ("hex", _CUBE_CORNERS, _grid(3, 1)),
    "hex20": ("hex", _CUBE_CORNERS, _serendipity(3)),
    "wedge6": ("wedge", _WEDGE_CORNERS, [(*p, q) for p in _complete(2, 1) for q in (0, 1)]),
}

#: the kinds that `shape_functions` knows.
KINDS = tuple(_FAMILIES)


def edge_nodes(kind: str) -> tuple[tuple[int, ...], ...]:
    """Local nodes of each edge: its two corners, then its middle node where the family has one."""
    shape, corners, powers = _FAMILIES[kind]
    if len(powers) == len(corners):
        return EDGES[shape]
    return tuple((*edge, len(corners) + i) for i, edge in enumerate(EDGES[shape]))


def _monomials(points: FloatArray, powers: npt.NDArray[np.int64]) -> FloatArray:
    """ξ^p (n_point, n_monomial)."""
    return np.asarray(np.prod(points[:, None, :] ** powers[None, :, :], axis=2))


def _points(points: npt.ArrayLike, dimension: int) -> FloatArray:
    at = np.asarray(points, float)
    if at.ndim != 2 or at.shape[1] != dimension:
        raise InputError(
            f"must be an array (n_point, {dimension})",
            field="points",
            value=at.shape,
            fix="One row per point",
        )
    return at
