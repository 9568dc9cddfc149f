"""Matrix files: there and back in every format, hand-made ones, SciPy as a second opinion, damage by line."""

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp

from axlespan.errors import InputError
from axlespan.io.matrices import (
    DofMap,
    ModalModel,
    NodeTable,
    read_coordinates,
    read_dof_map,
    read_harwell_boeing,
    read_matrices,
    read_matrix_market,
    read_modal,
    read_npz,
    write_abaqus,
    write_coordinates,
    write_dof_map,
    write_harwell_boeing,
    write_matrix_market,
    write_modal,
    write_npz,
)


@pytest.fixture
def write(tmp_path):
    def _write(name, text):
        path = tmp_path / name
        path.write_text(text)
        return path

    return _write


def files_of(beam, folder, layout):
    """The beam's matrices (and a damping matrix) in a format, with what belongs to it."""
    parts = {"K": beam.stiffness, "M": beam.mass, "C": 1e-3 * beam.stiffness + 0.1 * beam.mass}
    paths = {name: folder / f"{name}{'.matrix' if layout == 'harwell-boeing' else '.mtx'}" for name in parts}
    for name, dense in parts.items():
        matrix = sp.csr_array(dense)
        if layout == "matrix-market":
            write_matrix_market(matrix, paths[name])
        elif layout == "npz":
            write_npz(matrix, paths[name])
        elif layout == "harwell-boeing":
            write_harwell_boeing(matrix, paths[name], dofs=beam.dofs, right_hand_side=np.arange(len(dense)))
        else:
            write_abaqus(matrix, paths[name], beam.dofs, layout=layout)
    write_dof_map(beam.dofs, folder / "dofs.csv")
    write_coordinates(beam.coordinates, folder / "nodes.csv")
    named = layout in ("harwell-boeing", "matrix-input")
    return paths, None if named else folder / "dofs.csv", folder / "nodes.csv"


@pytest.mark.parametrize("layout", ["matrix-market", "npz", "matrix-input", "coordinate", "harwell-boeing"])
def test_there_and_back(held_beam, tmp_path, layout):
    paths, dofs, nodes = files_of(held_beam, tmp_path, layout)
    model = read_matrices(paths["K"], paths["M"], paths["C"], dofs=dofs, coordinates=nodes)
    order = [model.dofs.row(node, component) for node, component in held_beam.dofs.names]
    at = np.ix_(order, order)
    for found, expected in (
        (model.stiffness, held_beam.stiffness),
        (model.mass, held_beam.mass),
        (model.damping, 1e-3 * held_beam.stiffness + 0.1 * held_beam.mass),
    ):
        np.testing.assert_allclose(found.toarray()[at], expected, rtol=1e-12, atol=0.0)
    assert set(model.dofs.names) == set(held_beam.dofs.names)
    np.testing.assert_array_equal(model.coordinates.points, held_beam.coordinates.points)
    np.testing.assert_array_equal(model.coordinates.nodes_of_set("track"), held_beam.coordinates.labels)
    assert model.rigid_body_modes() == 0


@pytest.mark.parametrize("part", ["full", "lower", "upper", "mixed"])
@pytest.mark.parametrize("layout", ["matrix-market", "npz", "matrix-input", "coordinate"])
def test_any_half_of_a_symmetric_matrix_will_do(held_beam, tmp_path, layout, part):
    full = sp.coo_array(held_beam.stiffness)
    odd = (full.row + full.col) % 2 == 1
    keep = {
        "full": np.ones(full.nnz, dtype=bool),
        "lower": full.row >= full.col,
        "upper": full.row <= full.col,
        "mixed": np.where(odd, full.row > full.col, full.row <= full.col),
    }[part]
    row, column, data = full.row[keep], full.col[keep], full.data[keep]
    names = held_beam.dofs.names
    path = tmp_path / "K.mtx"
    numbers = {"x": 1, "z": 3, "ry": 5}
    if layout == "matrix-market":
        head = f"%%MatrixMarket matrix coordinate real general\n% K\n{full.shape[0]} {full.shape[0]} {len(data)}\n"
        path.write_text(
            head
            + "".join(f"{i + 1} {j + 1} {v!r}\n" for i, j, v in zip(row, column, data.tolist(), strict=True))
        )
    elif layout == "npz":
        sp.save_npz(tmp_path / "K.npz", sp.csc_array((data, (row, column)), shape=full.shape))
        path = tmp_path / "K.npz"
    elif layout == "coordinate":
        path.write_text(
            "".join(f"{i + 1:8d} {j + 1:8d} {v:24.16e}\n" for i, j, v in zip(row, column, data, strict=True))
        )
    else:
        lines = ["** Abaqus writes comments"]
        for i, j, v in zip(row.tolist(), column.tolist(), data.tolist(), strict=True):
            (a, p), (b, q) = names[i], names[j]
            lines.append(f"{a},{numbers[p]}, {b},{numbers[q]}, {v:.15e}")
        path.write_text("\n".join(lines) + "\n")
    write_abaqus(sp.csr_array(held_beam.mass), tmp_path / "M.mtx", held_beam.dofs)
    write_matrix_market(sp.csr_array(held_beam.mass), tmp_path / "M.mm")
    write_dof_map(held_beam.dofs, tmp_path / "dofs.csv")
    named = layout == "matrix-input"
    model = read_matrices(
        path, tmp_path / ("M.mtx" if named else "M.mm"), dofs=None if named else tmp_path / "dofs.csv"
    )
    order = [model.dofs.row(*name) for name in names]
    np.testing.assert_allclose(
        model.stiffness.toarray()[np.ix_(order, order)], held_beam.stiffness, rtol=1e-15
    )


