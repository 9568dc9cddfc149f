"""Running lines on beams: weights, derivatives, footprints."""

import itertools

import numpy as np
import pytest
import scipy.sparse as sp

from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.model.compile import compile_model
from axlespan.model.model import Model
from axlespan.running.line import path_on_beams
from axlespan.running.path import PolynomialPath
from axlespan.running.structure import Structure

THICK = BeamProperties(
    axial_stiffness=2e9,
    bending_stiffness_y=8e8,
    bending_stiffness_z=3e8,
    torsional_stiffness=1e8,
    shear_stiffness_y=3e8,
    shear_stiffness_z=5e8,
    mass_per_length=900.0,
)
THIN = BeamProperties(bending_stiffness_y=8e8, mass_per_length=900.0)
X = np.array([0.0, 1.5, 2.0, 4.5, 7.0])  # nodes of the plane line


def plane_line(properties=THIN, start=0.0):
    model = Model().with_nodes(np.column_stack([X, np.zeros(5)]))
    # The second and the last beam run against the line.
    model = model.with_beams([[0, 1], [2, 1], [2, 3], [4, 3]], properties)
    compiled = compile_model(model)
    return compiled.system, path_on_beams(model, compiled.table, range(5), start=start)


def space_line():
    """A skew polyline in space, climbing."""
    points = np.array([[0, 0, 0], [3, 1, 0.2], [5, 2.5, 0.2], [7, 2.5, -0.4], [8.5, 1.5, 0.0]], float)
    model = Model(plane=False).with_nodes(points).with_beams([[0, 1], [2, 1], [2, 3], [3, 4]], THICK)
    compiled = compile_model(model)
    return points, compiled.system, path_on_beams(model, compiled.table, range(5))


def dense(path, positions, n, derivative=0):
    return path.rows(np.asarray(positions, float), n, derivative).toarray()


def quadrature(path, s, n, kernel, half):
    """∫ kernel(t - s) w(t) dt over |t - s| < half, piece by piece, 12 Gauss points each."""
    x, w = np.polynomial.legendre.leggauss(12)
    cuts = np.unique(np.clip(np.concatenate([path.breaks, [s - half, s, s + half]]), s - half, s + half))
    total = np.zeros(n)
    for a, b in itertools.pairwise(cuts):
        t = 0.5 * (a + b) + 0.5 * (b - a) * x
        total += (0.5 * (b - a) * w * kernel(t - s)) @ dense(path, t, n)
    return total


