"""Load model 71 and standing trains on influence lines, against closed forms and plain sums."""

import numpy as np
import pytest

import axlespan as asp
from axlespan.errors import InputError
from axlespan.reference import point_load_deflection
from axlespan.standards.influence import deflection_lines, moment_lines
from axlespan.standards.lm71 import InfluenceLine, lm71_effect, sw0_effect, train_effect

SPAN = 20.0
X = np.linspace(0.0, SPAN, 2001)
MOMENT = InfluenceLine(X, 0.5 * np.minimum(X, SPAN - X))  # at midspan
SHEAR = InfluenceLine(X, 1.0 - X / SPAN)  # at the left support


def test_moment_of_load_model_71_at_midspan():
    """One of the inner axles at midspan: 250 (5 + 4.2 + 4.2 + 3.4) kNm and 80 (7.6² + 6²) / 4 kNm."""
    assert lm71_effect(MOMENT) == pytest.approx(1e3 * (4200.0 + 1875.2), rel=1e-6)
    assert lm71_effect(MOMENT, alpha=1.33) == pytest.approx(1.33 * 6075.2e3, rel=1e-6)


def test_reaction_of_load_model_71():
    """The first axle over the support: 250 (4 - 9.6/20) kN, and 80 kN/m from 5.6 m on."""
    axles = 250.0 * (4.0 - (0.0 + 1.6 + 3.2 + 4.8) / SPAN)
    uniform = 80.0 * 0.5 * (SPAN - 5.6) ** 2 / SPAN
    assert lm71_effect(SHEAR) == pytest.approx(1e3 * (axles + uniform), rel=1e-6)


def test_what_relieves_is_left_out():
    two = InfluenceLine(np.linspace(0.0, 40.0, 4001), np.sin(np.pi * np.linspace(0.0, 40.0, 4001) / 20.0))
    alone = InfluenceLine(two.positions, np.maximum(two.ordinates, 0.0))
    assert lm71_effect(two) == pytest.approx(lm71_effect(alone))
    assert lm71_effect(two, sign=-1.0) == pytest.approx(lm71_effect(two), rel=1e-6)


def test_sw0_on_a_long_span():
    """Both halves around the middle of a triangle of 60 m: 133 kN/m on 15 m each, ordinates 15 - s/2."""
    x = np.linspace(0.0, 60.0, 6001)
    line = InfluenceLine(x, 0.5 * np.minimum(x, 60.0 - x))
    half = np.linspace(2.65, 17.65, 1001)
    by_hand = 2.0 * np.trapezoid(15.0 - 0.5 * half, half) * 133e3
    assert sw0_effect(line) >= by_hand * (1.0 - 1e-9)
    places = np.linspace(0.0, 60.0, 1201)
    plain = max(
        133e3
        * sum(
            np.trapezoid(line.at(np.linspace(a, b, 3001)), np.linspace(a, b, 3001))
            for a, b in ((m - 17.65, m - 2.65), (m + 2.65, m + 17.65))
        )
        for m in places[::20]
    )
    assert sw0_effect(line) == pytest.approx(plain, rel=1e-4)


def test_standing_train_is_a_plain_sum():
    rng = np.random.default_rng(3)
    loads, behind = rng.uniform(5e4, 2e5, 7), np.sort(rng.uniform(0.0, 30.0, 7))
    heads = np.linspace(0.0, SPAN + behind.max(), 2001)
    plain = [sum(loads * np.interp(head - behind, X, MOMENT.ordinates, 0.0, 0.0)) for head in heads]
    assert train_effect(MOMENT, loads, behind, step=0.01) == pytest.approx(max(plain), rel=2e-3)


def test_integral_of_a_piecewise_linear_line():
    found = MOMENT.integral(np.array([-5.0, 3.0, 10.005]), np.array([25.0, 12.5, 10.005]))
    exact = [25.0 * 2.0, 0.25 * (10.0**2 - 3.0**2) + 0.25 * (10.0**2 - 7.5**2), 0.0]
    assert found == pytest.approx(exact, rel=1e-9, abs=1e-12)


def test_deflection_lines_of_a_beam():
    bridge = asp.bridges.simple_span(
        length=SPAN, youngs_modulus=30e9, second_moment=2.0, mass_per_length=1e4, elements=20
    )
    (line,) = deflection_lines(bridge, np.array([7.0]))
    expected = point_load_deflection(7.0, force=1.0, at=line.positions, length=SPAN, bending_stiffness=60e9)
    assert line.ordinates == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())


def test_deflection_under_load_model_71_against_a_sum_of_point_loads():
    bridge = asp.bridges.simple_span(
        length=SPAN, youngs_modulus=30e9, second_moment=2.0, mass_per_length=1e4, elements=20
    )
    (line,) = deflection_lines(bridge, np.array([10.0]))
    at = {"length": SPAN, "bending_stiffness": 60e9}
    axles = sum(-point_load_deflection(10.0, force=250e3, at=10.0 + d, **at) for d in (-2.4, -0.8, 0.8, 2.4))
    s = np.concatenate([np.linspace(0.0, 6.8, 3001)])
    uniform = 2.0 * np.trapezoid(-point_load_deflection(10.0, force=80e3, at=s, **at), s)
    assert lm71_effect(line, sign=-1.0) == pytest.approx(float(axles + uniform), rel=1e-3)


def test_positions_must_increase():
    with pytest.raises(InputError, match="must have positions that increase"):
        InfluenceLine(np.array([0.0, 0.0]), np.zeros(2))


@pytest.mark.parametrize("at", [0.3, 7.0, 10.0])
def test_moment_lines_of_a_simple_beam(at):
    """A triangle with s (L - s) / L at the section, inside elements and at nodes."""
    bridge = asp.bridges.simple_span(
        length=SPAN, youngs_modulus=30e9, second_moment=2.0, mass_per_length=1e4, elements=10
    )
    (line,) = moment_lines(bridge, np.array([at]))
    exact = np.minimum(line.positions, at) * (SPAN - np.maximum(line.positions, at)) / SPAN
    assert line.ordinates == pytest.approx(exact, abs=1e-9)


def test_moment_of_load_model_71_on_a_structure():
    bridge = asp.bridges.simple_span(
        length=SPAN, youngs_modulus=30e9, second_moment=2.0, mass_per_length=1e4, elements=10
    )
    (line,) = moment_lines(bridge, np.array([10.0]))
    assert lm71_effect(line) == pytest.approx(6075.2e3, rel=1e-6)


def test_hogging_over_the_middle_support():
    """Two equal spans: M = -P a (L² - a²) / 4 L² over the middle support for a force at a in one span."""
    beam = asp.bridges.continuous_beam(
        spans=[SPAN, SPAN], youngs_modulus=30e9, second_moment=2.0, mass_per_length=1e4, elements=10
    )
    (line,) = moment_lines(beam, np.array([SPAN]))
    a = np.where(line.positions <= SPAN, line.positions, 2.0 * SPAN - line.positions)
    assert line.ordinates == pytest.approx(-a * (SPAN**2 - a**2) / (4.0 * SPAN**2), abs=1e-9)
