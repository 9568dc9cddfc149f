"""Plane elements: properties of every family, Cook's membrane, the thick cylinder and bending."""

import numpy as np
import pytest

from axlespan.elements import plane, surfaces
from axlespan.elements.elasticity import isotropic, orthotropic, plane_strain, plane_stress, rotated
from axlespan.elements.plane import PLANES
from axlespan.errors import InputError

FAMILIES = [(name, "full") for name in PLANES] + [("quad4", "incompatible")]
QUADRATIC = ("quad8", "tri6")
THICKNESS = 0.3
_C, _S = np.cos(0.4), np.sin(0.4)
WOOD = plane_stress(
    rotated(
        orthotropic((11e9, 0.9e9, 0.5e9), (0.37, 0.43, 0.42), (0.69e9, 0.05e9, 0.7e9)),
        [[_C, _S, 0.0], [-_S, _C, 0.0], [0.0, 0.0, 1.0]],
    )
)
MATERIALS = [WOOD, plane_strain(isotropic(1e9, 0.4999)), plane_stress(isotropic(1e9, 0.49))]

every_family = pytest.mark.parametrize(("name", "formulation"), FAMILIES)
every_element = pytest.mark.parametrize("name", PLANES)


def distorted(name: str, count: int = 3, seed: int = 0) -> np.ndarray:
    """Elements (count, n_node, 2), skewed, moved at random, with curved edges."""
    rng = np.random.default_rng(seed)
    nodes = PLANES[name].nodes
    span = np.ptp(nodes[:, 0])
    x = nodes + 0.08 * span * rng.uniform(-1, 1, (count, *nodes.shape))
    for edge in PLANES[name].edges:
        if len(edge) == 3:
            x[:, edge[2]] = x[:, edge[:2]].mean(axis=1) + 0.03 * span * rng.uniform(-1, 1, (count, 2))
    return x @ np.array([[2.0, 0.3], [-0.2, 0.8]]) / span


def nodal_edge_forces(element, points, cells, on, traction) -> np.ndarray:
    """Forces (n_dof,) of a traction per length on the edges whose nodes are all flagged."""
    forces = np.zeros_like(points)
    for edge in element.edges:
        nodes = cells[:, list(edge)]
        nodes = nodes[on[nodes].all(axis=1)]
        loads = surfaces.traction_force(f"line{len(edge)}", points[nodes], traction)
        np.add.at(forces, nodes, loads.reshape(*nodes.shape, 2))
    return forces.ravel()


@every_family
def test_exactly_three_rigid_body_modes_and_symmetry(name: str, formulation: str) -> None:
    for material in MATERIALS:
        for k in plane.stiffness(PLANES[name], distorted(name), material, THICKNESS, formulation):
            assert np.array_equal(k, k.T)
            values = np.linalg.eigvalsh(k)
            assert np.abs(values[:3]).max() < 1e-13 * values[-1]
            assert values[3] > 1e-6 * values[-1]


@every_element
def test_energy_is_that_of_the_finite_difference_strains(name: str) -> None:
    element, x = PLANES[name], distorted(name, 1)[0]
    u = np.random.default_rng(8).standard_normal((element.node_count, 2))
    energy = 0.0
    for point, weight in zip(element.stiffness_rule.points, element.stiffness_rule.weights, strict=True):
        j, du = np.empty((2, 2)), np.empty((2, 2))
        for a, h in enumerate(1e-4 * np.eye(2)):
            change = (element.shape.values([point + h]) - element.shape.values([point - h]))[0] / 2e-4
            j[a], du[a] = change @ x, change @ u
        g = np.linalg.solve(j, du).T
        strain = np.array([g[0, 0], g[1, 1], g[0, 1] + g[1, 0]])
        energy += 0.5 * THICKNESS * strain @ WOOD @ strain * weight * np.linalg.det(j)
    k = plane.stiffness(element, x[None], WOOD, THICKNESS, "full")[0]
    assert 0.5 * u.ravel() @ k @ u.ravel() == pytest.approx(energy, rel=1e-7)


