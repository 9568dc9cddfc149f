"""The incremental form with user-written elements: against solve_ivp, order, quadratic convergence, step cutting."""

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.integrate import solve_ivp

from axlespan.dynamics.alpha import Alpha
from axlespan.dynamics.integrator import Integrator, Matrices, State
from axlespan.dynamics.newton import NewtonIntegrator
from axlespan.errors import AnalysisError

N = 4
K = sp.csr_array(
    1e5 * sp.diags_array([-np.ones(N - 1), 2.0 * np.ones(N), -np.ones(N - 1)], offsets=[-1, 0, 1])
)
M = sp.csr_array(sp.diags_array([10.0, 12.0, 8.0, 11.0]))
C = sp.csr_array(2e-4 * K)
MATRICES = Matrices(K, M, C)


class Cubic:
    """Springs k e³ and dashpots c ė |ė| from each d.o.f. to the next one."""

    def __init__(self, k, c):
        self.k, self.c = k, c
        self.B = sp.csr_array(sp.diags_array([np.ones(N), -np.ones(N - 1)], offsets=[0, -1], shape=(N, N)))

    def force(self, u, v, state):
        e, r = self.B @ u, self.B @ v
        return self.B.T @ (self.k * e**3 + self.c * r * np.abs(r))

    def tangent(self, u, v, state):
        e, r = self.B @ u, self.B @ v
        return tuple(
            sp.csr_array(self.B.T @ sp.diags_array(d) @ self.B)
            for d in (3 * self.k * e**2, 2 * self.c * np.abs(r))
        )

    def advanced(self, u, v, state):
        return state


class Slider:
    """Elastic-perfectly plastic: force k (u_0 - p), yielding at F; remembers p."""

    k, limit = 5e5, 400.0

    def _plastic(self, u, p):
        trial = self.k * (u[0] - p)
        return p + np.sign(trial) * max(abs(trial) - self.limit, 0.0) / self.k

    def force(self, u, v, state):
        p = state or 0.0
        f = np.zeros(N)
        f[0] = self.k * (u[0] - self._plastic(u, p))
        return f

    def tangent(self, u, v, state):
        p = state or 0.0
        elastic = abs(self.k * (u[0] - p)) <= self.limit
        k = np.zeros((N, N))
        k[0, 0] = self.k * elastic
        return sp.csr_array(k), sp.csr_array((N, N))

    def advanced(self, u, v, state):
        return self._plastic(u, state or 0.0)


def push(t):
    return np.array([0.0, 0.0, 900.0 * np.sin(40.0 * t), 0.0])


def exact(element, end, points):
    Minv = 1.0 / M.diagonal()

    def rate(t, y):
        u, v = y[:N], y[N:]
        return np.concatenate([v, Minv * (push(t) - K @ u - C @ v - element.force(u, v, None))])

    found = solve_ivp(
        rate, (0.0, end), np.zeros(2 * N), t_eval=points, method="DOP853", rtol=1e-8, atol=1e-10
    )
    return found.y[:N].T


@pytest.mark.parametrize("alpha", [0.0, -0.1])
def test_second_order_against_an_exact_solution(alpha):
    element, errors = Cubic(4e9, 4e3), []
    true = exact(element, 0.2, np.arange(201) * 1e-3)
    for dt in (1e-3, 5e-4, 2.5e-4):
        steps = round(0.2 / dt)
        body = NewtonIntegrator(MATRICES, [element], Alpha(alpha), dt)
        march = body.march(State.at_rest((N,)), push, steps)
        errors.append(np.abs(march.displacement[:: round(1e-3 / dt)] - true).max())
    peak = np.abs(march.displacement).max()
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert errors[-1] < 5e-4 * peak
    assert np.all(np.abs(orders - 2.0) < 0.25), (errors, orders)


