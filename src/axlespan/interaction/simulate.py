"""Simulate a crossing."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from axlespan.contact.laws import Law
from axlespan.dynamics.alpha import Alpha
from axlespan.dynamics.reduction import ReducedBasis, reduced_basis
from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.groundwork import translations
from axlespan.interaction.plan import plan_for
from axlespan.interaction.progress_bar import reporting
from axlespan.interaction.result import Result
from axlespan.interaction.runs import run_plan, run_plans
from axlespan.interaction.sensors import SensorPlace
from axlespan.interaction.settings import CUTS, LOST_AFTER, RIGID, Iteration, Settings, settings_for
from axlespan.running.structure import Structure

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


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
