"""Tapes of some stretches, gathered before they are worked up: many steps at a time cost less each."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np
import numpy.typing as npt

from axlespan.interaction.records.tape import LaneTape

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# So many steps, or bytes, are enough.
_STEPS: Final = 1024
_BYTES: Final = 750_000


@dataclass(eq=False)
class Gathering:
    """Copies of tapes (the originals are written over) with their steps and positions."""

    _steps: list[IntArray] = field(default_factory=list)
    _positions: list[FloatArray] = field(default_factory=list)
    _tapes: list[LaneTape] = field(default_factory=list)
    _count: int = 0
    _size: int = 0

    def is_vain(self, n_step: int) -> bool:
        """Whether so many steps are enough by themselves, and none waits."""
        return not self._tapes and n_step >= _STEPS // 2

    def add(self, steps: IntArray, positions: FloatArray, tape: LaneTape) -> bool:
        """Gather consecutive steps; whether these are enough."""
        own = LaneTape(tape.near.copy(), tape.vehicles.copy(), tape.forces.copy(), tape.sums.copy(order="K"))
        self._steps.append(steps)
        self._positions.append(positions)
        self._tapes.append(own)
        self._count += len(steps)
        self._size += (
            positions.nbytes + own.near.nbytes + own.vehicles.nbytes + own.forces.nbytes + own.sums.nbytes
        )
        return self._count >= _STEPS or self._size >= _BYTES

    def taken(self) -> tuple[IntArray, FloatArray, LaneTape] | None:
        """All of it as one stretch, None if there is nothing; it begins anew."""
        if not self._tapes:
            return None
        steps, positions, tapes = self._steps, self._positions, self._tapes
        self._steps, self._positions, self._tapes, self._count, self._size = [], [], [], 0, 0
        if len(tapes) == 1:
            return steps[0], positions[0], tapes[0]
        whole = LaneTape(
            np.concatenate([tape.near for tape in tapes], axis=1),
            np.concatenate([tape.vehicles for tape in tapes], axis=1),
            np.concatenate([tape.forces for tape in tapes]),
            np.concatenate([tape.sums for tape in tapes]),
        )
        return np.concatenate(steps), np.concatenate(positions), whole