def test_without_elements_it_is_the_linear_method():
    body = NewtonIntegrator(MATRICES, [], Alpha(-0.1), 1e-3)
    march = body.march(State.at_rest((N,)), push, 50)
    linear, state = Integrator(MATRICES, Alpha(-0.1), 1e-3), State.at_rest((N,))
    for step in range(50):
        state = linear.step(state, push(step * 1e-3), push((step + 1) * 1e-3))
    np.testing.assert_allclose(march.displacement[-1], state.u, rtol=1e-8)
    assert all(figures.parts == 1 for figures in march.figures)
    assert sum(figures.factorizations for figures in march.figures) == 1


def test_convergence_is_quadratic():
    """With fresh tangents the residual is squared from one iteration to the next."""
    body = NewtonIntegrator(MATRICES, [Cubic(4e12, 0.0)], Alpha(0.0), 4e-3, tolerance=1e-13)
    march = body.march(State.at_rest((N,)), push, 40)
    longest = max(march.figures, key=lambda figures: figures.iterations)
    r = np.array(longest.residuals)
    r = r[(r > 1e-12) & (r < 1e-2)]
    assert len(r) >= 2
    assert r[-1] < 1e3 * r[-2] ** 1.7
    assert longest.factorizations >= 2


def test_plasticity_remembers():
    """The slider's force stays within its limit, and energy is lost by what it slides."""
    body = NewtonIntegrator(MATRICES, [Slider()], Alpha(0.0), 5e-4)
    march = body.march(State.at_rest((N,)), push, 800)
    slider, p, forces = Slider(), 0.0, []
    for u in march.displacement:
        p = slider._plastic(u, p)
        forces.append(slider.k * (u[0] - p))
    assert np.abs(forces).max() == pytest.approx(slider.limit)
    assert march.memory[0] == pytest.approx(p, abs=1e-9)
    assert march.memory[0] != 0.0


class Snapping:
    """A stop that is hit hard: stiffness grows a millionfold behind a gap."""

    gap, k = 1e-4, 1e11

    def force(self, u, v, state):
        f = np.zeros(N)
        f[2] = self.k * np.maximum(u[2] - self.gap, 0.0) ** 1.5
        return f

    def tangent(self, u, v, state):
        k = np.zeros((N, N))
        k[2, 2] = 1.5 * self.k * np.sqrt(np.maximum(u[2] - self.gap, 0.0))
        return sp.csr_array(k), sp.csr_array((N, N))

    def advanced(self, u, v, state):
        return state


def test_steps_are_cut_and_restored():
    body = NewtonIntegrator(MATRICES, [Snapping()], Alpha(-0.1), 4e-3, limit=7, cuts=8, tolerance=1e-8)
    march = body.march(State.at_rest((N,)), lambda t: 40.0 * push(t), 60)
    parts = np.array([figures.parts for figures in march.figures])
    assert parts.max() > 1
    assert (parts == 1).sum() > 10
    assert parts[-1] == 1 or parts.min() == 1


class Wrong(Cubic):
    """Its tangent has the wrong sign."""

    def tangent(self, u, v, state):
        k, c = super().tangent(u, v, state)
        return -0.5 * k, -c

    def force(self, u, v, state):
        return np.full(N, np.nan) if np.abs(u).max() > 1e-3 else super().force(u, v, state)


def test_no_convergence_is_an_outcome():
    body = NewtonIntegrator(
        MATRICES, [Wrong(1e12, 0.0)], Alpha(0.0), 2e-3, cuts=2, dof_names=["a.z", "b.z", "c.z", "d.z"]
    )
    with pytest.raises(
        AnalysisError, match=r"step \d+, t = .* halved 2 times .* worst at d.o.f. [abcd].z"
    ) as caught:
        body.march(State.at_rest((N,)), lambda t: 100.0 * push(t), 100)
    kept = caught.value.result
    assert len(kept.time) == len(kept.figures) + 1
    assert np.all(np.isfinite(kept.displacement))
