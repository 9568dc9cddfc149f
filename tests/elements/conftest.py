"""Box and quadrilateral meshes of every family, and a plain sparse assembly, for the tests of elements."""

from collections.abc import Callable

import numpy as np
import pytest
import scipy.sparse as sp
import scipy.sparse.linalg as spla

from axlespan.elements.shape_functions import edge_nodes

# How a hexahedron is cut into cells of the other shapes; all tetrahedra share the diagonal 0-6.
CUTS = {
    "hex": ((0, 1, 2, 3, 4, 5, 6, 7),),
    "wedge": ((0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)),
    "tet": ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)),
    "quad": ((0, 1, 2, 3),),
    "tri": ((0, 1, 2), (0, 2, 3)),
}
SHAPES = {"hex8": "hex", "hex20": "hex", "wedge6": "wedge", "tet4": "tet", "tet10": "tet"} | {
    "quad4": "quad",
    "quad8": "quad",
    "tri3": "tri",
    "tri6": "tri",
}


def _grid_mesh(name, counts, warp, perturbation, seed):
    """Points (n, d) and cells of a grid over the unit square or cube, mapped by ``warp``."""
    d = len(counts)
    axes = [np.linspace(0.0, 1.0, n + 1) for n in counts]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, d)
    number = np.arange(len(points)).reshape([n + 1 for n in counts])
    if d == 2:
        corners = (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:])
    else:
        lower = [number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]]
        corners = (*(c[..., :-1] for c in lower), *(c[..., 1:] for c in lower))
    boxes = np.stack([c.ravel() for c in corners], axis=1)
    inside = ((points > 1e-9) & (points < 1.0 - 1e-9)).all(axis=1)
    shift = np.random.default_rng(seed).uniform(-perturbation, perturbation, points.shape) / np.array(counts)
    points = points + shift * inside[:, None]
    if warp is not None:
        points = warp(points)
    cells = np.vstack([boxes[:, cut] for cut in CUTS[SHAPES[name]]])
    edges = [edge[:2] for edge in edge_nodes(name) if len(edge) == 3]
    if edges:
        pairs = np.sort(np.stack([cells[:, e] for e in edges], axis=1).reshape(-1, 2), axis=1)
        unique, label = np.unique(pairs, axis=0, return_inverse=True)
        cells = np.hstack([cells, len(points) + label.reshape(len(cells), -1)])
        points = np.vstack([points, points[unique].mean(axis=1)])
    return points, cells


@pytest.fixture(scope="session")
def grid_mesh() -> Callable:
    """Return ``(name, counts, warp, perturbation, seed) -> (points, cells)``; interior points move."""

    def build(name, counts, warp=None, perturbation=0.0, seed=0):
        return _grid_mesh(name, counts, warp, perturbation, seed)

    return build


@pytest.fixture(scope="session")
def assemble() -> Callable:
    """Return ``(matrices, cells, n_point) -> sparse matrix`` for node-major d.o.f."""

    def build(matrices, cells, n_point):
        d = matrices.shape[1] // cells.shape[1]
        dofs = (cells[:, :, None] * d + np.arange(d)).reshape(len(cells), -1)
        rows = np.repeat(dofs, dofs.shape[1], axis=1).ravel()
        columns = np.tile(dofs, (1, dofs.shape[1])).ravel()
        return sp.coo_matrix((matrices.ravel(), (rows, columns)), shape=(d * n_point, d * n_point)).tocsc()

    return build


@pytest.fixture(scope="session")
def solve() -> Callable:
    """Return ``(stiffness, forces, fixed, prescribed=None) -> displacements``."""

    def run(stiffness, forces, fixed, prescribed=None):
        u = np.zeros(stiffness.shape[0]) if prescribed is None else prescribed.copy()
        free = np.setdiff1d(np.arange(len(u)), fixed)
        u[free] = spla.spsolve(
            stiffness[free][:, free],
            (forces - stiffness[:, fixed] @ u[fixed])[free],
            permc_spec="MMD_AT_PLUS_A",
        )
        return u

    return run
