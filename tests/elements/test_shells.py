"""Properties of single shell elements and small patches."""

import numpy as np
import pytest

from axlespan.elements import shells
from axlespan.elements.shells import ShellMaterial
from axlespan.errors import InputError

STEEL = ShellMaterial.isotropic(210e9, 0.3)
SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
QUADRILATERALS = {
    "square": SQUARE,
    "slender": [[0, 0, 0], [20, 0, 0], [20, 1, 0], [0, 1, 0]],
    "trapezoid": [[0, 0, 0], [2, 0, 0], [1.4, 1, 0], [0.3, 1, 0]],
    "distorted": [[0, 0, 0], [1.3, -0.2, 0], [0.9, 1.4, 0], [-0.2, 0.5, 0]],
    "nearly a triangle": [[0, 0, 0], [1, 0, 0], [0.52, 0.5, 0], [0, 1, 0]],
    "warped": [[0, 0, 0.2], [1.2, 0.1, -0.1], [1.0, 0.9, 0.15], [-0.1, 1.1, -0.2]],
    "twisted": [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 1, 0]],
}
TRIANGLES = {
    "right": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
    "needle": [[0, 0, 0], [10, 0, 0], [9, 0.5, 0]],
    "in space": [[0.1, 0.2, 0.3], [1.2, 0.1, -0.5], [0.4, 1.3, 0.6]],
}
SHAPES = [("shell4", np.array(x, dtype=float)) for x in QUADRILATERALS.values()] + [
    ("shell3", np.array(x, dtype=float)) for x in TRIANGLES.values()
]
NAMES = [*QUADRILATERALS, *TRIANGLES]
every_shape = pytest.mark.parametrize(("kind", "x"), SHAPES, ids=NAMES)

# MacNeal and Harder (1985): the patch of distorted elements, with its four inner nodes.
PATCH = 0.01 * np.array([[0, 0], [24, 0], [24, 12], [0, 12], [4, 2], [18, 3], [16, 8], [8, 8]], dtype=float)
PATCH_CELLS = {"shell4": np.array([[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 6, 7]])}
PATCH_CELLS["shell3"] = np.vstack([PATCH_CELLS["shell4"][:, [0, 1, 2]], PATCH_CELLS["shell4"][:, [0, 2, 3]]])


def rotation(seed):
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return q * np.sign(np.linalg.det(q))


def rigid_motions(points):
    """Displacements (6 n, 6) of unit translations and rotations about the origin."""
    modes = np.zeros((len(points), 6, 6))
    modes[:, :3, :3] = modes[:, 3:, 3:] = np.eye(3)
    for k, axis in enumerate(np.eye(3)):
        modes[:, :3, 3 + k] = np.cross(axis, points)
    return modes.reshape(-1, 6)


def assembled(cells, matrices, n_points):
    dofs = (6 * cells[:, :, None] + np.arange(6)).reshape(len(cells), -1)
    total = np.zeros((6 * n_points, 6 * n_points))
    for d, matrix in zip(dofs, matrices, strict=True):
        total[np.ix_(d, d)] += matrix
    return total, dofs


@every_shape
@pytest.mark.parametrize("thickness", [0.1, 1e-3])
@pytest.mark.parametrize(("offset", "turning"), [(0.0, 0.0), (0.3, 0.1)])
def test_only_rigid_motions_are_free_of_stress(kind, x, thickness, offset, turning):
    k = shells.stiffness(kind, x[None], STEEL, thickness, offset, turning)[0]
    np.testing.assert_array_equal(k, k.T)
    motions = rigid_motions(x)
    assert np.abs(k @ motions).max() < 1e-14 * np.abs(k).max() * max(1.0, np.abs(x).max())
    q, _ = np.linalg.qr(motions, mode="complete")
    deforming = np.linalg.eigvalsh(q[:, 6:].T @ k @ q[:, 6:])
    assert deforming[0] > 1e-12 * deforming[-1]  # t = 0.001, 10 long: 1e-11 at best


