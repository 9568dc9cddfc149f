"""The mesh value: structured meshes, sets, copies, connectivity; volumes by a formula of their own."""

import math
import pickle
import time

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.model.mesh import CELL_KINDS, CellBlock, Mesh

SOLIDS = ("hex8", "wedge6", "tet4")

# six (three, one) tetrahedra that fill each solid, corner 0 in all of them
FILLING = {
    "tet4": [(0, 1, 2, 3)],
    "wedge6": [(0, 1, 2, 5), (0, 1, 5, 4), (0, 4, 5, 3)],
    "hex8": [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)],
}


def volumes(mesh):
    """Signed volume of each element from determinants of tetrahedra."""
    block = mesh.blocks[0]
    total = np.zeros(len(block))
    for a, b, c, d in FILLING[block.kind]:
        p = mesh.points[block.nodes[:, [a, b, c, d]]]
        total += np.linalg.det(p[:, 1:] - p[:, :1]) / 6.0
    return total


@pytest.mark.parametrize("kind", SOLIDS)
def test_box_is_filled_once_by_elements_of_positive_volume(kind):
    mesh = Mesh.box((3.0, 2.0, 1.5), (3, 2, 4), origin=(1.0, -2.0, 0.5), kind=kind)
    each = volumes(mesh)
    assert each.min() > 0.0
    np.testing.assert_allclose(each.sum(), 9.0, rtol=1e-13)
    np.testing.assert_array_equal(mesh.bounding_box(), [[1.0, -2.0, 0.5], [4.0, 0.0, 2.0]])
    assert mesh.n_element == 24 * {"hex8": 1, "wedge6": 2, "tet4": 6}[kind]


@pytest.mark.parametrize("kind", ["wedge6", "tet4"])
def test_triangles_of_neighbours_match(kind):
    """Every triangle inside the box belongs to two elements: diagonals of neighbouring cells agree."""
    mesh = Mesh.box((1.0, 1.0, 1.0), (2, 2, 2), kind=kind)
    faces = {"tet4": [(0, 1, 2), (0, 1, 3), (1, 2, 3), (0, 2, 3)], "wedge6": [(0, 1, 2), (3, 4, 5)]}[kind]
    triangles = np.sort(mesh.blocks[0].nodes[:, faces].reshape(-1, 3), axis=1)
    distinct, count = np.unique(triangles, axis=0, return_counts=True)
    coordinates = mesh.points[distinct]
    outside = (np.ptp(coordinates, axis=1) == 0.0) & np.isin(coordinates[:, 0], (0.0, 1.0))
    np.testing.assert_array_equal(count, np.where(outside.any(axis=1), 1, 2))


@pytest.mark.parametrize("kind", ["quad4", "tri3"])
@pytest.mark.parametrize("plane", ["xy", "xz"])
def test_rectangle_has_its_area_and_named_edges(kind, plane):
    mesh = Mesh.rectangle((4.0, 2.0), (4, 3), plane=plane, kind=kind)
    axes = [0, 1] if plane == "xy" else [0, 2]
    corners = mesh.points[mesh.blocks[0].nodes][..., axes]
    following = np.roll(corners, -1, axis=1)
    areas = 0.5 * np.sum(corners[..., 0] * following[..., 1] - corners[..., 1] * following[..., 0], axis=1)
    assert areas.min() > 0.0
    np.testing.assert_allclose(areas.sum(), 8.0, rtol=1e-14)
    second = "y" if plane == "xy" else "z"
    assert mesh.points[mesh.nodes_of_set(f"{second}_max")][:, axes[1]].tolist() == [2.0] * 5
    assert mesh.points[mesh.nodes_of_set(f"x_min/{second}_max")].tolist() == [
        [0.0, 2.0, 0.0] if plane == "xy" else [0.0, 0.0, 2.0]
    ]


def test_box_names_its_faces_edges_and_corners():
    mesh = Mesh.box((3.0, 2.0, 1.0), (3, 2, 1))
    assert len([name for name in mesh.node_sets if name.count("/") == 0]) == 6
    assert len([name for name in mesh.node_sets if name.count("/") == 1]) == 12
    assert len([name for name in mesh.node_sets if name.count("/") == 2]) == 8
    for name, nodes in mesh.node_sets.items():
        inside = np.ones(mesh.n_node, dtype=bool)
        for part in name.split("/"):
            axis, end = "xyz".index(part[0]), part[2:]
            inside &= mesh.points[:, axis] == (0.0 if end == "min" else (3.0, 2.0, 1.0)[axis])
        np.testing.assert_array_equal(nodes, np.flatnonzero(inside))


