"""Running lines on surfaces: exactness, continuity, errors, and beams made of solids, shells and mixtures."""

import itertools
import time

import numpy as np
import pytest

import axlespan as asp
from axlespan.elements.shells import interpolation
from axlespan.errors import InputError
from axlespan.linalg.eigen import lowest_modes
from axlespan.model.compile import compile_model, dof_table
from axlespan.model.from_mesh import Planes, Shells, Solids
from axlespan.model.materials import BeamSection, Material
from axlespan.model.mesh import Mesh
from axlespan.model.model import Model
from axlespan.running.chain import ordered_along
from axlespan.running.joined import joined
from axlespan.running.line import path_on_beams
from axlespan.running.structure import Structure
from axlespan.running.surface import FIT_ERROR, line_over

CONCRETE = Material(30e9, 0.2, 2500.0)
RNG = np.random.default_rng


def moved(mesh, size=0.15, seed=7):
    """The mesh with nodes moved along x and y, those of the outline only along it."""
    points, (low, high) = mesh.points.copy(), mesh.bounding_box()
    for axis in (0, 1):
        free = (points[:, axis] > low[axis] + 1e-9) & (points[:, axis] < high[axis] - 1e-9)
        points[:, axis] += free * size * RNG(seed + axis).uniform(-1.0, 1.0, len(points))
    return mesh.with_points(points)


def solid_model(kind="hex8", quadratic=False, size=0.0):
    mesh = moved(Mesh.box((6.0, 2.0, 1.0), (6, 3, 2), kind=kind), size)
    mesh = mesh.quadratic() if quadratic else mesh
    return Model(plane=False).with_mesh(mesh, {"volume": Solids(CONCRETE)})


def shell_model(kind="quad4", size=0.0, slope=0.0):
    mesh = moved(Mesh.rectangle((6.0, 2.0), (6, 3), kind=kind), size)
    mesh = mesh.with_points(mesh.points + slope * mesh.points[:, :1] * [0.0, 0.0, 1.0])
    return Model(plane=False).with_mesh(mesh, {"surface": Shells(CONCRETE, 0.2)})


def along(line, path, n=601):
    """Positions on a path and the points of the polyline there."""
    line = np.asarray(line, float)
    lengths = np.linalg.norm(np.diff(line, axis=0), axis=1)
    s = np.linspace(path.start, path.stop, n)
    at = path.start + np.concatenate([[0.0], np.cumsum(lengths)])
    return s, np.column_stack([np.interp(s, at, line[:, i]) for i in range(3)])


def value(path, s, u):
    dofs, weights = path.weights(np.asarray(s, float))
    return (weights * u[dofs]).sum(axis=-1)


def rigid(model, table, shift=(0.3, -0.2, 0.5), turn=(0.4, -0.7, 0.2)):
    """Nodal displacements of a rigid motion, and the motion of points."""

    def motion(points):
        return np.asarray(shift) + np.cross(turn, points)

    u = np.zeros(table.size)
    for c, values in enumerate([*motion(model.points).T, *np.tile(turn, (len(model.points), 1)).T]):
        there = table.number[:, c] >= 0
        u[table.number[there, c]] = values[there]
    return u, motion


def left_and_right(path, u):
    """Values at the inner breaks of the path, from the segment before and the one after."""
    values = np.einsum("ejp,ej->ep", path.coefficients, u[path.dofs])
    return values[:-1].sum(axis=1), values[1:, 0]


LINES = {
    "along the nodes": [[0, 0, 1], [6, 0, 1]],
    "between the nodes": [[0, 0.9, 1], [6, 0.9, 1]],
    "slanting": [[0.2, 0.1, 1], [5.9, 1.8, 1]],
    "backward": [[6, 1.5, 1], [0, 0.4, 1]],
    "broken": [[0, 0.1, 1], [2.2, 1.0, 1], [2.6, 1.9, 1], [5.7, 0.2, 1]],
    "through the nodes": [[0, 0, 1], [2, 4 / 3, 1], [3, 2, 1]],
}
MODELS = {
    "hex8": lambda size: solid_model("hex8", size=size),
    "hex20": lambda size: solid_model("hex8", True, size=size),
    "tet4": lambda size: solid_model("tet4", size=size),
    "tet10": lambda size: solid_model("tet4", True, size=size),
    "wedge6": lambda size: solid_model("wedge6", size=size),
    "shell4": lambda size: shell_model("quad4", size),
    "shell3": lambda size: shell_model("tri3", size),
}


