"""Verdicts at, below and above their limits; limits of the standards and of a case."""

import dataclasses
import json
import math

import pytest

from axlespan.errors import InputError
from axlespan.io.strict_json import to_json
from axlespan.standards import CHECKS, FROM_MEMORY, Assessment, Verdict, envelope, overall, worst
from axlespan.standards.limits import LIMITS, largest_wheel_force, limit_of
from axlespan.standards.verdict import judged, not_assessed


def deck(value, limit=3.5, **more):
    return judged("deck_acceleration", "A2.4.4.2.1", "acceleration", value, limit, "m/s^2", **more)


@pytest.mark.parametrize(
    ("value", "outcome", "used"),
    [
        (0.0, "pass", 0.0),
        (3.4, "pass", 3.4 / 3.5),
        (3.5, "pass", 1.0),
        (3.5 + 1e-9, "fail", 1.0),
        (7.0, "fail", 2.0),
    ],
)
def test_at_most(value, outcome, used):
    verdict = deck(value)
    assert verdict.outcome == outcome
    assert verdict.utilization == pytest.approx(used)


@pytest.mark.parametrize(
    ("value", "outcome", "used"), [(1200.0, "pass", 0.5), (600.0, "pass", 1.0), (599.0, "fail", 600 / 599)]
)
def test_at_least(value, outcome, used):
    verdict = deck(value, 600.0, at_least=True)
    assert verdict.outcome == outcome
    assert verdict.utilization == pytest.approx(used)


def test_a_limit_of_zero():
    assert deck(0.0, 0.0).utilization == 0.0
    above = deck(3.0, 0.0)
    assert above.outcome == "fail" and above.utilization == math.inf


def test_a_value_that_is_none_fails():
    assert deck(math.nan).outcome == "fail"
    assert deck(math.inf, at_least=True).outcome == "fail"


def test_without_limit_it_is_reported():
    verdict = deck(2.0, None)
    assert verdict.outcome == "reported" and verdict.utilization is None


def test_not_assessed_says_why():
    verdict = not_assessed("twist", "A2.4.4.2.2", "twist", "one rail")
    assert (verdict.outcome, verdict.value, verdict.utilization) == ("not assessed", None, None)
    with pytest.raises(InputError, match="must say why"):
        not_assessed("twist", "A2.4.4.2.2", "twist", "")
    with pytest.raises(InputError, match="must be one of pass, fail, reported, not assessed"):
        dataclasses.replace(verdict, outcome="ok")


def test_as_a_mapping_it_is_strict_json():
    content = deck(3.0, 0.0, where="20 m", when=1.5).as_dict()
    assert {
        "check",
        "clause",
        "quantity",
        "value",
        "limit",
        "unit",
        "utilization",
        "outcome",
        "source",
    } <= set(content)
    assert json.loads(to_json(content))["where"] == "20 m"


def test_all_in_one_word():
    missing = not_assessed("twist", "c", "q", "r")
    assert overall([]) == overall([missing]) == overall([missing, deck(1.0, None)]) == "not assessed"
    assert overall([missing, deck(1.0)]) == "pass"
    assert overall([missing, deck(1.0), deck(9.0)]) == "fail"


def test_the_worst_of_several_runs():
    missing = not_assessed("deck_acceleration", "c", "q", "no line")
    assert worst([deck(1.0), missing, deck(3.0), deck(2.0)]).value == 3.0
    assert worst([missing]) is missing
    assert worst([deck(1.0), deck(1.0, 0.0)]).limit == 0.0
    assert worst([deck(1.0, None), deck(-4.0, None)]).value == -4.0
    ratio = [deck(value, 600.0, at_least=True) for value in (900.0, 650.0, 2000.0)]
    assert worst(ratio).value == 650.0
    with pytest.raises(InputError, match="must be at least one"):
        worst([])
    with pytest.raises(InputError, match="must all be of one check"):
        worst([deck(1.0), not_assessed("twist", "c", "q", "r")])


def test_the_envelope_of_a_sweep():
    missing = not_assessed("twist", "c", "q", "r")
    runs = [(deck(1.0), missing), (deck(4.0), missing), (deck(2.0),)]
    found = envelope(runs)
    assert [verdict.check for verdict in found] == ["deck_acceleration", "twist"]
    assert found[0].value == 4.0 and overall(found) == "fail"
    assert envelope([]) == ()


@pytest.mark.parametrize(
    ("name", "facts", "value"),
    [
        ("deck_acceleration", {}, 3.5),
        ("deck_acceleration", {"deck": "unballasted"}, 5.0),
        ("deck_frequency", {}, 30.0),
        ("deflection_ratio", {}, 600.0),
        ("body_acceleration", {}, 1.0),
        ("body_acceleration", {"comfort": "good"}, 1.3),
        ("body_acceleration", {"comfort": "acceptable"}, 2.0),
        ("end_offset", {"line_speed": 160 / 3.6}, 3e-3),
        ("end_offset", {"line_speed": 161 / 3.6}, 2e-3),
        ("twist", {"line_speed": 120 / 3.6}, 4.5e-3),
        ("twist", {"line_speed": 200 / 3.6}, 3.0e-3),
        ("twist", {"line_speed": 201 / 3.6}, 1.5e-3),
        ("wheel_unloading", {}, 0.6),
        ("derailment", {}, 0.8),
    ],
)
def test_limits_of_the_standards_are_marked(name, facts, value):
    limit = limit_of(name, Assessment(**facts))
    assert limit.value == pytest.approx(value)
    assert FROM_MEMORY in limit.source


def test_limits_that_depend_on_an_unknown_speed():
    limit = limit_of("end_offset", Assessment())
    assert limit.value is None and limit.missing == "line_speed"


@pytest.mark.parametrize("name", LIMITS)
def test_a_case_replaces_every_limit(name):
    own = limit_of(name, Assessment(limits={name: 0.123}, national="NA to BS EN 1990"))
    assert own.value == 0.123 and own.source == "national value: NA to BS EN 1990"
    assert limit_of(name, Assessment(limits={name: 0.123})).source == "given in the assessment"


@pytest.mark.parametrize(
    ("static", "kmh", "limit"),
    [
        (60e3, 100, 150e3),
        (120e3, 160, 200e3),
        (120e3, 200, 190e3),
        (110e3, 250, 180e3),
        (110e3, 300, 170e3),
        (110e3, 301, 160e3),
    ],
)
def test_limit_of_the_wheel_force(static, kmh, limit):
    value, source = largest_wheel_force(static, kmh / 3.6)
    assert value == limit and FROM_MEMORY in source


@pytest.mark.parametrize(
    ("wrong", "field"),
    [
        ({"deck": "wood"}, "deck"),
        ({"comfort": "best"}, "comfort"),
        ({"maintenance": "none"}, "maintenance"),
        ({"bridge_type": "wood"}, "bridge_type"),
        ({"checks": ("twist", "twits")}, "checks.1"),
        ({"line_speed": 0.0}, "line_speed"),
        ({"spans": (20.0, -1.0)}, "spans.1"),
        ({"overhang": -0.1}, "overhang"),
        ({"limits": {"speed": 1.0}}, "limits.speed"),
        ({"limits": {"twist": math.nan}}, "limits.twist"),
    ],
)
def test_an_assessment_is_checked(wrong, field):
    with pytest.raises(InputError) as error:
        Assessment(**wrong)
    assert error.value.field == field


def test_every_check_has_a_name_of_its_own():
    assert len(set(CHECKS)) == len(CHECKS) == 20
    assert Verdict("twist", "c", "q", "pass").as_dict()["check"] == "twist"
