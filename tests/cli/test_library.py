"""``axlespan library``: the list, one entry, a copy to change, and what is refused."""

import json

import pytest


def test_the_list_names_everything(axlespan):
    code, out, err = axlespan("library")
    assert (code, err) == (0, "")
    for head in (
        "Rail vehicles",
        "Road vehicles",
        "Trains of vehicles",
        "Load trains",
        "Spectra",
        "Track values",
    ):
        assert head in out
    row = next(line for line in out.splitlines() if line.strip().startswith("ice3-heavy "))
    assert row.split()[:5] == ["ice3-heavy", "2-D", "62", "152.1", "0.804-10.5"]
    assert "german-low" in out
    assert "hslm-a1 " in out
    assert "zhai-2004" in out
    assert max(len(line) for line in out.splitlines()) < 260


def test_one_vehicle(axlespan):
    code, out, _ = axlespan("library", "shinkansen-s300")
    lines = out.splitlines()
    assert code == 0
    assert "mass 54.95 t" in lines[2]
    rail = next(line for line in lines if line.count("O") == 4)
    assert [i for i, sign in enumerate(rail) if sign == "O"] == [2, 11, 68, 77]
    assert "     1                     0    134.765" in lines
    assert "  0.7229   32.7 %  body bounce" in lines
    assert any(line.split()[:3] == ["suspensions.primary.stiffness", "1.18", "MN/m"] for line in lines)
    assert "  table: Wu and Yang (2003), as in TTB-2D" in lines


def test_what_comes_out_stands_beside_what_the_source_states(axlespan):
    out = axlespan("library", "hs20-3d").out
    assert "     1                     0    35.5406  stated: 35.6 kN (-0.17 %)" in out.splitlines()
    assert "  2.651 Hz, stated: 2.651 Hz (-0.01 %)" in axlespan("library", "yang-yau").out.splitlines()


def test_a_train_shows_its_vehicles(axlespan):
    lines = axlespan("library", "ice3").out.splitlines()
    numbers, rail = lines[4:6]
    assert numbers.split() == [str(i) for i in range(1, 9)]
    assert len(rail.strip()) == 100
    for load in ("152.055", "135.869"):
        assert any(line.split() == ["4", "19.875", load] for line in lines)
    assert sum("body bounce" in line for line in lines) == 2


def test_what_is_to_be_checked_is_marked(axlespan):
    out = axlespan("library", "hs20-3d").out
    assert "check against the source before relying on it" in out
    assert "printed as roll inertia; corrected" in out
    assert "check against" not in axlespan("library", "manchester").out


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("ice3", "8 vehicles, 32 wheels, mass 482.8 t, 193.3 m from first wheel to last"),
        ("hslm-a1", "50 axles, 8500 kN, 397.525 m from first axle to last"),
        ("german-low", "2.863 mm"),
        ("zhai-2004", "pad_stiffness         1.3e+08"),
    ],
)
def test_other_entries(axlespan, name, text):
    code, out, err = axlespan("library", name)
    assert (code, err) == (0, "")
    assert text in out


def test_a_copy_runs_as_it_is_and_as_it_is_changed(axlespan, case, tmp_path):
    copied = tmp_path / "my.yaml"
    assert axlespan("library", "ice3-light", "--copy", copied).code == 0
    own = case(("sprung-mass\n    mass: 5750 kg\n    stiffness: 1595 kN/m", "my.yaml\n    count: 2"))
    assert "135.87, 135.87, 135.87, 135.87 kN" in axlespan("check", own).out
    copied.write_text(copied.read_text().replace("41200 kg", "45.2 t"))
    assert "145.68, 145.68, 145.68, 145.68 kN" in axlespan("check", own).out
    code, _, err = axlespan("run", own, "-o", tmp_path / "out", "--no-figures")
    assert (code, err) == (0, "")
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert summary["outcome"]["code"] == "completed"


def test_cross_wind_from_the_case(axlespan, case):
    vehicle = "ice-3d-motor\n    loads: [{body: body, y: -60 kN, height: 2.4 m}]"
    blown = case(
        ("sprung-mass\n    mass: 5750 kg\n    stiffness: 1595 kN/m", vehicle),
        ("speed: 80 km/h", "speed: 80 km/h\n  lines: {left: main, right: main}"),
    )
    share = 60.0 * 2.4 / 1.5 / 4  # [kN] on each of four wheels
    out = axlespan("check", blown).out
    assert f"static wheel loads {78.48 - share:.5g}, {78.48 + share:.5g}" in out


def test_a_car_in_space_written_out_in_the_case(axlespan, case):
    car = """multibody
    bodies: [{name: body, mass: 1 t, inertia: 1.5 t m^2, roll_inertia: 0.6 t m^2, position: 1.5 m, height: 0.5 m}]
    wheels: [{position: 0 m, gauge: 1.6 m, mass: 50 kg, independent: true}, {position: 3 m, gauge: 1.6 m}]
    suspensions:
      - {between: [body, wheel1], stiffness: 20 kN/m, spread: 1.6 m, roll_stiffness: 10 kNm/rad}
      - {between: [body, wheel2], stiffness: 20 kN/m, spread: 1.6 m}
    loads: [{body: body, y: 2 kN}]"""
    written = case(
        ("sprung-mass\n    mass: 5750 kg\n    stiffness: 1595 kN/m", car),
        ("speed: 80 km/h", "speed: 80 km/h\n  lines: {left: main, right: main}"),
    )
    out = axlespan("check", written).out
    loads = out.split("static wheel loads ")[1].split(" kN")[0]
    left, right, rear_left, rear_right = (float(load) for load in loads.split(", "))
    assert left + right == pytest.approx(4.905 + 0.981, abs=1e-3)
    assert rear_left + rear_right == pytest.approx(4.905, abs=1e-3)
    assert (left - right) + (rear_left - rear_right) == pytest.approx(2.0 * 2.0 * 0.5 / 1.6, abs=1e-3)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("icee3",), "Did you mean 'ice3'"),
        (("none.yaml",), "none.yaml: no such file"),
        (("hslm-a1", "--copy", "x.yaml"), "only vehicles and trains have files"),
        (("--copy", "x.yaml"), "needs the name of a vehicle"),
    ],
)
def test_refusals(axlespan, words, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, err = axlespan("library", *words)
    assert (code, out) == (2, "")
    assert message in err
    assert not (tmp_path / "x.yaml").exists()


def test_a_copy_replaces_nothing(axlespan, tmp_path):
    target = tmp_path / "my.yaml"
    target.write_text("mine")
    code, _, err = axlespan("library", "ice3-heavy", "--copy", target)
    assert code == 2
    assert "exists already. Use --force to replace it" in err
    assert target.read_text() == "mine"
    assert axlespan("library", "ice3-heavy", "--copy", target, "--force").code == 0
    assert target.read_text().startswith("title: ICE 3")


def test_a_vehicle_in_space_on_one_line_is_told_what_to_write(axlespan, case):
    spatial = case(("sprung-mass\n    mass: 5750 kg\n    stiffness: 1595 kN/m", "car-7dof"))
    code, _, err = axlespan("check", spatial)
    assert code == 2
    assert "case.yaml:10:14: train.0.vehicle = car-7dof: has left and right wheels" in err
    assert "lines: {left: main, right: main}" in err
