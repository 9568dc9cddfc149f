"""The lanes of a convoy that go through the compiled loop together, in the order of elimination, innermost in memory."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.integrator import State
from axlespan.interaction.bodies import StructureBody
from axlespan.interaction.contact_system import Stretch
from axlespan.interaction.fused.banded_body import BandedBody

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


# Floats in a line of the cache.
_LINE = 8


class Chunk:
    """Some lanes that follow one another: their states and what a stretch of steps needs.

    Parameters
    ----------
    body : BandedBody
    lane, used, width : int
        The first lane, how many there are, and the room for them.
    contacts, dofs, blocks : (int, int)
        Theirs among the coupled contacts, d.o.f. and vehicles of the joint fleet.
    """

    def __init__(
        self,
        body: BandedBody,
        lane: int,
        used: int,
        width: int,
        contacts: tuple[int, int],
        dofs: tuple[int, int],
        blocks: tuple[int, int],
    ) -> None:
        self.lane, self.used, self.width = lane, used, width
        self.contacts, self.dofs, self.blocks = contacts, dofs, blocks
        self._body = body
        n, pad = len(body.rank), 2 * body.width
        self._values = _aligned(3 * n * width).reshape(3, n, width)
        self._x, self._added = _aligned((n + pad) * width), _aligned((n + pad) * width)
        self._extra = _aligned(n * width).reshape(n, width)
        room = 1 << (2 * body.ahead + 1).bit_length()
        self._ring = (_aligned(room * width), _aligned(room * width))
        self._reach = np.zeros(2, dtype=np.int64)

    def arrays(self, forced: bool) -> tuple[Any, ...]:
        """State, vectors to work in, and whether any force but new contact acts."""
        u, v, a = (self._values[i].reshape(-1) for i in range(3))
        extra = self._extra.reshape(-1)
        return (u, v, a), self._x, self._added, extra, forced, self._ring, self._reach

    def prepare(self, stretch: Stretch, lanes: int) -> None:
        """Take from a stretch the wheels of these lanes."""
        low, high = self.contacts
        self.wheels = (*self._rows(stretch, True), _within(stretch.into, low, high))
        begin = int(stretch.begins[1][self.lane])
        end = int(stretch.begins[1][self.lane + self.used]) if self.lane + self.used < lanes else None
        self._forced = (*self._rows(stretch, False), _within(stretch.forced, begin, end))

    def _rows(self, stretch: Stretch, coupled: bool) -> tuple[IntArray, FloatArray]:
        """Places in the chunk (n_step, n_wheel, n_local) of the coupled wheels, or the moving forces, and weights."""
        lanes = stretch.crossings[self.lane : self.lane + self.used]
        which = [rows.live[(rows.rank >= 0) == coupled] for rows in lanes]
        n_local = max(path.free.dofs.shape[1] for rows in lanes for path in rows.train.paths)
        shape = (stretch.n_step, sum(map(len, which)), n_local)
        place, weights = np.empty(shape, np.int64), np.zeros(shape)  # places of no weight are not read
        begin = 0
        for lane, (rows, wheels) in enumerate(zip(lanes, which, strict=True)):
            slots = np.arange(begin, begin + len(wheels))
            for path in rows.train.paths if len(wheels) else ():
                own = np.isin(wheels, path.wheels)
                numbers = self._body.rank[path.free.dofs] * self.width + lane
                arrays = (rows.positions, wheels[own], slots[own], place, weights)
                path.free.fill_rows(*arrays, numbers=numbers)
            begin += len(wheels)
        return place, weights

    def known(self, weight: FloatArray) -> tuple[IntArray, FloatArray, FloatArray]:
        """Rows (n_step, n_wheel, n_local) and forces (n_wheel,) of moving forces."""
        place, weights, contacts = self._forced
        return place, weights, weight[contacts]

    def take(self, structure: StructureBody) -> None:
        """Take the lanes' states."""
        values = structure.state.values.reshape(3, len(self._body.rows), -1)
        lanes = slice(self.lane, self.lane + self.used)
        self._values[:, :, : self.used] = values[:, self._body.rows, lanes]

    def carry(self, structure: StructureBody, weight: float) -> None:
        """Begin with the contact loads of the step before, which the alpha method weighs."""
        self._extra[...] = 0.0
        dofs, load = structure.carried
        if weight and len(dofs):
            lanes = slice(self.lane, self.lane + self.used)
            self._extra[self._body.rank[dofs], : self.used] -= weight * load.reshape(len(dofs), -1)[:, lanes]

    def state_of(self, lane: int) -> State:
        """The state of one of the lanes."""
        return State(np.ascontiguousarray(self._values[:, :, lane - self.lane][:, self._body.rank]))

    def show(self, structure: StructureBody) -> None:
        """Give back the lanes' states."""
        values = structure.state.values.reshape(3, len(self._body.rank), -1)
        own = slice(self.lane, self.lane + self.used)
        values[:, :, own] = self._values[:, self._body.rank, : self.used]


def _aligned(size: int) -> FloatArray:
    """Zeros (size,) that begin where a line of the cache does: vectors of eight then lie in one line."""
    room = np.zeros(size + _LINE)
    begin = (-room.ctypes.data // room.itemsize) % _LINE
    return room[begin : begin + size]


def _within(names: IntArray, low: int, high: int | None) -> IntArray:
    """Those of some sorted numbers that are in a range."""
    return names[(names >= low) & (True if high is None else names < high)]


def chunks_of(
    body: BandedBody,
    sizes: tuple[Sequence[slice], Sequence[slice], Sequence[slice]],
    most: int,
    fewest: int,
) -> list[Chunk]:
    """Share lanes among chunks.

    Parameters
    ----------
    sizes
        For each lane its coupled contacts, vehicle d.o.f. and vehicles.
    most, fewest : int
        Lanes in a chunk; where there are fewer, each goes alone.
    """
    lanes, chunks, lane = len(sizes[0]), [], 0
    while lane < lanes:
        used = min(most, lanes - lane)
        width = most
        if used < fewest:
            used = width = 1
        ranges = [(of[lane].start, of[lane + used - 1].stop) for of in sizes]
        chunks.append(Chunk(body, lane, used, width, *ranges))
        lane += used
    return chunks