@pytest.mark.parametrize("kind", MODELS)
@pytest.mark.parametrize("size", [0.0, 0.15])
@pytest.mark.parametrize("name", LINES)
def test_rigid_motions_and_continuity(kind, size, name):
    model = MODELS[kind](size)
    table = dof_table(model)
    line = np.array(LINES[name]) - ([0, 0, 1] if kind.startswith("shell") else [0, 0, 0])
    path = line_over(model, table, line, start=10.0)
    assert path.start == 10.0
    assert path.stop == pytest.approx(10.0 + np.linalg.norm(np.diff(line, axis=0), axis=1).sum(), abs=1e-12)
    s, points = along(line, path)
    u, motion = rigid(model, table)
    np.testing.assert_allclose(value(path, s, u), motion(points)[:, 2], rtol=0, atol=1e-11)
    before, after = left_and_right(path, RNG(0).standard_normal(table.size))
    np.testing.assert_allclose(before, after, rtol=0, atol=1e-10)


@pytest.mark.parametrize("kind", ["quad4", "tri3"])
@pytest.mark.parametrize("quadratic", [False, True])
def test_lines_on_plane_elements(kind, quadratic):
    """A quadratic field along a cambered upper edge."""
    mesh = Mesh.rectangle((6.0, 2.0), (6, 3), kind=kind, plane="xz")
    mesh = mesh.quadratic() if quadratic else mesh
    camber = 0.02 * mesh.points[:, 0] * (6.0 - mesh.points[:, 0]) * (mesh.points[:, 2] / 2.0)
    mesh = mesh.with_points(mesh.points + camber[:, None] * [0.0, 0.0, 1.0])
    model = Model().with_mesh(mesh, {"surface": Planes(CONCRETE)})
    table = dof_table(model)
    nodes = np.flatnonzero(mesh.points[:, 2] - camber > 2.0 - 1e-9)
    top = mesh.points[nodes[np.argsort(mesh.points[nodes, 0])]]
    path = line_over(model, table, top[:, [0, 2]])
    assert len(path.breaks) == 7 if not quadratic else 13
    u = np.zeros(table.size)
    u[table.number[:, 2]] = 0.3 + 0.7 * mesh.points[:, 0]
    s, points = along(top, path)
    np.testing.assert_allclose(value(path, s, u), 0.3 + 0.7 * points[:, 0], rtol=0, atol=1e-12)
    if quadratic:
        u[table.number[:, 2]] = mesh.points[:, 0] ** 2
        np.testing.assert_allclose(value(path, s, u), points[:, 0] ** 2, rtol=0, atol=1e-11)
    assert set(path.path_dofs) <= set(table.number[nodes, 2])


def test_weights_are_bilinear_products_on_rectangles():
    """Against the shape functions written out: cells of 1 m x 2/3 m."""
    model = solid_model()
    table = dof_table(model)
    line = np.array([[0.0, 0.3, 1.0], [6.0, 1.7, 1.0]])
    path = line_over(model, table, line)
    s, points = along(line, path, 97)
    top = np.flatnonzero(model.points[:, 2] == 1.0)
    wanted = np.zeros((len(s), table.size))
    for k in top:
        across = np.abs(points[:, :2] - model.points[k, :2]) / [1.0, 2.0 / 3.0]
        wanted[:, table.number[k, 2]] = np.prod(np.maximum(1.0 - across, 0.0), axis=1)
    np.testing.assert_allclose(path.rows(s, table.size).toarray(), wanted, rtol=0, atol=1e-13)
    assert path.coefficients.shape[1:] == (4, 3)  # quadratic along a slanting line
    np.testing.assert_allclose(np.diff(path.breaks)[0], np.linalg.norm([1.0, 1.4 / 6.0]), rtol=1e-12)


def test_distorted_faces_are_interpolated_to_the_error_stated():
    """Against the point itself: ξ by bisection along the line, no Newton, no polynomial."""
    model = solid_model(size=0.2)
    table = dof_table(model)
    line = np.array([[0.0, 0.9, 1.0], [6.0, 1.1, 1.0]])
    path = line_over(model, table, line)
    assert len(path.breaks) > 7  # some faces took more than one polynomial, or the line met more of them
    u = RNG(3).standard_normal(table.size)
    part = model.parts[0]
    for s in np.linspace(0.013, path.stop - 0.013, 40):
        point = line[0] + s / path.stop * (line[1] - line[0])
        found = None
        for element in part.nodes:
            nodes = element[4:]  # the upper face
            x = model.points[nodes]
            if np.all(x[:, 2] == 1.0) and (at := bilinear_inverse(x[:, :2], point[:2])) is not None:
                shape = 0.25 * np.array([(1 + a * at[0]) * (1 + b * at[1]) for a, b in CORNERS])
                found = shape @ u[table.number[nodes, 2]]
        assert value(path, s, u) == pytest.approx(found, abs=10.0 * FIT_ERROR)


