"""Wheels in the air: when and where they lift off and land, and which vehicles are lost."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.errors import AnalysisError
from axlespan.interaction.plan import Plan

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
Mask = npt.NDArray[np.bool_]

#: Flights that are listed; all are counted.
LISTED = 1000
# A wheel that lands so often within so many steps chatters: its hops are not resolved by the time step.
_LANDINGS, _WITHIN = 12, 48


@dataclass(frozen=True)
class Flight:
    """A wheel's time off the line."""

    contact: str
    start: float  # first time without contact [s]
    stop: float  # first time with contact again, or the last time [s]
    start_position: float  # [m]
    stop_position: float  # [m]
    gap: float  # largest [m]
    closing_speed: float  # at the landing [m/s]; zero for a flight that does not end
    landed: bool = True


class Flights:
    """Keeps account of flights, over all steps.

    Parameters
    ----------
    plan : Plan
    in_air : array (n_coupled,)
        Wheels off the line at time zero.
    lost_after : float
        Time [s] for which all wheels of a vehicle may be in the air.
    """

    def __init__(self, plan: Plan, in_air: Mask, lost_after: float) -> None:
        self.plan, self._lost_after = plan, lost_after
        self.flights: list[Flight] = []
        self.count = 0
        fleet = plan.fleet
        self.names = [plan.crossing.contact_names[i] for i in fleet.coupled]
        self.in_air = in_air.copy()  # at time zero
        self._since = np.where(in_air, 0.0, -1.0)  # step of the lift-off
        self._gap = np.zeros(len(in_air))
        self._landings = np.full((len(in_air), _LANDINGS), -10 * _WITHIN)
        self._vehicles = fleet.vehicle_of
        self._first = np.searchsorted(fleet.vehicle_of, np.unique(fleet.vehicle_of))
        self._last = 0.0

    def look(
        self, step: float, in_air: Mask, struck: Mask, approach: FloatArray, closing: FloatArray
    ) -> None:
        """Look at a completed step: wheels in the air, those that struck the line, approaches [m], closing speeds [m/s].

        A wheel may strike the line and be in the air again at once: two flights. Of a step that was cut, ``step`` is a
        fraction.

        Raises
        ------
        AnalysisError
            If a vehicle has been in the air for too long, or a wheel chatters.
        """
        self._last = step
        flew = self._since >= 0
        if not (flew.any() or in_air.any()):
            return
        self._gap = np.maximum(self._gap, np.where(in_air, -approach, 0.0))
        ended = flew & (struck | ~in_air)
        for wheel in np.flatnonzero(ended).tolist():
            self._close(wheel, step, float(closing[wheel]))
        self._since = np.where(in_air, np.where(flew & ~ended, self._since, step), -1)
        self._lost(step)

    @property
    def any_in_air(self) -> bool:
        """Whether a wheel is in the air."""
        return bool((self._since >= 0).any())

    def _close(self, wheel: int, step: float, closing: float) -> None:
        landings = self._landings[wheel]
        landings[:-1], landings[-1] = landings[1:].copy(), math.ceil(step)
        self._add(wheel, step, closing, landed=True)
        if landings[-1] - landings[0] < _WITHIN:
            raise AnalysisError(
                f"step {math.ceil(step)}, t = {self._time(step):.6g} s: contact {self.names[wheel]} chatters, with {_LANDINGS} "
                f"landings in {_WITHIN} steps. Use a smaller time step, alpha: -0.1, a footprint, or contact: hertz"
            )

    def _add(self, wheel: int, step: float, closing: float, *, landed: bool) -> None:
        self.count += 1
        if len(self.flights) >= LISTED:
            return
        begin = float(self._since[wheel])
        times = np.array([self._time(begin), self._time(step)])
        start, stop = self.plan.rows.positions(times)[:, self.plan.fleet.coupled[wheel]].tolist()
        flight = Flight(
            self.names[wheel], float(times[0]), float(times[1]), start, stop, float(self._gap[wheel]), closing
        )
        self.flights.append(replace(flight, landed=landed))
        self._gap[wheel] = 0.0

    def _lost(self, step: float) -> None:
        since = np.where(self._since >= 0, self._since, step)
        latest = np.maximum.reduceat(since, self._first)  # of each vehicle, the wheel that left last
        lost = np.flatnonzero(self._time(step) - latest * self.plan.settings.time_step > self._lost_after)
        if len(lost):
            name = self.names[int(self._first[lost[0]])].partition(".")[0]
            raise AnalysisError(
                f"step {math.ceil(step)}, t = {self._time(step):.6g} s: vehicle {name} is lost: all its wheels have been in "
                f"the air for {self._lost_after:g} s. Check speed, irregularity and masses, or allow more with lost_after"
            )

    def _time(self, step: float) -> float:
        return step * self.plan.settings.time_step

    def checks(self) -> dict[str, Any]:
        """All flights so far, those that last until the end too."""
        for wheel in np.flatnonzero(self._since >= 0).tolist():
            self._add(wheel, self._last, 0.0, landed=False)
        self._since[:] = -1
        return {"flight_count": self.count, "flights": [asdict(flight) for flight in self.flights]}


class HeldFlights(Flights):
    """Remembers what it is shown of the parts of a step, and tells another one when the whole step is made."""

    def __init__(self, of: Flights, parts: int) -> None:
        super().__init__(of.plan, of.in_air, math.inf)
        self._of, self._parts = of, parts
        self._shown: list[tuple[float, Mask, Mask, FloatArray, FloatArray]] = []

    def look(
        self, step: float, in_air: Mask, struck: Mask, approach: FloatArray, closing: FloatArray
    ) -> None:
        """Remember a part, by its own time index."""
        self._shown.append((step / self._parts, in_air, struck, approach, closing))

    def forget(self) -> None:
        """The parts are to be made again."""
        self._shown = []

    def tell(self) -> None:
        """The step is made.

        Raises
        ------
        AnalysisError
            As :meth:`Flights.look`.
        """
        for shown in self._shown:
            self._of.look(*shown)
        self._shown = []