# --- Matrix Market and npz ------------------------------------------------------------------------


def test_scipy_reads_what_we_write_and_we_read_what_it_writes(held_beam, tmp_path):
    matrix = sp.csr_array(held_beam.stiffness)
    write_matrix_market(matrix, tmp_path / "ours.mtx")
    np.testing.assert_array_equal(scipy.io.mmread(tmp_path / "ours.mtx").toarray(), held_beam.stiffness)
    write_npz(matrix, tmp_path / "ours.npz")
    np.testing.assert_array_equal(sp.load_npz(tmp_path / "ours.npz").toarray(), held_beam.stiffness)
    for symmetry in ("general", "symmetric"):
        scipy.io.mmwrite(tmp_path / "theirs.mtx", matrix, symmetry=symmetry, precision=17)
        np.testing.assert_array_equal(
            read_matrix_market(tmp_path / "theirs.mtx").toarray(), held_beam.stiffness
        )
        scipy.io.mmwrite(tmp_path / "dense.mtx", held_beam.stiffness, symmetry=symmetry, precision=17)
        np.testing.assert_array_equal(
            read_matrix_market(tmp_path / "dense.mtx").toarray(), held_beam.stiffness
        )
    for form in ("csr", "csc", "coo", "bsr", "dia"):
        sp.save_npz(tmp_path / "theirs.npz", matrix.asformat(form))
        np.testing.assert_array_equal(read_npz(tmp_path / "theirs.npz").toarray(), held_beam.stiffness)
    scipy.io.hb_write(tmp_path / "theirs.rua", sp.csc_array(matrix))
    np.testing.assert_allclose(
        read_harwell_boeing(tmp_path / "theirs.rua").matrix.toarray(), held_beam.stiffness, rtol=1e-15
    )


MARKET = "%%MatrixMarket matrix coordinate real symmetric\n% a comment\n3 3 4\n1 1 2.0\n2 2 2.0\n3 3 2.0\n2 1 -1.0\n"


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("%%MatrixMarket", "%MatrixMarket", 1, "must begin with %%MatrixMarket"),
        ("real", "complex", 1, "must have the type real or integer or double"),
        ("symmetric", "hermitian", 1, "must have the symmetry general or symmetric"),
        ("coordinate", "table", 1, "must have the layout coordinate or array"),
        ("3 3 4", "3 3", 3, "must be 3 whole numbers"),
        ("3 3 4", "3 2 4", 3, "must be square"),
        ("3 3 4", "3 3 5", 7, "ends early: 4 of 5 lines of entries"),
        ("3 3 4", "3 3 3", 7, "stands after the last of the entries"),
        ("3 3 4", "3 3 -4", 3, "not negative"),
        ("3 3 4", "300000000 300000000 4", 3, "number of rows = 300000000: must fit the 4 entries"),
        ("3 3 2.0", "4 3 2.0", 6, r"row and column = \(4, 3\): must lie between 1 and 3"),
        ("3 3 2.0", "0 3 2.0", 6, r"row and column = \(0, 3\): must lie between 1 and 3"),
        ("3 3 2.0", "3 3 nan", 6, "matrix entry = nan: must be finite"),
        ("3 3 2.0", "3 3", 6, "must have 3 numbers"),
        ("3 3 2.0", "3 3.5 2.0", 6, "3.5: must be a whole number"),
        ("3 3 2.0", "3 3 two", 6, "must be numbers"),
    ],
)
def test_matrix_market_faults(write, old, new, line, message):
    with pytest.raises(InputError, match=message) as raised:
        read_matrix_market(write("a.mtx", MARKET.replace(old, new, 1)))
    assert raised.value.place.line == line


