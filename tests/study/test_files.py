"""What is said about files that cannot be read, and about the files that a case names."""

import os
import pickle

import pytest

from axlespan.errors import InputError, Place
from axlespan.study import InputErrors, load_case, read_case
from axlespan.study.loader import LARGEST


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def said(path):
    with pytest.raises(InputError) as caught:
        load_case(path)
    return str(caught.value)


def test_a_case_file_is_read_with_its_folder(here, footbridge):
    (here / "sub").mkdir()
    (here / "sub" / "bridge.yaml").write_text(footbridge, encoding="utf-8-sig")
    loaded = load_case("sub/bridge.yaml")
    assert str(loaded.place("structure.length")) == "sub/bridge.yaml:4:11"
    assert loaded.source.text == footbridge
    assert str(loaded.folder) == "sub"


def test_no_such_file(here, footbridge):
    (here / "bridge.yaml").write_text(footbridge)
    assert said("brigde.yaml") == "brigde.yaml: no such file. Did you mean bridge.yaml?"
    assert said("other.yaml") == "other.yaml: no such file"
    assert said("no/bridge.yaml") == "no/bridge.yaml: no such file. There is no folder no"


def test_folders(here, footbridge):
    (here / "cases").mkdir()
    assert said("cases") == "cases: is a folder, not a case file. Name a case file"
    (here / "cases" / "bridge.yml").write_text(footbridge)
    assert said("cases") == "cases: is a folder, not a case file. Name a file in it, such as cases/bridge.yml"


def test_large_files_are_refused_unread(here):
    with open("large.yaml", "wb") as stream:
        stream.truncate(100_000_000)
    assert said("large.yaml") == (
        f"large.yaml: is larger than {LARGEST // 10**6} MB, the most that a case file may have. Put long tables into "
        "files of their own, as in irregularity: {kind: table, file: profile.csv}"
    )


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="no /dev/zero")
def test_files_without_end_are_refused():
    assert said("/dev/zero").startswith("/dev/zero: is larger than 5 MB")


def test_permission(here, footbridge, monkeypatch):
    def refuse(*args, **options):
        raise PermissionError(13, "Permission denied")

    (here / "bridge.yaml").write_text(footbridge)
    monkeypatch.setattr("builtins.open", refuse)
    assert said("bridge.yaml") == "bridge.yaml: cannot be read: permission denied"


@pytest.mark.parametrize(
    ("raw", "expected"),
    [
        (
            b"\x89PNG\r\n\x1a\n\0\0",
            "case.yaml: is not a text file. A case file is YAML, written with a text editor",
        ),
        ("title: x".encode("utf-16"), "case.yaml: is written in UTF-16. Save it as UTF-8"),
        (
            "title: x\nstructure: {length: 5 µm}".encode("cp1252"),
            "case.yaml:2:23: is not UTF-8: byte 0xb5, in Windows-1252 'µ'. Save it as UTF-8",
        ),
        (b"", "case.yaml: is empty. axlespan examples writes cases to begin with"),
    ],
)
def test_files_of_other_kinds(here, raw, expected):
    (here / "case.yaml").write_bytes(raw)
    assert said("case.yaml") == expected


def test_odd_names(here):
    assert said("a\0b") == "a\0b: cannot be read: embedded null byte"
    assert said("a" * 5000).endswith(": cannot be read: File name too long")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (
            "a: 25\x07 m",
            "case.yaml:1:6: a control character, U+0007, stands here. Delete it, if this is text",
        ),
        (
            "a: b\nc: \u2028",
            "case.yaml:2:4: a control character, U+2028, stands here. Delete it, if this is text",
        ),
        ("a: " + "[" * 60 + "]" * 60, "case.yaml:1:44: is nested too deeply"),
        ("a: " + "[" * 20_000, "case.yaml:1:1: is nested too deeply"),
    ],
)
def test_texts_of_odd_characters_and_depth(text, expected):
    with pytest.raises(InputError) as caught:
        read_case(text)
    assert str(caught.value) == expected


MESH = """\
structure:
  kind: mesh
  file: bridge.msh
  materials: {steel: {youngs_modulus: 210 GPa, poisson_ratio: 0.3, density: 7.85 t/m^3}}
  sections: {deck: {material: steel, thickness: 20 mm}}
  supports: [{at: bearings, fixed: [x, y, z]}]
  running_line: {from: [0 m, 0 m, 1 m], to: [25 m, 0 m, 1 m]}
"""


