"""Solid elements, family by family: what every one of them must satisfy."""

import numpy as np
import pytest

from axlespan.elements import solids, surfaces
from axlespan.elements.elasticity import isotropic, orthotropic, rotated
from axlespan.elements.quadrature import gauss, tetrahedron
from axlespan.elements.solids import SOLIDS
from axlespan.errors import InputError

FAMILIES = [(name, "full") for name in SOLIDS] + [("hex8", "incompatible")]
QUADRATIC = ("hex20", "tet10")
WOOD = orthotropic((11e9, 0.9e9, 0.5e9), (0.37, 0.43, 0.42), (0.69e9, 0.05e9, 0.7e9))
AXES = np.linalg.qr(np.random.default_rng(4).standard_normal((3, 3)))[0]

every_family = pytest.mark.parametrize(("name", "formulation"), FAMILIES)
every_element = pytest.mark.parametrize("name", SOLIDS)


def distorted(name: str, count: int = 3, curved: bool = True, seed: int = 0) -> np.ndarray:
    """Elements (count, n_node, 3) of about 2 x 1 x 0.7 m, skewed, moved at random, with curved edges."""
    rng = np.random.default_rng(seed)
    nodes = SOLIDS[name].nodes
    corners = {"hex20": 8, "tet10": 4}.get(name, len(nodes))
    span = np.ptp(nodes, axis=0)[0]
    x = nodes + 0.08 * span * rng.uniform(-1, 1, (count, *nodes.shape))
    for edge in SOLIDS[name].edges[: len(nodes) - corners]:
        straight = x[:, edge[:2]].mean(axis=1)
        x[:, edge[2]] = straight + curved * 0.03 * span * rng.uniform(-1, 1, straight.shape)
    stretch = np.array([[2.0, 0.0, 0.0], [0.4, 1.0, 0.0], [0.2, -0.3, 0.7]]) / span
    return x @ stretch + np.array([100.0, -20.0, 8.0])


def rigid_motions(x: np.ndarray) -> np.ndarray:
    """Three translations and three rotations (6, n_dof) about the mean of the nodes (n_node, 3)."""
    arm = x - x.mean(axis=0)
    return np.array(
        [np.tile(e, (len(x), 1)) for e in np.eye(3)] + [np.cross(e, arm) for e in np.eye(3)]
    ).reshape(6, -1)


@every_family
def test_exactly_six_rigid_body_modes_and_symmetry(name: str, formulation: str) -> None:
    for nu in (0.0, 0.3, 0.49):
        for x in distorted(name):
            k = solids.stiffness(SOLIDS[name], x[None], isotropic(3e10, nu), formulation)[0]
            assert np.array_equal(k, k.T)
            values = np.linalg.eigvalsh(k)
            assert np.abs(values[:6]).max() < 1e-13 * values[-1]
            assert values[6] > 1e-5 * values[-1]
            assert np.abs(k @ rigid_motions(x).T).max() < 1e-11 * np.abs(k).max()


@every_element
def test_energy_is_that_of_the_finite_difference_strains(name: str) -> None:
    """uᵀKu/2 against ∫ ε:D:ε/2, strains from central differences of the displacement field."""
    element = SOLIDS[name]
    x = distorted(name, 1)[0] - np.array([100.0, -20.0, 8.0])
    u = np.random.default_rng(8).standard_normal((element.node_count, 3))
    energy = 0.0
    for point, weight in zip(element.stiffness_rule.points, element.stiffness_rule.weights, strict=True):
        j, du = np.empty((3, 3)), np.empty((3, 3))
        for a, h in enumerate(1e-4 * np.eye(3)):
            change = (element.shape.values([point + h]) - element.shape.values([point - h]))[0] / 2e-4
            j[a], du[a] = change @ x, change @ u
        gradient = np.linalg.solve(j, du).T
        e = gradient + gradient.T
        strain = np.array([e[0, 0] / 2, e[1, 1] / 2, e[2, 2] / 2, e[0, 1], e[1, 2], e[2, 0]])
        energy += 0.5 * strain @ WOOD @ strain * weight * np.linalg.det(j)
    k = solids.stiffness(element, x[None], WOOD, "full")[0]
    assert 0.5 * u.ravel() @ k @ u.ravel() == pytest.approx(energy, rel=1e-7)


