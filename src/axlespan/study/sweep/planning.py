"""Which scenarios are computed side by side, and in which order, so that a structure is factored once."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Final

import numpy as np
import numpy.typing as npt

from axlespan.study.sweep.recipe import Recipe
from axlespan.study.sweep.scenarios import Scenarios
from axlespan.study.sweep.workshop import Task

IntArray = npt.NDArray[np.int64]

MOST_LANES: Final = 8
"""Most scenarios side by side: beyond, what they work on does not fit into a processor's cache any more."""

MOST_OF_LARGE: Final = 32
"""The same for large structures, whose factor takes longer to read than all else."""

# Scenarios that the compiled loop takes at a time: tasks of whole ones leave none half empty.
_AT_A_TIME: Final = 8

# Tasks for each worker, so that they end at about the same time, and the fewest scenarios of one.
_TASKS_EACH, _FEWEST = 4, 8


def lanes_for(scenarios: int, workers: int, most: int = MOST_LANES) -> int:
    """Scenarios in a task: as many as memory allows, fewer where workers would be idle."""
    if workers == 1:
        return max(1, most)
    fair = math.ceil(scenarios / (_TASKS_EACH * workers))
    return max(1, min(most, max(fair, min(_FEWEST, math.ceil(scenarios / workers)))))


def ordered(scenarios: Scenarios, ids: IntArray) -> tuple[IntArray, IntArray, IntArray]:
    """Ids in the order in which they are computed, with numbers of what must be shared and of their structure."""
    apart = scenarios.groups(ids, ("analysis", "output"))
    structure = scenarios.groups(ids, ("structure",))
    train = scenarios.groups(ids, ("train",))
    # side by side go scenarios that last about as long: what ends early makes the others begin anew
    speed = scenarios.amounts(ids, "crossing.speed")
    order = np.lexsort((ids, train, speed, structure, apart))
    return ids[order], apart[order], structure[order]


def tasks(recipe: Recipe, scenarios: Scenarios, ids: IntArray, lanes: int) -> Iterator[Task]:
    """Tasks of at most so many scenarios; one task may hold several small structures."""
    sequence, apart, structure = ordered(scenarios, ids)
    for number, (begin, end) in enumerate(_cuts(apart, structure, lanes)):
        own = sequence[begin:end].tolist()
        yield Task(number, recipe, tuple(own), scenarios.values(own), scenarios.labels(own))


def count_tasks(scenarios: Scenarios, ids: IntArray, lanes: int) -> int:
    """Number of tasks."""
    _, apart, structure = ordered(scenarios, ids)
    return sum(1 for _ in _cuts(apart, structure, lanes))


def count_factorizations(scenarios: Scenarios, ids: IntArray) -> int:
    """Number of structures and time steps that differ."""
    _, apart, structure = ordered(scenarios, ids)
    return len(np.unique(np.column_stack([apart, structure]), axis=0))


def _cuts(apart: IntArray, structure: IntArray, lanes: int) -> Iterator[tuple[int, int]]:
    """Where tasks begin and end: at changes of what must be shared, and of structures where that pays."""
    n = len(apart)
    changes = np.flatnonzero((np.diff(structure) != 0) | (np.diff(apart) != 0)) + 1
    edges = np.concatenate([[0], changes, [n]]) if n else np.zeros(1, dtype=np.int64)
    begin = 0
    for left, right in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        new = left > begin and apart[left] != apart[begin]
        if left > begin and (new or right - begin > lanes):
            yield begin, left
            begin = left
        if right - left > lanes:
            yield from itertools.pairwise(_marks(left, right, lanes))
            begin = right
    if begin < n:
        yield begin, n


def _marks(left: int, right: int, lanes: int) -> list[int]:
    """Cuts of a run of scenarios into tasks of about the same size, whole multiples where that goes."""
    pieces, unit = math.ceil((right - left) / lanes), _AT_A_TIME if lanes % _AT_A_TIME == 0 else 1
    units = math.ceil((right - left) / unit)
    marks = left + unit * np.linspace(0, units, pieces + 1).round().astype(int)
    return [int(mark) for mark in np.minimum(marks, right)]
