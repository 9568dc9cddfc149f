"""The library: every entry against what its source says, and files of a user's own."""

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.study.case_train import KINDS
from axlespan.vehicles import library, load_trains, sprung_mass
from axlespan.vehicles.library import trains
from axlespan.vehicles.mode_words import vehicle_modes

G = 9.81
VEHICLES = [name for name in library.names() if library.entry(name).kind == "vehicle"]


def axle_loads(vehicle):
    positions = np.array([point.behind for point in vehicle.contacts])
    forces = vehicle.static_forces()
    return np.array([forces[positions == x].sum() for x in np.unique(positions)])


@pytest.mark.parametrize("name", VEHICLES)
def test_what_the_source_states_is_what_comes_out(name):
    entry = library.entry(name)
    vehicle, stated = entry.model, entry.stated
    assert axle_loads(vehicle).sum() == pytest.approx(vehicle.total_mass * G)
    if stated.axle_loads:
        loads = axle_loads(vehicle)
        each = np.broadcast_to(stated.axle_loads, loads.shape)
        np.testing.assert_allclose(loads, each, rtol=stated.tolerance)
    if stated.total_mass:
        assert vehicle.total_mass == pytest.approx(stated.total_mass, rel=stated.tolerance)
    for frequency in stated.frequencies:
        assert np.min(np.abs(vehicle.frequencies() / frequency - 1.0)) < stated.tolerance


@pytest.mark.parametrize("name", VEHICLES)
def test_every_number_has_a_source(name):
    entry = library.entry(name)
    assert all(value.origin is not None for value in entry.values)
    assert entry.group in ("rail", "road")
    modes = vehicle_modes(entry.model)
    np.testing.assert_allclose([mode.frequency for mode in modes], entry.model.frequencies(), rtol=1e-12)


def test_names_are_no_kinds_of_vehicles_and_no_load_trains():
    assert not set(library.names()) & ({*KINDS.names} | {*load_trains.names()})


class TestPublishedLoads:
    def test_ice3(self):
        train = library.train("ice3")
        loads = train.static_forces().reshape(8, 4)
        np.testing.assert_allclose(loads[[0, 1, 2, 5, 6, 7]], 152.06e3, rtol=1e-4)
        np.testing.assert_allclose(loads[[3, 4]], 135.87e3, rtol=1e-4)
        expected = 24.775 * np.arange(8)[:, None] + np.array([0.0, 2.5, 17.375, 19.875])
        np.testing.assert_allclose(train.offsets, expected.ravel())
        assert train.offsets[-1] == pytest.approx(193.3)

    def test_shinkansen(self):
        np.testing.assert_allclose(axle_loads(library.vehicle("shinkansen-s300")), 134.8e3, rtol=1e-3)
        assert library.vehicle("shinkansen-s300").total_mass == pytest.approx(54950.0)

    def test_hs20(self):
        loads = axle_loads(library.vehicle("hs20-3d"))
        np.testing.assert_allclose(loads, [35.6e3, 142.3e3, 142.3e3], rtol=2e-3)

    def test_n12(self):
        vehicle = library.vehicle("yang-yau")
        assert 2 * np.pi * vehicle.frequencies()[0] == pytest.approx(16.66, abs=5e-3)

    @pytest.mark.parametrize(("name", "tonnes"), [("traxx", 84.0), ("br189", 85.2), ("truck-2a3", 40.0)])
    def test_masses_that_such_vehicles_have(self, name, tonnes):
        assert library.vehicle(name).total_mass == pytest.approx(1e3 * tonnes)


def test_modes_in_words():
    words = [mode.description for mode in vehicle_modes(library.vehicle("ice3-heavy"))]
    assert words[:4] == [
        "body bounce",
        "body pitch",
        "bogie1 and bogie2 bounce",
        "bogie1 and bogie2 bounce, opposed",
    ]
    assert vehicle_modes(library.vehicle("ice-3d-motor"))[0].description == "body roll"
    bounce = vehicle_modes(library.vehicle("yang-yau"))[0]
    assert (bounce.description, bounce.damping_ratio) == ("body bounce", 0.0)
    damped = vehicle_modes(sprung_mass(mass=2e3, stiffness=3e5, damping=4e3))[0]
    assert damped.damping_ratio == pytest.approx(4e3 / (2 * np.sqrt(3e5 * 2e3)))


class TestTrains:
    def test_vehicles_follow_at_their_pitch(self):
        train = library.train("shinkansen-s300", 3)
        np.testing.assert_allclose(train.offsets[::4], [0.0, 25.0, 50.0])

    def test_several_trains(self):
        train = library.train("ice3", 2)
        np.testing.assert_allclose(train.offsets[32:] - train.offsets[:32], 8 * 24.775)
        assert library.train("ice3", 2, 210.0).offsets[32] == pytest.approx(210.0)

    def test_a_pitch_that_is_not_known_must_be_given(self):
        with pytest.raises(InputError, match="spacing: is needed for several of 'manchester'"):
            library.train("manchester", 2)
        assert library.train("manchester", 2, 24.0).offsets[4] == 24.0

    def test_counts(self):
        for wrong in (0, 1.5, True):
            with pytest.raises(InputError, match=r"count = .*: must be a whole number"):
                library.train("ice3", wrong)

    def test_names(self):
        with pytest.raises(
            InputError, match=r"'ice-3': is not a known vehicle of the library\. Did you mean"
        ):
            library.entry("ice-3")
        with pytest.raises(
            InputError, match=r"'ice3': is a train of several vehicles\. Its vehicles are ice3-heavy"
        ):
            library.vehicle("ice3")