def test_npz_faults(tmp_path):
    np.savez(tmp_path / "a.npz", something=np.ones(3))
    with pytest.raises(InputError, match=r"a.npz: does not hold a sparse matrix \(KeyError"):
        read_npz(tmp_path / "a.npz")
    sp.save_npz(tmp_path / "b.npz", sp.csr_array(np.ones((2, 3))))
    with pytest.raises(InputError, match=r"matrix = \(2, 3\): must be square"):
        read_npz(tmp_path / "b.npz")
    sp.save_npz(tmp_path / "c.npz", sp.csr_array(np.eye(2) * 1j))
    with pytest.raises(InputError, match="entries are complex128"):
        read_npz(tmp_path / "c.npz")
    good = {"format": np.array(b"csr"), "shape": np.array([3, 3]), "data": np.ones(3)}
    np.savez(tmp_path / "d.npz", **good, indices=np.array([0, 1, 700000]), indptr=np.array([0, 1, 2, 3]))
    with pytest.raises(InputError, match="does not hold a sparse matrix"):
        read_npz(tmp_path / "d.npz")
    (tmp_path / "e.npz").write_bytes((tmp_path / "d.npz").read_bytes()[:200])
    with pytest.raises(InputError, match="cannot be read as an npz archive"):
        read_npz(tmp_path / "e.npz")
    np.savez(tmp_path / "f.npz", format=np.array([object()], dtype=object))
    with pytest.raises(InputError, match="cannot be read as an npz archive"):
        read_npz(tmp_path / "f.npz")


# --- Abaqus ---------------------------------------------------------------------------------------

# Two nodes with x and z; node 1 is held along x by 1e36, node -1 is inside an element and comes last.
ABAQUS_K = """** STIFFNESS MATRIX
1,1, 1,1,  1.000000000000000e+36
1,3, 1,3,  2.000000000000000e+00
2,1, 2,1,  5.0D0
2,3, 1,3, -1.000000000000000e+00
2,3, 2,3,  2.000000000000000e+00
-1,7, -1,7, 4.0
-1,7, 2,1, 1.0
"""
ABAQUS_M = "1,1, 1,1, 3.0\n1,3, 1,3, 3.0\n2,1, 2,1, 3.0\n2,3, 2,3, 3.0\n"


def test_abaqus_by_hand(write):
    model = read_matrices(write("j_STIF1.mtx", ABAQUS_K), write("j_MASS1.mtx", ABAQUS_M))
    assert model.dofs.names == ((1, "z"), (2, "x"), (2, "z"), (-1, "warp"))
    assert model.held.names == ((1, "x"),)
    assert model.stiffness.toarray().tolist() == [[2, 0, -1, 0], [0, 5, 0, 1], [-1, 0, 2, 0], [0, 1, 0, 4]]
    assert model.mass.toarray().tolist() == [[3, 0, 0, 0], [0, 3, 0, 0], [0, 0, 3, 0], [0, 0, 0, 0]]


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("2,1, 2,1,  5.0D0", "2,1, 2,1", 4, "must have 5 numbers"),
        ("2,1, 2,1,  5.0D0", "2,1, 2,1, x", 4, "must be numbers"),
        ("2,1, 2,1,  5.0D0", "2,1, 2,1.5, 5.0", 4, "1.5: must be a whole number"),
        ("2,1, 2,1,  5.0D0", "2,0, 2,1, 5.0", 4, "must name nodes other than 0 and d.o.f. from 1"),
        ("2,1, 2,1,  5.0D0", "2,1, 2,1, nan", 4, "matrix entry = nan: must be finite"),
        (
            "1,1, 1,1,",
            "1, 1,1, 1,1,",
            2,
            "is a matrix by elements, which is not supported. Leave out ELEMENT BY ELEMENT",
        ),
    ],
)
def test_abaqus_faults(write, old, new, line, message):
    path = write("j_STIF1.mtx", ABAQUS_K.replace(old, new, 1))
    with pytest.raises(InputError, match=message) as raised:
        read_matrices(path, write("j_MASS1.mtx", ABAQUS_M))
    assert (raised.value.place.file, raised.value.place.line) == (str(path), line)


