"""The whole method written out again, dense and plain, from N12's equations: displacements, forces, reactions."""

import numpy as np
import pytest

from axlespan.bridges.spans import SupportAt, simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.simulate import simulate
from axlespan.irregularity import Harmonic
from axlespan.linalg.bordered import complete_matrix, symmetry_error
from axlespan.model.damping import Modal, Rayleigh
from axlespan.model.motions import HarmonicMotion
from axlespan.vehicles.simple import rigid_body, sprung_mass
from axlespan.vehicles.train import Train

BEAM = {"length": 12.0, "youngs_modulus": 2.87e9, "second_moment": 0.9, "mass_per_length": 1800.0}


def block_diagonal(blocks):
    total = np.zeros((sum(map(len, blocks)),) * 2)
    at = 0
    for block in blocks:
        total[at : at + len(block), at : at + len(block)] = block
        at += len(block)
    return total


class ByHand:
    """All d.o.f. of structure and vehicles in one vector, free (F) and prescribed (P), stepped by N12 (15) to (35).

    Right only for a start from rest before the structure, without irregularity under the wheels at t = 0.
    """

    def __init__(self, crossing, method, dt):
        self.crossing, self.method, self.dt = crossing, method, dt
        structure, vehicles = crossing.structure.system, [p.vehicle for p in crossing.train.placements]
        systems = [structure, *(v.system for v in vehicles)]
        self.K, self.M, self.C = (
            block_diagonal([getattr(s, name).toarray() for s in systems])
            for name in ("stiffness", "mass", "damping")
        )
        if structure.modal_damping is not None:
            low = structure.modal_damping
            self.C[np.ix_(structure.free, structure.free)] += (low.vectors * low.coefficients) @ low.vectors.T
        self.n_s, n = structure.size, len(self.K)
        self.P = structure.prescribed
        self.F = np.setdiff1d(np.arange(n), self.P)
        self.contact_dofs, self.weight = [], []
        at = self.n_s
        for v in vehicles:
            system = v.system
            self.contact_dofs += [
                at + list(system.independent).index(system.dof(point.dof)) for point in v.contacts
            ]
            self.weight += list(v.static_forces())
            at += system.size
        self.weight = np.array(self.weight)

    def G_and_r(self, t):
        """[-D; 1] over all d.o.f. (n, n_contact), and r under the wheels."""
        s = self.crossing.start + self.crossing.speed * t - self.crossing.train.offsets
        E = self.crossing.structure.lines["main"].rows(s, self.n_s).toarray()
        G = np.zeros((len(self.K), len(s)))
        G[: self.n_s] = -E.T
        G[self.contact_dofs, np.arange(len(s))] = 1.0
        return G, self.crossing.irregularity.value(s)

    def prescribed(self, t):
        motions = self.crossing.structure.system.motions
        return [
            np.array([float(getattr(m, name)(np.array([t]))[0]) for m in motions])
            for name in ("value", "velocity", "acceleration")
        ]

    def external(self, t):
        """P_F: loads on the structure, and the weights of the vehicles about their static position."""
        P = np.zeros(len(self.K))
        for load in self.crossing.structure.system.loads:
            P[: self.n_s] += load.vector * float(load.factor(np.array([t]))[0])
        P[self.contact_dofs] -= self.weight
        return P

    def run(self, steps):
        F, P, al = self.F, self.P, self.method.alpha
        A0, A1, A2, A3, A4, A5 = self.method.coefficients(self.dt)
        K, M, C = (
            {(a, b): X[np.ix_(i, j)] for a, i in (("F", F), ("P", P)) for b, j in (("F", F), ("P", P))}
            for X in (self.K, self.M, self.C)
        )
        u, v, a = np.zeros((3, len(F)))
        up, vp, ap = self.prescribed(0.0)
        G, _ = self.G_and_r(0.0)
        X, ext = self.weight.copy(), self.external(0.0)
        # At rest, but not in balance if supports move off at once.
        a[:] = np.linalg.lstsq(
            M["F", "F"], (ext + G @ X)[F] - M["F", "P"] @ ap - C["F", "P"] @ vp - K["F", "P"] @ up, rcond=None
        )[0]
        R = M["P", "F"] @ a + M["P", "P"] @ ap + C["P", "P"] @ vp + K["P", "P"] @ up - (ext + G @ X)[P]
        K_bar = A0 * M["F", "F"] + (1 + al) * A1 * C["F", "F"] + (1 + al) * K["F", "F"]  # (22)
        history, worst = [(u, X, R, a)], 0.0
        for i in range(1, steps + 1):
            t = i * self.dt
            (up_c, vp_c, ap_c), (G_c, r), ext_c = self.prescribed(t), self.G_and_r(t), self.external(t)
            f = (1 + al) * ext_c[F] - al * ext[F] - al * G[F] @ X  # (15)
            f -= M["F", "P"] @ ap_c + (1 + al) * C["F", "P"] @ vp_c - al * C["F", "P"] @ vp
            f -= (
                (1 + al) * K["F", "P"] @ up_c
                - al * K["F", "P"] @ up
                - al * (C["F", "F"] @ v + K["F", "F"] @ u)
            )
            f += M["F", "F"] @ (A0 * u + A2 * v + A3 * a)  # (23)
            f += (1 + al) * C["F", "F"] @ (A1 * u + A4 * v + A5 * a)
            # H u_F = r + E_XP u_P (31) with H = Gᵀ: (34), (35)
            r_bar = -(1 + al) * (r - G_c[P].T @ up_c)
            matrix = complete_matrix(K_bar, -(1 + al) * G_c[F])
            worst = max(worst, symmetry_error(matrix))
            scale = K_bar.diagonal().mean()
            matrix[len(F) :] *= scale
            solution = np.linalg.solve(matrix, np.concatenate([f, scale * r_bar]))
            u_c, X_c = solution[: len(F)], solution[len(F) :]
            a_c = A0 * (u_c - u) - A2 * v - A3 * a  # (18)
            v_c = A1 * (u_c - u) - A4 * v - A5 * a  # (20)
            q = al / (1 + al)
            R_c = q * R - ext_c[P] + q * ext[P] - G_c[P] @ X_c + q * G[P] @ X  # (13); D_P = -G_P
            R_c += (M["P", "F"] @ a_c + M["P", "P"] @ ap_c) / (1 + al)
            R_c += C["P", "F"] @ v_c + C["P", "P"] @ vp_c - q * (C["P", "F"] @ v + C["P", "P"] @ vp)
            R_c += K["P", "F"] @ u_c + K["P", "P"] @ up_c - q * (K["P", "F"] @ u + K["P", "P"] @ up)
            u, v, a, X, G, ext, R, up, vp = u_c, v_c, a_c, X_c, G_c, ext_c, R_c, up_c, vp_c
            history.append((u, X, R, a))
        return (np.array(x) for x in zip(*history, strict=True)), worst


