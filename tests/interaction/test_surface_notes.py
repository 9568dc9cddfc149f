"""Warnings about irregularities: steps, heights, lines that no wheel runs on; one line under two names."""

import re

import numpy as np
import pytest

import axlespan as asp
from axlespan import irregularity as ir
from axlespan.bridges import SupportAt
from axlespan.errors import InputError
from axlespan.interaction.plan import plan_for
from axlespan.interaction.settings import settings_for
from axlespan.interaction.surface_notes import start_notes
from axlespan.model.motions import Constant, HarmonicMotion, TableMotion

BEAM = {"length": 12.0, "youngs_modulus": 34e9, "second_moment": 0.5, "mass_per_length": 9e3, "elements": 12}
CAR = asp.vehicles.sprung_mass(mass=5e3, stiffness=1e6, damping=1e4)


@pytest.fixture(scope="module")
def beam():
    return asp.bridges.simple_span(**BEAM)


@pytest.fixture(scope="module")
def track(beam):
    return asp.bridges.with_track(beam, asp.bridges.ballasted_track(), approach=40.0, exit=40.0)


def warnings(structure, irregularity, **motion):
    crossing = asp.Crossing(
        structure, asp.Train.of(CAR), irregularity=irregularity, **{"speed": 20.0, "start": -3.0} | motion
    )
    notes = plan_for(crossing, settings_for(crossing, time_step=2e-3, steps=600)).settings.notes
    return [note for note in notes if note.startswith("warning: ") and "irregularity" in note]


WAVES = ir.Harmonic(1e-3, 5.0)


@pytest.mark.parametrize(
    ("profile", "step"),
    [
        (ir.Harmonic(1e-3, 5.0, start=1.25, stop=7.5), "1 mm at 1.25 m"),
        (ir.Bounded(WAVES, 0.0, 3.75), "1 mm at 3.75 m"),
        (ir.Bounded(ir.Table([2.0, 4.0, 6.0], [0.0, 1e-3, 2e-3]), 0.0, 6.0), "-2 mm at 6 m"),
        (ir.Shifted(ir.Bounded(ir.Table([0.0, 4.0], [3e-4, 0.0]), 0.0, 4.0), 1.0), "0.3 mm at 1 m"),
        (
            ir.Sum((WAVES, ir.Scaled(ir.Bounded(ir.Harmonic(1e-3, 5.0, np.pi / 2), 5.0), 0.5))),
            "0.5 mm at 5 m",
        ),
    ],
)
def test_steps_are_told(beam, profile, step):
    (word,) = warnings(beam, profile)
    assert f"the line 'main' steps by {step}" in word


@pytest.mark.parametrize(
    "profile",
    [
        WAVES,
        ir.Harmonic(1e-3, 5.0, start=0.0, stop=5.0),
        ir.Bounded(WAVES, 1.0, 9.0, taper=2.0),
        ir.Ramp(1.0, 5.0, 2e-3),
        ir.Table([2.0, 4.0, 6.0], [0.0, 1e-3, 2e-3]),  # the heights of its ends go on
    ],
)
def test_even_ends_are_fine(beam, profile):
    assert warnings(beam, profile) == []


def test_surfaces_as_high_as_hills(beam):
    (word,) = warnings(beam, ir.Harmonic(1.5, 30.0))
    assert "is up to 1.5 m high or deep" in word


def test_rails_of_a_track_have_two_names(track):
    """An irregularity of the line 'rail' acts on wheels of the line 'main': they are the same line."""
    runs = []
    for irregularity in (WAVES, {"main": WAVES}, {"rail": WAVES}):
        crossing = asp.Crossing(track, asp.Train.of(CAR), speed=20.0, irregularity=irregularity)
        runs.append(asp.simulate(crossing, time_step=2e-3, steps=200).contact_force)
        assert warnings(track, irregularity) == []
    assert np.ptp(runs[0]) > 1e3
    np.testing.assert_array_equal(runs[1], runs[0])
    np.testing.assert_array_equal(runs[2], runs[0])


def test_lines_without_wheels_are_told(track):
    (word,) = warnings(track, {"deck": WAVES})
    assert "no wheel runs on the line 'deck', which has an irregularity; wheels run on main" in word


def test_trains_on_two_names_of_one_line_collide(track):
    other = asp.OtherTrain(train=asp.Train.of(CAR), speed=20.0, line="rail")
    crossing = asp.Crossing(track, asp.Train.of(CAR), speed=20.0, others=[other])
    with pytest.raises(InputError, match="stands on train 1 at t = 0"):
        asp.simulate(crossing, time_step=2e-3, steps=20)


@pytest.mark.parametrize(
    ("motion", "told"),
    [
        ({}, "starts at the bridge, .* start at -10 m"),
        ({"start": -5.0}, "start at -10 m"),
        ({"start": 6.0}, "start at -10 m"),
        ({"start": -10.5}, None),
        ({"start": 13.0}, None),
        ({"start": 20.0, "direction": "backward"}, "start at 22 m"),
        ({"start": 23.0, "direction": "backward"}, None),
        ({"start": 5.0, "speed": 0.0}, None),
    ],
)
def test_trains_that_are_set_off_on_the_track_at_the_bridge(track, motion, told):
    crossing = asp.Crossing(track, asp.Train.of(CAR), **{"speed": 20.0} | motion)
    found = [note for note in start_notes(crossing) if "does not move yet" in note]
    assert len(found) == (told is not None)
    assert told is None or re.search(told, found[0])


def test_bare_spans_may_start_at_zero(beam):
    assert start_notes(asp.Crossing(beam, asp.Train.of(CAR), speed=20.0)) == []


@pytest.mark.parametrize(
    ("motion", "told"),
    [
        (HarmonicMotion(1e-3, 2.0), "'support2.z' moves at 0.0126 m/s or rad/s at t = 0"),
        (TableMotion([0.0, 1.0], [0.0, 2e-3]), "'support2.z' moves at 0.002 m/s"),
        (HarmonicMotion(1e-3, 2.0, np.pi / 2), None),
        (TableMotion([0.0, 1.0], [0.0, 2e-3], smooth=True), None),
        (TableMotion([0.5, 1.0], [0.0, 2e-3]), None),
        (Constant(-5e-3), None),
    ],
)
def test_supports_that_start_with_a_jerk(motion, told):
    supports = [SupportAt(0.0), SupportAt(12.0, fixed=(), motion={"z": motion})]
    crossing = asp.Crossing(asp.bridges.simple_span(**BEAM, supports=supports), asp.Train.of(CAR), speed=20.0)
    notes = start_notes(crossing)
    assert len(notes) == (told is not None)
    assert told is None or told in notes[0]