# --- Ansys ----------------------------------------------------------------------------------------

# Laid out as HBMAT does: one number to a line, lower triangle, a load vector.
ANSYS_K = """Stiffness matrix from ANSYS FULL file dumped into Harwell-Boeing format
            17             4             5             5             3
RSA                        3             3             5             0
(I14)           (I14)           (d25.15)            (d25.15)
F                          1             3
             1
             4
             5
             6
             1
             2
             3
             2
             3
    0.400000000000000D+01
   -0.100000000000000D+01
   -0.200000000000000D+01
    0.300000000000000D+01
    0.500000000000000D+01
    0.000000000000000D+00
   -0.981000000000000D+01
    0.700000000000000-105
"""
ANSYS_MAP = """    Matrix Eqn          Node    DOF
             1            50    UY
             2            50    ROTZ
             3         10001    TEMP
"""


def test_ansys_by_hand(write, tmp_path):
    path = write("K.matrix", ANSYS_K)
    content = read_harwell_boeing(path)
    assert content.matrix.toarray().tolist() == [[4, -1, -2], [-1, 3, 0], [-2, 0, 5]]
    assert content.right_hand_sides.tolist() == [[0.0], [-9.81], [7e-106]]
    assert content.title.startswith("Stiffness matrix from ANSYS FULL file")
    write("K.mapping", ANSYS_MAP)
    model = read_matrices(path, path)  # the mapping file is found beside it
    assert model.dofs.names == ((50, "y"), (50, "rz"), (10001, "temp"))


def test_harwell_boeing_in_fixed_columns(write):
    """Several numbers to a line that touch each other; all entries (RUA); a blank title."""
    text = (
        " \n             4             1             1             2\n"
        "RUA                        2             2             4             0\n"
        "(10I3)          (10I2)          (1P,3E12.4)         \n"
        "  1  3  5\n 1 2 1 2\n  2.0000E+00 -1.0000E+00 -1.0000E+00\n  2.0000E+00\n"
    )
    assert read_harwell_boeing(write("K.rua", text)).matrix.toarray().tolist() == [[2, -1], [-1, 2]]
    touching = text.replace("  2.0000E+00 -1.0000E+00 -1.0000E+00", " 22.0000E+00-11.0000E+00-11.0000E+00")
    assert read_harwell_boeing(write("K.rua", touching)).matrix.toarray().tolist() == [[22, -11], [-11, 2]]


@pytest.mark.parametrize(
    ("old", "new", "line", "message"),
    [
        ("RSA", "CSA", 3, "is not a supported type; RSA and RUA are"),
        ("RSA", "RSAX", 3, "must be a type and four numbers"),
        ("3             3             5", "3             4             5", 3, "must be square"),
        (
            "3             3             5",
            "9999999       9999999       5",
            3,
            "number of rows = 9999999: must fit",
        ),
        ("17             4", "17             5", 2, "must announce 4 lines of column pointers"),
        ("(I14)           (I14)", "(I14)           (X14)", 4, "must be Fortran formats"),
        ("F                 ", "M                 ", 5, "must be F and the number of right-hand sides"),
        (
            "             4\n             5\n             6",
            "             4\n             5\n             7",
            6,
            "rise from 1 to 6",
        ),
        (
            "             4\n             5\n",
            "             5\n             4\n",
            6,
            "must have column pointers that rise",
        ),
        (
            "             3\n             2\n",
            "             9\n             2\n",
            17,
            r"row and column = \(9, 1\)",
        ),
        ("0.400000000000000D+01", "0.40000000x000000D+01", 15, r"must be numbers \(values\)"),
        ("0.400000000000000D+01", "NaN", 15, "matrix entry = nan: must be finite"),
        ("   -0.981000000000000D+01\n", "", 21, "ends early: 2 of 3 lines of right-hand sides"),
    ],
)
def test_ansys_faults(write, old, new, line, message):
    assert old in ANSYS_K
    with pytest.raises(InputError, match=message) as raised:
        read_harwell_boeing(write("K.matrix", ANSYS_K.replace(old, new, 1)))
    assert (
        abs(raised.value.place.line - line) <= 3
    )  # of numbers that belong together the first or the last is shown


# --- tables ---------------------------------------------------------------------------------------