class TestWeights:
    def test_at_nodes_only_the_node_counts(self):
        system, path = plane_line(start=10.0)
        expected = np.zeros((5, 10))
        for i in range(5):
            expected[i, system.dof(f"n{i + 1}.z")] = 1.0
        np.testing.assert_allclose(dense(path, 10.0 + X, 10), expected, atol=1e-14)

    def test_exactly_at_both_ends(self):
        _, path = plane_line()
        ends = np.array([path.start, path.stop])
        assert path.carries(ends).all()
        beyond = np.array([np.nextafter(path.start, -1.0), np.nextafter(path.stop, 9.0)])
        assert not path.carries(beyond).any()
        assert np.all(dense(path, beyond, 10) == 0.0)
        assert np.abs(dense(path, ends, 10)).sum() == pytest.approx(2.0, abs=1e-12)

    def test_a_break_belongs_to_the_segment_that_begins_there(self):
        _, path = plane_line()
        segment, xi = path.locate(X)
        np.testing.assert_array_equal(segment, [0, 1, 2, 3, 3])
        np.testing.assert_array_equal(xi, [0.0, 0.0, 0.0, 0.0, 1.0])

    @pytest.mark.parametrize("properties", [THIN, THICK])
    def test_rigid_motions_in_the_plane(self, properties):
        """Lift 1 and pitch 1: z = 1 - x under every point, whichever way an element runs."""
        system, path = plane_line(properties)
        rigid = np.zeros((2, system.size))
        for i, x in enumerate(X):
            rigid[0, system.dof(f"n{i + 1}.z")] = 1.0
            rigid[1, system.dof(f"n{i + 1}.z")], rigid[1, system.dof(f"n{i + 1}.ry")] = -x, 1.0
        s = np.linspace(0.0, 7.0, 43)
        weights = dense(path, s, system.size)
        np.testing.assert_allclose(weights @ rigid[0], 1.0, rtol=1e-13)
        np.testing.assert_allclose(weights @ rigid[1], -s, atol=1e-13)

    def test_rigid_motions_in_space(self):
        points, system, path = space_line()
        rng = np.random.default_rng(0)
        shift, turn = rng.normal(size=3), rng.normal(size=3)
        u = np.zeros(system.size)
        for i, p in enumerate(points):
            for j, c in enumerate("xyz"):
                u[system.dof(f"n{i + 1}.{c}")] = (shift + np.cross(turn, p))[j]
                u[system.dof(f"n{i + 1}.r{c}")] = turn[j]
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        np.testing.assert_allclose(path.breaks, np.concatenate([[0.0], np.cumsum(steps)]))
        s = np.linspace(0.0, path.stop, 31)
        place = np.column_stack([np.interp(s, path.breaks, points[:, i]) for i in range(3)])
        expected = shift[2] + np.cross(turn, place)[:, 2]
        np.testing.assert_allclose(dense(path, s, system.size) @ u, expected, atol=1e-13)

    def test_a_cubic_is_reproduced_by_thin_beams(self):
        """Nodal values and slopes of a cubic give the cubic: Hermite's polynomials, reversed or not."""
        system, path = plane_line()
        w, slope = np.polynomial.Polynomial([0.3, -1.0, 0.5, -0.05]), None
        slope = w.deriv()
        u = np.zeros(system.size)
        for i, x in enumerate(X):
            u[system.dof(f"n{i + 1}.z")], u[system.dof(f"n{i + 1}.ry")] = w(x), -slope(x)
        s = np.linspace(0.0, 7.0, 29)
        for derivative in range(4):
            expected = w.deriv(derivative)(s) if derivative else w(s)
            np.testing.assert_allclose(dense(path, s, 10, derivative) @ u, expected, atol=1e-11)

    @pytest.mark.parametrize("derivative", [1, 2, 3])
    def test_derivatives_by_finite_differences(self, derivative):
        _, system, path = space_line()
        s, h = np.array([0.4, 2.0, 3.9, 5.8, 7.7, 9.0]), 1e-5
        difference = dense(path, s + h, system.size, derivative - 1) - dense(
            path, s - h, system.size, derivative - 1
        )
        np.testing.assert_allclose(dense(path, s, system.size, derivative), difference / (2 * h), atol=1e-8)

    def test_arrays_of_any_shape(self):
        _, path = plane_line()
        s = np.array([[0.2, 3.0, 8.0], [-1.0, 7.0, 4.5]])
        dofs, weights = path.weights(s)
        assert dofs.shape == weights.shape == (2, 3, 4)
        flat = dense(path, s.ravel(), 10)
        rebuilt = np.zeros((6, 10))
        np.add.at(rebuilt, (np.arange(6)[:, None], dofs.reshape(6, 4)), weights.reshape(6, 4))
        np.testing.assert_array_equal(rebuilt, flat)
        assert np.all(weights[[0, 1], [2, 0]] == 0.0)

    def test_parts_with_different_components(self):
        """A beam without and one with axial stiffness in one line: 4 and 6 d.o.f. per segment."""
        model = Model().with_nodes([[0, 0], [2, 0], [5, 0]])
        model = model.with_beams([[0, 1]], THIN).with_beams([[1, 2]], THICK)
        compiled = compile_model(model)
        path = path_on_beams(model, compiled.table, range(3))
        z = np.array([name.endswith(".z") for name in compiled.system.dof_names], float)
        np.testing.assert_allclose(
            dense(path, np.linspace(0, 5, 11), compiled.system.size) @ z, 1.0, rtol=1e-13
        )
        assert len(path.path_dofs) == 6  # z and ry of three nodes; x takes no part


