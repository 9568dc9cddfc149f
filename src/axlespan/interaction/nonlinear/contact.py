r"""The direct method with laws of contact and nonlinear springs: (D8) with p = F(d) in place of a plain solve.

One step:

1. both bodies advance without new interface forces, as in the linear method;
2. the interface, wheels and those springs that deviate from their reference stiffness, is solved by Newton's
   method on the compliance S: the structure's share of it is interpolated from columns of A⁻¹ at hand;
3. both bodies take the forces.

Wheels of a one-sided contact that land get an inelastic landing, see :mod:`axlespan.interaction.nonlinear.balance`.
The factor of A serves all steps.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import block_diag

from axlespan.contact.laws_of_wheels import WheelLaws
from axlespan.errors import AnalysisError
from axlespan.interaction.bodies import StructureBody
from axlespan.interaction.contact_system import Stretch
from axlespan.interaction.convoy import Convoy
from axlespan.interaction.march import all_forces
from axlespan.interaction.nonlinear.balance import Balance
from axlespan.interaction.nonlinear.flights import Flights
from axlespan.interaction.nonlinear.interface_solver import Interface, NotConverged, Solution, solve_interface
from axlespan.interaction.nonlinear.spring_field import SpringField
from axlespan.interaction.start import ContactRows

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]

_RELEASES = 3  # how often a step is repeated because a wheel lets go


class StepNotConverged(AnalysisError):
    """The interface of a step has not converged: bodies and springs stand at the step before.

    Parameters
    ----------
    message : str
    where : str
        The wheel or spring with the largest residual.
    residual : float
        That residual [N].
    iterations : int
        Made in vain.
    """

    def __init__(self, message: str, where: str, residual: float, iterations: int) -> None:
        self.where, self.residual, self.iterations = where, residual, iterations
        super().__init__(message)


def left_over(iterations: int, residual: float, where: str) -> str:
    """How an iteration ended that did not converge."""
    count = f"{iterations} iteration{'s' if iterations != 1 else ''}"
    if np.isnan(residual):
        return f"{count}, the force at {where} is not a number"
    return f"{count}, residual {residual:.3g} N, worst at {where}"


@dataclass(frozen=True, eq=False)
class _Group:
    """Wheels whose interfaces do not feel each other: rows (n_group, n_wheel) and compliance."""

    wheels: IntArray  # (n_group, n_wheel) among the coupled ones
    S: FloatArray  # (n_group, n_wheel, n_wheel)


class NonlinearCoupling:
    """Makes the steps of one crossing whose contact or track is nonlinear.

    Parameters
    ----------
    laws : WheelLaws
        Of the coupled wheels.
    balance : Balance
        For landings.
    approach : array (n_coupled,)
        At time zero [m].
    touching : array (n_coupled,)
        Constrained wheels that touch at time zero.
    field : SpringField
        The structure's nonlinear springs.
    flights : Flights
        Keeps account of wheels in the air.
    """

    def __init__(
        self,
        laws: WheelLaws,
        balance: Balance,
        approach: FloatArray,
        touching: Mask,
        field: SpringField,
        flights: Flights,
    ) -> None:
        self.laws, self.balance, self.field, self.flights = laws, balance, field, flights
        self.approach, self.before = approach.copy(), approach.copy()  # of the last two steps
        self.earlier = self.before  # of the step before those
        self.touching = touching.copy()
        held = np.concatenate([balance.plan.fleet.weight, field.springs.held])
        self.scale = max(float(np.abs(held).max(initial=0.0)), 1.0)
        self.iterations: list[int] = []  # of each step
        self.residuals: list[float] = []  # of the slowest step
        self.landings, self.loss = 0, 0.0  # [J]
        self._stretch: Stretch | None = None
        self._off: list[_Group] = []
        self._together = np.empty(0, dtype=np.int64)  # wheels that are solved for with the structure
        self._whole: FloatArray | None = None  # their compliance, where vehicles have springs of their own
        self._dt = balance.plan.settings.time_step

    # --- one step ------------------------------------------------------------------------------

    def __call__(self, convoy: Convoy, stretch: Stretch, k: int, external: FloatArray | None) -> FloatArray:
        """One step of a single lane.

        Raises
        ------
        StepNotConverged
            If the interface does not converge.
        AnalysisError
            If a vehicle is lost or a wheel chatters.
        """
        structure, fleet = convoy.structure, convoy.fleet
        if self._stretch is not stretch:
            self._enter(convoy, stretch)
        step = stretch.first + k
        count = 0
        for _ in range(_RELEASES):
            forces, approach, free, more = self._attempt(convoy, stretch, k, external)
            count += more
            if not self._release(convoy, step, forces):
                break
        self.iterations.append(count)
        load = None
        if fleet is not None and len(stretch.into):
            load = structure.path_load(stretch.held[k], stretch.weights[k], forces[stretch.into])
        self.field.take(structure, load, convoy.known_load(stretch, k))
        if fleet is None:
            return convoy.joint.weight
        self.field.take_fleet(fleet, forces)
        self._after(convoy, step, forces, approach, free)
        return all_forces(convoy, fleet.forces)

    def _enter(self, convoy: Convoy, stretch: Stretch) -> None:
        """Sort the wheels of a stretch: vehicles wholly off the structure stand for themselves."""
        self._stretch, self._off = stretch, []
        self.field.enter(convoy.structure, convoy.fleet)
        self._together = np.empty(0, dtype=np.int64)
        if convoy.fleet is None:
            return
        if convoy.structure.integrator.weight_p:
            self.balance.smoothed(convoy.structure.integrator.factor, convoy.fleet.integrator.factor)
        fleet = convoy.fleet.fleet
        self._together = stretch.systems[0].contacts if stretch.systems else np.empty(0, dtype=np.int64)
        if self.field.n_fleet:  # all wheels are one interface with the springs of their vehicles
            self._together = np.arange(len(fleet.coupled))
            self._whole = convoy.fleet.compliance.toarray()
        together = self._together
        apart = np.setdiff1d(np.arange(len(fleet.coupled)), together)
        owner = fleet.vehicle_of[apart]
        vehicles, count = np.unique(owner, return_counts=True)
        for n_wheel in np.unique(count):
            wheels = apart[np.isin(owner, vehicles[count == n_wheel])].reshape(-1, int(n_wheel))
            S = np.array([convoy.fleet.compliance[own][:, own].toarray() for own in wheels])
            self._off.append(_Group(wheels, 0.5 * (S + S.transpose(0, 2, 1))))

    def _attempt(
        self, convoy: Convoy, stretch: Stretch, k: int, external: FloatArray | None
    ) -> tuple[FloatArray, FloatArray, FloatArray, int]:
        """Predict both bodies and solve the interface; forces, approaches and free approaches (n_coupled,), iterations."""
        structure, fleet, into = convoy.structure, convoy.fleet, stretch.into
        convoy.predict(stretch, k, external)
        if fleet is not None:
            fleet.predict()
        self.field.predict(structure, fleet)
        nothing = np.zeros(0)
        if fleet is None:
            count = self._on_structure(structure, stretch, k, nothing, nothing, nothing, nothing)
            return nothing, nothing, nothing, count
        free = stretch.gap[k] - fleet.at_wheels()
        if len(into):
            free[into] += structure.gather(stretch.flat[k], stretch.held[k], stretch.weights[k])
        forces, approach = np.zeros(len(free)), np.zeros(len(free))
        count = 0
        for group in self._off:
            solution = self._solved(
                stretch.first + k, group.wheels, group.S, free[group.wheels], fleet.forces
            )
            forces[group.wheels], approach[group.wheels] = solution.forces, solution.coordinates
            count = max(count, len(solution.residuals))
        count = max(count, self._on_structure(structure, stretch, k, free, forces, approach, fleet.forces))
        return forces, approach, free, count

    def _on_structure(
        self,
        structure: StructureBody,
        stretch: Stretch,
        k: int,
        free: FloatArray,
        forces: FloatArray,
        approach: FloatArray,
        guess: FloatArray,
    ) -> int:
        """Solve for the wheels of vehicles on the structure and the springs that deviate; iterations."""
        field = self.field
        contacts = self._together
        if not len(contacts) and not field.busy:
            field.rest()
            return 0
        S, w, count = self._system(stretch, k), len(contacts), 0
        into = np.searchsorted(contacts, stretch.into)
        field.meet(stretch.flat[k], stretch.weights[k], into, contacts)
        outer = guess[contacts]
        while True:
            system, given, inner = field.joined(S, free[contacts])
            start = np.concatenate([outer, inner])
            solution = self._solved(stretch.first + k, contacts, system, given, start, field)
            count += len(solution.residuals)
            outer = solution.forces[:w]
            if field.settle(structure, outer, solution.forces[w:]):
                break
        forces[contacts], approach[contacts] = solution.forces[:w], solution.coordinates[:w]
        return count

    def _system(self, stretch: Stretch, k: int) -> FloatArray:
        """Compliance (n_wheel, n_wheel) of the wheels that are solved for together."""
        systems = stretch.systems
        if self._whole is None:
            return systems[0].matrices[k] if systems else np.zeros((0, 0))
        whole = self._whole.copy()
        if systems:
            whole[np.ix_(systems[0].contacts, systems[0].contacts)] = systems[0].matrices[k]
        return whole

    def _solved(
        self,
        step: int,
        wheels: IntArray,
        system: FloatArray,
        free: FloatArray,
        guess: FloatArray,
        field: SpringField | None = None,
    ) -> Solution:
        """Solve one interface: wheels (..., n_wheel), then the active springs of a field."""
        laws, w = self.laws, wheels.shape[-1]
        n_spring = free.shape[-1] - w
        rigid, unilateral = (
            np.concatenate([mask[wheels], np.zeros((*wheels.shape[:-1], n_spring), dtype=bool)], axis=-1)
            for mask in (laws.rigid, laws.unilateral)
        )
        compliant = n_spring or not (rigid | unilateral).all()

        def evaluate(d: FloatArray) -> tuple[FloatArray, FloatArray]:
            approach, rate, per_rate = self._kinematics(wheels, d[..., :w])
            force = laws.force(approach, rate)[wheels]
            slope, damping = laws.tangent(approach, rate)
            slope = (slope + per_rate * damping)[wheels]
            if field is None or not n_spring:
                return force, slope
            inner, inner_slope = field.evaluate(d[w:])
            if inner_slope.ndim == 2:
                return np.concatenate([force, inner]), block_diag(np.diag(slope), inner_slope)
            return np.concatenate([force, inner]), np.concatenate([slope, inner_slope])

        interface = Interface(rigid, unilateral, evaluate if compliant else None, self.scale)
        try:
            solution = solve_interface(
                system, free, interface, guess[wheels] if guess.shape != free.shape else guess
            )
        except NotConverged as error:
            raise self._stuck(step, wheels, error, field) from error
        if len(solution.residuals) > len(self.residuals):
            self.residuals = solution.residuals
        return solution

    def _kinematics(self, wheels: IntArray, d: FloatArray) -> tuple[FloatArray, FloatArray, float]:
        """Approaches (n_coupled,), rates by the backward difference of second order, and the rate's derivative."""
        approach = self.approach.copy()
        approach[wheels] = d
        rate = (3.0 * approach - 4.0 * self.approach + self.before) / (2.0 * self._dt)
        return approach, rate, 1.5 / self._dt

    # --- landing and letting go ------------------------------------------------------------------

    def _release(self, convoy: Convoy, step: int, forces: FloatArray) -> bool:
        """Let wheels go at the step before, with accelerations to match: a force that ends then does no work."""
        fleet, recorder = convoy.fleet, convoy.lanes[0].recorder
        if fleet is None:
            return False
        leaving = self.laws.unilateral & self.touching & (forces <= 0.0)
        if not leaving.any():
            return False
        self.touching = self.touching & ~leaving
        time = (step - 1) * self._dt
        rows = self.balance.rows(time)
        excess = self._balanced(convoy, rows, time, fleet.forces)
        recorder.released[step - 1] = convoy.structure.state.a.copy(), excess
        return True

    def _balanced(self, convoy: Convoy, rows: ContactRows, time: float, forces: FloatArray) -> float:
        """Make accelerations and forces of the last completed step those of the wheels that touch.

        Returns the inertia that they leave out, see :meth:`Balance.accelerate`.
        """
        structure, fleet = convoy.structure, convoy.fleet
        assert fleet is not None
        x = self.balance.plan.fleet.coupled
        given = self.balance.plan.fleet.weight.copy()
        given[x] = np.where(self.laws.constrained, 0.0, forces)
        total, excess = self.balance.accelerate(
            rows, structure.state, fleet.state, time, self.touching, given, self.field.force(), fleet.inner
        )
        fleet.forces = total[x]
        load = np.asarray(rows.E.T @ total)
        inner = self.field.force()
        structure.carry(load if inner is None else load - inner)
        return excess

    def _after(
        self, convoy: Convoy, step: int, forces: FloatArray, approach: FloatArray, free: FloatArray
    ) -> None:
        """Remember approaches, land wheels, keep account of flights."""
        structure, fleet = convoy.structure, convoy.fleet
        assert fleet is not None
        laws = self.laws
        on = laws.rigid | (laws.unilateral & (forces > 0.0))
        approach[on] = 0.0
        landed = on & laws.unilateral & ~self.touching
        # The step that closes a gap takes energy, and the impulse after it.
        self.loss -= 0.5 * float(forces[landed] @ self.approach[landed])
        closing = self._closing_rates(free)
        self.touching = on
        if landed.any():
            time = step * self._dt
            rows = self.balance.rows(time)
            _, loss = self.balance.land(rows, structure.state, fleet.state, time, on)
            convoy.lanes[0].recorder.restarted[step] = self._balanced(convoy, rows, time, forces)
            self.touching = laws.rigid | (laws.unilateral & (fleet.forces > 0.0))
            self.landings, self.loss = self.landings + int(landed.sum()), self.loss + loss
        self.earlier, self.before, self.approach = self.before, self.approach, approach
        self.flights.look(step, laws.may_part & ~(fleet.forces > 0.0), landed, approach, closing)

    def went(self, step: int, approaches: FloatArray) -> None:
        """Take over approaches (3, n_coupled) of the last three steps, made elsewhere, with no wheel in the air."""
        self.approach, self.before, self.earlier = approaches
        nobody = np.zeros(len(self.approach), dtype=bool)
        if len(nobody):
            self.flights.look(step, nobody, nobody, self.approach, self.approach)

    def flew(self, step: int, forces: FloatArray, approach: FloatArray, free: FloatArray) -> None:
        """Take over a step made elsewhere, in which no wheel lifted off a one-sided contact or landed on one.

        Raises
        ------
        AnalysisError
            If a vehicle is lost or a wheel chatters.
        """
        closing = self._closing_rates(free)
        self.earlier, self.before, self.approach = self.before, self.approach, approach
        nobody = np.zeros(len(approach), dtype=bool)
        self.flights.look(step, self.laws.may_part & ~(forces > 0.0), nobody, approach, closing)

    @property
    def time_step(self) -> float:
        """Δt [s]."""
        return self._dt

    def _closing_rates(self, free: FloatArray) -> FloatArray:
        """Rates (n_coupled,) [m/s] at which gaps close when they do, from the last approaches and the free one."""
        rise = free - self.approach
        with np.errstate(divide="ignore", invalid="ignore"):
            share = np.clip(np.where(rise != 0.0, -self.approach / rise, 0.0), 0.0, 1.0)
        bend = free - 2.0 * self.approach + self.before
        return np.asarray((rise + (share - 0.5) * bend) / self._dt)

    def _stuck(
        self, step: int, wheels: IntArray, error: NotConverged, field: SpringField | None
    ) -> StepNotConverged:
        """Say which step did not converge, where it is worst, and what to do."""
        w = wheels.size
        if error.row < w:
            names = self.balance.plan.crossing.contact_names
            where = f"contact {names[int(self.balance.plan.fleet.coupled[wheels.ravel()[error.row]])]}"
        else:
            assert field is not None
            where = f"spring {field.springs.names[int(field.active[error.row - w])]}"
        said = left_over(len(error.residuals), error.residuals[-1], where)
        message = (
            f"step {step}, t = {step * self._dt:.6g} s: the interface of wheels and springs did not converge "
            f"({said}). Use a smaller time step, or a law without jumps of its tangent"
        )
        return StepNotConverged(message, where, error.residuals[-1], len(error.residuals))

    def facts(self) -> dict[str, object]:
        """What the summary says of the iterations and landings."""
        counts = np.array(self.iterations or [0])
        facts: dict[str, object] = {
            "newton_iterations": int(counts.sum()),
            "newton_iterations_largest": int(counts.max()),
            "newton_iterations_per_step": counts,
            "newton_residuals": tuple(self.residuals),
            "contact_laws": tuple(dict.fromkeys(self.laws.kinds)),
            "landings": self.landings,
            "landing_loss": self.loss,
        }
        return facts | self.field.facts()
