"""Stresses of solids and resultants of shells at sensors, at every n-th step."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.interaction.plan import Plan
from axlespan.interaction.sensors import by_line
from axlespan.running.stress_points import StressPoints

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


class StressHistories:
    """Elastic stresses, from the displacements of the elements at the sensors."""

    def __init__(self, plan: Plan) -> None:
        self._plan, wanted = plan, plan.settings.stresses
        self.names: tuple[str, ...] = ()
        self.free_dofs: IntArray = np.empty(0, dtype=np.int64)
        n_kept = plan.settings.steps // plan.settings.every + 1
        self._table = np.zeros((n_kept, 0))
        if wanted:
            self._read_rows(wanted)
            self._table = np.zeros((n_kept, len(self.names)))

    def _read_rows(self, wanted: Sequence[str]) -> None:
        plan = self._plan
        system = plan.crossing.structure.system
        structure, settings = plan.crossing.structure, plan.settings
        groups = by_line(structure, wanted, settings.sensors, settings.sensor_lines)
        found = StressPoints((), sp.csr_array((0, system.size)))
        for line, (numbers, places) in groups.items():
            more = StressPoints.at(structure, [wanted[i] for i in numbers], places, line)
            found = StressPoints(
                (*found.names, *more.names), sp.csr_array(sp.vstack([found.rows, more.rows]))
            )
        self.names = found.names
        free = sp.csc_array(found.rows[:, system.free])
        self.free_dofs = np.unique(free.nonzero()[1]).astype(np.int64)
        self._rows = sp.csr_array(free[:, self.free_dofs])
        self._moved = sp.csr_array(found.rows[:, system.prescribed[plan.moving]])

    def look(self, steps: IntArray, near: FloatArray, positions: FloatArray, forces: FloatArray) -> None:
        """Look at consecutive steps: ``near`` (3, n_step, n_free) of ``free_dofs``."""
        if not self.names:
            return
        plan = self._plan
        kept = np.flatnonzero(steps % plan.settings.every == 0)
        values = (self._rows @ near[0, kept].T).T
        if len(plan.moving):
            times, motions = plan.times_of(steps[kept]), plan.crossing.structure.system.motions
            values = values + (self._moved @ np.array([motions[j].value(times) for j in plan.moving])).T
        self._table[steps[kept] // plan.settings.every] = values

    def histories(self, n: int) -> FloatArray:
        """The first n kept (n, n_stress)."""
        return np.asarray(self._table[:n])