def test_incompatible_modes_minimize_the_energy() -> None:
    """A plain element with 24 + 12 d.o.f., point by point, condensed by a least-squares solution."""
    element, x = SOLIDS["hex8"], distorted("hex8", 1)[0]
    u = np.random.default_rng(8).standard_normal(24)
    j0 = element.shape.derivatives([[0, 0, 0]])[0] @ x
    root = np.linalg.cholesky(WOOD).T
    compatible, modes = [], []
    for point, weight in zip(*(getattr(gauss(3, 2), f) for f in ("points", "weights")), strict=True):
        dn = element.shape.derivatives([point])[0]
        j = dn @ x
        det = np.linalg.det(j)
        gradients = [np.linalg.solve(j, dn[:, a]) for a in range(8)]
        hats = [np.linalg.solve(j0, np.eye(3)[a]) * point[a] * np.linalg.det(j0) / det for a in range(3)]
        dilatation = np.zeros((6, 3))
        dilatation[:3] = np.prod(point) / point * np.linalg.det(j0) / det
        compatible.append(np.sqrt(weight * det) * root @ np.hstack([_b(g) for g in gradients]))
        modes.append(np.sqrt(weight * det) * root @ np.hstack([*(_b(g) for g in hats), dilatation]))
    plain = np.vstack(compatible) @ u
    amplitudes, *_ = np.linalg.lstsq(np.vstack(modes), -plain, rcond=None)
    residual = plain + np.vstack(modes) @ amplitudes
    k = solids.stiffness(element, x[None], WOOD)[0]
    assert u @ k @ u == pytest.approx(residual @ residual, rel=1e-10)
    assert u @ k @ u < 0.99 * (plain @ plain)


def _b(g: np.ndarray) -> np.ndarray:
    """Strains of one node's displacements with the gradient g of its shape function."""
    return np.array(
        [[g[0], 0, 0], [0, g[1], 0], [0, 0, g[2]], [g[1], g[0], 0], [0, g[2], g[1]], [g[2], 0, g[0]]]
    )


@every_family
def test_stresses_are_in_equilibrium_with_the_nodal_forces(name: str, formulation: str) -> None:
    """Virtual work: K u = ∫ Bᵀ σ dV with the stresses that are reported; S u are the same stresses."""
    element, x = SOLIDS[name], distorted(name)
    u = np.random.default_rng(5).standard_normal((len(x), element.dof_count))
    rule = element.stiffness_rule
    sigma = solids.stress(element, x, WOOD, u, rule.points, formulation)
    forces = np.zeros((len(x), element.node_count, 3))
    for e, q in np.ndindex(len(x), len(rule)):
        dn = element.shape.derivatives(rule.points[q : q + 1])[0]
        j = dn @ x[e]
        s = sigma[e, q]
        tensor = np.array([[s[0], s[3], s[5]], [s[3], s[1], s[4]], [s[5], s[4], s[2]]])
        forces[e] += rule.weights[q] * np.linalg.det(j) * np.linalg.solve(j, dn).T @ tensor
    k = solids.stiffness(element, x, WOOD, formulation)
    expected = np.einsum("eij,ej->ei", k, u)
    np.testing.assert_allclose(forces.reshape(len(x), -1), expected, atol=1e-10 * np.abs(expected).max())
    matrix = solids.stress_matrix(element, x, WOOD, rule.points, formulation)
    np.testing.assert_allclose(np.einsum("epsd,ed->eps", matrix, u), sigma, atol=1e-11 * np.abs(sigma).max())


@every_family
@pytest.mark.parametrize("material", [isotropic(1e6, 0.25), isotropic(1e6, 0.4999), rotated(WOOD, AXES)])
def test_patch_of_distorted_elements_reproduces_constant_strain(
    name: str, formulation: str, material: np.ndarray, grid_mesh, assemble, solve
) -> None:
    """MacNeal and Harder (1985): only the outer nodes are prescribed, the inner ones follow."""
    points, cells = grid_mesh(name, (2, 2, 2), perturbation=0.3, seed=2)
    gradient = 1e-3 * np.array([[1.0, 0.5, 0.2], [0.4, -0.7, 0.3], [0.1, 0.6, 0.9]])
    exact = points @ gradient.T
    outer = np.flatnonzero(((points < 1e-9) | (points > 1 - 1e-9)).any(axis=1))
    assert len(outer) < len(points)
    element = SOLIDS[name]
    k = assemble(solids.stiffness(element, points[cells], material, formulation), cells, len(points))
    fixed = (3 * outer[:, None] + np.arange(3)).ravel()
    u = solve(k, np.zeros(exact.size), fixed, exact.ravel()).reshape(-1, 3)
    np.testing.assert_allclose(u, exact, atol=1e-11)
    e = gradient + gradient.T
    strain = np.array([e[0, 0] / 2, e[1, 1] / 2, e[2, 2] / 2, e[0, 1], e[1, 2], e[2, 0]])
    for at in (None, element.nodes):
        sigma = solids.stress(
            element, points[cells], material, u[cells].reshape(len(cells), -1), at, formulation
        )
        expected = np.broadcast_to(material @ strain, sigma.shape)
        np.testing.assert_allclose(sigma, expected, atol=1e-7 * np.abs(expected).max())


