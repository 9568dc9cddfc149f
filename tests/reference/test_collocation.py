"""Gauss collocation against its order conditions and exact oscillators."""

import numpy as np
import pytest

from axlespan.reference.collocation import GaussRule, OscillatorStages


def advance(rule, step, damping, stiffness, u, v, load):
    """One step of ``a + damping v + stiffness u = load`` for one oscillator, written out."""
    stages = OscillatorStages.over(step, rule, np.array([damping]), np.array([stiffness]))
    values = stages.free(np.array([u]), np.array([v])) + stages.forced(load[:, None])
    a = values[:, 2, 0]
    residual = a + damping * values[:, 1, 0] + stiffness * values[:, 0, 0] - load
    np.testing.assert_allclose(residual, 0.0, atol=1e-9 * max(1.0, stiffness * abs(u)))
    return u + step * v + step**2 * rule.double_weights @ a, v + step * rule.weights @ a


@pytest.mark.parametrize("stages", [1, 2, 3, 4])
def test_the_rule_integrates_polynomials_exactly(stages):
    rule = GaussRule.with_stages(stages)
    for k in range(2 * stages):
        assert rule.weights @ rule.nodes**k == pytest.approx(1 / (k + 1), rel=1e-14)
    for k in range(stages):
        np.testing.assert_allclose(rule.matrix @ rule.nodes**k, rule.nodes ** (k + 1) / (k + 1), atol=1e-15)
    np.testing.assert_allclose(rule.double_weights, rule.weights * (1 - rule.nodes), atol=1e-15)


@pytest.mark.parametrize("stages", [1, 2, 3])
def test_a_damped_driven_oscillator_converges_with_order_two_s(stages):
    rule = GaussRule.with_stages(stages)
    omega, zeta, drive = 3.0, 0.1, 2.0

    def error(steps):
        # u = cos(drive t) with the load that this needs
        h, u, v = 2.0 / steps, 1.0, 0.0
        for k in range(steps):
            t = h * (k + rule.nodes)
            load = (omega**2 - drive**2) * np.cos(drive * t) - 2 * zeta * omega * drive * np.sin(drive * t)
            u, v = advance(rule, h, 2 * zeta * omega, omega**2, u, v, load)
        return abs(u - np.cos(2.0 * drive)) + abs(v + drive * np.sin(2.0 * drive))

    order = np.log2(error(8) / error(16))
    assert order == pytest.approx(2 * stages, abs=0.25)


@pytest.mark.parametrize("omega_step", [0.1, 3.0, 500.0])
def test_free_vibration_keeps_its_energy_at_any_step(omega_step):
    rule = GaussRule.with_stages(3)
    omega, u, v = 100.0, 1.0, 20.0
    before = v**2 + (omega * u) ** 2
    for _ in range(50):
        u, v = advance(rule, omega_step / omega, 0.0, omega**2, u, v, np.zeros(3))
    assert v**2 + (omega * u) ** 2 == pytest.approx(before, rel=1e-10)
