"""A study: many scenarios around one case, from a file or from Python."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, replace
from functools import cached_property
from math import prod
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from axlespan.card import Card, Shown, some
from axlespan.errors import InputError
from axlespan.interaction.result import Result
from axlespan.interaction.runs import run_plan
from axlespan.io.strict_json import to_json
from axlespan.study.build import BuiltCase
from axlespan.study.case import Case
from axlespan.study.case_train import library_names
from axlespan.study.faults import InputErrors
from axlespan.study.source import Source
from axlespan.study.sweep.answers import Answers
from axlespan.study.sweep.columns import columns_of
from axlespan.study.sweep.estimate import Estimate, Trial, estimate, lanes_in_memory, try_out
from axlespan.study.sweep.executors import Executor, InProcess, Lost, Processes
from axlespan.study.sweep.node import Node
from axlespan.study.sweep.planning import lanes_for, tasks
from axlespan.study.sweep.plausible import doubts
from axlespan.study.sweep.recipe import Recipe, digest
from axlespan.study.sweep.scenarios import Scenarios
from axlespan.study.sweep.spec import Spec, load_spec, read_spec
from axlespan.study.sweep.store import Header, Store
from axlespan.study.sweep.validation import MOST, blamed, case_of, validate
from axlespan.study.sweep.workshop import Done, workshop_of
from axlespan.study.yaml_tree import read_yaml

if TYPE_CHECKING:
    import pandas

#: Most scenarios of one study: all of them are counted, ordered and listed in memory.
MOST_SCENARIOS = 10_000_000

#: Called with the numbers of scenarios that are done, that failed, and of all.
Progress = Callable[[int, int, int], None]

#: Called with how many scenarios' worth of time steps have been made in batches that are not done.
UnderWay = Callable[[float], None]


@dataclass(frozen=True, eq=False)
class Scenario:
    """One scenario of a study."""

    study: Study
    id: int

    @property
    def values(self) -> dict[str, Any]:
        """What it has along the paths that vary, as it is written; trains by their names."""
        scenarios = self.study._scenarios
        values, labels = scenarios.values([self.id])[0], scenarios.labels([self.id])[0]
        return {
            path: value if label is None else label
            for path, value, label in zip(scenarios.paths, values, labels, strict=True)
        }

    @property
    def data(self) -> Mapping[str, Any]:
        """Its case, as one writes it in a case file."""
        return self.study._recipe.composed(self.study._scenarios.values([self.id])[0])

    @cached_property
    def case(self) -> Case:
        """Its case, validated; in SI units."""
        return case_of(self.study._recipe, self.data)

    @cached_property
    def built(self) -> BuiltCase:
        """Its case with structure, train and plan."""
        return workshop_of(self.study._recipe).build(self.study._scenarios.values([self.id])[0])

    @property
    def provenance(self) -> str:
        """Digest of all that its numbers follow from."""
        return self.study._recipe.provenance(self.data, self.id)

    def run(self) -> Result:
        """Compute it alone; the numbers are those that it has in the study.

        Raises
        ------
        AnalysisError
            If it fails.
        """
        return run_plan(self.built.plan)

    def record(self, result: Result | None = None) -> np.ndarray:
        """The record (n_sample, n_sensor) of its sensors, with the noise that it has in the study.

        Raises
        ------
        InputError
            If the study has no ``records``.
        """
        recording = self.study.spec.recording
        if recording is None:
            raise InputError("is missing in the study", field="records")
        made = result if result is not None else self.run()
        return recording.record(
            getattr(made, recording.quantity), self.built.plan.settings.time_step, self.id
        )


@dataclass(frozen=True, eq=False)
class ScenarioList(Sequence[Scenario]):
    """The scenarios of a study by their ids; made when they are asked for."""

    study: Study

    def __len__(self) -> int:
        return len(self.study._scenarios)

    def __getitem__(self, key: Any) -> Any:
        if isinstance(key, slice):
            return [Scenario(self.study, i) for i in range(len(self))[key]]
        return Scenario(self.study, range(len(self))[key])


@dataclass(frozen=True)
class RunOutcome:
    """How a run of a study ended."""

    scenarios: int
    computed: int  # in this run
    failed: int  # rows of the store that are no results
    missing: int  # scenarios without row
    reasons: tuple[str, ...] = ()  # why some are missing
    mended: tuple[str, ...] = ()  # what was damaged in the store and has been done again


class Study(Shown):
    """Many scenarios around one case.

    Parameters
    ----------
    base : path or mapping
        A case file, or a case as a mapping with the keys of one.
    vary : mapping
        Values by dotted paths into the case: lists, ranges, factors, seeds, random variables.
    zip, sampling, trains, passage, histories, records, title : optional
        As in a study file.

    Raises
    ------
    InputError
        If something is wrong with them; nothing has been computed.

    Examples
    --------
    >>> study = Study(
    ...     {
    ...         "structure": {"kind": "simple-span", "length": 25, "youngs_modulus": "2.87 GPa",
    ...                       "second_moment": "2.9 m^4", "mass_per_length": 2303, "elements": 10},
    ...         "train": [{"vehicle": "axle-loads", "loads": "100 kN"}],
    ...         "crossing": {"speed": "80 km/h"},
    ...         "analysis": {"time_step": "10 ms"},
    ...     },
    ...     {"crossing.speed": {"from": "100 km/h", "to": "200 km/h", "step": "50 km/h"}},
    ...     passage={"after": "1 s"},
    ... )
    >>> len(study.scenarios), study.scenarios[1].values
    (3, {'crossing.speed': '150 km/h'})
    """

    def __init__(
        self,
        base: str | os.PathLike[str] | Mapping[str, Any],
        vary: Mapping[str, Any],
        *,
        zip: Sequence[Sequence[str]] | None = None,
        sampling: Mapping[str, Any] | None = None,
        trains: Mapping[str, Any] | None = None,
        passage: Mapping[str, Any] | None = None,
        histories: Mapping[str, Any] | None = None,
        records: Mapping[str, Any] | None = None,
        title: str = "",
    ) -> None:
        given = {
            "title": title or None,
            "base": base if isinstance(base, Mapping) else os.fspath(base),
            "vary": vary,
            "zip": zip,
            "sampling": sampling,
            "trains": trains,
            "passage": passage,
            "histories": histories,
            "records": records,
        }
        text = to_json({key: value for key, value in given.items() if value is not None}, indent=1)
        document = read_yaml(text, "study")
        try:
            self._take(
                read_spec(Node(document.data, Source("study", text, document.root)), Path(), library_names())
            )
        except InputError as error:
            raise InputErrors(_placeless(error)) from None

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Study:
        """Read a study file.

        Raises
        ------
        InputError
            All that is wrong, with file, line and column.
        """
        study = cls.__new__(cls)
        study._take(load_spec(path, library_names()))
        return study

    def _take(self, spec: Spec) -> None:
        self.spec = spec
        self._scenarios = Scenarios.of(spec)
        _require_countable(spec)
        self._recipe = Recipe.of(spec)
        self._store: Store | None = None
        validate(self._recipe, self._scenarios, spec.source)
        self._doubts = doubts(self._recipe, self._scenarios, spec.source)
        self._check_records()

    def _check_records(self) -> None:
        """Require base cases that records can be made of, whatever the time step is."""
        if self.spec.recording is None:
            return
        steps = {k for k, axis in enumerate(self._scenarios.axes) if "analysis.time_step" in axis.paths}
        for number, axis, _ in self._scenarios.one_by_one(MOST):
            if number == 0 or axis in steps:
                try:
                    self.spec.recording.require(self.scenario(number).case)
                except InputError as error:
                    raise self.spec.source.blame(error.field or "records", error.rule, error.fix) from None

    # --- what it is ----------------------------------------------------------------------------

    @property
    def title(self) -> str:
        """Its title, that of the base, or the name of its file."""
        return self.spec.title or str(self.spec.base.data.get("title") or "") or self.spec.source.file

    def card(self) -> Card:
        """Return what is shown of it."""
        facts = [("title", self.title), ("scenarios", f"{len(self._scenarios)}")]
        facts.append(("varies", some([f"{path} ({len(part)})" for path, part in zip_paths(self._scenarios)])))
        if self._store is None:
            return Card("Study", facts, 'study.run("folder")')
        facts.append(("folder", str(self._store.folder)))
        return Card("Study", facts, "study.table(), study.answers()")

    @property
    def scenarios(self) -> ScenarioList:
        """All scenarios, by id."""
        return ScenarioList(self)

    def scenario(self, id: int) -> Scenario:
        """One scenario.

        Raises
        ------
        InputError
            If there is none of that id.
        """
        if not 0 <= id < len(self._scenarios):
            raise InputError(f"must be from 0 to {len(self._scenarios) - 1}", field="scenario", value=id)
        return Scenario(self, id)

    @cached_property
    def columns(self) -> dict[str, str]:
        """Columns of the table of scenarios, and their kinds."""
        return columns_of(self.spec, self._scenarios, self.scenario(0).case)

    @cached_property
    def digest(self) -> str:
        """Digest of all that its numbers follow from."""
        recipe = self._recipe
        content = [recipe.data, self.spec.definition, dict(recipe.files)]
        return digest(content)

    def trial(self, *, timed: bool = True) -> Trial:
        """Build some scenarios, and time the first steps of a few.

        Raises
        ------
        InputError
            If one of them cannot be built, located where it can be told.
        """
        trial = try_out(
            self._recipe,
            self._scenarios,
            lambda error, id: InputErrors(blamed(error, self._scenarios, self.spec.source, id)),
            timed=timed,
            forgiving=self.spec.sampling is not None,
        )
        return replace(trial, cautions=(*self._doubts, *trial.cautions))

    def estimate(self, *, workers: int = 1, free: float = 4e9) -> Estimate:
        """What it takes on so many workers, from a trial.

        Parameters
        ----------
        workers : int
            Processes.
        free : float
            Memory that batches may share [byte].
        """
        return estimate(self.trial(), self._scenarios, len(self.columns), workers=workers, free=free)

    # --- running -------------------------------------------------------------------------------

    def run(
        self,
        folder: str | os.PathLike[str],
        *,
        workers: int = 1,
        scheduler: str | None = None,
        resume: bool = False,
        progress: Progress | None = None,
        under_way: UnderWay | None = None,
        trial: Trial | None = None,
        free: float = 4e9,
    ) -> RunOutcome:
        """Compute all scenarios into a store.

        Parameters
        ----------
        folder : path
            Of the store; new, or with ``resume`` one of this study, of which what is missing is computed.
        workers : int
            Processes on this machine; 1 computes in this one. In a script, several workers need
            ``if __name__ == "__main__":``.
        scheduler : str, optional
            Address of a Dask scheduler, or ``local`` for a local Dask cluster of so many workers.
        progress : callable, optional
            Called at first, and after each batch, with numbers of scenarios: done, failed, all.
        under_way : callable, optional
            Called while batches are computed, with how many scenarios' worth of their time steps have been made: a
            number of scenarios beside those that are done.
        trial : Trial, optional
            From :meth:`trial`, if it has been made already.
        free : float
            Memory that batches may share [byte].
        resume : bool
            Whether a store of this study is gone on with.

        Returns
        -------
        RunOutcome
            Scenarios that failed are rows of the table with their reason.

        Raises
        ------
        InputError
            If the folder or the scheduler cannot be used; nothing has been computed.
        OSError
            If the store cannot be written any more; what is in it stays, and ``resume`` goes on.
        ConnectionError
            If the scheduler is gone; likewise.
        """
        if workers < 1:
            raise InputError("must be at least 1", field="workers", value=workers)
        known = trial if trial is not None else self.trial(timed=False)
        header = Header(self.digest, len(self._scenarios), self.columns, self.title, self._scenarios.paths)
        with _executor(workers, scheduler) as executor:
            most = lanes_in_memory(known, executor.workers, free)
            with Store.for_writing(Path(folder), header, self._texts(), resume=resume) as store:
                self._store = store
                return self._fill(store, executor, most, progress, under_way)

    def _fill(
        self,
        store: Store,
        executor: Executor,
        most: int,
        progress: Progress | None,
        under_way: UnderWay | None,
    ) -> RunOutcome:
        every = np.arange(len(self._scenarios), dtype=np.int64)
        there = store.done()
        missing = np.setdiff1d(every, there, assume_unique=True)
        lanes = lanes_for(len(missing), executor.workers, most)
        work = tasks(self._recipe, self._scenarios, missing, lanes)
        done, failed, reasons = 0, 0, list[str]()
        shares: dict[int, float] = {}
        if progress is not None:
            progress(len(there), 0, len(every))

        def news(number: int, share: float) -> None:
            if under_way is not None and shares.get(number, 0.0) != share:
                shares[number] = share
                under_way(sum(shares.values()))

        running: Iterator[Done | Lost] = iter(executor.run(work, None if under_way is None else news))
        try:
            for one in running:
                if shares.pop(one.number, None) is not None and under_way is not None:
                    under_way(sum(shares.values()))
                if isinstance(one, Lost):
                    reasons.append(one.reason)
                    continue
                store.add(one)
                done += len(one.rows)
                failed += sum(row["outcome"] != "completed" for row in one.rows)
                if progress is not None:
                    progress(len(there) + done, failed, len(every))
        except ConnectionError as error:
            reasons.append(str(error))
        finally:
            close = getattr(running, "close", None)
            if close is not None:
                close()
            store.flush()
        complete = len(there) + done == len(every)
        if complete:
            store.compact()
        answers = Answers.of_store(store, self)
        if complete:
            store.write_summary(answers.summary())
        unsuccessful = answers.failed
        return RunOutcome(
            len(every),
            done,
            unsuccessful,
            len(every) - len(there) - done,
            tuple(dict.fromkeys(reasons)),
            store.mended,
        )

    def _texts(self) -> dict[str, str]:
        texts = {"study.yaml": self.spec.source.text}
        if self.spec.base.source.file != self.spec.source.file:
            texts["base.yaml"] = self.spec.base.source.text
        return texts

    def table(self, folder: str | os.PathLike[str] | None = None) -> pandas.DataFrame:
        """The table of scenarios, indexed by id: of the last run, or of a store.

        Raises
        ------
        InputError
            If there is none, or pandas is not installed.
        """
        return self._open(folder).table()

    def answers(self, folder: str | os.PathLike[str] | None = None) -> Answers:
        """Envelopes, critical speeds, distributions: of the last run, or of a store."""
        return Answers.of_store(self._open(folder), self)

    def _open(self, folder: str | os.PathLike[str] | None) -> Store:
        if folder is not None:
            return Store.open(Path(folder))
        if self._store is None:
            raise InputError(
                "is needed: the study has not been run here", field="folder", fix="Name its store"
            )
        return self._store


def _require_countable(spec: Spec) -> None:
    """Refuse products that no table holds."""
    number = prod(len(axis) for axis in spec.axes)
    if number > MOST_SCENARIOS:
        factors = " × ".join(str(len(axis)) for axis in spec.axes)
        rule = f"makes {number:.4g} scenarios ({factors}); at most {MOST_SCENARIOS:.0e} are possible"
        fix = "Vary fewer paths, take longer steps, zip lists that belong together, or sample at random"
        raise spec.source.blame_key(("vary",), rule, fix)


def zip_paths(scenarios: Scenarios) -> Iterable[tuple[str, Any]]:
    """Paths with their values."""
    return ((part.path, part) for part in scenarios.parts)


def _executor(workers: int, scheduler: str | None) -> AbstractContextManager[Executor]:
    if scheduler is not None:
        from axlespan.study.sweep.on_dask import on_dask

        return on_dask(scheduler, workers)
    return nullcontext(Processes(workers) if workers > 1 else InProcess())


def _placeless(error: InputError) -> Iterator[InputError]:
    """Errors without lines and columns of a file that there is not."""
    for one in getattr(error, "errors", (error,)):
        value: dict[str, Any] = {"value": one.value} if one.has_value else {}
        place = one.place if one.place is not None and one.place.file != "study" else None
        yield InputError(one.rule, field=one.field, fix=one.fix, place=place, **value)
