"""How long a run lasts: until its last wheel has left the structure, in a round number of steps."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing, Run

FloatArray = npt.NDArray[np.float64]


def passage(crossing: Crossing) -> float:
    """Time [s] at which the last wheel leaves the structure.

    Raises
    ------
    InputError
        If it never does.
    """
    latest = 0.0
    for run in crossing.runs:
        lines = [crossing.structure.line(name) for name in dict.fromkeys(run.lines)]
        reach = float(run.train.offsets.max())
        goal = (
            max(line.stop for line in lines)
            if run.course.direction > 0
            else min(line.start for line in lines)
        )

        speeds = run.course.speeds
        if len(speeds.times) == 1 and speeds.speeds[0] > 0.0:
            way = run.course.direction * (goal - run.course.start) + reach
            latest = max(latest, run.course.delay + way / float(speeds.speeds[0]))
            continue

        def left(times: FloatArray, run: Run = run, reach: float = reach, goal: float = goal) -> FloatArray:
            tail = run.course.head(times) - run.course.direction * reach
            return np.asarray(run.course.direction * (tail - goal))

        latest = max(latest, _root(left))
    return latest


def in_round_numbers(steps: int) -> int:
    """A number of steps, rounded up by at most an eighth, so that scenarios side by side end together.

    Examples
    --------
    >>> [in_round_numbers(n) for n in (7, 100, 1000, 1024, 1025)]
    [7, 104, 1024, 1024, 1152]
    """
    unit = 1 << max(0, steps.bit_length() - 4)
    return -(-steps // unit) * unit


def _root(rising: Callable[[FloatArray], FloatArray]) -> float:
    """Where a function that never falls reaches zero: bracketed by powers of 2, then divided by hundreds."""
    times = np.concatenate([[0.0], np.exp2(np.arange(-10.0, 18.0))])
    reached = rising(times) >= 0.0
    if reached[0]:
        return 0.0
    if not reached.any():
        raise InputError("never brings the last wheel off the structure", field="crossing.speed")
    first = int(np.argmax(reached))
    low, high = float(times[first - 1]), float(times[first])
    for _ in range(7):
        times = np.linspace(low, high, 129)
        first = max(1, int(np.argmax(rising(times) >= 0.0)))
        low, high = float(times[first - 1]), float(times[first])
    return high
