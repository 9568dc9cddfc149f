r"""The refactoring rival: contact condensed into the structure's matrix, assembled and factored at each step.

Eliminating the vehicles and the contact forces from N12 (35) adds the vehicles' dynamic stiffness to the
structure's effective matrix, at the places where the wheels are:

.. math:: \Big( A_s + (1+α) β Δt^2 E^T k E \Big) ü_s = b_s - (1+α) E^T k (E ũ + r - u_X)

with k the inverse of the vehicles' compliance at their contact points. This is what N12's [11-13] do.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.interaction.bodies import FleetBody, StructureBody
from axlespan.interaction.contact_system import Stretch, stretches
from axlespan.interaction.march import bodies_of, forced_load, initial_path_load, weighted_forces
from axlespan.interaction.plan import Plan
from axlespan.interaction.recorder import Recorder
from axlespan.interaction.start import Start

FloatArray = npt.NDArray[np.float64]


def march_refactored(plan: Plan, start: Start, recorder: Recorder) -> tuple[StructureBody, FleetBody | None]:
    """Compute all steps of a crossing with a factorization in each step that has wheels on the structure."""
    structure, fleet = bodies_of(plan, start)
    structure.path_load[:] = initial_path_load(plan, structure, start)
    recorder.begin(structure, fleet, start.forces)
    factorizations = 0
    for stretch in stretches(plan, structure, fleet, systems=False):
        external = weighted_forces(plan, stretch)
        for k in range(stretch.n_step):
            forces, factored = _step(plan, structure, fleet, stretch, k, external[k])
            factorizations += factored
            recorder.step(stretch, k, structure, fleet, forces)
        recorder.end_of(stretch)
    recorder.counts["factorizations"] = factorizations
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
    on, into = stretch.live_coupled, stretch.into_coupled
    structure.predict(plan.forces.vectors @ external, load)
    known = np.zeros_like(structure.path_load) if load is None else load
    if fleet is None:
        structure.path_load = known
        return all_forces, 0
    fleet.predict()
    gap = stretch.gap[k] - fleet.at_wheels()
    factored = 0
    if len(on):
        _condensed_step(structure, fleet, stretch, k, gap)
        gap[into] += structure.under(stretch.dofs[k][on], stretch.weights[k][on])
        factored = 1
    forces = fleet.stiffness @ gap
    coupled = structure.path_force(stretch.local[k][on], stretch.weights[k][on], forces[into])
    structure.path_load = coupled + known
    fleet.correct(forces)
    all_forces[plan.fleet.coupled] = forces
    return all_forces, factored


def _condensed_step(
    structure: StructureBody, fleet: FleetBody, stretch: Stretch, k: int, gap: FloatArray
) -> None:
    """Correct the free response of the structure with the condensed matrix."""
    body, on, into = structure.integrator, stretch.live_coupled, stretch.into_coupled
    dofs, weights = stretch.dofs[k][on], stretch.weights[k][on]
    row = np.broadcast_to(np.arange(len(on))[:, None], dofs.shape)
    E = sp.csr_array(sp.coo_array((weights.ravel(), (row.ravel(), dofs.ravel())), shape=(len(on), body.size)))
    stiffness = sp.csr_array(fleet.stiffness[np.ix_(into, into)])
    condensed = sp.csr_array(body.effective + (body.weight_c * body.u_from_a) * (E.T @ stiffness @ E))
    forces = (fleet.stiffness @ _with_line(gap, structure, dofs, weights, into))[into]
    response = body.factor_of(condensed).solve(-body.weight_c * (E.T @ forces))
    body.correct(structure.state, response)


def _with_line(
    gap: FloatArray,
    structure: StructureBody,
    dofs: npt.NDArray[np.int64],
    weights: FloatArray,
    into: npt.NDArray[np.int64],
) -> FloatArray:
    total = gap.copy()
    total[into] += structure.under(dofs, weights)
    return total
