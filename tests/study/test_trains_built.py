"""Trains of case files, built: consists, the library, files, forms, and several trains at once."""

import numpy as np
import pytest

import axlespan as asp
from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing, OtherTrain
from axlespan.irregularity import realize_pair
from axlespan.study.build import build
from axlespan.vehicles import Train, axle_loads, library, load_trains

WAGON = """\
title: A wagon
vehicle: rail
"""


@pytest.fixture
def built(with_train):
    """Build the case with another train; further edits are of the rest of the file."""

    def make(*entries, loader=None, **options):
        return build((loader or with_train)("".join(f"  - {entry}\n" for entry in entries), **options))

    return make


@pytest.fixture
def edited(loaded):
    """Build the case with pieces of its text replaced."""
    return lambda *edits, **options: build(loaded(*edits, **options))


def offsets(case):
    return case.crossing.train.offsets


# --- consists ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("entry", ["{vehicle: ice3}", "{vehicle: ice3, count: 8}"])
def test_the_eight_cars_of_an_ice3(built, entry):
    case = built(entry)
    first = 24.775 * np.arange(8)
    expected = np.add.outer(first, [0.0, 2.5, 17.375, 19.875]).ravel()
    np.testing.assert_allclose(offsets(case), expected, atol=1e-9)
    # 152.06 kN an axle, 135.87 kN in the middle of the train
    loads = np.repeat([152.055, 135.8685, 152.055], [12, 8, 12])
    np.testing.assert_allclose(case.crossing.train.static_forces() / 1e3, loads, rtol=1e-4)


def test_a_double_set_and_a_train_turned_round(built):
    case = built("{vehicle: ice3, count: 16}")
    assert len(case.crossing.train.placements) == 16
    single = library.train("ice3")
    turned = built("{vehicle: ice3, reversed: true}")
    np.testing.assert_allclose(offsets(turned), single.wheelbase - single.offsets[::-1], atol=1e-9)


def test_load_trains_of_the_library(built):
    case = built("{vehicle: hslm-a1}")
    np.testing.assert_array_equal(offsets(case), load_trains.hslm_a(1).offsets)
    assert case.crossing.train.name == "hslm-a1"
    case = built("{vehicle: en15528-d4, count: 3}")
    np.testing.assert_allclose(offsets(case), load_trains.en15528("d4", 3).offsets)
    case = built("{vehicle: hslm-b, forces: 15, distance: 3.5 m}")
    np.testing.assert_array_equal(offsets(case), 3.5 * np.arange(15))
    np.testing.assert_array_equal(case.crossing.train.static_forces(), 170e3)
    case = built("{vehicle: ave-s100, count: 2}")
    assert offsets(case)[26] == 200.15


def test_vehicles_of_the_library_stand_buffer_to_buffer(built):
    """Overhangs of 1.5 m and, of fatigue train 1's locomotive, 1.4 m."""
    case = built("{vehicle: en15528-d2, count: 2}", "{vehicle: en15528-a}", "{vehicle: fatigue-1}")
    d2 = 1.8 + 7.45 + 1.8
    a = 1.8 + 6.2 + 1.8
    heads = [0.0, d2 + 3.0, 2.0 * (d2 + 3.0), 2.0 * (d2 + 3.0) + a + 1.5 + 1.4]
    np.testing.assert_allclose([item.behind for item in case.crossing.train.placements], heads)


def test_own_words_for_where_they_stand(built):
    case = built("{vehicle: en15528-d2, count: 2, spacing: 20 m}", "{vehicle: en15528-a, gap: 10 m}")
    np.testing.assert_allclose(
        [p.behind for p in case.crossing.train.placements], [0.0, 20.0, 20.0 + 11.05 + 10.0]
    )


def test_a_reversed_entry(built):
    entry = "vehicle: axle-loads, loads: [100 kN, 50 kN, 20 kN], spacings: [3 m, 1 m]"
    case = built(f"{{{entry}}}", f"{{{entry}, reversed: true, gap: 4 m}}")
    np.testing.assert_allclose(offsets(case), [0, 3, 4, 8, 9, 12])
    np.testing.assert_allclose(case.crossing.train.static_forces() / 1e3, [100, 50, 20, 20, 50, 100])


