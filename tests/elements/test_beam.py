"""Beam elements against closed forms, rigid kinematics, quadrature and finite differences."""

import numpy as np
import pytest
from scipy.linalg import eigh

from axlespan.elements import beam
from axlespan.elements.beam import BeamProperties
from axlespan.reference import euler_bernoulli_frequencies, timoshenko_frequencies

THIN = BeamProperties(
    axial_stiffness=3.0e9,
    bending_stiffness_y=8.0e8,
    bending_stiffness_z=5.0e8,
    torsional_stiffness=2.0e8,
    mass_per_length=1700.0,
    rotary_inertia_y=210.0,
    rotary_inertia_z=130.0,
)
THICK = BeamProperties(
    axial_stiffness=3.0e9,
    bending_stiffness_y=8.0e8,
    bending_stiffness_z=5.0e8,
    torsional_stiffness=2.0e8,
    shear_stiffness_y=4.0e8,
    shear_stiffness_z=9.0e8,
    mass_per_length=1700.0,
    rotary_inertia_y=210.0,
    rotary_inertia_z=130.0,
)
THEORIES = pytest.mark.parametrize("properties", [THIN, THICK], ids=["euler-bernoulli", "timoshenko"])

# Plane d.o.f. (x, z, ry) of both nodes among the twelve.
PLANE = np.array([0, 2, 4, 6, 8, 10])


def skew(r):
    """The matrix of r × ·"""
    x, y, z = r
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def rigid_motions(ends):
    """(12, 6): unit translations and unit rotations about the origin."""
    modes = np.zeros((12, 6))
    for node, r in enumerate(ends):
        modes[6 * node : 6 * node + 3, :3] = np.eye(3)
        modes[6 * node : 6 * node + 3, 3:] = -skew(r)  # θ × r = -r × θ
        modes[6 * node + 3 : 6 * node + 6, 3:] = np.eye(3)
    return modes


def random_ends(n=7, seed=11):
    """Beams of all directions, one of them vertical, one along -x."""
    rng = np.random.default_rng(seed)
    ends = rng.uniform(-4.0, 4.0, (n, 2, 3))
    ends[0, 1] = ends[0, 0] + [0.0, 0.0, 2.5]
    ends[1, 1] = ends[1, 0] - [3.0, 0.0, 0.0]
    return ends


def random_rotation(seed=3):
    q, r = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0.0 else q[:, ::-1]


def along_x(length, n=1):
    """Coordinates (n, 2, 3) of n beams in a row along x."""
    x = np.linspace(0.0, length, n + 1)
    ends = np.zeros((n, 2, 3))
    ends[:, 0, 0], ends[:, 1, 0] = x[:-1], x[1:]
    return ends


def assembled(matrices, n_dof_per_node):
    """Dense matrix of a chain of elements."""
    n, d = len(matrices), n_dof_per_node
    total = np.zeros(((n + 1) * d, (n + 1) * d))
    for e, k in enumerate(matrices):
        total[e * d : (e + 2) * d, e * d : (e + 2) * d] += k
    return total


def chain(length, n, properties, kind):
    """Stiffness or mass of a row of beams in the x-z plane, d.o.f. (x, z, ry) per node."""
    ends = along_x(length, n)
    matrices = getattr(beam, kind)(ends, properties, beam.frames(ends))
    return assembled(matrices[:, PLANE[:, None], PLANE], 3)


class TestFrames:
    def test_axes_are_orthonormal_and_right_handed(self):
        ends = random_ends()
        frame = beam.frames(ends)
        np.testing.assert_allclose(
            frame @ frame.transpose(0, 2, 1), np.broadcast_to(np.eye(3), frame.shape), atol=1e-14
        )
        np.testing.assert_allclose(np.linalg.det(frame), 1.0, rtol=1e-14)
        np.testing.assert_allclose(
            frame[:, 0] * beam.lengths(ends)[:, None], ends[:, 1] - ends[:, 0], atol=1e-14
        )

    def test_local_z_points_up_and_vertical_beams_keep_global_y(self):
        ends = random_ends()
        frame = beam.frames(ends)
        assert np.all(frame[1:, 2, 2] > 0.0)
        np.testing.assert_allclose(frame[1:, 1, 2], 0.0, atol=1e-15)  # local y is level
        np.testing.assert_array_equal(frame[0], [[0, 0, 1], [0, 1, 0], [-1, 0, 0]])
        np.testing.assert_array_equal(frame[1], [[-1, 0, 0], [0, -1, 0], [0, 0, 1]])

    def test_up_lies_in_the_local_xz_plane_on_the_side_of_z(self):
        ends = random_ends()
        up = np.random.default_rng(5).normal(size=(len(ends), 3))
        frame = beam.frames(ends, up)
        np.testing.assert_allclose((frame[:, 1] * up).sum(axis=1), 0.0, atol=1e-14)
        assert np.all((frame[:, 2] * up).sum(axis=1) > 0.0)


