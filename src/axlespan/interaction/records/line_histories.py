"""Displacement, acceleration and twist along the deck at every n-th step, and the slope of its ends."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.interaction.line_points import deck_line
from axlespan.interaction.plan import Plan
from axlespan.running.structure import Structure

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

#: Lines under the wheels of each side, and the length over which twist is measured [m].
LEFT, RIGHT = "left", "right"
TWIST_LENGTH = 3.0

Rows = FloatArray | sp.csr_array
# Up to this many entries a dense product is quicker than a sparse one.
_DENSE_UP_TO = 20_000


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


def _operand(matrix: sp.csr_array) -> Rows:
    return matrix.toarray() if matrix.shape[0] * matrix.shape[1] <= _DENSE_UP_TO else matrix


class LineHistories:
    """Keeps the deck's vertical motion at ``plan.settings.line_points``.

    ``like`` is one of the same points on the same structure, whose rows serve here too.
    """

    positions: FloatArray  # (n_point,) [m]
    ends: FloatArray  # (2,) [m]
    free_dofs: IntArray
    _rows: tuple[Rows, Rows]  # of motion and of acceleration, over the free d.o.f.
    _moved: tuple[sp.csr_array, sp.csr_array]  # the same over the supports that move

    def __init__(self, plan: Plan, like: LineHistories | None = None) -> None:
        self._plan = plan
        if like is None:
            self._read_rows(plan)
        else:
            self.positions, self.ends, self.free_dofs = like.positions, like.ends, like.free_dofs
            self._rows, self._moved = like._rows, like._moved
        n_kept = plan.settings.steps // plan.settings.every + 1
        # Times run fastest: extremes over them, and filters, read memory in order.
        self._motion = np.zeros((self._rows[0].shape[0], n_kept))
        self._acceleration = np.zeros((len(self.positions), n_kept))

    def _read_rows(self, plan: Plan) -> None:
        self.positions = np.array(plan.settings.line_points, dtype=float)
        system, path = plan.crossing.structure.system, deck_line(plan.crossing.structure)
        self.ends = np.array([path.start, path.stop]) if len(self.positions) else np.zeros(0)
        values, slopes = path.rows(self.positions, system.size), path.rows(self.ends, system.size, 1)
        twists = twist_rows(plan.crossing.structure, self.positions)
        both = sp.csr_array(sp.vstack([values, slopes, twists]))
        free = sp.csc_array(both[:, system.free])
        self.free_dofs = np.unique(free.nonzero()[1]).astype(np.int64)
        n = len(self.positions)
        compact = sp.csr_array(free[:, self.free_dofs])
        moved = sp.csr_array(both[:, system.prescribed[plan.moving]])
        self._rows = _operand(compact), _operand(sp.csr_array(compact[:n]))
        self._moved = moved, moved[:n]

    def look(self, steps: IntArray, near: FloatArray, positions: FloatArray, forces: FloatArray) -> None:
        """Look at consecutive steps: ``near`` (3, n_step, n_free) of ``free_dofs``."""
        if not len(self.positions):
            return
        every = self._plan.settings.every
        kept = slice(int(-steps[0] % every), None, every)
        first = int(-(-steps[0] // every))
        into = slice(first, first + len(steps[kept]))
        self._motion[:, into] = self._values(0, "value", steps[kept], near[0, kept])
        self._acceleration[:, into] = self._values(1, "acceleration", steps[kept], near[2, kept])

    def _values(self, which: int, name: str, steps: IntArray, near: FloatArray) -> FloatArray:
        """Values (n_row, n_step) of rows at consecutive or every n-th step."""
        rows = self._rows[which]
        values = (near @ rows.T).T if isinstance(rows, np.ndarray) else np.asarray(rows @ near.T)
        if len(self._plan.moving):
            times, motions = self._plan.times_of(steps), self._plan.crossing.structure.system.motions
            own = np.array([getattr(motions[j], name)(times) for j in self._plan.moving])
            values = values + self._moved[which] @ own
        return values

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