@pytest.mark.parametrize("kind", ["shell3", "shell4"])
def test_a_free_warped_mesh_has_six_zero_eigenvalues(kind):
    u, v = (a.ravel() for a in np.meshgrid(np.arange(4.0), np.arange(4.0), indexing="ij"))
    points = np.stack([u, v + 0.1 * u, 0.15 * u * v + 0.05 * u**2], axis=1)
    first = (np.arange(3)[:, None] * 4 + np.arange(3)).ravel()
    cells = np.stack([first, first + 4, first + 5, first + 1], axis=1)
    if kind == "shell3":
        cells = np.vstack([cells[:, [0, 1, 2]], cells[:, [0, 2, 3]]])
    k, _ = assembled(cells, shells.stiffness(kind, points[cells], STEEL, 0.1), len(points))
    values = np.abs(np.linalg.eigvalsh(k))
    assert values[5] < 1e-14 * values[-1]
    assert values[6] > 1e-7 * values[-1]


@every_shape
def test_stiffness_and_mass_turn_with_the_element(kind, x):
    q, n = rotation(3), len(x)
    big = np.kron(np.eye(2 * n), q)
    for make in (
        lambda p: shells.stiffness(kind, p[None], STEEL, 0.05, 0.1)[0],
        lambda p: shells.mass(kind, p[None], 7850.0, 0.05, 0.1)[0],
        lambda p: shells.mass(kind, p[None], 7850.0, 0.05, 0.1, lumped=True)[0],
    ):
        here = make(x)
        np.testing.assert_allclose(make(x @ q.T + 7.0), big @ here @ big.T, atol=1e-10 * np.abs(here).max())


@every_shape
def test_numbering_may_start_at_any_node(kind, x):
    here = shells.stiffness(kind, x[None], STEEL, 0.05, 0.02)[0]
    there = shells.stiffness(kind, np.roll(x, 1, axis=0)[None], STEEL, 0.05, 0.02)[0]
    order = np.roll(np.arange(6 * len(x)), 6)
    np.testing.assert_allclose(there, here[np.ix_(order, order)], atol=1e-9 * np.abs(here).max())


@every_shape
def test_an_offset_is_a_rigid_link_to_the_mid_surface(kind, x):
    normal = shells.resultants(kind, x[None], STEEL, 0.1, np.zeros((1, 6 * len(x)))).axes[0, 2]
    lever = np.cross(np.eye(3), 0.25 * normal).T  # θ × d n as a matrix on θ
    link = np.kron(np.eye(len(x)), np.block([[np.eye(3), lever], [np.zeros((3, 3)), np.eye(3)]]))
    plain = shells.stiffness(kind, (x + 0.25 * normal)[None], STEEL, 0.1)[0]
    expected = link.T @ plain @ link
    offset = shells.stiffness(kind, x[None], STEEL, 0.1, 0.25)[0]
    np.testing.assert_allclose(offset, expected, atol=1e-10 * np.abs(expected).max())


def linear_state(points, slopes, curvatures):
    """Nodal displacements of constant strains, constant curvatures and a rotation, in the x-y plane."""
    x, y = points[:, 0], points[:, 1]
    a, b, c, d = slopes  # u = a x + b y, v = c x + d y
    kx, ky, kxy = curvatures  # of w: w,xx = -kx ...
    w = -0.5 * (kx * x**2 + ky * y**2 + kxy * x * y)
    wx, wy = -(kx * x + 0.5 * kxy * y), -(ky * y + 0.5 * kxy * x)
    return np.stack([a * x + b * y, c * x + d * y, w, wy, -wx, np.full_like(x, 0.5 * (c - b))], axis=1)


