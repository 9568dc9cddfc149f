"""The pieces of case files on the pages about defects and measured profiles make cases that can be built."""

import re
from pathlib import Path

import numpy as np
import pytest
from ruamel.yaml import YAML

from axlespan.study import read_case
from axlespan.study.build import build

DOCS = Path(__file__).parents[2] / "docs"
BASE = """\
structure: {kind: simple-span, length: 25 m, youngs_modulus: 34 GPa, second_moment: 0.9 m^4, mass_per_length: 12 t/m, elements: 9}
train: [{vehicle: quarter-car}]
crossing: {speed: 100 km/h}
analysis: {time_step: 1 ms, duration: 2 s}
"""
PIECES = [
    piece
    for page in ("defects.md", "measured-profile.md")
    for piece in re.findall(
        r"^```yaml\n(.*?)^```", (DOCS / page).read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE
    )
]


def test_there_are_pieces():
    assert len(PIECES) >= 6


@pytest.mark.parametrize("piece", PIECES, ids=range(len(PIECES)))
def test_piece(piece, tmp_path):
    x = np.arange(-60.0, 100.0, 0.25)
    rows = np.column_stack([x, np.sin(x)])
    np.savetxt(tmp_path / "profile.csv", rows, delimiter=";", header="x [m]; r [mm]", comments="")
    own = YAML(typ="safe", pure=True).load(piece)
    rest = "".join(f"{line}\n" for line in BASE.splitlines() if line.split(":")[0] not in own)
    (run,) = build(read_case(piece + rest, folder=tmp_path)).crossing.runs
    heights = [np.abs(profile.value(np.linspace(-30.0, 30.0, 4001))).max() for profile in run.profiles]
    assert 1e-5 < max(heights) < 0.05