def test_coordinates_and_sets(write):
    text = (
        '# of the bridge\nnode;x;y;z\n3; 1.0; 2.0; -3e-1; track; "left rail"\n\n1, 0, 0, 0\n2 5 6 7 track\n'
    )
    table = read_coordinates(write("nodes.csv", text.replace('"left rail"', '"left"')))
    assert table.labels.tolist() == [1, 2, 3]
    assert table.points_of([3, 2]).tolist() == [[1.0, 2.0, -0.3], [5.0, 6.0, 7.0]]
    assert sorted(table.nodes_of_set("track").tolist()) == [2, 3]
    assert table.nodes_of_set("left").tolist() == [3]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("node,x,y,z\n1,0,0\n", ":2: '1,0,0': must be a node and three coordinates: 12, 3.5, 0.0, 1.2"),
        ("1,0,0,0\n1,1,0,0\n", ":2: '1,1,0,0': is a node that stands there already"),
        ("1,0,0,nan\n", ":1: .*must be a node and three coordinates"),
        ("1,0,0,1e20\n", "Coordinates are finite and at most 1e[+]09 m"),
        ("1,0,0,0\n1.5,0,0,0\n", r":2: .*must have a whole number \(node\)"),
        ("node,x,y,z\n", "has no nodes"),
    ],
)
def test_faults_of_coordinates(write, text, message):
    with pytest.raises(InputError, match=message):
        read_coordinates(write("nodes.csv", text))


def test_components_of_other_programs(write):
    text = "2 7 UX\n1 7 ROTY\n3 8 6\n4 8 U3\n5 9 dy\n6 9 PRES\n"
    dofs = read_dof_map(write("map.txt", text))
    assert dofs.names == ((7, "ry"), (7, "x"), (8, "rz"), (8, "z"), (9, "y"), (9, "pres"))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("row,node,component\n1,7\n", ":2: '1,7': must be a row, a node and a component"),
        ("1,7,x\n1,7,y\n", ":2: '1,7,y': repeats row 1"),
        ("1,7,x\n2,7,ux\n", ":2: '2,7,ux': repeats d.o.f. 7.x"),
        ("0,7,x\n", "must count rows from 1"),
        ("1,7,x\n3,7,y\n", r"d.o.f. map, row = 2: is missing"),
        ("row,node,component\n", "has no rows"),
    ],
)
def test_faults_of_dof_maps(write, text, message):
    with pytest.raises(InputError, match=message):
        read_dof_map(write("map.csv", text))


# --- modes ----------------------------------------------------------------------------------------


def test_modal_models_as_csv_and_npz(write, tmp_path):
    frequencies = write("f.csv", "mode,frequency,mass,ratio\n1,4.78,28787.5,0.01\n2,19.1,28787.5,0.02\n")
    shapes = write("s.csv", "node,component,1,2\n1,z,0.0,0.0\n2,z,1.0,0.0\n3,z,0.0,-1.0\n")
    nodes = write("n.csv", "1,0,0,0\n2,12.5,0,0\n3,18.75,0,0\n")
    model = read_modal(frequencies, shapes, coordinates=nodes)
    assert model.frequencies.tolist() == [4.78, 19.1]
    assert model.damping_ratios.tolist() == [0.01, 0.02]
    assert model.shapes.tolist() == [[0, 0], [1, 0], [0, -1]]
    assert model.dofs.names == ((1, "z"), (2, "z"), (3, "z"))
    write_modal(model, tmp_path / "modes.npz")
    back = read_modal(tmp_path / "modes.npz", coordinates=nodes)
    for name in ("frequencies", "masses", "shapes", "damping_ratios"):
        np.testing.assert_array_equal(getattr(back, name), getattr(model, name))
    assert back.dofs.names == model.dofs.names


@pytest.mark.parametrize(
    ("frequencies", "shapes", "message"),
    [
        ("1,4.78\n", "1,z,1\n", r"f.csv:1: '1,4.78': must be a mode, its frequency"),
        ("2,4.78,1\n", "1,z,1\n", "f.csv:1: .*must be mode 1"),
        ("1,x,1\n", "1,z,1\n", "f.csv: has no modes|f.csv:1"),
        ("1,4.78,0\n", "1,z,1\n", "masses = 0.0: must be positive"),
        ("1,4.78,1\n", "1,z,1,2\n", "s.csv:1: .*must be a node, a component and 1 numbers"),
        ("1,4.78,1\n", "1,z,1\n1,uz,1\n", "s.csv: d.o.f. = '1.z': occurs twice"),
    ],
)
def test_faults_of_modal_models(write, frequencies, shapes, message):
    with pytest.raises(InputError, match=message):
        read_modal(write("f.csv", frequencies), write("s.csv", shapes))


