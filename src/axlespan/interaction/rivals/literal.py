"""The direct method as N12 prints it: the complete system (35), factored by blocks (appendix A), step by step.

Dense and slow; the readable reference for the march that runs. Displacements of structure and vehicles stand in
one vector u_F, vehicles behind the structure. What it needs of the step before, (superscript p), it reads
from the states that the other ways of coupling leave as well.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.interaction.contact_system import Stretch
from axlespan.interaction.convoy import Convoy
from axlespan.interaction.plan import Plan
from axlespan.linalg.bordered import block_factorization

FloatArray = npt.NDArray[np.float64]


def couple_literally(convoy: Convoy, stretch: Stretch, k: int, external: FloatArray | None) -> FloatArray:
    """One step of a single lane by (15), (18), (20), (23) and (35); ``external`` is computed anew here."""
    plan, structure, fleet = convoy.plans[0], convoy.structure, convoy.fleet
    settings, n, step = plan.settings, plan.structure.size, stretch.first + k
    alpha = settings.method.alpha
    A0, A1, A2, A3, A4, A5 = settings.method.coefficients(settings.time_step)
    K, M, C = complete_matrices(plan)
    u_p, v_p, a_p = structure.state.values.copy()
    if fleet is not None:
        u_p, v_p, a_p = np.concatenate([[u_p, v_p, a_p], fleet.state.values], axis=1)
    X_p = convoy.joint.weight.copy()
    X_p[convoy.joint.coupled] = convoy.joint.weight[:0] if fleet is None else fleet.forces
    G_p, G = (contact_matrix(plan, i) for i in (step - 1, step))
    P_p, _ = _external(plan, step - 1)
    P, inertial = _external(plan, step)
    K_bar = A0 * M + (1 + alpha) * A1 * C + (1 + alpha) * K  # (22)
    F = (1 + alpha) * P - alpha * P_p - alpha * G_p @ X_p + alpha * (C @ v_p + K @ u_p) + inertial  # (15)
    F_bar = F + M @ (A0 * u_p + A2 * v_p + A3 * a_p)  # (23)
    F_bar += (1 + alpha) * C @ (A1 * u_p + A4 * v_p + A5 * a_p)
    forced, coupled = plan.fleet.forced, plan.fleet.coupled
    X = plan.fleet.weight.copy()
    F_bar += (1 + alpha) * G[:, forced] @ X[forced]  # moving forces are known
    if len(coupled):
        G_bar = -(1 + alpha) * G[:, coupled]  # (26); H̄ = Ḡᵀ
        r_bar = -(1 + alpha) * stretch.gap[k]  # (37)
        u, X[coupled] = block_factorization(K_bar, G_bar.T).solve(F_bar, r_bar)  # (35)
    else:
        u = np.asarray(np.linalg.solve(K_bar, F_bar), dtype=np.float64)
    a = A0 * (u - u_p) - A2 * v_p - A3 * a_p  # (18)
    v = A1 * (u - u_p) - A4 * v_p - A5 * a_p  # (20)
    structure.put(np.array([u[:n], v[:n], a[:n]]), -(G[:n] @ X))
    if fleet is not None:
        fleet.put(np.array([u[n:], v[n:], a[n:]]), X[coupled])
    return X


def complete_matrices(plan: Plan) -> tuple[FloatArray, FloatArray, FloatArray]:
    """K_FF, M_FF and C_FF (n_F, n_F) of structure and vehicles together."""
    s, v = plan.structure, plan.fleet.matrices
    K, M = (
        np.asarray(sp.block_diag([a, b]).toarray()) if v.size else np.asarray(a.toarray())
        for a, b in ((s.K, v.K), (s.M, v.M))
    )
    C = np.zeros_like(K)
    C[: s.size, : s.size] = s.damping_force(np.eye(s.size))
    C[s.size :, s.size :] = v.damping_force(np.eye(v.size))
    return K, M, C


def contact_matrix(plan: Plan, step: int) -> FloatArray:
    """G_FX = [-D_IX; 1_XX] (n_F, n_contact) of N12 (11) at a time index."""
    n, wheels = plan.structure.size, np.arange(plan.rows.n_contact)
    block = plan.rows.rows(plan.rows.positions(plan.times_of(np.array([step]))), wheels)
    G = np.zeros((n + plan.fleet.matrices.size, len(wheels)))
    np.add.at(G, (block.dofs[0], wheels[:, None]), -block.weights[0])
    G[n + plan.fleet.dofs, plan.fleet.coupled] = 1.0
    return G


def _external(plan: Plan, step: int) -> tuple[FloatArray, FloatArray]:
    """External forces with the prescribed motions' share of (15), and its inertial part, at a time index."""
    factors = plan.forces.factors(plan.times_of(np.array([step])))[0]
    n, n_v = plan.structure.size, plan.fleet.matrices.size
    P, inertial = np.zeros(n + n_v), np.zeros(n + n_v)
    P[:n] = plan.forces.vectors @ np.where(plan.forces.inertial, 0.0, factors)
    inertial[:n] = plan.forces.vectors @ np.where(plan.forces.inertial, factors, 0.0)
    P[n + plan.fleet.dofs] -= plan.fleet.weight[plan.fleet.coupled]  # gravity, about the static position
    return P, inertial
