"""Where a worker computes scenarios: it keeps what it has built and factored for the next ones."""

from __future__ import annotations

import json
import time
from collections import OrderedDict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

import axlespan
from axlespan.errors import AxlespanError, InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.groundwork import Groundwork
from axlespan.interaction.plan import Plan
from axlespan.interaction.result import Result
from axlespan.interaction.runs import run_plans
from axlespan.running.structure import Structure
from axlespan.standards import Assessment, AtRest, BridgeFacts, assess, bridge_facts
from axlespan.study.build import BuiltCase
from axlespan.study.case import Case
from axlespan.study.sweep.building import Builder
from axlespan.study.sweep.kept import Kept
from axlespan.study.sweep.paths import validated
from axlespan.study.sweep.peaks import COMPLETED, FAILED, INVALID, peaks_of
from axlespan.study.sweep.recipe import Recipe, digest
from axlespan.study.sweep.shards import Histories, histories_of
from axlespan.study.sweep.under_way import Meter, Tell
from axlespan.study.sweep.verdicts import verdict_row

# Structures of which a worker keeps what verdicts need of them, and trains on each.
_BRIDGES, _TRAINS = 8, 64
# Factors and reduced bases that a worker keeps, fewer where they are large [byte].
_LAID, _LAID_BYTES = 2, 1e9


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


@dataclass(frozen=True, eq=False)
class _Bridge:
    """What verdicts need of a structure, and of trains that stand on it."""

    structure: Structure
    facts: BridgeFacts
    _trains: Kept[tuple[Crossing, AtRest]] = field(default_factory=lambda: Kept(_TRAINS))

    @classmethod
    def of(cls, structure: Structure, wanted: Assessment) -> _Bridge:
        """Of a structure, for an assessment."""
        return cls(structure, bridge_facts(structure, wanted))

    def at_rest(self, crossing: Crossing) -> AtRest:
        """What is the same for all speeds of a train."""
        key = tuple((id(run.train), run.course.direction) for run in crossing.runs)
        return self._trains.get((key, crossing.gravity), lambda: (crossing, AtRest()))[1]


class Workshop:
    """Builds and runs scenarios of one recipe."""

    def __init__(self, recipe: Recipe) -> None:
        if recipe.version != axlespan.__version__:
            raise InputError(
                f"this worker has axlespan {axlespan.__version__}, and the run was started by {recipe.version}",
                fix="Install the same version everywhere",
            )
        self.recipe = recipe
        self._builder = Builder(recipe)
        self._bridges: Kept[_Bridge] = Kept(_BRIDGES)
        self._laid: list[Groundwork] = []  # what was used last is last

    def build(self, values: Sequence[Any]) -> BuiltCase:
        """Build a scenario from the values of the paths.

        Raises
        ------
        InputError
            If they make no case, located in the base.
        """
        return self._builder.build(self.recipe.composed(values))

    # --- running -------------------------------------------------------------------------------

    def run(self, task: Task, tell: Tell | None = None) -> Done:
        """Compute the scenarios of a task; ``tell`` hears how many scenarios' worth of steps have been made."""
        begun, meter = time.process_time(), None if tell is None else Meter(tell)
        rows: dict[int, dict[str, Any]] = {}
        ready: dict[Any, list[tuple[int, BuiltCase]]] = {}
        for number, values, labels in zip(task.ids, task.values, task.labels, strict=True):
            rows[number] = row = {"id": number, "version": axlespan.__version__}
            try:
                data = self.recipe.composed(values)
                row["provenance"] = self.recipe.provenance(data, number)
                built = self._builder.build(data)
            except (AxlespanError, ArithmeticError, MemoryError) as error:
                row |= {"outcome": INVALID, "reason": _words(error), **self._inputs(None, values, labels)}
                continue
            row |= self._inputs(built.loaded.case, values, labels)
            row |= _facts(built, row)
            ready.setdefault(together(built.plan), []).append((number, built))
        results: dict[int, tuple[Result, Plan]] = {}
        for group in ready.values():
            for number, result, built, seconds, reason in self._computed(group, meter):
                rows[number] |= self._outcome(result, built, seconds, reason)
                if result is not None and rows[number]["outcome"] == COMPLETED:
                    results[number] = (result, built.plan)
            if meter is not None:
                meter.add(len(group))
        histories = histories_of(self.recipe.kept, results)
        records = self._records(results)
        ordered = [rows[number] for number in task.ids]
        return Done(task.number, ordered, histories, records, time.process_time() - begun)

    def _computed(
        self, group: list[tuple[int, BuiltCase]], meter: Meter | None
    ) -> list[tuple[int, Result | None, BuiltCase, float, str]]:
        """Results of scenarios that go side by side; where all break off, each is tried alone."""
        begun = time.perf_counter()
        plans = [built.plan for _, built in group]
        try:
            progress = None if meter is None else meter.of(plans)
            results = run_plans(plans, progress, self._groundwork(plans))
        except (AxlespanError, ArithmeticError, ValueError, MemoryError) as error:
            if len(group) > 1:
                return [one for item in group for one in self._computed([item], meter)]
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
            if isinstance(known, tuple) and len(known) == 1 and not isinstance(value, list | tuple):
                known = known[0]  # a single value where a list may stand
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
        wanted, crossing = asked.wanted(), built.crossing
        key = (id(crossing.structure), repr(wanted))
        bridge = self._bridges.get(key, lambda: _Bridge.of(crossing.structure, wanted))
        at_rest = bridge.at_rest(crossing)
        return verdict_row(assess(result, crossing, wanted, facts=bridge.facts, at_rest=at_rest))

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


