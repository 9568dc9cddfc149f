"""How a crossing is computed, and the defaults that follow from what the wheels are."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from axlespan.contact.laws import Law, Rigid, law_of
from axlespan.dynamics.alpha import Alpha
from axlespan.dynamics.reduction import ReducedBasis
from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.line_points import line_positions
from axlespan.interaction.outputs import envelope_names, field_steps, sensor_names
from axlespan.interaction.sensors import SensorPlace, split_places
from axlespan.model.materials import require_positive
from axlespan.running.path import PolynomialPath
from axlespan.running.structure import RAIL_LINE

#: N12's law of contact.
RIGID = Rigid()

#: Time [s] after which a vehicle with all wheels in the air is lost, when none is given.
LOST_AFTER = 0.5

#: How often a step that does not converge may be halved, when nothing else is said.
CUTS = 4
MOST_CUTS = 10

# More than any machine has cores.
_MOST_THREADS = 1024
#: Environment variable with the number of threads, where a run does not name it.
THREADS = "AXLESPAN_THREADS"

#: Ways of coupling vehicle and structure.
COUPLINGS = ("direct", "iterative", "refactored", "literal")

#: α for wheels with mass, or with a dashpot on a massless contact, when none is given.
DAMPED_ALPHA = -0.1

# Above this α there is too little numerical damping for wheels with mass.
_LITTLE_DAMPING = -0.03

# Largest spacing of sleepers that share an axle load [m].
_WIDEST_SLEEPERS = 3.0

#: Largest footprint [m] and its largest share of the running line, when none is given.
FOOTPRINT, FOOTPRINT_SHARE = 1.2, 0.02

#: Elements under a footprint where the line has kinks in slope between them, and its largest share of the line.
KINKED_ELEMENTS, MOST_OF_LINE = 3, 0.1
_SMOOTH = 4  # coefficients of a path that is smooth over its nodes: cubics of beams


@dataclass(frozen=True)
class Iteration:
    """Settings of the iterative coupling."""

    tolerance: float = 1e-10  # of the largest static contact force [-]
    relaxation: float = 1.0  # share of the new force taken at each iteration [-]
    limit: int = 200  # iterations in a step

    def __post_init__(self) -> None:
        if not 0.0 < self.tolerance < 1.0:
            raise InputError("must lie between 0 and 1", field="tolerance", value=self.tolerance)
        if not 0.0 < self.relaxation <= 1.0:
            raise InputError("must be above 0 and at most 1", field="relaxation", value=self.relaxation)
        if self.limit < 1:
            raise InputError("must be at least 1", field="max_iterations", value=self.limit)


@dataclass(frozen=True)
class Settings:
    """Everything about a run that is not the crossing itself."""

    time_step: float  # [s]
    steps: int
    method: Alpha
    footprint: float = 0.0  # [m]
    sleepers: float = 0.0  # spacing of three sleepers that share an axle load, 0 for none [m]
    coupling: str = "direct"
    solver: str = "auto"
    every: int = 1
    sensors: Mapping[str, float] = field(default_factory=dict)  # name -> position [m]
    sensor_lines: Mapping[str, str] = field(default_factory=dict)  # name -> line on which it stands
    reactions: bool = True  # whether support reactions are kept
    iteration: Iteration = field(default_factory=Iteration)
    fields: Sequence[int] = ()  # time indices of whole fields
    section_forces: tuple[str, ...] = ()  # sensors at which section forces of beams are kept
    stresses: tuple[str, ...] = ()  # sensors at which stresses of solids and shells are kept
    envelopes: tuple[str, ...] = ()  # quantities of which envelopes along the line are kept
    basis: str | ReducedBasis = "full"
    basis_modes: int = 0  # beside the Ritz vectors of a basis that is built here
    basis_tolerance: float | None = None  # of the estimated error of a basis that is built here [-]
    line_points: tuple[float, ...] = ()  # positions along the deck that are kept [m]
    energy_samples: int | None = None  # steps at which the energy is balanced; by size when left out
    notes: Sequence[str] = ()  # what was chosen by default, and warnings
    contact: Law = RIGID  # of wheels that have no law of their own
    cuts: int = CUTS  # how often a step of a nonlinear run that does not converge may be halved
    lost_after: float = LOST_AFTER  # time for which all wheels of a vehicle may be in the air [s]
    threads: int = 1

    def under_wheels(self, path: PolynomialPath) -> PolynomialPath:
        """A line as wheels touch it: shared among sleepers, under a footprint."""
        if self.sleepers > 0.0:
            path = path.shared(self.sleepers)
        return path.spread(self.footprint) if self.footprint > 0.0 else path


def settings_for(
    crossing: Crossing,
    *,
    time_step: float,
    steps: int,
    method: Alpha | None = None,
    footprint: float | None = None,
    sleepers: float | None = None,
    coupling: str = "direct",
    solver: str = "auto",
    every: int = 1,
    sensors: Mapping[str, SensorPlace] | None = None,
    reactions: bool = True,
    iteration: Iteration | None = None,
    fields: Sequence[float] | int | None = None,
    section_forces: Sequence[str] | None = None,
    stresses: Sequence[str] | None = None,
    envelopes: Sequence[str] | None = None,
    basis: str | ReducedBasis = "full",
    basis_modes: int = 0,
    basis_tolerance: float | None = None,
    line_points: int | Sequence[float] | None = None,
    contact: str | Law = RIGID,
    cuts: int = CUTS,
    lost_after: float = LOST_AFTER,
    threads: int | None = None,
) -> Settings:
    """Check the settings of a run and fill in what the user left to us.

    Raises
    ------
    InputError
        If a value is out of range.
    """
    _check_counts(time_step, steps, every)
    if coupling not in COUPLINGS:
        raise InputError(f"must be one of {', '.join(COUPLINGS)}", field="method", value=coupling)
    _check_basis(basis, basis_tolerance, coupling)
    notes: list[str] = []
    chosen = _method(crossing, method, notes)
    length = _footprint(crossing, footprint, notes)
    if sleepers is not None:
        notes.append(f"each wheel's force is shared by three sleepers {sleepers:g} m apart: 25, 50 and 25 %")
    places, lines = split_places(crossing.structure, sensors)
    if basis != "full" and (section_forces or set(envelopes or ()) & {"moment", "shear"}):
        notes.append(
            "warning: in a reduced basis section forces lack local bending, shear most; compare with basis: full"
        )
    return Settings(
        float(time_step),
        int(steps),
        chosen,
        length,
        _sleepers(crossing, sleepers),
        coupling,
        solver,
        int(every),
        places,
        lines,
        bool(reactions),
        iteration or Iteration(),
        field_steps(fields, float(time_step), int(steps)),
        sensor_names(section_forces, sensors or {}, "section_forces"),
        sensor_names(stresses, sensors or {}, "stresses"),
        envelope_names(envelopes),
        basis,
        int(basis_modes),
        basis_tolerance,
        line_points=line_positions(crossing.structure, line_points),
        notes=tuple(notes),
        contact=law_of(contact),
        cuts=_cuts(cuts),
        lost_after=require_positive(lost_after, "lost_after"),
        threads=_threads(threads),
    )


def _cuts(given: int) -> int:
    whole = isinstance(given, int | np.integer) and not isinstance(given, bool)
    if not whole or not 0 <= given <= MOST_CUTS:
        raise InputError(f"must be a whole number from 0 to {MOST_CUTS}", field="cuts", value=given)
    return int(given)


def _threads(given: int | None) -> int:
    """The number of threads that is given, else that of the environment, else one."""
    raw = os.environ.get(THREADS, "1") if given is None else given
    try:
        number = int(raw)
    except ValueError:
        number = 0
    if (
        isinstance(raw, bool)
        or not 1 <= number <= _MOST_THREADS
        or (isinstance(raw, float) and raw != number)
    ):
        field = THREADS if given is None else "threads"
        raise InputError(f"must be a whole number from 1 to {_MOST_THREADS}", field=field, value=raw)
    return number


def _check_basis(basis: str | ReducedBasis, tolerance: float | None, coupling: str) -> None:
    if isinstance(basis, str) and basis not in ("full", "reduced"):
        raise InputError("must be full, reduced, or a ReducedBasis", field="basis", value=basis)
    if basis != "full" and coupling != "direct":
        raise InputError(
            "goes with the direct method only", field="basis", value="reduced", fix="Use method: direct"
        )
    if tolerance is not None and not 0.0 < tolerance < 1.0:
        raise InputError("must lie between 0 and 1", field="basis_tolerance", value=tolerance)


def _check_counts(time_step: float, steps: int, every: int) -> None:
    if not np.isfinite(time_step) or time_step <= 0.0:
        raise InputError("must be positive", field="time_step", value=time_step, fix="Write for example 1 ms")
    if isinstance(steps, bool) or int(steps) != steps or steps < 1:
        raise InputError("must be a whole number of at least 1", field="steps", value=steps)
    if steps > 100_000_000:
        raise InputError("must be at most 100 000 000", field="steps", value=steps)
    if isinstance(every, bool) or int(every) != every or every < 1:
        raise InputError("must be a whole number of at least 1", field="every", value=every)


def _method(crossing: Crossing, method: Alpha | None, notes: list[str]) -> Alpha:
    vehicles = [item.vehicle for item in crossing.placements]
    massive = any(vehicle.has_massive_contacts for vehicle in vehicles)
    dashpot = any(vehicle.has_dashpot_contacts for vehicle in vehicles)
    why = "wheels have mass" if massive else "a dashpot ends at a massless contact point"
    if method is None:
        if not (massive or dashpot):
            return Alpha(0.0)
        notes.append(
            f"alpha = {DAMPED_ALPHA} by default, because {why}: numerical noise in the contact force is damped"
        )
        return Alpha(DAMPED_ALPHA)
    if method.alpha > _LITTLE_DAMPING and method._gamma < 0.5 - _LITTLE_DAMPING and (massive or dashpot):
        notes.append(
            f"warning: alpha = {method.alpha:g}, but {why}: the contact force may oscillate from step to step without "
            f"bound; leave alpha out, or use alpha: {DAMPED_ALPHA}"
        )
    return method


def _sleepers(crossing: Crossing, spacing: float | None) -> float:
    """Spacing of the sleepers that share an axle load."""
    if spacing is None:
        return 0.0
    if not 0.0 < spacing <= _WIDEST_SLEEPERS:
        raise InputError(
            f"must be positive and at most {_WIDEST_SLEEPERS:g} m",
            field="sleepers",
            value=spacing,
            fix="Use 0.6 m",
        )
    if RAIL_LINE in crossing.structure.lines:
        raise InputError(
            "must be left out: the structure has a track, whose rails spread the loads",
            field="sleepers",
            value=spacing,
        )
    return float(spacing)


def _kinked_elements(crossing: Crossing) -> float:
    """Usual length [m] of a line's elements where they meet with kinks in slope; zero on beams."""
    paths = [crossing.structure.line(name) for name in dict.fromkeys(crossing.contact_lines)]
    lengths = [
        float(np.median(np.diff(path.breaks))) for path in paths if path.coefficients.shape[2] < _SMOOTH
    ]
    return max(lengths, default=0.0)


