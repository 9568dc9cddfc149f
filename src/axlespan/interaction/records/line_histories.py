"""Displacement, acceleration and twist along the deck at every n-th step, and the slope of its ends."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.interaction.line_points import deck_line
from axlespan.interaction.plan import Plan
from axlespan.interaction.records.sums import Sums
from axlespan.running.structure import Structure

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Lines under the wheels of each side, and the length over which twist is measured [m].
LEFT, RIGHT = "left", "right"
TWIST_LENGTH = 3.0


def twist_rows(structure: Structure, positions: FloatArray) -> sp.csr_array:
    """Rows (n_position, n) of the twist [m] over 3 m around positions; none without a left and a right line.

    Twist is the change of the left line's height over the right one's; near the ends of the lines the 3 m are the
    last ones on them.
    """
    size = structure.system.size
    if not {LEFT, RIGHT} <= set(structure.lines):
        return sp.csr_array((0, size))
    left, right = structure.lines[LEFT], structure.lines[RIGHT]
    low, high = max(left.start, right.start), min(left.stop, right.stop) - TWIST_LENGTH
    if high < low:
        return sp.csr_array((0, size))
    begin = np.clip(positions - 0.5 * TWIST_LENGTH, low, high)
    cross = [left.rows(at, size) - right.rows(at, size) for at in (begin, begin + TWIST_LENGTH)]
    return sp.csr_array(cross[1] - cross[0])


class LineHistories:
    """Keeps the deck's vertical motion at ``plan.settings.line_points``.

    ``like`` is one of the same points on the same structure, whose rows serve here too.
    """

    positions: FloatArray  # (n_point,) [m]
    ends: FloatArray  # (2,) [m]
    sums: Sums  # of displacements (n_motion,), then of accelerations (n_point,)
    _moved: tuple[sp.csr_array, sp.csr_array]  # the same over the supports that move

    def __init__(self, plan: Plan, like: LineHistories | None = None) -> None:
        self._plan = plan
        if like is None:
            self._read_rows(plan)
        else:
            self.positions, self.ends, self.sums, self._moved = (
                like.positions,
                like.ends,
                like.sums,
                like._moved,
            )
        n_kept = plan.settings.steps // plan.settings.every + 1
        # Times run fastest: extremes over them, and filters, read memory in order.
        self._motion = np.empty((self.sums.count - len(self.positions), n_kept))
        self._acceleration = np.empty((len(self.positions), n_kept))

    def _read_rows(self, plan: Plan) -> None:
        self.positions = np.array(plan.settings.line_points, dtype=float)
        system, path = plan.crossing.structure.system, deck_line(plan.crossing.structure)
        self.ends = np.array([path.start, path.stop]) if len(self.positions) else np.zeros(0)
        values, slopes = path.rows(self.positions, system.size), path.rows(self.ends, system.size, 1)
        twists = twist_rows(plan.crossing.structure, self.positions)
        both = sp.csr_array(sp.vstack([values, slopes, twists]))
        n, free = len(self.positions), sp.csr_array(both[:, system.free])
        none = sp.csr_array(free.shape)
        of_acceleration = Sums.of_blocks(none[:n], none[:n], free[:n])
        self.sums = Sums.together([Sums.of_blocks(free, none, none), of_acceleration])
        moved = sp.csr_array(both[:, system.prescribed[plan.moving]])
        self._moved = moved, moved[:n]

    def look(self, steps: IntArray, sums: FloatArray) -> None:
        """Look at consecutive steps: values (n_step, n_sum) of :attr:`sums`."""
        if not len(self.positions):
            return
        every, n = self._plan.settings.every, len(self._motion)
        kept = slice(int(-steps[0] % every), None, every)
        first = int(-(-steps[0] // every))
        into = slice(first, first + len(steps[kept]))
        self._motion[:, into] = sums[kept, :n].T
        self._acceleration[:, into] = sums[kept, n:].T
        if len(self._plan.moving):
            self._motion[:, into] += self._of_supports(0, "value", steps[kept])
            self._acceleration[:, into] += self._of_supports(1, "acceleration", steps[kept])

    def _of_supports(self, which: int, name: str, steps: IntArray) -> FloatArray:
        """What supports that move add (n_row, n_step)."""
        times, motions = self._plan.times_of(steps), self._plan.crossing.structure.system.motions
        own = np.array([getattr(motions[j], name)(times) for j in self._plan.moving])
        return np.asarray(self._moved[which] @ own)

    def histories(self, n: int) -> dict[str, FloatArray]:
        """The first n kept, by their names in a result; empty if nothing was asked for."""
        if not len(self.positions):
            return {}
        count = len(self.positions)
        return {
            "line_position": self.positions,
            "line_end": self.ends,
            "line_displacement": self._motion[:count, :n].T,
            "line_acceleration": self._acceleration[:, :n].T,
            "line_slope": self._motion[count : count + 2, :n].T,
            "line_twist": self._motion[count + 2 :, :n].T,
        }
