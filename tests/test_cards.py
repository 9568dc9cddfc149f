"""How models, vehicles, trains, crossings and results show themselves in a terminal and in a notebook."""

from __future__ import annotations

import re

import numpy as np
import pytest

import axlespan as asp
from axlespan.card import Card, some


@pytest.fixture(scope="module")
def bridge():
    return asp.bridges.simple_span(
        length=25.0, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=50
    )


@pytest.fixture(scope="module")
def train():
    return asp.Train.of(asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6), count=3, spacing=10.0)


def test_a_crossing_and_its_result(bridge, train):
    crossing = asp.Crossing(bridge, train, speed=100.0 / 3.6)
    shown = repr(crossing)
    assert "simple span, 0 to 25 m" in shown
    assert "100 km/h" in shown
    # The step that it names works as written, and the last wheel is off the bridge at the end.
    (line,) = re.findall(r"next: (.*)", shown)
    result = eval(line, {"asp": asp, "crossing": crossing})
    assert result.contact_position[-1].min() > 25.0
    assert "contact forces" in repr(result)
    assert f"{result.contact_force.max() / 1e3:.6g} kN, 3 wheels" in repr(result)
    (at,) = re.findall(r"next: (.*), result.to_xarray", repr(result))
    assert np.array_equal(eval(at, {"result": result}), result.contact_force[:, 0])


def test_weights_and_frequencies(train, bridge):
    assert "169.222 kN" in repr(train)  # 3 × 5750 kg × 9.81 m/s²
    assert "20 m from the first to the last" in repr(train)
    vehicle = train.placements[0].vehicle
    assert f"{np.sqrt(1.595e6 / 5750.0) / (2.0 * np.pi):.3g} Hz" in repr(vehicle)
    assert "z 57.575 t" in repr(bridge)  # 25 m × 2303 kg/m
    assert "51; x 0 to 25 m" in repr(bridge.model)


def test_a_notebook_gets_a_table(bridge, train):
    for thing in (
        bridge,
        bridge.model,
        train,
        train.placements[0].vehicle,
        asp.Crossing(bridge, train, speed=9.0),
    ):
        page = thing._repr_html_()
        assert page.count("<tr>") == page.count("</tr>") == len(thing.card().facts)


def test_a_bar_counts_the_steps(bridge, train, capsys):
    crossing = asp.Crossing(bridge, train, speed=30.0)
    asp.simulate(crossing, time_step=1e-3, steps=40, progress=True)
    assert "40/40 steps" in capsys.readouterr().out
    asp.simulate(crossing, time_step=1e-3, steps=40, progress=False)
    assert capsys.readouterr().out == ""
    seen = []
    asp.simulate(crossing, time_step=1e-3, steps=40, progress=seen.append)
    assert seen[-1] == 40


def test_text_is_escaped():
    page = Card("a < b", [("x", "<script>")], "f('&')").html()
    assert "<script>" not in page
    assert "a &lt; b" in page
    assert "&amp;" in page


def test_long_lists_are_cut():
    assert some(["a", "b"]) == "a, b"
    assert some([]) == "none"
    assert some([str(i) for i in range(9)]) == "0, 1, 2, 3, 4, 5, … (9)"


def test_a_study_and_its_next_steps(tmp_path):
    case = {
        "structure": {"kind": "simple-span", "length": 25, "youngs_modulus": "2.87 GPa",
                      "second_moment": "2.9 m^4", "mass_per_length": 2303, "elements": 10},
        "train": [{"vehicle": "axle-loads", "loads": "100 kN"}],
        "crossing": {"speed": "80 km/h"},
        "analysis": {"time_step": "10 ms"},
    }  # fmt: skip
    study = asp.Study(
        case, {"crossing.speed": ["80 km/h", "90 km/h"]}, passage={"after": "1 s"}, title="<Two>"
    )
    assert "scenarios  2" in repr(study) and "crossing.speed (2)" in repr(study)
    assert "&lt;Two&gt;" in study._repr_html_()
    (line,) = re.findall(r"next: (.*)", repr(study))
    assert line == 'study.run("folder")'
    study.run(tmp_path / "folder")
    assert "next: study.table(), study.answers()" in repr(study)
    assert len(study.table()) == 2