CORNERS = ((-1, -1), (1, -1), (1, 1), (-1, 1))


def bilinear_inverse(x, point):
    """ξ of a point in a quadrilateral from the quadratic equation of the bilinear map, None outside."""
    a = x.mean(axis=0) - point
    b, c, d = (0.25 * np.array(sign) @ x for sign in ([-1, 1, 1, -1], [-1, -1, 1, 1], [1, -1, 1, -1]))

    def cross(p, q):
        return p[0] * q[1] - p[1] * q[0]

    # a + b ξ + c η + d ξη = 0: eliminate ξ.
    for eta in np.roots([cross(c, d), cross(a, d) + cross(c, b), cross(a, b)]):
        if abs(eta.imag) < 1e-12:
            eta = float(eta.real)
            along_xi = b + d * eta
            xi = -float((a + c * eta) @ along_xi / (along_xi @ along_xi))
            if max(abs(xi), abs(eta)) <= 1.0 + 1e-12:
                return xi, eta
    return None


def test_shells_move_as_their_elements_do():
    """The weights on a shell are the element's own, with rotations, here at slanting stations."""
    model = shell_model(size=0.1, slope=0.05)
    table = dof_table(model)
    line = np.array([[0.0, 0.2, 0.0], [6.0, 1.9, 0.3]])
    path = line_over(model, table, line)
    u = RNG(5).standard_normal(table.size)
    part, checked = model.parts[0], 0
    for s in np.linspace(0.02, path.stop - 0.02, 25):
        point = line[0] + s / path.stop * (line[1] - line[0])
        for element in part.nodes:
            at = bilinear_inverse(model.points[element][:, :2], point[:2])
            if at is not None:
                rows = interpolation("shell4", model.points[element][None], [at])[0, 0, 2]
                assert value(path, s, u) == pytest.approx(rows @ u[table.number[element].ravel()], abs=1e-7)
                checked += 1
    assert checked >= 25


def test_a_line_along_the_nodes_uses_them_alone():
    for model, z in ((solid_model(), 1.0), (shell_model(), 0.0)):
        table = dof_table(model)
        path = line_over(model, table, [[0.0, 0.0, z], [6.0, 0.0, z]])
        on_line = np.flatnonzero((model.points[:, 1] == 0.0) & (model.points[:, 2] == z))
        used = {int(np.argwhere(table.number == dof)[0][0]) for dof in path.path_dofs}
        assert used == set(on_line.tolist())


def test_the_choice_of_a_face_is_the_same_at_every_run():
    """A line along the common side of faces, and its mirror image, which meets them in another order."""
    model = solid_model(size=0.0)
    table = dof_table(model)
    line = np.array([[0.0, 2.0 / 3.0, 1.0], [6.0, 2.0 / 3.0, 1.0]])
    one, two = (line_over(model, table, line) for _ in range(2))
    assert np.array_equal(one.dofs, two.dofs)
    assert np.array_equal(one.coefficients, two.coefficients)
    back = line_over(model, table, line[::-1])
    s = np.linspace(0.0, 6.0, 31)
    u = RNG(1).standard_normal(table.size)
    np.testing.assert_allclose(value(one, s, u), value(back, 6.0 - s, u), rtol=0, atol=1e-12)


def test_lines_from_sets_of_nodes():
    """The outer edge of a curved deck, its nodes in any order; a straight rail on a box."""
    flat = Mesh.rectangle((6.0, 2.0), (24, 3))
    angle, radius = flat.points[:, 0] / 6.0 * 4.0, 5.0 + flat.points[:, 1]  # 230 degrees
    points = np.column_stack([radius * np.sin(angle), radius * np.cos(angle), 0.0 * angle])
    deck = flat.with_points(points).with_node_set("outer", RNG(0).permutation(flat.node_sets["y_max"]))
    model = Model(plane=False).with_mesh(deck, {"surface": Shells(CONCRETE, 0.2)})
    path = line_over(model, dof_table(model), "outer")
    assert path.stop == pytest.approx(24 * 2.0 * 7.0 * np.sin(0.5 * 4.0 / 24), rel=1e-12)
    assert len(path.breaks) == 25
    model = solid_model()
    path = line_over(model, dof_table(model), "y_max/z_max")
    np.testing.assert_allclose(path.breaks, np.arange(7.0), rtol=0, atol=1e-12)


