"""How the cost of a step grows: with the length of the structure, the wheels, the steps and the crossings."""

from __future__ import annotations

from functools import partial

import axlespan as asp
from benchmarks import track
from benchmarks.timing import Row, in_turns, per_step


def run(runs: int, quick: bool = False) -> list[Row]:
    """Each doubling beside what is doubled."""
    steps = 1280 if quick else 2304
    options = {"time_step": track.TIME_STEP}
    short, long = track.bridge(), track.bridge(2 * track.SPAN, 2 * track.APPROACH)
    cases = {
        "as it is": track.crossing(short),
        "twice the length": track.crossing(long),
        "half the wheels": track.crossing(short, cars=4),
    }
    for case in cases.values():
        asp.simulate(case, steps=3, **options)  # type: ignore[arg-type]

    asp.simulate_many([cases["as it is"]] * 4, steps=3, **options)  # type: ignore[arg-type]

    def alone(case: asp.Crossing, n: int) -> dict[str, float | str]:
        return per_step(lambda k: asp.simulate(case, steps=k, **options), n, 1, track.FIRST)  # type: ignore[arg-type]

    def together(lanes: int) -> dict[str, float | str]:
        several = [track.crossing(short, speed=60.0 + 23.0 * i / lanes) for i in range(lanes)]
        run = lambda k: asp.simulate_many(several, steps=k, **options)  # type: ignore[arg-type] # noqa: E731
        return per_step(run, steps, lanes, track.FIRST)

    alternatives = {name: partial(alone, case, steps) for name, case in cases.items()}
    alternatives["twice the steps"] = partial(alone, cases["as it is"], 2 * steps)
    alternatives |= {f"{n} crossings": partial(together, n) for n in ((4, 8) if quick else (4, 8, 16, 32))}
    return in_turns("growth, ballasted track", alternatives, runs)
