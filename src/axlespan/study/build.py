"""From a validated case to the crossing that it describes, with errors that point into the file."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from axlespan.dynamics.alpha import Alpha
from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing, Irregularity, OtherTrain
from axlespan.interaction.plan import Plan, plan_for
from axlespan.interaction.settings import Iteration, settings_for
from axlespan.running.structure import MAIN_LINE, Structure
from axlespan.study import case_crossing
from axlespan.study.build_checks import other_spans, overlaps, require_modes, require_solver, require_stable
from axlespan.study.build_irregularity import irregularity_of
from axlespan.study.build_structures import structure_of
from axlespan.study.build_vehicles import train_of
from axlespan.study.built import BuiltStructure
from axlespan.study.case_analysis import EveryFew
from axlespan.study.loader import LoadedCase
from axlespan.study.pointing import pointing
from axlespan.study.stated import stated_otherwise
from axlespan.vehicles import Train

#: How notes begin that are warnings.
WARNING = "warning: "


@dataclass(frozen=True, eq=False)
class BuiltCase:
    """A case, built and checked, ready to run."""

    loaded: LoadedCase
    crossing: Crossing
    plan: Plan
    warnings: tuple[str, ...]
    facts: tuple[str, ...] = ()  # of an imported structure: what it was read as
    of_trains: tuple[str, ...] = ()  # those of the warnings that are about its trains

    @property
    def title(self) -> str:
        """The case's title, or the name of its file."""
        return self.loaded.case.title or self.loaded.source.file

    @property
    def cautions(self) -> tuple[str, ...]:
        """What looks wrong but may be right, one line each."""
        said = (note.removeprefix(WARNING) for note in self.plan.settings.notes if note.startswith(WARNING))
        return (*self.warnings, *said)


@dataclass(frozen=True, eq=False)
class Known:
    """Parts of a case that have been built before, as in a sweep."""

    made: BuiltStructure | None = None
    trains: Sequence[Train] | None = None  # the first one, and the others of the case
    of_trains: tuple[str, ...] = ()  # warnings about them
    surfaces: Sequence[Irregularity | None] | None = None  # of the crossing, and of the other trains
    like: Plan | None = None  # of another case: what holds here too is shared with it


def build(
    loaded: LoadedCase, known: Known | None = None, *, lasting: Callable[[Crossing], int] | None = None
) -> BuiltCase:
    """Build the structure, the train and the plan of a case.

    Parameters
    ----------
    loaded : LoadedCase
    known : Known, optional
        What has been built before.
    lasting : callable, optional
        Number of steps of a crossing, in place of the case's own.

    Raises
    ------
    InputError
        If something is wrong that only shows now; it points to the place in the file.
    """
    case, known = loaded.case, known or Known()
    made = known.made
    if made is None:
        with pointing(loaded, "structure"):
            made = structure_of(case.structure)
            require_stable(made.structure, case.structure)
    with pointing(loaded, "crossing"):
        _require_lines(case.crossing, made.structure)
    trains = known.trains or _trains(loaded, made.structure)
    with pointing(loaded, "crossing"):
        surfaces = known.surfaces or _surfaces(loaded, made.structure)
        crossing = _crossing(loaded, made.structure, trains, surfaces)
    with pointing(loaded, "analysis"):
        require_solver(case.analysis.solver)
        require_modes(made.structure, case.analysis.modes)
        method = _method(loaded)
        options = _options(case.analysis, case.output, made)
        if lasting is not None:
            options = {**options, "steps": lasting(crossing)}
        settings = settings_for(crossing, method=method, **options)
        plan = plan_for(crossing, settings, known.like)
    warnings = (*loaded.warnings, *(f"{loaded.source.file}: structure: {word}" for word in made.warnings))
    warnings = (*warnings, *other_spans(made.structure, case, loaded.source))
    of_trains = known.of_trains
    if known.trains is None:
        of_trains = (*overlaps(trains[0], loaded.source), *stated_otherwise(loaded))
    return BuiltCase(loaded, crossing, plan, (*warnings, *of_trains), made.facts, of_trains)


# --- crossing and analysis ---------------------------------------------------------------------------


