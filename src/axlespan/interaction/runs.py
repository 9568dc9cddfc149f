"""Compute compiled crossings, one or many side by side."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from itertools import zip_longest
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.dynamics.reduction import ReducedBasis
from axlespan.errors import AnalysisError, Outcome
from axlespan.interaction.bodies import PreparedStructure
from axlespan.interaction.convoy import Lane
from axlespan.interaction.drive import Couple, Leaper, drive
from axlespan.interaction.fused.march import FusedMarch
from axlespan.interaction.groundwork import Groundwork, basis_for, prepare_reduced
from axlespan.interaction.march import couple_directly
from axlespan.interaction.nonlinear.fused_march import NonlinearMarch
from axlespan.interaction.nonlinear.march import begin_nonlinear, watch, with_cutting
from axlespan.interaction.plan import Plan
from axlespan.interaction.records.recorder import Recorder
from axlespan.interaction.reduced.error import ReductionError, ringing_runs
from axlespan.interaction.result import Result
from axlespan.interaction.rivals.iterative import IterativeCoupling
from axlespan.interaction.rivals.literal import couple_literally
from axlespan.interaction.rivals.refactored import couple_by_refactoring
from axlespan.interaction.start import StartFactors, starts_of

FloatArray = npt.NDArray[np.float64]

# Blocks of Ritz vectors and cut-offs of the bases that are tried, from lean to rich.
_BASES = ((2, 1e-2), (2, 1e-3), (3, 1e-4), (4, 1e-5), (6, 1e-6))
# A richer basis is of no use when less than this share of the error comes from the basis.
_SHARE_OF_BASIS = 0.2


def _couple(coupling: str) -> tuple[Couple, bool]:
    """How to make a step, and whether it needs the contact systems."""
    if coupling == "direct":
        return couple_directly, True
    if coupling == "iterative":
        return IterativeCoupling(), False
    return {"refactored": couple_by_refactoring, "literal": couple_literally}[coupling], False


def run_plan(plan: Plan, progress: Callable[[int], None] | None = None) -> Result:
    """Compute a compiled crossing; see :func:`simulate`."""
    (result,) = run_plans([plan], progress)
    if result.outcome.code == "failed":
        raise AnalysisError(result.outcome.message, result)
    return result


def run_plans(
    plans: Sequence[Plan],
    progress: Callable[[int], None] | None = None,
    groundwork: Groundwork | None = None,
) -> list[Result]:
    """Compute compiled crossings of one structure side by side; failed ones are among the results.

    ``groundwork`` of an earlier call saves factoring the structure again; it must serve these plans.
    """
    settings = plans[0].settings
    if len(plans) > 1 and any(plan.is_nonlinear for plan in plans):
        return [result for plan in plans for result in run_plans([plan], progress, groundwork)]
    if (
        settings.basis_tolerance is not None
        and settings.basis != "full"
        and not isinstance(settings.basis, ReducedBasis)
    ):
        return _refined(plans, progress, settings.basis_tolerance)
    laid = groundwork if groundwork is not None and groundwork.serves(plans) else Groundwork.of(plans)
    facts = {"basis_time": laid.seconds} if settings.basis == "reduced" else None
    return _driven(plans, progress, laid.prepared, laid.basis, facts, laid.start)


def _refined(plans: Sequence[Plan], progress: Callable[[int], None] | None, tolerance: float) -> list[Result]:
    """Compute with richer and richer bases until the estimated error is within the tolerance."""
    results: list[Result] = []
    for blocks, cutoff in _BASES:
        begun = time.perf_counter()
        basis = basis_for(plans, blocks, cutoff)
        seconds = time.perf_counter() - begun
        results = _driven(plans, progress, prepare_reduced(plans, basis), basis, {"basis_time": seconds})
        worst = max(float(result.facts["reduction_error"]) for result in results)
        by_basis = max(float(result.facts["reduction_error_of_basis"]) for result in results)
        if worst <= tolerance or by_basis < _SHARE_OF_BASIS * worst:
            break
    return results


def _driven(
    plans: Sequence[Plan],
    progress: Callable[[int], None] | None,
    prepared: PreparedStructure,
    basis: ReducedBasis | None,
    facts: Mapping[str, Any] | None = None,
    factors: StartFactors | None = None,
) -> list[Result]:
    begun = time.perf_counter()
    errors = [] if basis is None else [ReductionError(plan, basis) for plan in plans]
    factors = factors or StartFactors(plans[0])
    nonlinear = (
        begin_nonlinear(plans[0], factors) if plans[0].is_nonlinear else None
    )  # a single crossing then
    starts = starts_of(plans, factors) if nonlinear is None else [nonlinear[0]]
    recorders: list[Recorder] = []
    for plan, error in zip_longest(plans, errors):
        recorders.append(
            Recorder(plan, progress, [error] if error else [], recorders[0] if recorders else None)
        )
    lanes = [
        Lane.at_start(plan, start, keeper)
        for plan, start, keeper in zip(plans, starts, recorders, strict=True)
    ]
    couple, systems = _couple(plans[0].settings.coupling)
    if nonlinear is not None:
        watch(nonlinear[1], recorders[0])
        couple = with_cutting(nonlinear[1], recorders[0])
    leaper: Leaper | None = FusedMarch.of if couple is couple_directly else None
    if nonlinear is not None:
        leaper = NonlinearMarch.led_by(nonlinear[1], couple)
    drive(lanes, prepared, couple, systems=systems, leaper=leaper)
    estimates: list[dict[str, Any]] = [{} for _ in lanes]
    if basis is not None:
        ringing = ringing_runs(plans, starts, basis, couple)
        estimates = [error.facts(samples) for error, samples in zip(errors, ringing, strict=True)]
    common = {**(facts or {}), "wall_time": time.perf_counter() - begun, "side_by_side": len(lanes)}
    return [
        _result(lane, prepared, common | estimate) for lane, estimate in zip(lanes, estimates, strict=True)
    ]


def _result(lane: Lane, prepared: PreparedStructure, facts: Mapping[str, Any]) -> Result:
    own = {**_facts(lane.plan, prepared), **facts}
    if lane.error is not None:
        return lane.recorder.result(Outcome("failed", str(lane.error)), own)
    return lane.recorder.result(Outcome("completed", f"{lane.plan.settings.steps} steps computed"), own)


def _facts(plan: Plan, prepared: PreparedStructure) -> dict[str, Any]:
    factor = prepared.integrator.factor
    return {
        "structure": plan.crossing.structure.name,
        "train": plan.crossing.train_names,
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
        "sleepers": plan.settings.sleepers,
        "coupling": plan.settings.coupling,
        "solver": factor.name,
        "factor_bytes": int(factor.nbytes),
        "path_dofs": len(prepared.columns.path_dofs),
        "threads": plan.settings.threads,
    }
