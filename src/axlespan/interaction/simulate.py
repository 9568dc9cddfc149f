"""Simulate a crossing."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from axlespan.dynamics.alpha import Alpha
from axlespan.errors import AnalysisError, InputError, Outcome
from axlespan.interaction.bodies import PreparedStructure
from axlespan.interaction.convoy import Couple, Lane, drive
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.iterative import IterativeCoupling
from axlespan.interaction.literal import couple_literally
from axlespan.interaction.march import couple_directly
from axlespan.interaction.plan import Plan, plan_for
from axlespan.interaction.recorder import Recorder
from axlespan.interaction.refactored import couple_by_refactoring
from axlespan.interaction.result import Result
from axlespan.interaction.settings import Iteration, Settings, settings_for
from axlespan.interaction.start import start_of


def _couple(coupling: str) -> tuple[Couple, bool]:
    """How to make a step, and whether it needs the contact systems."""
    if coupling == "direct":
        return couple_directly, True
    if coupling == "iterative":
        return IterativeCoupling(), False
    return {"refactored": couple_by_refactoring, "literal": couple_literally}[coupling], False


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
    fields: Sequence[float] | int | None = None,
    section_forces: Sequence[str] | None = None,
    envelopes: Sequence[str] | None = None,
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
        wheels, and for wheels with mass 1.2 m or 2 % of the line, whichever is less.
    solver : str
        Kind of factorization: "auto", "banded", "superlu", "pardiso", "cholmod".
    every : int
        Keep every n-th step.
    iteration : Iteration, optional
        Tolerance, relaxation and limit of the iterative coupling.
    fields : sequence of float, or int, optional
        Times [s] of whole displacement and velocity fields (the nearest steps are taken), or at every so
        many steps; see :class:`axlespan.interaction.fields.Fields`.
    section_forces : sequence of str, optional
        Names of sensors at which moment, shear, normal force and torsion of the beams are kept.
    envelopes : sequence of str, optional
        Quantities whose extremes along the line are kept: "moment", "shear", "normal", "torsion",
        "deflection", "acceleration".
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
        fields=fields,
        section_forces=section_forces,
        envelopes=envelopes,
    )
    return run_plan(plan_for(crossing, settings), progress)


def simulate_many(
    crossings: Sequence[Crossing],
    *,
    time_step: float,
    steps: int | Sequence[int],
    method: Alpha | None = None,
    sensors: Mapping[str, float] | None = None,
    footprint: float | None = None,
    solver: str = "auto",
    every: int = 1,
    fields: Sequence[float] | int | None = None,
    section_forces: Sequence[str] | None = None,
    envelopes: Sequence[str] | None = None,
) -> list[Result]:
    """Simulate several crossings of one structure side by side, from one factorization.

    Parameters
    ----------
    crossings : sequence of Crossing
        All with the same ``structure``; trains, speeds, starts and irregularities may differ.
    steps : int or sequence of int
        Number of time steps, one for all or one each.
    time_step, method, sensors, footprint, solver, every, fields, section_forces, envelopes
        As for :func:`simulate`. The defaults of method and footprint follow from all trains together.

    Returns
    -------
    list of Result
        In the order of the crossings. A crossing that fails has ``outcome.code == "failed"`` and what was
        computed; the others go on.

    Raises
    ------
    InputError
        If the crossings don't share a structure, or an input breaks a rule.
    """
    if not crossings:
        return []
    if any(crossing.structure is not crossings[0].structure for crossing in crossings):
        raise InputError(
            "must all be of one structure object",
            field="crossings",
            fix="Build the structure once, and share it",
        )
    counts = list(steps) if isinstance(steps, Sequence | np.ndarray) else [steps] * len(crossings)
    if len(counts) != len(crossings):
        raise InputError("must be one number, or one for each crossing", field="steps", value=len(counts))

    def settings(crossing: Crossing, n: int, chosen: Alpha | None) -> Settings:
        return settings_for(
            crossing,
            time_step=time_step,
            steps=n,
            method=chosen,
            sensors=sensors,
            footprint=footprint,
            solver=solver,
            every=every,
            fields=fields,
            section_forces=section_forces,
            envelopes=envelopes,
        )

    pairs = list(zip(crossings, counts, strict=True))
    shared = method or _shared_method([settings(crossing, n, None) for crossing, n in pairs])
    plans = [plan_for(crossing, settings(crossing, n, shared)) for crossing, n in pairs]
    return run_plans(plans)


def _shared_method(settings: Sequence[Settings]) -> Alpha:
    """The method with the most numerical damping that any of the trains asks for."""
    return min((one.method for one in settings), key=lambda chosen: chosen.alpha)


def run_plan(plan: Plan, progress: Callable[[int], None] | None = None) -> Result:
    """Compute a compiled crossing; see :func:`simulate`."""
    (result,) = run_plans([plan], progress)
    if result.outcome.code == "failed":
        raise AnalysisError(result.outcome.message, result)
    return result


def run_plans(plans: Sequence[Plan], progress: Callable[[int], None] | None = None) -> list[Result]:
    """Compute compiled crossings of one structure side by side; failed ones are among the results."""
    begun = time.perf_counter()
    settings = plans[0].settings
    prepared = prepare(plans)
    lanes = [Lane.at_start(plan, start_of(plan), Recorder(plan, progress)) for plan in plans]
    couple, systems = _couple(settings.coupling)
    drive(lanes, prepared, couple, systems=systems)
    seconds = time.perf_counter() - begun
    return [_result(lane, prepared, seconds, len(lanes)) for lane in lanes]


def prepare(plans: Sequence[Plan]) -> PreparedStructure:
    """Factor the structure that the plans share."""
    settings = plans[0].settings
    used = [path.free.path_dofs for plan in plans for path in plan.rows.paths]
    path_dofs = np.unique(np.concatenate(used))
    return PreparedStructure(
        plans[0].structure, settings.method, settings.time_step, path_dofs, solver=settings.solver
    )


def _result(lane: Lane, prepared: PreparedStructure, seconds: float, lanes: int) -> Result:
    facts = _facts(lane.plan, prepared) | {"wall_time": seconds, "side_by_side": lanes}
    if lane.error is not None:
        return lane.recorder.result(Outcome("failed", str(lane.error)), facts)
    return lane.recorder.result(Outcome("completed", f"{lane.plan.settings.steps} steps computed"), facts)


def _facts(plan: Plan, prepared: PreparedStructure) -> dict[str, Any]:
    factor = prepared.integrator.factor
    return {
        "structure": plan.crossing.structure.name,
        "train": plan.crossing.train.name,
        "line_start": plan.crossing.structure.line().start,
        "line_stop": plan.crossing.structure.line().stop,
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
        "path_dofs": len(prepared.columns.path_dofs),
    }
