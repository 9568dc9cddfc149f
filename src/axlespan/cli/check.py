"""``axlespan check``: what a case is, before it is run."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from axlespan.cli.messages import DONE, refuse, say, warn
from axlespan.errors import InputError
from axlespan.linalg.eigen import lowest_modes
from axlespan.linalg.factor import choose
from axlespan.model.system import System
from axlespan.study.build import BuiltCase, build
from axlespan.study.loader import load_case
from axlespan.vehicles import Vehicle


def check_case(case: Path) -> int:
    """Read, build and describe a case; the exit code."""
    try:
        built = build(load_case(case))
    except InputError as error:
        return refuse(error)
    for warning in built.warnings:
        warn(warning)
    for line in _description(built):
        say(line)
    return DONE


def _description(built: BuiltCase) -> list[str]:
    plan, structure, train = built.plan, built.crossing.structure, built.crossing.train
    settings, system = plan.settings, structure.system
    wanted = 10 if built.facts else 3  # ten of an imported structure, to compare with where it came from
    modes = lowest_modes(plan.structure.K, plan.structure.M, min(wanted, plan.structure.size))
    head = plan.crossing.start + plan.crossing.motion.distance(plan.times[[0, -1]])
    choice = choose(plan.structure.K)
    kept = settings.steps // settings.every + 1
    values = (
        2 * plan.rows.n_contact
        + 3 * plan.fleet.matrices.size
        + 3 * len(settings.sensors)
        + len(system.prescribed)
    )
    lines = [
        built.title,
        f"  structure   {structure.name}, {structure.length:g} m, {plan.structure.size} free d.o.f., "
        f"{_mass(system)}frequencies {', '.join(f'{f:.4g}' for f in modes.frequencies)} Hz",
        *(f"  {fact}" for fact in built.facts),
        f"  train       {train.name}, {_counted(len(train.placements), 'vehicle')}, {_counted(plan.rows.n_contact, 'wheel')}, "
        f"{train.wheelbase:g} m from first wheel to last",
        *_vehicle_lines(built),
        f"  crossing    the first wheel runs from {head[0]:g} to {head[1]:g} m",
        f"  analysis    {settings.steps} steps of {settings.time_step:g} s, alpha = {settings.method.alpha:g}, "
        f"{settings.coupling} method",
        f"  solver      {choice if settings.solver == 'auto' else settings.solver} ({choice.reason})",
        f"  result      about {8e-6 * kept * values:.3g} MB",
    ]
    lines += [f"  note        {note}" for note in settings.notes]
    return [*lines, "The case is in order. Run it with: axlespan run CASE -o FOLDER"]


def _mass(system: System) -> str:
    """Mass that moves vertically; modal coordinates and rows without names don't tell."""
    mass = system.total_mass()
    return f"mass {mass / 1e3:.6g} t, " if mass > 0.0 else ""


def _counted(number: int, what: str) -> str:
    return f"{number} {what}" if number == 1 else f"{number} {what}s"


def _vehicle_lines(built: BuiltCase) -> list[str]:
    kinds: dict[int, Vehicle] = {id(item.vehicle): item.vehicle for item in built.crossing.train.placements}
    lines = []
    for vehicle in kinds.values():
        loads = vehicle.static_forces(built.crossing.gravity) / 1e3
        text = f"  vehicle     {vehicle.name}: static wheel loads {', '.join(f'{load:.5g}' for load in loads)} kN"
        frequencies = vehicle.frequencies()
        if len(frequencies):
            text += f"; frequencies {', '.join(f'{f:.4g}' for f in frequencies[:6])} Hz"
            steps = 1.0 / (np.max(frequencies) * built.plan.settings.time_step)
            text += f"; {steps:.4g} steps per shortest period"
        lines.append(text)
    return lines
