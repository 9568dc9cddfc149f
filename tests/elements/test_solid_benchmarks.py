"""Solid elements on published and closed-form problems.

MacNeal, Harder (1985): A proposed standard set of problems to test finite element accuracy. Finite
Elements in Analysis and Design 1, 3-20. N12: Neves, Azevedo, Calçada (2012), example 3.2.
"""

import numpy as np
import pytest
import scipy.sparse.linalg as spla

from axlespan.elements import solids
from axlespan.elements.elasticity import isotropic
from axlespan.elements.solids import SOLIDS
from axlespan.elements.surfaces import pressure_force, traction_force


def face_nodes(
    element, points: np.ndarray, cells: np.ndarray, on: np.ndarray
) -> list[tuple[str, np.ndarray]]:
    """Faces (kind, global nodes) whose nodes are all among the flagged points."""
    result = []
    for face in element.faces:
        nodes = cells[:, list(face.nodes)]
        nodes = nodes[on[nodes].all(axis=1)]
        if len(nodes):
            result.append((face.kind, nodes))
    return result


def end_load(element, points, cells, on, traction) -> np.ndarray:
    forces = np.zeros((len(points), 3))
    for kind, nodes in face_nodes(element, points, cells, on):
        np.add.at(forces, nodes, traction_force(kind, points[nodes], traction).reshape(*nodes.shape, 3))
    return forces.ravel()


# P L/EA and P L³/3EI + 6 P L/5GA for unit loads along x, y, z, as published there.
CANTILEVER = {"extension": 3.0e-5, "in-plane": 0.1081, "out-of-plane": 0.4321}


def cantilever(tools, name, formulation, counts, load, warp=None, nu=0.3) -> float:
    """Tip deflection over theory: MacNeal and Harder's straight cantilever, 6 x 0.2 x 0.1, E 1e7."""
    grid_mesh, assemble, solve = tools
    points, cells = grid_mesh(name, counts, warp=warp or (lambda p: p * [6.0, 0.2, 0.1]))
    element = SOLIDS[name]
    direction = np.eye(3)[list(CANTILEVER).index(load)]
    forces = end_load(element, points, cells, points[:, 0] > 6.0 - 1e-9, direction / (0.2 * 0.1))
    assert forces.sum() == pytest.approx(1.0)
    k = assemble(
        solids.stiffness(element, points[cells], isotropic(1e7, nu), formulation), cells, len(points)
    )
    fixed = (3 * np.flatnonzero(points[:, 0] < 1e-9)[:, None] + np.arange(3)).ravel()
    return float(forces @ solve(k, forces, fixed)) / CANTILEVER[load]


@pytest.fixture
def tools(grid_mesh, assemble, solve):
    return grid_mesh, assemble, solve


@pytest.mark.parametrize(
    ("name", "formulation", "counts", "bounds"),
    [
        ("hex8", "incompatible", (6, 1, 1), (0.97, 1.0)),
        ("hex20", "full", (6, 1, 1), (0.96, 1.0)),
        ("tet10", "full", (12, 1, 1), (0.94, 1.0)),
        ("hex8", "incompatible", (24, 2, 2), (0.98, 1.0)),
        ("hex20", "full", (12, 1, 1), (0.98, 1.0)),
    ],
)
def test_straight_cantilever_of_regular_elements(tools, name, formulation, counts, bounds) -> None:
    """One element over the height is enough; the clamped end costs some percent of the coarse mesh."""
    for load in CANTILEVER:
        ratio = cantilever(tools, name, formulation, counts, load)
        assert bounds[0] < ratio < bounds[1], load


def test_full_integration_locks_in_bending(tools) -> None:
    """Parasitic shear: coarse meshes give less than a tenth of the deflection, flat elements less still."""
    assert cantilever(tools, "hex8", "full", (6, 1, 1), "extension") > 0.97
    assert 0.05 < cantilever(tools, "hex8", "full", (6, 1, 1), "in-plane") < 0.12
    assert 0.01 < cantilever(tools, "hex8", "full", (6, 1, 1), "out-of-plane") < 0.05
    fine = cantilever(tools, "hex8", "full", (60, 2, 2), "in-plane")
    assert 0.8 < fine < 0.97


@pytest.mark.parametrize("name", ["hex8", "hex20", "tet10"])
@pytest.mark.parametrize("load", ["in-plane", "out-of-plane"])
def test_cantilever_of_skew_and_nearly_incompressible_elements(tools, name: str, load: str) -> None:
    """Parallelograms of 45 degrees in the x-y plane and ν = 0.49: no locking."""

    def skew(p: np.ndarray) -> np.ndarray:
        inner = np.minimum(p[:, 0], 1 - p[:, 0]) > 1e-9
        x = 6.0 * p[:, 0] + inner * 0.2 * (p[:, 1] - 0.5)
        return np.stack([x, 0.2 * p[:, 1], 0.1 * p[:, 2]], axis=1)

    ratios = [cantilever(tools, name, "incompatible", n, load, skew, 0.49) for n in ((6, 1, 1), (24, 2, 2))]
    assert 0.5 < ratios[0] < ratios[1] < 1.0
    assert ratios[1] > 0.9


