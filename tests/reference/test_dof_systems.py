"""The suspended body against a numerical integration of its equation and against textbook limits."""

import itertools

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from axlespan.errors import InputError
from axlespan.reference import SuspendedBody

TIME = np.linspace(0.0, 2.0, 401)
BODIES = [
    SuspendedBody(5750.0, 1.595e6),
    SuspendedBody(5750.0, 1.595e6, 20e3),
    SuspendedBody(2.0, 800.0, 60.0),
]


def integrated(body, foot, foot_rate, breaks, start=(0.0, 0.0)):
    """z, z' at TIME by a Runge-Kutta method of order 8, restarted where the foot's velocity jumps."""

    def rates(t, state):
        push = body.stiffness * (foot(t) - state[0]) + body.damping * (foot_rate(t) - state[1])
        return [state[1], push / body.mass]

    rows, state = [], np.array(start)
    for a, b in itertools.pairwise(breaks):
        t = np.array([t for t in TIME if a <= t < b])
        solved = solve_ivp(rates, (a, b), state, "DOP853", t_eval=np.append(t, b), rtol=1e-11, atol=1e-14)
        rows.append(solved.y[:, :-1])
        state = solved.y[:, -1]
    return np.hstack([*rows, state[:, None]])


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("ratio", [0.4, 1.0, 3.0])
def test_over_a_harmonic_foot(body, ratio):
    frequency = ratio * body.angular_frequency  # 1.0 is resonance
    motion = body.over_harmonic(1e-3, frequency, TIME)
    z = integrated(
        body,
        lambda t: 1e-3 * np.sin(frequency * t),
        lambda t: 1e-3 * frequency * np.cos(frequency * t),
        [0.0, 2.0],
    )
    scale = np.abs(z).max(axis=1)
    np.testing.assert_allclose(motion.displacement, z[0], atol=1e-8 * scale[0])
    np.testing.assert_allclose(motion.velocity, z[1], atol=1e-8 * scale[1])
    push = body.stiffness * (1e-3 * np.sin(frequency * TIME) - z[0])
    push += body.damping * (1e-3 * frequency * np.cos(frequency * TIME) - z[1])
    np.testing.assert_allclose(
        motion.acceleration, push / body.mass, atol=1e-7 * np.abs(push).max() / body.mass
    )


@pytest.mark.parametrize("body", BODIES)
def test_over_a_settlement_ramp(body):
    drop, duration = -0.01, 0.35
    motion = body.over_ramp(drop, duration, TIME)
    z = integrated(
        body,
        lambda t: drop * min(t / duration, 1.0),
        lambda t: drop / duration if t < duration else 0.0,
        [0.0, duration, 2.0],
    )
    np.testing.assert_allclose(motion.displacement, z[0], atol=1e-10)
    np.testing.assert_allclose(motion.velocity, z[1], atol=1e-8)


def test_a_slow_ramp_ends_at_the_settlement_without_ringing():
    body = SuspendedBody(5750.0, 1.595e6)
    period = 2 * np.pi / body.angular_frequency
    motion = body.over_ramp(-0.02, period, np.linspace(period, 3 * period, 50))
    # a ramp of exactly one period leaves an undamped body at rest
    np.testing.assert_allclose(motion.displacement, -0.02, rtol=1e-12)


def test_steady_amplitude_is_the_transmissibility():
    body = SuspendedBody(2.0, 800.0, 60.0)  # 75 % of critical: the start has died out after 2 s
    frequency = 15.0
    late = np.linspace(4.0, 4.0 + 2 * np.pi / frequency, 2001)
    motion = body.over_harmonic(1e-3, frequency, late)
    assert np.abs(motion.displacement).max() == pytest.approx(
        1e-3 * body.transmissibility(frequency), rel=1e-5
    )
    # all curves pass through one at sqrt(2) times the natural frequency
    assert body.transmissibility(np.sqrt(2.0) * body.angular_frequency) == pytest.approx(1.0, rel=1e-12)


def test_free_vibration_keeps_its_start_and_its_energy():
    body = SuspendedBody(5750.0, 1.595e6)
    motion = body.free_vibration(1e-3, 0.02, TIME)
    energy = 0.5 * body.mass * motion.velocity**2 + 0.5 * body.stiffness * motion.displacement**2
    np.testing.assert_allclose(energy, 0.5 * 5750.0 * 0.02**2 + 0.5 * 1.595e6 * 1e-6, rtol=1e-12)
    damped = BODIES[1].free_vibration(1e-3, 0.02, TIME)
    z = integrated(BODIES[1], lambda t: 0.0, lambda t: 0.0, [0.0, 2.0], start=(1e-3, 0.02))
    np.testing.assert_allclose(damped.displacement, z[0], atol=1e-11)


def test_critical_damping_is_refused():
    with pytest.raises(InputError, match="must be below critical damping"):
        SuspendedBody(1.0, 1.0, 2.0)