def test_line_runs_from_start_to_end():
    mesh = Mesh.line((0.0, 1.0, 2.0), (3.0, 1.0, 6.0), 5)
    lengths = np.linalg.norm(np.diff(mesh.points[mesh.blocks[0].nodes], axis=1)[:, 0], axis=1)
    np.testing.assert_allclose(lengths, 1.0, rtol=1e-14)
    assert mesh.points[mesh.nodes_of_set("end")].tolist() == [[3.0, 1.0, 6.0]]
    np.testing.assert_array_equal(mesh.nodes_of_set("line"), np.arange(6))


def test_hundred_thousand_hexahedra_in_well_under_a_second():
    start = time.perf_counter()
    mesh = Mesh.box((100.0, 5.0, 2.0), (1000, 10, 10))
    assert mesh.n_element == 100_000
    assert time.perf_counter() - start < 1.0


@pytest.mark.parametrize(
    ("kind", "edges"),
    [
        ("line2", ["01"]),
        ("tri3", ["01", "12", "20"]),
        ("quad4", ["01", "12", "23", "30"]),
        ("tet4", ["01", "12", "20", "03", "13", "23"]),
        ("hex8", ["01", "12", "23", "30", "45", "56", "67", "74", "04", "15", "26", "37"]),
    ],
)
def test_quadratic_puts_nodes_at_the_middles_of_vtks_edges(kind, edges):
    """Edge lists: VTK file formats, figures of the non-linear cell types."""
    mesh = {
        "line2": lambda: Mesh.line((0.0, 0.0, 0.0), (3.0, 1.0, 0.0), 3),
        "tri3": lambda: Mesh.rectangle((2.0, 1.0), (2, 2), kind="tri3"),
        "quad4": lambda: Mesh.rectangle((2.0, 1.0), (2, 2)),
        "tet4": lambda: Mesh.box((2.0, 1.0, 1.0), (2, 1, 1), kind="tet4"),
        "hex8": lambda: Mesh.box((2.0, 1.0, 1.0), (2, 1, 1)),
    }[kind]()
    quadratic = mesh.quadratic()
    nodes = quadratic.blocks[0].nodes
    corners = mesh.blocks[0].nodes.shape[1]
    assert nodes.shape[1] == corners + len(edges) == CELL_KINDS[quadratic.blocks[0].kind].node_count
    for place, (a, b) in enumerate(edges, start=corners):
        middle = 0.5 * (quadratic.points[nodes[:, int(a)]] + quadratic.points[nodes[:, int(b)]])
        np.testing.assert_allclose(quadratic.points[nodes[:, place]], middle, atol=1e-15)
    assert len(quadratic.duplicate_nodes(1e-9)) == 0
    assert quadratic.unused_nodes().size == 0


def test_quadratic_keeps_faces_whole():
    mesh = Mesh.box((2.0, 1.0, 1.0), (2, 1, 1)).quadratic()
    on_face = np.flatnonzero(mesh.points[:, 2] == 1.0)
    np.testing.assert_array_equal(mesh.nodes_of_set("z_max"), on_face)
    with pytest.raises(InputError, match=r"wedge6.*no quadratic form"):
        Mesh.box((1.0, 1.0, 1.0), (1, 1, 1), kind="wedge6").quadratic()


def test_an_unknown_set_suggests_the_nearest_name():
    mesh = Mesh.box((1.0, 1.0, 1.0), (1, 1, 1)).with_node_set("support_left", [0, 2])
    with pytest.raises(InputError, match=r"suport_left.*Did you mean 'support_left'\?"):
        mesh.nodes_of_set("suport_left")
    with pytest.raises(InputError, match=r"volum.*Did you mean 'volume'\?"):
        mesh.elements_of_set("volum")
    ((block, elements),) = mesh.elements_of_set("volume")
    assert (block, elements.tolist()) == (0, [0])


