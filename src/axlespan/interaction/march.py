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
from axlespan.interaction.contact_system import ContactSystemError, Stretch, solve_contact
from axlespan.interaction.convoy import Convoy

FloatArray = npt.NDArray[np.float64]


def couple_directly(convoy: Convoy, stretch: Stretch, k: int, external: FloatArray | None) -> FloatArray:
    """One step of all lanes by the direct method.

    Raises
    ------
    AnalysisError
        If a contact system is not positive definite.
    """
    structure, fleet = convoy.structure, convoy.fleet
    known = convoy.predict(stretch, k, external)
    if fleet is None:
        structure.take(None, known)
        return convoy.joint.weight
    fleet.predict()
    gap = stretch.gap[k] - fleet.at_wheels()
    into = stretch.into
    if len(into):
        gap[into] += structure.gather(stretch.flat[k], stretch.held[k], stretch.weights[k])
    forces = fleet.on_ground(gap)  # wheels of vehicles that are wholly off the structure
    load = None
    if len(into):
        try:
            for system in stretch.systems:
                forces[system.contacts] = solve_contact(system.matrices[k], gap[system.contacts])
        except ContactSystemError as error:
            raise AnalysisError(f"step {stretch.first + k}: {error}") from error
        load = structure.path_load(stretch.held[k], stretch.weights[k], forces[into])
    structure.take(load, known)
    fleet.take(forces)
    return all_forces(convoy, forces)


def all_forces(convoy: Convoy, coupled: FloatArray) -> FloatArray:
    """Forces of all contacts (n_contact,) from those of the coupled ones."""
    if len(coupled) == len(convoy.joint.weight):
        return coupled
    result = convoy.joint.weight.copy()
    result[convoy.joint.coupled] = coupled
    return result