class TestRigidBodyMotions:
    @THEORIES
    def test_space_has_exactly_six(self, properties):
        ends = random_ends()
        stiffness = beam.stiffness(ends, properties, beam.frames(ends))
        for k, pair in zip(stiffness, ends, strict=True):
            modes = rigid_motions(pair)
            assert np.abs(k @ modes).max() < 1e-12 * np.abs(k).max() * np.abs(modes).max()
            values = np.linalg.eigvalsh(k)
            assert np.all(np.abs(values[:6]) < 1e-11 * values[-1])
            assert values[6] > 1e-4 * values[-1]

    @THEORIES
    def test_plane_has_exactly_three(self, properties):
        ends = np.array([[[1.0, 0.0, 0.5], [3.0, 0.0, -1.0]]])
        k = beam.stiffness(ends, properties, beam.frames(ends))[0][np.ix_(PLANE, PLANE)]
        modes = rigid_motions(ends[0])[PLANE][:, [0, 2, 4]]
        assert np.abs(k @ modes).max() < 1e-13 * np.abs(k).max()
        values = np.linalg.eigvalsh(k)
        assert np.all(np.abs(values[:3]) < 1e-12 * values[-1])
        assert values[3] > 1e-3 * values[-1]

    @THEORIES
    def test_the_line_follows_them(self, properties):
        ends = random_ends()
        frame, direction = beam.frames(ends), np.array([0.36, -0.48, 0.8])
        polynomials = beam.displacement_polynomials(ends, properties, frame, direction)
        for xi in (0.0, 0.3, 0.77, 1.0):
            weights = polynomials @ xi ** np.arange(4)
            for row, pair in zip(weights, ends, strict=True):
                point = (1.0 - xi) * pair[0] + xi * pair[1]
                expected = np.concatenate([direction, np.cross(point, direction)])  # d·(θ × r) = θ·(r × d)
                np.testing.assert_allclose(row @ rigid_motions(pair), expected, atol=1e-13)


