"""N12's example 3.2 on 10 000 eight-node solids, 36 597 free d.o.f.: steps of the exact method, and the reduced one."""

from __future__ import annotations

import time

import numpy as np

import axlespan as asp
from axlespan.dynamics.integrator import Integrator
from axlespan.interaction.plan import matrices_of
from axlespan.interaction.simulate import reduce_structure
from axlespan.model.compile import compile_model
from axlespan.model.from_mesh import Solids
from axlespan.model.mesh import Mesh
from axlespan.running.surface import line_over
from benchmarks.timing import Row, in_turns

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


def run(runs: int) -> list[Row]:
    """Floor, exact steps by solver, rivals, lockstep and reduced."""
    structure = bridge()
    structure.require_stable()
    case = crossing(structure)
    options = {"time_step": 1e-3, "method": asp.Alpha(0.0)}
    integrator = Integrator(matrices_of(structure.system), asp.Alpha(0.0), 1e-3)
    load = np.random.default_rng(1).standard_normal(integrator.size)
    work = load.copy()

    def floor() -> dict[str, float | str]:
        for _ in range(100):
            integrator.factor.solve(load, out=work)
            integrator.K @ work
        return {"steps": 100.0}

    def steps(n: int, **more: object) -> dict[str, float | str]:
        result = asp.simulate(case, steps=n, **options, **more)  # type: ignore[arg-type]
        begun = time.perf_counter()
        asp.simulate(case, steps=1, **options, **more)  # type: ignore[arg-type]
        setup = time.perf_counter() - begun
        per_step = (float(result.facts["wall_time"]) - setup) / (n - 1)
        return {"ms/step": 1e3 * per_step, "set-up s": setup, "solver": str(result.facts["solver"])}

    def lockstep() -> dict[str, float | str]:
        cases = [crossing(structure, speed=10.0 + 0.5 * i) for i in range(32)]
        begun = time.perf_counter()
        asp.simulate_many(cases, steps=SHORT, **options)  # type: ignore[arg-type]
        return {"ms/crossing-step": 1e3 * (time.perf_counter() - begun) / (32 * SHORT)}

    basis = reduce_structure(structure)

    def reduced() -> dict[str, float | str]:
        result = asp.simulate(case, steps=2000, **options, basis=basis)  # type: ignore[arg-type]
        return {"ms/step": 1e3 * float(result.facts["wall_time"]) / 2000, "shapes": float(basis.size)}

    return in_turns(
        "example 3.2 on solids",
        {
            "floor: solve and product, 100 x": floor,
            f"direct, {STEPS} steps": lambda: steps(STEPS),
            f"direct, PARDISO, {SHORT} steps": lambda: steps(SHORT, solver="pardiso"),
            f"direct, SuperLU, {SHORT} steps": lambda: steps(SHORT, solver="superlu"),
            f"iterative, {SHORT} steps": lambda: steps(SHORT, coupling="iterative"),
            "refactored, 10 steps": lambda: steps(10, coupling="refactored"),
            f"direct, 32 side by side, {SHORT} steps": lockstep,
            "reduced basis, built": lambda: {"shapes": float(reduce_structure(structure).size)},
            "reduced basis, 2000 steps": reduced,
        },
        runs,
    )
