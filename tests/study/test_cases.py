"""Right case files: every value in SI units, where it stands, and what the models work out."""

import math
import pickle
import subprocess
import sys

import numpy as np
import pytest
from pydantic import ValidationError

from axlespan.errors import InputError, Place
from axlespan.study import read_case
from axlespan.study.case_damping import RayleighRatio

NEVES = """\
title: Neves et al. (2012), example 3.2
structure: {kind: simple-span, length: 25 m, youngs_modulus: 2.87 GPa, second_moment: 2.90 m^4,
            mass_per_length: 2303 kg/m, elements: 50}
train:
  - {vehicle: sprung-mass, mass: 5750 kg, stiffness: 1595 kN/m, count: 50, spacing: 3 m}
crossing:
  speed: 47.7 km/h
  irregularity: {kind: harmonic, amplitude: 0.5 mm, wavelength: 5 m, from: 0 m, to: 25 m}
analysis: {time_step: 1 ms, steps: 14000, alpha: 0.0, beta: 0.25, gamma: 0.5}
output: {sensors: {midspan: 12.5 m}}
"""


def test_the_example_of_neves_in_si_units():
    case = read_case(NEVES).case
    beam, (train,), wave = case.structure, case.train, case.crossing.irregularity
    assert case.title == "Neves et al. (2012), example 3.2"
    assert (beam.length, beam.youngs_modulus, beam.second_moment) == (25.0, 2.87e9, 2.9)
    assert (beam.mass_per_length, beam.elements, beam.damping, beam.supports) == (2303.0, 50, None, None)
    assert (train.mass, train.stiffness, train.damping, train.unsprung_mass) == (5750.0, 1.595e6, 0.0, 0.0)
    assert (train.count, train.spacing) == (50, 3.0)
    assert (case.crossing.speed, case.crossing.start) == (13.25, None)
    assert (wave.amplitude, wave.wavelength, wave.phase, wave.from_, wave.to) == (5e-4, 5.0, 0.0, 0.0, 25.0)
    analysis = case.analysis
    assert (analysis.time_step, analysis.step_count) == (1e-3, 14000)
    assert (analysis.alpha, analysis.beta, analysis.gamma) == (0.0, 0.25, 0.5)
    assert (analysis.method, analysis.basis, analysis.contact.kind) == ("direct", "full", "rigid")
    assert (analysis.footprint, analysis.solver, analysis.gravity) == ("auto", "auto", 9.81)
    assert case.output.sensors == {"midspan": 12.5}
    assert (case.output.every, case.output.reactions, case.output.fields) == (1, True, None)


def test_plain_numbers_are_si_units():
    plain = NEVES
    for text, number in {
        "25 m": "25",
        "2.87 GPa": "2.87e9",
        "2.90 m^4": "2.9",
        "2303 kg/m": "2303",
        "5750 kg": "5750",
        "1595 kN/m": "1_595_000",
        "3 m": "3.",
        "47.7 km/h": "13.25",
        "0.5 mm": "5e-4",
        "5 m": "0x5",
        "0 m": "0",
        "1 ms": "1e-3",
        "12.5 m": "+12.5",
    }.items():
        plain = plain.replace(f" {text}", f" {number}")
    assert "km" not in plain
    assert read_case(plain).case == read_case(NEVES).case


def test_models_are_frozen_and_cases_pickle():
    loaded = read_case(NEVES)
    with pytest.raises(ValidationError, match="frozen"):
        loaded.case.crossing.speed = 10.0
    again = pickle.loads(pickle.dumps(loaded))
    assert again.case == loaded.case
    assert again.place("train.0.mass") == loaded.place("train.0.mass")


