"""From a validated case to the crossing that it describes, with errors that point into the file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from axlespan import irregularity as profiles
from axlespan import vehicles
from axlespan.bridges import SupportAt, continuous_beam, simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.plan import Plan, plan_for
from axlespan.interaction.settings import Iteration, settings_for
from axlespan.irregularity import Profile
from axlespan.model import motions
from axlespan.model.damping import Damping, Modal, Rayleigh
from axlespan.running.structure import Structure
from axlespan.study import case_crossing, case_damping, case_structure, case_support, case_train
from axlespan.study.case_analysis import EveryFew
from axlespan.study.case_multibody import Multibody
from axlespan.study.faults import InputErrors
from axlespan.study.loader import LoadedCase
from axlespan.vehicles import Placement, Train, Vehicle


@dataclass(frozen=True, eq=False)
class BuiltCase:
    """A case, built and checked, ready to run."""

    loaded: LoadedCase
    crossing: Crossing
    plan: Plan
    warnings: tuple[str, ...]

    @property
    def title(self) -> str:
        """The case's title, or the name of its file."""
        return self.loaded.case.title or self.loaded.source.file


def build(loaded: LoadedCase) -> BuiltCase:
    """Build the structure, the train and the plan of a case.

    Raises
    ------
    InputError
        If something is wrong that only shows now; it points to the place in the file.
    """
    case = loaded.case
    with _pointing(loaded, "structure"):
        structure = _structure(case.structure)
    with _pointing(loaded, "train"):
        train = _train(loaded)
    with _pointing(loaded, "crossing"):
        crossing = _crossing(loaded, structure, train)
    with _pointing(loaded, "analysis"):
        method = _method(loaded)
        settings = settings_for(crossing, method=method, **_options(case.analysis, case.output))
        plan = plan_for(crossing, settings)
    return BuiltCase(loaded, crossing, plan, loaded.warnings)


@contextmanager
def _pointing(loaded: LoadedCase, section: str) -> Iterator[None]:
    """Turn errors of the layers below into errors at the place of the value, as far as it can be told."""
    try:
        yield
    except InputErrors:
        raise
    except InputError as error:
        if error.place is not None:
            raise
        source = loaded.source
        for path in _candidates(section, error.field):
            if source.knows(path):
                raise source.blame(path, error.rule, error.fix) from error
        words = InputError(
            error.rule, field=error.field, **({"value": error.value} if error.has_value else {})
        )
        raise source.blame(section, str(words), error.fix) from error


def _candidates(section: str, field: str | None) -> list[str]:
    if not field:
        return [section]
    places = [f"{section}.{field}", field]
    if section == "analysis":
        places += [f"output.{field}", f"crossing.{field}"]
    return places


# --- structure -------------------------------------------------------------------------------------


def _structure(case: case_structure.Structure) -> Structure:
    if isinstance(case, case_structure.SimpleSpan):
        return simple_span(
            length=case.length,
            youngs_modulus=case.youngs_modulus,
            second_moment=case.second_moment,
            mass_per_length=case.mass_per_length,
            elements=case.elements,
            area=case.area,
            shear_area=case.shear_area,
            poisson_ratio=0.2 if case.poisson_ratio is None else case.poisson_ratio,
            damping=_damping(case.damping),
            supports=_supports(case.supports),
        )
    if isinstance(case, case_structure.ContinuousBeam):
        spans = case.spans
        return continuous_beam(
            spans=[span.length for span in spans],
            youngs_modulus=[_given(span.youngs_modulus) for span in spans],
            second_moment=[_given(span.second_moment) for span in spans],
            mass_per_length=[_given(span.mass_per_length) for span in spans],
            elements=[int(_given(span.elements)) for span in spans],
            area=[span.area for span in spans],
            shear_area=[span.shear_area for span in spans],
            poisson_ratio=[0.2 if span.poisson_ratio is None else span.poisson_ratio for span in spans],
            damping=_damping(case.damping),
            supports=_supports(case.supports),
        )
    raise InputError("is not available in this version", field="kind", value=case.kind)


def _given(value: float | None) -> float:
    assert value is not None  # the schema completes the spans
    return value


