"""Damaged files of every kind: the outcome is a sound mesh or model, or one InputError that names the file."""

import random

import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp

from axlespan.errors import InputError
from axlespan.io.matrices import (
    DofMap,
    MatrixModel,
    ModalModel,
    NodeTable,
    read_matrices,
    read_modal,
    write_abaqus,
    write_coordinates,
    write_dof_map,
    write_harwell_boeing,
    write_matrix_market,
    write_modal,
    write_npz,
)
from axlespan.io.meshes import read_mesh, write_gmsh
from axlespan.model.mesh import Mesh

INP = """*HEADING
 two spans
*PART, NAME=P
*NODE, NSET=ALL
 1, 0., 0., 0.
 2, 1., 0., 0.
 3, 1., 1., 0.
 4, 0., 1., 0.
*ELEMENT, TYPE=S4R, ELSET=DECK
 10, 1, 2, 3, 4
*ELEMENT, TYPE=B31, ELSET=EDGE
 20, 1, 2
*NSET, NSET=LEFT, GENERATE
 1, 4, 3
*ELSET, ELSET=BOTH
 DECK, EDGE
*NSET, NSET=OF_DECK, ELSET=DECK
*END PART
*ASSEMBLY, NAME=A
*INSTANCE, NAME=P-1, PART=P
 0., 0., 1.
 0., 0., 0., 0., 0., 1., 90.
*END INSTANCE
*INSTANCE, NAME=P-2, PART=P
*END INSTANCE
*NSET, NSET=SUP, INSTANCE=P-1
 1, 2
*NSET, NSET=TIPS
 P-2.1, P-2.LEFT, SUP
*END ASSEMBLY
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Sound files of every kind."""
    folder = tmp_path_factory.mktemp("sound")
    mesh = (
        Mesh.box((3, 2, 1), (2, 1, 1))
        .merged(Mesh.line((0, 0, 0), (1, 0, 0), 2))
        .with_node_set("support", [0, 1])
    )
    write_gmsh(mesh, folder / "41.msh")
    write_gmsh(mesh, folder / "22.msh", version="2.2")
    (folder / "parts.inp").write_text(INP)
    stiffness = sp.csr_array(sp.diags_array([[2.0] * 8, [-1.0] * 7, [-1.0] * 7], offsets=[0, 1, -1]))
    mass = sp.csr_array(sp.eye_array(8) * 3.0)
    dofs = DofMap(np.repeat([1, 2, 3, 4], 2), ("x", "z") * 4)
    write_matrix_market(stiffness, folder / "K.mtx")
    write_matrix_market(mass, folder / "M.mtx")
    write_npz(stiffness, folder / "K.npz")
    write_abaqus(stiffness, folder / "K_STIF1.mtx", dofs)
    write_abaqus(mass, folder / "M_MASS1.mtx", dofs)
    write_abaqus(stiffness, folder / "K_rows.mtx", layout="coordinate")
    write_harwell_boeing(stiffness, folder / "K.matrix", dofs=dofs, right_hand_side=np.arange(8.0))
    scipy.io.hb_write(folder / "K.rua", sp.csc_array(stiffness))
    write_dof_map(dofs, folder / "dofs.csv")
    write_coordinates(
        NodeTable(np.arange(1, 5), np.arange(12.0).reshape(4, 3), {"a": np.array([1])}), folder / "nodes.csv"
    )
    modes = ModalModel(np.array([1.0, 2.0]), np.ones(2), np.arange(16.0).reshape(8, 2), dofs)
    write_modal(modes, folder / "modes.npz")
    (folder / "f.csv").write_text("mode,f,m,ratio\n1,1.0,2.0,0.01\n2,3.0,2.0,0.02\n")
    (folder / "s.csv").write_text("node,component,1,2\n1,z,0.5,1\n2,z,1,0.5\n3,z,0.5,-1\n")
    meshlane = pytest.importorskip("meshlane")
    for name, form in (("41b.msh", "gmsh"), ("22b.msh", "gmsh22")):
        meshlane.write(folder / name, meshlane.read(folder / "41.msh", "gmsh"), file_format=form, binary=True)
    return folder


def matrices(mass="M.mtx", dofs="dofs.csv", coordinates=None):
    """Read a stiffness file with sound files beside it."""

    def _read(path, folder):
        beside = {"dofs": None if dofs is None else folder / dofs}
        return read_matrices(path, folder / mass, coordinates=coordinates and folder / coordinates, **beside)

    return _read


def mesh(path, folder):
    return read_mesh(path)


READERS = {
    **dict.fromkeys(("41.msh", "22.msh", "41b.msh", "22b.msh", "parts.inp"), mesh),
    **dict.fromkeys(("K.mtx", "K_rows.mtx", "K.rua"), matrices()),
    "K.npz": matrices(coordinates="nodes.csv"),
    "K_STIF1.mtx": matrices("M_MASS1.mtx", None),
    "K.matrix": matrices(dofs="K.mapping"),
    "M.mtx": lambda path, folder: read_matrices(folder / "K.mtx", path, dofs=folder / "dofs.csv"),
    "K.mapping": lambda path, folder: read_matrices(folder / "K.mtx", folder / "M.mtx", dofs=path),
    "dofs.csv": lambda path, folder: read_matrices(folder / "K.mtx", folder / "M.mtx", dofs=path),
    "nodes.csv": lambda path, folder: read_matrices(
        folder / "K.mtx", folder / "M.mtx", dofs=folder / "dofs.csv", coordinates=path
    ),
    "modes.npz": lambda path, folder: read_modal(path),
    "f.csv": lambda path, folder: read_modal(path, folder / "s.csv"),
    "s.csv": lambda path, folder: read_modal(folder / "f.csv", path),
}