class TestMatrices:
    @THEORIES
    @pytest.mark.parametrize("kind", ["stiffness", "mass"])
    def test_symmetric(self, properties, kind):
        ends = random_ends()
        matrices = getattr(beam, kind)(ends, properties, beam.frames(ends))
        error = np.abs(matrices - matrices.transpose(0, 2, 1)).max(axis=(1, 2))
        assert np.all(error < 1e-14 * np.abs(matrices).max(axis=(1, 2)))

    @THEORIES
    @pytest.mark.parametrize("kind", ["stiffness", "mass"])
    def test_turn_with_the_beam(self, properties, kind):
        ends, up = random_ends(), np.array([0.2, -0.3, 0.9])
        q = random_rotation()
        build = getattr(beam, kind)
        before = build(ends, properties, beam.frames(ends, up))
        after = build(ends @ q.T, properties, beam.frames(ends @ q.T, q @ up))
        turn = np.kron(np.eye(4), q)
        scale = np.abs(before).max()
        np.testing.assert_allclose(after, turn @ before @ turn.T, atol=1e-13 * scale)

    @THEORIES
    def test_mass_and_inertia_of_rigid_motions(self, properties):
        ends = random_ends()
        frame = beam.frames(ends)
        mass = beam.mass(ends, properties, frame)
        points, weights = np.polynomial.legendre.leggauss(4)
        for m, pair, axes in zip(mass, ends, frame, strict=True):
            length = np.linalg.norm(pair[1] - pair[0])
            expected = np.zeros((6, 6))
            expected[:3, :3] = 1700.0 * length * np.eye(3)
            for xi, w in zip(0.5 + 0.5 * points, 0.5 * weights * length, strict=True):
                arm = -skew((1.0 - xi) * pair[0] + xi * pair[1])
                expected[:3, 3:] += w * 1700.0 * arm
                expected[3:, :3] += w * 1700.0 * arm.T
                expected[3:, 3:] += w * 1700.0 * arm.T @ arm
            section = np.diag([210.0 + 130.0, 210.0, 130.0]) * length
            expected[3:, 3:] += axes.T @ section @ axes
            modes = rigid_motions(pair)
            np.testing.assert_allclose(modes.T @ m @ modes, expected, atol=1e-12 * np.abs(expected).max())

    @THEORIES
    def test_mass_by_quadrature(self, properties):
        """∫ m Nᵀ N + ρI Pᵀ P, with N from the running line's polynomials and P from its shear strain."""
        ends = along_x(3.0)
        frame = beam.frames(ends)
        mass = beam.mass(ends, properties, frame)[0]
        points, weights = np.polynomial.legendre.leggauss(6)
        xi, w = 0.5 + 0.5 * points, 0.5 * weights * 3.0
        powers = xi[:, None] ** np.arange(4)
        slopes = np.arange(1, 4) * xi[:, None] ** np.arange(3) / 3.0
        expected = np.zeros((12, 12))
        for axis, bending, shear, rotary in (
            (2, 8.0e8, properties.shear_stiffness_z, 210.0),
            (1, 5.0e8, properties.shear_stiffness_y, 130.0),
        ):
            table = beam.displacement_polynomials(ends, properties, frame, np.eye(3)[axis])[0]
            n = powers @ table.T
            third = 6.0 * table[:, 3] / 3.0**3
            rotation = slopes @ table[:, 1:].T + bending / shear * third  # ψ = w' - V/κGA, V = -EI w'''
            expected += (n * w[:, None]).T @ n * 1700.0 + (rotation * w[:, None]).T @ rotation * rotary
        bending_dofs = [1, 2, 4, 5, 7, 8, 10, 11]
        np.testing.assert_allclose(
            mass[np.ix_(bending_dofs, bending_dofs)],
            expected[np.ix_(bending_dofs, bending_dofs)],
            atol=1e-12 * np.abs(expected).max(),
        )

    def test_axial_and_torsional_parts(self):
        ends = along_x(4.0)
        k = beam.stiffness(ends, THIN, beam.frames(ends))[0]
        m = beam.mass(ends, THIN, beam.frames(ends))[0]
        np.testing.assert_allclose(k[[0, 0, 3, 3], [0, 6, 3, 9]], [7.5e8, -7.5e8, 5.0e7, -5.0e7])
        polar = 340.0 * 4.0
        np.testing.assert_allclose(m[[0, 0, 3, 3], [0, 6, 3, 9]], [6800 / 3, 6800 / 6, polar / 3, polar / 6])

    def test_properties_may_differ_from_beam_to_beam(self):
        ends = np.repeat(along_x(2.0), 3, axis=0)
        several = BeamProperties(bending_stiffness_y=np.array([1e8, 2e8, 4e8]), mass_per_length=50.0)
        k = beam.stiffness(ends, several, beam.frames(ends))
        np.testing.assert_allclose(k[:, 2, 2], 12.0 / 8.0 * np.array([1e8, 2e8, 4e8]))


class TestPolynomials:
    @THEORIES
    def test_interpolate_the_nodes(self, properties):
        ends = random_ends()
        frame, direction = beam.frames(ends), np.array([0.0, 0.6, 0.8])
        table = beam.displacement_polynomials(ends, properties, frame, direction)
        at_first, at_second = np.zeros(12), np.zeros(12)
        at_first[:3], at_second[6:9] = direction, direction
        np.testing.assert_allclose(table[..., 0], np.broadcast_to(at_first, (7, 12)), atol=1e-14)
        np.testing.assert_allclose(table.sum(axis=2), np.broadcast_to(at_second, (7, 12)), atol=1e-14)

    def test_slopes_at_the_ends_are_the_rotations(self):
        """Euler-Bernoulli: dw/dx = -ry and dv/dx = +rz, by finite differences of the polynomials."""
        ends, h = along_x(2.5), 1e-6
        for axis, rotation, sign in ((2, 4, -1.0), (1, 5, 1.0)):
            table = beam.displacement_polynomials(ends, THIN, beam.frames(ends), np.eye(3)[axis])[0]
            for xi, dof in ((0.0, rotation), (1.0, rotation + 6)):
                right, left = (table @ (xi + d) ** np.arange(4) for d in (h, -h))
                expected = np.zeros(12)
                expected[dof] = sign
                np.testing.assert_allclose((right - left) / (2.0 * h * 2.5), expected, atol=1e-9)

    def test_shear_strain_is_shear_force_over_stiffness(self):
        """Timoshenko: w' - ψ is constant and equals V / κGA of the end forces, in both planes."""
        ends = along_x(2.5)
        frame = beam.frames(ends)
        u = np.random.default_rng(2).normal(size=(1, 12))
        forces = beam.end_forces(ends, THICK, frame, u)[0]
        length = np.array([2.5])
        for axis, dofs, sign, bending, shear in (
            (2, [2, 4, 8, 10], [1, -1, 1, -1], 8.0e8, 9.0e8),
            (1, [1, 5, 7, 11], [1, 1, 1, 1], 5.0e8, 4.0e8),
        ):
            phi = beam.shear_parameter(np.array([bending]), np.array([shear]), length)
            local = u[0, dofs] * sign
            w, psi = (
                local @ beam.deflection_polynomials(phi, length)[0],
                local @ beam.rotation_polynomials(phi, length)[0],
            )
            strain = np.array([w[1], 2.0 * w[2], 3.0 * w[3]]) / 2.5 - psi[:3]
            np.testing.assert_allclose(strain[1:], 0.0, atol=1e-14)
            assert psi[3] == 0.0
            # The force on the second node along +z is the shear force of a positive strain.
            assert strain[0] == pytest.approx(forces[axis + 6] / shear, rel=1e-12)