def test_axles_from_a_file(built, tmp_path):
    (tmp_path / "axles.csv").write_text("position [m]; load [kN]\n1; 170\n4,5; 180\n", encoding="utf-8")
    case = built("{vehicle: axle-loads, file: axles.csv, count: 2, spacing: 8 m}", folder=tmp_path)
    np.testing.assert_allclose(offsets(case), [0.0, 3.5, 8.0, 11.5])
    np.testing.assert_allclose(case.crossing.train.static_forces(), [170e3, 180e3] * 2)


def test_a_vehicle_from_a_file(built, tmp_path):
    text = library.entry("ice3-heavy").text
    (tmp_path / "my-wagon.yaml").write_text(text, encoding="utf-8")
    case = built("{vehicle: my-wagon.yaml, count: 2}", folder=tmp_path)
    np.testing.assert_allclose(offsets(case), library.train("ice3-heavy", 2).offsets)


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        (
            ["{vehicle: ice3, count: 3}"],
            "case.yaml:11:28: train.0.count = 3: counts vehicles, and ice3 has 8. Write count: 8",
        ),
        (
            ["{vehicle: my-wagn.yaml}"],
            "case.yaml:11:15: train.0.vehicle = my-wagn.yaml: no such file. Did you mean my-wagon.yaml?",
        ),
        (["{vehicle: hslm-b, forces: 12}"], "train.0.distance: is missing: it depends on the span"),
        (
            ["{vehicle: axle-loads}"],
            "train.0.loads: is missing. Add loads: [170 kN, 170 kN], or file: axles.csv",
        ),
        (
            ["{vehicle: axle-loads, file: axles.csv, loads: 3 kN}"],
            "train.0.loads = 3 kN: says again what the file says",
        ),
        (["{vehicle: axle-loads, file: axles.csv}"], "axles.csv:3: load [kN]: is missing"),
        (
            ["{vehicle: en15528-d2, count: 2, spacing: 13 m}"],
            "train: vehicle 2 begins 13 m behind the first wheel of vehicle 1, which needs 14.05 m between buffers",
        ),
        (
            ["{vehicle: rigid-mass, mass: 5 t}", "{vehicle: rigid-mass, mass: 5 t, gap: 0 m}"],
            "train: vehicle 2 begins 0 m behind the first wheel of vehicle 1, whose last wheel is 0 m behind it",
        ),
    ],
)
def test_trains_that_are_wrong(built, tmp_path, entries, message):
    (tmp_path / "my-wagon.yaml").write_text(WAGON, encoding="utf-8")
    (tmp_path / "axles.csv").write_text("position [m]; load [kN]\n0; 170\n3;\n", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        built(*entries, folder=tmp_path)
    assert message in str(caught.value)


# --- forms -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("word", "forces", "dofs"), [("full", 0, 80), ("moving-masses", 0, 32), ("axle-loads", 32, 0)]
)
def test_one_switch(edited, blocks, word, forces, dofs):
    case = edited(
        (blocks["<train>"], "  - {vehicle: ice3}"), ("steps: 2000", f"steps: 2000\n  vehicles: {word}")
    )
    assert len(case.plan.fleet.forced) == forces
    assert case.plan.fleet.matrices.size == dofs
    loads = np.repeat([152.055, 135.8685, 152.055], [12, 8, 12])
    np.testing.assert_allclose(case.plan.fleet.weight / 1e3, loads, rtol=1e-4)


# --- several trains ----------------------------------------------------------------------------------

OTHERS = """\
other_trains:
  - train: [{vehicle: axle-loads, loads: 90 kN, spacings: [3 m]}]
    speed: 90 km/h
    acceleration: -2 m/s^2
    to_speed: 36 km/h
    direction: backward
    delay: 0.4 s
  - {train: [{vehicle: rigid-mass, mass: 3 t}], speed: 20 m/s, start: -30 m}
analysis:"""


