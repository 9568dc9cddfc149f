"""Fields: displacements and velocities of all d.o.f. of the structure at chosen times."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.integrator import State
from axlespan.errors import InputError
from axlespan.interaction.plan import Plan

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Fields:
    """The structure as a whole at chosen times, and where the wheels are then.

    D.o.f. are all those of the model: tied ones follow their masters, supports their motions.
    """

    times: FloatArray  # (n,) [s]
    dof_names: tuple[str, ...]  # (n_full,) node.component
    displacement: FloatArray  # (n, n_full) [m or rad]
    velocity: FloatArray  # (n, n_full) [m/s or rad/s]
    contact_position: FloatArray  # (n, n_contact) along the line [m]
    contact_displacement: FloatArray  # (n, n_contact) of the contact points, vertical [m]
    contact_force: FloatArray  # (n, n_contact) on the vehicle, compression positive [N]

    def at(self, dof: str) -> FloatArray:
        """Displacements (n,) of one named d.o.f.

        Raises
        ------
        InputError
            If there is none of that name.
        """
        if dof not in self.dof_names:
            raise InputError("is not a d.o.f. of the structure", field="dof", value=dof)
        return np.asarray(self.displacement[:, self.dof_names.index(dof)])


class FieldWatcher:
    """Keeps the fields of one crossing."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        system, n_contact = plan.crossing.structure.system, plan.rows.n_contact
        self._row = {step: row for row, step in enumerate(plan.settings.fields)}
        n = len(self._row)
        self._motion = np.zeros((2, n, len(system.dof_names)))
        self._contacts = np.zeros((3, n, n_contact))  # positions, displacements, forces

    @property
    def steps(self) -> Collection[int]:
        """Time indices of the fields."""
        return self._row

    def look(
        self, step: int, structure: State, vehicles: State, load: FloatArray, forces: FloatArray
    ) -> None:
        """Keep the field of a completed step."""
        plan, row = self._plan, self._row[step]
        system, time = plan.crossing.structure.system, plan.times_of(np.array([step]))
        independent = np.zeros((2, system.size))
        independent[:, system.free] = structure.values[:2]
        for j in plan.moving:
            motion = system.motions[j]
            independent[:, system.prescribed[j]] = [motion.value(time)[0], motion.velocity(time)[0]]
        for which in range(2):
            self._motion[which, row] = system.elimination @ independent[which]
        self._contacts[:, row] = self._wheels(time, structure, vehicles, forces, independent[0])

    def _wheels(
        self, time: FloatArray, structure: State, vehicles: State, forces: FloatArray, u: FloatArray
    ) -> FloatArray:
        """Positions, displacements and forces (3, n_contact) of the contact points."""
        plan, fleet = self._plan, self._plan.fleet
        positions = plan.rows.positions(time)
        displacement, force = np.zeros(plan.rows.n_contact), fleet.weight.copy()
        force[fleet.coupled] = forces
        displacement[fleet.coupled] = vehicles.u[fleet.dofs]
        forced = fleet.forced
        if len(forced):  # moving forces go with the line
            block = plan.rows.rows(positions[:, forced], forced)
            displacement[forced] = (block.weights[0] * structure.u[block.dofs[0]]).sum(axis=1)
            moved = u[plan.crossing.structure.system.prescribed[plan.moving]]
            if len(moved):
                own = moved[block.prescribed_dofs[0]] * block.prescribed_weights[0]
                displacement[forced] += own.sum(axis=1)
        return np.array([positions[0], displacement, force])

    def fields(self, completed: int) -> Fields | None:
        """The fields up to a completed step; None if there were none asked for."""
        if not self._row:
            return None
        steps = np.array([step for step in self._row if step <= completed], dtype=np.int64)
        n = len(steps)
        return Fields(
            self._plan.times_of(steps),
            self._plan.crossing.structure.system.dof_names,
            self._motion[0, :n],
            self._motion[1, :n],
            *self._contacts[:, :n],
        )
