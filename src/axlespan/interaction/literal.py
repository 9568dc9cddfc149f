"""The direct method as N12 prints it: the complete system (35), factored by blocks (appendix A), step by step.

Dense and slow; the readable reference for the march that runs. Displacements of structure and vehicles stand in
one vector u_F, vehicles behind the structure.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.dynamics.integrator import State
from axlespan.interaction.bodies import FleetBody, StructureBody
from axlespan.interaction.contact_system import Stretch, stretches
from axlespan.interaction.march import bodies_of, initial_path_load
from axlespan.interaction.plan import Plan
from axlespan.interaction.recorder import Recorder
from axlespan.interaction.start import Start
from axlespan.linalg.bordered import block_factorization

FloatArray = npt.NDArray[np.float64]


@dataclass(eq=False)
class _Complete:
    """Matrices of structure and vehicles together, with the state of the step before (superscript p)."""

    K: FloatArray  # K_FF (n_F, n_F)
    M: FloatArray
    C: FloatArray
    K_bar: FloatArray  # N12 (22)
    state: State
    G: FloatArray  # G_FX of the step before (n_F, n_contact)
    X: FloatArray  # contact forces of the step before (n_contact,)
    P: FloatArray  # external forces of the step before (n_F,)


def march_literal(plan: Plan, start: Start, recorder: Recorder) -> tuple[StructureBody, FleetBody | None]:
    """Compute all steps of a crossing by (15), (18), (20), (23) and (35)."""
    structure, fleet = bodies_of(plan, start)
    structure.path_load[:] = initial_path_load(plan, structure, start)
    recorder.begin(structure, fleet, start.forces)
    complete = _complete(plan, start)
    n = plan.structure.size
    for stretch in stretches(plan, structure, fleet, systems=False):
        for k in range(stretch.n_step):
            _step(plan, complete, stretch, k)
            structure.state = State(*(q[:n] for q in (complete.state.u, complete.state.v, complete.state.a)))
            structure.path_load = -(complete.G[:n] @ complete.X)[structure.path_dofs]
            if fleet is not None:
                fleet.state = State(*(q[n:] for q in (complete.state.u, complete.state.v, complete.state.a)))
                fleet.forces = complete.X[plan.fleet.coupled]
            recorder.step(stretch, k, structure, fleet, complete.X)
        recorder.end_of(stretch)
    return structure, fleet


def _complete(plan: Plan, start: Start) -> _Complete:
    s, v = plan.structure, plan.fleet.matrices
    K, M = (_dense(a, b) for a, b in ((s.K, v.K), (s.M, v.M)))
    C = np.zeros_like(K)
    n = s.size
    C[:n, :n] = s.damping_force(np.eye(n))
    C[n:, n:] = v.damping_force(np.eye(v.size))
    A0, A1, *_ = plan.settings.method.coefficients(plan.settings.time_step)
    alpha = plan.settings.method.alpha
    rows = plan.rows.positions(np.zeros(1))
    state = State(
        *(np.concatenate([getattr(start.structure, q), getattr(start.fleet, q)]) for q in ("u", "v", "a"))
    )
    K_bar = A0 * M + (1 + alpha) * A1 * C + (1 + alpha) * K  # (22)
    return _Complete(K, M, C, K_bar, state, _G(plan, rows), start.forces.copy(), _P(plan, 0.0)[0])


def _dense(a: sp.csr_array, b: sp.csr_array) -> FloatArray:
    return np.asarray(sp.block_diag([a, b]).toarray()) if b.shape[0] else np.asarray(a.toarray())


def _G(plan: Plan, positions: FloatArray) -> FloatArray:
    """G_FX = [-D_IX; 1_XX] of N12 (11) at positions (1, n_contact)."""
    n, wheels = plan.structure.size, np.arange(plan.rows.n_contact)
    block = plan.rows.rows(positions, wheels)
    G = np.zeros((n + plan.fleet.matrices.size, len(wheels)))
    np.add.at(G, (block.dofs[0], wheels[:, None]), -block.weights[0])
    G[n + plan.fleet.dofs, plan.fleet.coupled] = 1.0
    return G


def _P(plan: Plan, time: float) -> tuple[FloatArray, FloatArray]:
    """External forces with the prescribed motions' share of (15), and its inertial part at this time."""
    factors = plan.forces.factors(np.array([time]))[0]
    n, n_v = plan.structure.size, plan.fleet.matrices.size
    P, inertial = np.zeros(n + n_v), np.zeros(n + n_v)
    P[:n] = plan.forces.vectors @ np.where(plan.forces.inertial, 0.0, factors)
    inertial[:n] = plan.forces.vectors @ np.where(plan.forces.inertial, factors, 0.0)
    P[n + plan.fleet.dofs] -= plan.fleet.weight[plan.fleet.coupled]  # gravity, about the static position
    return P, inertial


def _step(plan: Plan, c: _Complete, stretch: Stretch, k: int) -> None:
    settings = plan.settings
    alpha, step = settings.method.alpha, stretch.first + k
    A0, A1, A2, A3, A4, A5 = settings.method.coefficients(settings.time_step)
    p = c.state
    G = _G(plan, stretch.positions[k : k + 1])
    P, inertial = _P(plan, step * settings.time_step)
    F = (1 + alpha) * P - alpha * c.P - alpha * c.G @ c.X + alpha * (c.C @ p.v + c.K @ p.u) + inertial  # (15)
    F_bar = F + c.M @ (A0 * p.u + A2 * p.v + A3 * p.a)  # (23)
    F_bar += (1 + alpha) * c.C @ (A1 * p.u + A4 * p.v + A5 * p.a)
    X = plan.fleet.weight.copy()
    forced, coupled = plan.fleet.forced, plan.fleet.coupled
    F_bar += (1 + alpha) * G[:, forced] @ X[forced]
    G_bar = -(1 + alpha) * G[:, coupled]
    r_bar = -(1 + alpha) * stretch.gap[k]  # (37); H = Gᵀ
    if len(coupled):
        u, X[coupled] = block_factorization(c.K_bar, G_bar.T).solve(F_bar, r_bar)
    else:
        u = np.asarray(np.linalg.solve(c.K_bar, F_bar), dtype=np.float64)
    a = A0 * (u - p.u) - A2 * p.v - A3 * p.a  # (18)
    v = A1 * (u - p.u) - A4 * p.v - A5 * p.a  # (20)
    c.state, c.G, c.X, c.P = State(u, v, a), G, X, P