@every_family
@pytest.mark.parametrize("material", MATERIALS)
def test_patch_of_distorted_elements_reproduces_constant_strain(
    name: str, formulation: str, material: np.ndarray, grid_mesh, assemble, solve
) -> None:
    points, cells = grid_mesh(name, (3, 3), perturbation=0.3, seed=2)
    gradient = 1e-3 * np.array([[1.0, 0.5], [0.4, -0.7]])
    exact = points @ gradient.T
    outer = np.flatnonzero(((points < 1e-9) | (points > 1 - 1e-9)).any(axis=1))
    element = PLANES[name]
    k = assemble(
        plane.stiffness(element, points[cells], material, THICKNESS, formulation), cells, len(points)
    )
    u = solve(k, np.zeros(exact.size), (2 * outer[:, None] + np.arange(2)).ravel(), exact.ravel()).reshape(
        -1, 2
    )
    np.testing.assert_allclose(u, exact, atol=1e-11)
    expected = material @ np.array([gradient[0, 0], gradient[1, 1], gradient[0, 1] + gradient[1, 0]])
    for at in (None, element.nodes):
        sigma = plane.stress(
            element, points[cells], material, u[cells].reshape(len(cells), -1), at, formulation
        )
        np.testing.assert_allclose(
            sigma, np.broadcast_to(expected, sigma.shape), atol=1e-7 * np.abs(expected).max()
        )


@every_family
def test_stresses_are_in_equilibrium_with_the_nodal_forces(name: str, formulation: str) -> None:
    element, x = PLANES[name], distorted(name)
    u = np.random.default_rng(5).standard_normal((len(x), element.dof_count))
    rule = element.stiffness_rule
    sigma = plane.stress(element, x, WOOD, u, rule.points, formulation)
    forces = np.zeros((len(x), element.node_count, 2))
    for e, q in np.ndindex(len(x), len(rule)):
        dn = element.shape.derivatives(rule.points[q : q + 1])[0]
        j, s = dn @ x[e], sigma[e, q]
        tensor = np.array([[s[0], s[2]], [s[2], s[1]]])
        forces[e] += THICKNESS * rule.weights[q] * np.linalg.det(j) * np.linalg.solve(j, dn).T @ tensor
    expected = np.einsum("eij,ej->ei", plane.stiffness(element, x, WOOD, THICKNESS, formulation), u)
    np.testing.assert_allclose(forces.reshape(len(x), -1), expected, atol=1e-10 * np.abs(expected).max())
    matrix = plane.stress_matrix(element, x, WOOD, rule.points, formulation)
    np.testing.assert_allclose(np.einsum("epsd,ed->eps", matrix, u), sigma, atol=1e-11 * np.abs(sigma).max())


@every_family
def test_a_rotated_element_of_rotated_material_has_the_rotated_matrix(name: str, formulation: str) -> None:
    element, x = PLANES[name], distorted(name)
    q = np.array([[_C, -_S], [_S, _C]])
    # σ and ε turn by Voigt's matrices, written out for the plane.
    t = np.array(
        [[_C**2, _S**2, _C * _S], [_S**2, _C**2, -_C * _S], [-2 * _C * _S, 2 * _C * _S, _C**2 - _S**2]]
    )
    k = plane.stiffness(element, x, WOOD, THICKNESS, formulation)
    turned = plane.stiffness(element, x @ q.T, t.T @ WOOD @ t, THICKNESS, formulation)
    turn = np.kron(np.eye(element.node_count), q)
    np.testing.assert_allclose(turned, turn @ k @ turn.T, atol=1e-10 * np.abs(k).max())


@every_element
def test_mass_area_and_moments_are_those_of_the_body(name: str, grid_mesh) -> None:
    element, rho, size = PLANES[name], 7850.0, np.array([3.0, 0.8])
    points, cells = grid_mesh(name, (3, 3), warp=lambda p: p * size, perturbation=0.3)
    x = points[cells]
    total = rho * THICKNESS * size.prod()
    assert plane.areas(element, x).sum() == pytest.approx(size.prod())
    assert rho * plane.volumes(element, x, THICKNESS).sum() == pytest.approx(total)
    m = plane.mass(element, x, rho, THICKNESS)
    one, place = np.tile(np.eye(2), (element.node_count, 1)), x.reshape(len(x), -1)
    np.testing.assert_allclose(np.einsum("ia,eij,jb->ab", one, m, one), total * np.eye(2), atol=1e-9 * total)
    np.testing.assert_allclose(np.einsum("ia,eij,ej->a", one, m, place), total * size / 2)
    spin = ((x - size / 2)[..., ::-1] * [-1.0, 1.0]).reshape(len(x), -1)
    assert np.einsum("ei,eij,ej->", spin, m, spin) == pytest.approx(total / 12 * (size**2).sum())
    diagonal = plane.lumped_mass(element, x, rho, THICKNESS)
    assert (diagonal > 0).all()
    np.testing.assert_allclose(diagonal.sum(axis=1), 2 * rho * THICKNESS * plane.areas(element, x))
    lumped = plane.mass(element, x, rho, THICKNESS, lumped=True)
    assert np.array_equal(lumped, np.eye(element.dof_count) * diagonal[:, None, :])
    if name not in QUADRATIC:
        np.testing.assert_allclose(np.einsum("ia,ei,ei->a", one, diagonal, place), total * size / 2)
    weight = plane.body_force(element, x, (0.0, -rho * 9.81), THICKNESS).reshape(-1, 2).sum(axis=0)
    np.testing.assert_allclose(weight, [0.0, -9.81 * total], atol=1e-9)