class TestChanges:
    def test_transformed_follows_ties(self):
        system, path = plane_line()
        rng = np.random.default_rng(6)
        elimination = sp.csr_array(rng.normal(size=(10, 4)) * (rng.uniform(size=(10, 4)) < 0.5))
        s = np.linspace(-0.5, 7.5, 27)
        new = path.transformed(elimination)
        np.testing.assert_allclose(dense(new, s, 4), dense(path, s, 10) @ elimination.toarray(), atol=1e-13)
        np.testing.assert_array_equal(new.breaks, path.breaks)
        assert system.size == 10

    def test_renumbered_drops_what_is_negative(self):
        _, path = plane_line()
        number = np.array([3, -1, 0, 1, -1, 2, 6, 5, -1, 4])
        s = np.linspace(0.0, 7.0, 15)
        expected = np.zeros((15, 7))
        before = dense(path, s, 10)
        for old, new in enumerate(number):
            if new >= 0:
                expected[:, new] = before[:, old]
        new_path = path.renumbered(number)
        np.testing.assert_array_equal(dense(new_path, s, 7), expected)
        np.testing.assert_array_equal(new_path.path_dofs, np.arange(7))

    def test_a_line_with_nothing_left(self):
        _, path = plane_line()
        nothing = path.renumbered(np.full(10, -1))
        assert len(nothing.path_dofs) == 0
        assert np.all(dense(nothing, X, 10) == 0.0)
        assert np.all(dense(nothing.spread(0.6), X, 10) == 0.0)


class TestFootprint:
    # Positions before, at and around both ends, at breaks, and in the middle.
    S = (-0.55, -0.3, -0.11, 0.0, 0.2, 1.5, 1.81, 2.0, 3.3, 4.5, 6.7, 7.0, 7.15, 7.5)

    @pytest.mark.parametrize("length", [0.4, 1.3, 9.0])
    def test_averaged_is_the_mean_over_the_length(self, length):
        """Also for a length beyond some elements, and beyond the whole line."""
        _, path = plane_line()
        mean = path.averaged(length)
        for s in self.S:
            expected = quadrature(path, s, 10, lambda t: np.full_like(t, 1.0 / length), 0.5 * length)
            np.testing.assert_allclose(dense(mean, [s], 10)[0], expected, atol=2e-13)
        assert mean.start == pytest.approx(-0.5 * length)
        assert mean.stop == pytest.approx(7.0 + 0.5 * length)

    @pytest.mark.parametrize("length", [0.6, 1.9])
    def test_spread_is_a_triangle(self, length):
        _, path = plane_line(THICK)
        system, path = plane_line(THICK)
        wide, half = path.spread(length), 0.5 * length
        for s in self.S:
            expected = quadrature(path, s, system.size, lambda t: (1.0 - np.abs(t) / half) / half, half)
            np.testing.assert_allclose(dense(wide, [s], system.size)[0], expected, atol=2e-13)

    def test_spread_in_space(self):
        _, system, path = space_line()
        wide = path.spread(0.8)
        for s in (-0.2, 1.0, path.breaks[1], path.breaks[2] + 0.1, path.stop, path.stop + 0.3):
            expected = quadrature(path, s, system.size, lambda t: (1.0 - np.abs(t) / 0.4) / 0.4, 0.4)
            np.testing.assert_allclose(dense(wide, [s], system.size)[0], expected, atol=2e-13)

    def test_derivatives_of_the_spread_line_have_no_jumps(self):
        """A path with kinks in slope becomes one with a continuous curvature, also over supported ends."""
        _, path = plane_line()
        path = path.renumbered(np.array([-1, 1, 2, 3, 4, 5, 6, 7, -1, 9]))  # the end nodes don't move
        wide, eps = path.spread(0.6), 1e-9
        for derivative, tolerance in ((0, 1e-7), (1, 1e-6), (2, 1e-5)):
            left, right = (dense(wide, wide.breaks[1:-1] + d, 10, derivative) for d in (-eps, eps))
            np.testing.assert_allclose(left, right, atol=tolerance)
        assert np.all(dense(wide, [wide.start, wide.stop], 10, 1) == pytest.approx(0.0, abs=1e-12))

    @pytest.mark.parametrize("derivative", [1, 2])
    def test_derivatives_by_finite_differences(self, derivative):
        _, path = plane_line()
        wide, h = path.spread(0.6), 1e-5
        s = np.array([-0.21, 0.123, 1.44, 2.05, 4.4, 6.9, 7.1])
        difference = dense(wide, s + h, 10, derivative - 1) - dense(wide, s - h, 10, derivative - 1)
        np.testing.assert_allclose(dense(wide, s, 10, derivative), difference / (2 * h), atol=1e-7)

    def test_the_whole_load_is_on_the_line_once_the_footprint_is(self):
        _, path = plane_line()
        z = np.zeros(10)
        z[0::2] = 1.0
        share = dense(path.spread(0.6), np.linspace(-0.3, 7.3, 77), 10) @ z
        inside = (np.linspace(-0.3, 7.3, 77) >= 0.3) & (np.linspace(-0.3, 7.3, 77) <= 6.7)
        np.testing.assert_allclose(share[inside], 1.0, rtol=1e-12)
        assert np.all(np.diff(share[:4]) > 0.0)
        assert share.min() >= -1e-15


