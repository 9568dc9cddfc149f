"""N12's example 3.2 on 10 000 eight-node solids, 36 597 free d.o.f.: steps of the exact method, and the reduced one."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

import axlespan as asp
from axlespan.dynamics.integrator import Integrator
from axlespan.interaction.plan import matrices_of
from axlespan.interaction.simulate import reduce_structure
from axlespan.model.compile import compile_model
from axlespan.model.from_mesh import Solids
from axlespan.model.mesh import Mesh
from axlespan.running.surface import line_over
from benchmarks.timing import COST, Row, in_turns, per_step

STEPS, SHORT = 300, 60
LENGTH, WIDTH, HEIGHT = 25.0, 2.2272, 2.5


def bridge() -> asp.Structure:
    """The solid beam, pinned along the middle of both ends."""
    mesh = Mesh.box((LENGTH, WIDTH, HEIGHT), (100, 10, 10), origin=(0.0, -0.5 * WIDTH, 0.0))
    concrete = asp.Material(2.87e9, 0.2, 2303.0 / (WIDTH * HEIGHT))
    model = asp.Model(plane=False).with_mesh(mesh, {"volume": Solids(concrete, formulation="full")})
    x, _, z = model.points.T
    for at, name in ((0.0, "left"), (LENGTH, "right")):
        nodes = np.flatnonzero((np.abs(x - at) < 1e-9) & (np.abs(z - 0.5 * HEIGHT) < 1e-9))
        model = model.with_supports(nodes, ("x", "y", "z"), name=name)
    compiled = compile_model(model)
    path = line_over(model, compiled.table, [(0.0, 0.0, HEIGHT), (LENGTH, 0.0, HEIGHT)])
    lines = {"main": path.transformed(compiled.system.elimination)}
    return asp.Structure(system=compiled.system, lines=lines, model=model, name="solid beam")


def crossing(structure: asp.Structure, speed: float = 47.7 / 3.6, start: float = 60.0) -> asp.Crossing:
    """Example 3.2 with the span full of wheels from the first step on."""
    train = asp.Train.of(asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6), count=50, spacing=3.0)
    surface = asp.irregularity.Harmonic(amplitude=0.5e-3, wavelength=5.0, start=0.0, stop=25.0)
    return asp.Crossing(structure, train, speed=speed, start=start, irregularity=surface)


def run(runs: int, quick: bool = False) -> list[Row]:
    """Floor, exact steps by solver, rivals, lockstep and reduced."""
    structure = bridge()
    structure.require_stable()
    case = crossing(structure)
    options = {"time_step": 1e-3, "method": asp.Alpha(0.0)}
    integrator = Integrator(matrices_of(structure.system), asp.Alpha(0.0), 1e-3)
    load = np.random.default_rng(1).standard_normal(integrator.size)
    work = load.copy()
    many, short, lanes = (100, 20, 8) if quick else (STEPS, SHORT, 32)

    def floor() -> dict[str, float | str]:
        begun = time.process_time()
        for _ in range(many):
            integrator.factor.solve(load, out=work)
            integrator.K @ work
        return {COST: 1e6 * (time.process_time() - begun) / many}

    def setup_floor() -> dict[str, float | str]:
        """One factorization, and the columns that the first stretch of steps needs."""
        begun = time.process_time()
        own = Integrator(matrices_of(structure.system), asp.Alpha(0.0), 1e-3)
        own.columns(structure.line().path_dofs[:1].repeat(80))
        return {COST: 0.0, "before s": time.process_time() - begun}

    def steps(n: int, **more: object) -> dict[str, float | str]:
        """Cost of a step, without the set-up: the end of a run of one step to that of a long one."""
        facts = per_step(lambda k: asp.simulate(case, steps=k, **options, **more), n)  # type: ignore[arg-type]
        return facts

    sweep = [crossing(structure, speed=10.0 + 0.5 * i) for i in range(lanes)]

    def lockstep() -> dict[str, float | str]:
        return per_step(lambda k: asp.simulate_many(sweep, steps=k, **options), many, lanes)  # type: ignore[arg-type]

    alternatives: dict[str, Callable[[], dict[str, float | str]]] = {
        "floor: solve and product": floor,
        "factorization and columns": setup_floor,
        "direct": lambda: steps(many),
        "direct, PARDISO": lambda: steps(short, solver="pardiso"),
        "iterative": lambda: steps(short, coupling="iterative"),
        "refactored": lambda: steps(4, coupling="refactored"),
        f"direct, {lanes} side by side": lockstep,
    }
    if not quick:
        basis = reduce_structure(structure)
        alternatives |= {
            "direct, SuperLU": lambda: steps(short, solver="superlu"),
            "reduced basis, built": lambda: {"shapes": float(reduce_structure(structure).size)},
            "reduced basis": lambda: steps(2000, basis=basis),
        }
    return in_turns("example 3.2 on solids", alternatives, runs)
