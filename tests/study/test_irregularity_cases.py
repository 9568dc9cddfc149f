"""Irregularities of case files are the profiles that their words stand for, and cross a bridge."""

import numpy as np
import pytest

import axlespan as asp
from axlespan import irregularity as ir
from axlespan.errors import InputError
from axlespan.study import read_case
from axlespan.study.build import build

CASE = """\
structure: {kind: simple-span, length: 10 m, youngs_modulus: 34 GPa, second_moment: 0.9 m^4, mass_per_length: 12 t/m, elements: 8}
train: [{vehicle: rigid-mass, mass: 5 t, count: 2, spacing: 3 m}]
crossing: {speed: 20, start: -5 m, irregularity: IRREGULARITY}
analysis: {time_step: 2 ms, duration: 0.5 s}
"""
X = np.linspace(-7.0, 21.0, 1123)
JOINT, BUMP = ir.DippedJoint(5.0, 2e-3, 1.0), ir.Bump(6.0, -5e-3, 2.0)
WAVE = ir.Harmonic(1e-3, 5.0)
HEIGHTS = 1e-3 * np.array([0.0, 2.0, 1.0, 3.0, -1.0])
POINTS = "points: [[0, 0], [2 m, 2 mm], [4 m, 1 mm], [6 m, 3 mm], [8 m, -1 mm]]"
AT = np.arange(0.0, 9.0, 2.0)
EVEN_STEPS = ir.Measurement.from_points(AT, HEIGHTS)
LONG = np.arange(0.0, 100.0, 0.5)
RECORD = 2e-5 * LONG + 1e-3 * np.sin(2 * np.pi * LONG / 8.0) + 1e-3 * np.sin(2 * np.pi * LONG / 40.0)
MEASURED = ir.Measurement.from_points(LONG, RECORD).detrended(2)

KINDS = {
    "{kind: bump, at: 6 m, height: -5 mm, length: 2 m}": BUMP,
    "{kind: bump, at: 6 m, height: 5 mm, length: 2 m, shape: half-sine}": ir.Bump(
        6.0, 5e-3, 2.0, "half-sine"
    ),
    "{kind: ramp, from: -1 m, to: 3 m, height: 4 mm}": ir.Ramp(-1.0, 3.0, 4e-3),
    "{kind: ramp, from: -1 m, to: 3 m, height: -4 mm, shape: cosine}": ir.Ramp(-1.0, 3.0, -4e-3, "cosine"),
    "{kind: dipped-joint, at: 5 m, depth: 2 mm, length: 1 m}": JOINT,
    "{kind: squat, at: 3 m, depth: 0.3 mm, length: 400 mm}": ir.Squat(3.0, 3e-4, 0.4),
    "{kind: squat, at: 3 m, depth: 0.3 mm, length: 400 mm, crest: 50 %}": ir.Squat(3.0, 3e-4, 0.4, 0.5),
    "{kind: pothole, at: 4 m, depth: 20 mm, length: 2 m, edge: 500 mm}": ir.Pothole(4.0, 0.02, 2.0, 0.5),
    "{kind: settlement, at: 0 m, depth: 20 mm, inflection: 3 m}": ir.SettlementDip(0.0, 0.02, 3.0),
    "{kind: sum, of: [{kind: dipped-joint, at: 5 m, depth: 2 mm, length: 1 m}, none, "
    "{kind: harmonic, amplitude: 1 mm, wavelength: 5 m}]}": ir.Sum((JOINT, WAVE)),
    "{kind: lines, lines: {main: {kind: sum, of: [{kind: bump, at: 6 m, height: -5 mm, length: 2 m}, "
    "{kind: harmonic, amplitude: 1 mm, wavelength: 5 m, from: 0, to: 5 m}]}}}": ir.Sum(
        (BUMP, ir.Harmonic(1e-3, 5.0, 0.0, 0.0, 5.0))
    ),
    f"{{kind: table, {POINTS}, smooth: true}}": ir.Spline(AT, HEIGHTS),
    f"{{kind: table, {POINTS}, scale: -2, shift: 1.5 m}}": ir.Table(AT + 1.5, -2.0 * HEIGHTS),
    f"{{kind: table, {POINTS}, detrend: true}}": EVEN_STEPS.detrended(1).table(),
    f"{{kind: table, {POINTS}, detrend: 0, smooth: true}}": EVEN_STEPS.detrended(0).spline(),
    "{kind: table, file: record.csv, detrend: 2, band: D1, smooth: true, shift: -50 m}": ir.Shifted(
        MEASURED.filtered("D1").spline(), -50.0
    ),
    "{kind: table, file: record.csv, detrend: 2, band: [5 m, 12 m], from: 2 m, to: 9 m}": ir.Bounded(
        MEASURED.filtered((5.0, 12.0)).table(), 2.0, 9.0
    ),
}


@pytest.fixture
def folder(tmp_path):
    rows = (f"{x!r}; {1e3 * r!r}" for x, r in zip(LONG.tolist(), RECORD.tolist(), strict=True))
    (tmp_path / "record.csv").write_text("x [m]; r [mm]\n" + "\n".join(rows), encoding="utf-8")
    return tmp_path


