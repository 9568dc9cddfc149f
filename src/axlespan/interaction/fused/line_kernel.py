"""What wheels and lines do to each other in compiled steps: rows (n_wheel, n_local) of places and weights.

Only to be imported where numba is. Indices are unsigned, since a signed one would be asked at each access whether it
counts from the end.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from axlespan.compiled import as_compiled


@as_compiled
def standing(weights: Any, on: Any) -> int:
    """Write down which wheels with weights (n_wheel, n_local) load the line; how many they are."""
    count = 0
    for r in range(weights.shape[0]):
        for m in range(weights.shape[1]):
            if weights[r, m] != 0.0:
                on[count] = r
                count += 1
                break
    return count


@as_compiled
def add_line(
    on: Any, place: Any, weights: Any, into: Any, late: Any, state: Any, x: Any, w: int, gap: Any
) -> None:
    """Add to the gaps what the line does under the wheels on it without new contact forces."""
    dt, late_u, _, u_from_a, _ = late
    u, v, a = state
    for one in on:
        r, height = np.uint64(one), 0.0
        for m in range(place.shape[1]):
            if weights[r, m] != 0.0:
                i = np.uint64(place[r, m])
                height += weights[r, m] * (
                    u[i] + (dt * v[i] + late_u * a[i]) + u_from_a * x[i + np.uint64(w)]
                )
        gap[into[r]] += height


@as_compiled
def add_load(
    on: Any, place: Any, weights: Any, into: Any, forces: Any, factor: float, shift: int, load: Any
) -> Any:
    """Add loads of the wheels on the line; the lowest place and the highest one that were loaded."""
    low, high = load.shape[0], -1
    for one in on:
        r = np.uint64(one)
        scaled = factor * forces[into[r]]
        for m in range(place.shape[1]):
            if weights[r, m] != 0.0:
                at = place[r, m] + shift
                load[np.uint64(at)] += weights[r, m] * scaled
                low, high = min(low, at), max(high, at)
    return low, high


@as_compiled
def clear(on: Any, place: Any, weights: Any, load: Any) -> None:
    """Take away what the wheels on the line have loaded."""
    for one in on:
        r = np.uint64(one)
        for m in range(place.shape[1]):
            if weights[r, m] != 0.0:
                load[np.uint64(place[r, m])] = 0.0