@every_element
def test_inverted_and_degenerate_elements_are_found_and_thin_ones_are_not(name: str) -> None:
    element = PLANES[name]
    good = distorted(name, 1)[0]
    clockwise = good * np.array([1.0, -1.0])
    flat = element.nodes * np.array([1.0, 0.0])
    thin = element.nodes * np.array([10.0, 1e-4]) + 1000.0
    x = np.stack([good, clockwise, flat, thin])
    assert plane.check_geometry(element, x).tolist() == [1, 2]
    with pytest.raises(InputError, match="elements 1"):
        plane.stiffness(element, x[:2], WOOD, 1.0)


def test_thickness_of_each_element_scales_its_matrices() -> None:
    x = np.repeat(distorted("quad4", 1), 3, axis=0)
    t = np.array([0.1, 0.2, 0.5])
    one = plane.stiffness(PLANES["quad4"], x[:1], WOOD, 1.0)[0]
    np.testing.assert_allclose(plane.stiffness(PLANES["quad4"], x, WOOD, t), t[:, None, None] * one)
    one = plane.mass(PLANES["quad4"], x[:1], 5.0, 1.0)[0]
    np.testing.assert_allclose(plane.mass(PLANES["quad4"], x, 5.0, t), t[:, None, None] * one)
    with pytest.raises(InputError, match="not negative"):
        plane.stiffness(PLANES["quad4"], x, WOOD, -t)


def cook(tools, name: str, formulation: str, n: int) -> float:
    """Vertical displacement of (48, 52) of Cook's membrane: E 1, ν 1/3, t 1, plane stress, shear force 1."""
    grid_mesh, assemble, solve = tools

    def skew(p: np.ndarray) -> np.ndarray:
        x, y = 48 * p[:, 0], p[:, 1]
        bottom, top = 44 * p[:, 0], 44 + 16 * p[:, 0]
        return np.stack([x, bottom + (top - bottom) * y], axis=1)

    points, cells = grid_mesh(name, (n, n), warp=skew)
    element = PLANES[name]
    forces = nodal_edge_forces(element, points, cells, points[:, 0] > 48 - 1e-9, (0.0, 1 / 16))
    assert forces.sum() == pytest.approx(1.0)
    material = plane_stress(isotropic(1.0, 1 / 3))
    k = assemble(plane.stiffness(element, points[cells], material, 1.0, formulation), cells, len(points))
    clamped = np.flatnonzero(points[:, 0] < 1e-9)
    u = solve(k, forces, (2 * clamped[:, None] + np.arange(2)).ravel()).reshape(-1, 2)
    return float(u[np.hypot(*(points - [48.0, 52.0]).T).argmin(), 1])


@pytest.fixture
def tools(grid_mesh, assemble, solve):
    return grid_mesh, assemble, solve


@pytest.mark.parametrize(
    ("name", "formulation", "coarse"),
    [("quad4", "incompatible", 0.06), ("quad8", "full", 0.02), ("tri6", "full", 0.03)],
)
def test_cooks_membrane_converges(tools, name: str, formulation: str, coarse: float) -> None:
    """Converged solution 23.96; Cook (1974), J. Struct. Div. ASCE 100, 1851-1863."""
    values = np.array([cook(tools, name, formulation, n) for n in (4, 8, 16, 32)])
    errors = np.abs(values / 23.9642 - 1)
    assert errors[0] < coarse and errors[2] < 0.02 and errors[3] < 0.002
    assert (np.diff(errors) < 0).all()


