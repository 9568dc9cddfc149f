"""The bodies of a crossing at a fraction of its time step: factors and path columns, made once and kept."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from axlespan.interaction.contact_system import stretch_of
from axlespan.interaction.convoy import Convoy, Lane
from axlespan.interaction.groundwork import prepare
from axlespan.interaction.nonlinear.contact import NonlinearCoupling
from axlespan.interaction.nonlinear.flights import HeldFlights
from axlespan.interaction.plan import Plan
from axlespan.interaction.records.energy import EnergyMonitor
from axlespan.interaction.records.recorder import Recorder
from axlespan.interaction.records.substeps import Substep

FloatArray = npt.NDArray[np.float64]


class Substeps:
    """Makes one step of a crossing in several parts.

    Times count in parts, so that part j of step n is the step ``parts * (n - 1) + j`` of a crossing with the time step
    Δt / parts.

    Parameters
    ----------
    coupling : NonlinearCoupling
        Of the whole time step.
    convoy : Convoy
        Its bodies.
    parts : int
        A power of two, so that times are the same to the last bit.
    """

    def __init__(self, coupling: NonlinearCoupling, convoy: Convoy, parts: int) -> None:
        self.whole, self.parts = coupling, parts
        self.plan = in_parts(convoy.plans[0], parts)
        self._recorder = Recorder(self.plan)
        structure, vehicles, load, _ = convoy.moment(0)
        lane = Lane(self.plan, self._recorder, structure, vehicles, self.plan.fleet.weight, load)
        self._convoy = Convoy([lane], prepare([self.plan]))
        self._flights = HeldFlights(coupling.flights, parts)
        self._own = NonlinearCoupling(
            coupling.laws,
            coupling.balance.for_plan(self.plan),
            coupling.approach,
            coupling.touching,
            coupling.field.for_time_step(),
            self._flights,
        )
        self._stands_at = -1  # the last time index it has made
        self._accelerations: list[tuple[FloatArray, float]] = []

    @property
    def iterations(self) -> int:
        """Iterations of the parts made since it was entered."""
        return sum(self._own.iterations)

    def enter(self, step: int, convoy: Convoy) -> None:
        """Stand where the bodies stand before a step."""
        own, whole = self._own, self.whole
        _copy_state(convoy, self._convoy)
        if self._stands_at != self.parts * (step - 1):
            own.before = _one_part_ago(whole, self.parts)
        own.approach, own.touching = whole.approach, whole.touching
        own.field.resume(whole.field)
        own.field.history = []
        own.iterations, own.residuals, own.landings, own.loss = [], [], 0, 0.0
        self._recorder.restarted.clear()
        self._recorder.released.clear()
        self._flights.forget()
        self._stands_at = -1

    def make(self, step: int, recorder: Recorder) -> FloatArray:
        """Make all parts of a step; contact forces (n_contact,) [N] after the last one.

        Raises
        ------
        StepNotConverged
            If a part does not converge.
        """
        convoy, first = self._convoy, self.parts * (step - 1)
        stretch = stretch_of([self.plan], first + 1, self.parts, convoy.structure, convoy.fleet)
        external = convoy.external(stretch)
        energy = self._energy(first) if step in recorder.energy.steps else None
        mass, dofs = recorder.balance.mass, recorder.inertial_dofs
        forces, self._accelerations = np.zeros(0), []
        for k in range(self.parts):
            forces = self._own(convoy, stretch, k, None if external is None else external[k])
            a = convoy.structure.state.a
            self._accelerations.append((a[dofs], float(mass @ a)))
            if energy is not None:
                energy.look(first + 1 + k, *convoy.moment(0))
        if energy is not None:
            recorder.energy.include(energy)
        self._stands_at = first + self.parts
        return forces

    def _energy(self, first: int) -> EnergyMonitor:
        """A balance of every part of a step."""
        energy = EnergyMonitor(self.plan, range(first + 1, first + self.parts + 1))
        energy.restarted, energy.released = self._recorder.restarted, self._recorder.released
        if self.whole.field.n_fleet:
            energy.inner_of_fleet = self._own.field.fleet_force
        energy.look(first, *self._convoy.moment(0))
        return energy

    def leave(self, step: int, convoy: Convoy, recorder: Recorder) -> None:
        """Bring bodies, interface and records of the whole time step to the end of the step.

        Raises
        ------
        AnalysisError
            If a vehicle is lost or a wheel chatters.
        """
        own, whole = self._own, self.whole
        _copy_state(self._convoy, convoy)
        whole.earlier, whole.before, whole.approach = whole.before, whole.approach, own.approach
        whole.touching = own.touching
        whole.field.resume(own.field)
        whole.landings, whole.loss = whole.landings + own.landings, whole.loss + own.loss
        if len(own.residuals) > len(whole.residuals):
            whole.residuals = own.residuals
        self._tell(step, recorder)
        self._flights.tell()

    def _tell(self, step: int, recorder: Recorder) -> None:
        """Tell the records of the whole time step what lies inside, and what was set anew at both ends."""
        restarted, released = self._recorder.restarted, self._recorder.released
        first, last = self.parts * (step - 1), self.parts * step
        if first in released:
            recorder.released[step - 1] = released[first]
        if last in restarted:
            recorder.restarted[step] = restarted[last]
        mass, dofs = recorder.balance.mass, recorder.inertial_dofs
        inside = []
        for part, (near, total) in enumerate(self._accelerations[:-1], first + 1):
            excess = restarted.get(part)
            if part in released:
                anew, excess = released[part]
                near, total = anew[dofs], float(mass @ anew)
            time = float(self.plan.times_of(np.array([part]))[0])
            inside.append(Substep(time, dofs, near, total, excess))
        recorder.between[step] = tuple(inside)


def in_parts(plan: Plan, parts: int) -> Plan:
    """A crossing with a fraction of its time step, of which nothing is kept."""
    settings = replace(
        plan.settings,
        time_step=plan.settings.time_step / parts,
        steps=plan.settings.steps * parts,
        every=plan.settings.steps * parts,
        sensors={},
        sensor_lines={},
        fields=(),
        section_forces=(),
        stresses=(),
        envelopes=(),
        line_points=(),
        notes=(),
    )
    return replace(plan, settings=settings)


def _copy_state(source: Convoy, target: Convoy) -> None:
    """Let the bodies of a convoy stand where those of another one stand."""
    target.structure.put(source.structure.state.values, source.structure.load_of(0))
    if source.fleet is not None and target.fleet is not None:
        target.fleet.put(source.fleet.state.values, source.fleet.forces.copy())
        target.fleet.inner = source.fleet.inner


def _one_part_ago(coupling: NonlinearCoupling, parts: int) -> FloatArray:
    """Approaches (n_coupled,) a part of a step ago: on the parabola through those of the last three steps."""
    x = -1.0 / parts
    shares = 0.5 * (x + 1.0) * (x + 2.0), -x * (x + 2.0), 0.5 * x * (x + 1.0)
    return shares[0] * coupling.approach + shares[1] * coupling.before + shares[2] * coupling.earlier
