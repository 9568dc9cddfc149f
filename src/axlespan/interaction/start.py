r"""How a run starts: static equilibrium where the train stands, then what the motion along the line asks for.

At time zero each vehicle is in static equilibrium (the irregularity under its wheels included), its bodies
have no vertical velocity, and its wheels have the velocity and acceleration of the line under them: the
first and second time derivative of N12 (27) along s(t),

.. math::
   \dot u_X &= \dot s (r' + E' u) + E \dot u \\
   \ddot u_X &= \dot s^2 (r'' + E'' u) + \ddot s (r' + E' u) + 2 \dot s E' \dot u + E \ddot u

Accelerations and contact forces follow from the equations of motion and this constraint together.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.dynamics.integrator import State
from axlespan.interaction.line_responses import LineResponses, side_by_side
from axlespan.interaction.plan import Plan
from axlespan.interaction.start_draft import Draft
from axlespan.interaction.start_rows import (
    ContactRows,
    about_to_enter,
    carried_by,
    rows_at,
)
from axlespan.interaction.start_vehicles import (
    Vehicles,
    condensed_stiffness,
    mass_factor,
    where_mass,
)
from axlespan.linalg.factor import Factor, factorize

__all__ = [
    "ContactRows",
    "Start",
    "StartFactors",
    "about_to_enter",
    "carried_by",
    "condensed_stiffness",
    "entering",
    "mass_factor",
    "rows_at",
    "start_of",
    "starts_of",
    "where_mass",
]

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_NONE = np.empty(0, dtype=np.int64)

# Forces out of balance in a static equilibrium, relative to the largest one: rounding of its displacements.
_ROUNDING = 1e-12


@dataclass(frozen=True, eq=False)
class Start:
    """States and contact forces at time zero."""

    structure: State
    fleet: State
    forces: FloatArray  # (n_contact,) [N]
    load: FloatArray  # Eᵀ X (n,) on the structure [N]


class StartFactors:
    """Factors of the structure's K and M, made when a start needs them, once for all crossings of a structure.

    ``like`` is a factor of its effective matrix, whose order of elimination serves K too.
    """

    def __init__(self, plan: Plan, like: Factor | None = None) -> None:
        self._plan, self._like = plan, like

    @cached_property
    def stiffness(self) -> Factor:
        """Factor of K: the one that the check of the supports left over, where it is of the kind asked for."""
        settings = self._plan.settings
        known = self._plan.crossing.structure.stiffness_factor if settings.solver == "auto" else None
        if known is not None and (settings.threads == 1 or known.name != "pardiso"):
            return known
        return factorize(
            self._plan.structure.K, kind=settings.solver, threads=settings.threads, like=self._like
        )

    @cached_property
    def mass(self) -> Factor:
        """Factor of M, with a trace of stiffness where a d.o.f. has no mass; of parts of M, where wheels touch only these."""
        paths = [path.free.path_dofs for path in self._plan.rows.paths]
        return mass_factor(self._plan.structure, self._plan, np.concatenate([*paths, _NONE]))


def start_of(plan: Plan, factors: StartFactors | None = None) -> Start:
    """The state at time zero of one crossing."""
    return starts_of([plan], factors)[0]


def starts_of(plans: Sequence[Plan], factors: StartFactors | None = None) -> list[Start]:
    """The states at time zero of crossings of one structure; what they solve for goes side by side."""
    factors = factors or StartFactors(plans[0])
    kinds = Vehicles(plans[0])
    drafts = [Draft.of(plan, kinds) for plan in plans]
    _stand(drafts, factors)
    for draft in drafts:
        draft.follow_the_line()
    _accelerate(drafts, factors, kinds)
    n = plans[0].structure.size
    return [Start(d.structure, d.vehicles, d.forces, d.rows.load(d.forces[d.rows.on], n)) for d in drafts]


def _stand(drafts: Sequence[Draft], factors: StartFactors) -> None:
    """Set displacements of the structure and contact forces with the trains at rest on it, and what enters."""
    plan = drafts[0].plan
    external = plan.forces.static(0.0)
    u_0 = factors.stiffness.solve(external) if np.any(external) else None
    there = [draft for draft in drafts if np.any(draft.rows.carried & ~draft.entering)]
    # Forces of vehicles that are statically determinate do not ask how the structure gives way.
    known = [draft for draft in there if not any(np.any(group.kind.stiffness) for group in draft.groups)]
    standing = [draft for draft in there if draft not in known]
    responses = None
    if standing:
        lanes = [(d.rows.dofs[d.loading], d.rows.weights[0][d.loading]) for d in standing]
        responses = LineResponses(factors.stiffness, lanes)
    amounts: list[FloatArray] = []
    for draft in drafts:
        level = draft.rows.height.copy()
        if u_0 is not None:
            draft.structure.u[:] = u_0
            level[draft.rows.on] += draft.rows.read(u_0)
        _elastic_share(draft, level)
        if draft in standing and responses is not None:
            amounts.append(_balance(draft, level, responses.between(len(amounts))))
    if responses is not None:
        for draft, u in zip(standing, responses.under(amounts).T, strict=True):
            draft.structure.u[:] -= u
    if known:
        loads = [d.rows.load(d.forces[d.rows.on] * ~d.entering, plan.structure.size) for d in known]
        for draft, u in zip(known, side_by_side(factors.stiffness, loads), strict=True):
            draft.structure.u[:] -= u
    for draft in drafts:
        if np.any(draft.entering & draft.rows.carried):
            rows = ContactRows.of(draft.rows, plan.structure.size)
            u, v = entering(draft.plan, rows, draft.forces)
            draft.structure.u[:] += u
            draft.structure.v[:] += v


def _elastic_share(draft: Draft, level: FloatArray) -> None:
    """Change contact forces as an uneven level (n_contact,) under vehicles on many wheels does."""
    own = level[draft.plan.fleet.coupled]
    if np.any(own):
        for group in draft.groups:
            wheels = draft.plan.fleet.coupled[group.contacts]
            draft.forces[wheels] += own[group.contacts] @ group.kind.stiffness


def _balance(draft: Draft, level: FloatArray, compliance: FloatArray) -> FloatArray:
    """Forces (m,) of the wheels that load the structure, which gives way under them: E K⁻¹ Eᵀ (m, m).

    X = X_st + k (E u + r) with E u = E u_0 - (E K⁻¹ Eᵀ) X.
    """
    fleet, rows = draft.plan.fleet, draft.rows
    on = rows.on[draft.loading]
    # Wheels that enter have not deflected the structure.
    compliance = compliance * ~draft.entering[draft.loading]
    stiffness = {i: group.kind.stiffness for i, group in enumerate(draft.groups)}
    chosen, k = draft.blocks(stiffness)
    if len(chosen):
        place = np.full(len(draft.forces), -1)
        place[fleet.coupled[chosen]] = np.arange(len(chosen))
        at = place[on]
        moving = at >= 0
        under = np.zeros(len(chosen))
        under[at[moving]] = compliance[moving][:, ~moving] @ draft.forces[on[~moving]]
        wheels = fleet.coupled[chosen]
        right = fleet.weight[wheels] + k @ (level[wheels] - under)
        system = np.eye(len(chosen))
        system[:, at[moving]] += k[:, at[moving]] @ compliance[np.ix_(moving, moving)]
        draft.forces[wheels] = np.linalg.solve(system, right)
    return np.asarray(draft.forces[on] * ~draft.entering[draft.loading])


def entering(plan: Plan, rows: ContactRows, forces: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Displacements and velocities (n,) under footprints that reach over a fixed end before their wheels.

    The share E of a wheel that the span carries grows with its way s like exp(ω t), ω = ṡ |E'| / |E|. Under a force
    that has grown so for long u = (K + ω² M)⁻¹ f and u̇ = ω u (damping apart): the stiff motion near the end follows
    the force, and the slow modes hardly know of the wheel. At rest the span would be struck by that share at t = 0.
    """
    u, v = np.zeros(plan.structure.size), np.zeros(plan.structure.size)
    on = np.flatnonzero(about_to_enter(plan) & carried_by(rows.E))
    if not len(on):
        return u, v
    speeds, _ = plan.rows.motion(0.0)
    share, change = (np.asarray(abs(E[on]).sum(axis=1)).ravel() for E in (rows.E, rows.E1))
    growth = np.abs(speeds[on]) * change / share
    for rate in np.unique(growth.round(6)):
        wheels = on[growth.round(6) == rate]
        matrix = sp.csr_array(plan.structure.K + rate**2 * plan.structure.M)
        factor = factorize(matrix, kind=plan.settings.solver, threads=plan.settings.threads)
        grown = -factor.solve(np.asarray(rows.E[wheels].T @ forces[wheels]))
        u += grown
        v += rate * grown
    return u, v


