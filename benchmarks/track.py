"""A ballasted track over a 40 m bridge and its approaches: 5435 d.o.f., 32 wheels of an eight-car train, 3650 steps."""

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
from axlespan.model.compile import compile_model
from axlespan.model.model import Model
from axlespan.running.line import path_on_beams
from axlespan.vehicles.multibody import Body, Suspension, Wheel, multibody
from benchmarks.timing import Row, in_turns, per_step

BAY, SPAN, APPROACH, PER_BAY = (
    0.6,
    66,
    232,
    4,
)  # sleeper spacing [m], bays on the bridge, before and behind it
# All wheels are on the track from the first step to the last; most columns of its compliance are there after the first
# stretch of 256.
START, SPEED, TIME_STEP, STEPS, FIRST = 193.5, 300.0 / 3.6, 4e-4, 3650, 256
# Track of Zhai, Wang and Lin (2004), two rails.
PAD, BALLAST, SUB_BALLAST = (2 * 6.5e7, 2 * 7.5e4), (2 * 137.75e6, 2 * 5.88e4), (2 * 77.5e6, 2 * 3.115e4)


def layer(model: Model, pairs: np.ndarray, of: tuple[float, float], name: str) -> Model:
    """Springs and dashpots between pairs of nodes."""
    return model.with_springs(pairs, {"z": of[0]}, {"z": of[1]}, name=name)


def bridge(span: int = SPAN, approach: int = APPROACH) -> asp.Structure:
    """Rail on pads, sleepers, ballast and sub-ballast, on the ground and on the bridge; numbers are bays."""
    bays = span + 2 * approach
    n_rail, n_sleeper = bays * PER_BAY + 1, bays + 1
    x = np.arange(n_sleeper) * BAY
    rail = np.column_stack([np.linspace(0.0, bays * BAY, n_rail), np.zeros(n_rail)])
    sleepers, ballast = (np.column_stack([x, np.full(n_sleeper, z)]) for z in (-0.2, -0.5))
    deck = np.column_stack([x[approach : approach + span + 1], np.full(span + 1, -1.5)])
    ground_at = np.r_[0:approach, approach + span + 1 : n_sleeper]
    ground = np.column_stack([x[ground_at], np.full(len(ground_at), -0.8)])
    model = Model(plane=True).with_nodes(np.vstack([rail, sleepers, ballast, deck, ground]))
    first = np.cumsum([0, n_rail, n_sleeper, n_sleeper, span + 1])
    r, s, b, d, g = (
        first[i] + np.arange(n) for i, n in enumerate((n_rail, n_sleeper, n_sleeper, span + 1, len(ground)))
    )
    steel, concrete = asp.Material(2.1e11, 0.3, 7850.0), asp.Material(3.4e10, 0.2, 2500.0)
    rails = asp.BeamSection(second_moment=2 * 3.038e-5, mass_per_length=2 * 60.21).properties(steel)
    box = asp.BeamSection(second_moment=4.2, mass_per_length=18e3).properties(concrete)
    model = model.with_beams(np.column_stack([r[:-1], r[1:]]), rails, name="rail")
    model = model.with_beams(np.column_stack([d[:-1], d[1:]]), box, name="deck")
    for nodes, mass in ((s, 251.0), (b, 2 * 531.4)):
        for node in nodes.tolist():
            model = model.with_mass(node, mass, directions=("z",))
    model = layer(model, np.column_stack([r[::PER_BAY], s]), PAD, "pads")
    model = layer(model, np.column_stack([s, b]), BALLAST, "ballast")
    model = layer(model, np.column_stack([b[approach : approach + span + 1], d]), SUB_BALLAST, "sub-ballast")
    model = layer(model, np.column_stack([b[ground_at], g]), SUB_BALLAST, "sub-ballast on ground")
    model = model.with_supports(g, ("z",), name="ground")
    for node, name in ((d[0], "left"), (d[-1], "right")):
        model = model.with_support(int(node), ("z",), name=name)
    compiled = compile_model(model)
    path = path_on_beams(model, compiled.table, r.tolist())
    lines = {"main": path.transformed(compiled.system.elimination)}
    return asp.Structure(system=compiled.system, lines=lines, model=model, name="ballasted track bridge")


def car() -> asp.Vehicle:
    """ICE3 Velaro E after Goicolea (2014): 10 d.o.f."""
    bogies = [Body(f"bogie{i + 1}", 3500.0, at, 1715.0) for i, at in enumerate((1.25, 18.625))]
    wheels = [Wheel(at, 1800.0) for at in (0.0, 2.5, 17.375, 19.875)]
    primary = [Suspension((f"bogie{1 + i // 2}", f"wheel{i + 1}"), 2.4e6, 2e4) for i in range(4)]
    secondary = [Suspension(("body", f"bogie{i + 1}"), 0.7e6, 4e4) for i in range(2)]
    return multibody(
        bodies=[Body("body", 47_800.0, 9.9375, 1_957_888.0), *bogies],
        wheels=wheels,
        suspensions=[*primary, *secondary],
        name="ICE3",
    )


def crossing(structure: asp.Structure, speed: float = SPEED, cars: int = 8) -> asp.Crossing:
    """Eight cars on a rail with a wavy profile."""
    surface = asp.irregularity.Harmonic(amplitude=0.5e-3, wavelength=5.0)
    train = asp.Train.of(car(), cars, 24.775)
    return asp.Crossing(structure, train, speed=speed, start=START, irregularity=surface)


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
    asp.simulate(case, time_step=TIME_STEP, steps=3)
    asp.simulate_many(sweep[:2], time_step=TIME_STEP, steps=3)

    def work(name: str) -> dict[str, float | str]:
        if name == "floor":
            total, parts = floor(case)
            return {"us/step": 1e6 * total, **parts}
        if name == "one crossing":
            return per_step(lambda n: asp.simulate(case, time_step=TIME_STEP, steps=n), steps, 1, FIRST)
        return per_step(lambda n: asp.simulate_many(sweep, time_step=TIME_STEP, steps=n), steps, lanes, FIRST)

    names = ("floor", "one crossing", f"{lanes} speeds side by side")
    return in_turns("ballasted track", {name: partial(work, name) for name in names}, runs)
