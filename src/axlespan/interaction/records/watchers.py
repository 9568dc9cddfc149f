"""What looks on: watchers see complete states after some steps, keepers some d.o.f. after all steps."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Collection, Iterable
from typing import Protocol

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.integrator import State

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


class Watcher(Protocol):
    """Looks at a crossing after steps that it knows beforehand."""

    @property
    def steps(self) -> Collection[int]:
        """Time indices at which it looks; 0 is the start."""
        ...

    def look(
        self, step: int, structure: State, vehicles: State, load: FloatArray, forces: FloatArray
    ) -> None:
        """Look at a completed step: states, Eᵀ X (n,) and contact forces (n_coupled,).

        A step may come again with the same values, when a crossing beside it had to leave.
        """
        ...


class Keeper(Protocol):
    """Works up what the tape holds of some d.o.f. of the structure, stretch by stretch."""

    @property
    def free_dofs(self) -> IntArray:
        """The free d.o.f. (n,) that it needs, sorted."""
        ...

    def look(self, steps: IntArray, near: FloatArray, positions: FloatArray, forces: FloatArray) -> None:
        """Look at consecutive good steps: ``near`` (3, n_step, n) of ``free_dofs``, wheels (n_step, n_contact)."""
        ...


class Watchers:
    """Several watchers as one; the time loop asks ``looks_at`` once a step."""

    def __init__(self, watchers: Iterable[Watcher]) -> None:
        self._by_step: dict[int, list[Watcher]] = {}
        for watcher in watchers:
            for step in watcher.steps:
                self._by_step.setdefault(step, []).append(watcher)
        self._steps = sorted(self._by_step)

    def between(self, first: int, n_step: int) -> list[int]:
        """Which of so many steps from the first one on are looked at, counted from it."""
        low, high = bisect_left(self._steps, first), bisect_left(self._steps, first + n_step)
        return [step - first for step in self._steps[low:high]]

    def looks_at(self, step: int) -> bool:
        """Whether any of them looks at a step."""
        return step in self._by_step

    def look(
        self, step: int, structure: State, vehicles: State, load: FloatArray, forces: FloatArray
    ) -> None:
        """Let those look that look at this step."""
        for watcher in self._by_step[step]:
            watcher.look(step, structure, vehicles, load, forces)