class TestDeflections:
    @pytest.mark.parametrize("n", [1, 3])
    @THEORIES
    def test_cantilever_under_a_tip_force(self, properties, n):
        length, force = 6.0, -2.0e4
        k = chain(length, n, properties, "stiffness")[3:, 3:]
        load = np.zeros(len(k))
        load[-2] = force
        u = np.linalg.solve(k, load)
        shear = properties.shear_stiffness_z
        assert u[-2] == pytest.approx(force * length**3 / (3 * 8.0e8) + force * length / shear, rel=1e-11)
        assert u[-1] == pytest.approx(-force * length**2 / (2 * 8.0e8), rel=1e-11)  # ry = -dψ

    @THEORIES
    def test_cantilever_sideways(self, properties):
        length, force = 6.0, 1.5e4
        ends = along_x(length)
        k = beam.stiffness(ends, properties, beam.frames(ends))[0][6:, 6:]
        u = np.linalg.solve(k, [0.0, force, 0.0, 0.0, 0.0, 0.0])
        shear = properties.shear_stiffness_y
        assert u[1] == pytest.approx(force * length**3 / (3 * 5.0e8) + force * length / shear, rel=1e-12)
        assert u[5] == pytest.approx(force * length**2 / (2 * 5.0e8), rel=1e-12)

    @THEORIES
    def test_simply_supported_under_a_force_at_midspan(self, properties):
        length, force = 8.0, -5.0e4
        k = chain(length, 2, properties, "stiffness")
        free = [2, 3, 4, 5, 6, 8]
        load = np.zeros(9)
        load[4] = force
        u = np.zeros(9)
        u[free] = np.linalg.solve(k[np.ix_(free, free)], load[free])
        shear = properties.shear_stiffness_z
        assert u[4] == pytest.approx(
            force * length**3 / (48 * 8.0e8) + force * length / (4 * shear), rel=1e-12
        )

    def test_end_forces_of_a_cantilever(self):
        length = 6.0
        ends = along_x(length)
        u = np.zeros((1, 12))
        u[0, 6:] = np.linalg.solve(
            beam.stiffness(ends, THICK, beam.frames(ends))[0][6:, 6:], [3e3, 0.0, -2e4, 500.0, 0.0, 0.0]
        )
        forces = beam.end_forces(ends, THICK, beam.frames(ends), u)[0]
        # Moment of the tip force -2e4 N about the root: r × F = (6, 0, 0) × (0, 0, -2e4) = (0, 1.2e5, 0).
        expected = [-3e3, 0.0, 2e4, -500.0, -1.2e5, 0.0, 3e3, 0.0, -2e4, 500.0, 0.0, 0.0]
        np.testing.assert_allclose(forces, expected, atol=1e-7)

    def test_end_forces_are_those_of_the_turned_beam(self):
        ends = random_ends()
        frame = beam.frames(ends)
        u = np.random.default_rng(8).normal(size=(7, 12))
        expected = np.einsum("eij,ej->ei", beam.stiffness(ends, THICK, frame), u)
        turned = np.einsum("eij,eaj->eai", frame, expected.reshape(-1, 4, 3)).reshape(-1, 12)
        forces = beam.end_forces(ends, THICK, frame, u)
        np.testing.assert_allclose(forces, turned, atol=1e-12 * np.abs(turned).max())

    @pytest.mark.parametrize("n", [2, 4, 8])
    def test_uniform_load_inside_an_element_converges_with_order_four(self, n):
        """Nodes are exact; between them what is missing is q h⁴ / 384 EI, the clamped element's own sag."""
        length, load, bending = 8.0, -1.0e3, 8.0e8
        k = chain(length, n, THIN, "stiffness")
        ends = along_x(length, n)
        table = beam.displacement_polynomials(ends, THIN, beam.frames(ends), np.array([0.0, 0.0, 1.0]))[
            :, PLANE
        ]
        h = length / n
        consistent = load * h * (table / np.arange(1, 5)).sum(axis=2)
        total = np.zeros(len(k))
        for e in range(n):
            total[3 * e : 3 * e + 6] += consistent[e]
        free = np.setdiff1d(np.arange(len(k)), [0, 1, len(k) - 2])
        u = np.zeros(len(k))
        u[free] = np.linalg.solve(k[np.ix_(free, free)], total[free])
        x = np.arange(n) * h + 0.5 * h
        exact = load * x * (length**3 - 2.0 * length * x**2 + x**3) / (24.0 * bending)
        middle = [u[3 * e : 3 * e + 6] @ (table[e] @ 0.5 ** np.arange(4)) for e in range(n)]
        np.testing.assert_allclose(exact - middle, load * h**4 / (384.0 * bending), rtol=1e-6)


