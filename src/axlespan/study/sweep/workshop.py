"""Where a worker computes scenarios: it keeps the structures, trains and factors that it has built.

What is kept never changes a number: a structure that was built before is the same as one that is built again.
"""

from __future__ import annotations

import json
import math
import time
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final, TypeVar

import numpy as np
import numpy.typing as npt

import axlespan
from axlespan.errors import AxlespanError, InputError
from axlespan.interaction.crossing import Crossing, Run
from axlespan.interaction.groundwork import Groundwork
from axlespan.interaction.plan import Plan
from axlespan.interaction.result import Result
from axlespan.interaction.simulate import run_plans
from axlespan.standards import assess
from axlespan.standards.bridge_facts import BridgeFacts, bridge_facts
from axlespan.study.build import BuiltCase, build
from axlespan.study.build_checks import require_stable
from axlespan.study.build_structures import structure_of
from axlespan.study.built import BuiltStructure
from axlespan.study.case import Case
from axlespan.study.loader import LoadedCase
from axlespan.study.pointing import pointing
from axlespan.study.sweep.paths import validated
from axlespan.study.sweep.peaks import COMPLETED, FAILED, INVALID, peaks_of
from axlespan.study.sweep.recipe import Recipe, digest
from axlespan.study.sweep.shards import Histories, histories_of
from axlespan.study.sweep.validation import case_of
from axlespan.study.sweep.verdicts import verdict_row
from axlespan.vehicles import Train

FloatArray = npt.NDArray[np.float64]
T = TypeVar("T")

# Structures, trains and factors that a worker keeps.
_STRUCTURES: Final = 8
_TRAINS: Final = 64
# Factors and reduced bases that a worker keeps, fewer where they are large [byte].
_LAID, _LAID_BYTES = 2, 1e9

# Steps of a scenario at which its energy is balanced: a few of each are many of a study.
_ENERGY_SAMPLES: Final = 4


@dataclass(frozen=True, eq=False)
class Task:
    """Scenarios for one worker to compute."""

    number: int
    recipe: Recipe
    ids: tuple[int, ...]
    values: Sequence[tuple[Any, ...]]  # of the paths of the recipe, scenario by scenario
    labels: Sequence[tuple[str | None, ...]]


@dataclass(frozen=True, eq=False)
class Done:
    """What came of a task."""

    number: int
    rows: list[dict[str, Any]]
    histories: Histories | None = None  # of the completed scenarios
    records: Histories | None = None
    worker_seconds: float = 0.0  # processor time


@dataclass(eq=False)
class _Kept:
    """The few values that were used last."""

    most: int
    values: OrderedDict[Any, Any] = field(default_factory=OrderedDict)

    def get(self, key: Any, make: Callable[[], T]) -> T:
        if key not in self.values:
            value = make()
            while len(self.values) >= self.most:
                self.values.popitem(last=False)
            self.values[key] = value
        self.values.move_to_end(key)
        kept: T = self.values[key]
        return kept


