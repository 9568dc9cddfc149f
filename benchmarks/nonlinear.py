"""A ballasted track over a 40 m bridge with 601 ballast springs that only push: the nonlinear run against the linear one."""

from __future__ import annotations

import time

import axlespan as asp
from axlespan.bridges.unilateral import with_unilateral_springs
from benchmarks import track
from benchmarks.timing import COST, Row, in_turns

_APPROACH = 160.0  # [m], so that 601 sleepers are there
_STEPS, _SHORT = 3000, 300


def run(runs: int, quick: bool = False) -> list[Row]:
    """Whole runs on linear ballast, unilateral ballast, and with four hanging sleepers; then laws of contact."""
    linear = track.bridge(approach=_APPROACH)
    unilateral = with_unilateral_springs(linear, "ballast")
    hanging = [(12.15 + 0.6 * i, 1e-3) for i in range(4)]  # the nearest sleepers
    loose = with_unilateral_springs(linear, "ballast", hanging=hanging)
    train = track.train(4)

    def simulated(structure: asp.Structure, contact: str, steps: int) -> asp.Result:
        crossing = asp.Crossing(structure, train, speed=track.SPEED, start=track.START)
        return asp.simulate(
            crossing, time_step=track.TIME_STEP, steps=steps, contact=contact, reactions=False
        )

    steps = _SHORT if quick else _STEPS
    for structure in (linear, loose):  # compiled loops are read from disk, or made
        simulated(structure, "rigid", 3)

    def work(structure: asp.Structure, contact: str = "rigid") -> dict[str, float | str]:
        begun = time.process_time()
        result = simulated(structure, contact, steps)
        facts: dict[str, float | str] = {COST: 1e6 * (time.process_time() - begun) / steps}
        names = ("nonlinear_springs", "nonlinear_springs_active", "newton_iterations_largest")
        return facts | {name: float(result.facts[name]) for name in names if name in result.facts}

    alternatives = {
        "linear": lambda: work(linear),
        "601 unilateral springs": lambda: work(unilateral),
        "four of them hang": lambda: work(loose),
        "contact: hertz": lambda: work(linear, "hertz"),
        "contact: unilateral": lambda: work(linear, "unilateral"),
        "hertz, hanging": lambda: work(loose, "hertz"),
    }
    return in_turns("nonlinear ballasted bridge", alternatives, runs)
