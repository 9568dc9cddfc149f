"""Sweeps: ten HSLM trains, or one train of full vehicles over track, at 57 speeds; side by side and singly."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from axlespan.interaction.runs import run_plan
from axlespan.study.sweep import Study
from axlespan.study.sweep.workshop import forget
from benchmarks.timing import Row, in_turns

SPEEDS = {"from": "140 km/h", "to": "420 km/h", "step": "5 km/h"}
FEW = ["140 km/h", "280 km/h", "420 km/h"]  # a chunk of lanes
# Scenarios that are run singly: every so many of the study.
EVERY, EVERY_QUICK = 17, 44

BRIDGE = {
    "kind": "simple-span",
    "length": "40 m",
    "youngs_modulus": "34 GPa",
    "second_moment": "3.2 m^4",
    "mass_per_length": "18 t/m",
    "elements": 20,
    "damping": {"kind": "rayleigh", "ratio": "1 %", "frequencies": ["3 Hz", "27 Hz"]},
}


def hslm(speeds: object = SPEEDS) -> Study:
    """Ten trains of axle loads × 57 speeds on a span of 40 m."""
    base = {
        "structure": BRIDGE,
        "train": [],
        "crossing": {"speed": "200 km/h"},
        "analysis": {"time_step": "2 ms"},
        "output": {"sensors": {"midspan": "20 m"}, "reactions": False},
    }
    return Study(base, {"train": "hslm-a", "crossing.speed": speeds}, passage={"after": "1 s"})


def vehicles(speeds: object = SPEEDS) -> Study:
    """A train of full vehicles × 57 speeds on the same span with ballasted track."""
    base = {
        "structure": {**BRIDGE, "track": {"kind": "ballasted", "preset": "zhai-2004"}},
        "train": [{"vehicle": "ice3", "count": 1}],
        "crossing": {"speed": "200 km/h", "start": "0 m"},
        "analysis": {"time_step": "2 ms"},
        "output": {"sensors": {"midspan": "20 m"}, "reactions": False},
    }
    return Study(base, {"crossing.speed": speeds}, passage={"after": "1 s"})


def measured(made: Callable[..., Study], every: int = EVERY) -> dict[str, float | str]:
    """Processor time for each scenario: all of them in a sweep, and some of them singly, step by step compared.

    What is done once in a process (modules are read, loops are compiled) is done before. A single one builds its
    structure and its train, as the sweep does once.
    """
    study, few = made(), made(FEW)
    with tempfile.TemporaryDirectory() as folder:
        few.run(Path(folder) / "store")
    run_plan(study.scenario(0).built.plan)
    steps = [scenario.built.plan.settings.steps for scenario in study.scenarios]
    forget()
    begun = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        study.run(Path(folder) / "store")
    together = (time.process_time() - begun) / sum(steps)
    # the number of speeds is no multiple of this step: slow and fast ones take their share
    begun, some = time.process_time(), range(0, len(steps), every)
    for number in some:
        forget()
        plan = study.scenario(number).built.plan  # with the checks of a run of its own
        run_plan(replace(plan, settings=replace(plan.settings, energy_samples=None)))
    alone = (time.process_time() - begun) / sum(steps[number] for number in some)
    mean = sum(steps) / len(steps)
    return {
        "scenarios": float(len(steps)),
        "s/scenario": together * mean,
        "us/scenario-step": 1e6 * together,
        "singly s/scenario": alone * mean,
        "singly/sweep": alone / together,
    }


def run(runs: int, quick: bool = False) -> list[Row]:
    """Both studies; the ratio of singly to the sweep stands in the facts."""
    every = EVERY_QUICK if quick else EVERY
    first = in_turns("10 HSLM x 57 speeds, 40 m", {"sweep": lambda: measured(hslm, every)}, runs)
    second = in_turns("ICE 3 x 57 speeds, 40 m, track", {"sweep": lambda: measured(vehicles, every)}, runs)
    return [*first, *second]
