"""One body in time against closed forms, and against N12's displacement form by hand."""

import itertools

import numpy as np
import pytest
import scipy.sparse as sp

from axlespan.dynamics.alpha import Alpha
from axlespan.dynamics.integrator import Integrator, Matrices, State, Stepper
from axlespan.linalg.low_rank import LowRank
from axlespan.reference import SuspendedBody

METHODS = [Alpha(0.0), Alpha(-0.1), Alpha(-0.25, beta=0.5, gamma=0.9), Alpha(0.0, beta=0.3025, gamma=0.6)]


def random_body(n=6, seed=9, damping=True):
    rng = np.random.default_rng(seed)
    k, m, c = (q @ q.T + np.eye(n) for q in rng.normal(size=(3, n, n)))
    return 400.0 * k, m, 3.0 * c if damping else None


def sparse(k, m, c=None, low_rank=None):
    return Matrices(sp.csr_array(k), sp.csr_array(m), None if c is None else sp.csr_array(c), low_rank)


def by_hand(k, m, c, method, dt, state, forces):
    """N12 (15), (18), (20), (22), (23): dense, displacements as unknowns."""
    a0, a1, a2, a3, a4, a5 = method.coefficients(dt)
    alpha = method.alpha
    k_bar = a0 * m + (1 + alpha) * a1 * c + (1 + alpha) * k
    u, v, a = state
    history = []
    for f_p, f_c in itertools.pairwise(forces):
        f = (1 + alpha) * f_c - alpha * f_p + alpha * c @ v + alpha * k @ u
        f = f + m @ (a0 * u + a2 * v + a3 * a) + (1 + alpha) * c @ (a1 * u + a4 * v + a5 * a)
        new = np.linalg.solve(k_bar, f)
        u, v, a = (
            new,
            a1 * (new - u) - a4 * v - a5 * a,
            a0 * (new - u) - a2 * v - a3 * a,
        )
        history.append((u, v, a))
    return np.array(history)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("damping", [True, False])
@pytest.mark.parametrize("n", [6, 210])  # small bodies hold dense matrices
def test_steps_are_those_of_n12(method, damping, n):
    k, m, c = random_body(n, damping=damping)
    rng, dt = np.random.default_rng(1), 0.05
    forces = rng.normal(size=(31, n))
    u, v = rng.normal(size=(2, n))
    a = np.linalg.solve(m, forces[0] - k @ u - (0.0 if c is None else c @ v))
    expected = by_hand(k, m, np.zeros((n, n)) if c is None else c, method, dt, (u, v, a), forces)
    body, state = Integrator(sparse(k, m, c), method, dt), State.of(u, v, a)
    for i in range(30):
        state = body.step(state, forces[i], forces[i + 1])
        for got, want in zip((state.u, state.v, state.a), expected[i], strict=True):
            np.testing.assert_allclose(got, want, atol=1e-11 * np.abs(expected).max())


@pytest.mark.parametrize("method", METHODS[:3])
@pytest.mark.parametrize("n", [6, 210])
def test_low_rank_damping_is_damping(method, n):
    k, m, _ = random_body(n)
    rng = np.random.default_rng(3)
    low_rank = LowRank(rng.normal(size=(n, 2)), np.array([2.0, 0.7]))
    dense = (low_rank.vectors * low_rank.coefficients) @ low_rank.vectors.T
    forces = rng.normal(size=(21, n))
    one = Integrator(sparse(k, m, low_rank=low_rank), method, 0.05)
    two = Integrator(sparse(k, m, dense), method, 0.05)
    p, q = State.at_rest((n,)), State.at_rest((n,))
    for i in range(20):
        p, q = one.step(p, forces[i], forces[i + 1]), two.step(q, forces[i], forces[i + 1])
        np.testing.assert_allclose(p.u, q.u, atol=1e-14)
        np.testing.assert_allclose(p.a, q.a, atol=1e-11)


