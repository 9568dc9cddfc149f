"""What is said about meshes and matrices that are wrong: whole messages.

The files in ``wrong_imports/`` hold what to change in a right case or in its files (``---`` a piece of it, ``+++`` what
takes its place; both may go on for several lines) and all that is said then (``>>>``, one line for each error).
"""

import re
from pathlib import Path

import numpy as np
import pytest

import axlespan as asp
from axlespan.errors import InputError
from axlespan.io.matrices import DofMap, NodeTable, write_coordinates, write_dof_map, write_matrix_market
from axlespan.model.compile import compile_model
from axlespan.study import read_case
from axlespan.study.build import build

FOLDER = Path(__file__).parent / "wrong_imports"
PIECE = re.compile(r"^(===|---|\+\+\+|>>>) ?(.*?)(?=^(?:===|---|\+\+\+|>>>)(?: |$)|\Z)", re.M | re.S)


def wrong_cases(name):
    title, old, edits, said = "", "", [], []
    for mark, text in [*PIECE.findall((FOLDER / name).read_text(encoding="utf-8")), ("===", "")]:
        text = text.removesuffix("\n")
        if mark == "===":
            if said:
                yield pytest.param(edits, "\n".join(said), id=title)
            title, edits, said = text, [], []
        elif mark == "---":
            old = text
        elif mark == "+++":
            edits.append((old, text))
        else:
            said.append(text.rstrip("\n"))


def complaint(texts, edits, folder):
    """Change the texts of files, write them, and build the case among them."""
    for old, new in edits:
        name = next((name for name, text in texts.items() if old in text), None)
        assert name, f"{old!r} is in no file"
        texts = {**texts, name: texts[name].replace(old, new, 1)}
    for name, text in texts.items():
        (folder / name).write_text(text)
    with pytest.raises(InputError) as caught:
        build(read_case(texts["case.yaml"], folder=folder))
    return str(caught.value).replace(f"{folder}/", "")


REST = """\
train:
  - {vehicle: sprung-mass, mass: 5750 kg, stiffness: 1595 kN/m}
crossing: {speed: 90 km/h}
analysis: {time_step: 2 ms, steps: 300}
"""

DECK = """\
*NODE
1, 0, 0, 0
2, 2, 0, 0
3, 2, 1, 0
4, 0, 1, 0
5, 0, 0, 1
6, 2, 0, 1
7, 2, 1, 1
8, 0, 1, 1
9, 9, 9, 9
*ELEMENT, TYPE=C3D8, ELSET=deck
7, 1, 2, 3, 4, 5, 6, 7, 8
*NSET, NSET=base
1, 2, 3, 4
*NSET, NSET=top
5, 6
*NSET, NSET=lonely
9
"""
MESH = {
    "deck.inp": DECK,
    "case.yaml": f"""\
structure:
  kind: mesh
  file: deck.inp
  materials: {{concrete: {{youngs_modulus: 30 GPa, poisson_ratio: 0.2, density: 2500 kg/m^3}}}}
  sections: {{deck: {{material: concrete}}}}
  supports: [{{at: base, fixed: [x, y, z]}}]
  running_line: {{nodes: top}}
{REST}\
output: {{sensors: {{middle: 1 m}}}}
""",
}


@pytest.mark.parametrize(("edits", "expected"), list(wrong_cases("meshes.txt")))
def test_meshes(tmp_path, edits, expected):
    assert complaint(MESH, edits, tmp_path) == expected


def test_the_mesh_is_right_but_for_a_node(tmp_path):
    """A node without elements is worth a word; nodes at the same place are too, where nothing joins them."""
    (tmp_path / "deck.inp").write_text(DECK)
    built = build(read_case(MESH["case.yaml"], folder=tmp_path))
    assert built.warnings == ("case.yaml: structure: 1 node without elements: 9",)
    more = "9, 2, 1, 1\n10, 4, 0, 0\n11, 4, 1, 0\n12, 4, 0, 1\n13, 4, 1, 1"
    second = "8, 2, 10, 11, 3, 6, 12, 13, 9\n*NSET, NSET=base"
    (tmp_path / "deck.inp").write_text(
        DECK.replace("9, 9, 9, 9", more).replace("*NSET, NSET=base", second, 1)
    )
    built = build(read_case(MESH["case.yaml"], folder=tmp_path))
    assert built.warnings == (
        "case.yaml: structure: 1 pair of nodes at the same place that nothing joins (7, 9); merge: 1 mm joins them",
    )
    (tmp_path / "deck.inp").write_text(DECK.replace("9, 9, 9, 9\n", "9, 25000, 0, 0\n"))
    built = build(read_case(MESH["case.yaml"], folder=tmp_path))
    assert built.warnings[0] == "case.yaml: structure: the mesh is 2.5e+04 m long; is unit: m right?"


MATRICES = f"""\
structure:
  kind: matrices
  stiffness: K
  mass: M
  dofs: dofs.csv
  coordinates: nodes.csv
  supports: [{{at: 1, fixed: [x, z]}}, {{at: 9, fixed: [z]}}]
  running_line: {{nodes: deck}}
{REST}"""


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """Texts of the files of a beam of 25 m with nine nodes."""
    folder, n = tmp_path_factory.mktemp("exported"), 8
    x = np.linspace(0.0, 25.0, n + 1)
    section = asp.BeamSection(second_moment=2.90, area=5.568, mass_per_length=2303.0)
    model = asp.Model(plane=True).with_nodes(np.column_stack([x, 0.0 * x]))
    pairs = np.column_stack([np.arange(n), np.arange(1, n + 1)])
    system = compile_model(model.with_beams(pairs, section.properties(asp.Material(2.87e9)))).system
    labels = np.arange(1, n + 2)
    write_matrix_market(system.stiffness, folder / "K")
    write_matrix_market(system.mass, folder / "M")
    write_dof_map(DofMap(np.repeat(labels, 3), ("x", "z", "ry") * (n + 1)), folder / "dofs.csv")
    points = np.column_stack([x, 0.0 * x, 0.0 * x])
    write_coordinates(NodeTable(labels, points, {"deck": labels}), folder / "nodes.csv")
    return {"case.yaml": MATRICES, **{file.name: file.read_text() for file in folder.iterdir()}}


@pytest.mark.parametrize(("edits", "expected"), list(wrong_cases("matrices.txt")))
def test_matrices(exported, tmp_path, edits, expected):
    assert complaint(exported, edits, tmp_path) == expected


def test_the_galleries_are_read_as_a_whole():
    for name in ("meshes.txt", "matrices.txt"):
        titles = [case.id for case in wrong_cases(name)]
        assert len(titles) > 25
        assert len(set(titles)) == len(titles)