def test_merged_keeps_parts_apart_and_unites_sets():
    left = Mesh.box((1.0, 1.0, 1.0), (1, 1, 1))
    right = Mesh.box((1.0, 1.0, 1.0), (1, 1, 2), origin=(1.0, 0.0, 0.0))
    both = left.merged(right).with_points(left.merged(right).points + [0.0, 0.0, 5.0])
    assert (both.n_node, both.n_element) == (8 + 12, 3)
    assert len(np.unique(both.node_labels)) == 20
    np.testing.assert_array_equal(both.node_labels[:8], left.node_labels)
    assert [len(part) for part in both.components()] == [12, 8]
    faces = both.points[both.nodes_of_set("x_max")]
    assert sorted(set(faces[:, 0].tolist())) == [1.0, 2.0]
    assert [(block, elements.tolist()) for block, elements in both.elements_of_set("volume")] == [
        (0, [0]),
        (1, [0, 1]),
    ]
    touching = both.duplicate_nodes(1e-9)
    np.testing.assert_array_equal(both.points[touching[:, 0]], both.points[touching[:, 1]])
    assert len(touching) == 4  # two of the right part's six nodes at x = 1 lie at half height


def test_components_come_by_size_and_leave_out_loose_nodes():
    points = np.arange(24.0).reshape(8, 3)
    block = CellBlock("line2", np.array([[6, 7], [0, 1], [1, 2]]), np.array([1, 2, 3]))
    mesh = Mesh(points, (block,))
    assert [part.tolist() for part in mesh.components()] == [[0, 1, 2], [6, 7]]
    assert mesh.unused_nodes().tolist() == [3, 4, 5]
    assert Mesh(points).components() == ()


def test_duplicates_are_pairs_within_the_tolerance():
    points = np.array([[0.0, 0, 0], [1.0, 0, 0], [0.0, 0, 1e-4], [1.0, 0, 3e-4]])
    mesh = Mesh(points)
    assert mesh.duplicate_nodes(2e-4).tolist() == [[0, 2]]
    assert mesh.duplicate_nodes(4e-4).tolist() == [[0, 2], [1, 3]]
    with pytest.raises(InputError, match=r"tolerance = -1\.0: must be zero or positive"):
        mesh.duplicate_nodes(-1.0)


def test_copies_leave_the_mesh_as_it_is():
    mesh = Mesh.line((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), 2)
    changed = mesh.with_node_set("middle", [1]).with_points(mesh.points * 2.0)
    assert "middle" not in mesh.node_sets
    assert mesh.points[-1, 0] == 1.0
    assert changed.points[-1, 0] == 2.0
    assert math.isclose(pickle.loads(pickle.dumps(changed)).points[1, 0], 1.0)
    assert repr(changed) == "Mesh of 3 nodes, 2 line2; sets end, line, middle, …"


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: Mesh(np.zeros((2, 2))), r"points = \(2, 2\): must be an array"),
        (lambda: Mesh([[0.0, 0.0, math.nan]]), "must be finite"),
        (lambda: Mesh(np.zeros((2, 3)), node_labels=np.array([1])), "must be one for each node"),
        (lambda: CellBlock("brick", np.zeros((1, 8), int), np.array([1])), "not a known element kind"),
        (lambda: CellBlock("hex8", np.zeros((1, 6), int), np.array([1])), "must have 8 nodes"),
        (lambda: CellBlock("hex8", np.zeros((1, 8)), np.array([1])), "must be whole numbers"),
        (
            lambda: Mesh(np.zeros((2, 3)), (CellBlock("line2", np.array([[0, 2]]), np.array([1])),)),
            "between 0 and 1",
        ),
        (lambda: Mesh(np.zeros((2, 3)), node_sets={"a": np.array([-1])}), "node set 'a' = -1"),
        (
            lambda: Mesh(np.zeros((2, 3)), element_sets={"a": ((0, np.array([0])),)}),
            "block of element set 'a'",
        ),
        (lambda: Mesh(np.zeros((0, 3))).bounding_box(), "must have nodes"),
        (lambda: Mesh.box((1.0, 1.0), (1, 1, 1)), "must be 3 finite numbers"),
        (lambda: Mesh.box((1.0, 0.0, 1.0), (1, 1, 1)), "must be positive"),
        (lambda: Mesh.box((1.0, 1.0, 1.0), (1, 1)), "must be 3 numbers"),
        (lambda: Mesh.box((1.0, 1.0, 1.0), (1, 1, 0)), "at least 1"),
        (lambda: Mesh.box((1.0, 1.0, 1.0), (1, 1, 1), kind="quad4"), "must be one of hex8, wedge6, tet4"),
        (lambda: Mesh.rectangle((1.0, 1.0), (1, 1), plane="yz"), "must be 'xy' or 'xz'"),
        (lambda: Mesh.line((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 3), "must differ"),
    ],
)
def test_what_is_wrong_is_said(build, message):
    with pytest.raises(InputError, match=message):
        build()