BUMP = Harmonic(amplitude=0.5e-3, wavelength=3.0, start=0.0, stop=9.0)
CAR = rigid_body(mass=9e3, pitch_inertia=2e4, axles=[0.0, 2.6], stiffness=1.2e6, damping=1.5e4, center=1.1)
TRAIN = Train.joined(
    [Train.of(CAR), Train.of(sprung_mass(mass=4e3, stiffness=9e5, unsprung_mass=300.0))], [3.0]
)
LIGHT = Train.joined([Train.of(CAR), Train.of(sprung_mass(mass=4e3, stiffness=9e5))], [3.0])
STILL = simple_span(elements=4, **BEAM)
DAMPED = simple_span(elements=4, damping=Rayleigh(0.5, 3e-4), **BEAM)
MODAL = simple_span(elements=4, damping=Modal(0.03), **BEAM)
ELASTIC = simple_span(
    elements=4,
    area=3.0,
    shear_area=2.0,
    supports=[
        SupportAt(0.0, fixed=("x",), stiffness={"z": 5e7}, damping={"z": 2e5}),
        SupportAt(12.0, fixed=(), stiffness={"z": 4e7}),
    ],
    **BEAM,
)
# Moves off from rest: velocity and displacement are zero at t = 0, the acceleration is not.
QUAKE = simple_span(
    elements=4,
    damping=Rayleigh(0.0, 3e-4),
    supports=[
        SupportAt(0.0, fixed=(), motion={"z": HarmonicMotion(2e-3, 3.0, 0.0)}),
        SupportAt(12.0, fixed=("z",)),
    ],
    **BEAM,
)
CASES = {
    "Newmark": (STILL, LIGHT, Alpha(0.0)),
    "alpha": (STILL, TRAIN, Alpha(-0.1)),
    "Rayleigh": (DAMPED, TRAIN, Alpha(-0.2)),
    "modal": (MODAL, LIGHT, Alpha(-0.05)),
    "elastic": (ELASTIC, TRAIN, Alpha(-0.1)),
    "elastic, Newmark": (ELASTIC, LIGHT, Alpha(0.0)),
}


