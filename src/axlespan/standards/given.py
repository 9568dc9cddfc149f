"""What a check has before it: the result of a run, what was run, and what the rules know of the bridge."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt

from axlespan.interaction.crossing import Crossing
from axlespan.interaction.result import Result
from axlespan.standards.assessment import Assessment
from axlespan.standards.at_rest import AtRest
from axlespan.standards.bridge_facts import BridgeFacts

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

# Bodies of a vehicle that carry nobody.
_RUNNING_GEAR = ("wheel", "bogie", "axle")


@dataclass(frozen=True, eq=False)
class Given:
    """All that a check may look at."""

    result: Result
    assessment: Assessment
    facts: BridgeFacts
    crossing: Crossing | None = None
    at_rest: AtRest = field(default_factory=AtRest)

    @property
    def interval(self) -> float:
        """Time between records [s]; zero if there is but one."""
        return float(self.result.time[1] - self.result.time[0]) if len(self.result.time) > 1 else 0.0

    @property
    def thinned(self) -> str:
        """Why records of every few steps cannot be filtered; empty for those of every step."""
        step = float(self.result.facts.get("time_step") or self.interval)
        if self.interval <= 1.5 * step:
            return ""
        every = round(self.interval / step)
        return (
            f"one record of {every} steps was kept, and what is faster folds into the band of the rule: leave out "
            "every, under output"
        )

    @cached_property
    def speed(self) -> float:
        """Highest speed of the run [m/s]."""
        if self.crossing is not None:
            return max(run.course.largest_speed(float(self.result.time[-1])) for run in self.crossing.runs)
        if not self.result.contact_position.size or not self.interval:
            return 0.0
        return float(np.diff(self.result.contact_position[:, 0]).max(initial=0.0) / self.interval)

    @cached_property
    def moving_forces(self) -> BoolArray:
        """Which contacts (n_contact,) are forces given beforehand, not found by the run."""
        if self.crossing is not None:
            items = self.crossing.placements
            kinds = [item.vehicle.is_force for item in items for _ in item.vehicle.contacts]
            if len(kinds) == len(self.result.contact):
                return np.array(kinds, dtype=bool)
        return np.asarray(np.ptp(self.result.contact_force, axis=0) == 0.0)

    @property
    def static_forces(self) -> FloatArray:
        """Static contact forces (n_contact,) [N]."""
        found = self.result.checks.get("static_contact_force") or {}
        return np.array([float(found.get(name, np.nan)) for name in self.result.contact])

    @cached_property
    def on_deck(self) -> BoolArray:
        """When each wheel is on the deck (n_time, n_contact)."""
        ends = self.result.line_end
        if not ends.size:
            ends = np.array(
                [self.result.facts.get("line_start", -np.inf), self.result.facts.get("line_stop", np.inf)]
            )
        position = self.result.contact_position
        return np.asarray((position >= ends[0]) & (position <= ends[1]))

    @cached_property
    def live_deflection(self) -> FloatArray:
        """Deflection of the deck by traffic (n_time, n_line_point) [m]: without what was there before the train."""
        w = self.result.line_displacement
        return np.asarray(w if np.any(self.on_deck[0]) else w - w[0])

    def bodies(self) -> list[tuple[str, int, int | None]]:
        """Car bodies: name such as ``1.body``, column of its vertical d.o.f., and that of its pitch."""
        names = self.result.vehicle_dof
        found = []
        for column, name in enumerate(names):
            body, _, component = name.rpartition(".")
            part = body.partition(".")[2]
            if component == "z" and part and not part.startswith(_RUNNING_GEAR):
                pitch = f"{body}.pitch"
                found.append((body, column, names.index(pitch) if pitch in names else None))
        return found

    def lever(self, body: str) -> float | None:
        """Half the distance of a body's bogies or axles [m]: from the wheels of its vehicle, two halves.

        None where the vehicle has several bodies, which the wheels do not tell apart, or but one axle.
        """
        if self.crossing is None:
            return None
        number, _, own = body.partition(".")
        others = [name for name, _, _ in self.bodies() if name.partition(".")[0] == number]
        if len(others) != 1 or not own:
            return None
        placements = self.crossing.placements
        if not number.isdigit() or int(number) > len(placements):
            return None
        behind = np.sort([point.behind for point in placements[int(number) - 1].vehicle.contacts])
        half = len(behind) // 2
        if half == 0 or behind[0] == behind[-1]:
            return None
        return float(0.5 * (behind[-half:].mean() - behind[:half].mean()))

    def too_short(self, seconds: float) -> str:
        """Why a record is too short for a rule; empty if it is long enough."""
        length = self.interval * len(self.result.time)
        if length >= seconds * (1.0 - 1e-9):
            return ""
        return f"the record is {length:.3g} s long, the rule needs {seconds:g} s"