@pytest.mark.parametrize("method", METHODS[:2])
def test_a_step_in_two_halves(method):
    """A force given afterwards, as an acceleration A⁻¹ (1+α) f, is the same as one given before."""
    k, m, c = random_body()
    rng = np.random.default_rng(4)
    body = Integrator(sparse(k, m, c), method, 0.02)
    start = State.of(*rng.normal(size=(3, 6)))
    f_p, f_c, late = rng.normal(size=(3, 6))
    whole = body.step(start, f_p, f_c + late)
    halves = Stepper(body, start.copy())
    halves.force[...] = (1 + method.alpha) * f_c - method.alpha * f_p
    halves.predict()
    alone = body.step(start, f_p, f_c)
    np.testing.assert_allclose(halves.displacement(np.arange(6)), alone.u, atol=1e-12)
    halves.add(body.factor.solve((1 + method.alpha) * late))
    np.testing.assert_allclose(halves.displacement(np.array([[4, 0]])), whole.u[[[4, 0]]], atol=1e-12)
    halves.finish()
    np.testing.assert_allclose(halves.state.values, whole.values, atol=1e-11)


@pytest.mark.parametrize("n", [6, 210])
def test_several_states_at_once(n):
    k, m, c = random_body(n)
    rng = np.random.default_rng(5)
    body = Integrator(sparse(k, m, c), Alpha(-0.1), 0.02)
    states, forces = rng.normal(size=(3, n, 4)), rng.normal(size=(2, n, 4))
    together = body.step(State.of(*(np.ascontiguousarray(x) for x in states)), *forces)
    for j in range(4):
        alone = body.step(State.of(*(np.ascontiguousarray(x[:, j]) for x in states)), *forces[:, :, j])
        np.testing.assert_allclose(together.u[:, j], alone.u, atol=1e-13)
        np.testing.assert_allclose(together.a[:, j], alone.a, atol=1e-11)


@pytest.mark.parametrize("solver", ["banded", "superlu"])
def test_solvers_agree(solver):
    k, m, c = random_body()
    forces = np.random.default_rng(6).normal(size=(2, 6))
    reference = Integrator(sparse(k, m, c), Alpha(-0.1), 0.02).step(State.at_rest((6,)), *forces)
    other = Integrator(sparse(k, m, c), Alpha(-0.1), 0.02, solver=solver).step(State.at_rest((6,)), *forces)
    np.testing.assert_allclose(other.a, reference.a, rtol=1e-11)


def test_columns_of_the_inverse():
    k, m, c = random_body(n=80)
    method = Alpha(-0.1)
    body = Integrator(sparse(k, m, c), method, 0.02)
    effective = m + 0.9 * method.gamma * 0.02 * c + 0.9 * method.beta * 0.02**2 * k
    np.testing.assert_allclose(body.effective.toarray(), effective, rtol=1e-12)
    dofs = np.random.default_rng(7).permutation(80)[:70]
    np.testing.assert_allclose(body.columns(dofs) @ effective, np.eye(80)[dofs], atol=1e-10)


def test_step_leaves_its_input_alone():
    k, m, c = random_body()
    body, state, force = Integrator(sparse(k, m, c), Alpha(-0.1), 0.02), State.at_rest((6,)), np.ones(6)
    body.step(state, force, force)
    assert np.all(state.u == 0.0)
    assert np.all(force == 1.0)