def built(irregularity, folder):
    return build(read_case(CASE.replace("IRREGULARITY", irregularity), folder=folder))


@pytest.mark.parametrize(("words", "profile"), KINDS.items(), ids=range(len(KINDS)))
def test_kind(words, profile, folder):
    """It is the profile of Python, and a train crosses on it as on that."""
    case = built(words, folder)
    (surface,) = set(case.crossing.runs[0].profiles)
    # Samples of a file that is scaled from mm and a spacing that is averaged differ by rounding.
    for name, tolerance in (("value", 1e-15), ("slope", 1e-13), ("curvature", 1e-12)):
        wanted, found = getattr(profile, name)(X), getattr(surface, name)(X)
        assert np.allclose(found, wanted, rtol=1e-9, atol=tolerance)
    options = {"time_step": 2e-3, "steps": 250}
    result = asp.simulate(case.crossing, **options)
    crossing = asp.Crossing(
        case.crossing.structure, case.crossing.train, speed=20.0, start=-5.0, irregularity=profile
    )
    wanted = asp.simulate(crossing, **options).contact_force
    assert np.allclose(result.contact_force, wanted, rtol=1e-6, atol=1e-6 * 5e3 * 9.81)
    assert np.ptp(result.contact_force) > 10.0


def test_heights_of_some_places(folder):
    """What the words promise, without the objects of Python."""
    heights = {
        "{kind: bump, at: 6 m, height: 5 mm, length: 2 m}": {5.0: 0.0, 6.0: 5e-3, 5.5: 2.5e-3},
        "{kind: ramp, from: -1 m, to: 3 m, height: 4 mm}": {-1.0: 0.0, 1.0: 2e-3, 3.0: 4e-3, 20.0: 4e-3},
        "{kind: dipped-joint, at: 5 m, depth: 2 mm, length: 1 m}": {4.5: 0.0, 5.0: -2e-3, 5.25: -5e-4},
        "{kind: pothole, at: 4 m, depth: 20 mm, length: 2 m, edge: 0.5 m}": {
            3.25: -0.01,
            4.4: -0.02,
            5.1: 0.0,
        },
        "{kind: settlement, at: 0 m, depth: 20 mm, inflection: 3 m}": {3.0: -0.02 * np.exp(-0.5)},
    }
    for words, places in heights.items():
        surface = built(words, folder).crossing.runs[0].profiles[0]
        assert surface.value(list(places)) == pytest.approx(list(places.values()), abs=1e-15)


def test_a_band_keeps_its_waves(folder):
    """D1 keeps the wave of 8 m of the record and drops its drift and all but a fifth of the wave of 40 m."""
    words = "{kind: table, file: record.csv, detrend: true, band: D1}"
    x = np.arange(30.0, 70.0, 0.5)  # away from the ends
    found = built(words, folder).crossing.runs[0].profiles[0].value(x)
    assert found == pytest.approx(1e-3 * np.sin(2 * np.pi * x / 8.0), abs=2.5e-4)


def test_a_file_with_a_gap_in_its_steps(folder):
    lines = (folder / "record.csv").read_text(encoding="utf-8").splitlines()
    (folder / "gap.csv").write_text("\n".join([*lines[:51], *lines[52:]]), encoding="utf-8")
    assert built("{kind: table, file: gap.csv, smooth: true}", folder)
    with pytest.raises(InputError) as caught:
        built("{kind: table, file: gap.csv, detrend: true}", folder)
    assert str(caught.value) == (
        f"{folder / 'gap.csv'}:52: x[50] = 25.5: is off the regular grid: the step from 24.5 m is 1 m, the usual one 0.5 m. "
        "Points that are filtered must be at equal distances: interpolate them, or leave detrend and band out"
    )


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            f"{{kind: table, {POINTS}, band: D2}}",
            ":149: crossing.irregularity.band = D2: has waves of 70 m, which need a record of 140 m; this one has 8 m. "
            "Take a band of shorter waves, or a longer record",
        ),
        (
            f"{{kind: table, {POINTS}, band: [1 m, 2 m]}}",
            ":149: crossing.irregularity.band = [1 m, 2 m]: has waves of 1 m, which need points every 400 mm; those of the "
            "record are 2 m apart. Take a band of longer waves",
        ),
        (
            "{kind: sum, of: [none, {kind: table, points: [[0, 0], [1 m, 0], [3 m, 0], [4 m, 0]], detrend: 0}]}",
            ":129: crossing.irregularity.of.1.points.2.0 = 3 m: is off the regular grid: the step from 1 m is 2 m, the "
            "usual one 1 m. Points that are filtered must be at equal distances: interpolate them, or leave detrend and band out",
        ),
    ],
)
def test_wrong_records(words, said, folder):
    with pytest.raises(InputError) as caught:
        built(words, folder)
    assert str(caught.value).startswith("case.yaml:3:")
    assert str(caught.value).partition(": ")[2] == said.partition(": ")[2]