@pytest.mark.parametrize(
    ("name", "nu", "bounds"),
    [
        # Straight edges cost hex8 1.4 %, whatever ν is.
        *(("hex8", nu, (0.98, 1.0)) for nu in (0.3, 0.49, 0.499, 0.4999)),
        *(("tet10", nu, (0.995, 1.005)) for nu in (0.3, 0.49, 0.499, 0.4999)),
        # Full integration of hex20 is good for 0.49 and begins to lock above.
        *(("hex20", nu, (0.995, 1.005)) for nu in (0.3, 0.49)),
        ("hex20", 0.4999, (0.87, 0.89)),
    ],
)
def test_thick_cylinder_under_pressure(tools, name: str, nu: float, bounds: tuple[float, float]) -> None:
    """MacNeal and Harder's thick cylinder, plane strain; u_r = (1+ν) p a² [(1-2ν) r + b²/r] / E (b²-a²)."""
    grid_mesh, assemble, solve = tools
    radii = np.array([3.0, 3.5, 4.2, 5.2, 6.75, 9.0])

    def polar(p: np.ndarray) -> np.ndarray:
        r, angle = np.interp(p[:, 0], np.linspace(0, 1, 6), radii), np.pi / 2 * p[:, 1]
        return np.stack([r * np.cos(angle), r * np.sin(angle), p[:, 2]], axis=1)

    element = SOLIDS[name]
    points, cells = grid_mesh(name, (5, 9, 1), warp=polar)
    radius = np.hypot(points[:, 0], points[:, 1])
    # Middle nodes onto the arcs, so that quadratic elements have curved edges.
    on_arc = [np.isclose(radius, r, rtol=0.0077) for r in radii]
    for r, on in zip(radii, on_arc, strict=True):
        points[on, :2] *= (r / radius[on])[:, None]
    forces = np.zeros((len(points), 3))
    for kind, nodes in face_nodes(element, points, cells, on_arc[0]):
        np.add.at(forces, nodes, pressure_force(kind, points[nodes], 1.0).reshape(*nodes.shape, 3))
    k = assemble(solids.stiffness(element, points[cells], isotropic(1000.0, nu)), cells, len(points))
    fixed = np.concatenate(
        [
            3 * np.flatnonzero(np.abs(points[:, 0]) < 1e-9),
            3 * np.flatnonzero(np.abs(points[:, 1]) < 1e-9) + 1,
            3 * np.arange(len(points)) + 2,
        ]
    )
    u = solve(k, forces.ravel(), fixed).reshape(-1, 3)
    inner = on_arc[0]
    moved = (u[inner, :2] * points[inner, :2]).sum(axis=1) / 3.0
    exact = (1 + nu) * 9 * (3 * (1 - 2 * nu) + 27) / (1000 * 72)
    assert bounds[0] < moved.mean() / exact < bounds[1]


def timoshenko_frequency(length, width, height, e, nu, rho, n=1) -> float:
    """Lower root ω_n of a simply supported Timoshenko beam, shear coefficient 5/6."""
    area, inertia, shear = width * height, width * height**3 / 12, 5 / 6 * e / (2 * (1 + nu))
    k = n * np.pi / length
    quadratic = rho * inertia * rho / shear
    linear = -(rho * area + k**2 * (rho * inertia + e * inertia * rho / shear))
    return float(np.sqrt(np.roots([quadratic, linear, e * inertia * k**4]).min()))


def test_first_frequency_of_the_solid_beam(grid_mesh, assemble) -> None:
    """N12's solid beam, coarser: modes follow Timoshenko's beam, full integration comes from above."""
    length, width, height, e, nu = 25.0, 2.2272, 2.5, 2.87e9, 0.2
    rho = 2303.0 / (width * height)
    exact = timoshenko_frequency(length, width, height, e, nu, rho)
    assert exact == pytest.approx(29.555, abs=5e-4)

    def frequency(counts, formulation, lumped=False) -> float:
        points, cells = grid_mesh("hex8", counts, warp=lambda p: p * [length, width, height])
        x, element = points[cells], SOLIDS["hex8"]
        k = assemble(solids.stiffness(element, x, isotropic(e, nu), formulation), cells, len(points))
        m = assemble(solids.mass(element, x, rho, lumped), cells, len(points))
        ends = np.isclose(points[:, 0] % length, 0.0) & np.isclose(points[:, 2], height / 2)
        free = np.setdiff1d(np.arange(k.shape[0]), (3 * np.flatnonzero(ends)[:, None] + np.arange(3)).ravel())
        value = spla.eigsh(k[free][:, free], 1, m[free][:, free], sigma=0.0, return_eigenvectors=False)
        return float(np.sqrt(value[0]))

    assert frequency((20, 2, 2), "incompatible") == pytest.approx(exact, rel=5e-3)
    assert frequency((40, 2, 4), "incompatible") == pytest.approx(exact, rel=1e-3)
    assert frequency((40, 2, 4), "incompatible", lumped=True) == pytest.approx(exact, rel=2e-3)
    stiff = [frequency(counts, "full") / exact for counts in ((20, 2, 2), (40, 2, 4))]
    assert 1.05 < stiff[0] < 1.07 and 1.01 < stiff[1] < 1.02