def test_cooks_membrane_converges_slowly_without_modes(tools) -> None:
    plain, modes = (cook(tools, "quad4", f, 8) for f in ("full", "incompatible"))
    assert plain < 0.95 * 23.9642 < 0.98 * 23.9642 < modes
    assert cook(tools, "tri3", "full", 8) < plain


@pytest.mark.parametrize("nu", [0.3, 0.49, 0.4999])
@pytest.mark.parametrize(
    ("name", "formulation"), [("quad4", "incompatible"), ("quad4", "full"), ("tri6", "full")]
)
def test_thick_cylinder_under_pressure(tools, name: str, formulation: str, nu: float) -> None:
    """MacNeal and Harder (1985): a 3, b 9, E 1000, p 1, plane strain; only plain quad4 locks."""
    grid_mesh, assemble, solve = tools
    radii = np.array([3.0, 3.5, 4.2, 5.2, 6.75, 9.0])

    def polar(p: np.ndarray) -> np.ndarray:
        r, angle = np.interp(p[:, 0], np.linspace(0, 1, 6), radii), np.pi / 2 * p[:, 1]
        return np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1)

    points, cells = grid_mesh(name, (5, 9), warp=polar)
    radius = np.hypot(*points.T)
    on_arc = [np.isclose(radius, r, rtol=0.0077) for r in radii]
    for r, on in zip(radii, on_arc, strict=True):
        points[on] *= (r / radius[on])[:, None]
    element = PLANES[name]
    inner, forces = on_arc[0], np.zeros_like(points)
    for edge in element.edges:
        nodes = cells[:, list(edge)]
        nodes = nodes[inner[nodes].all(axis=1)]
        loads = surfaces.pressure_force(f"line{len(edge)}", points[nodes], 1.0)
        np.add.at(forces, nodes, loads.reshape(*nodes.shape, 2))
    material = plane_strain(isotropic(1000.0, nu))
    k = assemble(plane.stiffness(element, points[cells], material, 1.0, formulation), cells, len(points))
    fixed = np.concatenate([2 * np.flatnonzero(np.abs(points[:, i]) < 1e-9) + i for i in range(2)])
    u = solve(k, forces.ravel(), fixed).reshape(-1, 2)
    moved = (u[inner] * points[inner]).sum(axis=1).mean() / 3.0
    ratio = moved / ((1 + nu) * 9 * (3 * (1 - 2 * nu) + 27) / (1000 * 72))
    if formulation == "incompatible":
        assert 0.98 < ratio < 1.0
    elif name == "tri6":
        assert 0.995 < ratio < 1.001
    else:
        assert ratio < {0.3: 1.0, 0.49: 0.90, 0.4999: 0.10}[nu]


def test_one_slender_element_bends_exactly_with_modes(assemble, solve) -> None:
    """Pure bending of a 10 x 1 quad4 in plane stress: v = M L²/2EI, σ = M y/I; plain quad4 has a fraction."""
    element, e, nu, length, height = PLANES["quad4"], 2e11, 0.3, 10.0, 1.0
    x = (element.nodes + [1.0, 0.0]) * [length / 2, height / 2]
    moment, inertia = 1e6, height**3 / 12
    forces = np.zeros((4, 2))
    forces[1, 0], forces[2, 0] = -moment / height, moment / height
    material = plane_stress(isotropic(e, nu))
    cells = np.array([[0, 1, 2, 3]])
    exact = -moment * length**2 / (2 * e * inertia)
    deflection = {}
    for formulation in ("incompatible", "full"):
        k = assemble(plane.stiffness(element, x[None], material, 1.0, formulation), cells, 4)
        u = solve(k, forces.ravel(), np.array([0, 1, 6]))
        deflection[formulation] = u[3] / exact
        if formulation == "incompatible":
            sigma = plane.stress(element, x[None], material, u[None], element.nodes)[0]
            np.testing.assert_allclose(sigma[:, 0], moment * x[:, 1] / inertia, rtol=1e-9)
            np.testing.assert_allclose(sigma[:, 1:], 0.0, atol=1e-6 * moment)
    assert deflection["incompatible"] == pytest.approx(1.0, rel=1e-9)
    # Textbook: (1-ν²)/(1 + (1-ν)/2 (L/h)²), here 0.025.
    shear = (1 - nu**2) / (1 + (1 - nu) / 2 * (length / height) ** 2)
    assert deflection["full"] == pytest.approx(shear, rel=1e-9)