def _trains(loaded: LoadedCase, structure: Structure) -> list[Train]:
    """All trains of a case, the first one first."""
    case = loaded.case
    with pointing(loaded, "train"):
        trains = [train_of(loaded, structure, lines=_lines(case.crossing))]
    for number, other in enumerate(case.other_trains):
        path = f"other_trains.{number}"
        with pointing(loaded, path):
            _require_lines(other, structure)
        before = sum(len(train.placements) for train in trains)
        trains.append(train_of(loaded, structure, f"{path}.train", other.train, _lines(other), before))
    return trains


def _surfaces(loaded: LoadedCase, structure: Structure) -> list[Irregularity | None]:
    """Irregularities of the crossing, and of the other trains that have their own."""
    with pointing(loaded, "crossing.irregularity"):
        surfaces: list[Irregularity | None] = [irregularity_of(loaded.case.crossing.irregularity, structure)]
    for number, other in enumerate(loaded.case.other_trains):
        with pointing(loaded, f"other_trains.{number}.irregularity"):
            own = other.irregularity
            surfaces.append(None if own is None else irregularity_of(own, structure))
    return surfaces


def _crossing(
    loaded: LoadedCase,
    structure: Structure,
    trains: Sequence[Train],
    surfaces: Sequence[Irregularity | None],
) -> Crossing:
    others: list[OtherTrain] = []
    for number, other in enumerate(loaded.case.other_trains):
        with pointing(loaded, f"other_trains.{number}"):
            _require_lines(other, structure)
            train, surface = trains[number + 1], surfaces[number + 1]
            others.append(OtherTrain(train=train, irregularity=surface, **_movement(other)))
    crossing = Crossing(
        structure,
        trains[0],
        irregularity=surfaces[0],
        gravity=loaded.case.analysis.gravity,
        others=tuple(others),
        **_movement(loaded.case.crossing),
    )
    _ = crossing.runs  # lines of irregularities are there
    return crossing


def _movement(case: case_crossing.Movement) -> dict[str, Any]:
    names = ("speed", "speed_history", "acceleration", "to_speed", "start", "direction", "delay")
    return {name: getattr(case, name) for name in names} | {"line": case.line or case.lines}


def _lines(case: case_crossing.Movement) -> Mapping[str, str]:
    """Lines of the structure by those that wheels name."""
    return case.lines or ({MAIN_LINE: case.line} if case.line is not None else {})


def _require_lines(case: case_crossing.Movement, structure: Structure) -> None:
    """The lines that a movement names are there."""
    for name, line in _lines(case).items():
        try:
            structure.line(line)
        except InputError as error:
            field = "line" if case.line is not None else f"lines.{name}"
            raise InputError(error.rule, field=field, value=line, fix=error.fix) from error


def _method(loaded: LoadedCase) -> Alpha | None:
    analysis = loaded.case.analysis
    if analysis.alpha is None and analysis.beta is None and analysis.gamma is None:
        return None
    return Alpha(analysis.alpha or 0.0, analysis.beta, analysis.gamma)


def _options(analysis: Any, output: Any, made: BuiltStructure) -> Mapping[str, Any]:
    iteration = {
        name: value
        for name, value in (
            ("tolerance", analysis.tolerance),
            ("relaxation", analysis.relaxation),
            ("limit", analysis.max_iterations),
        )
        if value is not None
    }
    return {
        "time_step": analysis.time_step,
        "steps": analysis.step_count,
        "footprint": None if analysis.footprint == "auto" else float(analysis.footprint),
        "sleepers": analysis.load_distribution.spacing if analysis.load_distribution else None,
        "coupling": analysis.method,
        "solver": analysis.solver,
        "threads": analysis.threads,
        "every": output.every,
        "reactions": output.reactions,
        "sensors": {
            name: made.sensor_place(at, f"output.sensors.{name}") for name, at in output.sensors.items()
        },
        "iteration": Iteration(**iteration),
        "basis": analysis.basis,
        "basis_modes": analysis.modes or 0,
        "basis_tolerance": analysis.basis_tolerance,
        "fields": output.fields.every if isinstance(output.fields, EveryFew) else output.fields,
        "section_forces": output.section_forces,
        "stresses": output.stresses,
        "envelopes": output.envelopes,
        "line_points": output.line,
        "contact": analysis.contact.law,
        "lost_after": analysis.lost_after,
        "cuts": analysis.cuts,
    }