def test_files_are_relative_to_the_folder_of_the_case(tmp_path, with_structure):
    (tmp_path / "bridge.msh").write_text("mesh")
    mesh = with_structure(MESH, folder=tmp_path).case.structure
    assert mesh.file == tmp_path / "bridge.msh"
    assert mesh.materials["steel"].density == 7850.0
    assert mesh.running_line.to == (25.0, 0.0, 1.0)
    assert mesh.supports[0].at == "bearings"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("7.85 t/m^3", "7.85", "case.yaml:5:77: structure.materials.steel.density = 7.85: looks wrong: without a unit it is "
         "7.85 kg/m^3. Write 7.85 t/m^3; or 7.85 kg/m^3, if that is meant"),
        ("{material: steel", "{material: stell", "case.yaml:6:31: structure.sections.deck.material = stell: no such material. "
         "Did you mean steel?"),
        ("bridge.msh", "brigde.msh", "case.yaml:4:9: structure.file = brigde.msh: no such file. Did you mean bridge.msh?"),
        ("bridge.msh", ".", "case.yaml:4:9: structure.file = .: is a folder, not a file"),
        ("bridge.msh", "[]", "case.yaml:4:9: structure.file = []: must be the name of a file"),
        (", to: [25 m, 0 m, 1 m]", "",
         "case.yaml:8:17: structure.running_line = {from: [0 m, 0 m, 1 m]}: must be given by nodes, "
         "or by from and to. Write {from: [0 m, 0 m, 0 m], to: [25 m, 0 m, 0 m]}, or {nodes: rail}"),
        ("[25 m, 0 m, 1 m]", "[25 m, 0 m]",
         "case.yaml:8:45: structure.running_line.to = [25 m, 0 m]: must have exactly 3 values, "
         "not 2. Write [0 m, 0 m, 0 m]"),
    ],
)  # fmt: skip
def test_wrong_meshes(tmp_path, with_structure, old, new, expected):
    (tmp_path / "bridge.msh").write_text("mesh")
    with pytest.raises(InputError) as caught:
        with_structure(MESH.replace(old, new), folder=tmp_path)
    assert str(caught.value) == expected


def test_matrices(tmp_path, with_structure, with_train):
    for name in ("K.mtx", "M.mtx", "C.mtx"):
        (tmp_path / name).write_text("matrix")
    files = "kind: matrices, stiffness: K.mtx, mass: M.mtx"
    line = "running_line: {dofs: [0, deck.7], positions: [0 m, 5 m]}"
    given = with_structure(
        f"structure: {{{files}, damping: C.mtx, {line}}}\n", folder=tmp_path
    ).case.structure
    assert (given.damping, given.running_line.dofs) == (tmp_path / "C.mtx", ("0", "deck.7"))
    modal = with_structure(
        f"structure: {{{files}, damping: {{kind: modal, ratio: 1 %}}, {line}}}\n", folder=tmp_path
    )
    assert modal.case.structure.damping.ratio == 0.01
    wheels = "wheels: [{dof: 4, position: 0 m}, {dof: 5, position: 2.5 m}]"
    vehicle = with_train(
        f"  - {{vehicle: matrices, stiffness: K.mtx, mass: M.mtx, {wheels}}}\n", folder=tmp_path
    )
    assert [wheel.position for wheel in vehicle.case.train[0].wheels] == [0.0, 2.5]


def test_many_errors_are_kept_and_the_first_twenty_shown():
    errors = InputErrors(InputError(f"slip {n}", place=Place("a.yaml", n)) for n in range(30, 0, -1))
    assert (len(errors.errors), errors.rule, errors.place) == (30, "slip 1", Place("a.yaml", 1))
    lines = str(errors).splitlines()
    assert (lines[0], lines[19], lines[20]) == ("a.yaml:1: slip 1", "a.yaml:20: slip 20", "... and 10 more")
    assert pickle.loads(pickle.dumps(errors)).errors[29].rule == "slip 30"
    assert (
        str(InputErrors([InputError("x"), errors.errors[0]]).located(Place("b"), "f"))
        == "b: f: x\na.yaml:1: f: slip 1"
    )
