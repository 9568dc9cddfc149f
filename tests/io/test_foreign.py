"""Meshes through meshlane: formats of others, damaged files, files on which it would never end."""

import time

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.io.meshes import foreign, read_mesh
from axlespan.model.mesh import Mesh

meshlane = pytest.importorskip("meshlane")

NAMES = {
    **{"hex8": "hexahedron", "hex20": "hexahedron20", "tet4": "tetra", "tet10": "tetra10", "wedge6": "wedge"},
    **{"quad4": "quad", "tri3": "triangle", "line2": "line"},
}


def written(mesh, path, **options):
    blocks = [(NAMES[block.kind], block.nodes) for block in mesh.blocks]
    meshlane.write(path, meshlane.Mesh(mesh.points, blocks, **options))
    return path


@pytest.mark.parametrize("extension", [".vtu", ".vtk", ".bdf", ".med"])
def test_formats_of_others(tmp_path, extension):
    mesh = Mesh.box((2.0, 1.0, 1.0), (2, 1, 1))
    back = read_mesh(written(mesh, tmp_path / f"mesh{extension}"))
    np.testing.assert_allclose(back.points, mesh.points, atol=1e-12)
    np.testing.assert_array_equal(back.blocks[0].nodes, mesh.blocks[0].nodes)


def test_quadratic_and_mixed_elements(tmp_path):
    mesh = Mesh.box((2.0, 1.0, 1.0), (2, 1, 1)).quadratic()
    back = read_mesh(written(mesh, tmp_path / "mesh.vtu"))
    np.testing.assert_array_equal(back.blocks[0].nodes, mesh.blocks[0].nodes)
    mixed = Mesh.rectangle((2.0, 1.0), (2, 1), kind="tri3").merged(Mesh.line((0, 0, 1.0), (2.0, 0, 1.0), 2))
    back = read_mesh(written(mixed, tmp_path / "mesh.vtu"))
    assert [(block.kind, len(block)) for block in back.blocks] == [("tri3", 4), ("line2", 2)]


@pytest.mark.parametrize("extension", [".med", ".cdb"])
def test_sets_come_along(tmp_path, extension):
    mesh = Mesh.box((2.0, 1.0, 1.0), (2, 1, 1))
    sets = {"point_sets": {"left": np.array([0, 3])}, "cell_sets": {"second": [np.array([1])]}}
    back = read_mesh(written(mesh, tmp_path / f"mesh{extension}", **sets))
    assert back.nodes_of_set("left").tolist() == [0, 3]
    assert [(block, own.tolist()) for block, own in back.elements_of_set("second")] == [(0, [1])]


def test_numbers_of_elements_become_sets(tmp_path):
    mesh = Mesh.box((3.0, 1.0, 1.0), (3, 1, 1))
    path = written(mesh, tmp_path / "mesh.mesh", cell_data={"medit:ref": [np.array([4, 7, 4])]})
    assert [own.tolist() for _, own in read_mesh(path).elements_of_set("medit:ref-4")] == [[0, 2]]


def test_elements_that_are_not_supported_are_named(tmp_path):
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1.0]], float)
    meshlane.write(tmp_path / "mesh.vtu", meshlane.Mesh(points, [("pyramid", np.array([[0, 1, 2, 3, 4]]))]))
    with pytest.raises(InputError, match=r"'pyramid' \(1 element\): is not a supported element type"):
        read_mesh(tmp_path / "mesh.vtu")


def test_damage_is_one_error_and_the_interpreter_lives(tmp_path):
    path = written(Mesh.box((2.0, 1.0, 1.0), (2, 1, 1)), tmp_path / "mesh.vtu")
    path.write_bytes(path.read_bytes()[:300])
    with pytest.raises(InputError, match=r"mesh.vtu: cannot be read as a mesh"):
        read_mesh(path)


def test_a_reader_that_never_ends_is_given_up(tmp_path):
    """meshlane's OFF reader loops for ever on a file that ends in its comments."""
    path = tmp_path / "mesh.off"
    path.write_text("OFF\n# only a comment\n")
    start = time.perf_counter()
    with pytest.raises(InputError, match=r"could not be read within 3 s"):
        foreign.read_with_meshlane(path, timeout=3.0)
    assert time.perf_counter() - start < 10.0


def test_an_extension_that_nobody_knows(tmp_path):
    path = tmp_path / "mesh.xyz"
    path.write_text("1 2 3\n")
    with pytest.raises(InputError, match=r"cannot be read as a mesh .*Check its format and extension"):
        read_mesh(path)


def test_without_meshlane_it_says_what_to_do(tmp_path, monkeypatch):
    path = tmp_path / "mesh.vtu"
    path.write_text("<VTKFile>")
    monkeypatch.setattr(foreign, "find_spec", lambda name: None)
    with pytest.raises(
        InputError, match=r"needs the optional package meshlane. Install it with: pip install"
    ):
        read_mesh(path)


def test_a_gmsh_file_under_another_name_is_read_as_one(tmp_path):
    path = tmp_path / "mesh.txt"
    path.write_text(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n3 1 2 3\n$EndNodes\n$Elements\n0\n$EndElements\n"
    )
    assert read_mesh(path).points.tolist() == [[1.0, 2.0, 3.0]]
