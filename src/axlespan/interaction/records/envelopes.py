"""Envelopes: extremes along the line over all steps, and when they came."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.elements.beam_sections import QUANTITIES
from axlespan.errors import InputError
from axlespan.interaction.plan import Plan
from axlespan.interaction.records.section_forces import SectionForces

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Values that are there at one time.
_VALUES = 4_000_000

# quantity -> unit and meaning
UNITS: Mapping[str, tuple[str, str]] = {
    "moment": ("N m", "bending moment of the beams, sagging positive"),
    "shear": ("N", "shear force of the beams, dM/ds"),
    "normal": ("N", "normal force of the beams, tension positive"),
    "torsion": ("N m", "torsional moment of the beams"),
    "deflection": ("m", "vertical displacement of the line, positive upward"),
    "acceleration": ("m/s^2", "vertical acceleration of the line"),
}
# quantity -> state and motion of the supports that it is read from
_MOTIONS = {"deflection": (0, "value"), "acceleration": (2, "acceleration")}


@dataclass(frozen=True, eq=False)
class Envelope:
    """Extremes of one quantity at each station; each array (n_station,)."""

    largest: FloatArray
    smallest: FloatArray
    time_of_largest: FloatArray  # [s]
    time_of_smallest: FloatArray  # [s]


@dataclass(frozen=True, eq=False)
class Envelopes:
    """Extremes of several quantities along the first line, over all steps."""

    position: FloatArray  # (n_station,) [m]
    tables: Mapping[str, Envelope]  # by quantity

    def of(self, quantity: str) -> Envelope:
        """The envelope of a quantity.

        Raises
        ------
        InputError
            If it was not asked for.
        """
        if quantity not in self.tables:
            known = ", ".join(self.tables) or "none"
            raise InputError(
                "is not among the envelopes", field="quantity", value=quantity, fix=f"Known: {known}"
            )
        return self.tables[quantity]


class EnvelopeMonitor:
    """Envelopes at the breaks of the first line: the nodes, where it runs on beams.

    Section forces are looked at on both sides of a station.
    """

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._position = plan.sensor_path.breaks
        n = len(self._position)
        self._forces: SectionForces | None = None
        dofs = [np.empty(0, dtype=np.int64)]
        wanted = plan.settings.envelopes
        if any(name in QUANTITIES for name in wanted):
            segments = np.repeat(np.arange(n - 1), 2)
            self._of_beams = [name for name in wanted if name in QUANTITIES]
            self._forces = SectionForces(plan, segments, np.tile([0.0, 1.0], n - 1), self._of_beams)
            dofs.append(self._forces.free_dofs)
        if any(name in _MOTIONS for name in wanted):
            dofs.append(plan.sensor_path.path_dofs)
        self.free_dofs = np.unique(np.concatenate(dofs))
        self._values = {name: np.array([np.full(n, -np.inf), np.full(n, np.inf)]) for name in wanted}
        self._times = {name: np.zeros((2, n)) for name in wanted}

    @property
    def forces(self) -> list[SectionForces]:
        """What section forces are read from."""
        return [] if self._forces is None else [self._forces]

    def look(self, steps: IntArray, near: FloatArray, positions: FloatArray, forces: FloatArray) -> None:
        """Look at consecutive steps: ``near`` (3, n_step, n_free) of ``free_dofs``, wheels (n_step, n_contact)."""
        at_once = max(1, _VALUES // (4 * len(self._position)))
        for begin in range(0, len(steps), at_once):
            some = slice(begin, begin + at_once)
            self._look(steps[some], near[:, some], positions[some], forces[some])

    def _look(self, steps: IntArray, near: FloatArray, positions: FloatArray, forces: FloatArray) -> None:
        times = self._plan.times_of(steps)
        if self._forces is not None:
            own = np.searchsorted(self.free_dofs, self._forces.free_dofs)
            sides = self._forces.of(steps, near[:, :, own], positions, forces)
            for i, name in enumerate(self._of_beams):
                self._take(name, times, sides[:, ::2, i], slice(None, -1))
                self._take(name, times, sides[:, 1::2, i], slice(1, None))
        for name in self._plan.settings.envelopes:
            if name in _MOTIONS:
                self._take(name, times, self._motion(name, times, near), slice(None))

    def _motion(self, name: str, times: FloatArray, near: FloatArray) -> FloatArray:
        """Motion of the line (n_step, n_station)."""
        plan, (which, history) = self._plan, _MOTIONS[name]
        dofs, weights = plan.sensor_path.weights(self._position)
        at = np.minimum(np.searchsorted(self.free_dofs, dofs), max(len(self.free_dofs) - 1, 0))
        values = (near[which][:, at] * weights).sum(axis=2)
        if len(plan.moving):
            motions = plan.crossing.structure.system.motions
            moved = np.array([getattr(motions[j], history)(times) for j in plan.moving])
            values += (plan.sensor_path_moving.rows(self._position, len(plan.moving)) @ moved).T
        return np.asarray(values)

    def _take(self, name: str, times: FloatArray, values: FloatArray, where: slice) -> None:
        """Take values (n_step, n) at some of the stations."""
        station = np.arange(values.shape[1])
        for side, (best, better) in enumerate(((np.argmax, np.greater), (np.argmin, np.less))):
            row = best(values, axis=0)
            found = values[row, station]
            known, when = self._values[name][side, where], self._times[name][side, where]
            change = better(found, known)
            known[change], when[change] = found[change], times[row[change]]

    def envelopes(self) -> Envelopes | None:
        """The envelopes of the steps seen; None if none were asked for."""
        if not self._values:
            return None
        tables = {name: Envelope(*self._values[name], *self._times[name]) for name in self._values}
        return Envelopes(self._position, tables)