def _accelerate(drafts: Sequence[Draft], factors: StartFactors, kinds: Vehicles) -> None:
    """Set the accelerations of both bodies, and the contact forces that go with them."""
    plan = drafts[0].plan
    external = plan.forces.at(0.0) if plan.forces.n_term else np.zeros(plan.structure.size)
    struck: list[Draft] = []
    pushed: list[tuple[Draft, FloatArray]] = []
    for draft in drafts:
        net = _out_of_balance(draft, external)
        if net is None:
            continue
        struck.append(draft)
        if np.any(net) and np.any(net := where_mass(plan.structure, net)):
            pushed.append((draft, net))
    if pushed:
        solved = side_by_side(factors.mass, [net for _, net in pushed])
        for (draft, _), a in zip(pushed, solved, strict=True):
            draft.structure.a[:] = a
    lanes, rows = [], []
    for draft in struck:
        of_vehicles = draft.loading[draft.coupled_place[draft.rows.on[draft.loading]] >= 0]
        if len(of_vehicles):
            lanes.append((draft, of_vehicles))
            rows.append((draft.rows.dofs[of_vehicles], draft.rows.weights[0][of_vehicles]))
    responses = LineResponses(factors.mass, rows) if rows else None
    coupled = {id(draft): (i, of_vehicles) for i, (draft, of_vehicles) in enumerate(lanes)}
    changes = []
    for draft in drafts:
        if not len(draft.plan.fleet.coupled):
            continue
        lane, of_vehicles = coupled.get(id(draft), (-1, _NONE))
        between = responses.between(lane) if responses is not None and lane >= 0 else np.zeros((0, 0))
        change = _accelerate_vehicles(draft, kinds, of_vehicles, between)
        if lane >= 0:
            changes.append(change)
    if responses is not None:
        for (draft, _), a in zip(lanes, responses.under(changes).T, strict=True):
            draft.structure.a[:] -= a


