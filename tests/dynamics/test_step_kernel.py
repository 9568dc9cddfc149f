"""A step of a large body: the compiled passes against NumPy, for one body and for many side by side."""

import numpy as np
import pytest
import scipy.sparse as sp

from axlespan.dynamics.alpha import Alpha
from axlespan.dynamics.integrator import Integrator, Matrices, State, Stepper
from axlespan.linalg.low_rank import LowRank

N = 260  # large enough for sparse products


def matrices(rng, damping):
    """A chain with some far neighbors; damping of a pattern of its own, of low rank, or none."""
    far = sp.diags_array([-3.0, 8.0 + rng.uniform(size=N), -3.0], offsets=[-7, 0, 7], shape=(N, N))
    K = sp.csr_array(1e3 * (far + sp.diags_array([-1.0, 4.0, -1.0], offsets=[-1, 0, 1], shape=(N, N))))
    M = sp.csr_array(sp.diags_array([0.2, 1.0, 0.2], offsets=[-1, 0, 1], shape=(N, N)))
    C = None
    if "matrix" in damping:  # with rows that have no entry
        own = np.where(np.arange(N) % 3, 5.0, 0.0)
        C = sp.csr_array(sp.diags_array(own))
        C.eliminate_zeros()
    low_rank = LowRank(rng.standard_normal((N, 3)), np.array([0.5, 1.0, 2.0])) if "rank" in damping else None
    return Matrices(K, M, C, low_rank)


def dense_step(m, method, dt, state, force_p, force_c):
    """One step of the alpha method as N12 writes it, in displacements."""
    K, M = m.K.toarray(), m.M.toarray()
    C = m.damping_force(np.eye(N))
    alpha, beta, gamma = method.alpha, method._beta, method._gamma
    u, v, a = state
    ut, vt = u + dt * v + (0.5 - beta) * dt**2 * a, v + (1.0 - gamma) * dt * a
    A = M + (1.0 + alpha) * (gamma * dt * C + beta * dt**2 * K)
    b = (1.0 + alpha) * force_c - alpha * force_p
    b -= C @ ((1.0 + alpha) * vt - alpha * v) + K @ ((1.0 + alpha) * ut - alpha * u)
    new = np.linalg.solve(A, b)
    return np.array([ut + beta * dt**2 * new, vt + gamma * dt * new, new])


@pytest.mark.parametrize("damping", ["none", "matrix", "rank", "matrix and rank"])
@pytest.mark.parametrize("lanes", [0, 1, 3])
@pytest.mark.parametrize("numba", [True, False])
def test_a_step_is_the_alpha_method(damping, lanes, numba, monkeypatch):
    rng = np.random.default_rng(3)
    if not numba:
        for name in ("right_side", "completion", "reading"):
            monkeypatch.setattr(f"axlespan.dynamics.integrator.compiled_{name}", lambda *_: None)
    m, method, dt = matrices(rng, damping), Alpha(-0.1), 0.01
    shape = (3, N) if not lanes else (3, N, lanes)
    values, forces = rng.standard_normal(shape), rng.standard_normal((2, *shape[1:]))
    added = rng.standard_normal(shape[1:])
    stepper = Stepper(Integrator(m, method, dt), State(values.copy()))
    for force in (True, False):
        before = stepper.state.values.copy()
        given = forces if force else np.zeros_like(forces)
        expected = dense_step(m, method, dt, before, *given)
        stepper.force[...] = 1.1 * 9.0  # what stands there is not looked at when there is none
        if force:
            stepper.force[...] = 0.9 * forces[1] + 0.1 * forces[0]
        stepper.predict(forceless=not force)
        stepper.finish(added)
        expected += np.array([0.3025 * dt**2, 0.6 * dt, 1.0]).reshape(3, *[1] * (len(shape) - 1)) * added
        for got, wanted in zip(stepper.state.values, expected, strict=True):
            np.testing.assert_allclose(got, wanted, rtol=0.0, atol=1e-12 * np.abs(wanted).max())