class Workshop:
    """Builds and runs scenarios of one recipe."""

    def __init__(self, recipe: Recipe) -> None:
        if recipe.version != axlespan.__version__:
            raise InputError(
                f"this worker has axlespan {axlespan.__version__}, and the run was started by {recipe.version}",
                fix="Install the same version everywhere",
            )
        self.recipe = recipe
        self._structures, self._trains = _Kept(_STRUCTURES), _Kept(_TRAINS)
        self._bridges = _Kept(_STRUCTURES)  # facts for their verdicts
        self._laid: list[Groundwork] = []  # what was used last is last

    # --- building ------------------------------------------------------------------------------

    def build(self, values: Sequence[Any]) -> BuiltCase:
        """Build a scenario from the values of the paths.

        Raises
        ------
        InputError
            If they make no case, located in the base.
        """
        data = self.recipe.composed(values)
        case = case_of(self.recipe, data)
        loaded = LoadedCase(case, self.recipe.source, Path(self.recipe.folder))
        made: BuiltStructure = self._structures.get(_key(data["structure"]), lambda: self._structure(loaded))
        key = (_key([data["train"], case.analysis.gravity, case.analysis.vehicles]), id(made))
        return self._built(loaded, made, key)

    def _structure(self, loaded: LoadedCase) -> BuiltStructure:
        with pointing(loaded, "structure"):
            made = structure_of(loaded.case.structure)
            require_stable(made.structure, loaded.case.structure)
        return made

    def _built(self, loaded: LoadedCase, made: BuiltStructure, key: Any) -> BuiltCase:
        train: Train | None = self._trains.values.get(key)
        lasting = None if self.recipe.passage is None else self._steps(loaded.case)
        built = build(loaded, made=made, train=train, lasting=lasting)
        settings = replace(built.plan.settings, energy_samples=_ENERGY_SAMPLES)
        built = replace(built, plan=replace(built.plan, settings=settings))
        if train is None:
            self._trains.get(key, lambda: built.crossing.train)
        return built

    def _steps(self, case: Case) -> Callable[[Crossing], int]:
        after, dt = self.recipe.passage or 0.0, case.analysis.time_step

        def steps(crossing: Crossing) -> int:
            return in_round_numbers(max(1, math.ceil((passage(crossing) + after) / dt * (1.0 - 1e-12))))

        return steps

    # --- running -------------------------------------------------------------------------------

    def run(self, task: Task) -> Done:
        """Compute the scenarios of a task."""
        begun = time.process_time()
        rows: dict[int, dict[str, Any]] = {}
        ready: dict[Any, list[tuple[int, BuiltCase]]] = {}
        for number, values, labels in zip(task.ids, task.values, task.labels, strict=True):
            rows[number] = row = {"id": number, "version": axlespan.__version__}
            try:
                data = self.recipe.composed(values)
                row["provenance"] = self.recipe.provenance(data, number)
                built = self.build(values)
            except (AxlespanError, ArithmeticError, MemoryError) as error:
                row |= {"outcome": INVALID, "reason": _words(error), **self._inputs(None, values, labels)}
                continue
            row |= self._inputs(built.loaded.case, values, labels)
            row |= _facts(built, row)
            ready.setdefault(together(built.plan), []).append((number, built))
        results: dict[int, tuple[Result, Plan]] = {}
        for group in ready.values():
            for number, result, built, seconds, reason in self._computed(group):
                rows[number] |= self._outcome(result, built, seconds, reason)
                if result is not None and rows[number]["outcome"] == COMPLETED:
                    results[number] = (result, built.plan)
        histories = histories_of(self.recipe.kept, results)
        records = self._records(results)
        ordered = [rows[number] for number in task.ids]
        return Done(task.number, ordered, histories, records, time.process_time() - begun)

    def _computed(
        self, group: list[tuple[int, BuiltCase]]
    ) -> list[tuple[int, Result | None, BuiltCase, float, str]]:
        """Results of scenarios that go side by side; where all break off, each is tried alone."""
        begun = time.perf_counter()
        plans = [built.plan for _, built in group]
        try:
            results = run_plans(plans, groundwork=self._groundwork(plans))
        except (AxlespanError, ArithmeticError, ValueError, MemoryError) as error:
            if len(group) > 1:
                return [one for item in group for one in self._computed([item])]
            number, built = group[0]
            return [(number, None, built, time.perf_counter() - begun, _words(error))]
        share = (time.perf_counter() - begun) / len(group)
        return [(n, result, built, share, "") for (n, built), result in zip(group, results, strict=True)]

    def _groundwork(self, plans: Sequence[Plan]) -> Groundwork | None:
        """The factor or basis of a structure, from an earlier task if there was one; none where it is refined."""
        if plans[0].settings.basis_tolerance is not None:
            return None
        found = next((laid for laid in self._laid if laid.serves(plans)), None)
        if found is None:
            while self._laid and (
                len(self._laid) >= _LAID or sum(laid.nbytes for laid in self._laid) > _LAID_BYTES
            ):
                self._laid.pop(0)
            found = Groundwork.of(plans)
        self._laid = [*(laid for laid in self._laid if laid is not found), found]
        return found

    def _inputs(
        self, case: Case | None, values: Sequence[Any], labels: Sequence[str | None]
    ) -> dict[str, Any]:
        """The values of the paths in SI units, as columns."""
        row = {}
        for path, value, label in zip(self.recipe.paths, values, labels, strict=True):
            known = label if label is not None else value if case is None else validated(case, path)
            simple = known is None or isinstance(known, str | int | float)
            row[path] = known if simple else json.dumps(value, default=str)
        return row

    def _outcome(
        self, result: Result | None, built: BuiltCase, seconds: float, reason: str
    ) -> dict[str, Any]:
        row: dict[str, Any] = {"seconds": seconds, "steps": built.plan.settings.steps}
        if result is None or result.outcome.code != "completed":
            return {**row, "outcome": FAILED, "reason": reason or (result.outcome.message if result else "")}
        return {
            **row,
            "outcome": COMPLETED,
            "reason": "",
            **peaks_of(result, built.plan),
            **self._verdicts(result, built),
        }

    def _verdicts(self, result: Result, built: BuiltCase) -> dict[str, Any]:
        """Verdicts by the rules that the case asks for; facts of a bridge are the same for all its crossings."""
        asked = built.loaded.case.assessment
        if asked is None:
            return {}
        wanted, structure = asked.wanted(), built.crossing.structure
        key = (id(structure), repr(wanted))
        kept: tuple[Any, BridgeFacts] = self._bridges.get(
            key, lambda: (structure, bridge_facts(structure, wanted))
        )
        return verdict_row(assess(result, built.crossing, wanted, facts=kept[1]))

    def _records(self, results: Mapping[int, tuple[Result, Plan]]) -> Histories | None:
        recording = self.recipe.recording
        if recording is None:
            return None
        found = {}
        for number, (result, plan) in results.items():
            values = getattr(result, recording.quantity)
            found[number] = recording.record(values, plan.settings.time_step, number)
        sensors = next(iter(results.values()))[0].sensor if results else ()
        return Histories(
            tuple(found),
            1.0 / recording.rate,
            {recording.quantity: ("sensor", tuple(sensors), list(found.values()))},
        )