@pytest.mark.parametrize("kind", ["shell3", "shell4"])
@pytest.mark.parametrize("thickness", [0.001, 0.05])
@pytest.mark.parametrize("tilted", [False, True])
def test_patch_of_distorted_elements_keeps_constant_states(kind, thickness, tilted):
    material = ShellMaterial.isotropic(1e6, 0.25)
    flat = np.column_stack([PATCH, np.zeros(8)])
    exact = linear_state(flat, (1e-3, 0.5e-3, 0.5e-3, 1e-3), (-1e-3, -1e-3, -1e-3))
    q = rotation(5) if tilted else np.eye(3)
    points, exact = flat @ q.T, np.hstack([exact[:, :3] @ q.T, exact[:, 3:] @ q.T])
    cells = PATCH_CELLS[kind]
    k, dofs = assembled(cells, shells.stiffness(kind, points[cells], material, thickness), 8)
    u = exact.ravel().copy()
    held, free = np.arange(24), np.arange(24, 48)
    u[free] = np.linalg.solve(k[np.ix_(free, free)], -k[np.ix_(free, held)] @ u[held])
    np.testing.assert_allclose(u, exact.ravel(), rtol=0, atol=1e-9 * np.abs(exact).max())

    found = shells.resultants(kind, points[cells], material, thickness, u[dofs]).along(q[:, 0])
    # stresses published: 1333, 1333, 400; moments 1.111e-7, 1.111e-7, 3.333e-8 for t = 0.001
    np.testing.assert_allclose(
        found.normal_forces / thickness,
        np.broadcast_to([4e3 / 3, 4e3 / 3, 400.0], found.moments.shape),
        rtol=1e-7,
    )
    moment = -1e-3 * thickness**3 / 12 * np.array([4e6 / 3, 4e6 / 3, 4e5])
    np.testing.assert_allclose(found.moments, np.broadcast_to(moment, found.moments.shape), rtol=1e-6)
    assert np.abs(found.shear_forces).max() < 1e-6 * abs(moment[0]) / 0.02


@pytest.mark.parametrize("thickness", [0.001, 0.05])
@pytest.mark.parametrize("cut", [[4], [0, 2], [1]])
def test_patch_of_both_kinds_keeps_constant_states(thickness, cut):
    material = ShellMaterial.isotropic(1e6, 0.25)
    points = np.column_stack([PATCH, np.zeros(8)])
    exact = linear_state(points, (1e-3, 0.5e-3, 0.5e-3, 1e-3), (-1e-3, -1e-3, -1e-3)).ravel()
    cells = PATCH_CELLS["shell4"]
    four = np.delete(cells, cut, axis=0)
    three = np.vstack([cells[cut][:, [0, 1, 2]], cells[cut][:, [0, 2, 3]]])
    mixed = shells.mixed_sides(three, four)
    assert mixed.sum() == (np.isin(cells[cut], [4, 5, 6, 7]).sum() if cut == [4] else 3 * len(cut))
    k4, _ = assembled(four, shells.stiffness("shell4", points[four], material, thickness), 8)
    k3, d3 = assembled(three, shells.stiffness("shell3", points[three], material, thickness, mixed=mixed), 8)
    k, held, free = k3 + k4, np.arange(24), np.arange(24, 48)
    found = np.linalg.solve(k[np.ix_(free, free)], -k[np.ix_(free, held)] @ exact[held])
    np.testing.assert_allclose(found, exact[free], rtol=0, atol=1e-9 * np.abs(exact).max())
    forces = shells.resultants("shell3", points[three], material, thickness, exact[d3], mixed=mixed)
    forces = forces.along([1.0, 0.0, 0.0]).normal_forces / thickness
    np.testing.assert_allclose(forces, np.broadcast_to([4e3 / 3, 4e3 / 3, 400.0], forces.shape), rtol=1e-8)


