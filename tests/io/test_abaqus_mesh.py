"""Abaqus input files: hand-made ones with every form that is read, and meshlane's view of a flat one."""

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.io.meshes import read_mesh

FLAT = """*HEADING
 a slab with an edge beam
** nodes
*NODE, NSET=ALL
 1, 0., 0., 0.
 2, 1., 0., 0.
 3, 1., 1., 0.
 4, 0., 1., 0.
 15, 2., 0.
 16, 2.0D0, 1., 0.
*ELEMENT, TYPE=S4R,
ELSET=DECK
 10, 1, 2, 3, 4
 11, 2, 15, 16, 3
*element, type=B31, elset="edge beam"
 20, 1, 2
 21, 2, 15
*NSET, NSET=LEFT, GENERATE
 1, 4, 3
*NSET, NSET=SOME
 1, 2,
 15
*ELSET, ELSET=BOTH
 DECK, Edge Beam
*NSET, NSET=MORE
 left, 16
*NSET, NSET=OF_DECK, ELSET=deck
*MATERIAL, NAME=CONCRETE
*ELASTIC
 3.0e10, 0.2
*STEP
*STATIC
*END STEP
"""


@pytest.fixture
def write(tmp_path):
    def _write(text, name="model.inp"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return _write


def labels(mesh, name):
    return sorted(mesh.node_labels[mesh.nodes_of_set(name)].tolist())


def element_labels(mesh, name):
    return {
        mesh.blocks[block].kind: mesh.blocks[block].labels[own].tolist()
        for block, own in mesh.elements_of_set(name)
    }


def test_a_flat_file(write):
    mesh = read_mesh(write(FLAT))
    assert mesh.node_labels.tolist() == [1, 2, 3, 4, 15, 16]
    assert mesh.points[4:].tolist() == [[2, 0, 0], [2, 1, 0]]
    assert [(block.kind, block.labels.tolist()) for block in mesh.blocks] == [
        ("quad4", [10, 11]),
        ("line2", [20, 21]),
    ]
    assert mesh.node_labels[mesh.blocks[0].nodes].tolist() == [[1, 2, 3, 4], [2, 15, 16, 3]]
    assert labels(mesh, "ALL") == [1, 2, 3, 4, 15, 16]
    assert labels(mesh, "LEFT") == [1, 4]
    assert labels(mesh, "SOME") == [1, 2, 15]
    assert labels(mesh, "MORE") == [1, 4, 16]
    assert labels(mesh, "OF_DECK") == [1, 2, 3, 4, 15, 16]
    assert element_labels(mesh, "DECK") == {"quad4": [10, 11]}
    assert element_labels(mesh, "edge beam") == {"line2": [20, 21]}
    assert element_labels(mesh, "BOTH") == {"quad4": [10, 11], "line2": [20, 21]}


def test_meshlane_agrees_on_a_flat_file(write):
    meshlane = pytest.importorskip("meshlane")
    text = FLAT.replace("*ELEMENT, TYPE=S4R,\nELSET", "*ELEMENT, TYPE=S4R, ELSET").replace("2.0D0", "2.0")
    path = write(text.replace(" 15, 2., 0.\n", " 15, 2., 0., 0.\n"))
    ours, theirs = read_mesh(path), meshlane.read(path, file_format="abaqus")
    np.testing.assert_array_equal(ours.points, theirs.points)
    for block, other in zip(ours.blocks, theirs.cells, strict=True):
        np.testing.assert_array_equal(block.nodes, other.data)


# Node order: Abaqus Elements Guide. Given are the corners of each mid-edge node, from node 5, 9 or the second on.
@pytest.mark.parametrize(
    ("kind", "name", "corners", "edges", "vtk"),
    [
        ("hex20", "C3D20R", 8, "01 12 23 30 45 56 67 74 04 15 26 37", None),
        ("tet10", "C3D10", 4, "01 12 20 03 13 23", None),
        ("quad8", "S8R", 4, "01 12 23 30", None),
        ("tri6", "STRI65", 3, "01 12 20", None),
    ],
)
def test_quadratic_elements_run_over_lines_and_keep_vtks_order(write, kind, name, corners, edges, vtk):
    unit = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    if kind in ("tet10", "tri6"):
        unit = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    points = np.array(unit[:corners], float)
    middles = np.array([points[[int(a), int(b)]].mean(axis=0) for a, b in edges.split()])
    points = np.vstack([points, middles])
    rows = [f"{i}, {x}, {y}, {z}" for i, (x, y, z) in enumerate(points.tolist(), start=1)]
    numbers = [str(i) for i in range(1, len(points) + 1)]
    split = (
        ", ".join(["7", *numbers[:9]]) + ",\n" + ", ".join(numbers[9:])
        if len(numbers) > 9
        else "7, " + ", ".join(numbers)
    )
    mesh = read_mesh(write("\n".join(["*NODE", *rows, f"*ELEMENT, TYPE={name}", split]) + "\n"))
    (block,) = mesh.blocks
    assert (block.kind, block.labels.tolist()) == (kind, [7])
    np.testing.assert_array_equal(mesh.points[block.nodes[0, corners:]], middles)


def test_what_says_nothing_of_the_mesh_is_passed_over(write):
    text = FLAT.replace("*NODE, NSET=ALL", "*SYSTEM\n*NODE, NSET=ALL")
    np.testing.assert_array_equal(read_mesh(write(text)).points, read_mesh(write(FLAT)).points)


def test_the_middle_node_of_a_line_goes_last(write):
    mesh = read_mesh(write("*NODE\n1, 0.\n2, 1.\n3, 2.\n*ELEMENT, TYPE=B32\n1, 1, 2, 3\n"))
    assert mesh.points[mesh.blocks[0].nodes[0], 0].tolist() == [0.0, 2.0, 1.0]


@pytest.mark.parametrize(
    ("name", "kind", "nodes"),
    [
        *(
            ("B31", "line2", 2),
            ("B33", "line2", 2),
            ("T3D2", "line2", 2),
            ("S3", "tri3", 3),
            ("S4", "quad4", 4),
        ),
        *(
            ("CPS4", "quad4", 4),
            ("CPE4R", "quad4", 4),
            ("CPS3", "tri3", 3),
            ("C3D4", "tet4", 4),
            ("C3D6", "wedge6", 6),
        ),
        *(("C3D8", "hex8", 8), ("C3D8I", "hex8", 8), ("C3D8R", "hex8", 8), ("MASS", "point1", 1)),
    ],
)
def test_types_and_their_kinds(write, name, kind, nodes):
    rows = "\n".join(f"{i}, {i}., {i * i}., 0." for i in range(1, 9))
    row = ", ".join(str(i) for i in range(1, nodes + 1))
    mesh = read_mesh(write(f"*NODE\n{rows}\n*ELEMENT, TYPE={name.lower()}\n5, {row}\n"))
    assert (mesh.blocks[0].kind, mesh.blocks[0].nodes.tolist()) == (kind, [list(range(nodes))])


PARTS = """*HEADING
*PART, NAME=Span
*NODE
1, 0., 0., 0.
2, 4., 0., 0.
*ELEMENT, TYPE=B31, ELSET=girder
1, 1, 2
*NSET, NSET=ends
1, 2
*END PART
*ASSEMBLY, NAME=Assembly
*INSTANCE, NAME=Span-1, PART=Span
*END INSTANCE
*INSTANCE, NAME=Span-2, PART=span
 10., 0., 1.
 10., 0., 1., 10., 0., 2., 90.
*END INSTANCE
*NODE, NSET=reference
1, 7., 7., 7.
*NSET, NSET=supports, INSTANCE=Span-1
1,
*NSET, NSET=supports, INSTANCE=Span-2
ends,
*NSET, NSET=tips
Span-1.2, Span-2.ends, reference
*ELSET, ELSET=all girders
Span-1.girder, Span-2.1
*END ASSEMBLY
"""


def test_parts_and_instances(write):
    mesh = read_mesh(write(PARTS))
    # the second instance is moved by (10, 0, 1), then turned by 90 degrees about the vertical through (10, 0)
    np.testing.assert_allclose(
        mesh.points, [[0, 0, 0], [4, 0, 0], [10, 0, 1], [10, 4, 1], [7, 7, 7]], atol=1e-14
    )
    assert len(set(mesh.node_labels.tolist())) == 5
    assert mesh.nodes_of_set("supports").tolist() == [0, 2, 3]
    assert mesh.nodes_of_set("tips").tolist() == [1, 2, 3, 4]
    assert mesh.nodes_of_set("Span-2.ends").tolist() == [2, 3]
    assert mesh.nodes_of_set("reference").tolist() == [4]
    assert [(block, own.tolist()) for block, own in mesh.elements_of_set("all girders")] == [
        (0, [0]),
        (1, [0]),
    ]
    assert [(block, own.tolist()) for block, own in mesh.elements_of_set("Span-2.girder")] == [(1, [0])]
    assert mesh.blocks[1].nodes.tolist() == [[2, 3]]


def test_one_instance_keeps_the_names_of_its_sets(write):
    text = (
        PARTS[: PARTS.index("*INSTANCE, NAME=Span-2")] + "*NSET, NSET=a, INSTANCE=Span-1\n2\n*END ASSEMBLY\n"
    )
    mesh = read_mesh(write(text))
    assert mesh.nodes_of_set("ends").tolist() == [0, 1]
    assert mesh.nodes_of_set("a").tolist() == [1]
    alone = read_mesh(write(PARTS[: PARTS.index("*ASSEMBLY")]))
    assert alone.nodes_of_set("ends").tolist() == [0, 1]
    assert alone.node_labels.tolist() == [1, 2]


def test_elements_that_are_not_supported_are_named_with_their_number_and_count(write):
    text = FLAT.replace("TYPE=S4R,\nELSET=DECK", "TYPE=S9R5").replace("type=B31", "type=CONN3D2")
    with pytest.raises(
        InputError, match=r"model.inp:11: Abaqus type S9R5 \(2 elements\), Abaqus type CONN3D2 \(2 elements\)"
    ):
        read_mesh(write(text))


FAULTS = [
    (" 3, 1., 1., 0.", " 3, 1., 1., x", " 3, 1., 1., x", "must be numbers"),
    (" 3, 1., 1., 0.", " 3, 1., nan, 0.", " 3, 1., nan, 0.", "coordinates of node 3 = .*: must be finite"),
    (" 3, 1., 1., 0.", " 3", " 3", "must be a node number and one to three coordinates"),
    (
        " 3, 1., 1., 0.",
        " 2, 1., 1., 0.",
        " 2, 1., 1., 0.",
        "node number = 2: is already the number of another node",
    ),
    (
        " 3, 1., 1., 0.",
        " 3.5, 1., 1., 0.",
        " 3.5, 1., 1., 0.",
        r"3\.5: must be a whole number \(node number\)",
    ),
    (" 11, 2, 15, 16, 3", " 11, 2, 15, 16", " 11, 2, 15, 16", "must be 5 numbers"),
    (" 10, 1, 2, 3, 4", " 10, 1, 2, 3", " 10, 1, 2, 3", "must be 5 numbers"),
    (" 10, 1, 2, 3, 4", " 10, 1, 2, 3, 4, 5", " 10, 1, 2, 3, 4, 5", "must be 5 numbers"),
    (" 10, 1, 2, 3, 4", " 10, 1, 2, , 4", " 10, 1, 2, , 4", "must be whole numbers"),
    (
        " 11, 2, 15, 16, 3",
        " 11, 2, 15, 99, 3",
        " 11, 2, 15, 99, 3",
        r"node number = 99: must be a node of the file",
    ),
    (
        " 11, 2, 15, 16, 3",
        " 10, 2, 15, 16, 3",
        " 10, 2, 15, 16, 3",
        "element number = 10: is already the number",
    ),
    (" 1, 4, 3", " 1, 4, 0", " 1, 4, 0", r"must have a positive step \(GENERATE\)"),
    (" 1, 4, 3", " 7, 9, 1", " 7, 9, 1", "names nothing that is in the file"),
    (" 1, 4, 3", " 1", " 1", "must be first, last and step"),
    ("\n 15\n", "\n 17\n", " 17", r"node number = 17: must be a node of the file \(set 'SOME'\)"),
    (" left, 16", " lift, 16", " lift, 16", r"'lift': is not a known set. Did you mean 'LEFT'\?"),
    (" left, 16", " more, 16", " more, 16", "makes the set contain itself"),
    ("ELSET=deck", "ELSET=dock", "*NSET, NSET=OF_DECK, ELSET=dock", "'dock': is not a known element set"),
    ("*NSET, NSET=SOME", "*NSET", "*NSET", r"\*NSET: must have the parameter NSET"),
    ("*element, type=B31", "*element", '*element, elset="edge beam"', "must have the parameter TYPE"),
    (
        "*MATERIAL",
        "*NGEN\n1, 2\n*MATERIAL",
        "*NGEN",
        r"\*NGEN: is not supported. Let the preprocessor write all nodes",
    ),
    (
        "*MATERIAL",
        "*INCLUDE, INPUT=x.inp\n*MATERIAL",
        "*INCLUDE, INPUT=x.inp",
        r"\*INCLUDE: is not supported. Put the",
    ),
    ("*NODE, NSET=ALL", "*NODE, INPUT=x.inp", "*NODE, INPUT=x.inp", "with INPUT is not supported"),
    (
        "*NODE, NSET=ALL",
        "*SYSTEM\n0., 0., 1.\n*NODE, NSET=ALL",
        "*SYSTEM",
        r"\*SYSTEM: is not supported. Write the",
    ),
    ("*NODE, NSET=ALL", "*NODE, SYSTEM=C", "*NODE, SYSTEM=C", r"must be R \(rectangular\)"),
    ("*HEADING\n", "1, 2\n*HEADING\n", "1, 2", "must begin with a keyword"),
    (
        "*NSET, NSET=SOME",
        "*NSET, NSET=SOME, INSTANCE=A",
        "*NSET, NSET=SOME, INSTANCE=A",
        "is not an instance of the file",
    ),
]


@pytest.mark.parametrize(("old", "new", "line", "message"), FAULTS)
def test_what_is_wrong_is_said_with_its_line(write, old, new, line, message):
    assert old in FLAT
    damaged = FLAT.replace(old, new, 1)
    with pytest.raises(InputError, match=message) as raised:
        read_mesh(write(damaged))
    assert damaged.split("\n")[raised.value.place.line - 1] == line


def test_sets_that_contain_each_other(write):
    text = FLAT.replace("*NSET, NSET=OF_DECK, ELSET=deck\n", "*NSET, NSET=A\nB\n*NSET, NSET=B\nA\n")
    with pytest.raises(InputError, match="makes the set contain itself"):
        read_mesh(write(text))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("PART=span", "PART=spam", r":\d+: \*INSTANCE = 'spam': is not a part of the file"),
        ("NAME=Span-2, PART", "NAME=Span-1, PART", "is already the name of an instance"),
        (" 10., 0., 1.\n 10.", " 10., 0.\n 10.", r"must be followed by a translation \(3 numbers\)"),
        ("0., 2., 90.", "0., 2., inf", "must be followed by a translation"),
        ("Span-1.2, Span", "Span-1.3, Span", "node number = 3: must be a node of the file"),
        ("Span-1.2, Span", "Span-3.2, Span", "'Span-3.2': is not a known set"),
        (
            "*PART, NAME=Span\n",
            "*PART, NAME=Span\n*END PART\n*PART, NAME=SPAN\n",
            "is already the name of a part",
        ),
    ],
)
def test_what_is_wrong_with_instances_is_said(write, old, new, message):
    assert old in PARTS
    with pytest.raises(InputError, match=message):
        read_mesh(write(PARTS.replace(old, new, 1)))


def test_a_file_without_nodes(write):
    with pytest.raises(InputError, match="has no nodes"):
        read_mesh(write("*HEADING\n nothing\n*STEP\n*END STEP\n"))
