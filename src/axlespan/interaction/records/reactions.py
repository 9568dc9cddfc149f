"""Support reactions, N12 (13)."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.interaction.plan import Plan
from axlespan.interaction.records.inertia import filtered, special_steps
from axlespan.interaction.records.substeps import Substep
from axlespan.interaction.records.sums import Sums
from axlespan.running.path import PolynomialPath

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


class Reactions:
    """R_P after each step, from sums over the free d.o.f. next to the supports.

    N12 (13) with the inertia forces gathered: (1+α) I^c = M_PF ü_F^c + M_PP ü_P^c + α I^p, and
    R_P^c = I^c + [C_PF u̇_F + C_PP u̇_P + K_PF u_F + K_PP u_P - P_P + D_PX X]^c.
    ``like`` are those of another crossing with the same structure and footprint, whose tables serve here too.
    """

    sums: Sums  # of displacements and velocities (n_P), then of accelerations (n_P)
    free_dofs: IntArray  # that the inertia forces need
    _M: sp.csr_array  # (n_free, n_P)
    _loads: Sequence[tuple[FloatArray, Callable[[FloatArray], FloatArray]]]

    def __init__(self, plan: Plan, like: Reactions | None = None) -> None:
        self.plan = plan
        self._lines: dict[str, PolynomialPath] = {} if like is None else like._lines
        if like is None:
            self._read_tables()
        else:
            self.sums, self.free_dofs, self._M, self._loads = like.sums, like.free_dofs, like._M, like._loads
        self.paths = self._prescribed_paths()
        self._inertia = np.zeros(len(plan.crossing.structure.system.prescribed))
        self.restarted: Collection[int] = ()  # steps whose accelerations are those of their own time
        self.released: Mapping[
            int, tuple[FloatArray, float]
        ] = {}  # accelerations (n,) set anew after such a step
        self.between: Mapping[int, Sequence[Substep]] = {}  # steps that were cut
        # What nonlinear springs add in so many steps (n_step, n_P), in turn.
        self.inner: Callable[[int], FloatArray | None] | None = None

    def _read_tables(self) -> None:
        system = self.plan.crossing.structure.system
        blocks = system.partition
        none = sp.csr_array(blocks.K_FP.T.shape)
        from_rest = Sums.of_blocks(sp.csr_array(blocks.K_FP.T), sp.csr_array(blocks.C_FP.T), none)
        self.sums = Sums.together([from_rest, Sums.of_blocks(none, none, sp.csr_array(blocks.M_FP.T))])
        self.free_dofs = np.unique(sp.coo_array(blocks.M_FP).row.astype(np.int64))
        self._M = sp.csr_array(sp.csr_array(blocks.M_FP)[self.free_dofs])
        loads = [(load.vector[system.prescribed], load.factor) for load in system.loads]
        self._loads = [(vector, factor) for vector, factor in loads if np.any(vector)]

    def _prescribed_paths(self) -> list[tuple[IntArray, PolynomialPath]]:
        """The lines in the prescribed d.o.f., for wheels that stand right over a support."""
        lines = self.plan.crossing.contact_lines
        result = []
        for line in dict.fromkeys(lines):
            if line not in self._lines:
                self._lines[line] = self._prescribed_path(line)
            wheels = np.array([i for i, name in enumerate(lines) if name == line], dtype=np.int64)
            result.append((wheels, self._lines[line]))
        return result

    def _prescribed_path(self, line: str) -> PolynomialPath:
        structure = self.plan.crossing.structure
        system = structure.system
        number = np.full(system.size, -1, dtype=np.int64)
        number[system.prescribed] = np.arange(len(system.prescribed))
        return self.plan.settings.under_wheels(structure.line(line)).renumbered(number)

    def of(self, steps: IntArray, sums: FloatArray, positions: FloatArray, forces: FloatArray) -> FloatArray:
        """Reactions (n_step, n_P) at consecutive time indices.

        Parameters
        ----------
        steps : array (n_step,)
            Time indices; must follow those of the call before.
        sums : array (n_step, 2 n_P)
            Those of :attr:`sums`.
        positions, forces : array (n_step, n_contact)
            Of the wheels.
        """
        system, plan = self.plan.crossing.structure.system, self.plan
        blocks = system.partition
        times = plan.times_of(steps)
        reaction, inertia = sums[:, : len(self._inertia)].copy(), sums[:, len(self._inertia) :].copy()
        if len(plan.moving):
            pairs = (("value", blocks.K_PP), ("velocity", blocks.C_PP), ("acceleration", blocks.M_PP))
            for part, (name, matrix) in zip((reaction, reaction, inertia), pairs, strict=True):
                table = np.zeros((len(steps), len(system.prescribed)))
                for j in plan.moving:
                    table[:, j] = getattr(system.motions[j], name)(times)
                part += table @ matrix.T
        reaction += self._filtered(steps, inertia)
        for vector, factor in self._loads:
            reaction -= factor(times)[:, None] * vector
        reaction += self._carried(positions, forces)
        inner = self.inner(len(steps)) if self.inner is not None else None
        if inner is not None:
            reaction += inner
        return np.asarray(reaction)

    def _filtered(self, steps: IntArray, momentum: FloatArray) -> FloatArray:
        alpha = self.plan.settings.method.alpha
        if alpha == 0.0:
            return momentum
        special = special_steps(steps, self.restarted, self.released, self.between)

        def anew(i: int) -> bool:
            step = int(steps[i])
            if step - 1 in self.released:
                before = float(self.plan.times_of(np.array([step - 1]))[0])
                self._inertia[:] = self._momentum(before, self.released[step - 1][0][self.free_dofs])
            for part in self.between.get(step, ()):
                own = self._momentum(part.time, part.at(self.free_dofs))
                fresh = part.excess is not None
                self._inertia[:] = own if fresh else (own + alpha * self._inertia) / (1.0 + alpha)
            return step == 0 or step in self.restarted

        filtered(momentum, alpha, self._inertia, special, anew)
        return momentum

    def _momentum(self, time: float, near: FloatArray) -> FloatArray:
        """Inertia forces (n_P,) at a time, of accelerations (n_free,) that no tape holds."""
        system, times = self.plan.crossing.structure.system, np.array([time])
        moved = np.zeros(len(system.prescribed))
        for j in self.plan.moving:
            moved[j] = system.motions[j].acceleration(times)[0]
        return np.asarray(near @ self._M + system.partition.M_PP @ moved)

    def _carried(self, positions: FloatArray, forces: FloatArray) -> FloatArray:
        """D_PX X: wheel loads that go straight into the supports."""
        total = np.zeros((len(positions), self._inertia.size))
        for wheels, path in self.paths:
            total += path.loads(positions, forces, wheels, self._inertia.size, one_way=True)
        return total
