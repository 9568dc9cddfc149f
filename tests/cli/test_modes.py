"""``axlespan modes`` and ``axlespan run --paraview``: what is printed, written and refused."""

import json
from xml.etree import ElementTree

import numpy as np
import pytest
from typer.testing import CliRunner

from axlespan.cli.app import app

CASE = """\
title: Footbridge
structure: {kind: simple-span, length: 20 m, youngs_modulus: 30 GPa, second_moment: 0.1 m^4,
            mass_per_length: 4 t/m, elements: 12, damping: {kind: modal, ratio: 1 %}}
train: [{vehicle: axle-loads, loads: [100 kN, 100 kN], spacings: [3 m]}]
crossing: {speed: 20 m/s}
analysis: {time_step: 5 ms, steps: 250}
output: {sensors: {mid: 10 m}}
"""


@pytest.fixture
def case(tmp_path):
    """Write a case file with pieces of its text replaced."""

    def write(*edits):
        text = CASE
        for old, new in edits:
            assert old in text
            text = text.replace(old, new)
        path = tmp_path / "footbridge.yaml"
        path.write_text(text, encoding="utf-8")
        return str(path)

    return write


def axlespan(*words):
    result = CliRunner().invoke(app, list(words))
    assert result.exception is None or isinstance(result.exception, SystemExit), result.exception
    return result.exit_code, result.stdout, result.stderr


def test_the_table(case):
    code, out, err = axlespan("modes", case(), "-n", "4")
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert lines[0] == "Footbridge"
    assert lines[1] == "  simple span, 24 free d.o.f., mass 80 t along z"
    assert lines[3].split() == [
        "mode",
        "f",
        "[Hz]",
        "T",
        "[s]",
        "damping",
        "mass",
        "[t]",
        "Γ",
        "z",
        "m",
        "z",
        "Σm",
        "z",
    ]
    rows = [line.split() for line in lines[4:8]]
    assert lines[8] == "" and len(lines) == 10
    n = np.arange(1, 5)
    exact = n**2 * np.pi / 2 / 20.0**2 * np.sqrt(3e10 * 0.1 / 4e3)
    assert [int(row[0]) for row in rows] == [1, 2, 3, 4]
    assert [float(row[1]) for row in rows] == pytest.approx(exact, rel=1e-3)
    assert {row[3] + row[4] for row in rows} == {"1%"}
    assert [float(row[7]) for row in rows] == pytest.approx([81.06, 0.0, 9.01, 0.0], abs=0.02)
    assert float(rows[2][9]) == pytest.approx(90.07, abs=0.03)


def test_what_is_written(case, tmp_path):
    folder = tmp_path / "out"
    code, out, _ = axlespan("modes", case(), "-o", str(folder))
    assert code == 0
    assert out.splitlines()[-1] == f"Written to {folder}: modes.json, modes.vtu, modes.png"
    content = json.loads((folder / "modes.json").read_text(encoding="utf-8"))
    assert content["total_mass_kg"] == pytest.approx({"z": 80000.0})
    assert len(content["modes"]) == 10
    first = content["modes"][0]
    assert first["modal_mass_kg"] == pytest.approx(40000.0, rel=1e-3)
    assert first["damping_ratio"] == pytest.approx(0.01)
    assert first["period_s"] == pytest.approx(1.0 / first["frequency_Hz"])
    along = first["directions"]["z"]
    assert along["participation_factor"] == pytest.approx(4.0 / np.pi, rel=1e-3)
    assert along["effective_mass_kg"] == pytest.approx(80000.0 * along["effective_mass_ratio"])
    assert content["modes"][-1]["directions"]["z"]["cumulative_mass_ratio"] > 0.95
    assert (folder / "modes.png").read_bytes()[:4] == b"\x89PNG"
    root = ElementTree.parse(folder / "modes.vtu").getroot()
    assert len(root.findall("UnstructuredGrid/Piece/PointData/DataArray")) == 10


@pytest.mark.parametrize(
    ("words", "edits", "said"),
    [
        (("-n", "100"), (), "--number = 100: must be at most 24, the number of modes that there are"),
        ((), (("20 m,", "20 kg,"),), "structure.length = 20 kg: must be a length"),
        ((), (("title: Footbridge", "vary: {crossing.speed: [20 m/s]}"),), "is a study, not a case"),
    ],
)
def test_refusals(case, words, edits, said):
    code, out, err = axlespan("modes", case(*edits), *words)
    assert (code, out) == (2, "")
    assert said in err


def test_a_full_folder_is_kept(case, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "thesis.txt").write_text("mine")
    code, _, err = axlespan("modes", case(), "-o", str(tmp_path / "out"))
    assert code == 2 and "exists already and is not empty" in err
    assert axlespan("modes", case(), "-n", "2", "-o", str(tmp_path / "out"), "--force")[0] == 0
    assert (tmp_path / "out" / "thesis.txt").read_text() == "mine"


def test_run_for_paraview(case, tmp_path):
    """Fields are spread over the run where the case asks for none, and those asked for are taken."""
    for fields, count in (("", 126), (", fields: [0.5 s, 1 s]", 2)):
        folder = tmp_path / f"out{count}"
        edit = ("{sensors: {mid: 10 m}}", f"{{sensors: {{mid: 10 m}}{fields}}}")
        code, _, err = axlespan("run", case(edit), "-o", str(folder), "--paraview", "--no-figures")
        assert (code, err) == (0, "")
        assert "fields.pvd" in json.loads((folder / "summary.json").read_text(encoding="utf-8"))["files"]
        entries = ElementTree.parse(folder / "fields.pvd").getroot().findall("Collection/DataSet")
        assert len(entries) == 2 * count
        assert all((folder / entry.get("file")).is_file() for entry in entries)


def test_run_with_section_forces_and_envelopes(case, tmp_path):
    import h5py

    edit = ("{mid: 10 m}}", "{mid: 10 m}, section_forces: [mid], envelopes: [moment, deflection]}")
    code, _, err = axlespan("run", case(edit), "-o", str(tmp_path / "out"), "--no-figures")
    assert (code, err) == (0, "")
    with h5py.File(tmp_path / "out" / "result.nc") as file:
        moment = file["section_moment"][:, 0]
        # two axles 3 m apart: static maximum in the middle P (L - 3) / 2, times the dynamic amplification
        static = 100e3 * (20.0 - 3.0) / 2.0
        assert 0.98 * static < moment.max() < 1.6 * static
        largest = file["envelope_moment_largest"][:]
        # the element before the node says the same, but for the damping of the modes, which no element knows
        assert largest[6] == pytest.approx(moment.max(), rel=3e-5)
        assert file["station"][:] == pytest.approx(np.linspace(0.0, 20.0, 13))
