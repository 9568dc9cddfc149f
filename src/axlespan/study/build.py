"""From a validated case to the crossing that it describes, with errors that point into the file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from axlespan import irregularity as profiles
from axlespan.dynamics.alpha import Alpha
from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.plan import Plan, plan_for
from axlespan.interaction.settings import Iteration, settings_for
from axlespan.irregularity import Profile
from axlespan.running.structure import Structure
from axlespan.study import case_crossing, case_train
from axlespan.study.build_checks import overlaps, require_solver, require_stable
from axlespan.study.build_structures import structure_of
from axlespan.study.build_vehicles import vehicle_of
from axlespan.study.built import BuiltStructure
from axlespan.study.case_analysis import EveryFew
from axlespan.study.loader import LoadedCase
from axlespan.study.pointing import pointing
from axlespan.vehicles import Placement, Train

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

    @property
    def title(self) -> str:
        """The case's title, or the name of its file."""
        return self.loaded.case.title or self.loaded.source.file

    @property
    def cautions(self) -> tuple[str, ...]:
        """What looks wrong but may be right, one line each."""
        said = (note.removeprefix(WARNING) for note in self.plan.settings.notes if note.startswith(WARNING))
        return (*self.warnings, *said)


def build(loaded: LoadedCase) -> BuiltCase:
    """Build the structure, the train and the plan of a case.

    Raises
    ------
    InputError
        If something is wrong that only shows now; it points to the place in the file.
    """
    case = loaded.case
    with pointing(loaded, "structure"):
        made = structure_of(case.structure)
        require_stable(made.structure, case.structure)
    with pointing(loaded, "train"):
        train = _train(loaded, made.structure)
    with pointing(loaded, "crossing"):
        crossing = _crossing(loaded, made.structure, train)
    with pointing(loaded, "analysis"):
        require_solver(case.analysis.solver)
        method = _method(loaded)
        settings = settings_for(crossing, method=method, **_options(case.analysis, case.output, made))
        plan = plan_for(crossing, settings)
    warnings = (*loaded.warnings, *(f"{loaded.source.file}: structure: {word}" for word in made.warnings))
    warnings = (*warnings, *overlaps(train, loaded.source))
    return BuiltCase(loaded, crossing, plan, warnings, made.facts)


# --- train -----------------------------------------------------------------------------------------


def _train(loaded: LoadedCase, structure: Structure) -> Train:
    entries = loaded.case.train
    built = []
    for number, entry in enumerate(entries):
        with pointing(loaded, f"train.{number}"):
            built.append(vehicle_of(entry, loaded.case.analysis.gravity))
            built[-1].static_forces(loaded.case.analysis.gravity)  # it stands, and no wheel pulls
            for name in {point.line for point in built[-1].contacts}:
                structure.line(name)  # it is there
    wheelbases = [max(point.behind for point in vehicle.contacts) for vehicle in built]
    heads = case_train.first_wheels(entries, wheelbases, [None] * len(built))
    placed = [
        Placement(vehicle, behind) for vehicle, places in zip(built, heads, strict=True) for behind in places
    ]
    placed.sort(key=lambda item: item.behind)
    names = dict.fromkeys(vehicle.name for vehicle in built)
    return Train(tuple(placed), f"{len(placed)} × {', '.join(names)}" if len(placed) > 1 else built[0].name)


# --- crossing and analysis ---------------------------------------------------------------------------


def _crossing(loaded: LoadedCase, structure: Structure, train: Train) -> Crossing:
    case = loaded.case.crossing
    with pointing(loaded, "crossing.irregularity"):
        profile = _profile(case.irregularity)
    return Crossing(
        structure,
        train,
        speed=case.speed,
        speed_history=case.speed_history,
        start=case.start,
        irregularity=profile,
        gravity=loaded.case.analysis.gravity,
    )


def _profile(case: Any) -> Profile:
    if case is None or isinstance(case, case_crossing.NoIrregularity):
        return profiles.Smooth()
    if isinstance(case, case_crossing.HarmonicIrregularity):
        return profiles.Harmonic(case.amplitude, case.wavelength, case.phase, case.from_, case.to)
    if isinstance(case, case_crossing.TableIrregularity):
        table: Profile
        if case.points is not None:
            points = np.array(case.points)
            table = profiles.Table(points[:, 0], points[:, 1])
        else:
            assert case.file is not None  # the schema asks for one of the two
            table = profiles.Table.from_csv(case.file)
        return _bounded(table, case)
    shape = profiles.spectrum(case.name)
    low, high = case.wavelengths or shape.wavelengths
    length = 20.0 * high if case.components is None else case.components / (1.0 / low - 1.0 / high)
    try:
        realized = profiles.realize(shape, length, seed=case.seed, wavelengths=(low, high))
    except InputError as error:
        if error.field != "length":
            raise
        field = "wavelengths" if case.components is None else "components"
        raise InputError(
            error.rule, field=field, fix="Use a narrower band of wavelengths, or fewer components"
        ) from error
    scaled = realized if case.scale == 1.0 else profiles.Scaled(realized, case.scale)
    return _bounded(scaled, case)


def _bounded(profile: Profile, case: case_crossing.Bounded) -> Profile:
    if case.from_ is None and case.to is None:
        return profile
    return profiles.Bounded(profile, case.from_, case.to)


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
        "coupling": analysis.method,
        "solver": analysis.solver,
        "every": output.every,
        "reactions": output.reactions,
        "sensors": {
            name: made.sensor_position(at, f"output.sensors.{name}") for name, at in output.sensors.items()
        },
        "iteration": Iteration(**iteration),
        "basis": analysis.basis,
        "basis_modes": analysis.modes or 0,
        "basis_tolerance": analysis.basis_tolerance,
        "fields": output.fields.every if isinstance(output.fields, EveryFew) else output.fields,
        "section_forces": output.section_forces,
        "stresses": output.stresses,
        "envelopes": output.envelopes,
    }
