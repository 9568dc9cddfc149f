"""``axlespan run``: a case file to a folder of results."""

from __future__ import annotations

import json
import os
from dataclasses import replace
from pathlib import Path

from axlespan import __version__
from axlespan.cli.messages import DONE, FAILED, refuse, say, warn
from axlespan.cli.progress import progress
from axlespan.errors import AnalysisError, InputError, Place
from axlespan.interaction.result import Result
from axlespan.interaction.simulate import run_plan
from axlespan.io.paraview import require_model, write_paraview
from axlespan.io.result_extras import append_extras
from axlespan.io.results import write_result
from axlespan.io.summary import summary, summary_lines
from axlespan.study.build import BuiltCase, build
from axlespan.study.loader import load_case

# Fields for ParaView where a case asks for none.
_FIELDS = 100


def run_case(case: Path, output: Path | None, *, force: bool, figures: bool, paraview: bool = False) -> int:
    """Run a case; the exit code."""
    folder = output or case.with_suffix("")
    try:
        check_folder(folder, force)
        built = build(load_case(case))
        if paraview:
            built = _with_fields(built)
    except InputError as error:
        return refuse(error)
    for warning in (
        *built.warnings,
        *(note for note in built.plan.settings.notes if note.startswith("warning")),
    ):
        warn(warning)
    steps = built.plan.settings.steps
    code = DONE
    try:
        with progress(steps, built.title) as advance:
            result = run_plan(built.plan, advance)
    except AnalysisError as error:
        warn(f"the analysis failed: {error}")
        if not isinstance(error.result, Result):
            return FAILED
        result, code = error.result, FAILED
    try:
        _write(built, result, folder, figures=figures, paraview=paraview)
    except OSError as error:
        warn(f"{folder}: the results cannot be written: {error.strerror or error}")
        return FAILED
    return code


def check_folder(folder: Path, force: bool) -> None:
    """The folder must be new or empty, unless --force is given; and it must be possible to make it."""
    place = Place(str(folder))
    if folder.is_dir():
        if any(folder.iterdir()) and not force:
            raise InputError(
                "exists already and is not empty", place=place, fix="Use --force, or another folder with -o"
            )
        if not os.access(folder, os.W_OK):
            raise InputError("cannot be written to", place=place)
        return
    if folder.exists():
        raise InputError("is a file, not a folder", place=place, fix="Name another folder with -o")
    parent = next(p for p in (folder.absolute(), *folder.absolute().parents) if p.exists())
    if not (parent.is_dir() and os.access(parent, os.W_OK)):
        raise InputError(
            "cannot be made", place=place, fix=f"Check that {parent} is a folder that you may write to"
        )


def _write(built: BuiltCase, result: Result, folder: Path, *, figures: bool, paraview: bool) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    write_result(result, folder / "result.nc", case_text=built.loaded.source.text, version=__version__)
    append_extras(result, folder / "result.nc")
    written = ["result.nc", "summary.json"]
    if figures:
        written += _draw(built, result, folder)
    if paraview:
        written += write_paraview(result, built.crossing, folder)[:1]
    facts = summary(result, built.crossing, title=built.title, version=__version__, files=written)
    text = json.dumps(facts, indent=2, allow_nan=False)
    temporary = folder / ".summary.json.part"
    temporary.write_text(text + "\n", encoding="utf-8")
    os.replace(temporary, folder / "summary.json")
    for line in summary_lines(facts):
        say(line)
    say(f"Written to {folder}: {', '.join(written)}")


def _with_fields(built: BuiltCase) -> BuiltCase:
    """The case with fields for ParaView: some, evenly spread, if it asks for none itself."""
    require_model(built.crossing.structure)
    settings = built.plan.settings
    if len(settings.fields):
        return built
    every = max(1, settings.steps // _FIELDS)
    fields = range(0, settings.steps + 1, every)
    return replace(built, plan=replace(built.plan, settings=replace(settings, fields=fields)))


def _draw(built: BuiltCase, result: Result, folder: Path) -> list[str]:
    from axlespan.plot import draw_figures

    return draw_figures(result, built.crossing, folder)