@pytest.mark.parametrize("kind", ["shell3", "shell4"])
@pytest.mark.parametrize("thickness", [0.002, 0.4])
def test_strip_under_a_shear_force(kind, thickness):
    """Tip of a distorted strip without lateral contraction: P L³/3EI + P L/κGA, at Q = P/b."""
    length, width, n = 2.0, 0.4, 8
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n + 1), np.arange(3), indexing="ij"))
    points = np.stack([length * i / n, width * j / 2, 0.0 * i], axis=1)
    inner = (i > 0) & (i < n) & (j == 1)
    points[inner, :2] += np.random.default_rng(0).uniform(-0.04, 0.04, (inner.sum(), 2))
    first = (np.arange(n)[:, None] * 3 + np.arange(2)).ravel()
    cells = np.stack([first, first + 3, first + 4, first + 1], axis=1)
    if kind == "shell3":
        cells = np.vstack([cells[:, [0, 1, 2]], cells[:, [0, 2, 3]]])
    material = ShellMaterial.isotropic(1e9, 0.0)
    k, dofs = assembled(cells, shells.stiffness(kind, points[cells], material, thickness), len(points))
    load = np.zeros(len(k))
    load[6 * np.flatnonzero(i == n) + 2] = [0.25, 0.5, 0.25]
    free = np.setdiff1d(np.arange(len(k)), (6 * np.flatnonzero(i == 0)[:, None] + np.arange(6)).ravel())
    u = np.zeros(len(k))
    u[free] = np.linalg.solve(k[np.ix_(free, free)], load[free])
    exact = length**3 / (3 * 1e9 * width * thickness**3 / 12) + length / (5 / 6 * 0.5e9 * width * thickness)
    assert u[6 * np.flatnonzero(i == n) + 2].mean() == pytest.approx(exact, rel=4e-3)
    found = shells.resultants(kind, points[cells], material, thickness, u[dofs]).along([1.0, 0.0, 0.0])
    area = shells.areas(kind, points[cells])[:, None]
    # the moment is P (L - x) in all, pulling below for a tip that goes up: M_x < 0 at the top side
    assert (area * found.moments.mean(axis=1)).sum(axis=0) == pytest.approx(
        [-0.5 * length**2, 0.0, 0.0], abs=0.02
    )
    if kind == "shell4":
        mean = (area * found.shear_forces.mean(axis=1)).sum(axis=0) / area.sum()
        np.testing.assert_allclose(mean, [1.0 / width, 0.0], atol=0.02 / width)


@pytest.mark.parametrize("aspect", [1.0, 5.0, 20.0])
@pytest.mark.parametrize(("nu", "excess"), [(0.0, 1e-9), (0.3, 0.03)])
def test_in_plane_bending_of_a_rectangle_has_the_energy_of_a_beam(aspect, nu, excess):
    """E h³/12 κ² per length: two triangles exactly, a quadrilateral where ν = 0."""
    x = (np.array(SQUARE, dtype=float) - [0.5, 0.5, 0.0]) * [aspect, 1.0, 1.0]
    d = np.zeros((4, 6))
    d[:, 0], d[:, 1] = -x[:, 0] * x[:, 1], 0.5 * (x[:, 0] ** 2 + nu * x[:, 1] ** 2)
    d[:, 5] = x[:, 0]
    material = ShellMaterial.isotropic(1.0, nu)
    energy = 0.5 * d.ravel() @ shells.stiffness("shell4", x[None], material, 1.0)[0] @ d.ravel()
    assert 1.0 - 1e-9 < energy / (aspect / 24.0) < 1.0 + excess
    cut = np.array([[0, 1, 2], [0, 2, 3]])
    parts = shells.stiffness("shell3", x[cut], material, 1.0)
    energy = sum(0.5 * d[c].ravel() @ k @ d[c].ravel() for c, k in zip(cut, parts, strict=True))
    assert energy == pytest.approx(aspect / 24.0, rel=1e-9)


@pytest.mark.parametrize("kind", ["shell3", "shell4"])
def test_an_orthotropic_layer_obeys_the_rotated_law(kind):
    """Constant strain and curvature against C_ijkl turned index by index."""
    angle = 0.7
    layer = ShellMaterial(40e9, 10e9, 0.25, 5e9, 4e9, 3e9, direction=(1.0, 0.0, 0.0), angle=angle)
    s = np.array([[1 / 40e9, -0.25 / 40e9, 0], [-0.25 / 40e9, 1 / 10e9, 0], [0, 0, 1 / 5e9]])
    c = np.linalg.inv(s)
    tensor = np.zeros((2, 2, 2, 2))
    pairs = [(0, 0), (1, 1), (0, 1)]
    for a, (i, j) in enumerate(pairs):
        for b, (k, m) in enumerate(pairs):
            for p, q in {(i, j), (j, i)}:
                for r, t in {(k, m), (m, k)}:
                    tensor[p, q, r, t] = c[a, b]
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    tensor = np.einsum("abcd,ai,bj,ck,dl->ijkl", tensor, turn, turn, turn, turn)
    strain = np.array([[1e-3, 0.2e-3], [0.2e-3, -0.4e-3]])
    stress = np.einsum("ijkl,kl->ij", tensor, strain)
    x = np.array(QUADRILATERALS["distorted"] if kind == "shell4" else TRIANGLES["needle"], dtype=float)
    # strains as above and the same numbers as curvatures; w,xy carries half of the engineering twist
    d = linear_state(x, (1e-3, 0.2e-3, 0.2e-3, -0.4e-3), (1e-3, -0.4e-3, 0.4e-3))
    found = shells.resultants(kind, x[None], layer, 0.2, d.ravel()[None]).along([1.0, 0.0, 0.0])
    expected = np.array([stress[0, 0], stress[1, 1], stress[0, 1]])
    np.testing.assert_allclose(found.normal_forces[0, 0], 0.2 * expected, rtol=1e-8)
    np.testing.assert_allclose(found.moments[0, 1], 0.2**3 / 12 * expected, rtol=1e-8)