def _damping(case: case_damping.StructuralDamping | None) -> Damping | None:
    if case is None:
        return None
    if isinstance(case, case_damping.ModalDamping):
        return Modal(case.ratio)
    alpha, beta = case.coefficients()
    return Rayleigh(alpha, beta)


def _supports(cases: tuple[case_support.Support, ...] | None) -> list[SupportAt] | None:
    if cases is None:
        return None
    result = []
    for number, case in enumerate(cases):
        assert not isinstance(case.at, str)  # the schema asks for positions on beams
        result.append(
            SupportAt(
                position=case.at,
                fixed=case.fixed,
                stiffness=case.stiffness.given() if case.stiffness else None,
                damping=case.damping.given() if case.damping else None,
                motion={key: _motion(value) for key, value in case.motion.given().items()}
                if case.motion
                else None,
                name=f"support{number + 1}",
            )
        )
    if len(result) == 2:
        return [_renamed(result[0], "left"), _renamed(result[1], "right")]
    return result


def _renamed(support: SupportAt, name: str) -> SupportAt:
    return SupportAt(
        support.position, support.fixed, support.stiffness, support.damping, support.motion, name
    )


def _motion(case: Any) -> motions.Motion:
    if case.kind == "constant":
        return motions.Constant(case.value)
    if case.kind == "harmonic":
        return motions.HarmonicMotion(case.amplitude, case.frequency, case.phase)
    return motions.TableMotion([t for t, _ in case.points], [u for _, u in case.points], smooth=case.smooth)


# --- train -----------------------------------------------------------------------------------------


def _train(loaded: LoadedCase) -> Train:
    entries = loaded.case.train
    built = []
    for number, entry in enumerate(entries):
        with _pointing(loaded, f"train.{number}"):
            built.append(_vehicle(entry))
    wheelbases = [max(point.behind for point in vehicle.contacts) for vehicle in built]
    heads = case_train.first_wheels(entries, wheelbases, [None] * len(built))
    placed = [
        Placement(vehicle, behind) for vehicle, places in zip(built, heads, strict=True) for behind in places
    ]
    placed.sort(key=lambda item: item.behind)
    names = dict.fromkeys(vehicle.name for vehicle in built)
    return Train(tuple(placed), f"{len(placed)} × {', '.join(names)}" if len(placed) > 1 else built[0].name)


def _vehicle(case: case_train.Entry) -> Vehicle:
    if isinstance(case, case_train.SprungMass):
        return vehicles.sprung_mass(
            mass=case.mass, stiffness=case.stiffness, damping=case.damping, unsprung_mass=case.unsprung_mass
        )
    if isinstance(case, case_train.RigidMass):
        return vehicles.rigid_mass(mass=case.mass)
    if isinstance(case, case_train.AxleLoads):
        return vehicles.axle_loads(loads=list(case.axle_loads), positions=list(case.wheel_positions))
    if isinstance(case, Multibody):
        return vehicles.multibody(
            bodies=[vehicles.Body(b.name, b.mass, b.position, b.inertia) for b in case.bodies],
            wheels=[vehicles.Wheel(w.position, w.mass, w.name) for w in case.wheels],
            suspensions=[
                vehicles.Suspension((s.between[0], s.between[1]), s.stiffness, s.damping, s.at)
                for s in case.suspensions
            ],
        )
    raise InputError("is not available in this version", field="vehicle", value=case.vehicle)


# --- crossing and analysis ---------------------------------------------------------------------------


def _crossing(loaded: LoadedCase, structure: Structure, train: Train) -> Crossing:
    case = loaded.case.crossing
    with _pointing(loaded, "crossing.irregularity"):
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
    name = case.name
    shape = profiles.spectrum(name)
    low, high = case.wavelengths or shape.wavelengths
    length = 20.0 * high if case.components is None else case.components * high
    realized = profiles.realize(shape, length, seed=case.seed, wavelengths=(low, high))
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


def _options(analysis: Any, output: Any) -> Mapping[str, Any]:
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
        "sensors": output.sensors,
        "iteration": Iteration(**iteration),
        "fields": output.fields.every if isinstance(output.fields, EveryFew) else output.fields,
        "section_forces": output.section_forces,
        "envelopes": output.envelopes,
    }
