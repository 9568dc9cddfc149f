"""A ballasted track over a 40 m bridge and its approaches: 5555 d.o.f., the 32 wheels of an ICE 3, 3650 steps."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

import numpy as np

import axlespan as asp
from axlespan.interaction.contact_system import path_compliance, rows_of, solve_contact
from axlespan.interaction.groundwork import prepare
from axlespan.interaction.plan import plan_for
from axlespan.interaction.settings import settings_for
from benchmarks.timing import Row, in_turns, per_step

SPAN, APPROACH = 40.0, 250.0  # [m]
# All wheels are on the track from the first step to the last; most columns of its compliance are there after the first
# stretch of 256.
START, SPEED, TIME_STEP, STEPS, FIRST = 30.0, 300.0 / 3.6, 4e-4, 3650, 256


def bridge(span: float = SPAN, approach: float = APPROACH) -> asp.Structure:
    """Rail, sleepers and ballast of Zhai, Wang and Lin (2004) on a span and on the ground; elements of 1 m."""
    deck = asp.bridges.simple_span(
        length=span, youngs_modulus=3.4e10, second_moment=4.2, mass_per_length=18e3, elements=round(span)
    )
    return asp.bridges.with_track(deck, asp.bridges.ballasted_track(), approach=approach, exit=approach)


def train(cars: int = 8) -> asp.Train:
    """The first cars of an ICE 3."""
    return asp.Train(asp.vehicles.library.train("ice3").placements[:cars], f"{cars} cars of an ICE 3")


def crossing(structure: asp.Structure, speed: float = SPEED, cars: int = 8) -> asp.Crossing:
    """Some cars on a track in good order."""
    surface = asp.irregularity.realize("german-low", 1000.0, seed=1)
    return asp.Crossing(structure, train(cars), speed=speed, start=START, irregularity=surface)


def floor(case: asp.Crossing, count: int = 200) -> tuple[float, dict[str, float]]:
    """Least time of a step [s] and its parts [µs]: a banded solve, the products, the contact system, eight passes."""
    plan = plan_for(case, settings_for(case, time_step=TIME_STEP, steps=count))
    prepared = prepare([plan])
    body, columns = prepared.integrator, prepared.columns
    rows = rows_of(plan, np.arange(1, count + 1))
    columns.hold(rows.dofs[rows.weights != 0.0])
    local = columns.position[rows.dofs]
    systems = path_compliance(columns, local, rows.weights) + 1e-9 * np.eye(local.shape[1])
    gap, x = np.ones(local.shape[1]), np.random.default_rng(1).standard_normal(body.size)
    work = x.copy()

    def times(what: Callable[[int], object]) -> float:
        what(0)
        begun = time.process_time()
        for k in range(count):
            what(k)
        return (time.process_time() - begun) / count

    begun = time.process_time()
    path_compliance(columns, local, rows.weights)
    compliance = (time.process_time() - begun) / count
    parts = {
        "solve": times(lambda k: body.factor.solve(x, out=work)),
        "products": times(lambda k: (body.K @ x, None if body.C is None else body.C @ x)),
        "contact": compliance + times(lambda k: solve_contact(systems[k], gap)),
        "passes": 8 * times(lambda k: np.multiply(x, 2.0, out=work)),
    }
    return sum(parts.values()), {f"{name} us": 1e6 * value for name, value in parts.items()}


def run(runs: int, quick: bool = False) -> list[Row]:
    """The floor, one crossing all in, and a sweep of 48 speeds in lockstep."""
    structure = bridge()
    case = crossing(structure)
    steps, lanes = (600, 16) if quick else (STEPS, 48)
    sweep = [crossing(structure, speed=60.0 + 23.0 * i / lanes) for i in range(lanes)]
    floor(case)
    asp.simulate(case, time_step=TIME_STEP, steps=3)
    asp.simulate_many(sweep, time_step=TIME_STEP, steps=3)

    def work(name: str) -> dict[str, float | str]:
        if name == "floor":
            total, parts = floor(case)
            return {"us/step": 1e6 * total, **parts}
        if name == "one crossing":
            return per_step(lambda n: asp.simulate(case, time_step=TIME_STEP, steps=n), steps, 1, FIRST)
        return per_step(lambda n: asp.simulate_many(sweep, time_step=TIME_STEP, steps=n), steps, lanes, FIRST)

    names = ("floor", "one crossing", f"{lanes} speeds side by side")
    return in_turns("ballasted track", {name: partial(work, name) for name in names}, runs)
