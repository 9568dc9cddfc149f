"""N12's example 3.2 on 50 beam elements: 14 000 steps, 50 sprung masses; the direct method and its rivals."""

from __future__ import annotations

import time

import axlespan as asp
from benchmarks.timing import Row, in_turns

STEPS = 14_000
# The direct method satisfies compatibility to rounding; this brings the iteration close to it.
EQUAL = asp.Iteration(tolerance=1e-12)


def crossing() -> asp.Crossing:
    """Example 3.2."""
    bridge = asp.bridges.simple_span(
        length=25.0, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=50
    )
    train = asp.Train.of(asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6), count=50, spacing=3.0)
    surface = asp.irregularity.Harmonic(amplitude=0.5e-3, wavelength=5.0, start=0.0, stop=25.0)
    return asp.Crossing(bridge, train, speed=47.7 / 3.6, irregularity=surface)


def run(runs: int, quick: bool = False) -> list[Row]:
    """The three couplings, in turns; the iteration to the same accuracy (1e-10 of the static load)."""
    case, steps = crossing(), 3000 if quick else STEPS

    def work(coupling: str) -> dict[str, float | str]:
        begun = time.process_time()
        result = asp.simulate(
            case, time_step=1e-3, steps=steps, method=asp.Alpha(0.0), coupling=coupling, iteration=EQUAL
        )
        facts = {"us/step": 1e6 * (time.process_time() - begun) / steps}
        return facts | {
            name: float(result.facts[name])
            for name in ("iterations", "factorizations")
            if name in result.facts
        }

    asp.simulate(case, time_step=1e-3, steps=10, method=asp.Alpha(0.0))  # imports and compiles
    couplings = {name: (lambda name=name: work(name)) for name in ("direct", "iterative", "refactored")}
    return in_turns("example 3.2 on beams", couplings, runs)