@every_family
def test_a_rotated_element_of_rotated_material_has_the_rotated_matrix(name: str, formulation: str) -> None:
    element, x = SOLIDS[name], distorted(name)
    q = AXES * np.sign(np.linalg.det(AXES))
    k = solids.stiffness(element, x, WOOD, formulation)
    turn = np.kron(np.eye(element.node_count), q)
    turned = solids.stiffness(element, x @ q.T, rotated(WOOD, q.T), formulation)
    np.testing.assert_allclose(turned, turn @ k @ turn.T, atol=1e-10 * np.abs(k).max())


@every_element
def test_mass_volume_and_moments_are_those_of_the_body(name: str, grid_mesh) -> None:
    """A distorted mesh of a box: mass, first moments and inertia to rounding; lumped mass the total."""
    element, rho, size = SOLIDS[name], 2400.0, np.array([3.0, 0.8, 1.2])
    points, cells = grid_mesh(name, (2, 2, 2), warp=lambda p: p * size, perturbation=0.3)
    x = points[cells]
    total = rho * size.prod()
    assert solids.volumes(element, x).sum() == pytest.approx(size.prod())
    m = solids.mass(element, x, rho)
    assert np.array_equal(m, m.transpose(0, 2, 1))
    assert np.linalg.eigvalsh(m).min() > 0
    one, place = np.tile(np.eye(3), (element.node_count, 1)), x.reshape(len(x), -1)
    np.testing.assert_allclose(np.einsum("ia,eij,jb->ab", one, m, one), total * np.eye(3), atol=1e-9 * total)
    np.testing.assert_allclose(np.einsum("ia,eij,ej->a", one, m, place), total * size / 2)
    # Rotation about the center: [θ × r]ᵀ M [θ × r] is the moment of inertia of the box.
    for axis in range(3):
        spin = np.cross(np.eye(3)[axis], x - size / 2).reshape(len(x), -1)
        inertia = total / 12 * (np.delete(size, axis) ** 2).sum()
        assert np.einsum("ei,eij,ej->", spin, m, spin) == pytest.approx(inertia)
    diagonal = solids.lumped_mass(element, x, rho)
    assert (diagonal > 0).all()
    lumped = solids.mass(element, x, rho, lumped=True)
    assert np.array_equal(lumped, np.eye(element.dof_count) * diagonal[:, None, :])
    np.testing.assert_allclose(diagonal.sum(axis=1), 3 * rho * solids.volumes(element, x))
    if name not in QUADRATIC:
        np.testing.assert_allclose(np.einsum("ia,ei,ei->a", one, diagonal, place), total * size / 2)


@pytest.mark.parametrize(
    ("name", "corner", "middle"),
    [("hex8", 1 / 8, 0.0), ("tet4", 1 / 4, 0.0), ("hex20", -1 / 8, 1 / 6), ("tet10", -1 / 20, 1 / 5)],
)
def test_weight_of_a_parallelepiped_on_the_nodes(name: str, corner: float, middle: float) -> None:
    """Textbook values (Zienkiewicz): quadratic corners are pulled up."""
    element = SOLIDS[name]
    x = element.nodes @ np.array([[2.0, 0.0, 0.0], [0.3, 1.0, 0.0], [0.1, 0.2, 0.5]])
    weight = 9.81 * solids.volumes(element, x[None])[0]
    f = solids.body_force(element, x[None], (0.0, 0.0, -9.81)).reshape(-1, 3)
    corners = 8 if name.startswith("hex") else 4
    np.testing.assert_allclose(f[:corners, 2], -corner * weight)
    np.testing.assert_allclose(f[corners:, 2], -middle * weight)
    assert np.array_equal(f[:, :2], np.zeros((len(f), 2)))


@every_element
def test_faces_close_the_element_and_look_outward(name: str) -> None:
    """∮ n dA = 0 and the divergence theorem ∮ x·n dA = 3 V, also with curved faces."""
    element = SOLIDS[name]
    x = distorted(name) - np.array([100.0, -20.0, 8.0])
    flux, closed = np.zeros(len(x)), np.zeros((len(x), 3))
    for face in element.faces:
        nodes = x[:, list(face.nodes)]
        push = -surfaces.pressure_force(face.kind, nodes, 1.0).reshape(len(x), -1, 3)
        flux += np.einsum("eai,eai->e", push, nodes)
        closed += push.sum(axis=1)
    np.testing.assert_allclose(flux / 3, solids.volumes(element, x), rtol=1e-12)
    np.testing.assert_allclose(closed, 0.0, atol=1e-12)


