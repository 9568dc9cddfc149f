r"""How a run starts where contact or track is nonlinear: static equilibrium by Newton's method.

With the static stiffness k of the vehicles, condensed to their contact points, and the static compliance Z of the
structure under wheels and nonlinear springs, the unknowns are the contact points' displacements u_X and the
springs' deviations q from their reference stiffness:

.. math:: X = X_{st} + k u_X, \qquad δ = r + E u_0 - Z_{ww} X - Z_{ws} q - u_X, \qquad
          e = B u_0 - Z_{sw} X - Z_{ss} q

with X = F(δ), or δ = 0, or 0 <= X ⟂ δ <= 0 of the wheels' laws, and q = Q(e) of the springs.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.contact.laws_of_wheels import WheelLaws
from axlespan.dynamics.integrator import State
from axlespan.errors import AnalysisError
from axlespan.interaction.nonlinear.balance import Balance
from axlespan.interaction.nonlinear.springs import Springs, slope_times
from axlespan.interaction.nonlinear.static_columns import StaticColumns
from axlespan.interaction.plan import Plan
from axlespan.interaction.start import (
    ContactRows,
    Start,
    StartFactors,
    about_to_enter,
    condensed_stiffness,
    entering,
)
from axlespan.linalg.factor import factorize

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_LIMIT, _TOLERANCE, _HALVINGS = 100, 1e-12, 10
_FOLLOWS = 100  # iterations of the approaches of wheels that follow the line


@dataclass(frozen=True, eq=False)
class NonlinearStart:
    """The state at time zero, with what the interface remembers."""

    start: Start
    approach: FloatArray  # (n_coupled,) from the static one on level ground [m]
    deviation: FloatArray  # (n_spring,) [N]
    touching: npt.NDArray[np.bool_]  # (n_coupled,) constrained wheels on the line


def nonlinear_start(
    plan: Plan, laws: WheelLaws, balance: Balance, factors: StartFactors, springs: Springs
) -> NonlinearStart:
    """Static equilibrium, then the velocities and accelerations that the motion along the line asks for.

    Raises
    ------
    AnalysisError
        If the equilibrium is not found.
    """
    rows, fleet, x = balance.rows(0.0), plan.fleet, plan.fleet.coupled
    statics = _Statics(plan, laws, rows, factors, springs)
    u_x, deviation = statics.solve()
    forces, approach, elongation = statics.at(u_x, deviation)
    if springs.n:
        deviation, _ = springs.static_deviation(elongation)  # exactly zero where a law follows its reference
    structure, vehicles = State.at_rest((plan.structure.size,)), State.at_rest((fleet.matrices.size,))
    standing = fleet.weight.copy()
    standing[x] = forces
    u_e, structure.v[:] = entering(plan, rows, standing)
    structure.u[:] = statics.deflection(forces, deviation) + u_e
    vehicles.u[:] = _vehicles(plan, u_x + (rows.E @ u_e)[x])
    touching = laws.rigid | (laws.unilateral & (forces + statics.stiffness * approach > 0.0))
    approach[touching] = 0.0
    speed, _ = plan.rows.motion(0.0)
    vehicles.v[fleet.dofs] = (rows.rate + speed * (rows.E1 @ structure.u) + rows.E @ structure.v)[x]
    inner = -(springs.rows.T @ deviation) if springs.n else None
    forces[laws.unilateral & ~touching] = 0.0
    forces[laws.may_part & (forces < _TOLERANCE * statics.scale)] = 0.0  # rounding is no tension
    total = _moving(balance, rows, (structure, vehicles), touching, forces, approach, inner)
    load = np.asarray(rows.E.T @ total)
    if springs.n:
        load = load + springs.rows.T @ deviation
        springs.begin(elongation)
    return NonlinearStart(Start(structure, vehicles, total, load), approach, deviation, touching)


def _moving(
    balance: Balance,
    rows: ContactRows,
    bodies: tuple[State, State],
    touching: npt.NDArray[np.bool_],
    forces: FloatArray,
    approach: FloatArray,
    inner: FloatArray | None,
) -> FloatArray:
    """Set accelerations as the motion along the line asks for them; contact forces (n_contact,).

    Wheels on compliant contacts follow the line too: approaches change from those at rest until the law gives the
    force that this takes.
    """
    laws, fleet, x = balance.laws, balance.plan.fleet, balance.plan.fleet.coupled
    structure, vehicles = bodies
    follows = touching | (~laws.constrained & (forces > 0.0))
    at_rest, u_x, total = approach.copy(), vehicles.u[fleet.dofs].copy(), fleet.weight.copy()
    for _ in range(_FOLLOWS):
        given = fleet.weight.copy()
        given[x] = np.where(follows, 0.0, forces)
        total, _ = balance.accelerate(rows, structure, vehicles, 0.0, follows, given, inner)
        wanted = np.where(follows & ~touching, laws.approach(total[x]), approach)
        if np.any(wanted[follows & ~touching] + laws.indentation[follows & ~touching] <= 0.0):
            break
        change = float(np.abs(wanted - approach).max(initial=0.0))
        approach[:] = wanted
        vehicles.u[fleet.dofs] = u_x - (approach - at_rest)
        if change <= 1e-15:
            return total
    approach[:], vehicles.u[fleet.dofs] = at_rest, u_x  # contacts too soft to follow: they start from rest
    given = fleet.weight.copy()
    given[x] = np.where(touching, 0.0, forces)
    total, _ = balance.accelerate(rows, structure, vehicles, 0.0, touching, given, inner)
    return total


def _vehicles(plan: Plan, u_x: FloatArray) -> FloatArray:
    """Displacements of the vehicles at rest with their contact points at u_X."""
    fleet = plan.fleet
    u = np.zeros(fleet.matrices.size)
    u[fleet.dofs] = u_x
    rest = np.setdiff1d(np.arange(fleet.matrices.size), fleet.dofs)
    if len(rest) and np.any(u):
        stiffness = sp.csr_array(fleet.matrices.K)
        u[rest] = factorize(sp.csr_array(stiffness[rest][:, rest])).solve(-(stiffness[rest] @ u))
    return u


def _step(jacobian: FloatArray, residual: FloatArray) -> FloatArray:
    """The Newton step; the smallest one where a vehicle may move freely for want of contacts."""
    if not len(residual):
        return residual
    try:
        return np.asarray(np.linalg.solve(jacobian, residual), dtype=np.float64)
    except np.linalg.LinAlgError:
        return np.asarray(np.linalg.lstsq(jacobian, residual, rcond=1e-14)[0], dtype=np.float64)


class _Statics:
    """The equations of rest at time zero."""

    def __init__(
        self, plan: Plan, laws: WheelLaws, rows: ContactRows, factors: StartFactors, springs: Springs
    ) -> None:
        self.plan, self.laws, self.springs = plan, laws, springs
        fleet, x = plan.fleet, plan.fleet.coupled
        self.weight = fleet.weight[x]
        self.k = condensed_stiffness(fleet)[np.ix_(x, x)]
        external = plan.forces.static(0.0)
        forced, carried = fleet.forced, sp.diags_array((~about_to_enter(plan)).astype(float))
        at_rest = sp.csr_array(carried @ rows.E)
        if len(forced):
            external = external - at_rest[forced].T @ fleet.weight[forced]
        E = at_rest[x]
        self._B = sp.csr_array(sp.vstack([E, springs.rows])) if springs.n else E
        self._columns, self._factor = StaticColumns(self._B, factors.stiffness), factors.stiffness
        self._columns.take_in(np.flatnonzero(np.asarray(abs(E).sum(axis=1)) > 0.0))
        self.u_0 = np.zeros(plan.structure.size)
        if np.any(external):
            self.u_0 = factors.stiffness.solve(np.array(external))
        self.free = np.asarray(self._B @ self.u_0)
        self.free[: len(x)] += rows.height[x]
        self.active = np.empty(0, dtype=np.int64)  # springs that are unknown: others follow their reference
        self.n_wheel = len(x)
        self.scale = max(float(np.abs(fleet.weight).max(initial=0.0)), 1.0)
        # A stiffness that turns gaps into forces, to tell who touches.
        self.stiffness = max(float(np.abs(self.k).max(initial=0.0)), 1e3 * self.scale)

    def deflection(self, forces: FloatArray, deviation: FloatArray) -> FloatArray:
        """Displacements (n,) of the structure."""
        load = np.asarray(self._B.T @ np.concatenate([forces, deviation]))
        return self.u_0 - self._factor.solve(load) if np.any(load) else self.u_0.copy()

    def at(self, u_x: FloatArray, q: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Contact forces, approaches and elongations, from deviations (n_spring,) of active springs."""
        forces = self.weight + self.k @ u_x
        d = self.free - self._B @ self._columns.deflection(np.concatenate([forces, q]))
        w = self.n_wheel
        return forces, d[:w] - u_x, d[w:]

    def residual(self, y: FloatArray) -> tuple[FloatArray, FloatArray, IntArray]:
        """Residual [N] and Jacobian, and springs that are not unknown but should be."""
        w, laws, a = self.n_wheel, self.laws, self.active
        u_x, q = y[:w], y[w:]
        forces, approach, elongation = self.at(u_x, self._all(q))
        Z = self._columns.compliance(np.concatenate([np.arange(w), w + a]))
        still = np.zeros(w)
        slope, _ = laws.tangent(approach, still)
        from_u = np.concatenate([self.k, np.zeros((len(q), w))])  # of [X, q]
        from_q = np.concatenate([np.zeros((w, len(q))), np.eye(len(q))])
        dp = np.hstack([from_u, from_q])
        dd = -Z @ dp
        dd[:w, :w] -= np.eye(w)
        residual = np.empty(len(y))
        jacobian = np.empty((len(y), len(y)))
        residual[:w] = forces - laws.force(approach, still)
        jacobian[:w] = dp[:w] - slope[:, None] * dd[:w]
        held = laws.rigid | (laws.unilateral & (forces + self.stiffness * approach > 0.0))
        residual[:w][held] = -self.stiffness * approach[held]
        jacobian[:w][held] = -self.stiffness * dd[:w][held]
        loose = laws.unilateral & ~held
        residual[:w][loose] = forces[loose]
        jacobian[:w][loose] = dp[:w][loose]
        if not self.springs.n:
            return residual, jacobian, a
        given, tangent = self.springs.static_deviation(elongation)
        varies = tangent != 0.0 if tangent.ndim == 1 else np.any(tangent != 0.0, axis=1)
        if len(a):
            residual[w:] = q - given[a]
            jacobian[w:] = dp[w:] - slope_times(
                tangent[a] if tangent.ndim == 1 else tangent[np.ix_(a, a)], dd[w:]
            )
        return residual, jacobian, np.setdiff1d(np.flatnonzero((given != 0.0) | varies), a)

    def _all(self, q: FloatArray) -> FloatArray:
        """Deviations (n_spring,) from those of active springs."""
        result = np.zeros(self.springs.n)
        result[self.active] = q
        return result

    def _take_in(self, springs: IntArray) -> None:
        self._columns.take_in(self.n_wheel + springs)
        self.active = np.append(self.active, springs)

    def solve(self) -> tuple[FloatArray, FloatArray]:
        """u_X (n_coupled,) and q (n_spring,)."""
        w = self.n_wheel
        on_line = self._columns.compliance(np.arange(w)) @ self.weight
        y = self.free[:w] - on_line
        residual, jacobian, more = self.residual(y)
        for _ in range(_LIMIT):
            if len(more):
                self._take_in(more)
                y = np.append(y, np.zeros(len(more)))
                residual, jacobian, more = self.residual(y)
            step = _step(jacobian, residual)
            size = float(residual @ residual)
            share = 1.0
            for _ in range(_HALVINGS):
                tried = y - share * step
                new, slope, more = self.residual(tried)
                if float(new @ new) <= size:
                    break
                share *= 0.5
            change = float(np.abs(tried - y).max(initial=0.0))
            y, residual, jacobian = tried, new, slope
            small = float(np.abs(residual).max(initial=0.0)) <= _TOLERANCE * self.scale
            still = change <= 1e-15 and float(np.abs(residual).max(initial=0.0)) <= 1e-6 * self.scale
            if not len(more) and (small or still):  # rounding is all that is left under very stiff laws
                return y[:w], self._all(y[w:])
        worst = int(np.argmax(np.abs(residual)))
        where = (
            f"contact {self.plan.crossing.contact_names[int(self.plan.fleet.coupled[worst])]}"
            if worst < self.n_wheel
            else f"spring {self.springs.names[int(self.active[worst - self.n_wheel])]}"
        )
        raise AnalysisError(
            f"the static equilibrium at time zero was not found in {_LIMIT} iterations (residual "
            f"{np.abs(residual).max():.3g} N at {where}). Start the train before the structure, or check the laws"
        )
