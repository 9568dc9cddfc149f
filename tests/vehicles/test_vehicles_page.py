"""The files of docs/vehicles.md: read, shown and run as they stand there."""

import re
from pathlib import Path

import numpy as np
import pytest

from axlespan.study.build import build
from axlespan.study.loader import load_case
from axlespan.vehicles import library

PAGE = (Path(__file__).parents[2] / "docs" / "vehicles.md").read_text(encoding="utf-8")
FILES = dict(re.findall(r"^```yaml\n# (\S+\.yaml)\n(.*?)^```", PAGE, flags=re.DOTALL | re.MULTILINE))
CASES = [name for name, text in FILES.items() if "structure:" in text]
G = 9.81


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with all files of the page."""
    path = tmp_path_factory.mktemp("page")
    for name, text in FILES.items():
        (path / name).write_text(text, encoding="utf-8")
    return path


def test_all_files_are_found():
    assert sorted(FILES) == sorted(
        f"{name}.yaml" for name in ("case", "wagon", "articulated", "semitrailer", "tram", "wind", "freight")
    )


def test_the_wagon(folder):
    entry = library.load(folder / "wagon.yaml")
    np.testing.assert_allclose(entry.model.static_forces(), (14e3 + 1.3e3) * G)
    assert entry.stated.axle_loads[0] == pytest.approx(
        entry.model.static_forces()[0], rel=entry.stated.tolerance
    )
    assert entry.model.length == 11.5


def test_the_articulated_train(folder):
    loads = library.load(folder / "articulated.yaml").model.static_forces() / G
    end, shared = (12e3 + 2.9e3) / 2 + 1.9e3, (24e3 + 2.9e3) / 2 + 1.9e3
    np.testing.assert_allclose(loads, [end, end, shared, shared, end, end], rtol=1e-9)


def test_the_semitrailer(folder):
    """Statically determinate: levers of the trailer, then of the tractor."""
    loads = library.load(folder / "semitrailer.yaml").model.static_forces() / G
    rear = 24e3 * (7.0 - 3.2) / (10.5 - 3.2)
    hinge = 24e3 - rear
    drive = (5e3 * 1.2 + hinge * 3.2) / 3.6
    np.testing.assert_allclose(loads, [5e3 + hinge - drive, drive, rear], rtol=1e-9)


def test_the_train(folder):
    train = library.train("traxx", 1)
    own = library.load(folder / "freight.yaml")
    assert [group.count for group in own.groups] == [1, 6]
    assert own.pitch == pytest.approx(18.95 + 6 * 11.5)
    assert len(train.contacts) == 4


@pytest.mark.parametrize("name", CASES)
def test_cases_are_in_order(folder, name):
    built = build(load_case(folder / name))
    forces = built.crossing.train.static_forces()
    if name == "wind.yaml":
        share = 15e3 * 1.9 / 1.5 / 2
        still = (6e3 + 0.9e3) * G / 2
        np.testing.assert_allclose(forces, [still - share, still + share] * 2, rtol=1e-9)
    else:
        np.testing.assert_allclose(forces, 152.055e3, rtol=1e-9)
        np.testing.assert_allclose(np.diff(built.crossing.train.offsets[::4]), 24.775)