class TestChains:
    def test_any_order_of_a_helix(self):
        t = np.sort(RNG(2).uniform(0.0, 20.0, 400))
        points = np.column_stack([3.0 * np.cos(t), 3.0 * np.sin(t), 0.4 * t])
        mixed = RNG(3).permutation(400)
        order = ordered_along(points[mixed])
        chain = mixed[order]
        assert chain.tolist() in (list(range(400)), list(range(399, -1, -1)))
        assert points[chain[0], 0] < points[chain[-1], 0]

    def test_what_is_no_line(self):
        x = np.arange(6.0)
        star = np.array([[0, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, 2, 0.0]])
        with pytest.raises(InputError, match=r"it branches at this node"):
            ordered_along(star)
        rails = np.array([[i, y, 0.0] for i in x for y in (0.0, 3.0)])
        with pytest.raises(InputError, match=r"branches|turns sharply"):
            ordered_along(rails)
        far = np.column_stack([np.concatenate([x, x + 1e4]), np.zeros(12), np.zeros(12)])
        far = np.vstack([far + [0, 0, k * 1e-3] for k in range(4)])[:48]
        with pytest.raises(InputError, match="must form one line"):
            ordered_along(far)
        with pytest.raises(InputError, match="at least two nodes"):
            ordered_along(star[:1])


class TestChoices:
    def test_layers_by_height_and_by_name(self):
        """A box girder of shells: two slabs above each other."""
        upper, lower = (Mesh.rectangle((6.0, 2.0), (6, 2), origin=(0.0, 0.0, z)) for z in (2.0, 0.0))
        model = Model(plane=False).with_mesh(upper, {"surface": Shells(CONCRETE, 0.2)})
        second = Mesh(lower.points, lower.blocks, {}, {"lower": lower.element_sets["surface"]})
        model = model.with_mesh(second, {"lower": Shells(CONCRETE, 0.2)})
        table = dof_table(model)
        for z, faces in ((2.0, "top"), (0.0, "top"), (0.0, "lower"), (2.0, "surface"), (2.0, None)):
            path = line_over(model, table, [[0.0, 1.3, z], [6.0, 1.3, z]], faces=faces)
            nodes = {int(np.argwhere(table.number == dof)[0][0]) for dof in path.path_dofs}
            assert set(model.points[list(nodes), 2]) == {z}
        with pytest.raises(
            InputError, match=r"is not on the faces chosen from 0 to 6 m.* is 2 m along the contact"
        ):
            line_over(model, table, [[0.0, 1.3, 2.0], [6.0, 1.3, 2.0]], faces="lower")
        with pytest.raises(
            InputError, match=r"'lover': is not a known part or set of nodes. Did you mean 'lower'"
        ):
            line_over(model, table, [[0.0, 1.3, 2.0], [6.0, 1.3, 2.0]], faces="lover")

    def test_faces_of_a_solid(self):
        model = solid_model()
        table = dof_table(model)
        below = [[0.0, 1.0, 0.0], [6.0, 1.0, 0.0]]
        with pytest.raises(InputError, match="1 m along the contact force away"):
            line_over(model, table, below)
        for faces in (None, "volume", "z_min"):
            path = line_over(model, table, below, faces=faces)
            u, motion = rigid(model, table)
            s, points = along(below, path)
            np.testing.assert_allclose(value(path, s, u), motion(points)[:, 2], rtol=0, atol=1e-12)
        with pytest.raises(InputError, match=r"'y_min': has no faces of solids or shells"):
            line_over(model, table, below, faces="y_min")

    def test_two_parts_that_touch_have_no_faces_between(self):
        one = Mesh.box((2.0, 1.0, 1.0), (2, 1, 1))
        both = Mesh.box((2.0, 1.0, 2.0), (2, 1, 2))
        sets = {"lower": ((0, np.array([0, 1])),), "upper": ((0, np.array([2, 3])),)}
        mesh = Mesh(both.points, both.blocks, {}, sets)
        model = Model(plane=False).with_mesh(mesh, {"lower": Solids(CONCRETE), "upper": Solids(CONCRETE)})
        with pytest.raises(InputError, match="1 m along the contact force"):
            line_over(model, dof_table(model), [[0.0, 0.5, 1.0], [2.0, 0.5, 1.0]], faces="lower")
        alone = Model(plane=False).with_mesh(one, {"volume": Solids(CONCRETE)})
        assert line_over(alone, dof_table(alone), [[0.0, 0.5, 1.0], [2.0, 0.5, 1.0]]).stop == 2.0

    def test_other_directions(self):
        """A force across the line: the wall of a tunnel, or a rail pushed sideways."""
        model = solid_model(size=0.1)
        table = dof_table(model)
        line = [[0.0, 2.0, 0.3], [6.0, 2.0, 0.8]]
        path = line_over(model, table, line, direction=(0.0, 2.0, 0.0))
        u, motion = rigid(model, table)
        s, points = along(line, path)
        np.testing.assert_allclose(value(path, s, u), motion(points)[:, 1], rtol=0, atol=1e-12)

    def test_two_rails_on_a_deck(self):
        """Equal and opposite loads on the rails of a deck turn it, equal ones bend it."""
        mesh = Mesh.rectangle((12.0, 4.0), (12, 4), origin=(0.0, -2.0, 0.0))
        model = Model(plane=False).with_mesh(mesh, {"surface": Shells(CONCRETE, 0.4)})
        for end in ("x_min", "x_max"):
            model = model.with_supports(end, ("x", "y", "z") if end == "x_min" else ("y", "z"))
        compiled = compile_model(model)
        rails = {
            name: line_over(model, compiled.table, [[0.0, y, 0.0], [12.0, y, 0.0]])
            for name, y in (("left", 0.7), ("right", -0.7))
        }
        lines = {name: path.transformed(compiled.system.elimination) for name, path in rails.items()}
        structure = Structure(system=compiled.system, lines=lines)
        assert structure.line("right").stop == 12.0
        blocks, free = compiled.system.partition, compiled.system.free
        left, right = (lines[name].rows([6.0], compiled.system.size).toarray()[0][free] for name in rails)
        solve = np.linalg.inv(blocks.K_FF.toarray())
        near, cross = left @ solve @ left, left @ solve @ right
        assert near == pytest.approx(right @ solve @ right, rel=1e-8)
        strip = 12.0**3 / (48.0 * 30e9 * 4.0 * 0.4**3 / 12.0)
        assert near + cross == pytest.approx(2.0 * strip, rel=0.05)
        # A pair of forces 1.4 m apart twists the strip: T L/4 GJ at the middle, J = b t³/3 (1 - 0.63 t/b).
        twist = 1.4 * 12.0 / (4.0 * 12.5e9 * 4.0 * 0.4**3 / 3.0 * (1.0 - 0.63 * 0.1))
        assert near - cross == pytest.approx(0.7 * twist, rel=0.1)


