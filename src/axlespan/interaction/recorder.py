"""What a run keeps: histories at every n-th step, and peaks over all steps."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.errors import AnalysisError, Outcome
from axlespan.interaction.bodies import FleetBody, StructureBody
from axlespan.interaction.contact_system import Stretch
from axlespan.interaction.monitors import BalanceMonitor, CompatibilityMonitor, EnergyMonitor, TensionMonitor
from axlespan.interaction.plan import Plan
from axlespan.interaction.reactions import Reactions
from axlespan.interaction.result import Result

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# A contact force so many times the largest static one means that the run has diverged.
_DIVERGED = 1e6

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
    """Keeps histories and watches the run; handed to the march, which knows nothing of its inside."""

    def __init__(self, plan: Plan, progress: Callable[[int], None] | None = None) -> None:
        self.plan, self._progress = plan, progress
        self.notes: list[str] = list(plan.settings.notes)
        self.counts: dict[str, float] = {}  # of a coupling: iterations, factorizations
        self.every = plan.settings.every
        n_kept = plan.settings.steps // self.every + 1
        n_contact, n_vehicle = plan.rows.n_contact, plan.fleet.matrices.size
        self._sensor_dofs, self._sensor_weights = self._sensors()
        self.reactions = Reactions(plan)
        self.compatibility, self.energy = CompatibilityMonitor(plan), EnergyMonitor(plan)
        self.balance, self.tension = BalanceMonitor(plan, self.reactions.paths), TensionMonitor(plan)
        n_sensor = len(self._sensor_dofs)
        self.histories = Histories(
            np.zeros((n_kept, n_contact)),
            np.zeros((n_kept, n_contact)),
            {name: np.zeros((n_kept, n_vehicle)) for name in _QUANTITIES},
            {name: np.zeros((n_kept, n_sensor)) for name in _QUANTITIES},
            np.zeros((n_kept, len(plan.crossing.structure.system.prescribed))),
        )
        self._selected, self._inverse = np.unique(
            np.concatenate([self._sensor_dofs.ravel(), self.reactions.free_dofs]), return_inverse=True
        )
        self.completed = 0  # time index of the last good step
        self.finite = True
        self._pending: tuple[Stretch, int] | None = None  # a stretch that is not worked up yet
        self._buffer_steps = 0

    def _sensors(self) -> tuple[IntArray, FloatArray]:
        positions = np.array(list(self.plan.settings.sensors.values()), float)
        if not len(positions):
            return np.zeros((0, 1), dtype=np.int64), np.zeros((0, 1))
        return self.plan.sensor_path.weights(positions)

    # --- in the loop ---------------------------------------------------------------------------

    def begin(self, structure: StructureBody, fleet: FleetBody | None, forces: FloatArray) -> None:
        """Keep time zero."""
        self._allocate(1)
        self._take(0, structure, fleet, forces)
        self.energy.begin(structure, fleet)
        zero, positions = np.zeros(1, dtype=np.int64), self.plan.rows.positions(np.zeros(1))
        self._keep(zero, positions)
        self.tension.look(zero, positions, self._forces)

    def step(
        self, stretch: Stretch, k: int, structure: StructureBody, fleet: FleetBody | None, forces: FloatArray
    ) -> None:
        """Keep one step of a stretch."""
        if k == 0:
            self._allocate(stretch.n_step)
        self._take(k, structure, fleet, forces)
        self._pending = (stretch, k + 1)
        self.energy.step(stretch, k, structure, fleet, forces)
        if fleet is not None and k == stretch.n_step - 1:
            self.compatibility.look(stretch, k, structure, fleet)

    def end_of(self, stretch: Stretch) -> None:
        """Work up a stretch: reactions, peaks, checks.

        Raises
        ------
        AnalysisError
            If a value is not finite or the contact forces have run away.
        """
        self._work_up(stretch, stretch.n_step)
        if self._progress is not None:
            self._progress(self.completed)

    def salvage(self) -> None:
        """Keep the good steps of a stretch that was broken off."""
        if self._pending is not None:
            stretch, n_step = self._pending
            with suppress(AnalysisError):
                self._work_up(stretch, n_step)

    def _work_up(self, stretch: Stretch, n_step: int) -> None:
        self._pending = None
        steps = stretch.first + np.arange(n_step)
        bad = self._first_bad(n_step)
        n_good = n_step if bad is None else bad
        if n_good:
            self._keep(steps[:n_good], stretch.positions[:n_good])
            self.tension.look(steps[:n_good], stretch.positions[:n_good], self._forces[:n_good])
        if bad is not None:
            self.finite = False
            self._raise_for(int(steps[bad]), bad)

    def _allocate(self, n_step: int) -> None:
        if n_step != self._buffer_steps:
            n_selected, n_vehicle = len(self._selected), self.plan.fleet.matrices.size
            self._structure_rows = np.zeros((3, n_step, n_selected))
            self._vehicle_rows = np.zeros((3, n_step, n_vehicle))
            self._forces = np.zeros((n_step, self.plan.rows.n_contact))
            self._sums = np.zeros((n_step, self.balance.n_sum))
            self._buffer_steps = n_step

    def _take(self, k: int, structure: StructureBody, fleet: FleetBody | None, forces: FloatArray) -> None:
        state = structure.state
        if len(self._selected):
            for row, values in zip(self._structure_rows, (state.u, state.v, state.a), strict=True):
                values.take(self._selected, out=row[k])
        if fleet is not None:
            own = fleet.state
            rows = self._vehicle_rows
            rows[0, k], rows[1, k], rows[2, k] = own.u, own.v, own.a
        self._forces[k] = forces
        self.balance.take(state, self._sums[k])

    # --- after a stretch -----------------------------------------------------------------------

    def _first_bad(self, n_step: int) -> int | None:
        limit = _DIVERGED * max(float(np.abs(self.plan.fleet.weight).max()), 1.0)
        good = np.isfinite(self._vehicle_rows[:, :n_step]).all(axis=(0, 2))
        good &= np.isfinite(self._structure_rows[:, :n_step]).all(axis=(0, 2))
        with np.errstate(invalid="ignore"):
            good &= (np.abs(self._forces[:n_step]) < limit).all(axis=1)
        good &= np.isfinite(self._sums[:n_step]).all(axis=1)
        return None if good.all() else int(np.argmin(good))

    def _raise_for(self, step: int, k: int) -> None:
        time = step * self.plan.settings.time_step
        with np.errstate(invalid="ignore", over="ignore"):
            force = np.abs(np.nan_to_num(self._forces[k], nan=np.inf))
            motion = np.abs(np.nan_to_num(self._vehicle_rows[0, k], nan=np.inf))
        contact = self.plan.crossing.train.contact_names[int(np.argmax(force))]
        where = f"contact {contact}"
        if len(motion):
            where += f", d.o.f. {self.plan.fleet.dof_names[int(np.argmax(motion))]}"
        raise AnalysisError(
            f"the run diverged at step {step}, t = {time:.6g} s ({where}): a value is not finite or a contact force exceeds "
            f"{_DIVERGED:g} times the static one. Use alpha = -0.1, a smaller time step, or check masses and stiffnesses"
        )

    def _keep(self, steps: IntArray, positions: FloatArray) -> None:
        """Move the kept steps of the buffers into the histories."""
        n = len(steps)
        if not n:
            return
        values = self._structure_rows[:, :n, self._inverse]
        n_sensor = self._sensor_dofs.size
        at_sensors = values[:, :, :n_sensor].reshape(3, n, *self._sensor_dofs.shape)
        sensors = (at_sensors * self._sensor_weights).sum(axis=3) + self._moved_sensors(steps)
        reactions = self.reactions.of(steps, values[:, :, n_sensor:], positions, self._forces[:n])
        self.balance.look(steps, self._sums[:n], reactions, positions, self._forces[:n])
        kept = np.flatnonzero(steps % self.every == 0)
        into = steps[kept] // self.every
        h = self.histories
        h.contact_force[into], h.contact_position[into] = self._forces[kept], positions[kept]
        h.support_reaction[into] = reactions[kept]
        for i, name in enumerate(_QUANTITIES):
            h.vehicle[name][into] = self._vehicle_rows[i, kept]
            h.sensor[name][into] = sensors[i, kept]
        self.completed = int(steps[-1])

    def _moved_sensors(self, steps: IntArray) -> FloatArray:
        """What supports that move add at the sensors (3, n_step, n_sensor): E_P u_P and its rates."""
        plan = self.plan
        result = np.zeros((3, len(steps), len(self._sensor_dofs)))
        if len(plan.moving) and len(self._sensor_dofs):
            times = plan.times_of(steps)
            rows = plan.sensor_path_moving.rows(
                np.array(list(plan.settings.sensors.values())), len(plan.moving)
            )
            for i, name in enumerate(("value", "velocity", "acceleration")):
                motions = [
                    getattr(plan.crossing.structure.system.motions[j], name)(times) for j in plan.moving
                ]
                result[i] = (rows @ np.array(motions)).T
        return result

    # --- at the end ----------------------------------------------------------------------------

    def result(self, outcome: Outcome, facts: Mapping[str, Any]) -> Result:
        """The result up to the last good step."""
        plan, h = self.plan, self.histories
        self.tension.finish()
        n = self.completed // self.every + 1
        return Result(
            time=plan.times_of(np.arange(n) * self.every),
            sensor=tuple(plan.settings.sensors),
            contact=plan.crossing.train.contact_names,
            vehicle_dof=plan.fleet.dof_names,
            support=plan.crossing.structure.system.support_names,
            sensor_displacement=h.sensor["displacement"][:n],
            sensor_velocity=h.sensor["velocity"][:n],
            sensor_acceleration=h.sensor["acceleration"][:n],
            contact_force=h.contact_force[:n],
            contact_position=h.contact_position[:n],
            vehicle_displacement=h.vehicle["displacement"][:n],
            vehicle_velocity=h.vehicle["velocity"][:n],
            vehicle_acceleration=h.vehicle["acceleration"][:n],
            support_reaction=h.support_reaction[:n],
            outcome=outcome,
            checks=self._checks(),
            facts={**facts, **self.counts, "completed_steps": self.completed, "notes": tuple(self.notes)},
        )

    def _checks(self) -> dict[str, Any]:
        tension, static = self.tension, self.plan.fleet.weight
        return {
            "finite_values": self.finite,
            "compatibility_residual": self.compatibility.residual,
            "equilibrium_residual": self.balance.residual,
            "energy_residual": self.energy.residual,
            "tension_episodes": tension.count,
            "tension": [asdict(episode) for episode in tension.episodes],
            "largest_contact_force": dict(
                zip(self.plan.crossing.train.contact_names, tension.largest.tolist(), strict=True)
            ),
            "smallest_contact_force": dict(
                zip(self.plan.crossing.train.contact_names, tension.smallest.tolist(), strict=True)
            ),
            "static_contact_force": dict(
                zip(self.plan.crossing.train.contact_names, static.tolist(), strict=True)
            ),
        }
