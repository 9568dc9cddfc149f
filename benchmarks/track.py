"""A ballasted track over a 40 m bridge and its approaches: 5435 d.o.f., 32 wheels of an eight-car train, 3650 steps."""

from __future__ import annotations

import numpy as np

import axlespan as asp
from axlespan.model.compile import compile_model
from axlespan.model.model import Model
from axlespan.running.line import path_on_beams
from axlespan.vehicles.multibody import Body, Suspension, Wheel, multibody

BAY, SPAN, APPROACH, PER_BAY = 0.6, 66, 232, 4  # sleeper spacing [m], bays on the bridge, before and behind it
# All wheels are on the track from the first step to the last.
START, SPEED, TIME_STEP, STEPS = 193.5, 300.0 / 3.6, 4e-4, 3650
# Track of Zhai, Wang and Lin (2004), two rails.
PAD, BALLAST, SUB_BALLAST = (2 * 6.5e7, 2 * 7.5e4), (2 * 137.75e6, 2 * 5.88e4), (2 * 77.5e6, 2 * 3.115e4)


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
    r, s, b, d, g = (first[i] + np.arange(n) for i, n in enumerate((n_rail, n_sleeper, n_sleeper, span + 1, len(ground))))
    steel, concrete = asp.Material(2.1e11, 0.3, 7850.0), asp.Material(3.4e10, 0.2, 2500.0)
    rails = asp.BeamSection(second_moment=2 * 3.038e-5, mass_per_length=2 * 60.21).properties(steel)
    box = asp.BeamSection(second_moment=4.2, mass_per_length=18e3).properties(concrete)
    model = model.with_beams(np.column_stack([r[:-1], r[1:]]), rails, name="rail")
    model = model.with_beams(np.column_stack([d[:-1], d[1:]]), box, name="deck")
    for nodes, mass in ((s, 251.0), (b, 2 * 531.4)):
        part = model.with_mass(int(nodes[0]), mass, directions=("z",)).parts[-1]
        for node in nodes.tolist():
            model = model.with_mass(node, mass, directions=("z",))
        del part
    def layer(model: Model, pairs: np.ndarray, of: tuple[float, float], name: str) -> Model:
        return model.with_springs(pairs, {"z": of[0]}, {"z": of[1]}, name=name)
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
        wheels=wheels, suspensions=[*primary, *secondary], name="ICE3",
    )