class TestErrors:
    MODEL = shell_model()
    TABLE = dof_table(MODEL)

    def refused(self, points, words, **options):
        with pytest.raises(InputError, match=words):
            line_over(self.MODEL, self.TABLE, points, **options)

    def test_leaving_the_surface(self):
        self.refused(
            [[0, 1, 0], [8, 1, 0]],
            r"running line = \(7.0, 1.0, 0.0\): is not on the faces chosen from 106 to 108 m; in the middle the nearest, "
            r"element 12 of 'surface', is 1 m sideways away. Move its points",
            start=100.0,
        )
        self.refused(
            [[0, 1, 0], [6, 1, 0.5]], r"from 1.00347 to 6.0208 m; .* is 0.292 m along the contact force away"
        )
        self.refused([[0, 9, 0], [6, 9, 0]], "is 7 m sideways")

    def test_tolerance(self):
        line = [[0.0, 1.0, 0.05], [6.0, 1.0, 0.05]]
        assert line_over(self.MODEL, self.TABLE, line).stop == 6.0
        self.refused(line, "0.05 m along the contact force", tolerance=0.01)
        assert line_over(self.MODEL, self.TABLE, [[-0.02, 1, 0], [6.02, 1, 0]]).stop == pytest.approx(6.04)
        self.refused(
            [[-0.02, 1, 0], [6.02, 1, 0]], "is 0.02 m off element 7 of 'surface' at 0 m", tolerance=0.015
        )
        bow = np.column_stack([np.linspace(0, 6, 7), np.ones(7), np.zeros(7)])
        bow[3, 2] = 0.06
        self.refused(
            bow, r"= \(2.85355, 1.0, 0.0512132\): is 0.0512 m off element 9 of 'surface'", tolerance=0.05
        )

    def test_polylines(self):
        self.refused(
            [[0, 1, 0], [2, 1, 0], [2, 1, 0], [6, 1, 0]], r"two equal points, 2 and 3, at position 2 m"
        )
        self.refused(
            [[0, 1, 0], [2, 1, 0], [2, 1, 1], [6, 1, 0]],
            r"must not run along the contact force, as from point 2",
        )
        self.refused([[0, 1, 0]], r"at least two points")
        self.refused([[0, 1, 0], [np.nan, 1, 0]], r"point 2 = \[nan, 1.0, 0.0\]: must be finite")
        self.refused("rails", r"'rails': is not a known node or set of nodes")

    @pytest.mark.parametrize(("gap", "passes"), [(0.02, True), (0.2, False)])
    def test_joints(self, gap, passes):
        """The wheels roll over a gap within the tolerance; the halves stay apart."""
        one, two = (Mesh.rectangle((3.0, 2.0), (3, 2), origin=(x, 0.0, 0.0)) for x in (0.0, 3.0 + gap))
        model = Model(plane=False).with_mesh(one.merged(two), {"surface": Shells(CONCRETE, 0.2)})
        line = [[0.0, 1.0, 0.0], [6.0, 1.0, 0.0]]
        if not passes:
            with pytest.raises(
                InputError, match=r"is not on the faces chosen from 3 to 3.2 m.*is 0.1 m sideways"
            ):
                line_over(model, dof_table(model), line)
            return
        path = line_over(model, dof_table(model), line)
        assert 3.02 in np.round(path.breaks, 9)
        u = np.zeros(dof_table(model).size)
        u[dof_table(model).number[12:, 2]] = 1.0  # the second half is lifted
        np.testing.assert_allclose(value(path, [2.9, 3.01, 3.03, 5.0], u), [0.0, 0.0, 1.0, 1.0], atol=1e-12)

    def test_models_without_faces(self):
        beams = Model().with_nodes([[0, 0], [1, 0]]).with_beams([[0, 1]], BEAM)
        with pytest.raises(InputError, match="has no faces of solids or shells"):
            line_over(beams, dof_table(beams), [[0, 0], [1, 0]])
        with pytest.raises(InputError, match=r"direction = .*: must lie in the plane of the model"):
            line_over(beams, dof_table(beams), [[0, 0], [1, 0]], direction=(0, 1, 0))