WAGON = """\
title: My wagon
sources:
  sheet: Data sheet of the maker
  guess: {text: assumed, check: true}
source: sheet
pitch: 12 m
bodies:
  - {name: body, mass: 30 t, inertia: {value: 400 t m^2, source: guess, note: slender}, position: 4.5 m}
wheels:
  - {mass: 1.5 t, positions: [0 m, 9 m]}
suspensions:
  - {between: [[body, wheel1], [body, wheel2]], stiffness: 2 MN/m, damping: 20 kNs/m}
"""


@pytest.fixture
def wagon(tmp_path):
    """Write the wagon with pieces of its text replaced; its path."""

    def write(*edits, name="wagon.yaml"):
        text = WAGON
        for old, new in edits:
            assert old in text
            text = text.replace(old, new, 1)
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write


class TestOwnFiles:
    def test_a_wagon(self, wagon):
        entry = library.load(wagon())
        np.testing.assert_allclose(axle_loads(entry.model), (15e3 + 1.5e3) * G)
        pitch, bounce = 4.5 * np.sqrt(4e6 / 4e5), np.sqrt(4e6 / 3e4)
        np.testing.assert_allclose(2 * np.pi * entry.model.frequencies(), sorted([pitch, bounce]), rtol=1e-9)
        inertia = next(value for value in entry.values if value.path == "bodies.body.inertia")
        assert (inertia.written, inertia.origin.text, inertia.note, inertia.check) == (
            "400 t m^2",
            "assumed",
            "slender",
            True,
        )
        mass = next(value for value in entry.values if value.path == "bodies.body.mass")
        assert (mass.origin.text, mass.check) == ("Data sheet of the maker", False)
        assert (entry.name, entry.kind, entry.pitch, entry.to_check) == ("wagon", "vehicle", 12.0, True)

    def test_a_train_of_ones_own_and_of_the_library(self, wagon, tmp_path):
        wagon()
        path = tmp_path / "train.yaml"
        path.write_text(
            "title: Freight\nvehicles: [{vehicle: traxx}, {vehicle: wagon.yaml, count: 2}, {vehicle: wagon.yaml}]\n"
        )
        entry = library.load(path)
        assert entry.kind == "train"
        assert [group.count for group in entry.groups] == [1, 2, 1]
        assert entry.pitch == pytest.approx(18.95 + 3 * 12.0)

    @pytest.mark.parametrize("loco_first", [True, False])
    def test_different_vehicles_stand_buffer_to_buffer(self, wagon, tmp_path, loco_first):
        """Of the locomotive 3 m are ahead of its first wheel, of the wagon 1 m: 18.95 and 12 m over buffers."""
        wagon(("pitch: 12 m", "pitch: 12 m\nlength: 12 m\noverhang: 1 m"))
        names = ["{vehicle: traxx}", "{vehicle: wagon.yaml, count: 2}"]
        path = tmp_path / "train.yaml"
        path.write_text(f"title: F\nvehicles: [{', '.join(names if loco_first else names[::-1])}]\n")
        entry = library.load(path)
        train = trains.train_of(entry)
        train.require_apart()
        fronts = [item.behind - item.vehicle.front_overhang for item in train.placements]
        lengths = [18.95, 12.0] if loco_first else [12.0, 12.0]
        np.testing.assert_allclose(np.diff(fronts), lengths)
        assert entry.pitch == pytest.approx(18.95 + 2 * 12.0)

    def test_a_spacing_that_is_given_holds(self, wagon, tmp_path):
        wagon(("pitch: 12 m", "pitch: 12 m\nlength: 12 m\noverhang: 1 m"))
        path = tmp_path / "train.yaml"
        path.write_text("title: F\nvehicles: [{vehicle: traxx, spacing: 20 m}, {vehicle: wagon.yaml}]\n")
        assert trains.train_of(library.load(path)).placements[1].behind == 20.0

    def test_loads_in_the_file(self, wagon):
        still, loaded = (
            library.load(wagon(*edits)).model
            for edits in (
                [],
                [("pitch: 12 m\n", "pitch: 12 m\nloads: [{body: body, z: -10 kN, pitch: 9 kNm}]\n")],
            )
        )
        np.testing.assert_allclose(loaded.static_forces() - still.static_forces(), [6e3, 4e3], rtol=1e-9)

    def test_anchors_and_merges(self, wagon):
        """``*k`` is the same number; ``<<`` brings in what the mapping does not have."""
        edit = (
            "  - {between: [[body, wheel1], [body, wheel2]], stiffness: 2 MN/m, damping: 20 kNs/m}",
            "  - &s {between: [body, wheel1], stiffness: 2 MN/m, damping: 20 kNs/m}\n"
            "  - {<<: *s, between: [body, wheel2]}",
        )
        plain, merged = library.load(wagon()).model, library.load(wagon(edit)).model
        np.testing.assert_array_equal(merged.system.stiffness.toarray(), plain.system.stiffness.toarray())

    @pytest.mark.parametrize(
        ("old", "new", "message"),
        [
            ("400 t m^2,", "-400 t m^2,", r"wagon\.yaml:8:47: bodies\.0\.inertia\.value = '-400 t m\^2': must be positive"),
            ("30 t,", "0 t,", r"wagon\.yaml:8:24: bodies\.0\.mass = '0 t': must be positive"),
            ("30 t,", "30 kN,", r"wagon\.yaml:8:24: bodies\.0\.mass = '30 kN': must be a mass; 'kN' is a force"),
            ("body, wheel2]]", "body, wheel3]]", r"wagon\.yaml:12:15: .*'wheel3': is not a known body or wheel"),
            ("position: 4.5 m", "position: 12 m", r"wagon\.yaml:8:3: wheel '1' of .* must press on the line"),
            ("position: 4.5 m", "positon: 4.5 m", r"wagon\.yaml:8:89: bodies\.0\.positon: .* Did you mean 'position'"),
            (", [body, wheel2]]", "]", r"wagon\.yaml:12:3: suspensions: must stand on its wheels"),
            ("name: body", "name: wheel1", r"bodies = 'wheel1': is the name of more than one"),
            ("title: My wagon\n", "", r"wagon\.yaml:1:1: title: is missing"),
            ("pitch: 12 m", "pitch: 12 m\npitch: 13 m", r"wagon\.yaml:7:1: pitch: is given twice; the first is in line 6"),
            ("pitch: 12 m", "pitch: -12 m", r"wagon\.yaml:6:8: pitch = '-12 m': must be positive"),
            ("note: slender", "note: slender, long", r"Put a text that has a comma in quotes"),
            ("positions: [0 m, 9 m]", "positions: [1 m, 9 m]", "must have its first wheel at 0"),
            ("[[body, wheel1], [body, wheel2]]", "[body]", "must be two names, or a list of such pairs"),
            ("pitch: 12 m", "length: 8 m", r"wagon\.yaml:6:9: length = '8 m': must be at least 9 m"),
            ("pitch: 12 m", "length: 12 m\noverhang: 5 m", r"wagon\.yaml:7:11: overhang = '5 m': must be between 0 and 3 m"),
            ("pitch: 12 m", "overhang: 1 m", r"wagon\.yaml:6:11: overhang = '1 m': needs a length"),
            ("pitch: 12 m", "stated: {axle_loads: 160 kN, tolerance: -1 %}", "tolerance = '-1 %': must be positive"),
            (
                "  - {mass: 1.5 t, positions: [0 m, 9 m]}",
                "  - {mass: 1.5 t, position: 0 m}\n  - {mass: 1.5 t, position: 9 m, gauge: 1.5 m, roll_inertia: 90 kg m^2}",
                r"wagon\.yaml:10:5: wheels\.0\.gauge: is missing: other wheels have one",
            ),
            ("pitch: 12 m", "notes: &n [*n]", "is nested too deeply|found undefined alias"),
            ("pitch: 12 m", "<<: 3", r"wagon\.yaml:6:1: <<: must be followed by one alias of a mapping"),
            ("title: My wagon", "title: [", r"wagon\.yaml:2:1: is no YAML|wagon\.yaml:\d+:\d+: is no YAML"),
        ],
    )  # fmt: skip
    def test_errors(self, wagon, old, new, message):
        with pytest.raises(InputError, match=message):
            library.load(wagon((old, new)))

    def test_aliases_that_grow_without_end(self, wagon):
        lines = "".join(f"n{i}: &n{i} [{', '.join([f'*n{i - 1}'] * 10)}]\n" for i in range(1, 9))
        with pytest.raises(InputError, match="has too many values"):
            library.load(wagon(("pitch: 12 m\n", f"n0: &n0 [x]\n{lines}")))

    def test_files_that_are_not_there(self, tmp_path):
        with pytest.raises(InputError, match=r"none\.yaml: no such file"):
            library.load(tmp_path / "none.yaml")
        path = tmp_path / "train.yaml"
        path.write_text("title: T\nvehicles: [{vehicle: nobody.yaml}]\n")
        with pytest.raises(InputError, match=r"train\.yaml:2:22: .*'nobody\.yaml': no such file"):
            library.load(path)
        path.write_text("title: T\nvehicles: [{vehicle: train.yaml}]\n")
        with pytest.raises(InputError, match=r"train\.yaml:2:22: .* is a train that names itself"):
            library.load(path)
        path.write_text("title: T\nvehicles: [{vehicle: icee3}]\n")
        with pytest.raises(
            InputError, match=r"train\.yaml:2:22: vehicles\.0\.vehicle = 'icee3': .* Did you mean 'ice3'"
        ):
            library.load(path)
