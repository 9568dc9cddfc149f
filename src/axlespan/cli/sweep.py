"""``axlespan sweep``: a study to a store of results; and what ``axlespan check`` says of a study."""

from __future__ import annotations

import shlex
import sys
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from axlespan.cli.folder import check_folder, publish, staged
from axlespan.cli.messages import DONE, FAILED, INTERRUPTED, refuse, say, warn
from axlespan.cli.room import free_disk, free_memory
from axlespan.errors import AxlespanError, InputError
from axlespan.interaction.result import Result
from axlespan.interaction.runs import run_plan
from axlespan.io.results import write_result
from axlespan.io.strict_json import to_json
from axlespan.io.summary import summary, summary_lines, write_summary
from axlespan.study.size import size_text
from axlespan.study.sweep.answers import Answers
from axlespan.study.sweep.estimate import Estimate, Trial, estimate
from axlespan.study.sweep.shards import Histories, shard_bytes
from axlespan.study.sweep.study import RunOutcome, Scenario, Study

#: More scenarios than this, or more hours, are not begun without --yes.
MOST_SCENARIOS, MOST_HOURS = 100_000, 12.0

# Seconds between two lines of progress where there is no terminal.
_PAUSE = 60.0


@dataclass(frozen=True)
class Wanted:
    """The options of ``axlespan sweep``."""

    resume: bool = False
    workers: int = 1
    scheduler: str | None = None
    yes: bool = False
    figures: bool = True
    only: int | None = None


def check_study(path: Path) -> int:
    """Read a study and say what it will take; the exit code."""
    try:
        study = Study.load(path)
        trial = study.trial()
        lines = _description(study, trial, _estimated(study, trial, 1))
    except InputError as error:
        return refuse(error)
    except AxlespanError as error:
        warn(f"the analysis failed: {error}")
        return FAILED
    for text in trial.cautions:
        warn(f"warning: {text}")
    for line in lines:
        say(line)
    say(f"The study is in order. Run it with: axlespan sweep {shlex.quote(str(path))} -o FOLDER")
    return DONE


def _estimated(study: Study, trial: Trial, workers: int) -> Estimate:
    return estimate(trial, study._scenarios, len(study.columns), workers=workers, free=free_memory())


def _description(study: Study, trial: Trial, about: Estimate) -> list[str]:
    scenarios = study._scenarios
    factors = " × ".join(f"{len(axis)} of {', '.join(axis.paths)}" for axis in scenarios.axes)
    manner = "one after another" if about.one_by_one else "side by side"
    lines = [
        study.title,
        f"  scenarios   {about.scenarios}: {factors}",
        f"  structures  {_counted(about.factorizations, 'factorization')}",
        f"  batches     {about.batches}, of up to {about.lanes} scenarios {manner}",
        f"  time        about {_duration(about.seconds)} on one core: {trial.steps:.0f} steps on average, "
        f"timed on the first {min(256, int(trial.steps))} steps of up to 8 scenarios",
        f"  disk        about {size_text(about.disk)}",
        f"  memory      about {size_text(3.5e8 + about.memory)} for each worker",
    ]
    lines += [f"  note        {note}" for note in study.spec.notes]
    if trial.passed < trial.built:
        lines.append(
            f"  warning     in {trial.built - trial.passed} of {trial.built} scenarios that were looked at, the train has "
            "not left the structure at the end; add passage: {after: 1 s}"
        )
    return lines


def run_sweep(path: Path, folder: Path | None, wanted: Wanted) -> int:
    """Run a study; the exit code."""
    place = folder or (path.with_suffix("") if path.suffix else path.with_name(f"{path.name}-results"))
    try:
        study = Study.load(path)
        if wanted.only is not None:
            return _run_one(study, wanted.only, place)
        trial = study.trial()
        about = _estimated(study, trial, max(1, wanted.workers))
        _require_meant(study, about, wanted.yes, path)
        for text in trial.cautions:
            warn(f"warning: {text}")
        return _run(study, trial, place, wanted)
    except InputError as error:
        return refuse(error)
    except AxlespanError as error:
        warn(f"the analysis failed: {error}")
        return FAILED


