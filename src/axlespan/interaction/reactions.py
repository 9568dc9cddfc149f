"""Support reactions, N12 (13)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.interaction.plan import Plan
from axlespan.running.path import PolynomialPath

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


class Reactions:
    """R_P after each step, from the free d.o.f. next to the supports.

    N12 (13) with the inertia forces gathered: (1+α) I^c = M_PF ü_F^c + M_PP ü_P^c + α I^p, and
    R_P^c = I^c + [C_PF u̇_F + C_PP u̇_P + K_PF u_F + K_PP u_P - P_P + D_PX X]^c.
    """

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        system = plan.crossing.structure.system
        blocks = system.partition
        together = abs(blocks.K_FP) + abs(blocks.M_FP) + abs(blocks.C_FP)
        self.free_dofs = np.unique(together.tocoo().row.astype(np.int64))
        self._K, self._M, self._C = (
            np.asarray(m[self.free_dofs].toarray()) for m in (blocks.K_FP, blocks.M_FP, blocks.C_FP)
        )
        self._loads = [(load.vector[system.prescribed], load.factor) for load in system.loads]
        self._loads = [(vector, factor) for vector, factor in self._loads if np.any(vector)]
        self.paths = self._prescribed_paths()
        self._inertia = np.zeros(len(system.prescribed))

    def _prescribed_paths(self) -> list[tuple[IntArray, PolynomialPath]]:
        """The lines in the prescribed d.o.f., for wheels that stand right over a support."""
        system, crossing = self.plan.crossing.structure.system, self.plan.crossing
        number = np.full(system.size, -1, dtype=np.int64)
        number[system.prescribed] = np.arange(len(system.prescribed))
        result = []
        lines = [point.line for _, _, point, _ in crossing.train.contacts]
        for line in dict.fromkeys(lines):
            path = crossing.structure.line(line)
            if self.plan.settings.footprint > 0.0:
                path = path.spread(self.plan.settings.footprint)
            wheels = np.array([i for i, name in enumerate(lines) if name == line], dtype=np.int64)
            result.append((wheels, path.renumbered(number)))
        return result

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
        motion = {
            name: np.zeros((len(steps), len(system.prescribed)))
            for name in ("value", "velocity", "acceleration")
        }
        for name, table in motion.items():
            for j in plan.moving:
                table[:, j] = getattr(system.motions[j], name)(times)
        momentum = a @ self._M + motion["acceleration"] @ blocks.M_PP.T
        reaction = self._filtered(steps, momentum)
        reaction += u @ self._K + motion["value"] @ blocks.K_PP.T
        reaction += v @ self._C + motion["velocity"] @ blocks.C_PP.T
        for vector, factor in self._loads:
            reaction -= factor(times)[:, None] * vector
        reaction += self._carried(positions, forces)
        return np.asarray(reaction)

    def _filtered(self, steps: IntArray, momentum: FloatArray) -> FloatArray:
        alpha = self.plan.settings.method.alpha
        if alpha == 0.0:
            return momentum.copy()
        result = np.empty_like(momentum)
        for i, step in enumerate(steps):
            self._inertia = (
                momentum[i] if step == 0 else (momentum[i] + alpha * self._inertia) / (1.0 + alpha)
            )
            result[i] = self._inertia
        return result

    def _carried(self, positions: FloatArray, forces: FloatArray) -> FloatArray:
        """D_PX X: wheel loads that go straight into the supports."""
        total = np.zeros((len(positions), self._inertia.size))
        for wheels, path in self.paths:
            near = wheels[path.carries(positions[:, wheels]).any(axis=0)]
            if not len(near) or not len(path.path_dofs):
                continue
            dofs, weights = path.weights(positions[:, near])
            for support in path.path_dofs.tolist():
                total[:, support] += ((dofs == support) * weights * forces[:, near, None]).sum(axis=(1, 2))
        return total
