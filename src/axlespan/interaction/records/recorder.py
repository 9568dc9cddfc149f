"""What a run keeps: histories at every n-th step, and peaks over all steps."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.dynamics.integrator import State
from axlespan.errors import AnalysisError, Outcome
from axlespan.interaction.plan import Plan
from axlespan.interaction.records.balance import BalanceMonitor
from axlespan.interaction.records.energy import EnergyMonitor
from axlespan.interaction.records.envelopes import EnvelopeMonitor
from axlespan.interaction.records.fields import FieldWatcher
from axlespan.interaction.records.force_noise import NoiseMonitor
from axlespan.interaction.records.gathering import Gathering
from axlespan.interaction.records.line_histories import LineHistories
from axlespan.interaction.records.monitors import CompatibilityMonitor, TensionMonitor
from axlespan.interaction.records.reactions import Reactions
from axlespan.interaction.records.section_forces import SectionHistories
from axlespan.interaction.records.stress_histories import StressHistories
from axlespan.interaction.records.substeps import Substep
from axlespan.interaction.records.sums import Sums
from axlespan.interaction.records.tape import LaneTape
from axlespan.interaction.records.watchers import Keeper, Watcher, Watchers
from axlespan.interaction.result import Result
from axlespan.interaction.settings import DAMPED_ALPHA

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# A contact force so many times the largest static one means that the run has diverged.
_DIVERGED = 1e4

_QUANTITIES = ("displacement", "velocity", "acceleration")


@dataclass(eq=False)
class Histories:
    """Arrays at the kept times; first index time."""

    contact_force: FloatArray  # (n_time, n_contact) [N]
    contact_position: FloatArray  # (n_time, n_contact) [m]
    vehicle: dict[str, FloatArray]  # quantity -> (n_time, n_vehicle_dof)
    sensor: dict[str, FloatArray]  # quantity -> (n_time, n_sensor)
    support_reaction: FloatArray  # (n_time, n_support) [N, N m]


class Recorder:
    """Keeps histories and watches the run; handed to the march, which knows nothing of its inside.

    ``like`` is the recorder of another crossing, whose tables serve here too if it reads the same of the structure.
    """

    def __init__(
        self,
        plan: Plan,
        progress: Callable[[int], None] | None = None,
        watchers: Sequence[Watcher] = (),
        like: Recorder | None = None,
    ) -> None:
        self.plan, self._progress = plan, progress
        self.notes: list[str] = list(plan.settings.notes)
        self.counts: dict[str, float] = {}  # of a coupling: iterations, factorizations
        self.every = plan.settings.every
        n_kept = plan.settings.steps // self.every + 1
        n_contact, n_vehicle = plan.rows.n_contact, plan.fleet.matrices.size
        known = like if like is not None and like._reads_the_same(plan) else None
        self._sensor_rows: sp.csr_array = plan.sensor_rows() if known is None else known._sensor_rows
        self._sensor_sums: Sums = self._sensors() if known is None else known._sensor_sums
        self.reactions: Reactions = Reactions(plan, None if known is None else known.reactions)
        self.compatibility: CompatibilityMonitor = CompatibilityMonitor()
        self.energy = EnergyMonitor(plan, alone=like is None)
        self.fields = FieldWatcher(plan)
        self.watchers = Watchers([self.energy, self.fields, *watchers])
        self.sections, self.stresses = SectionHistories(plan), StressHistories(plan)
        self.envelopes = EnvelopeMonitor(plan)
        self.line: LineHistories = LineHistories(plan, None if known is None else known.line)
        self._keepers: tuple[Keeper, ...] = (self.sections, self.stresses, self.envelopes)
        self.balance: BalanceMonitor = BalanceMonitor(
            plan, self.reactions.paths, None if known is None else known.balance
        )
        self.tension = TensionMonitor(plan)
        self.noise = NoiseMonitor(plan.fleet.weight, plan.fleet.coupled)
        # Steps at which a wheel landed, or after which one let go, with what was set anew: see the balance monitor.
        self.restarted: dict[int, float] = {}
        self.reactions.restarted = self.balance.restarted = self.energy.restarted = self.restarted
        self.released: dict[int, tuple[FloatArray, float]] = {}
        self.reactions.released = self.balance.released = self.energy.released = self.released
        # Steps that were cut, with what lies inside.
        self.between: dict[int, tuple[Substep, ...]] = {}
        self.reactions.between = self.balance.between = self.energy.cut = self.between
        sections = [*self.sections.forces, *self.envelopes.forces]
        for forces in sections:
            forces.restarted, forces.released, forces.between = self.restarted, self.released, self.between
        inertial = [self.reactions.free_dofs, *(forces.free_dofs for forces in sections)]
        self.inertial_dofs: IntArray = np.unique(np.concatenate(inertial)).astype(np.int64)
        self.more_checks: Callable[[], Mapping[str, Any]] | None = None
        self.more_facts: Callable[[], Mapping[str, Any]] | None = None
        n_sensor = self._sensor_rows.shape[0]
        self.histories = Histories(
            _forces(plan, n_kept),
            np.empty((n_kept, n_contact)),
            # In one piece, which large pages may hold.
            dict(zip(_QUANTITIES, np.empty((3, n_kept, n_vehicle)), strict=True)),
            {name: np.empty((n_kept, n_sensor)) for name in _QUANTITIES},
            np.empty((n_kept, len(plan.crossing.structure.system.prescribed))),
        )
        parts = [self.balance.sums, self.reactions.sums, self._sensor_sums, self.line.sums]
        self.sums: Sums = Sums.together(parts) if known is None else known.sums
        self._ends = np.cumsum([part.count for part in parts]).tolist()
        own = [keeper.free_dofs for keeper in self._keepers]
        self.selected = np.unique(np.concatenate(own)).astype(np.int64)
        self._own = [np.searchsorted(self.selected, dofs) for dofs in own]
        self._gathering = Gathering()
        # Nonlinear couplings set things anew from step to step, which must be read in time.
        self._at_once = plan.is_nonlinear
        self.completed = 0  # time index of the last good step
        self.finite = True

    def _sensors(self) -> Sums:
        """Displacements, then velocities, then accelerations of all sensors."""
        rows = sp.csr_array(self._sensor_rows[:, self.plan.crossing.structure.system.free])
        none = sp.csr_array(rows.shape)
        blocks = ((rows, none, none), (none, rows, none), (none, none, rows))
        return Sums.together([Sums.of_blocks(*of) for of in blocks])

    def _reads_the_same(self, plan: Plan) -> bool:
        own, other = self.plan.settings, plan.settings
        return (
            self.plan.crossing.structure is plan.crossing.structure
            and own.sensors == other.sensors
            and own.sensor_lines == other.sensor_lines
            and own.line_points == other.line_points
            and (own.footprint, own.sleepers) == (other.footprint, other.sleepers)
        )

    # --- during the run ----------------------------------------------------------------------

    def begin(self, structure: State, vehicles: State, forces: FloatArray, load: FloatArray) -> None:
        """Keep time zero: states, contact forces (n_contact,) and Eᵀ X (n,)."""
        near = structure.values[:, None, self.selected]
        sums = self.sums.of(structure.values)
        tape = LaneTape(near, vehicles.values[:, None], forces[None], sums[None])
        zero = np.zeros(1, dtype=np.int64)
        self._take(zero, self.plan.rows.positions(np.zeros(1)), tape)
        if self.watchers.looks_at(0):
            self.watchers.look(0, structure, vehicles, load, forces[self.plan.fleet.coupled])

    def work_up(self, steps: IntArray, positions: FloatArray, tape: LaneTape) -> None:
        """Work up the tape of consecutive good steps, at once or later: histories, reactions, peaks, checks."""
        if self._at_once or self._gathering.is_vain(len(steps)):
            self._take(steps, positions, tape)
        else:
            self.completed = int(steps[-1])
            if self._gathering.add(steps, positions, tape):
                self._work_off()
        if self._progress is not None:
            self._progress(self.completed)

    def _work_off(self) -> None:
        """Work up what has been gathered."""
        gathered = self._gathering.taken()
        if gathered is not None:
            self._take(*gathered)

    def broken_off(
        self, steps: IntArray, positions: FloatArray, tape: LaneTape, n_good: int, message: str | None
    ) -> AnalysisError:
        """Keep the good steps of a stretch that failed; the error that says what happened.

        Without a message the step after the good ones holds a value that is not finite or out of bounds.
        """
        self._work_off()
        if n_good:
            self._take(steps[:n_good], positions[:n_good], tape.upto(n_good))
        if message is not None:
            return AnalysisError(message)
        self.finite = False
        return self._divergence(int(steps[n_good]), tape.forces[n_good], tape.vehicles[0, n_good])

    @cached_property
    def largest_force(self) -> float:
        """A contact force so large means that the run has diverged [N]."""
        fleet = self.plan.fleet
        weight = float(np.abs(fleet.weight).max()) or 9.81 * float(fleet.matrices.M.sum())  # without gravity
        return _DIVERGED * max(weight, 1.0)

    def first_bad(self, tape: LaneTape) -> int | None:
        """The first step with a value that is not finite or a contact force that has run away."""
        limit = self.largest_force
        with np.errstate(all="ignore"):  # a sum is finite only if everything in it is
            totals = [part.sum() for part in (tape.vehicles, tape.near, tape.sums)]
            if np.isfinite(totals).all() and np.abs(tape.forces).max(initial=0.0) < limit:
                return None
        good = np.isfinite(tape.vehicles).all(axis=(0, 2)) & np.isfinite(tape.near).all(axis=(0, 2))
        with np.errstate(invalid="ignore"):
            good &= (np.abs(tape.forces) < limit).all(axis=1)
        good &= np.isfinite(tape.sums).all(axis=1)
        return None if good.all() else int(np.argmin(good))

    def _divergence(self, step: int, forces: FloatArray, motion: FloatArray) -> AnalysisError:
        time = step * self.plan.settings.time_step
        force = np.abs(np.nan_to_num(forces, nan=np.inf))
        where = f"contact {self.plan.crossing.contact_names[int(np.argmax(force))]}"
        if len(motion):
            largest = int(np.argmax(np.abs(np.nan_to_num(motion, nan=np.inf))))
            where += f", d.o.f. {self.plan.fleet.dof_names[largest]}"
        return AnalysisError(
            f"the run diverged at step {step}, t = {time:.6g} s ({where}): a value is not finite or a contact force "
            f"exceeds {_DIVERGED:g} times the static one. Use alpha = {DAMPED_ALPHA}, a smaller time step, or check "
            "masses and stiffnesses"
        )

    # --- after a stretch -----------------------------------------------------------------------

    def _take(self, steps: IntArray, positions: FloatArray, tape: LaneTape) -> None:
        """Move what is asked for into the histories."""
        # All that reads forces reads them faster in one piece.
        tape = replace(tape, forces=np.ascontiguousarray(tape.forces))
        first, second, third, _ = self._ends
        reactions = self.reactions.of(steps, tape.sums[:, first:second], positions, tape.forces)
        self.balance.look(steps, tape.sums[:, :first], reactions, positions, tape.forces)
        n_sensor = self._sensor_rows.shape[0]
        sensors = tape.sums[:, second:third].reshape(len(steps), 3, n_sensor).transpose(1, 0, 2)
        sensors = sensors + self._moved_sensors(steps)
        self.line.look(steps, tape.sums[:, third:])
        self.tension.look(steps, positions, tape.forces)
        self.noise.look(tape.forces)
        for keeper, at in zip(self._keepers, self._own, strict=True):
            own_near = tape.near if len(at) == len(self.selected) else tape.near[:, :, at]
            keeper.look(steps, own_near, positions, tape.forces)
        for step in [step for step in self.released if step < steps[-1]]:
            del self.released[step]
        for step in [step for step in self.between if step <= steps[-1]]:
            del self.between[step]
        first = int(-(-steps[0] // self.every))  # of the kept steps
        kept = slice(first * self.every - int(steps[0]), None, self.every)
        into = slice(first, first + len(steps[kept]))
        h = self.histories
        h.contact_position[into] = positions[kept]
        if h.contact_force.flags.writeable:
            h.contact_force[into] = tape.forces[kept]
        h.support_reaction[into] = reactions[kept]
        for i, name in enumerate(_QUANTITIES):
            if h.vehicle[name].size:
                h.vehicle[name][into] = tape.vehicles[i, kept]
            if h.sensor[name].size:
                h.sensor[name][into] = sensors[i, kept]
        self.completed = int(steps[-1])

    def _moved_sensors(self, steps: IntArray) -> FloatArray:
        """What supports that move add at the sensors (3, n_step, n_sensor): E_P u_P and its rates."""
        plan = self.plan
        if not len(plan.moving) or not self._sensor_rows.shape[0]:
            return np.zeros((3, 1, self._sensor_rows.shape[0]))
        result = np.zeros((3, len(steps), self._sensor_rows.shape[0]))
        times = plan.times_of(steps)
        rows = self._sensor_rows[:, plan.crossing.structure.system.prescribed[plan.moving]]
        for i, name in enumerate(("value", "velocity", "acceleration")):
            motions = [getattr(plan.crossing.structure.system.motions[j], name)(times) for j in plan.moving]
            result[i] = (rows @ np.array(motions)).T
        return result

    # --- at the end ----------------------------------------------------------------------------

    def result(self, outcome: Outcome, facts: Mapping[str, Any]) -> Result:
        """The result up to the last good step."""
        plan, h = self.plan, self.histories
        self._work_off()
        self.tension.finish()
        n = self.completed // self.every + 1
        return Result(
            time=plan.times_of(np.arange(n) * self.every),
            sensor=tuple(plan.settings.sensors),
            contact=plan.crossing.contact_names,
            vehicle_dof=plan.fleet.dof_names,
            support=plan.crossing.structure.system.support_names if plan.settings.reactions else (),
            sensor_displacement=h.sensor["displacement"][:n],
            sensor_velocity=h.sensor["velocity"][:n],
            sensor_acceleration=h.sensor["acceleration"][:n],
            contact_force=h.contact_force[:n],
            contact_position=h.contact_position[:n],
            vehicle_displacement=h.vehicle["displacement"][:n],
            vehicle_velocity=h.vehicle["velocity"][:n],
            vehicle_acceleration=h.vehicle["acceleration"][:n],
            support_reaction=h.support_reaction[:n]
            if plan.settings.reactions
            else h.support_reaction[:n, :0],
            section=self.sections.names,
            **self.sections.histories(n),
            stress=self.stresses.names,
            stress_history=self.stresses.histories(n),
            **self.line.histories(n),
            envelopes=self.envelopes.envelopes(),
            fields=self.fields.fields(self.completed),
            outcome=outcome,
            checks=self._checks(),
            facts={
                **facts,
                **self.counts,
                **_of(self.more_facts),
                "completed_steps": self.completed,
                "notes": tuple(self.notes),
            },
        )

    def _checks(self) -> dict[str, Any]:
        tension, names = self.tension, self.plan.crossing.contact_names

        def by_contact(values: FloatArray) -> dict[str, float]:
            return dict(zip(names, values.tolist(), strict=True))

        return {
            "finite_values": self.finite,
            "compatibility_residual": self.compatibility.residual,
            "equilibrium_residual": self.balance.residual,
            "energy_residual": self.energy.residual,
            "force_noise": self.noise.largest,
            "tension_episodes": tension.count,
            "tension": [asdict(episode) for episode in tension.episodes],
            "largest_contact_force": by_contact(tension.largest),
            "largest_contact_force_time": by_contact(tension.largest_at),
            "smallest_contact_force": by_contact(tension.smallest),
            "smallest_contact_force_time": by_contact(tension.smallest_at),
            "static_contact_force": by_contact(self.plan.fleet.weight),
            **_of(self.more_checks),
        }


def _forces(plan: Plan, n_kept: int) -> FloatArray:
    """Room for contact forces (n_kept, n_contact); those of moving forces alone stay as they are."""
    if len(plan.fleet.coupled):
        return np.empty((n_kept, plan.rows.n_contact))
    return np.broadcast_to(plan.fleet.weight, (n_kept, plan.rows.n_contact))


def _of(source: Callable[[], Mapping[str, Any]] | None) -> Mapping[str, Any]:
    return {} if source is None else source()
