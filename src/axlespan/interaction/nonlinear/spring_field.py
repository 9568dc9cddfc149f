r"""Nonlinear springs within a step: which are unknowns, and what they do to the bodies.

All elongations follow from the free response, the contact forces X of the wheels and the deviations q,

.. math:: e = e^* - (1+α) β Δt^2 \left( B A^{-1} R^T X + B A^{-1} B^T q \right)

with R = E on the structure and R = -I_X on the vehicles, and the rates ė = ė* + γ/(βΔt) (e - e*). Springs whose
deviation vanishes are left out of Newton's method; after it has converged, those that were left out wrongly are
taken in, and the step is solved again.
"""

from __future__ import annotations

from copy import copy
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.interaction.bodies import FleetBody, StructureBody
from axlespan.interaction.nonlinear.spring_columns import SpringColumns
from axlespan.interaction.nonlinear.springs import Springs
from axlespan.linalg.products import Product

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


class SpringField:
    """The springs of a structure and its vehicles in time, with the memory of the last completed step.

    Parameters
    ----------
    own : Springs
        Of the structure, under its own weight.
    deviation : array (n_own,)
        At time zero [N].
    fleet : Springs
        Of the vehicles.
    """

    def __init__(self, own: Springs, deviation: FloatArray, fleet: Springs) -> None:
        self.springs = own.with_fleet(fleet)
        self.n, self.n_own, self.n_fleet = self.springs.n, own.n, fleet.n
        self._rows, self._rows_fleet, self._ground = own.rows, fleet.rows, own.ground
        self._dofs, self._dofs_fleet = (
            np.unique(part.rows.indices).astype(np.int64) for part in (own, fleet)
        )
        self._local = Product(own.rows[:, self._dofs])
        self._local_fleet = Product(fleet.rows[:, self._dofs_fleet])
        self._onto = Product(sp.csr_array(own.rows.T))
        self.q = np.concatenate([deviation, np.zeros(fleet.n)])
        self.e, self.rate = np.zeros(self.n), np.zeros(self.n)
        self.e_free, self.rate_free = np.zeros(self.n), np.zeros(self.n)
        self.active = self._active()
        self.largest = len(self.active)  # unknowns of a step, so far
        self.history = [self.q]  # of the start and each step, where springs stand on supports
        self._lift: FloatArray | None = None  # (n_own,) of elements that stand on nothing
        self._recent = np.zeros((0, self.n_own))
        self._columns: SpringColumns | None = None
        self._of_fleet: FloatArray | None = None  # compliance (n_fleet, n_fleet) of springs of vehicles [m/N]
        self._found = self.q, self.e, self.rate  # of the last attempt of a step
        self._response: FloatArray | None = None  # of the last attempt of a step, to loads on the structure

    def for_time_step(self) -> SpringField:
        """The same springs, which share their memory, for bodies at another time step."""
        other = copy(self)
        other._columns = other._of_fleet = None
        other.history = []
        return other

    @property
    def standing(self) -> tuple[Any, ...]:
        """The last completed step, to come back to after an attempt that failed."""
        return self.q, self.e, self.rate, self.active, self.springs.state

    def back_to(self, standing: tuple[Any, ...]) -> None:
        """Come back to what stood at a completed step."""
        self.q, self.e, self.rate, self.active, self.springs.state = standing

    def resume(self, other: SpringField) -> None:
        """Stand where the same springs at another time step stand: that is the last completed step."""
        self.q, self.e, self.rate, self.active = other.q, other.e, other.rate, other.active
        self.largest = max(self.largest, other.largest)
        if self.on_ground:
            self.history.append(self.q)

    # --- compliance ------------------------------------------------------------------------------

    def enter(self, structure: StructureBody, fleet: FleetBody | None) -> None:
        """Have at hand what a stretch needs."""
        if not self.n:
            return
        self._rate_from_e = structure.integrator.v_from_a / structure.integrator.u_from_a
        self._time_step = structure.integrator.time_step
        self.columns(structure)
        if fleet is not None and self.n_fleet and self._of_fleet is None:
            self._solve_fleet(fleet)

    def _solve_fleet(self, fleet: FleetBody) -> None:
        scale = fleet.integrator.weight_c * fleet.integrator.u_from_a
        solved = fleet.integrator.factor.solve(np.ascontiguousarray(self._rows_fleet.T.toarray()))
        Z = np.asarray(self._rows_fleet @ solved)
        self._of_fleet = 0.5 * scale * (Z + Z.T)
        self._of_wheels = -scale * solved[fleet.fleet.dofs]  # (n_coupled, n_fleet)
        self._fleet_responses = -fleet.integrator.weight_c * solved

    def columns(self, structure: StructureBody) -> SpringColumns:
        """What unit forces of the structure's springs do in a step."""
        if self._columns is None:
            self._columns = SpringColumns(structure.integrator, self._rows, structure.columns.path_dofs)
        return self._columns

    # --- a step ----------------------------------------------------------------------------------

    def predict(self, structure: StructureBody, fleet: FleetBody | None) -> None:
        """Elongations and rates of the free response; unknown are springs that deviate, or will if they go on so."""
        if not self.n:
            return
        bodies = [(structure.stepper, self._dofs, self._local)]
        if fleet is not None:
            bodies.append((fleet.stepper, self._dofs_fleet, self._local_fleet))
        self.e_free = np.concatenate([local.of(body.displacement(at)) for body, at, local in bodies])
        self.rate_free = np.concatenate([local.of(body.velocity(at)) for body, at, local in bodies])
        ahead = self.springs.deviation(self.e + self._time_step * self.rate, self.rate)
        self._guess = np.where(np.isfinite(ahead), ahead, self.q)  # an element may not reach so far
        self._take_in(self._guess != 0.0)

    @property
    def busy(self) -> bool:
        """Whether a spring deviates, or would in the free response."""
        if not self.n:
            return False
        return bool(len(self.active)) or bool(np.any(self.springs.deviation(self.e_free, self.rate_free)))

    def rest(self) -> None:
        """A step in which no spring deviates and no wheel is there."""
        self._response = None
        self._found = np.zeros(self.n), self.e_free, self.rate_free

    def meet(self, dofs: IntArray, weights: FloatArray, at: IntArray, contacts: IntArray) -> None:
        """Note which d.o.f. the wheels on the structure load (n_wheel, n_local), and their places in the interface."""
        if not self.n_own or not np.any(weights):  # no wheel is on the structure yet
            at, dofs, weights = at[:0], dofs[:0], weights[:0]
        self._under, self._weights, self._at, self._contacts = dofs, weights, at, contacts

    def joined(self, S: FloatArray, gap: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Compliance, free coordinates and guessed deviations of the wheels and the active springs together."""
        a, w = self.active, len(gap)
        if not len(a):
            return S, gap, np.zeros(0)
        assert self._columns is not None
        system = np.zeros((w + len(a), w + len(a)))
        system[:w, :w] = S
        m = int(np.searchsorted(a, self.n_own))  # the structure's own come first
        if m:
            own = slice(w, w + m)
            system[own, own] = self._columns.between(a[:m])
            if len(self._at):
                cross = self._columns.under(self._under, self._weights, a[:m])
                system[self._at, own], system[own, self._at] = cross, cross.T
        if m < len(a):
            assert self._of_fleet is not None
            others = a[m:] - self.n_own
            system[w + m :, w + m :] = self._of_fleet[np.ix_(others, others)]
            if w:
                cross = self._of_wheels[np.ix_(self._contacts, others)]
                system[:w, w + m :], system[w + m :, :w] = cross, cross.T
        return system, np.concatenate([gap, self.e_free[a]]), self._guess[a]

    def evaluate(self, e: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Deviations of the active springs at their elongations, and their derivatives: (n,), or (n, n) with elements."""
        a = self.active
        rate = self.rate_free[a] + self._rate_from_e * (e - self.e_free[a])
        return self.springs.linearized(a, e, rate, self._rate_from_e)

    def _active(self) -> IntArray:
        """Springs that deviate, and all that are d.o.f. of elements."""
        return np.union1d(np.flatnonzero(self.q), self.springs.coupled).astype(np.int64)

    def _take_in(self, springs: npt.NDArray[np.bool_]) -> None:
        """Have some more springs as unknowns."""
        self.active = np.union1d(self.active, np.flatnonzero(springs))
        self.largest = max(self.largest, len(self.active))

    def settle(self, structure: StructureBody, forces: FloatArray, deviation: FloatArray) -> bool:
        """Take a solution; false where springs deviate that were left out: they are active from now on."""
        if not self.n:
            return True
        q = np.zeros(self.n)
        q[self.active] = deviation
        e = self.e_free.copy()
        self._respond(structure, forces, q[: self.n_own])
        if self._response is not None:
            moved = structure.integrator.u_from_a * self._response[self._dofs]
            e[: self.n_own] += self._local.of(moved)
        if self._of_fleet is not None:
            own = slice(self.n_own, None)
            e[own] -= self._of_fleet @ q[own]
            if len(forces):
                e[own] -= forces @ self._of_wheels[self._contacts]
        rate = self.rate_free + self._rate_from_e * (e - self.e_free)
        all_of_them = self.springs.deviation(e, rate)
        left_out = all_of_them != 0.0
        left_out[self.active] = False
        self._found = q, e, rate
        if not left_out.any():
            return True
        self._guess = np.where(left_out, all_of_them, q)
        self._take_in(left_out)
        return False

    def _respond(self, structure: StructureBody, forces: FloatArray, inner: FloatArray) -> None:
        """Acceleration of the structure under wheels and springs; one solve tells what all springs do."""
        self._response = None
        if not self.n_own:
            return
        total = self._onto.of(inner)
        if len(self._at):
            loads = self._weights * forces[self._at][:, None]
            there = self._weights != 0.0
            total += np.bincount(self._under[there], loads[there], minlength=len(total))
        if np.any(total):
            integrator = structure.integrator
            self._total = total
            self._response = integrator.factor.solve(-integrator.weight_c * total)

    def take(self, structure: StructureBody, load: FloatArray | None, known: FloatArray | None) -> None:
        """Give the structure the loads of the wheels (n_held,) and the springs, and complete the step."""
        if self.n:
            self.q, self.e, self.rate = self._found
            self.springs.advance(self.e, self.rate)
            self.active = self._active()
            if self.on_ground:
                self.history.append(self.q)
        if self._response is None:
            structure.take(load, known)
            return
        structure.stepper.add(self._response)
        if known is not None:
            self._total[structure.columns.held] += known
        structure.stepper.finish()
        structure.carry(self._total)
        self._response = None

    def went(self, last: FloatArray, largest: int, history: FloatArray) -> None:
        """Take over steps that were made elsewhere: last deviations, elongations and rates (3, n), all deviations."""
        self.q, self.e, self.rate = last
        self.active, self.largest = self._active(), largest
        self.history.extend(history)

    @property
    def on_ground(self) -> bool:
        """Whether springs stand on supports, or elements on nothing that is modeled."""
        return bool(self._ground.nnz) or self._lift is not None

    def weigh(self, up: FloatArray, up_of_supports: FloatArray) -> None:
        """Note what forces of the springs are left in sum, from d.o.f. (n,) and supports that all move up by one."""
        lift = self._rows @ up + self._ground @ up_of_supports
        self._lift = lift if np.any(np.abs(lift) > 1e-9) else None

    def left_over(self) -> FloatArray | None:
        """Vertical force (n_step,) that elements which stand on nothing take, in the steps last asked for; None: none."""
        return None if self._lift is None else np.asarray(self._recent @ self._lift)

    def take_fleet(self, fleet: FleetBody, forces: FloatArray) -> None:
        """Give the vehicles the contact forces (n_coupled,) and their springs, and complete the step."""
        if self.n_fleet:
            inner = self.q[self.n_own :]
            fleet.stepper.add(self._fleet_responses @ inner)
            fleet.inner = np.asarray(-(self._rows_fleet.T @ inner))
        fleet.take(forces)

    def force(self) -> FloatArray | None:
        """Force (n,) of the deviations on the structure at the last completed step."""
        inner = self.q[: self.n_own]
        return np.asarray(-(self._rows.T @ inner)) if np.any(inner) else None

    def fleet_force(self) -> FloatArray | None:
        """Force (n,) of the deviations on the vehicles at the last completed step; None where they have no springs."""
        return np.asarray(-(self._rows_fleet.T @ self.q[self.n_own :])) if self.n_fleet else None

    def on_supports(self, n_step: int) -> FloatArray | None:
        """What the deviations add to the reactions in the last so many steps (n_step, n_prescribed)."""
        if not self.on_ground:
            return None
        recent, self.history = np.array(self.history[:n_step]), self.history[n_step:]
        self._recent = recent[:, : self.n_own]
        return np.asarray(self._recent @ self._ground)

    def facts(self) -> dict[str, object]:
        """For the summary."""
        if not self.n:
            return {}
        return {"nonlinear_springs": self.n, "nonlinear_springs_active": self.largest}
