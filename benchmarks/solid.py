"""N12's example 3.2 on 10 000 eight-node solids, 36 597 free d.o.f.: steps of the exact method, and the reduced one."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

import axlespan as asp
from axlespan.dynamics.integrator import Integrator
from axlespan.interaction.contact_system import rows_of
from axlespan.interaction.fleet import matrices_of
from axlespan.interaction.plan import plan_for
from axlespan.interaction.settings import settings_for
from axlespan.interaction.simulate import reduce_structure
from axlespan.model.compile import compile_model
from axlespan.model.from_mesh import Solids
from axlespan.model.mesh import Mesh
from axlespan.running.surface import line_over
from benchmarks.timing import COST, Row, in_turns, per_step

STEPS, SHORT, WHOLE = 300, 60, 14_000
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


def literal_step(integrator: Integrator, path_dofs: np.ndarray, wheels: int = 9) -> Callable[[], object]:
    """A step as N12 (A.5) has it: a forward substitution for each wheel, on this factor; E has one entry a wheel."""
    factor, n = integrator.factor, integrator.size
    loads = np.zeros((n, wheels))
    loads[path_dofs[:: len(path_dofs) // wheels][:wheels], np.arange(wheels)] = 1.0
    force, u = np.random.default_rng(2).standard_normal((2, n))

    def step() -> object:
        y = factor.forward(force - integrator.K @ u)  # type: ignore[union-attr]
        Y = factor.forward(loads)  # type: ignore[union-attr]
        X = np.linalg.solve(Y.T @ Y + 1e-12 * np.eye(wheels), Y.T @ y)
        return factor.backward(y - Y @ X)  # type: ignore[union-attr]

    return step


def setup(case: asp.Crossing, options: dict[str, object], runs: int) -> list[Row]:
    """All that comes before the second step, beside one factorization and the columns of the path."""
    plan = plan_for(case, settings_for(case, steps=1, **options))  # type: ignore[arg-type]
    rows = rows_of(plan, np.array([1]))
    dofs = np.unique(rows.dofs[rows.weights != 0.0])

    path = plan.rows.paths[0].free.path_dofs

    def least() -> None:
        Integrator(plan.structure, asp.Alpha(0.0), 1e-3).columns(dofs)

    def columns() -> None:
        Integrator(plan.structure, asp.Alpha(0.0), 1e-3).columns(path)

    def whole() -> None:
        asp.simulate(case, steps=1, **options)  # type: ignore[arg-type]

    alternatives = {
        "factorization, all columns": columns,
        "factorization, first columns": least,
        "run of one step": whole,
    }
    return in_turns("example 3.2 on solids, set-up", alternatives, runs)


def run(runs: int, quick: bool = False) -> list[Row]:
    """Floor, exact steps by solver, rivals, lockstep and reduced."""
    structure = bridge()
    structure.require_stable()
    case = crossing(structure)
    options: dict[str, object] = {"time_step": 1e-3, "method": asp.Alpha(0.0)}
    integrator = Integrator(matrices_of(structure.system), asp.Alpha(0.0), 1e-3)
    load = np.random.default_rng(1).standard_normal(integrator.size)
    work = load.copy()
    many, short, lanes = (60, 12, 8) if quick else (STEPS, SHORT, 32)
    literal = literal_step(integrator, structure.line().path_dofs)
    cost: dict[str, float] = {}
    passage, count = crossing(structure, start=0.0), WHOLE

    def repeated(step: Callable[[], object], count: int) -> dict[str, float | str]:
        begun = time.process_time()
        for _ in range(count):
            step()
        return {COST: 1e6 * (time.process_time() - begun) / count}

    def floor() -> None:
        integrator.factor.solve(load, out=work)
        integrator.K @ work

    def steps(n: int, **more: object) -> dict[str, float | str]:
        return per_step(lambda k: asp.simulate(case, steps=k, **options, **more), n)  # type: ignore[arg-type]

    def exact() -> dict[str, float | str]:
        facts = steps(many)
        cost["exact"] = float(facts[COST])
        return facts

    def reduced() -> dict[str, float | str]:
        """A basis built, and a run in it; what all of example 3.2 takes beside the exact steps."""
        begun = time.process_time()
        basis = reduce_structure(structure)
        building = time.process_time() - begun
        facts = per_step(lambda k: asp.simulate(passage, steps=k, basis=basis, **options), count)  # type: ignore[arg-type]
        whole = building + 1e-6 * WHOLE * float(facts[COST])
        return facts | {
            "shapes": float(basis.size),
            "building s": building,
            f"exact/reduced, {WHOLE} steps": 1e-6 * WHOLE * cost["exact"] / whole,
        }

    sweep = [crossing(structure, speed=10.0 + 0.5 * i) for i in range(lanes)]

    def lockstep() -> dict[str, float | str]:
        return per_step(lambda k: asp.simulate_many(sweep, steps=k, **options), short, lanes)  # type: ignore[arg-type]

    alternatives: dict[str, Callable[[], dict[str, float | str]]] = {
        "floor: solve and product": lambda: repeated(floor, many),
        "direct": exact,
        "N12 (A.5), literally": lambda: repeated(literal, short),
        "iterative": lambda: steps(short, coupling="iterative"),
        "refactored": lambda: steps(4, coupling="refactored"),
        f"direct, {lanes} side by side": lockstep,
        "reduced basis": reduced,
    }
    if not quick:
        alternatives |= {
            "direct, PARDISO": lambda: steps(short, solver="pardiso"),
            "direct, SuperLU": lambda: steps(short, solver="superlu"),
        }
    return [*setup(case, options, runs), *in_turns("example 3.2 on solids", alternatives, runs)]