def test_ten_thousand_faces_and_a_thousand_pieces_are_quick():
    mesh = moved(Mesh.rectangle((100.0, 100.0), (100, 100)), 0.2)
    model = Model(plane=False).with_mesh(mesh, {"surface": Shells(CONCRETE, 0.3)})
    table = dof_table(model)
    x = np.linspace(1.0, 99.0, 1001)
    wave = np.column_stack([x, 50.0 + 40.0 * np.sin(x / 10.0), 0.0 * x])
    begun = time.perf_counter()
    path = line_over(model, table, wave)
    assert time.perf_counter() - begun < 2.0  # 0.22 s on one core
    assert len(path.breaks) > 1300
    u, motion = rigid(model, table)
    s, points = along(wave, path, 5001)
    np.testing.assert_allclose(value(path, s, u), motion(points)[:, 2], rtol=0, atol=1e-10)


# --- the beam of N12, example 3.2, as solids, shells and mixtures -------------------------------------------

LENGTH, WIDTH, HEIGHT = 25.0, 2.2272, 2.5
BEAM_MATERIAL = Material(2.87e9, 0.2, 2303.0 / (WIDTH * HEIGHT))
AREA, INERTIA = WIDTH * HEIGHT, WIDTH * HEIGHT**3 / 12.0
BEAM = BeamSection(
    second_moment=INERTIA,
    area=AREA,
    lateral_second_moment=HEIGHT * WIDTH**3 / 12.0,
    torsion_constant=0.2 * HEIGHT * WIDTH**3,
    shear_area=AREA * 5.0 / 6.0,
    lateral_shear_area=AREA * 5.0 / 6.0,
).properties(BEAM_MATERIAL)


def solid_beam(divisions, length=LENGTH, formulation="incompatible"):
    """Solids, pinned along the line at half the height of both ends (of the first alone, if shorter)."""
    mesh = Mesh.box((length, WIDTH, HEIGHT), divisions)
    x, z = mesh.points[:, 0], mesh.points[:, 2]
    pins = ((x == 0.0) | (x == LENGTH)) & (np.abs(z - 0.5 * HEIGHT) < 1e-9)
    mesh = mesh.with_node_set("pins", np.flatnonzero(pins))
    model = Model(plane=False).with_mesh(mesh, {"volume": Solids(BEAM_MATERIAL, formulation=formulation)})
    return model.with_supports("pins", ("x", "y", "z"))


