"""Section forces of beams over consecutive steps, from the d.o.f. next to the sections and the wheels on them.

As for the support reactions (N12 (13)), the inertia forces that go with the forces of the new time are
(1+α) J^c = I ü^c + α J^p; then shear at a support and its reaction agree to rounding for every α.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.elements.beam_sections import QUANTITIES
from axlespan.interaction.plan import Plan
from axlespan.interaction.records.inertia import filtered, special_steps
from axlespan.interaction.records.substeps import Substep
from axlespan.interaction.sensors import by_line
from axlespan.running.path import PolynomialPath
from axlespan.running.sections import BeamSections

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# A wheel so close before a section (a share of the line's length) counts as before it, so that sections take
# the shear on the right of an axle that stands right over them, whatever the rounding of its position.
_OVER = 1e-12


class SectionForces:
    """Moment, shear, normal force and torsion, or some of them, at sections of a line, that for sensors by default."""

    def __init__(
        self,
        plan: Plan,
        segments: IntArray,
        xi: FloatArray,
        quantities: Sequence[str] = QUANTITIES,
        line: str | None = None,
    ) -> None:
        self._plan = plan
        name = line or plan.crossing.structure.sensor_line
        sections = BeamSections.at(plan.crossing.structure, segments, xi, name)
        system = plan.crossing.structure.system
        chosen = np.array([QUANTITIES.index(name) for name in quantities], dtype=np.int64)
        keep = (np.arange(sections.n_section)[:, None] * len(QUANTITIES) + chosen).ravel()
        rows = [sp.csr_array(matrix[keep]) for matrix in sections.rows()]
        free = [sp.csc_array(matrix[:, system.free]) for matrix in rows]
        self.free_dofs = np.unique(np.concatenate([matrix.nonzero()[1] for matrix in free])).astype(np.int64)
        self._rows = [sp.csr_array(matrix[:, self.free_dofs]) for matrix in free]
        self._moved = [sp.csr_array(matrix[:, system.prescribed[plan.moving]]) for matrix in rows]
        number = np.full(sections.n_row, -1, dtype=np.int64)
        number[keep] = np.arange(len(keep))
        self._influences = self._wheels(sections, number)
        self._shape = (sections.n_section, len(chosen))
        self._inertia = np.zeros(len(keep))
        # As for the reactions: steps set anew, accelerations (n,) set anew after a step, steps that were cut.
        self.restarted: Collection[int] = ()
        self.released: Mapping[int, tuple[FloatArray, float]] = {}
        self.between: Mapping[int, Sequence[Substep]] = {}

    def _wheels(self, sections: BeamSections, number: IntArray) -> list[tuple[IntArray, PolynomialPath]]:
        """Wheels (n_wheel,) of each line, and their share in the section forces by their position."""
        lines = self._plan.crossing.contact_lines
        result = []
        for line in dict.fromkeys(lines):
            path = sections.influence(line)
            if path is not None:
                path = path.renumbered(number)
                wheels = np.array([i for i, name in enumerate(lines) if name == line], dtype=np.int64)
                result.append((wheels, self._plan.settings.under_wheels(path)))
        return result

    def of(self, steps: IntArray, near: FloatArray, positions: FloatArray, forces: FloatArray) -> FloatArray:
        """Section forces (n_step, n_section, n_quantity) at consecutive time indices.

        Parameters
        ----------
        steps : array (n_step,)
            Time indices; must follow those of the call before.
        near : array (3, n_step, n_free)
            Displacement, velocity and acceleration of ``free_dofs``.
        positions, forces : array (n_step, n_contact)
            Of the wheels.
        """
        total = np.zeros((self._shape[0] * self._shape[1], len(steps)))
        for which, name in enumerate(("value", "velocity", "acceleration")):
            part = self._linear(which, name, steps, near[which])
            if part is not None:
                total += self._filtered(steps, part) if name == "acceleration" else part
        self._add_wheels(total, positions, forces)
        return total.reshape(*self._shape, len(steps)).transpose(2, 0, 1)

    def _linear(self, which: int, name: str, steps: IntArray, near: FloatArray) -> FloatArray | None:
        """What the d.o.f. and the supports that move give (n_row, n_step); None if nothing."""
        rows, moved = self._rows[which], self._moved[which]
        if not rows.nnz and not moved.nnz:
            return None
        part = np.asarray(rows @ near.T)
        if moved.nnz:
            times, motions = self._plan.times_of(steps), self._plan.crossing.structure.system.motions
            part += moved @ np.array([getattr(motions[j], name)(times) for j in self._plan.moving])
        return part

    def _filtered(self, steps: IntArray, inertia: FloatArray) -> FloatArray:
        alpha = self._plan.settings.method.alpha
        if alpha == 0.0:
            return inertia

        def anew(i: int) -> bool:
            step = int(steps[i])
            if step - 1 in self.released:
                before = float(self._plan.times_of(np.array([step - 1]))[0])
                self._inertia[:] = self._at(before, self.released[step - 1][0][self.free_dofs])
            for part in self.between.get(step, ()):
                own = self._at(part.time, part.at(self.free_dofs))
                fresh = part.excess is not None
                self._inertia[:] = own if fresh else (own + alpha * self._inertia) / (1.0 + alpha)
            return step == 0 or step in self.restarted

        special = special_steps(steps, self.restarted, self.released, self.between)
        filtered(inertia.T, alpha, self._inertia, special, anew)
        return inertia

    def _at(self, time: float, accelerations: FloatArray) -> FloatArray:
        """Inertia forces (n_row,) at a time, of accelerations (n_free,) that no tape holds."""
        part = np.asarray(self._rows[2] @ accelerations)
        if self._moved[2].nnz:
            times, motions = np.array([time]), self._plan.crossing.structure.system.motions
            part += self._moved[2] @ np.array([motions[j].acceleration(times)[0] for j in self._plan.moving])
        return part

    def _add_wheels(self, total: FloatArray, positions: FloatArray, forces: FloatArray) -> None:
        """Add G X (n_row, n_step) of the wheels in the elements of the sections."""
        for wheels, path in self._influences:
            before = -_OVER * (path.stop - path.start)
            total += path.loads(positions, forces, wheels, len(total), before, one_way=True).T


class SectionHistories:
    """Section forces at sensors, at every n-th step."""

    def __init__(self, plan: Plan) -> None:
        self.names, self._every = plan.settings.section_forces, plan.settings.every
        self._groups: list[tuple[IntArray, SectionForces]] = []
        structure, settings = plan.crossing.structure, plan.settings
        for line, (numbers, places) in by_line(
            structure, self.names, settings.sensors, settings.sensor_lines
        ).items():
            segments, xi = structure.line(line).locate(places)
            self._groups.append((numbers, SectionForces(plan, segments, xi, line=line)))
        self.forces = [forces for _, forces in self._groups]
        none: IntArray = np.empty(0, dtype=np.int64)
        self.free_dofs = np.unique(np.concatenate([none, *(group.free_dofs for _, group in self._groups)]))
        n_kept = plan.settings.steps // self._every + 1
        self._table = np.zeros((n_kept, len(self.names), len(QUANTITIES)))

    def look(self, steps: IntArray, near: FloatArray, positions: FloatArray, forces: FloatArray) -> None:
        """Look at consecutive steps; see :meth:`SectionForces.of`."""
        kept = np.flatnonzero(steps % self._every == 0)
        for numbers, group in self._groups:
            own = np.searchsorted(self.free_dofs, group.free_dofs)
            values = group.of(steps, near[:, :, own], positions, forces)[kept]
            self._table[(steps[kept] // self._every)[:, None], numbers] = values

    def histories(self, n: int) -> dict[str, FloatArray]:
        """The first n kept (n, n_section), by their names in a result."""
        return {f"section_{name}": self._table[:n, :, i] for i, name in enumerate(QUANTITIES)}
