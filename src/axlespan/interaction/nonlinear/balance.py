r"""Velocities and accelerations of both bodies at one instant, where wheels touch, land or let go.

A wheel that lands changes its velocity at once. The impulses P of an inelastic landing leave no relative
velocity in the wheels that touch,

.. math:: \left( I_X M_v^{-1} I_X^T + E M_s^{-1} E^T \right) P = \dot δ, \qquad
          \dot δ = \dot r + \dot s E' u_s + E \dot u_s - \dot u_X

and take the energy ½ \dot δᵀ P from the bodies, which is never negative. After that the accelerations are those of
the constraint, differentiated twice, with 0 <= X where the contact is one-sided: (D14) at any time.

With numerical damping the effective masses A stand in for M: what moves in a landing is then what the time step can
follow, whatever the mesh, and waves that it cannot follow do not throw the wheel up again. Without numerical damping
M itself is used, and energy is kept to rounding but for the loss above.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
import numpy.typing as npt

from axlespan.contact.laws_of_wheels import WheelLaws
from axlespan.dynamics.integrator import State
from axlespan.interaction.nonlinear.interface_solver import complementary
from axlespan.interaction.plan import Plan
from axlespan.interaction.start import ContactRows, StartFactors, mass_factor, rows_at, where_mass
from axlespan.linalg.factor import Factor

FloatArray = npt.NDArray[np.float64]
Mask = npt.NDArray[np.bool_]


class Balance:
    """Balances the bodies of one crossing at an instant; holds the factors of their masses.

    Once it has :meth:`smoothed`, those are the effective masses of the time integration.
    """

    def __init__(self, plan: Plan, laws: WheelLaws, factors: StartFactors) -> None:
        self.plan, self.laws, self._factors = plan, laws, factors
        self._effective: tuple[Factor, Factor] | None = None
        system = plan.crossing.structure.system
        self._vertical = system.translation("z")[system.free]

    def for_plan(self, plan: Plan) -> Balance:
        """The same for another time step of the crossing; not smoothed yet."""
        return Balance(plan, self.laws, self._factors)

    def smoothed(self, structure: Factor, vehicles: Factor) -> None:
        """Use the factors of the effective matrices from now on."""
        self._effective = structure, vehicles

    @property
    def structure_mass(self) -> Factor:
        """Factor of the structure's M, or of its A."""
        return self._factors.mass if self._effective is None else self._effective[0]

    @property
    def vehicle_mass(self) -> Factor:
        """Factor of the vehicles' M, or of their A."""
        return self._mass_of_vehicles if self._effective is None else self._effective[1]

    @cached_property
    def _mass_of_vehicles(self) -> Factor:
        return mass_factor(self.plan.fleet.matrices, self.plan)

    def rows(self, time: float) -> ContactRows:
        """Contact rows of all wheels at a time [s]."""
        return rows_at(self.plan, time)

    def closing_rates(self, rows: ContactRows, structure: State, vehicles: State, time: float) -> FloatArray:
        """Rates (n_coupled,) of the approach of all wheels [m/s]."""
        fleet = self.plan.fleet
        speed, _ = self.plan.rows.motion(time)
        line = rows.rate + speed * (rows.E1 @ structure.u) + rows.E @ structure.v
        return np.asarray(line[fleet.coupled] - vehicles.v[fleet.dofs])

    def land(
        self, rows: ContactRows, structure: State, vehicles: State, time: float, touching: Mask
    ) -> tuple[FloatArray, float]:
        """Take the relative velocity from the wheels that touch (n_coupled,); impulses (n_coupled,) [N s] and loss [J]."""
        chosen = np.flatnonzero(touching)
        rates = self.closing_rates(rows, structure, vehicles, time)[chosen]
        on_structure, on_vehicles, system = self._responses(rows, chosen)
        impulse = np.linalg.solve(system, rates)
        before = self._kinetic(structure, vehicles)
        structure.v[:] -= on_structure @ impulse
        vehicles.v[:] += on_vehicles @ impulse
        result = np.zeros(len(touching))
        result[chosen] = impulse
        return result, before - self._kinetic(structure, vehicles)

    def _kinetic(self, structure: State, vehicles: State) -> float:
        masses = self.plan.structure.M, self.plan.fleet.matrices.M
        both = zip(masses, (structure.v, vehicles.v), strict=True)
        return sum(0.5 * float(v @ (mass @ v)) for mass, v in both)

    def accelerate(
        self,
        rows: ContactRows,
        structure: State,
        vehicles: State,
        time: float,
        touching: Mask,
        given: FloatArray,
        inner: FloatArray | None = None,
        inner_of_fleet: FloatArray | None = None,
    ) -> tuple[FloatArray, float]:
        """Set the accelerations of both bodies; contact forces (n_contact,) [N], and the inertia that they leave out.

        The latter is the vertical force out of balance on the structure, less M ü: zero unless smoothed.

        Parameters
        ----------
        touching : array (n_coupled,)
            Wheels without relative velocity; where they are one-sided, the force may not pull.
        given : array (n_contact,)
            Contact forces of all others, zero for those that touch.
        inner, inner_of_fleet : array (n,), optional
            Further forces on the structure and on the vehicles.
        """
        plan, fleet, x = self.plan, self.plan.fleet, self.plan.fleet.coupled
        chosen = np.flatnonzero(touching)
        net = self._net_on_structure(rows, structure, time, given, inner)
        if np.any(net) or np.any(rows.E.data):
            structure.a[:] = self.structure_mass.solve(where_mass(plan.structure, net))
        if not len(x):
            return given, 0.0
        m = fleet.matrices
        own = -(m.K @ vehicles.u) - m.damping_force(vehicles.v)
        own[fleet.dofs] += given[x] - fleet.weight[x]
        if inner_of_fleet is not None:
            own += inner_of_fleet
        # Massless contact points that are held take the contact force; other massless d.o.f. are in balance.
        vehicles.a[:] = self.vehicle_mass.solve(where_mass(m, own, fleet.dofs[chosen]))
        on_structure, on_vehicles, system = self._responses(rows, chosen)
        speed, acceleration = plan.rows.motion(time)
        line = rows.second_rate + (
            rows.E @ structure.a
            + speed**2 * (rows.E2 @ structure.u)
            + acceleration * (rows.E1 @ structure.u)
            + 2.0 * speed * (rows.E1 @ structure.v)
        )
        wanted = (line[x] - vehicles.a[fleet.dofs])[chosen]
        found = complementary(system, wanted, self.laws.unilateral[chosen], fleet.weight[x][chosen])
        structure.a[:] -= on_structure @ found
        vehicles.a[:] += on_vehicles @ found
        forces = given.copy()
        forces[x[chosen]] = found
        if self._effective is None:
            return forces, 0.0
        left = net - rows.E[x[chosen]].T @ found - plan.structure.M @ structure.a
        return forces, float(self._vertical @ left)

    def _net_on_structure(
        self,
        rows: ContactRows,
        structure: State,
        time: float,
        given: FloatArray,
        inner: FloatArray | None,
    ) -> FloatArray:
        matrices, forces = self.plan.structure, self.plan.forces
        net = forces.at(time) if forces.n_term else np.zeros(matrices.size)
        net = net - matrices.K @ structure.u - matrices.damping_force(structure.v)
        net -= rows.E.T @ given
        scale = max(
            float(np.abs(matrices.K @ structure.u).max(initial=0.0)), float(np.abs(given).max(initial=0.0))
        )
        if inner is not None:
            net += inner
        net[np.abs(net) < 1e-13 * scale] = 0.0
        return np.asarray(net)

    def _responses(
        self, rows: ContactRows, chosen: npt.NDArray[np.int64]
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """M⁻¹ Eᵀ (n, m), M⁻¹ I_Xᵀ and the compliance (m, m) [1/kg] of some coupled wheels."""
        fleet = self.plan.fleet
        E = rows.E[fleet.coupled[chosen]]
        columns = np.zeros((self.plan.structure.size, len(chosen)))
        carried = np.flatnonzero(np.asarray(abs(E).sum(axis=1)) > 0.0)
        if len(carried):
            columns[:, carried] = self.structure_mass.solve(np.ascontiguousarray(E[carried].T.toarray()))
        unit = np.zeros((fleet.matrices.size, len(chosen)))
        unit[fleet.dofs[chosen], np.arange(len(chosen))] = 1.0
        responses = self.vehicle_mass.solve(unit) if len(chosen) else unit
        system = responses[fleet.dofs[chosen]] + E @ columns
        return columns, responses, 0.5 * (system + system.T)
