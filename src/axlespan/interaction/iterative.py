"""The iterative rival: two separate systems, made compatible by fixed-point iteration in each step.

The structure is solved under guessed contact forces, the vehicles are led along the deflected line, and the
contact forces that this takes are the next guess. N12's introduction discusses such methods ([8-10] there).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.integrator import State
from axlespan.errors import AnalysisError
from axlespan.interaction.bodies import FleetBody, StructureBody
from axlespan.interaction.contact_system import Stretch, stretches
from axlespan.interaction.march import bodies_of, forced_load, initial_path_load, weighted_forces
from axlespan.interaction.plan import Plan
from axlespan.interaction.recorder import Recorder
from axlespan.interaction.start import Start

FloatArray = npt.NDArray[np.float64]


def march_iterative(plan: Plan, start: Start, recorder: Recorder) -> tuple[StructureBody, FleetBody | None]:
    """Compute all steps of a crossing by iteration between structure and vehicles.

    Raises
    ------
    AnalysisError
        If a step does not converge, with the step, the residual and a remedy.
    """
    structure, fleet = bodies_of(plan, start)
    structure.path_load[:] = initial_path_load(plan, structure, start)
    recorder.begin(structure, fleet, start.forces)
    iterations = 0
    for stretch in stretches(plan, structure, fleet, systems=False):
        external = weighted_forces(plan, stretch)
        with np.errstate(over="ignore", invalid="ignore"):
            for k in range(stretch.n_step):
                forces, count = _step(plan, structure, fleet, stretch, k, external[k])
                iterations += count
                recorder.step(stretch, k, structure, fleet, forces)
        recorder.end_of(stretch)
    recorder.counts["iterations"] = iterations
    return structure, fleet


def _step(
    plan: Plan,
    structure: StructureBody,
    fleet: FleetBody | None,
    stretch: Stretch,
    k: int,
    external: FloatArray,
) -> tuple[FloatArray, int]:
    all_forces = plan.fleet.weight.copy()
    load = forced_load(plan, structure, stretch, k)
    structure.predict(plan.forces.vectors @ external, load)
    known = np.zeros_like(structure.path_load) if load is None else load
    if fleet is None:
        structure.path_load = known
        return all_forces, 0
    fleet.predict()
    on, into = stretch.live_coupled, stretch.into_coupled
    dofs, local, weights = (rows[k][on] for rows in (stretch.dofs, stretch.local, stretch.weights))
    gap = stretch.gap[k] - fleet.at_wheels()
    free = structure.state.copy()
    forces, count = _iterate(
        plan, structure, fleet, free, (dofs, local, weights), gap, into, stretch.first + k
    )
    coupled = structure.path_force(local, weights, forces[into])
    structure.path_load = coupled + known
    fleet.correct(forces)
    all_forces[plan.fleet.coupled] = forces
    return all_forces, count


def _iterate(
    plan: Plan,
    structure: StructureBody,
    fleet: FleetBody,
    free: State,
    rows: tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], FloatArray],
    gap: FloatArray,
    into: npt.NDArray[np.int64],
    step: int,
) -> tuple[FloatArray, int]:
    """Contact forces (n_coupled,) of one step and the iterations they took; the structure is left with them."""
    dofs, local, weights = rows
    settings = plan.settings.iteration
    limit = settings.tolerance * float(np.abs(fleet.static).max())
    forces, residual = fleet.forces, np.inf
    for count in range(1, settings.limit + 1):
        force = np.zeros(structure.integrator.size)
        force[structure.path_dofs] = -structure.integrator.weight_c * structure.path_force(
            local, weights, forces[into]
        )
        structure.state = free.copy()
        structure.integrator.correct(structure.state, structure.integrator.factor.solve(force, out=force))
        reached = gap.copy()
        reached[into] += structure.under(dofs, weights)
        wanted = fleet.stiffness @ reached
        residual = float(np.abs(wanted - forces).max())
        if residual <= limit or not len(into):
            return wanted, count
        forces = forces + settings.relaxation * (wanted - forces)
        if not np.isfinite(residual):
            break
    raise AnalysisError(
        f"step {step}, t = {step * plan.settings.time_step:.6g} s: the iteration between structure and vehicles did not converge "
        f"in {settings.limit} iterations (last change {residual:.3g} N, tolerance {limit:.3g} N). Use the direct method, "
        "a relaxation below 1, or a smaller time step"
    )
