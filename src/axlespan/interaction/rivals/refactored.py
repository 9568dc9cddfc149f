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

from axlespan.interaction.contact_system import Stretch
from axlespan.interaction.convoy import Convoy
from axlespan.interaction.march import all_forces

FloatArray = npt.NDArray[np.float64]


def couple_by_refactoring(
    convoy: Convoy, stretch: Stretch, k: int, external: FloatArray | None
) -> FloatArray:
    """One step of a single lane, with a factorization if there are wheels on the structure."""
    structure, fleet, into = convoy.structure, convoy.fleet, stretch.into
    known = convoy.predict(stretch, k, external)
    if fleet is None:
        structure.take(None, known)
        return convoy.joint.weight
    fleet.predict()
    gap = stretch.gap[k] - fleet.at_wheels()
    if len(into):
        _correct(convoy, stretch, k, gap)
        gap[into] += structure.gather(stretch.flat[k], stretch.held[k], stretch.weights[k])
        convoy.count("factorizations", 1)
    forces = np.asarray(fleet.stiffness @ gap)
    if len(into):
        structure.take_solved(structure.path_load(stretch.held[k], stretch.weights[k], forces[into]), known)
    else:
        structure.take(None, known)
    fleet.take(forces)
    return all_forces(convoy, forces)


def _correct(convoy: Convoy, stretch: Stretch, k: int, gap: FloatArray) -> None:
    """Add the response to contact, by the condensed matrix, to the structure's free acceleration."""
    structure, fleet, into = convoy.structure, convoy.fleet, stretch.into
    assert fleet is not None
    body, dofs, weights = structure.integrator, stretch.flat[k], stretch.weights[k]
    row = np.broadcast_to(np.arange(len(into))[:, None], dofs.shape)
    E = sp.csr_array(
        sp.coo_array((weights.ravel(), (row.ravel(), dofs.ravel())), shape=(len(into), body.size))
    )
    stiffness = sp.csr_array(fleet.stiffness)[into][:, into]
    condensed = sp.csr_array(body.effective + (body.weight_c * body.u_from_a) * (E.T @ stiffness @ E))
    reached = gap.copy()
    reached[into] += structure.gather(dofs, stretch.held[k], weights)
    forces = np.asarray(fleet.stiffness @ reached)[into]
    structure.stepper.add(body.factor_of(condensed).solve(-body.weight_c * (E.T @ forces)))
