"""The pieces of case files on the page about trains make cases that can be built."""

import re
from pathlib import Path

import pytest
from ruamel.yaml import YAML

from axlespan.study import read_case
from axlespan.study.build import build

PAGE = (Path(__file__).parents[2] / "docs" / "trains.md").read_text(encoding="utf-8")
BASE = """\
structure: {kind: simple-span, length: 25 m, youngs_modulus: 34 GPa, second_moment: 0.9 m^4, mass_per_length: 12 t/m, elements: 9}
train: [{vehicle: hslm-a1}]
crossing: {speed: 100 km/h}
analysis: {time_step: 1 ms, duration: 7 s}
"""
PIECES = re.findall(r"^```yaml\n(.*?)^```", PAGE, flags=re.DOTALL | re.MULTILINE)
(AXLES,) = re.findall(r"^```text\n(.*?)^```", PAGE, flags=re.DOTALL | re.MULTILINE)


def test_there_are_pieces():
    assert len(PIECES) >= 7


@pytest.mark.parametrize("piece", PIECES, ids=range(len(PIECES)))
def test_piece(piece, tmp_path):
    (tmp_path / "axles.csv").write_text(AXLES, encoding="utf-8")
    own = YAML(typ="safe", pure=True).load(piece)
    rest = "".join(f"{line}\n" for line in BASE.splitlines() if line.split(":")[0] not in own)
    case = build(read_case(piece + rest, folder=tmp_path))
    assert len(case.crossing.runs) == 1 + len(own.get("other_trains", ()))
    if "analysis" in own:
        assert case.crossing.train.name.endswith("as moving masses")


def test_vehicles_are_numbered_on():
    piece = next(piece for piece in PIECES if "other_trains" in piece)
    text = piece + "".join(
        f"{line}\n" for line in BASE.splitlines() if line.split(":")[0] in ("structure", "analysis")
    )
    crossing = build(read_case(text)).crossing
    assert [run.first for run in crossing.runs] == [0, 8, 9]
