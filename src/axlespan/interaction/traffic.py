"""Whether the trains of a crossing get along: nobody stands in another vehicle, nobody runs into another train."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing, Run

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Meeting:
    """Two trains, by their numbers, at the same place of a line."""

    trains: tuple[int, int]
    line: str
    time: float  # when it begins [s]
    opposite: bool


def meetings(crossing: Crossing, end: float) -> Iterator[Meeting]:
    """Pairs of trains that are at the same place of a line at some time until ``end`` [s]."""
    for (i, one), (j, other) in combinations(enumerate(crossing.runs), 2):
        shared = [
            name
            for name in dict.fromkeys(map(crossing.line_name, one.lines))
            if name in map(crossing.line_name, other.lines)
        ]
        time = _first_touch(one, other, end) if shared else None
        if time is not None:
            opposite = one.course.direction != other.course.direction
            yield Meeting((i + 1, j + 1), shared[0], time, opposite)


def require_clear_tracks(crossing: Crossing, end: float) -> list[str]:
    """Refuse trains that run into each other; say where trains that meet are taken to have a track each.

    Trains that run in opposite directions on one line are believed: in a model of one line they stand for the two
    tracks of a bridge.

    Raises
    ------
    InputError
        If vehicles of one train overlap, two trains stand on one another, or one catches up with another.
    """
    for run in crossing.runs:
        run.train.require_apart(run.lines)
    notes = []
    for meeting in meetings(crossing, end):
        first, second = meeting.trains
        if meeting.opposite:
            notes.append(
                f"trains {first} and {second} meet on the line '{meeting.line}' at t = {meeting.time:.4g} s: they are taken "
                "to run on two tracks that it stands for"
            )
            continue
        field = f"others.{second - 2}"
        if meeting.time <= 0.0:
            raise InputError(
                f"stands on train {first} at t = 0, on the line '{meeting.line}'",
                field=f"{field}.start",
                fix="Move its start, give it a delay, or another line",
            )
        raise InputError(
            f"is at the same place as train {first} from t = {meeting.time:.4g} s on, on the line '{meeting.line}'",
            field=f"{field}.speed",
            fix="Change a speed or a start, give it a delay, or another line",
        )
    return notes


def _first_touch(one: Run, other: Run, end: float) -> float | None:
    """The first time [s] at which two trains share a place; None if never.

    Between the corners of their histories the distance of two ends is a quadratic in time.
    """
    corners = [0.0, end]
    for run in (one, other):
        corners += (run.course.speeds.times + run.course.delay).tolist()
    times = np.unique(np.clip(corners, 0.0, end))
    if _apart(one, other, np.zeros(1))[0] <= 0.0:
        return 0.0
    for begin, stop in pairwise(times.tolist()):
        at = np.array([begin, 0.5 * (begin + stop), stop])
        found = [
            root
            for values in _gaps(one, other, at)
            for root in _roots(at, values)
            if _apart(one, other, np.array([root]))[0] <= 1e-9
        ]
        if found:
            return float(min(found))
    return None


def _ends(run: Run, time: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest position of a train [m]."""
    head, tail = run.train.ends
    first = run.course.head(time) + run.course.direction * head
    last = run.course.head(time) - run.course.direction * tail
    return np.minimum(first, last), np.maximum(first, last)


def _gaps(one: Run, other: Run, time: FloatArray) -> tuple[FloatArray, FloatArray]:
    """From each train's highest position to the other's lowest [m]; both negative where they overlap."""
    (low, high), (other_low, other_high) = _ends(one, time), _ends(other, time)
    return other_low - high, low - other_high


def _apart(one: Run, other: Run, time: FloatArray) -> FloatArray:
    """Clear distance of two trains [m]; zero or less where they overlap."""
    return np.maximum(*_gaps(one, other, time))


def _roots(at: FloatArray, values: FloatArray) -> list[float]:
    """Zeros of the quadratic through three points, between the first and the last."""
    span = at[2] - at[0]
    x = (at - at[0]) / span
    polynomial = np.polynomial.Polynomial.fit(x, values, 2, domain=[0.0, 1.0], window=[0.0, 1.0])
    scale = float(np.abs(values).max())
    coefficients = np.where(np.abs(polynomial.coef) < 1e-12 * max(scale, 1e-30), 0.0, polynomial.coef)
    if not np.any(coefficients[1:]):
        return []
    roots = np.polynomial.Polynomial(np.trim_zeros(coefficients, "b")).roots()
    real = roots[np.abs(np.imag(roots)) < 1e-9].real
    return [float(at[0] + span * r) for r in real if -1e-9 <= r <= 1.0 + 1e-9]
