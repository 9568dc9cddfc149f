"""The pieces of case files on the page about trains make cases that can be built."""

import re
from pathlib import Path

import numpy as np
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
AXLES, SPECTRUM = re.findall(r"^```text\n(.*?)^```", PAGE, flags=re.DOTALL | re.MULTILINE)


def test_there_are_pieces():
    assert len(PIECES) >= 7


@pytest.mark.parametrize("piece", PIECES, ids=range(len(PIECES)))
def test_piece(piece, tmp_path):
    (tmp_path / "axles.csv").write_text(AXLES, encoding="utf-8")
    (tmp_path / "spectrum.csv").write_text(SPECTRUM, encoding="utf-8")
    own = YAML(typ="safe", pure=True).load(piece)
    rest = "".join(f"{line}\n" for line in BASE.splitlines() if line.split(":")[0] not in own)
    case = build(read_case(piece + rest, folder=tmp_path))
    assert len(case.crossing.runs) == 1 + len(own.get("other_trains", ()))
    if "analysis" in own:
        assert case.crossing.train.name.endswith("as moving masses")


def test_the_spectrum_of_the_page_is_realized(tmp_path):
    """Its realization has the variance of the three points, straight in a double logarithmic plot."""
    (tmp_path / "spectrum.csv").write_text(SPECTRUM, encoding="utf-8")
    piece = next(piece for piece in PIECES if "spectrum.csv" in piece).replace(
        ", from: -60 m, to: 90 m, taper: 20 m", ""
    )
    rest = "".join(f"{line}\n" for line in BASE.splitlines() if not line.startswith("crossing"))
    (profile,) = set(build(read_case(piece + rest, folder=tmp_path)).crossing.runs[0].profiles)
    n, density = np.array([0.01, 0.1, 0.5]), 1e-6 * np.array([120.0, 1.5, 0.03])
    slope = np.diff(np.log(density)) / np.diff(np.log(n)) + 1.0
    variance = np.sum(np.diff(density * n) / slope)
    x = np.arange(0.0, 2000.0, 0.25)
    assert np.std(profile.value(x)) == pytest.approx(np.sqrt(variance), rel=0.02)


def test_vehicles_are_numbered_on():
    piece = next(piece for piece in PIECES if "other_trains" in piece)
    text = piece + "".join(
        f"{line}\n" for line in BASE.splitlines() if line.split(":")[0] in ("structure", "analysis")
    )
    crossing = build(read_case(text)).crossing
    assert [run.first for run in crossing.runs] == [0, 8, 9]
