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

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.contact.rows import RowBlock
from axlespan.dynamics.integrator import Matrices, State
from axlespan.interaction.plan import Fleet, Plan
from axlespan.linalg.factor import Factor, factorize

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Share of the effective stiffness that stands in for the missing mass of massless d.o.f.: their
# accelerations then are those that keep the static balance of forces, to this relative accuracy.
_SUBSTITUTE = 1e-7


@dataclass(frozen=True, eq=False)
class Start:
    """States and contact forces at time zero."""

    structure: State
    fleet: State
    forces: FloatArray  # (n_contact,) [N]
    load: FloatArray  # Eᵀ X (n,) on the structure [N]


@dataclass(frozen=True, eq=False)
class ContactRows:
    """Rows of all wheels at a time, with derivatives along the line."""

    E: sp.csr_array  # (n_contact, n)
    E1: sp.csr_array
    E2: sp.csr_array
    height: FloatArray  # (n_contact,) r + E_P u_P [m]
    rate: FloatArray  # ṡ (r' + E_P' u_P) + E_P u̇_P [m/s]
    second_rate: FloatArray  # [m/s^2]


class StartFactors:
    """Factors of the structure's K and M, made when a start needs them, once for all crossings of a structure."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan

    @cached_property
    def stiffness(self) -> Factor:
        """Factor of K."""
        settings = self._plan.settings
        return factorize(self._plan.structure.K, kind=settings.solver, threads=settings.threads)

    @cached_property
    def mass(self) -> Factor:
        """Factor of M, with a trace of stiffness where a d.o.f. has no mass."""
        return mass_factor(self._plan.structure, self._plan)


def start_of(plan: Plan, factors: StartFactors | None = None) -> Start:
    """The state at time zero; crossings of one structure may share the factors."""
    factors = factors or StartFactors(plan)
    rows, fleet = rows_at(plan), plan.fleet
    n, n_contact = plan.structure.size, len(fleet.weight)
    external = plan.forces.at(0.0) if plan.forces.n_term else np.zeros(n)
    u_s, forces = _static(plan, plan.forces.static(0.0), rows, factors)
    u_e, v_s = entering(plan, rows, forces)
    u_s = u_s + u_e
    u_v, forces = vehicles_at(fleet, forces, rows, u_s)
    structure, vehicles = State.at_rest((n,)), State.at_rest((fleet.matrices.size,))
    structure.u[:], structure.v[:], vehicles.u[:] = u_s, v_s, u_v
    x = fleet.coupled
    speed, _ = plan.rows.motion(0.0)
    vehicles.v[fleet.dofs] = (rows.rate + speed * (rows.E1 @ u_s) + rows.E @ v_s)[x]
    forces = _accelerate(plan, structure, vehicles, external, rows, forces.reshape(n_contact), speed, factors)
    return Start(structure, vehicles, forces, np.asarray(rows.E.T @ forces))


def rows_at(plan: Plan, time: float = 0.0) -> ContactRows:
    """The rows of all wheels at a time, with derivatives along the line."""
    now = np.array([time])
    positions = plan.rows.positions(now)
    speed, acceleration = plan.rows.motion(time)
    wheels = np.arange(plan.rows.n_contact)
    blocks = [plan.rows.rows(positions, wheels, derivative) for derivative in range(3)]
    n = plan.structure.size
    row = np.broadcast_to(wheels[:, None], blocks[0].dofs[0].shape).ravel()
    E, E1, E2 = (
        sp.csr_array(sp.coo_array((b.weights[0].ravel(), (row, b.dofs[0].ravel())), shape=(len(wheels), n)))
        for b in blocks
    )
    r, r1, r2 = (plan.rows.irregularity(positions, derivative)[0] for derivative in range(3))
    height, rate = r.copy(), speed * r1
    second = speed**2 * r2 + acceleration * r1
    if len(plan.moving):
        motions = [plan.crossing.structure.system.motions[j] for j in plan.moving]
        u, v, a = (
            np.array([getattr(m, name)(now)[0] for m in motions])
            for name in ("value", "velocity", "acceleration")
        )
        p0, p1, p2 = (_prescribed_rows(block, len(motions)) for block in blocks)
        height += p0 @ u
        rate += speed * (p1 @ u) + p0 @ v
        second += speed**2 * (p2 @ u) + acceleration * (p1 @ u) + 2.0 * speed * (p1 @ v) + p0 @ a
    return ContactRows(E, E1, E2, height, rate, second)


def carried_by(E: sp.csr_array) -> npt.NDArray[np.bool_]:
    """Which wheels (n_contact,) the structure carries."""
    return np.asarray(abs(E).sum(axis=1) > 0.0)


def _prescribed_rows(block: RowBlock, n: int) -> FloatArray:
    """E_P (n_contact, n) of the prescribed d.o.f. that move."""
    dofs, weights = block.prescribed_dofs[0], block.prescribed_weights[0]
    result = np.zeros((len(dofs), n))
    np.add.at(result, (np.arange(len(dofs))[:, None], dofs), weights)
    return result


def _static(
    plan: Plan, external: FloatArray, rows: ContactRows, factors: StartFactors
) -> tuple[FloatArray, FloatArray]:
    """Deflection of the structure and contact forces with the train at rest on it."""
    fleet, n = plan.fleet, plan.structure.size
    forces = fleet.weight.copy()
    carried = np.flatnonzero(carried_by(rows.E) & ~about_to_enter(plan))
    if not len(carried) and not np.any(external):
        return np.zeros(n), forces + _elastic_share(fleet, rows.height)
    factor = factors.stiffness
    u_0 = factor.solve(external.copy())
    columns = (
        factor.solve(np.ascontiguousarray(rows.E[carried].T.toarray())) if len(carried) else np.zeros((n, 0))
    )
    compliance = np.zeros((len(forces), len(forces)))
    compliance[:, carried] = rows.E @ columns
    # X = X_st + k (E u + r) with E u = E u_0 - (E K⁻¹ Eᵀ) X
    k = condensed_stiffness(fleet)
    right = forces + k @ (rows.E @ u_0 + rows.height)
    forces = np.asarray(np.linalg.solve(np.eye(len(forces)) + k @ compliance, right), dtype=np.float64)
    return u_0 - columns @ forces[carried], forces


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


def about_to_enter(plan: Plan) -> npt.NDArray[np.bool_]:
    """Which wheels (n_contact,) run onto the structure over a fixed end that they have not passed.

    A footprint reaches over that end before its wheel does. A train that has been running has not deflected
    the structure by that share of a wheel, as one that stands there would.
    """
    positions = plan.rows.positions(np.zeros(1))[0]
    speeds, _ = plan.rows.motion(0.0)
    names = np.asarray(plan.crossing.contact_lines)
    free = np.zeros(plan.crossing.structure.system.size, dtype=bool)
    free[plan.crossing.structure.system.free] = True
    result = np.zeros(len(positions), dtype=bool)
    for name in dict.fromkeys(plan.crossing.contact_lines):
        path = plan.crossing.structure.line(name)
        here = np.flatnonzero(names == name)
        before = (positions[here] <= path.start) & (speeds[here] > 0.0)
        behind = (positions[here] >= path.stop) & (speeds[here] < 0.0)
        dofs, weights = path.weights(np.clip(positions[here], path.start, path.stop))
        gives_way = np.any((np.abs(weights) > 1e-9) & free[dofs], axis=1)
        result[here] = (before | behind) & ~gives_way
    return result


def condensed_stiffness(fleet: Fleet) -> FloatArray:
    """Static stiffness (n_contact, n_contact) of the vehicles seen from their contact points."""
    n_contact = len(fleet.weight)
    result = np.zeros((n_contact, n_contact))
    if len(fleet.coupled):
        rest = np.setdiff1d(np.arange(fleet.matrices.size), fleet.dofs)
        stiffness = sp.csr_array(fleet.matrices.K)
        own = stiffness[fleet.dofs][:, fleet.dofs].toarray()
        if len(rest):
            link = stiffness[rest][:, fleet.dofs].toarray()
            own = own - link.T @ factorize(sp.csr_array(stiffness[rest][:, rest])).solve(
                np.ascontiguousarray(link)
            )
        scale = np.abs(stiffness.diagonal()[fleet.dofs])
        own[np.abs(own) < 1e-12 * np.sqrt(np.outer(scale, scale))] = (
            0.0  # statically determinate vehicles: rounding
        )
        result[np.ix_(fleet.coupled, fleet.coupled)] = own
    return result


def _elastic_share(fleet: Fleet, heights: FloatArray) -> FloatArray:
    """Change of the contact forces (n_contact,) from an uneven level under vehicles on many wheels."""
    return (
        np.asarray(condensed_stiffness(fleet) @ heights) if np.any(heights) else np.zeros(len(fleet.weight))
    )


def vehicles_at(
    fleet: Fleet, forces: FloatArray, rows: ContactRows, u_s: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Displacements of the vehicles at rest on the deflected, uneven line."""
    u = np.zeros(fleet.matrices.size)
    if not len(fleet.coupled):
        return u, forces
    u[fleet.dofs] = (rows.height + rows.E @ u_s)[fleet.coupled]
    rest = np.setdiff1d(np.arange(fleet.matrices.size), fleet.dofs)
    if len(rest) and np.any(u):
        stiffness = sp.csr_array(fleet.matrices.K)
        u[rest] = factorize(sp.csr_array(stiffness[rest][:, rest])).solve(-(stiffness[rest] @ u))
    return u, forces


