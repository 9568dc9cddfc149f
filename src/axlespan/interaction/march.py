"""The direct method in time: predict without contact, solve the contact system, correct.

One step from t to t + Δt:

1. both bodies advance under everything but the new contact forces;
2. the gap of these free responses, r + E u_s - u_X, divided by the small contact system S gives the
   contact forces X of all wheels (N12 (35), with u eliminated);
3. both bodies take X.

The structure's matrix is factored once. A step costs one solve with it, the sparse products of its right-hand
side, and dense algebra of the size of the wheels.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.errors import AnalysisError
from axlespan.interaction.bodies import FleetBody, StructureBody
from axlespan.interaction.contact_system import ContactSystemError, Stretch, solve_contact, stretches
from axlespan.interaction.plan import Plan
from axlespan.interaction.recorder import Recorder
from axlespan.interaction.start import Start

FloatArray = npt.NDArray[np.float64]


def bodies_of(plan: Plan, start: Start) -> tuple[StructureBody, FleetBody | None]:
    """Both bodies at time zero, factored."""
    settings = plan.settings
    used = [path.free.path_dofs for path in plan.rows.paths]
    structure = StructureBody(
        plan.structure,
        settings.method,
        settings.time_step,
        np.unique(np.concatenate(used)),
        solver=settings.solver,
    )
    structure.state = start.structure.copy()
    if not len(plan.fleet.coupled):
        return structure, None
    fleet = FleetBody(plan.fleet, settings.method, settings.time_step)
    fleet.state = start.fleet.copy()
    fleet.forces = start.forces[plan.fleet.coupled].copy()
    return structure, fleet


def march_direct(plan: Plan, start: Start, recorder: Recorder) -> tuple[StructureBody, FleetBody | None]:
    """Compute all steps of a crossing; the recorder keeps what is asked for.

    Raises
    ------
    AnalysisError
        If a value is not finite; the recorder holds the steps until then.
    """
    structure, fleet = bodies_of(plan, start)
    structure.path_load[:] = initial_path_load(plan, structure, start)
    recorder.begin(structure, fleet, start.forces)
    for stretch in stretches(plan, structure, fleet):
        external = weighted_forces(plan, stretch)
        with np.errstate(over="ignore", invalid="ignore"):
            for k in range(stretch.n_step):
                forces = _step(plan, structure, fleet, stretch, k, external[k])
                recorder.step(stretch, k, structure, fleet, forces)
        recorder.end_of(stretch)
    return structure, fleet


def _step(
    plan: Plan,
    structure: StructureBody,
    fleet: FleetBody | None,
    stretch: Stretch,
    k: int,
    external: FloatArray,
) -> FloatArray:
    """One step; returns all contact forces (n_contact,)."""
    all_forces = plan.fleet.weight.copy()
    dofs, local, weights = stretch.dofs[k], stretch.local[k], stretch.weights[k]
    load = forced_load(plan, structure, stretch, k)
    structure.predict(plan.forces.vectors @ external, load)
    if fleet is None:
        structure.path_load = load if load is not None else np.zeros_like(structure.path_load)
        return all_forces
    fleet.predict()
    gap = stretch.gap[k] - fleet.at_wheels()
    on = stretch.live_coupled
    if len(on):
        gap[stretch.into_coupled] += structure.under(dofs[on], weights[on])
    forces = fleet.stiffness @ gap
    if len(on):
        try:
            forces[stretch.active] = solve_contact(stretch.systems[k], gap[stretch.active])
        except ContactSystemError as error:
            raise AnalysisError(f"step {stretch.first + k}: {error}") from error
        coupled_load = structure.path_force(local[on], weights[on], forces[stretch.into_coupled])
        structure.correct(coupled_load)
        structure.path_load = coupled_load if load is None else coupled_load + load
    else:
        structure.path_load = np.zeros_like(structure.path_load) if load is None else load
    fleet.correct(forces)
    all_forces[plan.fleet.coupled] = forces
    return all_forces


def forced_load(plan: Plan, structure: StructureBody, stretch: Stretch, k: int) -> FloatArray | None:
    """Eᵀ P (n_path,) of the moving forces at a step; None where there are none."""
    forced = stretch.live_forced
    if not len(forced):
        return None
    return structure.path_force(
        stretch.local[k, forced], stretch.weights[k, forced], plan.fleet.weight[stretch.live[forced]]
    )


def weighted_forces(plan: Plan, stretch: Stretch) -> FloatArray:
    """Weighted factors (n_step, n_term) of the external forces."""
    steps = np.arange(stretch.first - 1, stretch.first + stretch.n_step)
    return plan.forces.weighted(plan.times_of(steps), plan.settings.method)


def initial_path_load(plan: Plan, structure: StructureBody, start: Start) -> FloatArray:
    """Eᵀ X (n_path,) at time zero."""
    positions = plan.rows.positions(np.zeros(1))
    wheels = np.arange(plan.rows.n_contact)
    block = plan.rows.rows(positions, wheels)
    return structure.path_force(structure.local[block.dofs[0]], block.weights[0], start.forces)