def _require_meant(study: Study, about: Estimate, yes: bool, path: Path) -> None:
    """Refuse what is larger than anybody means by accident."""
    hours = about.seconds / 3600.0
    if yes or (about.scenarios <= MOST_SCENARIOS and hours <= MOST_HOURS):
        return
    raise InputError(
        f"makes {about.scenarios} scenarios, about {_duration(about.seconds)} and {size_text(about.disk)}",
        field="vary",
        fix=f"Add --yes if that is meant; axlespan check {shlex.quote(str(path))} says more",
        place=study.spec.source.place("vary"),
    )


def _run(study: Study, trial: Trial, folder: Path, wanted: Wanted) -> int:
    _warn_of_disk(study, trial, folder, wanted)
    counter = _Counter(len(study.scenarios))
    try:
        with _progress(counter, study.title):
            outcome = study.run(
                folder,
                workers=wanted.workers,
                scheduler=wanted.scheduler,
                resume=wanted.resume,
                progress=counter,
                under_way=counter.under_way,
                trial=trial,
                free=free_memory(),
            )
    except OSError as error:
        warn(f"{folder}: the store cannot be written: {error.strerror or error}; {_goes_on(study, folder)}")
        return FAILED
    except KeyboardInterrupt:
        warn(f"interrupted; {_goes_on(study, folder)}")
        return INTERRUPTED
    return _told(study, folder, outcome, wanted)


def _goes_on(study: Study, folder: Path) -> str:
    """What is in the store, and how to go on."""
    try:
        done = len(study._open(folder).done())
    except (AxlespanError, OSError):
        return "nothing was computed"
    return f"{done} of {len(study.scenarios)} scenarios are in {folder}, and --resume computes the others"


def _told(study: Study, folder: Path, outcome: RunOutcome, wanted: Wanted) -> int:
    for line in outcome.mended:
        warn(f"{folder}: {line}")
    answers = study.answers(folder)
    for line in answers.lines():
        say(line)
    if outcome.missing:
        for reason in outcome.reasons[:5]:
            warn(reason)
        warn(f"{outcome.missing} scenarios were not computed; --resume computes them")
        return FAILED
    if wanted.figures and answers.completed.any():
        _draw(answers, folder)
    say(f"Written to {folder}: the table opens with pandas.read_parquet({str(folder / 'table')!r})")
    return DONE


def _warn_of_disk(study: Study, trial: Trial, folder: Path, wanted: Wanted) -> None:
    about, space = _estimated(study, trial, wanted.workers), free_disk(folder)
    if about.disk > space > 0.0:
        warn(f"warning: the store may take {size_text(about.disk)}; {size_text(space)} are free on the disk")