def _accelerate(
    plan: Plan,
    structure: State,
    vehicles: State,
    external: FloatArray,
    rows: ContactRows,
    static: FloatArray,
    speed: FloatArray,
    factors: StartFactors,
) -> FloatArray:
    """Fill in the accelerations of both bodies; return the contact forces (n_contact,)."""
    fleet, x = plan.fleet, plan.fleet.coupled
    _, acceleration = plan.rows.motion(0.0)
    out_of_balance = external - plan.structure.K @ structure.u - plan.structure.damping_force(structure.v)
    out_of_balance -= rows.E.T @ static
    carried = carried_by(rows.E)[x]
    still = not np.any(carried) and np.abs(out_of_balance).max(initial=0.0) <= 1e-9 * max(
        np.abs(external).max(initial=0.0), 1e-30
    )
    structure_mass = None if still else factors.mass
    columns = np.zeros((plan.structure.size, len(x)))
    if structure_mass is not None:
        structure.a[:] = structure_mass.solve(where_mass(plan.structure, out_of_balance))
        if np.any(carried):
            columns = structure_mass.solve(np.ascontiguousarray(rows.E[x].T.toarray()))
    if not len(x):
        return static
    m = fleet.matrices
    net = -(m.K @ vehicles.u) - m.damping_force(vehicles.v)
    net[fleet.dofs] += static[x] - fleet.weight[x]
    vehicle_mass = mass_factor(m, plan)
    # The wheels' d.o.f. take the contact force; other massless d.o.f. are in balance already.
    free = vehicle_mass.solve(where_mass(m, net, fleet.dofs))
    unit = np.zeros((m.size, len(x)))
    unit[fleet.dofs, np.arange(len(x))] = 1.0
    responses = vehicle_mass.solve(unit)
    wanted = rows.second_rate[x] + (
        rows.E[x] @ structure.a
        + speed[x] ** 2 * (rows.E2[x] @ structure.u)
        + acceleration[x] * (rows.E1[x] @ structure.u)
        + 2.0 * speed[x] * (rows.E1[x] @ structure.v)
    )
    system = responses[fleet.dofs] + rows.E[x] @ columns
    change = np.linalg.solve(system, wanted - free[fleet.dofs])  # of the contact forces, from the static ones
    vehicles.a[:] = free + responses @ change
    structure.a[:] -= columns @ change
    forces = static.copy()
    forces[x] += change
    return forces


def mass_factor(matrices: Matrices, plan: Plan) -> Factor:
    """Factor of M, with a trace of stiffness where a d.o.f. has no mass."""
    diagonal = matrices.M.diagonal()
    mass = matrices.M
    if np.any(diagonal <= 0.0):
        dt = plan.settings.time_step
        mass = mass + (_SUBSTITUTE * 0.25 * dt**2) * matrices.K
        if matrices.C is not None:
            mass = mass + (_SUBSTITUTE * 0.5 * dt) * matrices.C
    return factorize(sp.csr_array(mass), kind=plan.settings.solver, threads=plan.settings.threads)


def where_mass(matrices: Matrices, force: FloatArray, also: IntArray | None = None) -> FloatArray:
    """The force, without the rounding that stands on massless d.o.f. in balance."""
    mask = matrices.M.diagonal() > 0.0
    if also is not None:
        mask[also] = True
    return np.where(mask, force, 0.0)