def goes_alone(plan: Plan) -> bool:
    """Whether a scenario is computed by itself, with nothing beside it."""
    # bases that are refined until the worst of a group is good enough would depend on the group
    s = plan.settings
    return s.coupling != "direct" or s.basis_tolerance is not None or plan.is_nonlinear


def together(plan: Plan) -> Any:
    """What scenarios must share to be computed side by side."""
    s = plan.settings
    basis = s.basis if isinstance(s.basis, str) else id(s.basis)
    alone = id(plan) if goes_alone(plan) else None
    footprint = (
        (s.footprint, s.sleepers) if basis != "full" else None
    )  # the basis holds the shapes of its loads
    structure = id(plan.crossing.structure)
    return (structure, s.time_step, s.method, s.coupling, s.solver, basis, s.basis_modes, footprint, alone)


def _facts(built: BuiltCase, row: Mapping[str, Any]) -> dict[str, Any]:
    speed = float(np.abs(built.plan.rows.motion(0.0)[0]).max(initial=0.0))
    label = row.get("train")
    return {
        "train_name": label if isinstance(label, str) else built.crossing.train_names,
        "speed_m_per_s": speed,
    }


def _words(error: BaseException) -> str:
    text = str(error) or (
        "there is not enough memory" if isinstance(error, MemoryError) else type(error).__name__
    )
    return " ".join(text.split())[:500]


_WORKSHOPS: OrderedDict[str, Workshop] = OrderedDict()


def workshop_of(recipe: Recipe) -> Workshop:
    """The workshop of a recipe in this process, which keeps what it builds."""
    key = digest([recipe.data, recipe.paths, recipe.folder, repr(recipe.kept)])
    key += repr((recipe.recording, recipe.passage, recipe.version, recipe.source.file))
    if key not in _WORKSHOPS:
        while len(_WORKSHOPS) >= 2:
            _WORKSHOPS.popitem(last=False)
        _WORKSHOPS[key] = Workshop(recipe)
    return _WORKSHOPS[key]


def forget() -> None:
    """Let go of all that workshops of this process keep."""
    _WORKSHOPS.clear()


def run_task(task: Task, tell: Tell | None = None) -> Done:
    """Compute a task in this process; see :meth:`Workshop.run`."""
    return workshop_of(task.recipe).run(task, tell)
