"""Parameters of the alpha method: N12 (24), and what is refused."""

import numpy as np
import pytest

from axlespan.dynamics.alpha import Alpha
from axlespan.errors import InputError


def largest_growth(alpha, beta, gamma):
    """Largest eigenvalue of the step of an undamped oscillator over ωΔt from 1e-2 to 1e4."""
    worst = 0.0
    for square in np.logspace(-4.0, 8.0, 97):
        left = np.array([[(1.0 + alpha) * square, 0.0, 1.0], [1.0, 0.0, -beta], [0.0, 1.0, -gamma]])
        right = np.array([[alpha * square, 0.0, 0.0], [1.0, 1.0, 0.5 - beta], [0.0, 1.0, 1.0 - gamma]])
        worst = max(worst, np.abs(np.linalg.eigvals(np.linalg.solve(left, right))).max())
    return worst


def test_defaults_follow_alpha():
    for alpha in (0.0, -0.05, -0.1, -1.0 / 3.0):
        method = Alpha(alpha)
        assert method.beta == pytest.approx(0.25 * (1.0 - alpha) ** 2)
        assert method.gamma == pytest.approx(0.5 - alpha)
        assert method.is_second_order
    assert not Alpha(0.0, beta=0.3025, gamma=0.6).is_second_order
    assert Alpha(-0.1, beta=0.4).is_second_order


def test_coefficients():
    """N12 (24), written out for β = 0.3025, γ = 0.6, Δt = 0.02."""
    a = Alpha(-0.1).coefficients(0.02)
    expected = [8264.462810, 99.17355372, 165.2892562, 0.6528925620, 0.9834710744, -1.652892562e-4]
    np.testing.assert_allclose(a, expected, rtol=1e-9)
    newmark = Alpha(0.0).coefficients(1e-3)
    np.testing.assert_allclose(newmark, [4e6, 2e3, 4e3, 1.0, 1.0, 0.0], rtol=1e-12, atol=1e-18)


def test_coefficients_are_those_of_16_and_17():
    """(18) and (20) solved for ü and u̇ satisfy (16) and (17)."""
    method, dt = Alpha(-0.2, beta=0.5, gamma=0.9), 0.03
    a0, a1, a2, a3, a4, a5 = method.coefficients(dt)
    u_p, v_p, a_p, u_c = 0.3, -1.1, 2.7, 0.35
    a_c = a0 * (u_c - u_p) - a2 * v_p - a3 * a_p
    v_c = a1 * (u_c - u_p) - a4 * v_p - a5 * a_p
    assert v_c == pytest.approx(v_p + ((1 - 0.9) * a_p + 0.9 * a_c) * dt)
    assert u_c == pytest.approx(u_p + v_p * dt + ((0.5 - 0.5) * a_p + 0.5 * a_c) * dt**2)


@pytest.mark.parametrize("alpha", [0.0, -0.05, -0.1, -0.2, -1.0 / 3.0])
@pytest.mark.parametrize("gamma", [-0.02, 0.0, 0.1, 0.5])  # above ½ - α
@pytest.mark.parametrize("beta", [0.98, 1.0, 1.02, 2.0])  # of γ / 2
def test_exactly_what_is_unconditionally_stable_is_accepted(alpha, gamma, beta):
    gamma = 0.5 - alpha + gamma
    beta = beta * 0.5 * gamma
    stable = largest_growth(alpha, beta, gamma) <= 1.0 + 1e-7
    try:
        Alpha(alpha, beta, gamma)
        accepted = True
    except InputError:
        accepted = False
    assert accepted == stable


@pytest.mark.parametrize(
    ("arguments", "field", "rule"),
    [
        ((0.1,), "alpha", "must lie between -1/3 and 0"),
        ((-0.34,), "alpha", "must lie between -1/3 and 0"),
        ((float("nan"),), "alpha", "must be a finite number"),
        ((0.0, float("inf")), "beta", "must be a finite number"),
        ((0.0, 0.25, 0.4), "gamma", "must be at least 1/2"),
        ((-0.1, 0.3025, 0.5), "gamma", r"must be at least 1/2 - alpha = 0\.6"),
        ((0.0, 0.2, 0.5), "beta", r"must be at least 0\.25"),
        ((-0.1, 0.25), "beta", r"must be at least 0\.3"),
    ],
)
def test_errors(arguments, field, rule):
    with pytest.raises(InputError, match=rule) as caught:
        Alpha(*arguments)
    assert caught.value.field == field
