"""Section forces of beams over consecutive steps, from the d.o.f. next to the sections and the wheels on them.

As for the support reactions (N12 (13)), the inertia forces that go with the forces of the new time are
(1+α) J^c = I ü^c + α J^p; then shear at a support and its reaction agree to rounding for every α.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.elements.beam_sections import QUANTITIES
from axlespan.interaction.plan import Plan
from axlespan.running.path import PolynomialPath
from axlespan.running.sections import BeamSections

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# A wheel so close before a section (a share of the line's length) counts as before it, so that sections take
# the shear on the right of an axle that stands right over them, whatever the rounding of its position.
_OVER = 1e-12


class SectionForces:
    """Moment, shear, normal force and torsion at sections of the first line."""

    def __init__(self, plan: Plan, segments: IntArray, xi: FloatArray) -> None:
        self._plan = plan
        sections = BeamSections.at(plan.crossing.structure, segments, xi)
        system = plan.crossing.structure.system
        rows = sections.rows()
        free = [sp.csc_array(matrix[:, system.free]) for matrix in rows]
        self.free_dofs = np.unique(np.concatenate([matrix.nonzero()[1] for matrix in free])).astype(np.int64)
        self._rows = [sp.csr_array(matrix[:, self.free_dofs]) for matrix in free]
        self._moved = [sp.csr_array(matrix[:, system.prescribed[plan.moving]]) for matrix in rows]
        self._influences = self._wheels(sections)
        self._shape = (sections.n_section, len(QUANTITIES))
        self._inertia = np.zeros(sections.n_row)

    def _wheels(self, sections: BeamSections) -> list[tuple[IntArray, PolynomialPath]]:
        """Wheels (n_wheel,) of each line, and their share in the section forces by their position."""
        lines = [point.line for _, _, point, _ in self._plan.crossing.train.contacts]
        result = []
        for line in dict.fromkeys(lines):
            path = sections.influence(line)
            if path is not None:
                wheels = np.array([i for i, name in enumerate(lines) if name == line], dtype=np.int64)
                footprint = self._plan.settings.footprint
                result.append((wheels, path.spread(footprint) if footprint > 0.0 else path))
        return result

    def of(self, steps: IntArray, near: FloatArray, positions: FloatArray, forces: FloatArray) -> FloatArray:
        """Section forces (n_step, n_section, 4) at consecutive time indices.

        Parameters
        ----------
        steps : array (n_step,)
            Time indices; must follow those of the call before.
        near : array (3, n_step, n_free)
            Displacement, velocity and acceleration of ``free_dofs``.
        positions, forces : array (n_step, n_contact)
            Of the wheels.
        """
        static, viscous, inertial = (
            (rows @ values.T).T + self._of_supports(matrix, name, steps)
            for rows, values, matrix, name in zip(
                self._rows, near, self._moved, ("value", "velocity", "acceleration"), strict=True
            )
        )
        total = static + viscous + self._filtered(steps, inertial)
        total += self._of_wheels(positions, forces)
        return np.asarray(total).reshape(len(steps), *self._shape)

    def _of_supports(self, matrix: sp.csr_array, name: str, steps: IntArray) -> FloatArray | float:
        """What supports that move add (n_step, n_row)."""
        plan = self._plan
        if not matrix.nnz:
            return 0.0
        times, motions = plan.times_of(steps), plan.crossing.structure.system.motions
        return np.asarray((matrix @ np.array([getattr(motions[j], name)(times) for j in plan.moving])).T)

    def _filtered(self, steps: IntArray, inertia: FloatArray) -> FloatArray:
        alpha = self._plan.settings.method.alpha
        if alpha == 0.0:
            return inertia
        result = np.empty_like(inertia)
        for i, step in enumerate(steps):
            self._inertia = inertia[i] if step == 0 else (inertia[i] + alpha * self._inertia) / (1.0 + alpha)
            result[i] = self._inertia
        return result

    def _of_wheels(self, positions: FloatArray, forces: FloatArray) -> FloatArray:
        """G X (n_step, n_row) of the wheels in the elements of the sections."""
        n_step, n_row = len(positions), self._shape[0] * self._shape[1]
        total = np.zeros(n_step * n_row)
        for wheels, path in self._influences:
            at = positions[:, wheels] - _OVER * (path.stop - path.start)
            step, wheel = np.nonzero(path.carries(at))
            rows, weights = path.weights(at[step, wheel])
            shares = weights * forces[step, wheels[wheel], None]
            total += np.bincount((step[:, None] * n_row + rows).ravel(), shares.ravel(), len(total))
        return total.reshape(n_step, n_row)


class SectionHistories:
    """Section forces at sensors, at every n-th step."""

    def __init__(self, plan: Plan) -> None:
        self.names, self._every = plan.settings.section_forces, plan.settings.every
        self._forces: SectionForces | None = None
        self.free_dofs: IntArray = np.empty(0, dtype=np.int64)
        if self.names:
            places = np.array([plan.settings.sensors[name] for name in self.names], float)
            segments, xi = plan.crossing.structure.line().locate(places)
            self._forces = SectionForces(plan, segments, xi)
            self.free_dofs = self._forces.free_dofs
        n_kept = plan.settings.steps // self._every + 1
        self._table = np.zeros((n_kept, len(self.names), len(QUANTITIES)))

    def look(self, steps: IntArray, near: FloatArray, positions: FloatArray, forces: FloatArray) -> None:
        """Look at consecutive steps; see :meth:`SectionForces.of`."""
        if self._forces is not None:
            kept = np.flatnonzero(steps % self._every == 0)
            self._table[steps[kept] // self._every] = self._forces.of(steps, near, positions, forces)[kept]

    def histories(self, n: int) -> dict[str, FloatArray]:
        """The first n kept (n, n_section), by their names in a result."""
        return {f"section_{name}": self._table[:n, :, i] for i, name in enumerate(QUANTITIES)}