def _footprint(crossing: Crossing, footprint: float | None, notes: list[str]) -> float:
    length = crossing.structure.length
    if footprint is not None:
        if not 0.0 <= footprint <= length:
            raise InputError(
                f"must be between 0 and the length of the line, {length:g} m",
                field="footprint",
                value=footprint,
            )
        return float(footprint)
    if not any(item.vehicle.has_massive_contacts for item in crossing.placements):
        return 0.0
    if RAIL_LINE in crossing.structure.lines:
        chosen = float(np.median(np.diff(crossing.structure.line(RAIL_LINE).breaks)))
        notes.append(
            f"footprint of {chosen:.3g} m by default, the length of the rail's elements: a wheel with mass does not "
            "feel where they meet"
        )
        return chosen
    chosen = min(FOOTPRINT, FOOTPRINT_SHARE * length)
    kinked = _kinked_elements(crossing)
    if kinked * KINKED_ELEMENTS > chosen:
        chosen = min(kinked * KINKED_ELEMENTS, MOST_OF_LINE * length)
        notes.append(
            f"footprint of {chosen:.3g} m by default, {KINKED_ELEMENTS} elements of solids or shells: a wheel with mass "
            "does not feel the kinks where they meet"
        )
        return chosen
    notes.append(
        f"footprint of {chosen:.3g} m by default, because wheels have mass: a kink in the line, as at the end of a bare span, "
        "does not act as a blow"
    )
    return chosen