def test_isotropic_is_orthotropic_with_equal_moduli_at_any_angle():
    same = ShellMaterial(210e9, 210e9, 0.3, *[210e9 / 2.6] * 3, direction=(0.3, 0.8, 0.1), angle=0.4)
    for kind, x in SHAPES:
        expected = shells.stiffness(kind, x[None], STEEL, 0.1)
        found = shells.stiffness(kind, x[None], same, 0.1)
        np.testing.assert_allclose(found, expected, atol=1e-10 * np.abs(expected).max())


@every_shape
@pytest.mark.parametrize("offset", [0.0, 0.3])
def test_mass_has_the_inertia_of_the_plate(kind, x, offset):
    density, t = 2500.0, 0.2
    m = shells.mass(kind, x[None], density, t, offset)[0]
    np.testing.assert_array_equal(m, m.T)
    assert np.linalg.eigvalsh(m)[0] > 0.0
    # integrals over the mean plane by splitting it into triangles: ∫ x xᵀ from the corners' sums
    axes = shells.resultants(kind, x[None], STEEL, t, np.zeros((1, 6 * len(x)))).axes[0]
    local = (x - x.mean(axis=0)) @ axes.T
    local[:, 2] = offset
    area, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for k in range(1, len(x) - 1):
        corner = local[[0, k, k + 1]]
        a = 0.5 * np.cross(corner[1] - corner[0], corner[2] - corner[0])[2]
        total = corner.sum(axis=0)
        area, first = area + a, first + a * total / 3.0
        second = second + a / 12.0 * (corner.T @ corner + np.outer(total, total))
    layer = density * t
    inertia = layer * (np.trace(second) * np.eye(3) - second) + layer * area * t**2 / 12.0 * np.diag(
        [1.0, 1.0, 0.0]
    )
    q = np.kron(np.eye(2 * len(x)), axes)
    motions = rigid_motions((x - x.mean(axis=0)) @ axes.T)
    rigid = motions.T @ (q @ m @ q.T) @ motions
    scale = layer * area * max(1.0, np.abs(local).max() ** 2)
    np.testing.assert_allclose(rigid[:3, :3], layer * area * np.eye(3), atol=1e-12 * scale)
    np.testing.assert_allclose(rigid[3:, 3:], inertia, atol=1e-10 * scale)
    cross = np.cross(np.eye(3), layer * first)  # u = θ × r: ∫ρ r × u
    np.testing.assert_allclose(rigid[3:, :3], cross, atol=1e-10 * scale)


@every_shape
def test_lumped_mass_is_diagonal_with_the_same_total_and_center(kind, x):
    lumped = shells.mass(kind, x[None], 2500.0, 0.2, lumped=True)[0]
    np.testing.assert_array_equal(lumped, np.diag(np.diag(lumped)))
    assert np.diag(lumped).min() > 0.0
    motions = rigid_motions(x)
    total = motions.T @ lumped @ motions
    consistent = motions.T @ shells.mass(kind, x[None], 2500.0, 0.2)[0] @ motions
    np.testing.assert_allclose(total[:3, :], consistent[:3, :], atol=1e-9 * np.abs(total).max())


