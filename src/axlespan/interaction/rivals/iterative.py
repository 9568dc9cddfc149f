"""The iterative rival: two separate systems, made compatible by fixed-point iteration in each step.

The structure is solved under guessed contact forces, the vehicles are led along the deflected line, and the
contact forces that this takes are the next guess. N12's introduction discusses such methods ([8-10] there).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.errors import AnalysisError
from axlespan.interaction.bodies import FleetBody
from axlespan.interaction.contact_system import Stretch
from axlespan.interaction.convoy import Convoy
from axlespan.interaction.march import all_forces
from axlespan.interaction.rivals.led_fleet import LedFleet

FloatArray = npt.NDArray[np.float64]


class IterativeCoupling:
    """Couples structure and vehicles by iteration; holds the vehicles' system as led along a line."""

    def __init__(self) -> None:
        self._led: LedFleet | None = None
        self._of: FleetBody | None = None

    def __call__(self, convoy: Convoy, stretch: Stretch, k: int, external: FloatArray | None) -> FloatArray:
        """One step of a single lane.

        Raises
        ------
        AnalysisError
            If the step does not converge, with the step, the residual and a remedy.
        """
        structure, fleet = convoy.structure, convoy.fleet
        known = convoy.predict(stretch, k, external)
        if fleet is None:
            structure.take(None, known)
            return convoy.joint.weight
        if self._led is None or self._of is not fleet:
            self._led, self._of = LedFleet(fleet), fleet
        fleet.predict()
        self._led.begin()
        forces = _converged(convoy, self._led, stretch, k)
        load = structure.path_load(stretch.held[k], stretch.weights[k], forces[stretch.into])
        structure.take_solved(load, known)
        fleet.take(forces)
        return all_forces(convoy, forces)


def _converged(convoy: Convoy, led: LedFleet, stretch: Stretch, k: int) -> FloatArray:
    """Contact forces (n_coupled,) of one step; the structure is left with their response."""
    structure, fleet = convoy.structure, convoy.fleet
    assert fleet is not None
    settings, into = convoy.plans[0].settings.iteration, stretch.into
    flat, held, weights = stretch.flat[k], stretch.held[k], stretch.weights[k]
    limit = settings.tolerance * float(np.abs(fleet.static).max())
    free = structure.stepper.acceleration.copy()
    forces, residual = fleet.forces, np.inf
    for count in range(1, settings.limit + 1):
        force = np.zeros(structure.integrator.size)
        force[structure.columns.held] = -structure.integrator.weight_c * structure.path_load(
            held, weights, forces[into]
        )
        structure.stepper.acceleration[...] = free + structure.integrator.factor.solve(force, out=force)
        line = stretch.gap[k].copy()
        if len(into):
            line[into] += structure.gather(flat, held, weights)
        wanted = led.forces(line)
        residual = float(np.abs(wanted - forces).max())
        if residual <= limit or not len(into):
            convoy.count("iterations", count)
            return wanted
        if not np.isfinite(residual):
            break
        forces = forces + settings.relaxation * (wanted - forces)
    step = stretch.first + k
    raise AnalysisError(
        f"step {step}, t = {step * convoy.plans[0].settings.time_step:.6g} s: the iteration between structure and "
        f"vehicles did not converge in {settings.limit} iterations (last change {residual:.3g} N, tolerance "
        f"{limit:.3g} N). Use the direct method, a relaxation below 1, or a smaller time step"
    )
