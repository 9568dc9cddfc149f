"""Simulate a crossing."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from itertools import zip_longest
from typing import Any

import numpy as np
import numpy.typing as npt

from axlespan.contact.laws import Law
from axlespan.dynamics.alpha import Alpha
from axlespan.dynamics.reduction import ReducedBasis, reduced_basis
from axlespan.errors import AnalysisError, InputError, Outcome
from axlespan.interaction.bodies import PreparedStructure
from axlespan.interaction.convoy import Couple, Lane, drive
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.fused.march import FusedMarch
from axlespan.interaction.groundwork import Groundwork, basis_for, prepare_reduced, translations
from axlespan.interaction.march import couple_directly
from axlespan.interaction.nonlinear.fused_march import NonlinearMarch
from axlespan.interaction.nonlinear.march import begin_nonlinear, watch, with_cutting
from axlespan.interaction.plan import Plan, plan_for
from axlespan.interaction.progress_bar import reporting
from axlespan.interaction.records.recorder import Recorder
from axlespan.interaction.reduced.error import ReductionError, ringing_runs
from axlespan.interaction.result import Result
from axlespan.interaction.rivals.iterative import IterativeCoupling
from axlespan.interaction.rivals.literal import couple_literally
from axlespan.interaction.rivals.refactored import couple_by_refactoring
from axlespan.interaction.sensors import SensorPlace
from axlespan.interaction.settings import CUTS, LOST_AFTER, RIGID, Iteration, Settings, settings_for
from axlespan.interaction.start import StartFactors, starts_of
from axlespan.running.structure import Structure

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

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


def simulate(
    crossing: Crossing,
    *,
    time_step: float,
    steps: int,
    method: Alpha | None = None,
    sensors: Mapping[str, SensorPlace] | None = None,
    reactions: bool = True,
    coupling: str = "direct",
    footprint: float | None = None,
    sleepers: float | None = None,
    solver: str = "auto",
    every: int = 1,
    iteration: Iteration | None = None,
    fields: Sequence[float] | int | None = None,
    section_forces: Sequence[str] | None = None,
    stresses: Sequence[str] | None = None,
    envelopes: Sequence[str] | None = None,
    basis: str | ReducedBasis = "full",
    basis_tolerance: float | None = None,
    line_points: int | Sequence[float] | None = None,
    contact: str | Law = RIGID,
    lost_after: float = LOST_AFTER,
    cuts: int = CUTS,
    threads: int | None = None,
    progress: Callable[[int], None] | bool | None = None,
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
        Positions [m] whose vertical motion is kept: on the deck where there is a track, else on the first
        running line; ``("rail", 12.5)`` names another line.
    reactions : bool
        Whether support reactions are kept.
    coupling : {"direct", "iterative", "refactored", "literal"}
        The direct method, its two rivals, or the direct method as N12 prints it (dense; for small models).
    footprint : float, optional
        Length [m] over which a wheel's contact is spread along the line. By default zero for massless
        wheels, and for wheels with mass 1.2 m or 2 % of the line, whichever is less.
    sleepers : float, optional
        Spacing [m] of three sleepers that share each wheel's force, 25, 50 and 25 %, and move with it
        (EN 1991-2 6.3.6.1), for structures without track.
    solver : str
        Kind of factorization: "auto", "banded", "superlu", "pardiso", "cholmod".
    every : int
        Keep every n-th step.
    iteration : Iteration, optional
        Tolerance, relaxation and limit of the iterative coupling.
    fields : sequence of float, or int, optional
        Times [s] of whole displacement and velocity fields (the nearest steps are taken), or at every so
        many steps; see :class:`axlespan.interaction.records.fields.Fields`.
    section_forces : sequence of str, optional
        Names of sensors at which moment, shear, normal force and torsion of the beams are kept.
    stresses : sequence of str, optional
        Names of sensors at which stresses of the solids or resultants of the shells under the line are kept.
    envelopes : sequence of str, optional
        Quantities whose extremes along the line are kept: "moment", "shear", "normal", "torsion",
        "deflection", "acceleration".
    line_points : int or sequence of float, optional
        So many positions along the deck (the line called "deck", else the first one), or the positions [m],
        at which displacement and acceleration are kept, with the slope of the line's two ends.
    contact : {"rigid", "unilateral", "hertz", "linear-spring"} or Law
        Law of the wheels that have none of their own, see :mod:`axlespan.contact.laws`.
    lost_after : float
        Time [s] for which all wheels of a vehicle may be in the air before the run stops.
    cuts : int
        How often a step of a run with nonlinear springs or contact may be halved where it does not converge: 4 means
        16 parts. 0 stops the run at once.
    basis : {"full", "reduced"} or ReducedBasis
        All d.o.f. of the structure, or a reduced basis, which is built here or given (see
        :func:`reduce_structure`). The result's facts hold its size and an estimate of its error.
    basis_tolerance : float, optional
        Estimated error [-] that a basis built here must reach; it grows until it does, or until a richer one would not help.
    threads : int, optional
        Threads of solves by PARDISO; when left out, those of the environment's AXLESPAN_THREADS, else one.
    progress : callable or bool, optional
        True shows a bar, in a terminal or a notebook; a callable is called with the number of steps done,
        now and then.

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
        sleepers=sleepers,
        coupling=coupling,
        solver=solver,
        every=every,
        sensors=sensors,
        reactions=reactions,
        iteration=iteration,
        fields=fields,
        section_forces=section_forces,
        stresses=stresses,
        envelopes=envelopes,
        basis=basis,
        basis_tolerance=basis_tolerance,
        line_points=line_points,
        contact=contact,
        lost_after=lost_after,
        cuts=cuts,
        threads=threads,
    )
    with reporting(progress, steps) as report:
        return run_plan(plan_for(crossing, settings), report)


def simulate_many(
    crossings: Sequence[Crossing],
    *,
    time_step: float,
    steps: int | Sequence[int],
    method: Alpha | None = None,
    sensors: Mapping[str, SensorPlace] | None = None,
    footprint: float | None = None,
    sleepers: float | None = None,
    solver: str = "auto",
    every: int = 1,
    fields: Sequence[float] | int | None = None,
    section_forces: Sequence[str] | None = None,
    stresses: Sequence[str] | None = None,
    envelopes: Sequence[str] | None = None,
    basis: str | ReducedBasis = "full",
    basis_tolerance: float | None = None,
    line_points: int | Sequence[float] | None = None,
    contact: str | Law = RIGID,
    lost_after: float = LOST_AFTER,
    cuts: int = CUTS,
    threads: int | None = None,
) -> list[Result]:
    """Simulate several crossings of one structure side by side, from one factorization.

    Parameters
    ----------
    crossings : sequence of Crossing
        All with the same ``structure``; trains, speeds, starts and irregularities may differ.
    steps : int or sequence of int
        Number of time steps, one for all or one each.
    time_step : float
        [s]; this and all that is not named here as for :func:`simulate`. The defaults of method and footprint
        follow from all trains together.
    threads : int, optional
        As for :func:`simulate`; with other solvers than PARDISO the crossings are shared among so many threads.
    method, sensors, footprint, sleepers, solver, every, fields, section_forces, stresses, envelopes : optional
        As for :func:`simulate`.
    basis, basis_tolerance, line_points, contact, lost_after, cuts : optional
        As for :func:`simulate`.

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
            sleepers=sleepers,
            solver=solver,
            every=every,
            fields=fields,
            section_forces=section_forces,
            stresses=stresses,
            envelopes=envelopes,
            basis=basis,
            basis_tolerance=basis_tolerance,
            line_points=line_points,
            contact=contact,
            lost_after=lost_after,
            cuts=cuts,
            threads=threads,
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
    leaper = FusedMarch.of if couple is couple_directly else None
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


def reduce_structure(
    structure: Structure, *, blocks: int = 3, cutoff: float = 1e-4, modes: int = 0, solver: str = "auto"
) -> ReducedBasis:
    """A reduced basis of a structure, for loads on its running lines; see :func:`reduced_basis`.

    The basis serves every train, speed, irregularity and time step.
    """
    system = structure.system
    number = np.full(system.size, -1, dtype=np.int64)
    number[system.free] = np.arange(len(system.free))
    used = [path.renumbered(number).path_dofs for path in structure.lines.values()]
    blocks_of = system.partition
    return reduced_basis(
        blocks_of.K_FF,
        blocks_of.M_FF,
        np.unique(np.concatenate(used)),
        blocks=blocks,
        cutoff=cutoff,
        modes=modes,
        extra=translations(structure),
        solver=solver,
    )


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