def sound(outcome):
    """Whether what came out holds together."""
    if isinstance(outcome, Mesh):
        used = all(block.nodes.max(initial=-1) < outcome.n_node for block in outcome.blocks)
        return (
            used
            and bool(np.isfinite(outcome.points).all())
            and len(set(outcome.node_labels.tolist())) == outcome.n_node
        )
    if isinstance(outcome, MatrixModel):
        size = len(outcome.dofs)
        return outcome.stiffness.shape == outcome.mass.shape == (size, size) and bool(
            np.isfinite(outcome.stiffness.data).all()
        )
    return outcome.shapes.shape == (len(outcome.dofs), outcome.n_mode)


def damaged(data, chance):
    """A copy with a piece cut off or out, bytes flipped or replaced, or something strange put in."""
    copy, way = bytearray(data), chance.randrange(5)
    spot = chance.randrange(len(copy))
    if way == 0:
        del copy[spot:]
    elif way == 1:
        for _ in range(chance.randrange(1, 4)):
            copy[chance.randrange(len(copy))] ^= 1 << chance.randrange(8)
    elif way == 2:
        for _ in range(chance.randrange(1, 4)):
            copy[chance.randrange(len(copy))] = chance.choice(b"0123456789.-+eE ,\n*$")
    elif way == 3:
        del copy[spot : spot + chance.randrange(1, 40)]
    else:
        strange = (
            b"9999999999999999999",
            b"nan",
            b"inf",
            b"1e400",
            b"-1",
            b"\n",
            b"\0",
            b"1e300",
            b"\xff",
            b",",
        )
        copy[spot:spot] = chance.choice(strange)
    return bytes(copy)


@pytest.mark.parametrize("name", list(READERS))
def test_sound_files_are_read(folder, name):
    assert sound(READERS[name](folder / name, folder))


@pytest.mark.parametrize("name", list(READERS))
def test_damage_ends_in_a_sound_outcome_or_in_one_error(folder, tmp_path, name):
    data, path = (folder / name).read_bytes(), tmp_path / name
    chance, refused = random.Random(f"axlespan {name}"), 0
    for _ in range(150):
        path.write_bytes(damaged(data, chance))
        try:
            assert sound(READERS[name](path, folder))
        except InputError as error:
            refused += 1
            assert error.place is not None
    assert refused > 50  # damage is mostly seen


@pytest.mark.parametrize("name", list(READERS))
def test_a_file_cut_at_any_line_is_one_error_or_sound(folder, tmp_path, name):
    data, path = (folder / name).read_bytes(), tmp_path / name
    for cut in range(0, len(data), max(1, len(data) // 40)):
        path.write_bytes(data[:cut])
        try:
            assert sound(READERS[name](path, folder))
        except InputError as error:
            assert str(path) in str(error) or "missing" in str(error) or error.place is not None


SAYS = "must |is not |has no |cannot |ends early"
GARBAGE = random.Random(5).randbytes(3000)


@pytest.mark.parametrize("name", list(READERS))
@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "is empty"),
        (b" \n\n\t\n", "is empty"),
        (GARBAGE, SAYS),
        (b"\0" * 100, SAYS),
        (b"hello\nworld\n", SAYS),
    ],
    ids=["empty", "blank", "garbage", "zeros", "prose"],
)
def test_what_is_no_such_file_at_all(folder, tmp_path, name, content, message):
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(InputError, match=message) as raised:
        READERS[name](path, folder)
    assert raised.value.place is not None
    assert raised.value.place.file == str(path)


@pytest.mark.parametrize("name", list(READERS))
def test_a_missing_file_and_a_folder(folder, tmp_path, name):
    with pytest.raises(InputError, match=r"does not exist. Check the path"):
        READERS[name](tmp_path / name, folder)
    (tmp_path / name).mkdir()
    with pytest.raises(InputError, match="cannot be read: Is a directory"):
        READERS[name](tmp_path / name, folder)


@pytest.mark.parametrize(
    ("name", "other", "message"),
    [
        ("parts.inp", "mesh.msh", r"must begin with \$MeshFormat to be a Gmsh file"),
        (
            "K.mtx",
            "mesh.inp",
            r"must begin with a keyword such as \*HEADING or \*NODE to be an Abaqus input file",
        ),
        ("K.npz", "mesh.inp", "is not a text file"),
    ],
)
def test_a_wrong_extension(folder, tmp_path, name, other, message):
    path = tmp_path / other
    path.write_bytes((folder / name).read_bytes())
    with pytest.raises(InputError, match=message):
        read_mesh(path)
