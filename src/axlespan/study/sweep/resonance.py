"""Speeds at which equal distances of a train meet a natural frequency of the structure: v = f d / i."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from axlespan.linalg.eigen import lowest_modes
from axlespan.vehicles import Train

if TYPE_CHECKING:
    from axlespan.study.sweep.study import Study

FloatArray = npt.NDArray[np.float64]

# Frequencies of a structure and orders i that are looked at.
_FREQUENCIES: Final = 3
_ORDERS: Final = 5
# Trains up to which resonances are looked for.
_TRAINS: Final = 40
# Distances that repeat in trains lie here [m]: wheels of a bogie are closer, coaches have up to 30 m.
_SPACINGS: Final = (3.0, 35.0)
_CLOSE: Final = 0.01  # distances that are the same [m]
_MOST_AXLES: Final = 2000


@dataclass(frozen=True, eq=False)
class Resonances:
    """Resonance speeds of a train on a structure."""

    frequencies: FloatArray  # (n_frequency,) [Hz]
    spacing: float  # distance d that repeats in the train [m]

    def speeds(self, order: int) -> FloatArray:
        """V = f d / i for each frequency (n_frequency,) [m/s]."""
        return self.frequencies * self.spacing / order

    def between(self, low: float, high: float) -> list[tuple[int, int, float]]:
        """Frequency number, order and speed of all within bounds [m/s]."""
        return [
            (j, order, float(speed))
            for order in range(1, _ORDERS + 1)
            for j, speed in enumerate(self.speeds(order), 1)
            if low <= speed <= high
        ]

    def summary(self) -> dict[str, Any]:
        """For summary.json."""
        speeds = {f"{order}": self.speeds(order).tolist() for order in range(1, _ORDERS + 1)}
        return {
            "frequencies_hz": self.frequencies.tolist(),
            "spacing_m": self.spacing,
            "speeds_m_per_s_by_order": speeds,
        }


def spacing_of(train: Train, gravity: float = 9.81) -> float | None:
    """The distance [m] at which axles of a train follow each other most often, from 3 to 35 m; None for one without.

    Pairs of axles at the same distance, to a centimeter, count by the product of their loads. Coaches of one length
    give that length; equal axles their distance. Two pairs are no repetition.
    """
    order = np.argsort(train.offsets)
    offsets, loads = train.offsets[order], train.static_forces(gravity)[order]
    if len(offsets) < 3 or len(offsets) > _MOST_AXLES:
        return None
    first, second = np.triu_indices(len(offsets), 1)
    distance = offsets[second] - offsets[first]
    use = (distance >= _SPACINGS[0]) & (distance <= _SPACINGS[1])
    if not use.any():
        return None
    product = (loads[first] * loads[second])[use]
    _, place = np.unique(np.round(distance[use] / _CLOSE).astype(np.int64), return_inverse=True)
    weight, number = np.bincount(place, product), np.bincount(place)
    best = int(np.argmax(np.where(number > 2, weight, 0.0)))
    return float(np.mean(distance[use][place == best])) if number[best] > 2 else None


def resonances_of(study: Study, trains: Sequence[str], most: int) -> Mapping[str, Resonances]:
    """Resonances of named trains, where the study has one structure; of several, on that of the first scenario.

    Nothing is looked for in studies of more than ``most`` structures or in random mixes of trains.
    """
    scenarios = study._scenarios
    ids = np.arange(min(len(scenarios), 100_000), dtype=np.int64)
    _, first = np.unique(scenarios.groups(ids, ("train",)), return_index=True)
    if len(np.unique(scenarios.groups(ids, ("structure",)))) > most or len(first) > _TRAINS:
        return {}
    found: dict[str, Resonances] = {}
    frequencies: FloatArray | None = None
    for number in first.tolist():
        scenario = study.scenario(int(ids[number]))
        built = scenario.built
        if frequencies is None:
            matrices = built.plan.structure
            massive = int(np.count_nonzero(matrices.M.diagonal()))
            frequencies = lowest_modes(matrices.K, matrices.M, min(_FREQUENCIES, massive)).frequencies
        label = scenario.values.get("train")
        name = label if isinstance(label, str) else built.crossing.train_names
        spacing = spacing_of(built.crossing.train, built.crossing.gravity)
        if name in trains and spacing is not None:
            found[name] = Resonances(frequencies, spacing)
    return found