class TestErrors:
    def test_no_beam_joins_two_nodes(self):
        model = Model().with_nodes([[0, 0], [1, 0], [2, 0]], ["a", "b"]).with_beams([[0, 1], [1, 2]], THIN)
        compiled = compile_model(model)
        with pytest.raises(InputError, match=r"running line = 'a to n3': must follow beams"):
            path_on_beams(model, compiled.table, ["a", "n3"])

    def test_one_node_is_no_line(self):
        model = Model().with_nodes([[0, 0], [1, 0]]).with_beams([[0, 1]], THIN)
        with pytest.raises(InputError, match="must have at least two nodes"):
            path_on_beams(model, compile_model(model).table, [0])

    def test_unknown_node(self):
        model = Model().with_nodes([[0, 0], [1, 0]], ["west", "east"]).with_beams([[0, 1]], THIN)
        with pytest.raises(InputError, match="Did you mean 'west'"):
            path_on_beams(model, compile_model(model).table, ["wset", "east"])

    def test_positions_must_increase(self):
        with pytest.raises(InputError, match="must advance"):
            PolynomialPath(np.array([0.0, 1.0, 1.0]), np.zeros((2, 1), int), np.zeros((2, 1, 2)))

    def test_lines_by_name(self):
        system, path = plane_line()
        structure = Structure(system, {"track 1": path, "track 2": path})
        assert structure.line("track 2") is path
        assert structure.line() is path
        assert structure.length == 7.0
        with pytest.raises(InputError, match="Did you mean 'track 1'"):
            structure.line("trak 1")
        with pytest.raises(InputError, match="must have at least one running line"):
            Structure(system, {})


def test_compiled_rows_and_loads_are_those_of_plain_numpy() -> None:
    rng = np.random.default_rng(7)
    breaks = np.concatenate([[0.0], np.cumsum(rng.uniform(0.01, 3.0, 40))])  # far from even segments
    dofs, coefficients = rng.integers(0, 30, (40, 4)), rng.standard_normal((40, 4, 5))
    coefficients[10:15] = 0.0
    path = PolynomialPath(breaks, dofs, coefficients)
    positions = rng.uniform(-5.0, breaks[-1] + 5.0, (300, 6))
    positions[:41, 2], positions[0, 0] = breaks, np.nan  # right over every break, both ends included
    contacts, slots = np.array([0, 2, 5]), np.array([2, 0, 1])
    own, weights = np.zeros((300, 3, 4), dtype=np.int64), np.zeros((300, 3, 4))
    path.fill_rows(positions, contacts, slots, own, weights)
    expected_dofs, expected = path.weights(positions[:, contacts])
    on = path.carries(positions[:, contacts])
    assert 100 < on.sum() < on.size
    np.testing.assert_allclose(weights[:, slots], expected, rtol=1e-14, atol=1e-14)
    np.testing.assert_array_equal(own[:, slots][on], expected_dofs[on])
    forces, loads = rng.standard_normal((300, 6)), np.zeros((300, 30))
    for step, wheel in zip(*np.nonzero(on), strict=True):
        place = expected_dofs[step, wheel]
        np.add.at(loads[step], place, expected[step, wheel] * forces[step, contacts[wheel]])
    np.testing.assert_allclose(path.loads(positions, forces, contacts, 30), loads, rtol=1e-12, atol=1e-12)
    few = path.loads(positions[:5], forces[:5], contacts, 30)  # too few for the compiled loop
    np.testing.assert_allclose(few, loads[:5], rtol=1e-12, atol=1e-12)
