"""``axlespan check``: what a case is, before it is run."""

from __future__ import annotations

import shlex
from itertools import groupby
from pathlib import Path

import numpy as np
import numpy.typing as npt

from axlespan.cli.messages import DONE, FAILED, refuse, say, warn
from axlespan.cli.room import check_size
from axlespan.errors import AxlespanError, InputError
from axlespan.irregularity import spectrum_names
from axlespan.linalg.eigen import lowest_modes
from axlespan.linalg.factor import choose
from axlespan.model.system import System
from axlespan.standards import bridge_facts
from axlespan.study.build import WARNING, BuiltCase, build
from axlespan.study.loader import load_case
from axlespan.study.size import Size, size_text
from axlespan.study.sweep.spec import is_study_file
from axlespan.vehicles import Vehicle

# Wheel loads that are written one by one.
_MANY = 8


def check_case(case: Path) -> int:
    """Read, build and describe a case or a study; the exit code."""
    if is_study_file(case):
        from axlespan.cli.sweep import check_study

        return check_study(case)
    try:
        built = build(load_case(case, spectra=spectrum_names()))
        size = check_size(built)
    except InputError as error:
        return refuse(error)
    except AxlespanError as error:
        warn(f"the analysis failed: {error}")
        return FAILED
    for text in built.cautions:
        warn(f"warning: {text}")
    for line in _description(built, size):
        say(line)
    say(f"The case is in order. Run it with: axlespan run {shlex.quote(str(case))} -o FOLDER")
    return DONE


def _description(built: BuiltCase, size: Size) -> list[str]:
    plan, structure = built.plan, built.crossing.structure
    settings, system = plan.settings, structure.system
    ends = plan.times_of(np.array([0, settings.steps]))
    lines = [
        built.title,
        f"  structure   {structure.name}, {structure.length:g} m, {plan.structure.size} free d.o.f., "
        f"{_mass(system)}{_frequencies(built)}",
        *(f"  {fact}" for fact in built.facts),
        *_train_lines(built, ends),
        *_vehicle_lines(built),
        f"  analysis    {settings.steps} steps of {settings.time_step:g} s, alpha = {settings.method.alpha:g}, "
        f"{settings.coupling} method",
        f"  solver      {_solver(built)}",
        *_rules(built),
        f"  size        {size.kept_times} times of {size.values} values, at most {size_text(size.result)}; memory for the "
        f"run about {size_text(size.memory)}",
    ]
    return [*lines, *(f"  note        {note}" for note in settings.notes if not note.startswith(WARNING))]


def _train_lines(built: BuiltCase, ends: npt.NDArray[np.float64]) -> list[str]:
    """Each train, and where it runs."""
    lines = []
    for run in built.crossing.runs:
        train, head = run.train, run.course.head(ends)
        lines.append(
            f"  train       {train.name}, {_counted(len(train.placements), 'vehicle')}, "
            f"{_counted(len(run.lines), 'wheel')}, {train.wheelbase:g} m from first wheel to last"
        )
        last = head[1] - run.course.direction * train.wheelbase
        behind = f", the last one to {last:g} m" if train.wheelbase else ""
        lines.append(f"  crossing    the first wheel runs from {head[0]:g} to {head[1]:g} m{behind}")
    return lines


def _frequencies(built: BuiltCase) -> str:
    """The first frequencies of the structure, in words."""
    matrices = built.plan.structure
    wanted = 10 if built.facts else 3  # ten of an imported structure, to compare with where it came from
    massive = int(np.count_nonzero(matrices.M.diagonal()))
    try:
        modes = lowest_modes(matrices.K, matrices.M, min(wanted, massive))
    except AxlespanError as error:  # it runs without them
        return f"frequencies not found: {error}"
    return f"frequencies {', '.join(f'{f:.4g}' for f in modes.frequencies)} Hz"


def _rules(built: BuiltCase) -> list[str]:
    """What the rules take the bridge for, if the case is to be assessed."""
    asked = built.loaded.case.assessment
    if asked is None:
        return []
    facts = bridge_facts(built.crossing.structure, asked.wanted())
    return [f"  rules       {facts.words}; {len(asked.checks)} checks"]


def _solver(built: BuiltCase) -> str:
    kind = built.plan.settings.solver
    if kind != "auto":
        return kind
    choice = choose(built.plan.structure.K)
    return f"{choice} ({choice.reason})"


def _mass(system: System) -> str:
    """Mass that moves vertically; modal coordinates and rows without names don't tell."""
    mass = system.total_mass()
    return f"mass {mass / 1e3:.6g} t, " if mass > 0.0 else ""


def _counted(number: int, what: str) -> str:
    return f"{number} {what}" if number == 1 else f"{number} {what}s"


def _listed(loads: npt.NDArray[np.float64]) -> str:
    """Loads one by one, or in runs of equal ones where they are many."""
    words = [f"{load:.5g}" for load in loads]
    if len(words) <= _MANY:
        return ", ".join(words)
    runs = [(word, len(list(same))) for word, same in groupby(words)]
    return ", ".join(f"{count} × {word}" if count > 1 else word for word, count in runs)


def _vehicle_lines(built: BuiltCase) -> list[str]:
    placed = [item.vehicle for item in built.crossing.placements]
    kinds: dict[int, Vehicle] = {id(one.system or one): one for one in placed}  # whatever flats they have
    lines = []
    for vehicle in kinds.values():
        loads = vehicle.static_forces(built.crossing.gravity) / 1e3
        text = f"  vehicle     {vehicle.name}: static wheel loads {_listed(loads)} kN"
        frequencies = vehicle.frequencies()
        if len(frequencies):
            text += f"; frequencies {', '.join(f'{f:.4g}' for f in frequencies[:6])} Hz"
        if len(frequencies) and vehicle.is_multibody:  # a mesh has periods that no step resolves, nor need it
            steps = 1.0 / (np.max(frequencies) * built.plan.settings.time_step)
            text += f"; {steps:.4g} steps per shortest period"
        lines.append(text)
    return lines