@every_shape
def test_interpolation_follows_rigid_motions_and_nodes(kind, x):
    motions = rigid_motions(x)
    where = np.array([[0.2, 0.3], [0.1, 0.7], [0.0, 0.4]])
    value = shells.interpolation(kind, x[None], where, offset=0.2)[0]
    shape = np.stack([1 - where.sum(axis=1), where[:, 0], where[:, 1]], axis=1)
    if kind == "shell4":
        r, s = where[:, :1], where[:, 1:]
        shape = 0.25 * (1 + r * [-1, 1, 1, -1]) * (1 + s * [-1, -1, 1, 1])
    expected = rigid_motions(shape @ x).reshape(-1, 6, 6)[:, :3]
    np.testing.assert_allclose(value @ motions, expected, atol=1e-11 * np.abs(expected).max())
    corners = [[0, 0], [1, 0], [0, 1]] if kind == "shell3" else [[-1, -1], [1, -1], [1, 1], [-1, 1]]
    at_nodes = shells.interpolation(kind, x[None], corners, offset=0.2)[0]
    identity = np.eye(6 * len(x)).reshape(len(x), 6, -1)[:, :3]
    np.testing.assert_allclose(at_nodes, identity, atol=1e-12)
    one_each = shells.interpolation(kind, np.stack([x, x + 1.0]), np.stack([where, where[::-1]]))
    np.testing.assert_allclose(one_each[1], one_each[0, ::-1], atol=1e-12)


@pytest.mark.parametrize("kind", ["shell3", "shell4"])
def test_interpolation_of_a_side_is_hermite_up_to_its_quadratic_part(kind):
    x = np.array(SQUARE, dtype=float)[: 3 if kind == "shell3" else 4] * [2.0, 1.0, 1.0]
    middle = [[0.5, 0.0]] if kind == "shell3" else [[0.0, -1.0]]
    row = shells.interpolation(kind, x[None], middle)[0, 0, 2]
    # w(L/2) = (w1 + w2)/2 + L/8 (w'1 - w'2) with w' = -ry
    np.testing.assert_allclose(row[[2, 4, 8, 10]], [0.5, -0.25, 0.5, 0.25])


@every_shape
def test_loads_add_up(kind, x):
    center = x.mean(axis=0)
    motions = rigid_motions(x - center)
    zero = np.zeros((1, 6 * len(x)))
    axes = shells.resultants(kind, x[None], STEEL, 0.1, zero).axes[0]
    area = shells.areas(kind, x[None])[0]
    total = motions.T @ shells.surface_pressure(kind, x[None], 3.0)[0]
    np.testing.assert_allclose(total[:3], 3.0 * area * axes[2], rtol=1e-10, atol=1e-12)
    # consistent with the mass matrix: gravity is M times a unit acceleration
    m = shells.mass(kind, x[None], 1.0, 0.2, 0.1)[0]
    upward = np.tile([0.0, 0.0, 1.0, 0.0, 0.0, 0.0], len(x))
    weight = shells.body_force(kind, x[None], [0.0, 0.0, -9.81], 0.2, 0.1)[0]
    np.testing.assert_allclose(weight, -9.81 * m @ upward, atol=1e-10 * np.abs(weight).max())


def test_consistent_load_of_a_side_is_that_of_a_beam():
    x = np.array(SQUARE, dtype=float) * [4.0, 1.0, 1.0]
    load = shells.surface_pressure("shell4", x[None], 6.0)[0].reshape(4, 6)
    # q L²/12 of the line load q = 6 · 1 over L = 4, half on each long side; w' = -ry
    np.testing.assert_allclose(load[:2, 4], [-4.0, 4.0])
    np.testing.assert_allclose(load[:, 2], 6.0)


def test_geometry_faults_are_told_apart():
    good = np.array(SQUARE, dtype=float)
    cases = np.stack(
        [
            good,
            good * [1, 0, 0],  # on a line
            np.array([[0, 0, 0], [2, 0, 0], [0.5, 0.5, 0], [0, 2, 0]], dtype=float),  # arrow
            good[[0, 2, 1, 3]],  # sides cross
            good + [[0, 0, 0.3], [0, 0, -0.3], [0, 0, 0.3], [0, 0, -0.3]],
            np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 0]], dtype=float),  # two nodes coincide
            good + [[0, 0, 0.02], [0, 0, -0.02], [0, 0, 0.02], [0, 0, -0.02]],
        ]
    )
    faults = shells.check_geometry("shell4", cases)
    assert faults.without_area.tolist() == [1, 3]
    assert faults.non_convex.tolist() == [2, 5]
    assert faults.warped.tolist() == [4]
    assert faults.degenerate.tolist() == [1, 2, 3, 5]
    flat = shells.check_geometry("shell3", cases[:, :3])
    assert flat.degenerate.tolist() == [1]