class TestFrequencies:
    @staticmethod
    def computed(length, n, properties, fixed, count):
        k, m = (chain(length, n, properties, kind) for kind in ("stiffness", "mass"))
        z = np.setdiff1d(np.arange(len(k)), np.arange(0, len(k), 3))  # bending only
        free = np.setdiff1d(z, fixed)
        squares = eigh(k[np.ix_(free, free)], m[np.ix_(free, free)], eigvals_only=True)
        return np.sqrt(squares[:count])

    def test_euler_bernoulli(self):
        """The error is (β h)⁴ / 1440, the leading term of the element's dispersion."""
        properties = BeamProperties(bending_stiffness_y=8.323e9, mass_per_length=2303.0)
        n, exact = 24, euler_bernoulli_frequencies(25.0, 8.323e9, 2303.0, 3)
        error = self.computed(25.0, n, properties, [1, 3 * n + 1], 3) / exact - 1.0
        np.testing.assert_allclose(error, (np.pi * np.arange(1, 4) / n) ** 4 / 1440.0, rtol=0.05)
        clamped = euler_bernoulli_frequencies(25.0, 8.323e9, 2303.0, 3, "fixed-free")
        np.testing.assert_allclose(self.computed(25.0, n, properties, [1, 2], 3), clamped, rtol=1e-5)

    def test_timoshenko(self):
        """A deep beam: depth 2.5 m over 10 m, where thin-beam theory is 8 % off for the first mode."""
        area, moment, e = 1.5 * 2.5, 1.5 * 2.5**3 / 12, 30e9
        shear, mass = 5 / 6 * area * e / 2.4, 2500.0 * area
        properties = BeamProperties(
            bending_stiffness_y=e * moment,
            shear_stiffness_z=shear,
            mass_per_length=mass,
            rotary_inertia_y=2500.0 * moment,
        )
        n, exact = 40, timoshenko_frequencies(10.0, e * moment, shear, mass, 2500.0 * moment, 3)
        np.testing.assert_allclose(self.computed(10.0, n, properties, [1, 3 * n + 1], 3), exact, rtol=1.5e-3)
        thin = euler_bernoulli_frequencies(10.0, e * moment, mass, 1)[0]
        assert thin / exact[0] > 1.05

    @pytest.mark.parametrize(("theory", "order"), [("euler-bernoulli", 4.0), ("timoshenko", 2.0)])
    def test_converge(self, theory, order):
        """Order four; two with shear deformation, whose strain is constant in an element while inertia bends it."""
        bending, mass = 8.323e9, 2303.0
        if theory == "timoshenko":
            properties = BeamProperties(
                bending_stiffness_y=bending,
                shear_stiffness_z=9e8,
                mass_per_length=mass,
                rotary_inertia_y=900.0,
            )
            exact = timoshenko_frequencies(25.0, bending, 9e8, mass, 900.0, 2)[1]
        else:
            properties = BeamProperties(bending_stiffness_y=bending, mass_per_length=mass)
            exact = euler_bernoulli_frequencies(25.0, bending, mass, 2)[1]
        errors = [self.computed(25.0, n, properties, [1, 3 * n + 1], 2)[1] / exact - 1.0 for n in (8, 16, 32)]
        assert all(error > 0.0 for error in errors)  # a conforming element is too stiff
        orders = np.log2(np.array(errors[:-1]) / errors[1:])
        np.testing.assert_allclose(orders, order, atol=0.1)
