"""Support reactions, N12 (13)."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.interaction.plan import Plan
from axlespan.running.path import PolynomialPath

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Up to this many entries a dense product is quicker than a sparse one.
_DENSE_UP_TO = 10_000


class Reactions:
    """R_P after each step, from the free d.o.f. next to the supports.

    N12 (13) with the inertia forces gathered: (1+α) I^c = M_PF ü_F^c + M_PP ü_P^c + α I^p, and
    R_P^c = I^c + [C_PF u̇_F + C_PP u̇_P + K_PF u_F + K_PP u_P - P_P + D_PX X]^c.
    ``like`` are those of another crossing with the same structure and footprint, whose tables serve here too.
    """

    free_dofs: IntArray
    _K: FloatArray | sp.csr_array
    _M: FloatArray | sp.csr_array
    _C: FloatArray | sp.csr_array
    _loads: Sequence[tuple[FloatArray, Callable[[FloatArray], FloatArray]]]

    def __init__(self, plan: Plan, like: Reactions | None = None) -> None:
        self.plan = plan
        self._lines: dict[str, PolynomialPath] = {} if like is None else like._lines
        if like is None:
            self._read_tables()
        else:
            self.free_dofs, self._K, self._M, self._C = like.free_dofs, like._K, like._M, like._C
            self._loads = like._loads
        self.paths = self._prescribed_paths()
        self._inertia = np.zeros(len(plan.crossing.structure.system.prescribed))
        self.restarted: Collection[int] = ()  # steps whose accelerations are those of their own time
        self.released: Mapping[
            int, tuple[FloatArray, float]
        ] = {}  # accelerations (n,) set anew after such a step
        # What nonlinear springs add in so many steps (n_step, n_P), in turn.
        self.inner: Callable[[int], FloatArray | None] | None = None

    def _read_tables(self) -> None:
        system = self.plan.crossing.structure.system
        blocks = system.partition
        together = abs(blocks.K_FP) + abs(blocks.M_FP) + abs(blocks.C_FP)
        self.free_dofs = np.unique(together.tocoo().row.astype(np.int64))
        self._K, self._M, self._C = (
            _operand(sp.csr_array(m)[self.free_dofs]) for m in (blocks.K_FP, blocks.M_FP, blocks.C_FP)
        )
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

    def of(self, steps: IntArray, near: FloatArray, positions: FloatArray, forces: FloatArray) -> FloatArray:
        """Reactions (n_step, n_P) at consecutive time indices.

        Parameters
        ----------
        steps : array (n_step,)
            Time indices; must follow those of the call before.
        near : array (3, n_step, n_free)
            Displacement, velocity and acceleration of ``free_dofs``.
        positions, forces : array (n_step, n_contact)
            Of the wheels.
        """
        system, plan = self.plan.crossing.structure.system, self.plan
        blocks = system.partition
        times = plan.times_of(steps)
        u, v, a = near
        own = [u @ self._K, v @ self._C, a @ self._M]
        if len(plan.moving):
            pairs = (("value", blocks.K_PP), ("velocity", blocks.C_PP), ("acceleration", blocks.M_PP))
            for part, (name, matrix) in zip(own, pairs, strict=True):
                table = np.zeros((len(steps), len(system.prescribed)))
                for j in plan.moving:
                    table[:, j] = getattr(system.motions[j], name)(times)
                part += table @ matrix.T
        reaction = self._filtered(steps, own[2])
        reaction += own[0]
        reaction += own[1]
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
            return momentum.copy()
        result = np.empty_like(momentum)
        for i, step in enumerate(steps):
            fresh = step == 0 or int(step) in self.restarted
            if int(step) - 1 in self.released:
                self._inertia = self._momentum(int(step) - 1)
            self._inertia = momentum[i] if fresh else (momentum[i] + alpha * self._inertia) / (1.0 + alpha)
            result[i] = self._inertia
        return result

    def _momentum(self, step: int) -> FloatArray:
        """Inertia forces (n_P,) of accelerations that were set anew."""
        system = self.plan.crossing.structure.system
        time = self.plan.times_of(np.array([step]))
        moved = np.zeros(len(system.prescribed))
        for j in self.plan.moving:
            moved[j] = system.motions[j].acceleration(time)[0]
        return np.asarray(self.released[step][0][self.free_dofs] @ self._M + system.partition.M_PP @ moved)

    def _carried(self, positions: FloatArray, forces: FloatArray) -> FloatArray:
        """D_PX X: wheel loads that go straight into the supports."""
        n_support = self._inertia.size
        total = np.zeros((len(positions), n_support))
        for wheels, path in self.paths:
            row, column = on_segments(path, positions[:, wheels])
            if not len(row):
                continue
            wheel = wheels[column]
            dofs, weights = path.weights(positions[row, wheel])
            place = row[:, None] * n_support + dofs
            loads = weights * forces[row, wheel][:, None]
            total += np.bincount(place.ravel(), loads.ravel(), total.size).reshape(total.shape)
        return total


def on_segments(path: PolynomialPath, positions: FloatArray) -> tuple[IntArray, IntArray]:
    """Rows and columns of the positions (n_step, n_wheel) at which a path has any weights."""
    row, column = np.nonzero(path.carries(positions))
    weighty = np.any(path.coefficients != 0.0, axis=(1, 2))
    if len(row) and not weighty.all():
        keep = weighty[path.locate(positions[row, column])[0]]
        return row[keep], column[keep]
    return row, column


def _operand(matrix: sp.csr_array) -> FloatArray | sp.csr_array:
    return matrix.toarray() if matrix.shape[0] * matrix.shape[1] <= _DENSE_UP_TO else matrix