@every_element
def test_inverted_and_degenerate_elements_are_found_and_thin_ones_are_not(name: str) -> None:
    element = SOLIDS[name]
    good = distorted(name, 1)[0]
    mirrored = good * np.array([1.0, 1.0, -1.0])
    flat = element.nodes * np.array([1.0, 1.0, 0.0])
    thin = element.nodes * np.array([10.0, 2.0, 1e-4]) + 1000.0
    collapsed = good.copy()
    collapsed[2] = collapsed[1]
    x = np.stack([good, mirrored, flat, thin, collapsed, np.full_like(good, 3.0)])
    assert solids.check_geometry(element, x).tolist() == [1, 2, 4, 5]
    assert solids.check_geometry(element, x[:0]).tolist() == []
    with pytest.raises(InputError, match="elements 1, 2"):
        solids.stiffness(element, x[:3], WOOD)
    assert solids.volumes(element, x)[1] == pytest.approx(-solids.volumes(element, x)[0])


@every_family
def test_congruent_elements_get_the_matrices_of_each_alone(name: str, formulation: str, grid_mesh) -> None:
    """A structured mesh far from the origin, two materials: computed once per kind, equal to rounding."""
    element = SOLIDS[name]
    points, cells = grid_mesh(name, (6, 3, 2), warp=lambda p: p * [1.5, 0.7, 0.33] + [4321.7, 0.1, -55.3])
    x = points[cells]
    material = np.where((np.arange(len(x)) % 2 == 0)[:, None, None], WOOD, isotropic(1e9, 0.3))
    together = solids.stiffness(element, x, material, formulation)
    stresses = solids.stress(element, x, material, x.reshape(len(x), -1) ** 2, None, formulation)
    masses = solids.mass(element, x, np.arange(1.0, len(x) + 1))
    for e in range(len(x)):
        alone = solids.stiffness(element, x[e : e + 1], material[e], formulation)[0]
        np.testing.assert_allclose(together[e], alone, atol=1e-10 * np.abs(alone).max())
        alone = solids.stress(
            element, x[e : e + 1], material[e], x[e].reshape(1, -1) ** 2, None, formulation
        )[0]
        np.testing.assert_allclose(stresses[e], alone, atol=1e-9 * np.abs(alone).max())
        alone = solids.mass(element, x[e : e + 1], e + 1.0)[0]
        np.testing.assert_allclose(masses[e], alone, atol=1e-10 * alone.max())


def test_first_moment_of_a_curved_element_is_exact() -> None:
    """Consistent mass of curved tet10 and hex20 against rules of higher order in the test."""
    fine = {"hex20": gauss(3, 6), "tet10": tetrahedron(5)}
    for name, rule in fine.items():
        element, x = SOLIDS[name], distorted(name, 1)[0]
        det = np.linalg.det(element.shape.derivatives(rule.points) @ x)
        moment = (rule.weights * det) @ (element.shape.values(rule.points) @ x)
        m = solids.mass(element, x[None], 1.0)[0]
        np.testing.assert_allclose((m @ x.ravel()).reshape(-1, 3).sum(axis=0), moment, rtol=1e-12)


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda x: solids.stiffness(SOLIDS["hex8"], x[:, :4], WOOD), r"\(n_element, 8, 3\) for hex8"),
        (lambda x: solids.stiffness(SOLIDS["hex8"], x * np.nan, WOOD), "finite"),
        (lambda x: solids.stiffness(SOLIDS["hex8"], x, WOOD, "reduced"), "'incompatible' or 'full'"),
        (lambda x: solids.stiffness(SOLIDS["hex8"], x, np.tile(WOOD, (2, 1, 1))), "each of the 3 elements"),
        (lambda x: solids.stress(SOLIDS["hex8"], x, WOOD, np.zeros((3, 8))), r"\(3, 24\)"),
        (lambda x: solids.mass(SOLIDS["hex8"], x, -1.0), "not negative"),
        (lambda x: solids.mass(SOLIDS["hex8"], x, np.ones(2)), r"\(3,\)"),
    ],
)
def test_wrong_input_is_named(call, text: str) -> None:
    with pytest.raises(InputError, match=text):
        call(distorted("hex8"))


def test_no_elements_give_empty_matrices() -> None:
    nothing = np.empty((0, 8, 3))
    assert solids.stiffness(SOLIDS["hex8"], nothing, WOOD).shape == (0, 24, 24)
    assert solids.mass(SOLIDS["hex8"], nothing, 1.0).shape == (0, 24, 24)
    assert solids.body_force(SOLIDS["hex8"], nothing, (0.0, 0.0, 1.0)).shape == (0, 24)
    assert surfaces.pressure_force("quad4", np.empty((0, 4, 3)), 1.0).shape == (0, 12)