@pytest.mark.parametrize(
    ("path", "line", "column"),
    [
        ("title", 1, 8),
        ("structure", 2, 12),
        ("structure.second_moment", 2, 87),
        ("structure.mass_per_length", 3, 30),
        ("structure.damping", 2, 1),  # is not there: the key of its mapping
        ("train.0", 5, 5),
        ("train.0.mass", 5, 34),
        ("train[0].mass", 5, 34),
        ("train.1", 4, 1),
        ("crossing.irregularity.from", 8, 76),
        ("output.sensors.midspan", 10, 29),
        ("weather", 1, 1),
    ],
)
def test_places(path, line, column):
    assert read_case(NEVES, "neves.yaml").place(path) == Place("neves.yaml", line, column)


def test_later_errors_point_into_the_file():
    loaded = read_case(NEVES, "neves.yaml")
    late = loaded.located(
        InputError("must be below the critical speed", fix="Drive slower"), "crossing.speed"
    )
    expected = "neves.yaml:7:10: crossing.speed = 47.7 km/h: must be below the critical speed. Drive slower"
    assert str(late) == expected
    assert loaded.source.written("structure.youngs_modulus") == "2.87 GPa"
    assert loaded.source.knows("analysis.beta")
    assert not loaded.source.knows("analysis.method")


def test_names_with_dots_are_found(loaded):
    case = loaded(("midspan: 12.5 m", "pier.1: 12.5 m"))
    assert case.case.output.sensors == {"pier.1": 12.5}
    assert str(case.place("output.sensors.pier.1")) == "case.yaml:23:13"


def test_anchors_and_merges(loaded):
    text = "  - &car {vehicle: sprung-mass, mass: 5 t, stiffness: 1 MN/m, count: 2, spacing: 9 m}\n  - {<<: *car, mass: 7 t}"
    case = loaded(
        (
            "  - vehicle: sprung-mass\n    mass: 5750 kg\n    stiffness: 1595 kN/m\n    count: 3\n    spacing: 10 m",
            text,
        )
    )
    first, second = case.case.train
    assert (first.mass, second.mass, second.stiffness, second.count) == (5000.0, 7000.0, 1e6, 2)
    assert case.place("train.1.stiffness") == case.place("train.0.stiffness")


def test_spans_take_what_the_structure_says_for_all(with_structure):
    beam = with_structure(
        "structure:\n  kind: continuous-beam\n  spans: [{length: 20 m}, {length: 25 m, second_moment: 1.5 m^4, elements: 30}]\n"
        "  youngs_modulus: 34 GPa\n  second_moment: 2 m^4\n  mass_per_length: 12 t/m\n  elements: 20\n"
    ).case.structure
    assert beam.length == 45.0
    assert [(span.length, span.second_moment, span.elements) for span in beam.spans] == [
        (20.0, 2.0, 20),
        (25.0, 1.5, 30),
    ]
    assert {span.youngs_modulus for span in beam.spans} == {34e9}


def test_spans_that_lack_a_property(with_structure):
    with pytest.raises(InputError) as caught:
        with_structure(
            "structure:\n  kind: continuous-beam\n  spans:\n    - {length: 20 m, elements: 20, shear_area: 2 m^2}\n"
            "    - {length: 25 m, second_moment: 2 m^4}\n  youngs_modulus: 34 GPa\n  mass_per_length: 12 t/m\n"
        )
    fix = "to the span, or to the structure for all spans"
    assert str(caught.value).splitlines() == [
        "case.yaml:5:7: structure.spans.0.second_moment: is missing; neither the span nor the structure gives it. "
        f"Add second_moment: 2.90 m^4 {fix}",
        "case.yaml:6:7: structure.spans.1.elements: is missing; neither the span nor the structure gives it. "
        f"Add elements: 20 {fix}",
    ]


