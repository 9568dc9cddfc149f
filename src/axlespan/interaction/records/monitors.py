"""Self-checks of the contact in a run: compatibility, and wheels that would pull at the rail."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.interaction.plan import Plan

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Smallest displacement [m] that a compatibility residual is related to.
_SMALLEST = 1e-6


class CompatibilityMonitor:
    """Largest |u_X - E u - r| relative to the largest displacement of the wheels (N12 (27)), now and then."""

    def __init__(self) -> None:
        self._worst, self._scale = 0.0, _SMALLEST
        self.touching: Callable[[], npt.NDArray[np.bool_]] | None = None  # which wheels; None: all

    def look(self, wheels: FloatArray, line: FloatArray) -> None:
        """Compare wheels with the line under them (n_coupled,) [m]."""
        if len(wheels) and self.touching is not None:
            which = self.touching()
            wheels, line = wheels[which], line[which]
        if len(wheels) and np.all(np.isfinite(wheels)) and np.all(np.isfinite(line)):
            self._worst = max(self._worst, float(np.abs(wheels - line).max()))
            self._scale = max(self._scale, float(np.abs(wheels).max()))

    @property
    def residual(self) -> float:
        """Relative residual [-]."""
        return self._worst / self._scale


@dataclass(frozen=True)
class TensionEpisode:
    """A stretch of time in which a wheel would have to pull at the rail."""

    contact: str
    start: float  # [s]
    stop: float  # [s]
    position: float  # of the wheel at the largest tension [m]
    size: float  # largest tension [N], positive


class TensionMonitor:
    """Tension episodes of every wheel, over all steps."""

    _LIMIT = 1000  # episodes kept; all are counted

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self.episodes: list[TensionEpisode] = []
        self.count = 0
        self._open: dict[int, TensionEpisode] = {}
        n = plan.rows.n_contact
        self.largest, self.smallest = np.full(n, -np.inf), np.full(n, np.inf)
        self.largest_at, self.smallest_at = np.zeros(n), np.zeros(n)
        # Moving forces stay as they are.
        self._constant = not len(plan.fleet.coupled) and bool(np.all(plan.fleet.weight >= 0.0))

    def look(self, steps: IntArray, positions: FloatArray, forces: FloatArray) -> None:
        """Look at consecutive steps: positions and forces (n_step, n_contact)."""
        if self._constant:
            self.largest = self.smallest = self._plan.fleet.weight
            return
        times = self._plan.times_of(steps)
        self._peaks(times, forces)
        pulled = forces < 0.0
        for wheel in np.flatnonzero(
            pulled.any(axis=0) | np.isin(np.arange(forces.shape[1]), list(self._open))
        ):
            self._episodes_of(int(wheel), times, forces[:, wheel], positions[:, wheel])

    def _peaks(self, times: FloatArray, forces: FloatArray) -> None:
        top, bottom = forces.argmax(axis=0), forces.argmin(axis=0)
        wheel = np.arange(forces.shape[1])
        higher, lower = forces[top, wheel] > self.largest, forces[bottom, wheel] < self.smallest
        self.largest_at[higher], self.smallest_at[lower] = times[top[higher]], times[bottom[lower]]
        self.largest, self.smallest = (
            np.maximum(self.largest, forces[top, wheel]),
            np.minimum(self.smallest, forces[bottom, wheel]),
        )

    def _episodes_of(self, wheel: int, times: FloatArray, forces: FloatArray, positions: FloatArray) -> None:
        name = self._plan.crossing.contact_names[wheel]
        for time, force, position in zip(times.tolist(), forces.tolist(), positions.tolist(), strict=True):
            current = self._open.get(wheel)
            if force < 0.0:
                if current is None:
                    current = TensionEpisode(name, time, time, position, -force)
                if -force > current.size:
                    current = TensionEpisode(name, current.start, time, position, -force)
                self._open[wheel] = TensionEpisode(name, current.start, time, current.position, current.size)
            elif current is not None:
                self._close(wheel)

    def _close(self, wheel: int) -> None:
        episode = self._open.pop(wheel)
        self.count += 1
        if len(self.episodes) < self._LIMIT:
            self.episodes.append(episode)

    def finish(self) -> None:
        """Close the episodes that last until the end."""
        for wheel in list(self._open):
            self._close(wheel)
