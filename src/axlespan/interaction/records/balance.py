"""Vertical equilibrium of the whole structure, at every step."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from axlespan.interaction.plan import Plan
from axlespan.interaction.records.inertia import filtered, special_steps
from axlespan.interaction.records.substeps import Substep
from axlespan.interaction.records.sums import Sums
from axlespan.running.path import PolynomialPath

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


class BalanceMonitor:
    """Vertical equilibrium of the whole structure at each step: reactions, loads, wheels and inertia.

    ``like`` is that of another crossing of the structure, whose tables serve here too.
    """

    mass: FloatArray  # (n,) M t of the structure that moves up by one [kg]
    sums: Sums
    _t_prescribed: FloatArray
    _t_free: FloatArray
    _rows: list[tuple[FloatArray, str]]
    _loads: list[tuple[float, Callable[[FloatArray], FloatArray]]]

    def __init__(
        self,
        plan: Plan,
        prescribed_paths: list[tuple[IntArray, PolynomialPath]],
        like: BalanceMonitor | None = None,
    ) -> None:
        self._plan = plan
        if like is None:
            self._read_tables(plan)
        else:
            self._t_prescribed, self._t_free, self._rows = like._t_prescribed, like._t_free, like._rows
            self.mass, self.sums, self._loads = like.mass, like.sums, like._loads
        # Each wheel's line when the whole structure moves up by one.
        free = [(path.wheels, path.free) for path in plan.rows.paths]
        self._lifted = [
            (wheels, path.moved_by(unit))
            for paths, unit in ((free, self._t_free), (prescribed_paths, self._t_prescribed))
            for wheels, path in paths
            if len(path.path_dofs)
        ]
        self._inertia, self._worst, self._scale = np.zeros(1), 0.0, 0.0
        # Steps whose accelerations were set anew, with the inertia that these leave out: those where a wheel landed,
        # and, with the new ones (n,), those after which a wheel let go.
        self.restarted: Mapping[int, float] = {}
        self.released: Mapping[int, tuple[FloatArray, float]] = {}
        self.between: Mapping[int, Sequence[Substep]] = {}  # steps that were cut
        # What elements that stand on nothing take in the steps for which reactions were asked last (n_step,).
        self.left_over: Callable[[], FloatArray | None] | None = None

    def _read_tables(self, plan: Plan) -> None:
        """What follows from the structure alone."""
        system = plan.crossing.structure.system
        t = system.translation("z")
        self._t_prescribed = t[system.prescribed]
        self._t_free = t[system.free]
        mass, damping, stiffness = (
            np.asarray(m @ t) for m in (system.mass, system.damping, system.stiffness)
        )
        if system.modal_damping is not None:
            damping[system.free] += system.modal_damping.apply(t[system.free])
        scale = np.abs(system.stiffness.diagonal()).max(initial=1.0)
        stiffness[np.abs(stiffness) < 1e-10 * scale] = 0.0
        rows = [(mass, "a")]
        rows += [(vector, name) for vector, name in ((damping, "v"), (stiffness, "u")) if np.any(vector)]
        self._rows = [(vector[system.prescribed], name) for vector, name in rows]
        moved = [vector[system.free] for vector, _ in rows]
        self.mass = moved[0]
        self.sums = Sums.together(
            [
                Sums.of_blocks(*(vector[None] if name == which else 0.0 * vector[None] for which in "uva"))
                for vector, (_, name) in zip(moved, rows, strict=True)
            ]
        )
        self._loads = [(float(t @ load.vector), load.factor) for load in system.loads]

    def look(
        self,
        steps: IntArray,
        sums: FloatArray,
        reactions: FloatArray,
        positions: FloatArray,
        forces: FloatArray,
    ) -> None:
        """Check consecutive steps."""
        plan, system = self._plan, self._plan.crossing.structure.system
        times = plan.times_of(steps)
        alpha = plan.settings.method.alpha
        totals = np.zeros(len(steps))
        for i, (prescribed, name) in enumerate(self._rows):
            history = {"a": "acceleration", "v": "velocity", "u": "value"}[name]
            moved = sum(
                (prescribed[j] * getattr(system.motions[j], history)(times) for j in plan.moving),
                np.zeros(len(steps)),
            )
            value = sums[:, i] + moved
            if name == "a" and alpha != 0.0:
                self._filter(steps, value, moved, prescribed)
            totals += value
        applied = sum((amount * factor(times) for amount, factor in self._loads), np.zeros(len(steps)))
        wheels = self._carried(positions, forces)
        residual = reactions @ self._t_prescribed + applied - wheels - totals
        left_over = self.left_over() if self.left_over is not None else None
        if left_over is not None:
            residual -= left_over
        self._worst = max(self._worst, float(np.abs(residual).max()))
        self._scale = max(self._scale, *(float(np.abs(part).max()) for part in (wheels, applied, totals)))

    def _after(self, part: Substep, prescribed: FloatArray, alpha: float) -> float:
        """Inertia of the whole structure after a step in between."""
        motions, time = self._plan.crossing.structure.system.motions, np.array([part.time])
        moved = sum(float(prescribed[j] * motions[j].acceleration(time)[0]) for j in self._plan.moving)
        if part.excess is not None:
            return part.total + moved + part.excess
        return (part.total + moved + alpha * float(self._inertia[0])) / (1.0 + alpha)

    def _filter(
        self, steps: IntArray, momentum: FloatArray, moved: FloatArray, prescribed: FloatArray
    ) -> None:
        """Turn tᵀ M ü (n_step,), of which supports that move have a share, into inertia forces, in place."""
        alpha = self._plan.settings.method.alpha
        special = special_steps(steps, self.restarted, self.released, self.between)

        def anew(k: int) -> bool:
            step = int(steps[k])
            if step - 1 in self.released:
                accelerations, excess = self.released[step - 1]
                before = moved[k - 1] if k else moved[k]  # a support hardly changes its acceleration
                self._inertia[0] = float(self.mass @ accelerations) + before + excess
            for part in self.between.get(step, ()):
                self._inertia[0] = self._after(part, prescribed, alpha)
            if step in self.restarted:
                momentum[k] += self.restarted[step]
            return step == 0 or step in self.restarted

        filtered(momentum[:, None], alpha, self._inertia, special, anew)

    def _carried(self, positions: FloatArray, forces: FloatArray) -> FloatArray:
        """What the structure carries (n_step,) of the wheels' forces: all of it, or less at its ends."""
        total = np.zeros(len(positions))
        for wheels, path in self._lifted:
            total += path.loads(positions, forces, wheels, 1, one_way=True)[:, 0]
        return total

    @property
    def residual(self) -> float:
        """Largest residual relative to the largest load [-]."""
        return self._worst / self._scale if self._scale > 0.0 else self._worst
