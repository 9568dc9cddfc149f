"""Simulate a crossing."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

from axlespan.dynamics.alpha import Alpha
from axlespan.errors import AnalysisError, Outcome
from axlespan.interaction.bodies import FleetBody, StructureBody
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.iterative import march_iterative
from axlespan.interaction.literal import march_literal
from axlespan.interaction.march import march_direct
from axlespan.interaction.plan import Plan, plan_for
from axlespan.interaction.recorder import Recorder
from axlespan.interaction.refactored import march_refactored
from axlespan.interaction.result import Result
from axlespan.interaction.settings import Iteration, settings_for
from axlespan.interaction.start import Start, start_of

_Bodies = tuple[StructureBody, FleetBody | None]
_MARCHES: dict[str, Callable[[Plan, Start, Recorder], _Bodies]] = {
    "direct": march_direct,
    "iterative": march_iterative,
    "refactored": march_refactored,
    "literal": march_literal,
}


def simulate(
    crossing: Crossing,
    *,
    time_step: float,
    steps: int,
    method: Alpha | None = None,
    sensors: Mapping[str, float] | None = None,
    coupling: str = "direct",
    footprint: float | None = None,
    solver: str = "auto",
    every: int = 1,
    iteration: Iteration | None = None,
    progress: Callable[[int], None] | None = None,
) -> Result:
    """Simulate a crossing.

    Parameters
    ----------
    crossing : Crossing
        Who crosses what, and how fast.
    time_step : float
        Δt [s].
    steps : int
        Number of time steps.
    method : Alpha, optional
        Parameters of the alpha method. By default α = 0, or α = -0.1 for wheels that have mass (or a
        dashpot that ends at a massless contact point).
    sensors : mapping of name to position, optional
        Positions [m] on the first running line whose vertical motion is kept.
    coupling : {"direct", "iterative", "refactored", "literal"}
        The direct method, its two rivals, or the direct method as N12 prints it (dense; for small models).
    footprint : float, optional
        Length [m] over which a wheel's contact is spread along the line. By default zero for massless
        wheels, and for wheels with mass 1.2 m or 3 % of the line, whichever is less.
    solver : str
        Kind of factorization: "auto", "banded", "superlu", "pardiso", "cholmod".
    every : int
        Keep every n-th step.
    iteration : Iteration, optional
        Tolerance, relaxation and limit of the iterative coupling.
    progress : callable, optional
        Called with the number of steps done, now and then.

    Returns
    -------
    Result

    Raises
    ------
    InputError
        If an input breaks a rule; nothing has been computed.
    AnalysisError
        If the run diverges; ``error.result`` holds what was computed until then.
    """
    settings = settings_for(
        crossing,
        time_step=time_step,
        steps=steps,
        method=method,
        footprint=footprint,
        coupling=coupling,
        solver=solver,
        every=every,
        sensors=sensors,
        iteration=iteration,
    )
    return run_plan(plan_for(crossing, settings), progress)


def run_plan(plan: Plan, progress: Callable[[int], None] | None = None) -> Result:
    """Compute a compiled crossing; see :func:`simulate`."""
    begun = time.perf_counter()
    start = start_of(plan)
    recorder = Recorder(plan, progress)
    try:
        structure, fleet = _MARCHES[plan.settings.coupling](plan, start, recorder)
    except AnalysisError as error:
        recorder.salvage()
        outcome = Outcome("failed", str(error))
        facts = {"wall_time": time.perf_counter() - begun}
        raise AnalysisError(str(error), recorder.result(outcome, facts)) from error
    facts = _facts(plan, structure, fleet) | {"wall_time": time.perf_counter() - begun}
    outcome = Outcome("completed", f"{plan.settings.steps} steps computed")
    return recorder.result(outcome, facts)


def _facts(plan: Plan, structure: StructureBody, fleet: FleetBody | None) -> dict[str, Any]:
    factor = structure.integrator.factor
    return {
        "structure_dofs": plan.structure.size,
        "vehicle_dofs": plan.fleet.matrices.size,
        "contacts": plan.rows.n_contact,
        "steps": plan.settings.steps,
        "time_step": plan.settings.time_step,
        "alpha": plan.settings.method.alpha,
        "beta": plan.settings.method.beta,
        "gamma": plan.settings.method.gamma,
        "footprint": plan.settings.footprint,
        "coupling": plan.settings.coupling,
        "solver": factor.name,
        "factor_bytes": int(factor.nbytes),
        "path_dofs": len(structure.path_dofs),
    }