def test_turning_is_half_the_angle_between_facets():
    n = 6
    angle = np.pi / 2 / n
    a = angle * np.arange(n + 1)
    arc = np.stack([np.sin(a), np.cos(a)], axis=1)
    points = np.array([[x, y, z] for x, z in arc for y in (0.0, 0.5)])
    first = 2 * np.arange(n)
    cells = np.stack([first, first + 2, first + 3, first + 1], axis=1)
    np.testing.assert_allclose(shells.surface_turning(points, {"shell4": cells})["shell4"], angle / 2)
    cells[3] = cells[3, ::-1]  # numbered the other way round: the same surface
    mixed = {"shell4": cells[:5], "shell3": np.array([[10, 12, 13], [10, 13, 11]])}
    found = shells.surface_turning(points, mixed)
    np.testing.assert_allclose(found["shell4"], angle / 2)
    np.testing.assert_allclose(found["shell3"], [0.0, angle / 2], atol=1e-12)
    assert shells.surface_turning(points, {"shell4": cells}, crease=10.0)["shell4"].max() == 0.0


def test_a_web_on_a_smooth_flange_does_not_turn_it():
    points = np.array(
        [[0, 0, 0], [1, 0, 0.1], [2, 0, 0], [0, 1, 0], [1, 1, 0.1], [2, 1, 0], [1, 0, -1], [1, 1, -1]]
    )
    cells = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [6, 1, 4, 7]])
    assert shells.surface_turning(points, {"shell4": cells})["shell4"].tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda: shells.stiffness("shell5", [SQUARE], STEEL, 0.1), "shell3 or shell4"),
        (lambda: shells.stiffness("shell4", [SQUARE[:3]], STEEL, 0.1), r"\(n_e, 4, 3\)"),
        (lambda: shells.stiffness("shell4", [[[0, 0, 0]] * 4], STEEL, 0.1), "element 0 has no area"),
        (lambda: shells.stiffness("shell4", [SQUARE], STEEL, 0.0), "thickness = 0.0: must be positive"),
        (lambda: shells.stiffness("shell4", [SQUARE], STEEL, [0.1, 0.2]), "one per element"),
        (lambda: shells.mass("shell4", [SQUARE], -1.0, 0.1), "density"),
        (lambda: shells.resultants("shell4", [SQUARE], STEEL, 0.1, np.zeros((1, 12))), r"\(1, 24\)"),
        (lambda: shells.body_force("shell4", [SQUARE], [1.0], 0.1), "3 finite numbers"),
        (lambda: shells.stiffness("shell3", [SQUARE[:3]], STEEL, 0.1, mixed=[True]), r"\(1, 3\)"),
        (lambda: ShellMaterial.isotropic(210e9, 0.5), "poisson_ratio"),
        (lambda: ShellMaterial(1e9, 9e9, 0.4, 1e9, 1e9, 1e9), "E_1/E_2"),
        (lambda: ShellMaterial(1e9, 1e9, 0.4, -1e9, 1e9, 1e9), "shear_modulus_12"),
        (lambda: shells.interpolation("shell4", [SQUARE], [0.0, 0.0]), "natural"),
        (lambda: shells.surface_turning(SQUARE, {"shell4": [[0, 1, 2, 7]]}), "rows of the points"),
    ],
)
def test_wrong_input_is_named(call, text):
    with pytest.raises(InputError, match=text):
        call()


def test_a_direction_normal_to_an_element_is_refused():
    layer = ShellMaterial(40e9, 10e9, 0.25, 5e9, 4e9, 3e9, direction=(0.0, 0.0, 1.0))
    with pytest.raises(InputError, match="normal to an element, as it is to element 0"):
        shells.stiffness("shell4", [SQUARE], layer, 0.1)
