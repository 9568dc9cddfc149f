"""Columns of A⁻¹ at the d.o.f. under the wheels: computed once, kept while the train is there.

The effective matrix A of the structure is constant, and a row of E only interpolates between the d.o.f. along
the path. So the columns of A⁻¹ for these d.o.f. give the structure's compliance under all wheels at every
step; N12's (A.5) leaves the time loop.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.integrator import Integrator
from axlespan.interaction.path_kernel import compiled_sandwich, subtract_at, weighted_rows

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Up to this many entries, a product with all columns is quicker than one with a selection.
_WHOLE_PRODUCT_UP_TO = 100_000

# Whole columns are kept for wheels to come: of a small model some more than are needed, since every step passes them
# all; of a large one as many as take no more memory [byte] than the factor, or than this.
_IDLE_SHARE = 0.5
_KEPT = 64e6

# A path of so many d.o.f. has all its columns computed with the first ones, if they can be kept.
_PATH_AT_ONCE = 128

# Along a narrow band a column of A⁻¹ dies away within some meters: in one time step the load is felt no farther.
# Entries below this share of its largest one are rounding, and left out; none above the second one is missed.
_NOTHING, _MISSED = 1e-17, 1e-16
# Columns from which the reach is estimated, and columns that are solved for together.
_SAMPLES, _TOGETHER = 17, 64
# Places kept beyond the reach: the rows under one wheel are added up over what all of them keep.
_MARGIN = 40


class PathColumns:
    """The columns of one structure and time step.

    Parameters
    ----------
    integrator : Integrator
        Of the structure.
    path_dofs : array (n_path,)
        D.o.f. that running lines use, sorted.
    loaded : int, optional
        How many of them are loaded at a time, at most; when left out, as many as the first wheels load.

    Notes
    -----
    ``held`` are the d.o.f. whose loads a step may name. Where a second solve costs less than the product with
    whole columns (narrow bands), these are all d.o.f. of the path, and only the entries of the columns on the path
    are kept, as far as they reach.
    """

    def __init__(self, integrator: Integrator, path_dofs: IntArray, loaded: int | None = None) -> None:
        self.integrator, self.path_dofs, self._loaded = integrator, path_dofs, loaded
        self.held = np.empty(0, dtype=np.int64)
        self.position = np.zeros(integrator.size, dtype=np.int64)  # d.o.f. -> place among the held ones
        self._columns = np.empty((0, integrator.size))  # in rows: that of the held d.o.f. i is at row[i]
        self._row = self._used = np.empty(
            0, dtype=np.int64
        )  # (n_held,) row, and the stretch that last needed it
        self._filled = self._stretch = 0  # rows that have ever been filled, stretches so far
        self._force = np.empty(0)
        # (1+α) β Δt² R A⁻¹ Rᵀ of the held d.o.f. [m/N]: row i begins at entry offset[i]; it is zero but from low[i] to
        # high[i].
        self.compliance = np.empty((0, 0))
        self.offset = self.low = self.high = np.empty(0, dtype=np.int64)
        self.solves_again: bool | None = None  # decided with the first wheels

    @property
    def nbytes(self) -> int:
        """Memory of the columns held [byte]."""
        return int(8 * self._filled * self.integrator.size + self.compliance.nbytes)

    @property
    def is_whole(self) -> bool:
        """Whether all columns of the path are at hand."""
        if self.solves_again:
            return bool(self._there.all())
        return self.solves_again is not None and len(self.held) == len(self.path_dofs)

    def for_others(self) -> PathColumns:
        """Columns of the same structure for other crossings, which go on by themselves."""
        return PathColumns(self.integrator, self.path_dofs, self._loaded)

    def hold(self, dofs: IntArray) -> None:
        """Have the columns of some d.o.f. of the path at hand; drop others that are idle."""
        mark = np.zeros(len(self.position), dtype=bool)
        mark[dofs] = True
        needed = np.flatnonzero(mark)
        if self.solves_again is None and len(needed):
            self.solves_again = self._second_solve_pays(self._loaded or len(needed))
            if self.solves_again:
                self._hold_path()
        if self.solves_again:
            self._add_rows(self.position[needed])
        else:
            self._hold_whole(needed)

    def _hold_whole(self, needed: IntArray) -> None:
        self._stretch += 1
        missing = np.setdiff1d(needed, self.held, assume_unique=True)
        if len(missing):
            self._bring(needed, missing)
        self._used[self.position[needed]] = self._stretch

    def _bring(self, needed: IntArray, missing: IntArray) -> None:
        """Compute missing columns, and some that wheels will need; drop those unused for longest if memory asks for it."""
        room = self._room(len(needed))
        if len(self._columns) < room:
            wider = np.empty((room, self.integrator.size))  # memory is taken when it is filled
            wider[: self._filled] = self._columns[: self._filled]
            self._columns = wider
        idle = np.flatnonzero(~np.isin(self.held, needed, assume_unique=True))
        excess = len(self.held) + len(missing) - room
        keep = np.ones(len(self.held), dtype=bool)
        if excess > 0:
            keep[idle[np.argsort(self._used[idle], kind="stable")][:excess]] = False
        held, row, used = self.held[keep], self._row[keep], self._used[keep]
        new = np.concatenate([missing, self._ahead(held, missing, room)])
        vacant = np.setdiff1d(np.arange(len(held) + len(new)), row)[: len(new)]
        self.integrator.columns(new, self._columns, vacant)
        self._filled = max(self._filled, int(vacant.max()) + 1)
        held = np.concatenate([held, new])
        order = np.argsort(held)
        self.held, self._row = held[order], np.concatenate([row, vacant])[order]
        self._used = np.concatenate([used, np.full(len(new), self._stretch)])[order]
        self.position[:] = 0
        self.position[self.held] = np.arange(len(self.held))
        block = self._scale * self._columns[self._row[:, None], self.held]
        self.compliance = 0.5 * (block + block.T)
        self.offset = self.low = np.zeros_like(self.held)
        self.high = np.full_like(self.held, len(self.held))

    @property
    def _is_small(self) -> bool:
        return self.integrator.size * len(self.path_dofs) <= _WHOLE_PRODUCT_UP_TO

    def _room(self, needed: int) -> int:
        """How many columns may be held when so many are needed."""
        if self._is_small:
            return min(int((1.0 + _IDLE_SHARE) * needed), len(self.path_dofs))
        kept = max(_KEPT, self.integrator.factor.nbytes) / (8 * self.integrator.size)
        return max(needed, min(int(kept), len(self.path_dofs)))

    def _ahead(self, held: IntArray, missing: IntArray, room: int) -> IntArray:
        """D.o.f. of the path next to those missing, to be solved for with them: several cost little more than few."""
        others = np.setdiff1d(self.path_dofs, np.concatenate([held, missing]), assume_unique=True)
        count = min(len(others), room - len(held) - len(missing))
        if self._is_small or not count:
            return others[:0]
        if count < len(others) or len(self.path_dofs) > _PATH_AT_ONCE:
            count = min(count, -len(missing) % _TOGETHER if len(held) else 0)
        near, at = (np.searchsorted(self.path_dofs, dofs) for dofs in (np.sort(missing), others))
        after = np.minimum(np.searchsorted(near, at), len(near) - 1)
        distance = np.minimum(np.abs(near[after] - at), np.abs(near[np.maximum(after - 1, 0)] - at))
        return others[np.argsort(distance, kind="stable")[:count]]

    @property
    def _scale(self) -> float:
        return self.integrator.weight_c * self.integrator.u_from_a

    def _second_solve_pays(self, loaded: int) -> bool:
        """Compare the memory traffic of a solve with that of a product with the columns under the wheels."""
        n = self.integrator.size
        return n * loaded > _WHOLE_PRODUCT_UP_TO and 8 * n * loaded > 2 * self.integrator.factor.nbytes

    # --- entries on the path only ------------------------------------------------------------------

    def _hold_path(self) -> None:
        """Hold the whole path, its columns still to be computed, with as many entries as they seem to need."""
        n = len(self.path_dofs)
        self.held = self.path_dofs
        self.position[self.held] = np.arange(n)
        reach = n
        if compiled_sandwich() is not None:
            sample = np.unique(np.linspace(0, n - 1, _SAMPLES).astype(np.int64))
            low, high = _extent(self._entries(sample), _NOTHING)
            reach = int(1.1 * max(np.max(sample - low), np.max(high - sample))) + _MARGIN
        self._make_room(reach)

    def _make_room(self, reach: int) -> None:
        n = len(self.path_dofs)
        width = min(2 * reach + 1, n)
        self.offset = np.clip(np.arange(n) - reach, 0, n - width)
        self.low, self.high = self.offset.copy(), self.offset + width
        self.compliance = np.zeros((n, width))
        self._there = np.zeros(n, dtype=bool)

    def _entries(self, places: IntArray) -> FloatArray:
        """Entries on the path (n, n_path) of the columns at some places."""
        loads = np.zeros((self.integrator.size, len(places)))
        loads[self.path_dofs[places], np.arange(len(places))] = self._scale
        return np.ascontiguousarray(self.integrator.factor.solve(loads, out=loads)[self.path_dofs].T)

    def _add_rows(self, needed: IntArray) -> None:
        """Compute the columns at some places, unless they are there."""
        missing = needed[~self._there[needed]]
        width = self.compliance.shape[1]
        for begin in range(0, len(missing), _TOGETHER):
            some = missing[begin : begin + _TOGETHER]
            entries, offset = self._entries(some), self.offset[some]
            low, high = _extent(entries, _MISSED)
            if np.any(low < offset) or np.any(high > offset + width):
                # The sample did not show how far they reach: once more, with more room.
                self._make_room(2 * max(int(np.max(some - low)), int(np.max(high - some)), width // 2))
                self._add_rows(needed)
                return
            self.compliance[some] = np.take_along_axis(entries, offset[:, None] + np.arange(width), axis=1)
            low, high = _extent(self.compliance[some], _NOTHING)
            self.low[some], self.high[some] = low + offset, high + offset
            self._there[some] = True

    def response(self, load: FloatArray) -> FloatArray:
        """Acceleration (n,) or (n, k) of the structure under loads (n_held,) or (n_held, k), downward: -(1+α) A⁻¹ Rᵀ load.

        The array may be used again by the next call.
        """
        weight = -self.integrator.weight_c
        if self.solves_again:
            shape = (self.integrator.size, *load.shape[1:])
            if self._force.shape != shape:
                self._force = np.empty(shape)
            self._force[...] = 0.0
            subtract_at(self.held, -weight, load, self._force)
            return self.integrator.factor.solve(self._force, out=self._force)
        if load.ndim > 1 or self._filled * self.integrator.size <= _WHOLE_PRODUCT_UP_TO:
            by_row = np.zeros((self._filled, *load.shape[1:]))
            by_row[self._row] = weight * load
            return np.asarray(self._columns[: self._filled].T @ by_row)
        loaded = np.flatnonzero(load)
        return weighted_rows(self._columns, self._row[loaded], weight * load[loaded])


def _extent(entries: FloatArray, share: float) -> tuple[IntArray, IntArray]:
    """Of each row the first entry above a share of the largest one, and the place behind the last one."""
    size = np.abs(entries)
    counts = size > share * size.max(axis=1, keepdims=True)
    return counts.argmax(axis=1), entries.shape[1] - counts[:, ::-1].argmax(axis=1)