def together(plan: Plan) -> Any:
    """What scenarios must share to be computed side by side."""
    s = plan.settings
    basis = s.basis if isinstance(s.basis, str) else id(s.basis)
    # bases that are refined until the worst of a group is good enough would depend on the group
    alone = id(plan) if s.coupling != "direct" or s.basis_tolerance is not None else None
    footprint = (
        (s.footprint, s.sleepers) if basis != "full" else None
    )  # the basis holds the shapes of its loads
    structure = id(plan.crossing.structure)
    return (structure, s.time_step, s.method, s.coupling, s.solver, basis, s.basis_modes, footprint, alone)


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


def _facts(built: BuiltCase, row: Mapping[str, Any]) -> dict[str, Any]:
    speed = float(np.abs(built.plan.rows.motion(0.0)[0]).max(initial=0.0))
    label = row.get("train")
    return {
        "train_name": label if isinstance(label, str) else built.crossing.train_names,
        "speed_m_per_s": speed,
    }


def _key(data: Any) -> str:
    return digest(data)


def _words(error: BaseException) -> str:
    text = str(error) or (
        "there is not enough memory" if isinstance(error, MemoryError) else type(error).__name__
    )
    return " ".join(text.split())[:500]


_WORKSHOPS: OrderedDict[str, Workshop] = OrderedDict()


def run_task(task: Task) -> Done:
    """Compute a task in this process, which keeps what it builds for the next one."""
    key = digest([task.recipe.data, task.recipe.paths, task.recipe.folder, repr(task.recipe.kept)])
    key += repr((task.recipe.recording, task.recipe.passage, task.recipe.version, task.recipe.source.file))
    if key not in _WORKSHOPS:
        while len(_WORKSHOPS) >= 2:
            _WORKSHOPS.popitem(last=False)
        _WORKSHOPS[key] = Workshop(task.recipe)
    return _WORKSHOPS[key].run(task)
