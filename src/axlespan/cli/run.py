"""``axlespan run``: a case file to a folder of results."""

from __future__ import annotations

import shlex
import warnings
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from axlespan.cli.folder import check_folder, publish, staged
from axlespan.cli.messages import DONE, FAILED, INTERRUPTED, refuse, say, warn
from axlespan.cli.progress import Steps, progress
from axlespan.cli.room import check_size
from axlespan.errors import AnalysisError, AxlespanError, InputError, Place
from axlespan.interaction.result import Result
from axlespan.interaction.runs import run_plan
from axlespan.io.drawing import drawing_of
from axlespan.io.paraview import require_model, write_paraview
from axlespan.io.results import write_result
from axlespan.io.summary import summary, summary_lines, write_summary
from axlespan.irregularity import spectrum_names
from axlespan.standards import assess
from axlespan.study.build import BuiltCase, build
from axlespan.study.loader import load_case
from axlespan.study.sweep.spec import is_study_file

# Fields for ParaView where a case asks for none.
_FIELDS = 100

_NO_MEMORY = "there is not enough memory; keep fewer times with every, under output"


@dataclass(frozen=True)
class Wanted:
    """What is written beside the result and its summary."""

    figures: bool = True
    paraview: bool = False
    report: bool = False


def run_case(case: Path, output: Path | None, *, force: bool, wanted: Wanted) -> int:
    """Run a case; the exit code."""
    try:
        if is_study_file(case):
            fix = f"Run it with: axlespan sweep {shlex.quote(str(case))} -o FOLDER"
            raise InputError("is a study, not a case", place=Place(str(case)), fix=fix)
        loaded = load_case(case, spectra=spectrum_names())
        folder = output or _folder_of(case)
        check_folder(folder, force)
        built = build(loaded)
        if wanted.paraview:
            built = _with_fields(built)
        with staged(folder) as stage:
            check_size(built, folder)
            for text in built.cautions:
                warn(f"warning: {text}")
            code, lines = _run(built, stage, folder, wanted)
    except InputError as error:
        return refuse(error)
    except AxlespanError as error:
        warn(f"the analysis failed: {error}")
        return FAILED
    except KeyboardInterrupt:
        warn("interrupted; nothing was written")
        return INTERRUPTED
    for line in lines:
        say(line)
    return code


def _folder_of(case: Path) -> Path:
    """The folder for the results where none is named."""
    return case.with_suffix("") if case.suffix else case.with_name(f"{case.name}-results")


def _with_fields(built: BuiltCase) -> BuiltCase:
    """The case with fields for ParaView: some, evenly spread, if it asks for none itself."""
    require_model(built.crossing.structure)
    settings = built.plan.settings
    if len(settings.fields):
        return built
    every = max(1, settings.steps // _FIELDS)
    fields = range(0, settings.steps + 1, every)
    return replace(built, plan=replace(built.plan, settings=replace(settings, fields=fields)))


def _run(built: BuiltCase, stage: Path, folder: Path, wanted: Wanted) -> tuple[int, list[str]]:
    """Compute and write; the exit code, and what is to be said of the result."""
    try:
        result, code = _computed(built)
        return code, [] if result is None else _written(built, result, stage, folder, wanted)
    except (OSError, MemoryError) as error:
        reason = getattr(error, "strerror", None) or str(error) or _NO_MEMORY
        warn(f"{folder}: the results cannot be written: {reason}")
        return FAILED, []
    except KeyboardInterrupt:
        warn("interrupted while the results were written; they are not kept")
        return INTERRUPTED, []


def _computed(built: BuiltCase) -> tuple[Result | None, int]:
    """The result, that of a failed run too, and the exit code."""
    steps = Steps(built.plan.settings.steps)
    try:
        with progress(steps, built.title):
            return run_plan(built.plan, steps), DONE
    except InputError:
        raise
    except (AxlespanError, MemoryError) as error:
        warn(f"the analysis failed: {str(error) or _NO_MEMORY}")
        kept = error.result if isinstance(error, AnalysisError) else None
        return (kept if isinstance(kept, Result) else None), FAILED
    except KeyboardInterrupt:
        warn(f"interrupted after {steps.done} of {steps.total} steps; nothing was written")
        return None, INTERRUPTED


def _written(built: BuiltCase, result: Result, stage: Path, folder: Path, wanted: Wanted) -> list[str]:
    """Write all files, then move them to their folder; what is to be said of the result."""
    drawing = drawing_of(built.crossing, result)
    write_result(result, stage / "result.nc", case_text=built.loaded.source.text, drawing=drawing)
    files = ["result.nc", "summary.json"]
    if wanted.figures:
        files += _draw(built, result, stage)
    if wanted.paraview and result.fields is not None:
        files += write_paraview(result, built.crossing, stage)[:1]
    verdicts = _assessed(built, result)
    if wanted.report:
        files.append("report.html")
    facts = summary(result, built.crossing, title=built.title, files=files, verdicts=verdicts)
    write_summary(facts, stage / "summary.json")
    if wanted.report:
        _report(stage)
    publish(stage, folder)
    return [*summary_lines(facts), f"Written to {folder}"]


def _report(folder: Path) -> None:
    """Write the page of the result that a folder holds; the result is worth keeping without it."""
    from axlespan.report import write_report

    try:
        write_report(folder)
    except Exception as error:  # as with figures
        words = " ".join((str(error) or type(error).__name__).split())[:200]
        warn(f"warning: the report could not be written: {words}")


def _assessed(built: BuiltCase, result: Result) -> list[dict[str, Any]]:
    """Verdicts by the rules that the case asks for; a run that failed is not assessed."""
    asked = built.loaded.case.assessment
    if asked is None or result.outcome.code != "completed":
        return []
    try:
        return [verdict.as_dict() for verdict in assess(result, built.crossing, asked.wanted())]
    except Exception as error:  # hours of computing are not lost for a rule
        reason = " ".join((str(error) or type(error).__name__).split())[:200]
        warn(f"warning: the run could not be assessed: {reason}")
        return []


def _draw(built: BuiltCase, result: Result, folder: Path) -> list[str]:
    """Draw the figures; a result is worth keeping without them."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of glyphs that a font lacks, and the like
            from axlespan.plot import draw_figures

            compare = built.loaded.case.output.compare
            return draw_figures(result, built.crossing, folder, compare=compare)
    except Exception as error:  # whatever a plotting library says, hours of computing are not lost for it
        words = getattr(error, "strerror", None) or str(error) or type(error).__name__
        reason = " ".join(words.split())[:200]
        warn(f"warning: the figures could not be drawn: {reason}")
        for file in folder.glob("*.png"):
            file.unlink()
        return []