def over_solids(model, table, end=LENGTH):
    return line_over(model, table, [[0.0, 0.5 * WIDTH, HEIGHT], [end, 0.5 * WIDTH, HEIGHT]], faces="volume")


def case_solids():
    model = solid_beam((25, 2, 4))
    return model, over_solids(model, dof_table(model))


def case_shells():
    """A plate as thick as the beam is high."""
    mesh = Mesh.rectangle((LENGTH, WIDTH), (20, 4))
    model = Model(plane=False).with_mesh(mesh, {"surface": Shells(BEAM_MATERIAL, HEIGHT)})
    model = model.with_supports("x_min", ("x", "y", "z")).with_supports("x_max", ("x", "y", "z"))
    return model, line_over(model, dof_table(model), [[0, 0.5 * WIDTH, 0], [LENGTH, 0.5 * WIDTH, 0]])


def case_stiffened_shells():
    """A deck of 0.5 m above a beam of 2 m, whose axis is 1.25 m below the deck's nodes."""
    deck, rib = 0.5, HEIGHT - 0.5
    mesh = Mesh.rectangle((LENGTH, WIDTH), (20, 4), origin=(0.0, 0.0, HEIGHT - 0.5 * deck))
    model = Model(plane=False).with_mesh(mesh, {"surface": Shells(BEAM_MATERIAL, deck)})
    line = np.flatnonzero(np.abs(mesh.points[:, 1] - 0.5 * WIDTH) < 1e-9)
    section = BeamSection(
        second_moment=WIDTH * rib**3 / 12.0,
        area=WIDTH * rib,
        lateral_second_moment=rib * WIDTH**3 / 12.0,
        torsion_constant=0.2 * WIDTH * rib**3,
        shear_area=WIDTH * rib * 5.0 / 6.0,
        lateral_shear_area=WIDTH * rib * 5.0 / 6.0,
    ).properties(BEAM_MATERIAL)
    pairs = np.column_stack([line[:-1], line[1:]])
    model = model.with_beams(pairs, section, offset=(0.0, 0.0, 0.5 * rib - HEIGHT + 0.5 * deck))
    # Supports at half the height of the whole, below the ends of the deck.
    ends = [[0.0, 0.5 * WIDTH, 0.5 * HEIGHT], [LENGTH, 0.5 * WIDTH, 0.5 * HEIGHT]]
    model = model.with_nodes(ends, ["left", "right"])
    model = model.with_rigid_link("left", [int(line[0])]).with_rigid_link("right", [int(line[-1])])
    model = model.with_support("left", ("x", "y", "z", "rx", "rz"))
    model = model.with_support("right", ("y", "z", "rx", "rz"))
    z = HEIGHT - 0.5 * deck
    return model, line_over(model, dof_table(model), [[0, 0.5 * WIDTH, z], [LENGTH, 0.5 * WIDTH, z]])


def case_solids_and_beams():
    """Half of it solids, half beams; the end face of the solids follows the first node of the beams."""
    half = 0.5 * LENGTH
    model = solid_beam((10, 2, 2), half)
    first, x = len(model.points), np.linspace(half, LENGTH, 11)
    model = model.with_nodes(np.column_stack([x, np.full(11, 0.5 * WIDTH), np.full(11, 0.5 * HEIGHT)]))
    chain = np.arange(first, first + 11)
    model = model.with_beams(np.column_stack([chain[:-1], chain[1:]]), BEAM)
    model = model.with_rigid_link(first, model.nodes_of("x_max").tolist())
    model = model.with_support(first + 10, ("x", "y", "z", "rx"))
    table = dof_table(model)
    return model, joined(
        [over_solids(model, table, half), path_on_beams(model, table, chain.tolist(), start=half)]
    )