def _draw(answers: Answers, folder: Path) -> None:
    """Draw the figures; a store is worth having without them."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            from axlespan.plot.study import draw_study

            draw_study(answers, folder)
    except Exception as error:  # whatever a plotting library says, the store is complete
        words = " ".join(str(error).split())[:200] or type(error).__name__
        warn(f"warning: the figures could not be drawn: {words}")


# --- one scenario ----------------------------------------------------------------------------------


def _run_one(study: Study, number: int, folder: Path) -> int:
    """Compute one scenario alone, with all its histories."""
    scenario = study.scenario(number)
    _require_other_folder(folder)
    with staged(folder) as stage:
        try:
            result = run_plan(scenario.built.plan)
        except AxlespanError as error:
            kept = getattr(error, "result", None)
            if not isinstance(kept, Result):
                raise
            warn(f"the analysis failed: {error}")
            result = kept
        try:
            lines = _write_one(study, scenario, result, stage, folder)
        except OSError as error:
            warn(f"{folder}: the results cannot be written: {error.strerror or error}")
            return FAILED
    for line in lines:
        say(line)
    return DONE if result.outcome.code == "completed" else FAILED


def _require_other_folder(folder: Path) -> None:
    """Require a folder that is new or empty: a store is of all scenarios."""
    try:
        check_folder(folder, force=False)
    except InputError as error:
        if folder.is_dir():
            error = InputError(error.rule, place=error.place, fix="Name another folder with -o")
        raise error from None


def _write_one(study: Study, scenario: Scenario, result: Result, stage: Path, folder: Path) -> list[str]:
    case_text = to_json(scenario.data, indent=2)
    write_result(result, stage / "result.nc", case_text=case_text)
    files = ["result.nc", "summary.json"]
    recording = study.spec.recording
    if recording is not None and result.outcome.code == "completed":
        values = scenario.record(result)
        record = Histories(
            (scenario.id,), 1.0 / recording.rate, {recording.quantity: ("sensor", result.sensor, [values])}
        )
        (stage / "record.nc").write_bytes(shard_bytes(record, {"provenance": scenario.provenance}))
        files.append("record.nc")
    title = f"{study.title}, scenario {scenario.id}"
    facts: dict[str, Any] = summary(result, scenario.built.crossing, title=title, files=files)
    write_summary(
        facts | {"scenario": scenario.values, "provenance": scenario.provenance}, stage / "summary.json"
    )
    publish(stage, folder)
    return [*summary_lines(facts), f"Written to {folder}"]


# --- progress --------------------------------------------------------------------------------------


@dataclass
class _Counter:
    """Counts scenarios over all workers, and shows them where somebody watches."""

    total: int
    shown: Any = field(default=None, repr=False)
    done: int = 0
    failed: int = 0
    share: float = 0.0  # scenarios' worth of steps in batches that are not done

    def __call__(self, done: int, failed: int, total: int) -> None:
        self.done, self.failed = done, failed
        self._show()

    def under_way(self, share: float) -> None:
        """Count what is made within batches; it falls where one is done, and then that is counted."""
        grown, self.share = share > self.share, share
        if grown:
            self._show()

    def _show(self) -> None:
        if self.shown is not None:
            self.shown(self.done, self.failed, self.share)


@contextmanager
def _progress(counter: _Counter, title: str) -> Iterator[None]:
    """Done, failed, rate and time left: a bar on a terminal, a line a minute elsewhere."""
    if sys.stderr is None:
        yield
        return
    if not sys.stderr.isatty():
        counter.shown = _Lines(counter.total)
        yield
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(bar_width=24),
        TextColumn("{task.fields[done]}/{task.total:.0f} done", markup=False),
        TextColumn("{task.fields[failed]} failed", markup=False),
        TextColumn("{task.fields[rate]}", markup=False),
        TimeRemainingColumn(),
        TextColumn("left"),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title[:40], total=counter.total, done=0, failed=0, rate="")
        begun, first = time.monotonic(), -1.0

        def show(done: int, failed: int, share: float) -> None:
            nonlocal first
            made = done + share
            first = made if first < 0 else first
            passed = time.monotonic() - begun
            rate = f"{(made - first) / passed:,.3g}/s" if passed > 1.0 and made > first else ""
            bar.update(task, completed=made, done=done, failed=failed, rate=rate)

        counter.shown = show
        yield


class _Lines:
    """A line of progress now and then."""

    def __init__(self, total: int) -> None:
        self._total, self._begun, self._last = total, time.monotonic(), time.monotonic()
        self._first: float | None = None

    def __call__(self, done: int, failed: int, share: float) -> None:
        now, made = time.monotonic(), done + share
        if self._first is None:
            self._first = made
        if now - self._last < _PAUSE or done >= self._total:
            return
        self._last = now
        rate = max(made - self._first, 1e-3) / (now - self._begun)
        left = (self._total - made) / rate
        warn(
            f"{done} of {self._total} done, {failed} failed, {rate:.3g} a second, about {_duration(left)} left"
        )


def _duration(seconds: float) -> str:
    """A time in words.

    Examples
    --------
    >>> _duration(0.2), _duration(90.0), _duration(7.5 * 3600), _duration(4e6)
    ('1 s', '1.5 min', '7.5 h', '46 days')
    """
    if seconds < 60.0:
        return f"{max(1.0, round(seconds)):.0f} s"
    for size, unit in ((3600.0, "min"), (86400.0, "h")):
        if seconds < 2.0 * size:
            return f"{seconds / (60.0 if unit == 'min' else 3600.0):.2g} {unit}"
    if seconds < 48 * 3600.0:
        return f"{seconds / 3600.0:.2g} h"
    return f"{seconds / 86400.0:.2g} days"


def _counted(number: int, what: str) -> str:
    return f"{number} {what}" if number == 1 else f"{number} {what}s"