def test_supports_of_all_kinds(loaded):
    supports = (
        "[{at: 0 m, fixed: [x, z]}, {at: 12.5 m, stiffness: {z: 1e8 N/m, ry: 5 MNm/rad}, damping: {z: 20 kNs/m}}, "
        "{at: 25 m, motion: {z: {kind: table, points: [[0, 0], [1 s, -10 mm]]}, ry: {kind: harmonic, amplitude: 1 mrad, "
        "frequency: 2 Hz, phase: 90 deg}}}]"
    )
    first, second, third = loaded(
        ("  elements: 20", f"  elements: 20\n  supports: {supports}")
    ).case.structure.supports
    assert (first.at, first.fixed) == (0.0, ("x", "z"))
    assert second.stiffness.given() == {"z": 1e8, "ry": 5e6}
    assert second.damping.given() == {"z": 2e4}
    assert third.motion.z.points == ((0.0, 0.0), (1.0, -0.01))
    assert (third.motion.ry.amplitude, third.motion.ry.frequency) == (1e-3, 2.0)
    assert third.motion.ry.phase == math.pi / 2


def test_rayleigh_coefficients_give_the_ratio_at_both_frequencies():
    damping = RayleighRatio(kind="rayleigh", ratio="1.5 %", frequencies=["3 Hz", "12 Hz"])
    alpha, beta = damping.coefficients()
    for frequency in (3.0, 12.0):
        omega = 2.0 * np.pi * frequency
        assert alpha / (2.0 * omega) + beta * omega / 2.0 == pytest.approx(0.015, rel=1e-14)
    between = 2.0 * np.pi * 6.0
    assert alpha / (2.0 * between) + beta * between / 2.0 < 0.015


@pytest.mark.parametrize(
    ("end", "steps"),
    [("duration: 2 s", 2000), ("duration: 2.0004 s", 2001), ("duration: 0.1 ms", 1), ("steps: 7", 7)],
)
def test_durations_are_whole_steps(loaded, end, steps):
    assert loaded(("steps: 2000", end)).case.analysis.step_count == steps


def test_what_may_be_a_word_a_list_or_a_mapping(loaded):
    run = loaded(
        ("steps: 2000", "steps: 2000\n  footprint: 300 mm\n  contact: {kind: rigid}"),
        ("output:", "output:\n  fields: [0.5 s, 1 s]"),
        ("80 km/h", "80 km/h\n  irregularity: none"),
    ).case
    assert (run.analysis.footprint, run.analysis.contact.kind) == (0.3, "rigid")
    assert (run.output.fields, run.crossing.irregularity.kind) == ((0.5, 1.0), "none")
    every = loaded(
        ("output:", "output:\n  fields: {every: 100}"), ("steps: 2000", "steps: 2000\n  footprint: 0")
    ).case
    assert (every.output.fields.every, every.analysis.footprint) == (100, 0.0)


def test_axlespan_does_not_load_what_only_case_files_need():
    code = "import axlespan, axlespan.units, sys; print([m for m in ('pydantic', 'ruamel.yaml') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


@pytest.mark.parametrize(
    ("edit", "warning"),
    [
        (("80 km/h", "80"), None),
        (
            ("80 km/h", "100"),
            "case.yaml:17:10: crossing.speed = 100: is taken as 100 m/s, which is 360 km/h. "
            "Write 100 km/h if that is meant",
        ),
        (
            ("1595 kN/m", "1595 N/m"),
            "case.yaml:13:16: train.0.stiffness = 1595 N/m: is so soft that 5.75 t sag by 35.37 m under their weight",
        ),
        (
            ("34 GPa", "34 kPa"),
            "case.yaml:5:19: structure.youngs_modulus = 34 kPa: is unusual; is its unit right?",
        ),
        (("5750 kg", "57 kg"), "case.yaml:12:11: train.0.mass = 57 kg: is unusual; is its unit right?"),
        (("12.5 m", "12500 mm"), None),
    ],
)
def test_what_looks_wrong_but_has_a_unit_is_only_warned_of(loaded, edit, warning):
    warnings = loaded(edit).warnings
    assert warning in warnings if warning else not warnings


def test_a_span_of_odd_frequency(loaded):
    assert loaded(("0.9 m^4", "900 m^4")).warnings == (
        "case.yaml:6:18: structure.second_moment = 900 m^4: with it the first frequency of the span is 126.9 Hz; "
        "bridges of 25 m have 3.5 to 8.5 Hz. Look at the units of all properties",
    )
