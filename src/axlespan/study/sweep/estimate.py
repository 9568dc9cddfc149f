"""What a study will take, before it runs: hours from a short timed trial, bytes from counting."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Final

import numpy as np
import numpy.typing as npt

from axlespan.compiled import when_compiling
from axlespan.errors import InputError
from axlespan.interaction.plan import Plan
from axlespan.interaction.runs import run_plans
from axlespan.study.build import BuiltCase
from axlespan.study.faults import InputErrors
from axlespan.study.size import size_of
from axlespan.study.sweep.peaks import has_passed
from axlespan.study.sweep.planning import (
    MOST_LANES,
    MOST_OF_LARGE,
    count_factorizations,
    count_tasks,
    lanes_for,
)
from axlespan.study.sweep.recipe import Recipe
from axlespan.study.sweep.scenarios import Scenarios
from axlespan.study.sweep.workshop import Workshop, goes_alone, together, workshop_of

FloatArray = npt.NDArray[np.float64]

# D.o.f. beyond which a structure is a large one.
_LARGE: Final = 10_000

# Scenarios that are built for an estimate, steps and lanes of a trial.
_BUILT: Final = 24
_STEPS: Final = 256
_LANES: Final = 8

# A row of the table as Parquet keeps it, for each column [byte]; measured at 5 to 9 for random studies.
_ROW: Final = 9.0
# What gzip leaves of histories that no step repeats; measured 0.55 to 0.75.
_PACKED: Final = 0.7
# Copies of the histories of a batch that are in memory at a time: recorder, result, shard.
_COPIES: Final = 3.0
# What a scenario in a batch needs beside: tapes that wait to be worked up, tables [byte].
_GATHERED: Final = 1e6
# Share of the free memory that batches may take, and the most [byte] for one worker.
_SHARE, _LARGEST = 0.4, 2e9


@dataclass(frozen=True)
class Trial:
    """What a few scenarios of a study are like."""

    steps: float  # mean number
    alone: float  # of a step of one scenario [s]
    beside: float  # of each further scenario side by side [s]
    building: float  # of a scenario, its structure at hand [s]
    structure: float  # of a structure: building and factoring [s]
    memory: float  # of a scenario in a batch [byte]
    kept: float  # of histories and records of a scenario on the disk [byte]
    built: int  # how many were looked at
    passed: int  # how many of them have the train off the structure at their end
    cautions: tuple[str, ...]
    one_by_one: bool = False  # whether scenarios cannot advance side by side
    large: bool = False  # whether the structure is a large one


@dataclass(frozen=True)
class Estimate:
    """What a study takes."""

    scenarios: int
    factorizations: int
    batches: int
    lanes: int
    seconds: float  # of all workers together, divided by their number
    disk: float  # [byte]
    memory: float  # of one worker beside the program itself [byte]
    one_by_one: bool = False  # whether scenarios of a batch go one after another


def try_out(
    recipe: Recipe,
    scenarios: Scenarios,
    located: Callable[[InputError, int], InputError],
    *,
    timed: bool = True,
    forgiving: bool = False,
) -> Trial:
    """Build some scenarios of a study, and time the first steps of a few.

    Parameters
    ----------
    located : callable
        Points an error of a scenario to the value that is to blame.
    forgiving : bool
        Whether some may fail, as in a random study, whose table then says why.

    Raises
    ------
    InputError
        If one of them cannot be built, or none.
    """
    workshop = workshop_of(recipe)
    ids = np.unique(np.linspace(0, len(scenarios) - 1, _BUILT).astype(np.int64)).tolist()
    built: list[BuiltCase] = []
    faults: list[InputError] = []
    values = scenarios.values(ids)
    good = values[0]
    for number, own in zip(ids, values, strict=True):
        try:
            built.append(workshop.build(own))
            good = own
        except InputError as error:
            faults.append(located(error, number))
    if faults and not (forgiving and built):
        raise InputErrors(faults[:1] if built else faults)
    again = _time_of(partial(workshop.build, good)) if timed else 0.0
    afresh = _time_of(partial(Workshop(recipe).build, good)) if timed else 0.0
    plans = [one.plan for one in built]
    alone, beside, start, first = _timed(plans) if timed else (0.0, 0.0, 0.0, 0.0)
    notes = dict.fromkeys(text for one in built for text in one.cautions)
    return Trial(
        steps=float(np.mean([plan.settings.steps for plan in plans])),
        alone=alone,
        beside=beside,
        building=again + start,
        structure=max(0.0, afresh - again) + first,
        memory=max(_COPIES * size_of(plan).result for plan in plans) + _GATHERED,
        kept=float(np.mean([_kept_bytes(recipe, plan) for plan in plans])),
        built=len(plans),
        passed=sum(has_passed(plan) for plan in plans),
        cautions=tuple(notes),
        one_by_one=any(goes_alone(plan) for plan in plans),
        large=any(plan.structure.size > _LARGE for plan in plans),
    )


def _time_of(work: Callable[[], object]) -> float:
    """Time of some work [s]; once more if loops were compiled in it, which happens once on a machine."""
    compiled: list[bool] = []
    for _ in range(2):
        begun = time.perf_counter()
        with when_compiling(compiled.append):
            work()
        passed = time.perf_counter() - begun
        if not compiled:
            break
    return passed


def _timed(plans: Sequence[Plan]) -> tuple[float, float, float, float]:
    """Times [s]: of a step of one scenario, of each further one beside it, of the start of one, and of the first."""
    first = together(plans[0])
    some = [plan for plan in plans if together(plan) == first][:_LANES]

    def run(count: int, steps: int) -> float:
        own = [_short(some[k % len(some)], steps) for k in range(count)]
        return _time_of(lambda: run_plans(own))

    few = 2
    for count in (1, _LANES):
        run(count, few)  # what is compiled or loaded at the first call
    steps = min(_STEPS, *(plan.settings.steps for plan in some))
    if steps <= few:
        return run(1, steps) / steps, 0.0, 0.0, 0.0
    start_one, start_many = run(1, few), run(_LANES, few)
    one = (run(1, steps) - start_one) / (steps - few)
    many = (run(_LANES, steps) - start_many) / (steps - few)
    per_start = max(0.0, (start_many - start_one) / (_LANES - 1))
    return max(one, 1e-9), max((many - one) / (_LANES - 1), 0.0), per_start, max(0.0, start_one - per_start)


def _short(plan: Plan, steps: int) -> Plan:
    return replace(plan, settings=replace(plan.settings, steps=min(steps, plan.settings.steps), fields=()))


def _kept_bytes(recipe: Recipe, plan: Plan) -> float:
    settings, total = plan.settings, 0.0
    sensors = len(settings.sensors)
    if recipe.kept is not None:
        wide = {
            "contact_force": plan.rows.n_contact,
            "vehicle_acceleration": plan.fleet.matrices.size,
        }
        values = sum(wide.get(name, sensors) for name in recipe.kept.variables)
        total += 8.0 * _PACKED * values * (settings.steps // (settings.every * recipe.kept.every) + 1)
    if recipe.recording is not None:
        total += 8.0 * _PACKED * sensors * settings.steps * settings.time_step * recipe.recording.rate
    return total


def lanes_in_memory(trial: Trial, workers: int, free: float) -> int:
    """Scenarios in a batch that the memory of one worker holds; few where they go one by one, as a batch is lost whole."""
    room = min(_SHARE * free / workers, _LARGEST)
    most = MOST_OF_LARGE if trial.large else MOST_LANES
    return int(np.clip(room / trial.memory, 1, _LANES if trial.one_by_one else most))


def estimate(
    trial: Trial, scenarios: Scenarios, columns: int, *, workers: int = 1, free: float = 4e9
) -> Estimate:
    """What a study takes on so many workers."""
    n = len(scenarios)
    ids = np.arange(n, dtype=np.int64)
    lanes = lanes_for(n, workers, lanes_in_memory(trial, workers, free))
    batches, factors = count_tasks(scenarios, ids, lanes), count_factorizations(scenarios, ids)
    # groups smaller than a batch are computed one after the other within it
    groups = max(batches, factors)
    march = trial.steps * (groups * trial.alone + max(0, n - groups) * trial.beside)
    work = march + n * trial.building + factors * trial.structure
    wide = min(lanes, max(1, -(-n // factors)))
    return Estimate(
        n,
        factors,
        batches,
        lanes,
        work / workers,
        n * (columns * _ROW + trial.kept),
        wide * trial.memory,
        trial.one_by_one,
    )