def case_solids_and_shells():
    """Half of it solids, half a plate; each line of nodes over the height follows a node of the plate."""
    half = 0.5 * LENGTH
    model = solid_beam((10, 4, 2), half)
    first, face = len(model.points), model.nodes_of("x_max")
    plate = Mesh.rectangle((half, WIDTH), (10, 4), origin=(half, 0.0, 0.5 * HEIGHT))
    plate = Mesh(plate.points, plate.blocks, {"joint": plate.node_sets["x_min"], "end": plate.node_sets["x_max"]},
                 {"plate": plate.element_sets["surface"]})  # fmt: skip
    model = model.with_mesh(plate, {"plate": Shells(BEAM_MATERIAL, HEIGHT)})
    for node in model.nodes_of("joint").tolist():
        above = face[np.abs(model.points[face, 1] - model.points[node, 1]) < 1e-9]
        model = model.with_rigid_link(node, above.tolist())
    model = model.with_supports("end", ("x", "y", "z"))
    table = dof_table(model)
    line = [[half, 0.5 * WIDTH, 0.5 * HEIGHT], [LENGTH, 0.5 * WIDTH, 0.5 * HEIGHT]]
    assert first == len(face) * 11
    return model, joined(
        [over_solids(model, table, half), line_over(model, table, line, faces="plate", start=half)]
    )


CASES = {
    "solids": case_solids,
    "shells": case_shells,
    "shells and eccentric beams": case_stiffened_shells,
    "solids and beams": case_solids_and_beams,
    "solids and shells": case_solids_and_shells,
}


def crossing(structure):
    """The sprung mass of example 3.1 at 100 km/h."""
    train = asp.Train.of(asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6), count=1)
    return asp.simulate(
        asp.Crossing(structure, train, speed=100.0 / 3.6),
        time_step=2e-3,
        steps=450,
        method=asp.Alpha(0.0, beta=0.25, gamma=0.5),
        sensors={"midspan": 12.5},
    )


@pytest.fixture(scope="module")
def beam_theory():
    """Timoshenko's beam."""
    span = asp.bridges.simple_span(
        length=LENGTH,
        youngs_modulus=2.87e9,
        second_moment=INERTIA,
        mass_per_length=2303.0,
        elements=50,
        area=AREA,
        shear_area=AREA * 5.0 / 6.0,
    )
    result = crossing(span)
    return result.sensor_displacement[:, 0], result.vehicle_displacement[:, 0]


@pytest.mark.parametrize("case", CASES)
def test_the_beam_of_example_3_2(case, beam_theory):
    """First frequency within 1 %, peaks within 2 %, histories within 2.5 % of them.

    On solids the vehicle sees also that the corner above the pins gives way, 3 % of the peak when it enters.
    """
    model, path = CASES[case]()
    compiled = compile_model(model)
    system = compiled.system
    assert system.total_mass() == pytest.approx(2303.0 * LENGTH, rel=1e-9)
    blocks = system.partition
    first = lowest_modes(blocks.K_FF, blocks.M_FF, 1).angular_frequencies[0]
    assert first == pytest.approx(29.555, rel=0.01)
    result = crossing(Structure(system=system, lines={"main": path.transformed(system.elimination)}))
    histories = (result.sensor_displacement[:, 0], result.vehicle_displacement[:, 0])
    for own, wanted, share in zip(histories, beam_theory, (0.025, 0.04), strict=True):
        assert np.abs(own - wanted).max() < share * np.abs(wanted).max()
        assert own.min() == pytest.approx(wanted.min(), rel=0.02)
    assert np.all(result.contact_force > 0.0)


@pytest.mark.slow
def test_the_solid_model_of_example_3_2_as_published():
    """36 597 free d.o.f., full integration: ω₁ = 29.59 rad/s."""
    model = solid_beam((100, 10, 10), formulation="full")
    system = compile_model(model).system
    assert len(system.free) == 36_597
    blocks = system.partition
    first = lowest_modes(blocks.K_FF, blocks.M_FF, 1).angular_frequencies[0]
    assert first == pytest.approx(29.59, rel=0.002)


def test_joined_paths_meet():
    model = solid_model()
    table = dof_table(model)
    ends = [[0.0, 1.0, 1.0], [2.5, 1.0, 1.0], [6.0, 1.0, 1.0]]
    whole = line_over(model, table, ends)
    one, two = (line_over(model, table, pair, start=pair[0][0]) for pair in itertools.pairwise(ends))
    s, u = np.linspace(0.0, 6.0, 61), RNG(8).standard_normal(table.size)
    np.testing.assert_allclose(value(joined([one, two]), s, u), value(whole, s, u), rtol=0, atol=1e-12)
    with pytest.raises(
        InputError, match=r"path 2 of the running line = 0.0: must begin where the one before ends, at 2.5"
    ):
        joined([one, line_over(model, table, ends[1:])])
    with pytest.raises(InputError, match="at least one path"):
        joined([])
