"""The cases of the book on supports, beams, track and methods, and where their expected values come from."""

import numpy as np
import pytest

from axlespan.reference import WinklerBeam
from axlespan.verification import beams, methods, supports, track
from axlespan.verification.supports import ShakenSpan

CASES = [*supports.CASES, *track.CASES, *beams.CASES, *methods.CASES]


@pytest.mark.parametrize("case", [c for c in CASES if not c.long], ids=lambda c: c.name)
def test_every_row_is_within_its_tolerance(case, check_case):
    rows = check_case(case)
    assert len(rows) >= 2


def by_three_moments(spans, loaded):
    """Reactions [P] and mid-span deflections [P L^3 / EI] of equal spans, P in the middle of one."""
    n = spans - 1
    matrix = 4.0 * np.eye(n) + np.eye(n, k=1) + np.eye(n, k=-1)  # M_{i-1} + 4 M_i + M_{i+1}
    right = np.zeros(n)
    for support in (loaded - 1, loaded):  # inner supports at the ends of the loaded span
        if 0 <= support < n:
            right[support] = -3.0 / 8.0
    moments = np.concatenate(([0.0], np.linalg.solve(matrix, right), [0.0]))
    slopes = np.diff(moments)  # shear by end moments
    reactions = np.zeros(spans + 1)
    reactions[:-1] += slopes
    reactions[1:] -= slopes
    reactions[[loaded, loaded + 1]] += 0.5
    deflections = -(moments[:-1] + moments[1:]) / 16.0  # upward for hogging end moments
    deflections[loaded] -= 1.0 / 48.0
    return reactions, deflections


@pytest.mark.parametrize(("case", "spans", "words"), [
    (beams.two_spans, 2, [""]),
    (beams.three_spans, 3, ["first span: ", "second span: "]),
])  # fmt: skip
def test_continuous_beams_expect_what_three_moments_give(case, spans, words):
    rows = {row.quantity: row.expected for row in case.compute()}
    for loaded, word in enumerate(words):
        reactions, deflections = by_three_moments(spans, loaded)
        for i, value in enumerate(reactions):
            assert rows[f"{word}reaction {i + 1} over the force"] == pytest.approx(value, abs=1e-15)
        for i, value in enumerate(deflections):
            assert rows[f"{word}deflection {i + 1} over P L^3 / EI"] == pytest.approx(value, abs=1e-15)


def test_influence_line_of_the_middle_reaction():
    # three moments for a force at x: 4 M = -x (1 - x^2); the end spans hang on M
    x = np.linspace(0.0, 1.0, 11)
    moment = -x * (1.0 - x**2) / 4.0
    np.testing.assert_allclose(beams._middle_reaction(x), x - 2.0 * moment, atol=1e-15)


def test_shaken_span_satisfies_its_equations():
    time = np.linspace(0.0, 0.2, 20_001)
    span = ShakenSpan(time, ((2e-3, 12.0, 0.7), (-5e-4, 40.0, 0.0)))
    q, rate2 = span.modal()
    omega = span.numbers**2 * (np.pi / 25.0) ** 2 * np.sqrt(2.87e9 * 2.9 / 2303.0)
    participation = 4.0 / (np.pi * span.numbers)
    residual = rate2 + omega**2 * q + participation * span.ground(2)[:, None]
    assert np.abs(residual).max() < 1e-9 * np.abs(omega**2 * q).max()
    assert np.abs(q[0]).max() < 1e-15
    few = slice(0, 5)  # low modes, which differences in time resolve
    step = time[1]
    assert np.abs((q[1] - q[0])[few] / step).max() < 1e-4 * np.abs(np.diff(q[:, few], axis=0) / step).max()
    second = np.diff(q[:, few], 2, axis=0) / step**2
    np.testing.assert_allclose(second, rate2[1:-1, few], atol=2e-3 * np.abs(rate2[:, few]).max())
    ground_rate2 = np.diff(span.ground(), 2) / step**2
    np.testing.assert_allclose(ground_rate2, span.ground(2)[1:-1], atol=1e-5 * np.abs(span.ground(2)).max())


def test_printed_values_of_the_rail_are_the_formulas():
    rail = WinklerBeam(210e9 * 3.0383e-5, 50e6, 60.21)
    rows = {row.quantity: row.expected for row in track.rail_on_springs.compute()}
    assert rows["standing: w0 = P beta / 2 k"] == pytest.approx(1e3 * rail.static_deflection(85e3), rel=5e-6)
    assert rows["standing: M0 = P / 4 beta"] == pytest.approx(1e-3 * rail.static_moment(85e3), rel=5e-6)