def test_several_trains_as_in_python(edited):
    case = edited(("analysis:", OTHERS))
    assert case.crossing.contact_names == ("1.1", "2.1", "3.1", "4.1", "4.2", "5.1")
    bridge = case.crossing.structure
    python = Crossing(
        bridge,
        case.crossing.train,
        speed=80 / 3.6,
        others=[
            OtherTrain(
                train=Train.of(axle_loads(loads=[90e3, 90e3], positions=[0.0, 3.0])),
                speed=25.0,
                acceleration=-2.0,
                to_speed=10.0,
                direction="backward",
                delay=0.4,
            ),
            OtherTrain(train=Train.of(asp.vehicles.rigid_mass(mass=3e3)), speed=20.0, start=-30.0),
        ],
    )
    t = np.array([0.0, 1.0, 3.0])
    for one, other in zip(case.crossing.runs, python.runs, strict=True):
        np.testing.assert_array_equal(one.course.head(t), other.course.head(t))
        np.testing.assert_array_equal(one.train.offsets, other.train.offsets)
    assert case.crossing.runs[1].course.head(np.array(0.4)) == 25.0
    np.testing.assert_allclose(case.plan.fleet.weight[-1], 3e3 * 9.81)


@pytest.mark.parametrize(
    "kind",
    ["harmonic, amplitude: 1 mm, wavelength: 5 m, phase: 90 deg", "spectrum, name: german-low, seed: 1"],
)
def test_a_taper_fades_an_irregularity_in_and_out(edited, kind):
    whole, cut, faded = (
        edited(("80 km/h", f"80 km/h\n  irregularity: {{kind: {kind}{more}}}"))
        for more in ("", ", from: 2 m, to: 22 m", ", from: 2 m, to: 22 m, taper: 5 m")
    )
    x = np.array([1.9, 2.0, 4.5, 7.0, 12.0, 17.0, 19.5, 22.0, 22.1])
    share = [0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 0.5, 0.0, 0.0]
    plain, with_taper = (case.crossing.runs[0].profiles[0].value(x) for case in (whole, faded))
    np.testing.assert_allclose(with_taper, share * plain, atol=1e-12)
    assert any("steps by" in word for word in cut.cautions)
    assert not any("steps by" in word for word in faded.cautions)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("kind: spectrum, seed: 1", "irregularity.name: is missing. Add name: german-low, or file: spectrum.csv"),
        ("kind: spectrum, seed: 1, name: german-low, file: s.csv", "file = s.csv: says again what name says"),
        ("kind: spectrum, seed: 1, file: s.csv, rails: [left, right]", "needs the level and the cross level"),
        ("kind: spectrum, seed: 1, file: t.csv", "file = t.csv: no such file"),
        (
            "kind: spectrum, seed: 1, name: german-low, wavelengths: [1 m, 80 m]",
            "irregularity.wavelengths = [1 m, 80 m]: lie outside the range of german-low, wavelengths from 3 m to 150 m. Stay",
        ),
        ("kind: spectrum, seed: 1, name: german-low, taper: 5 m", "taper = 5 m: goes with from and to"),
        ("kind: spectrum, seed: 1, name: german-low, from: 0 m, to: 8 m, taper: 5 m", "taper = 5 m: must be at most 4 m"),
    ],
)  # fmt: skip
def test_wrong_spectra_and_tapers(edited, tmp_path, keys, message):
    (tmp_path / "s.csv").write_text("n [1/m]; S [m^3]\n0.1; 1e-6\n1; 1e-8\n", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        edited(("80 km/h", f"80 km/h\n  irregularity: {{{keys}}}"), folder=tmp_path)
    assert message in str(caught.value)


def test_irregularities_of_lines_and_rails(edited):
    waves = "{kind: lines, lines: {main: {kind: harmonic, amplitude: 1 mm, wavelength: 5 m}, b: none}}"
    with pytest.raises(InputError, match=r"crossing\.irregularity\.lines\.b = none: .*Known: main"):
        edited(("80 km/h", f"80 km/h\n  irregularity: {waves}"))
    case = edited(("80 km/h", f"80 km/h\n  irregularity: {waves.replace(', b: none', '')}"))
    assert case.crossing.runs[0].profiles[0].value(1.25) == pytest.approx(1e-3)


class Rails:
    """A structure of which only the lines are asked for."""

    @staticmethod
    def line(name):
        assert name in ("left", "right")


def test_a_pair_of_rails(loaded):
    from axlespan.study.build_irregularity import irregularity_of

    rails = "{kind: spectrum, name: german-low, seed: 3, wavelengths: [3 m, 70 m], rails: [left, right], scale: 2}"
    case = loaded(("80 km/h", f"80 km/h\n  irregularity: {rails}")).case
    made = irregularity_of(case.crossing.irregularity, Rails)
    pair = realize_pair("german-low", 1400.0, seed=3, wavelengths=(3.0, 70.0))
    x = np.linspace(0.0, 100.0, 31)
    np.testing.assert_allclose(made["left"].value(x), 2.0 * pair.left.value(x))
    np.testing.assert_allclose(made["right"].value(x), 2.0 * pair.right.value(x))


@pytest.mark.parametrize(
    ("edits", "message"),
    [
        ([("80 km/h", "80 km/h\n  to_speed: 90 km/h")], "crossing.to_speed = 90 km/h: needs an acceleration"),
        (
            [("80 km/h", "80 km/h\n  acceleration: 1 m/s^2\n  to_speed: 70 km/h")],
            "crossing.to_speed = 70 km/h: must be more than the speed, 80 km/h. A train that brakes has",
        ),
        ([("80 km/h", "80 km/h\n  acceleration: 0")], "crossing.acceleration = 0: must not be zero"),
        (
            [("80 km/h", "80 km/h\n  direction: back")],
            "crossing.direction = back: must be forward or backward",
        ),
        ([("80 km/h", "80 km/h\n  line: left")], "crossing.line = left: "),
        ([("80 km/h", "80 km/h\n  lines: {main: left}")], "crossing.lines.main = left: "),
        (
            [("analysis:", "other_trains:\n  - {train: [{vehicle: ice3}], speed: 30}\nanalysis:")],
            "other_trains.0 = {train: [{vehicle: ice3}], speed: 30}: stands on train 1 at t = 0, on the line 'main'",
        ),
        (
            [
                (
                    "analysis:",
                    "other_trains:\n  - {train: [{vehicle: ice3}], speed: 30, start: -35 m}\nanalysis:",
                )
            ],
            "other_trains.0.speed = 30: is at the same place as train 1 from t = ",
        ),
        (
            [("analysis:", "other_trains:\n  - {train: [{vehicle: icex}], speed: 30}\nanalysis:")],
            "Did you mean ice3?",
        ),
        (
            [("analysis:", "other_trains:\n  - {train: [], speed: 30}\nanalysis:")],
            "other_trains.0.train = []: has no vehicle",
        ),
        (
            [("analysis:", "other_trains:\n  - {train: [{vehicle: ice3, gap: 3 m}], speed: 30}\nanalysis:")],
            "other_trains.0.train.0.gap = 3 m: is for later entries",
        ),
        (
            [("analysis:", "other_trains:\n  - {train: [{vehicle: ice3}]}\nanalysis:")],
            "other_trains.0.speed: is missing",
        ),
        (
            [("steps: 2000", "steps: 2000\n  vehicles: masses")],
            "analysis.vehicles = masses: must be full, moving-masses or axle-loads",
        ),
        (
            [
                (
                    "80 km/h",
                    "80 km/h\n  irregularity: {kind: spectrum, name: german-low, seed: 1, rails: [left]}",
                )
            ],
            "crossing.irregularity.rails = [left]: must be two different lines",
        ),
    ],
)
def test_crossings_that_are_wrong(edited, edits, message):
    with pytest.raises(InputError) as caught:
        edited(*edits)
    assert message in str(caught.value)
    assert str(caught.value).startswith("case.yaml:")