class TestOscillator:
    BODY = SuspendedBody(mass=2.0, stiffness=800.0, damping=4.0)  # ω = 20 rad/s, ζ = 5 %

    @classmethod
    def matrices(cls, damping=True):
        one = sp.csr_array([[1.0]])
        return Matrices(800.0 * one, 2.0 * one, 4.0 * one if damping else None)

    def march(self, method, dt, until, state, force=None, damping=True):
        body = Integrator(self.matrices(damping), method, dt)
        n = round(until / dt)
        history = np.empty((n + 1, 3))
        history[0] = state.u[0], state.v[0], state.a[0]
        for i in range(n):
            f = [np.array([0.0 if force is None else force(t)]) for t in (i * dt, (i + 1) * dt)]
            state = body.step(state, *f)
            history[i + 1] = state.u[0], state.v[0], state.a[0]
        return np.arange(n + 1) * dt, history

    def test_free_vibration(self):
        u, v = 0.01, -0.3
        a = -(800.0 * u + 4.0 * v) / 2.0
        t, history = self.march(Alpha(0.0), 1e-3, 1.0, State.of(*np.array([[u], [v], [a]])))
        exact = self.BODY.free_vibration(u, v, t)
        # Period error ω²Δt²/12 of the trapezoidal rule, over 20 rad: 1.3e-3 / ... of the amplitude 0.018.
        assert np.abs(history[:, 0] - exact.displacement).max() < 20.0 * (20e-3) ** 2 / 12 * 0.019
        assert np.abs(history[:, 2] - exact.acceleration).max() < 20.0 * (20e-3) ** 2 / 12 * 0.019 * 400 * 1.2

    @pytest.mark.parametrize(
        ("method", "order"),
        [(Alpha(0.0), 2.0), (Alpha(-0.1), 2.0), (Alpha(-0.3), 2.0), (Alpha(0.0, 0.36, 0.7), 1.0)],
    )
    def test_order_of_accuracy(self, method, order):
        """Under a harmonic force from rest: displacement, velocity and acceleration.

        M ü^c = (1+α) f^c - α f^p: with α < 0 the acceleration is that of the time t + αΔt, to second order.
        """
        w, p = 13.0, 5.0

        def exact(t):
            zeta, omega = 0.05, 20.0
            damped = omega * np.sqrt(1 - zeta**2)
            response = p / 2.0 / (omega**2 - w**2 + 2j * zeta * omega * w)
            u0, v0 = -response.imag, -(1j * w * response).imag
            decay = np.exp(-zeta * omega * t)
            free = decay * (u0 * np.cos(damped * t) + (v0 + zeta * omega * u0) / damped * np.sin(damped * t))
            return (response * np.exp(1j * w * t)).imag + free

        errors = []
        for dt in (4e-3, 2e-3, 1e-3):
            t, history = self.march(method, dt, 0.8, State.at_rest((1,)), lambda t: p * np.sin(w * t))
            h, late = 1e-4, t + method.alpha * dt
            velocity, shifted = ((exact(x + h) - exact(x - h)) / (2 * h) for x in (t, late))
            acceleration = (p * np.sin(w * late) - 4.0 * shifted - 800.0 * exact(late)) / 2.0
            wanted = (exact(t), velocity, acceleration)
            errors.append([np.abs(history[1:, i] - x[1:]).max() for i, x in enumerate(wanted)])
        orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
        np.testing.assert_allclose(orders[-1], order, atol=0.15)

    def test_newmark_keeps_the_energy(self):
        state = State.of(np.array([0.01]), np.array([0.2]), np.array([-4.0]))
        _, history = self.march(Alpha(0.0), 0.03, 30.0, state, damping=False)
        energy = 0.5 * 800.0 * history[:, 0] ** 2 + 0.5 * 2.0 * history[:, 1] ** 2
        np.testing.assert_allclose(energy, 0.08, rtol=1e-11)

    def test_alpha_damps_what_the_step_cannot_resolve(self):
        """ωΔt = 60: the spectral radius at infinity is (1+α) / (1-α) for the default parameters."""
        state = State.of(np.array([0.01]), np.array([0.0]), np.array([-4.0]))
        _, history = self.march(Alpha(-0.1), 3.0, 120.0, state, damping=False)
        decay = np.abs(history[30:40, 0]).max() / np.abs(history[20:30, 0]).max()
        assert decay**0.1 == pytest.approx(0.9 / 1.1, rel=0.02)

    def test_static_load(self):
        """A constant force from rest swings about its static displacement: mean P/k, peak 2 P/k."""
        _, history = self.march(
            Alpha(0.0),
            1e-3,
            np.pi / 20.0 * 4,
            State.of(*np.array([[0.0], [0.0], [5.0]])),
            lambda t: 10.0,
            damping=False,
        )
        assert history[:, 0].max() == pytest.approx(2 * 10.0 / 800.0, rel=1e-4)
