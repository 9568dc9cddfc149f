"""How far a task is that is being computed: long batches are not over for minutes."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from axlespan.interaction.plan import Plan

#: Called with how many scenarios' worth of steps of a task have been made.
Tell = Callable[[float], None]

#: Called with the number of a task and what it told.
News = Callable[[int, float], None]

# Seconds between two messages.
_PAUSE: Final = 0.25


@dataclass(eq=False)
class Meter:
    """Counts the steps of a task whose groups of scenarios are computed one after the other.

    Examples
    --------
    ``meter.of(plans)`` goes to ``run_plans`` as its ``progress``; ``meter.add(len(plans))`` follows.
    """

    tell: Tell
    pause: float = _PAUSE
    _done: float = 0.0  # scenarios of the groups before
    _told: float = 0.0
    _next: float = 0.0

    def of(self, plans: Sequence[Plan]) -> Callable[[int], None]:
        """What a group of scenarios reports its time steps to; what begins anew is not told again."""
        steps = np.array([plan.settings.steps for plan in plans], dtype=float)

        def look(step: int) -> None:
            now = time.monotonic()
            if now < self._next:
                return
            self._next = now + self.pause
            made = self._done + float(np.minimum(step / steps, 1.0).sum())
            if made > self._told:
                self._told = made
                self.tell(made)

        return look

    def add(self, scenarios: int) -> None:
        """Count a group that is over."""
        self._done += scenarios