def test_what_modal_files_lack(write, tmp_path):
    with pytest.raises(InputError, match="need mode shapes"):
        read_modal(write("f.csv", "1,4.78,1\n"))
    np.savez(tmp_path / "m.npz", frequencies=np.ones(2))
    with pytest.raises(InputError, match=r"m.npz: array = 'masses': is missing"):
        read_modal(tmp_path / "m.npz")
    arrays = {
        "frequencies": np.ones(1),
        "masses": np.ones(1),
        "nodes": np.array([1]),
        "components": np.array(["z"]),
    }
    np.savez(tmp_path / "c.npz", **arrays, shapes=np.ones((1, 1)) * 1j)
    with pytest.raises(InputError, match=r"shapes: must be real. Export undamped"):
        read_modal(tmp_path / "c.npz")


# --- all together ---------------------------------------------------------------------------------


def test_matrices_that_do_not_belong_together(held_beam, tmp_path, write):
    paths, dofs, _nodes = files_of(held_beam, tmp_path, "matrix-market")
    with pytest.raises(InputError, match=r"matrices: need a d\.o\.f\. map"):
        read_matrices(paths["K"], paths["M"])
    with pytest.raises(InputError, match=r"mass: must name its d\.o\.f\., as the other matrices do"):
        write_abaqus(sp.csr_array(held_beam.stiffness), tmp_path / "K1.mtx", held_beam.dofs)
        read_matrices(tmp_path / "K1.mtx", paths["M"])
    with pytest.raises(InputError, match="dofs: is not needed"):
        read_matrices(tmp_path / "K1.mtx", tmp_path / "K1.mtx", dofs=dofs)
    short = write("short.mtx", MARKET)
    with pytest.raises(
        InputError, match=r"short.mtx: mass = 3: must have as many rows as there are d.o.f., 30"
    ):
        read_matrices(paths["K"], short, dofs=dofs)
    with pytest.raises(InputError, match=r"nodes1.csv: node = 102: has no coordinates"):
        read_matrices(paths["K"], paths["M"], dofs=dofs, coordinates=write("nodes1.csv", "101,0,0,0\n"))
    with pytest.raises(InputError, match=r"format = 'nastran': must be one of matrix-market"):
        read_matrices(paths["K"], paths["M"], dofs=dofs, format="nastran")
    with pytest.raises(InputError, match=r"odd.txt:1: is not a matrix file that is known"):
        read_matrices(write("odd.txt", "hello\n"), paths["M"], dofs=dofs)
    negative = write("neg.mtx", MARKET.replace("1 1 2.0", "1 1 -2.0"))
    map3 = write("map3.csv", "1,1,z\n2,2,z\n3,3,z\n")
    with pytest.raises(
        InputError, match=r"neg.mtx: stiffness of 1.z = -2.0: must not be negative on the diagonal"
    ):
        read_matrices(negative, short, dofs=map3)


def test_writers_say_what_they_cannot_write(tmp_path):
    matrix = sp.csr_array(np.eye(2))
    with pytest.raises(InputError, match="component = 'volt': has no number in Abaqus"):
        write_abaqus(matrix, tmp_path / "a.mtx", DofMap(np.array([1, 2]), ("z", "volt")))
    with pytest.raises(
        InputError, match=r"layout = 'matrix-input': must be 'matrix-input' with a d\.o\.f\. map"
    ):
        write_abaqus(matrix, tmp_path / "a.mtx")
    with pytest.raises(InputError, match=r"right_hand_side = \(3,\): must have 2 numbers"):
        write_harwell_boeing(matrix, tmp_path / "a.matrix", right_hand_side=np.ones(3))


def test_tables_there_and_back(tmp_path):
    table = NodeTable(
        np.array([5, 2]), np.array([[0.1, 0.2, 1.0 / 3.0], [1e-9, 2.0, 3.0]]), {"a": np.array([2])}
    )
    write_coordinates(table, tmp_path / "n.csv")
    back = read_coordinates(tmp_path / "n.csv")
    np.testing.assert_array_equal(back.points, table.points)
    assert back.nodes_of_set("a").tolist() == [2]
    modal = ModalModel(np.array([1.0]), np.array([2.0]), np.ones((1, 1)), DofMap(np.array([5]), ("z",)))
    write_modal(modal, tmp_path / "m.npz")
    assert read_modal(tmp_path / "m.npz").damping_ratios is None