def _out_of_balance(draft: Draft, external: FloatArray) -> FloatArray | None:
    """Forces (n,) on the structure that accelerate it; None where it stands still, without wheels of vehicles."""
    m, state = draft.plan.structure, draft.structure
    net = external.copy()
    if np.any(state.u):
        net -= m.K @ state.u
    if np.any(state.v):
        net -= m.damping_force(state.v)
    wheels = draft.forces[draft.rows.on]
    net -= draft.rows.load(wheels, m.size)
    scale = max(float(np.abs(external).max(initial=0.0)), float(np.abs(wheels).max(initial=0.0)))
    net[np.abs(net) <= _ROUNDING * scale] = 0.0
    of_vehicles = draft.coupled_place[draft.rows.on[draft.loading]] >= 0
    return net if np.any(of_vehicles) or np.any(net) else None


def _accelerate_vehicles(
    draft: Draft, kinds: Vehicles, of_vehicles: IntArray, between: FloatArray
) -> FloatArray:
    """Set the vehicles' accelerations and change the contact forces, from the static ones; the changes (m,).

    Parameters
    ----------
    of_vehicles : array (m,)
        Their wheels that load the structure, among those on it.
    between : array (m, m)
        E M⁻¹ Eᵀ of these wheels [1/kg].
    """
    fleet, state = draft.plan.fleet, draft.vehicles
    m, x = fleet.matrices, fleet.coupled
    net = -(m.K @ state.u) - m.damping_force(state.v)
    net[fleet.dofs] += draft.forces[x] - fleet.weight[x]
    wanted = _wanted(draft)[x]
    if not len(of_vehicles) and not np.any(wanted) and not np.any(net):
        return np.zeros(0)
    mass = {i: kinds.mass(group.kind) for i, group in enumerate(draft.groups)}
    for i, group in enumerate(draft.groups):
        state.a[group.dofs] = mass[i].free(net[group.dofs])
    wanted -= state.a[fleet.dofs]
    change = np.zeros(len(x))
    for i, (group, _, others) in enumerate(draft.touching()):
        if len(others):
            wheels = group.contacts[others]
            change[wheels] = np.linalg.solve(mass[i].at_contacts, wanted[wheels].T).T
    chosen, system = draft.blocks({i: own.at_contacts for i, own in mass.items()})
    loading = draft.coupled_place[draft.rows.on[of_vehicles]]
    if len(chosen):
        place = np.full(len(x), -1)
        place[chosen] = np.arange(len(chosen))
        at = place[loading]
        system[at[:, None], at] += between
        change[chosen] = np.linalg.solve(system, wanted[chosen])
    for i, group in enumerate(draft.groups):
        state.a[group.dofs] += change[group.contacts] @ mass[i].responses.T
    draft.forces[x] += change
    return change[loading]


def _wanted(draft: Draft) -> FloatArray:
    """Accelerations (n_contact,) of the line under the wheels, but for what the change of their forces does to it."""
    rows, state = draft.rows, draft.structure
    result = rows.second_rate.copy()
    if len(rows.on):
        speed, acceleration = rows.speed[rows.on], rows.acceleration[rows.on]
        slope = rows.read(state.u, 1)
        result[rows.on] += rows.read(state.a) + speed**2 * rows.read(state.u, 2) + acceleration * slope
        result[rows.on] += 2.0 * speed * rows.read(state.v, 1)
    return result
