"""A load train: axle forces with a name, where they come from and how sure that is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from axlespan.vehicles.simple import axle_loads
from axlespan.vehicles.vehicle import Vehicle

#: Found in sources that agree, or recomputed.
VERIFIED = "verified"
#: Found in one public source.
ONE_SOURCE = "one source"
#: Written down from memory of the standard.
CHECK = "check against the standard"


@dataclass(frozen=True)
class LoadTrain:
    """A named load train or wagon."""

    name: str  # as in case files
    title: str
    make: Callable[[], Vehicle]
    source: str
    certainty: str  # VERIFIED, ONE_SOURCE or CHECK
    note: str = ""
    speed: float | None = None  # that the source gives it [m/s]
    wagon: bool = False  # one of many that make a train

    def vehicle(self) -> Vehicle:
        """All its axles as one group of moving forces."""
        return replace(self.make(), name=self.name)


def from_strings(*vehicles: tuple[Sequence[float], float], count: int = 1) -> Vehicle:
    """Vehicles one behind another as one group of forces.

    Parameters
    ----------
    vehicles : (lengths, load)
        Front overhang, distances from axle to axle, and rear overhang [m]; the force of each axle [N].
    count : int
        How often they are repeated.
    """
    positions: list[float] = []
    loads: list[float] = []
    begin = 0.0
    for lengths, load in vehicles * count:
        places = begin + np.cumsum(lengths)
        positions += places[:-1].tolist()
        loads += [load] * (len(lengths) - 1)
        begin = float(places[-1])
    first = positions[0]
    # Rounded, for sums of decimal numbers are not; the sources have at most four decimals.
    behind = [round(x - first, 6) for x in positions]
    made = axle_loads(loads=loads, positions=behind)
    return replace(made, length=round(begin, 6), overhang=round(first, 6))
