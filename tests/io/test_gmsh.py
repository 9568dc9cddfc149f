"""Gmsh files: against hand-made files, against meshlane (an implementation of its own), and there and back."""

import struct

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.io.meshes import read_gmsh, read_mesh, write_gmsh
from axlespan.model.mesh import CellBlock, Mesh

# A strip of two quadrilaterals with a line on its left edge and a point; numbers have gaps. Layout as in the
# Gmsh reference manual's example of MSH 4.1.
STRIP_41 = """$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
3
0 4 "anchor"
1 2 "left edge"
2 1 "deck"
$EndPhysicalNames
$Entities
1 1 1 0
7 0 0 0 1 4
3 0 0 0 0 1 0 2 2 -9 0
5 0 0 0 2 1 0 1 1 0
$EndEntities
$Nodes
2 6 10 60
1 3 0 2
10
40
0 0 0
0 1 0
2 5 1 4
20
30
50
60
1 0 0 0 0
1 1 0 0 0
2 0 0.5 0 0
2 1 0.5 0 0
$EndNodes
$Elements
3 4 1 9
0 7 15 1
1 10
1 3 1 1
2 40 10
2 5 3 2
8 10 20 30 40
9 20 50 60 30
$EndElements
"""

STRIP_22 = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 2 "left edge"
2 1 "deck"
$EndPhysicalNames
$Nodes
6
10 0 0 0
20 1 0 0
30 1 1 0
40 0 1 0
50 2 0 0.5
60 2 1 0.5
$EndNodes
$Elements
5
2 1 2 2 3 40 10
3 1 2 9 3 40 10
8 3 2 1 5 10 20 30 40
9 3 4 1 5 1 1 20 50 60 30
10 15 0 10
$EndElements
"""


@pytest.fixture
def write(tmp_path):
    def _write(content, name="mesh.msh"):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return _write


@pytest.mark.parametrize("text", [STRIP_41, STRIP_22, STRIP_41.replace("\n", "\r\n")])
def test_a_small_file_by_hand(write, text):
    mesh = read_mesh(write(text))
    at = {label: point for label, point in zip(mesh.node_labels.tolist(), mesh.points.tolist(), strict=True)}
    assert at == {
        10: [0, 0, 0],
        20: [1, 0, 0],
        30: [1, 1, 0],
        40: [0, 1, 0],
        50: [2, 0, 0.5],
        60: [2, 1, 0.5],
    }
    quads = next(block for block in mesh.blocks if block.kind == "quad4")
    assert quads.labels.tolist() == [8, 9]
    assert mesh.node_labels[quads.nodes].tolist() == [[10, 20, 30, 40], [20, 50, 60, 30]]
    assert sorted(mesh.node_labels[mesh.nodes_of_set("deck")].tolist()) == [10, 20, 30, 40, 50, 60]
    # the line is in two groups, one of them without a name
    for name in ("left edge", "line-9"):
        assert sorted(mesh.node_labels[mesh.nodes_of_set(name)].tolist()) == [10, 40]
        ((block, elements),) = mesh.elements_of_set(name)
        assert (mesh.blocks[block].kind, elements.tolist()) == ("line2", [0])
    assert len(next(block for block in mesh.blocks if block.kind == "line2")) == 1


def test_points_become_sets_too(write):
    mesh = read_mesh(write(STRIP_41))
    assert mesh.node_labels[mesh.nodes_of_set("anchor")].tolist() == [10]


# Edges in the order of Gmsh's mid-edge nodes: Gmsh reference manual, "Node ordering", figures of
# Tetrahedron10 and Hexahedron20.
GMSH_EDGES = {
    "tet10": (11, [(0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3)]),
    "hex20": (
        17,
        [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)],
    ),
    "tri6": (9, [(0, 1), (1, 2), (2, 0)]),
    "quad8": (16, [(0, 1), (1, 2), (2, 3), (3, 0)]),
    "line3": (8, [(0, 1)]),
}
CORNERS = {
    "tet10": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
    "hex20": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
    "tri6": [(0, 0, 0), (1, 0, 0), (0, 1, 0)],
    "quad8": [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)],
    "line3": [(0, 0, 0), (1, 0, 0)],
}
# VTK file formats, figures of the non-linear cell types
VTK_EDGES = {
    "tet10": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
    "hex20": [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)],
    "tri6": [(0, 1), (1, 2), (2, 0)],
    "quad8": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "line3": [(0, 1)],
}


@pytest.mark.parametrize("kind", list(GMSH_EDGES))
def test_nodes_of_quadratic_elements_come_in_vtks_order(write, kind):
    number, edges = GMSH_EDGES[kind]
    corners = np.array(CORNERS[kind], float)
    points = np.vstack([corners, [corners[list(edge)].mean(axis=0) for edge in edges]])
    rows = "\n".join(f"{i} {x} {y} {z}" for i, (x, y, z) in enumerate(points.tolist(), start=1))
    nodes = " ".join(str(i + 1) for i in range(len(points)))
    text = f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(points)}\n{rows}\n$EndNodes\n"
    mesh = read_gmsh(write(text + f"$Elements\n1\n1 {number} 2 0 1 {nodes}\n$EndElements\n"))
    assert mesh.blocks[0].kind == kind
    found = mesh.points[mesh.blocks[0].nodes[0]]
    expected = [corners[list(edge)].mean(axis=0) for edge in VTK_EDGES[kind]]
    np.testing.assert_array_equal(found[len(corners) :], expected)


MESHES = {
    "hexahedra": Mesh.box((3.0, 2.0, 1.0), (3, 2, 2)),
    "quadratic hexahedra": Mesh.box((3.0, 2.0, 1.0), (2, 2, 1)).quadratic(),
    "tetrahedra": Mesh.box((1.0, 1.0, 1.0), (1, 2, 1), kind="tet4"),
    "quadratic tetrahedra": Mesh.box((1.0, 1.0, 1.0), (1, 2, 1), kind="tet4").quadratic(),
    "wedges": Mesh.box((1.0, 1.0, 1.0), (1, 2, 1), kind="wedge6"),
    "quadratic quadrilaterals": Mesh.rectangle((2.0, 1.0), (3, 2)).quadratic(),
    "quadratic triangles": Mesh.rectangle((2.0, 1.0), (3, 2), kind="tri3").quadratic(),
    "beams on a shell": Mesh.rectangle((1.0 / 3.0, 1.0), (3, 2)).merged(Mesh.line((0, 0, 0), (1.0, 0, 0), 3)),
    "no elements": Mesh([[0.1, 0.2, 0.3]], node_labels=np.array([77])).with_node_set("only one", [0]),
}


@pytest.mark.parametrize("version", ["4.1", "2.2"])
@pytest.mark.parametrize("name", list(MESHES))
def test_there_and_back(tmp_path, name, version):
    mesh = MESHES[name]
    write_gmsh(mesh, tmp_path / "mesh.msh", version=version)
    back = read_mesh(tmp_path / "mesh.msh")
    np.testing.assert_array_equal(back.points, mesh.points)
    np.testing.assert_array_equal(back.node_labels, mesh.node_labels)
    blocks = [block for block in back.blocks if block.kind != "point1"]  # points carry the node sets
    for ours, theirs in zip(mesh.blocks, blocks, strict=True):
        assert theirs.kind == ours.kind
        np.testing.assert_array_equal(theirs.nodes, ours.nodes)
        np.testing.assert_array_equal(theirs.labels, ours.labels)
    for set_name in {*mesh.node_sets, *mesh.element_sets}:
        np.testing.assert_array_equal(back.nodes_of_set(set_name), mesh.nodes_of_set(set_name))
    for set_name, parts in mesh.element_sets.items():
        labels = [mesh.blocks[block].labels[elements].tolist() for block, elements in parts]
        again = [
            back.blocks[block].labels[elements].tolist() for block, elements in back.elements_of_set(set_name)
        ]
        assert again == labels


def test_overlapping_sets_survive_both_versions(tmp_path):
    mesh = Mesh.rectangle((3.0, 1.0), (3, 1))
    mesh = mesh.with_element_set("left", ((0, np.array([0, 1])),)).with_element_set(
        "right", ((0, np.array([1, 2])),)
    )
    for version in ("4.1", "2.2"):
        write_gmsh(mesh, tmp_path / "mesh.msh", version=version)
        back = read_mesh(tmp_path / "mesh.msh")
        quads = next(i for i, block in enumerate(back.blocks) if block.kind == "quad4")
        assert len(back.blocks[quads]) == 3
        for name, labels in {"left": [1, 2], "right": [2, 3], "surface": [1, 2, 3]}.items():
            ((block, elements),) = back.elements_of_set(name)
            assert (block, sorted(back.blocks[block].labels[elements].tolist())) == (quads, labels)


def binary(mesh_of_strip: bool, version: str, order: str) -> bytes:
    """The strip (deck and left edge) as Gmsh writes it in binary, by struct."""
    text, names = (
        b"$MeshFormat\n%s 1 8\n",
        STRIP_41[STRIP_41.index("$PhysicalNames") : STRIP_41.index("$Entities")],
    )
    body = text % version.encode() + struct.pack(order + "i", 1) + b"\n$EndMeshFormat\n" + names.encode()
    points = {10: (0, 0, 0), 20: (1, 0, 0), 30: (1, 1, 0), 40: (0, 1, 0), 50: (2, 0, 0.5), 60: (2, 1, 0.5)}
    if version == "2.2":
        body += b"$Nodes\n6\n"
        body += b"".join(struct.pack(order + "i3d", label, *xyz) for label, xyz in points.items())
        body += b"\n$EndNodes\n$Elements\n4\n"
        body += struct.pack(order + "3i", 1, 2, 2) + struct.pack(
            order + "10i", 2, 2, 3, 40, 10, 3, 9, 3, 40, 10
        )
        body += struct.pack(order + "3i", 3, 2, 2)
        body += struct.pack(order + "14i", 8, 1, 5, 10, 20, 30, 40, 9, 1, 5, 20, 50, 60, 30)
        return body + b"\n$EndElements\n"
    body += b"$Entities\n" + struct.pack(order + "4Q", 1, 1, 1, 0)
    body += struct.pack(order + "i3dQi", 7, 0, 0, 0, 1, 4)
    body += struct.pack(order + "i6dQ2iQ2i", 3, 0, 0, 0, 0, 1, 0, 2, 2, -9, 2, 7, -7)
    body += struct.pack(order + "i6dQiQ", 5, 0, 0, 0, 2, 1, 0, 1, 1, 0)
    body += b"\n$EndEntities\n$Nodes\n" + struct.pack(order + "4Q", 2, 6, 10, 60)
    body += struct.pack(order + "3iQ2Q", 1, 3, 0, 2, 10, 40)
    body += struct.pack(order + "6d", 0, 0, 0, 0, 1, 0)
    body += struct.pack(order + "3iQ4Q", 2, 5, 1, 4, 20, 30, 50, 60)
    body += b"".join(struct.pack(order + "5d", *points[label], 0.1, 0.2) for label in (20, 30, 50, 60))
    body += b"\n$EndNodes\n$Elements\n" + struct.pack(order + "4Q", 2, 3, 2, 9)
    body += struct.pack(order + "3iQ3Q", 1, 3, 1, 1, 2, 40, 10)
    body += struct.pack(order + "3iQ10Q", 2, 5, 3, 2, 8, 10, 20, 30, 40, 9, 20, 50, 60, 30)
    return body + b"\n$EndElements\n"


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("version", ["4.1", "2.2"])
def test_binary_of_either_byte_order(write, version, order):
    mesh = read_mesh(write(binary(True, version, order)))
    quads = next(block for block in mesh.blocks if block.kind == "quad4")
    assert mesh.node_labels[quads.nodes].tolist() == [[10, 20, 30, 40], [20, 50, 60, 30]]
    assert mesh.points[mesh.node_labels == 60].tolist() == [[2, 1, 0.5]]
    assert sorted(mesh.node_labels[mesh.nodes_of_set("left edge")].tolist()) == [10, 40]
    assert sorted(mesh.node_labels[mesh.nodes_of_set("line-9")].tolist()) == [10, 40]
    assert [block.kind for block in mesh.blocks].count("line2") == 1


@pytest.mark.parametrize(
    "name", ["quadratic hexahedra", "quadratic tetrahedra", "wedges", "quadratic triangles"]
)
@pytest.mark.parametrize(("version", "form"), [("4.1", "gmsh"), ("2.2", "gmsh22")])
def test_meshlane_reads_what_we_write_and_we_read_what_it_writes(tmp_path, name, version, form):
    meshlane = pytest.importorskip("meshlane")
    mesh = MESHES[name]
    write_gmsh(mesh, tmp_path / "ours.msh", version=version)
    theirs = meshlane.read(tmp_path / "ours.msh", file_format="gmsh")
    np.testing.assert_allclose(theirs.points, mesh.points, rtol=1e-15)
    cells = next(block.data for block in theirs.cells if block.type != "vertex")
    np.testing.assert_array_equal(cells, mesh.blocks[0].nodes)
    for as_binary in (False, True):
        plain = meshlane.Mesh(
            mesh.points, [(next(b.type for b in theirs.cells if b.type != "vertex"), cells)]
        )
        meshlane.write(tmp_path / "theirs.msh", plain, file_format=form, binary=as_binary)
        back = read_mesh(tmp_path / "theirs.msh")
        np.testing.assert_allclose(back.points, mesh.points, rtol=1e-14)
        np.testing.assert_array_equal(back.blocks[0].nodes, mesh.blocks[0].nodes)


def test_elements_that_are_not_supported_are_named_with_their_number_and_count(write):
    pyramids = STRIP_41.replace(
        "2 5 3 2\n8 10 20 30 40\n9 20 50 60 30", "3 5 7 2\n8 10 20 30 40 50\n9 20 50 60 30 10"
    )
    with pytest.raises(
        InputError, match=r"mesh.msh:39: Gmsh type 7, 5-node pyramid \(2 elements\): is not a supported"
    ):
        read_mesh(write(pyramids))
    mixed = STRIP_22.replace("8 3 2 1 5 10 20 30 40", "8 10 2 1 5 10 20 30 40 50 60 10 20 30").replace(
        "10 15 0 10", "10 99 0 10"
    )
    with pytest.raises(
        InputError, match=r"Gmsh type 10, 9-node quadrilateral \(1 element\), Gmsh type 99, unknown"
    ) as raised:
        read_mesh(write(mixed))
    assert "Mesh.SecondOrderIncomplete = 1" in str(raised.value)


# what is changed into what, the line that is at fault afterwards, and what is said of it
FAULTS_41 = [
    ("4.1 0 8", "4.0 0 8", "4.0 0 8", r"MSH version = '4\.0': is not a supported version; 4\.1 and 2\.2 are"),
    ("4.1 0 8", "four", "four", "must give version, file type"),
    ("$MeshFormat\n4.1", "$Mesh\n4.1", "$Mesh", r"must begin with \$MeshFormat"),
    ("$EndNodes\n", "", "", r"ends early: the section \$Nodes of line \d+ has no \$EndNodes"),
    ("$Nodes", "$Knots", "", r"ends early: the section \$Knots of line"),
    ("2 6 10 60", "2 7 10 60", "2 7 10 60", "must announce 6 nodes"),
    ("2 6 10 60", "3 6 10 60", "2 1 0.5 0 0", "ends early: 0 of 1 lines"),
    ("2 6 10 60", "99999999999 6 10 60", "2 1 0.5 0 0", r"ends early: \d+ of 99999999999 lines of blocks"),
    ("1 3 0 2\n10", "1 3 0 1\n10", "40", r"'40': must have 3 numbers \(coordinates\), not 1"),
    ("0 1 0\n2 5", "0 nan 0\n2 5", "0 nan 0", "coordinates of node 40 = .*: must be finite"),
    ("0 1 0\n2 5", "0 1e30 0\n2 5", "0 1e30 0", r"must be finite and at most 1e\+09 m"),
    ("0 1 0\n2 5", "0 x 0\n2 5", "0 x 0", r"'0 x 0': must be numbers \(coordinates\)"),
    ("20\n30\n50", "20\n20\n50", "20", "node number = 20: is already the number of another node"),
    ("20\n30\n50", "20\n30.5\n50", "30.5", r"30\.5: must be a whole number \(node number\)"),
    ("20\n30\n50", "20\n99999999999999999999\n50", "99999999999999999999", r"1e\+20: must be a whole number"),
    ("2 40 10", "2 40 11", "2 40 11", r"node number = 11: must be a node of the file \(line2 element\)"),
    (
        "9 20 50 60 30",
        "8 20 50 60 30",
        "8 20 50 60 30",
        "element number = 8: is already the number of another",
    ),
    ("9 20 50 60 30", "9 20 50 60", "9 20 50 60", "'9 20 50 60': must have 5 numbers"),
    ("3 4 1 9", "3 5 1 9", "3 5 1 9", "must announce 4 elements"),
    (
        '1 2 "left edge"',
        "1 2 left",
        "1 2 left",
        r"must be a dimension \(0 to 3\), a number and a name in quotes",
    ),
    ("0 2 2 -9 0", "0 9 2 -9 0", "3 0 0 0 0 1 0 9 2 -9 0", "must list 9 physical groups"),
]
FAULTS_22 = [
    ("$Elements\n5", "$Elements\n4", "10 15 0 10", "stands after the last of the elements"),
    ("$Elements\n5", "$Elements\n6", "10 15 0 10", "ends early: 5 of 6 lines of elements"),
    ("5 10 20 30 40", "5 10 20 30", "8 3 2 1 5 10 20 30", "must have as many tags as it says and 4 nodes"),
    ("8 3 2 1", "8 3 -2 1", "8 3 -2 1 5 10 20 30 40", "must have as many tags"),
    ("8 3 2 1 5 10 20 30 40", "8 3", "8 3", "'8 3': must be a number, a type, tags and nodes"),
    ("20 30 40", "20 30 4.5", "8 3 2 1 5 10 20 30 4.5", r"4\.5: must be a whole number"),
    ("60 2 1 0.5", "60 2 1", "60 2 1", "must have 4 numbers"),
    ("$EndNodes", "$EndNodes\n$Nodes\n0\n$EndNodes", "$Nodes", "opens a section that the file already has"),
]


@pytest.mark.parametrize(
    ("text", "old", "new", "line", "message"),
    [(STRIP_41, *fault) for fault in FAULTS_41] + [(STRIP_22, *fault) for fault in FAULTS_22],
)
def test_what_is_wrong_is_said_with_its_line(write, text, old, new, line, message):
    assert old in text
    damaged = text.replace(old, new, 1)
    with pytest.raises(InputError, match=message) as raised:
        read_mesh(write(damaged), format="gmsh")
    assert damaged.split("\n")[raised.value.place.line - 1] == line


def test_a_section_that_is_missing(write):
    text = STRIP_22[: STRIP_22.index("$Elements")]
    with pytest.raises(InputError, match=r"has no section \$Elements"):
        read_mesh(write(text))
    head = STRIP_41[: STRIP_41.index("$Entities")]
    partitioned = head + "$PartitionedEntities\n2\n0\n$EndPartitionedEntities\n"
    with pytest.raises(
        InputError, match=r"partitioned mesh, which is not supported. Save it from Gmsh without"
    ):
        read_mesh(write(partitioned))


def test_binary_that_ends_early_or_lies_about_its_counts(write):
    data = binary(True, "4.1", "<")
    with pytest.raises(InputError, match=r"\$Elements.*has no closing mark"):
        read_mesh(write(data[:-20]))
    start = data.index(b"$Nodes\n") + len(b"$Nodes\n")
    wrong = data[: start + 8] + struct.pack("<Q", 7) + data[start + 16 :]
    with pytest.raises(InputError, match=r"announces 7 nodes, its blocks hold 6"):
        read_mesh(write(wrong))
    huge = data[: start + 32 + 12] + struct.pack("<Q", 2**60) + data[start + 32 + 20 :]
    with pytest.raises(InputError, match=r"\$Nodes: ends early: 1152921504606846976 records"):
        read_mesh(write(huge))


def test_writing_says_what_it_cannot_write(tmp_path):
    mesh = Mesh([[0.0, 0.0, 0.0]], (CellBlock("point1", np.array([[0]]), np.array([1])),))
    with pytest.raises(InputError, match=r"version = '4.0': must be '4.1' or '2.2'"):
        write_gmsh(mesh, tmp_path / "mesh.msh", version="4.0")
    with pytest.raises(InputError, match="must be printable and without quotes"):
        write_gmsh(mesh.with_node_set('a"b', [0]), tmp_path / "mesh.msh")
    with pytest.raises(InputError, match="cannot be written"):
        write_gmsh(mesh, tmp_path / "nowhere" / "mesh.msh")