def both(name, steps=300, dt=2e-3, bridge=None):
    structure, train, method = CASES[name] if bridge is None else bridge
    crossing = Crossing(structure, train, speed=30.0, start=-0.5, irregularity=BUMP)
    by_hand = ByHand(crossing, method, dt)
    (u, X, R, a), symmetry = by_hand.run(steps)
    names = [structure.system.free_name(i) for i in range(len(structure.system.free))]
    result = simulate(
        crossing, time_step=dt, steps=steps, method=method, footprint=0.0, sensors={"m": 6.0, "q": 1.7}
    )
    return by_hand, names, u, X, R, a, result, symmetry


@pytest.mark.parametrize("name", CASES)
def test_agrees_with_the_equations_by_hand(name):
    by_hand, names, u, X, R, _, result, symmetry = both(name)
    assert symmetry < 1e-15  # of (35): Betti
    middle = result.at("sensor_displacement", "m")
    np.testing.assert_allclose(middle, u[:, names.index("n3.z")], atol=1e-9 * np.abs(middle).max())
    np.testing.assert_allclose(result.contact_force, X, atol=1e-8 * np.abs(X).max())
    np.testing.assert_allclose(result.support_reaction, R, atol=1e-8 * np.abs(R).max())
    vehicles = u[:, len(names) :]
    scale = np.abs(vehicles).max()
    np.testing.assert_allclose(result.vehicle_displacement, vehicles, atol=1e-9 * scale)
    assert np.abs(result.contact_force / by_hand.weight - 1.0).max() > 0.02


@pytest.mark.parametrize("name", ["Newmark", "elastic, Newmark"])
def test_reactions_balance_loads_and_inertia(name):
    """Σ R = Σ wheels on the structure - Σ M ü, from the accelerations by hand (α = 0)."""
    by_hand, names, _, X, _, a, result, _ = both(name)
    system = by_hand.crossing.structure.system
    t = system.translation("z")
    inertia = a[:, : len(names)] @ (system.mass.toarray() @ t)[system.free]
    s = by_hand.crossing.start + 30.0 * result.time[:, None] - by_hand.crossing.train.offsets
    on = (s >= 0.0) & (s <= 12.0)
    vertical = np.array([name.endswith(".z") for name in result.support], float)
    missing = result.support_reaction @ vertical - (X * on).sum(axis=1) - inertia
    assert np.abs(missing).max() < 1e-8 * np.abs(X).max()
    assert np.abs(inertia).max() > 0.05 * np.abs(X).max()


@pytest.mark.parametrize("alpha", [0.0, -0.1])
def test_supports_that_move(alpha):
    """A harmonic base whose velocity jumps at t = 0; the structure is at rest then."""
    structure, method = QUAKE, Alpha(alpha)
    _, names, u, X, R, _, result, _ = both(
        "quake", bridge=(structure, LIGHT if alpha == 0.0 else TRAIN, method)
    )
    quarter = np.zeros(len(names))
    line = structure.lines["main"].rows([1.7], structure.system.size).toarray()[0]
    quarter = u[:, : len(names)] @ line[structure.system.free]
    motion = structure.system.motions[0]
    quarter += line[structure.system.prescribed[0]] * motion.value(result.time)
    scale = np.abs(quarter).max()
    np.testing.assert_allclose(result.at("sensor_displacement", "q"), quarter, atol=1e-8 * scale)
    np.testing.assert_allclose(result.contact_force, X, atol=1e-7 * np.abs(X).max())
    np.testing.assert_allclose(result.support_reaction, R, atol=1e-7 * np.abs(R).max())
