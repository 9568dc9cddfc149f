"""What a crossing becomes before it is computed: matrices of both bodies, contact rows, applied forces."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.contact.laws_of_wheels import WheelLaws
from axlespan.contact.rows import TrainRows, WheelPath, Wheels
from axlespan.dynamics.integrator import Matrices
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.defect_notes import defect_notes
from axlespan.interaction.fleet import Fleet, fleet_of, joined, matrices_of
from axlespan.interaction.forces import AppliedForces
from axlespan.interaction.nonlinear.laws import laws_of, require_direct
from axlespan.interaction.plan_checks import check_damping, check_reach, check_sections, check_time_step
from axlespan.interaction.sensors import check_sensors, sensor_rows
from axlespan.interaction.settings import Settings
from axlespan.interaction.surface_notes import start_notes, surface_notes
from axlespan.interaction.traffic import require_clear_tracks
from axlespan.model.motions import Constant
from axlespan.model.system import System
from axlespan.running.path import PolynomialPath

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Plan:
    """A crossing with its settings, compiled."""

    crossing: Crossing
    settings: Settings
    structure: Matrices
    forces: AppliedForces
    fleet: Fleet
    rows: TrainRows
    sensor_path: PolynomialPath  # of the line for sensors, free d.o.f.
    sensor_path_moving: PolynomialPath  # the same in the prescribed d.o.f. that move
    moving: IntArray  # (n_moving,) prescribed d.o.f. that move or are set down
    laws: WheelLaws  # of the coupled wheels

    @property
    def is_nonlinear(self) -> bool:
        """Whether contact may let go or give way, or the structure has nonlinear springs."""
        systems = [self.crossing.structure.system]
        systems += [
            item.vehicle.system for item in self.crossing.placements if item.vehicle.system is not None
        ]
        return not self.laws.all_rigid or any(system.nonlinear for system in systems)

    @property
    def times(self) -> FloatArray:
        """Times (steps + 1,) [s]."""
        return self.times_of(np.arange(self.settings.steps + 1))

    def times_of(self, steps: IntArray) -> FloatArray:
        """Times [s] of time indices."""
        return np.asarray(steps * self.settings.time_step, dtype=np.float64)

    def sensor_rows(self) -> sp.csr_array:
        """Rows (n_sensor, n) of the sensors over the independent d.o.f. of the structure."""
        return sensor_rows(self.crossing.structure, self.settings.sensors, self.settings.sensor_lines)


def plan_for(crossing: Crossing, settings: Settings, like: Plan | None = None) -> Plan:
    """Compile a crossing.

    Parameters
    ----------
    crossing : Crossing
    settings : Settings
    like : Plan, optional
        One that was compiled before: what is the same object in both crossings (structure, trains) is not compiled
        again, and the plans share it. Numbers are those without it.

    Raises
    ------
    InputError
        If a wheel's line is unknown, no wheel is ever on the structure, or a sensor is off it.
    """
    system = crossing.structure.system
    same = like if like is not None and _same_trains(like, crossing, settings) else None
    if like is not None and like.crossing.structure is not crossing.structure:
        like = None
    if like is None:
        crossing.structure.require_stable()
        check_damping(crossing.structure)
    moving = _moving(system) if like is None else like.moving
    line = crossing.structure.line(crossing.structure.sensor_line)
    plan = Plan(
        crossing=crossing,
        settings=settings,
        structure=matrices_of(system) if like is None else like.structure,
        forces=AppliedForces.of(system) if like is None else like.forces,
        fleet=_fleet(crossing) if same is None else same.fleet,
        rows=_train_rows(crossing, settings, moving, like),
        sensor_path=_split(line, system, system.free) if like is None else like.sensor_path,
        sensor_path_moving=(
            _split(line, system, system.prescribed[moving]) if like is None else like.sensor_path_moving
        ),
        moving=moving,
        laws=laws_of(crossing, settings) if same is None else same.laws,
    )
    if plan.is_nonlinear:
        require_direct(settings, plan.laws, system.nonlinear)
    check_time_step(crossing, settings)
    check_reach(crossing, settings, plan.rows)
    end = settings.time_step * settings.steps
    notes = [*require_clear_tracks(crossing, end), *surface_notes(crossing, end), *start_notes(crossing)]
    notes += defect_notes(crossing, settings.time_step, end)
    if notes:
        plan = replace(plan, settings=replace(settings, notes=(*settings.notes, *notes)))
    if like is None or _placed(settings) != _placed(like.settings):
        check_sensors(crossing.structure, settings.sensors, settings.sensor_lines)
        check_sections(crossing.structure, settings)
    return plan


def _moving(system: System) -> IntArray:
    """Prescribed d.o.f. that move or are set down."""
    still = [isinstance(motion, Constant) and motion.amount == 0.0 for motion in system.motions]
    return np.flatnonzero(~np.array(still, dtype=bool))


def _fleet(crossing: Crossing) -> Fleet:
    return joined([fleet_of(run.train, crossing.gravity, run.first) for run in crossing.runs])


def _same_trains(like: Plan, crossing: Crossing, settings: Settings) -> bool:
    """Whether fleet and laws of a plan are those of another crossing too."""
    before = [run.train for run in like.crossing.runs]
    now = [run.train for run in crossing.runs]
    return (
        len(before) == len(now)
        and all(one is other for one, other in zip(before, now, strict=True))
        and like.crossing.gravity == crossing.gravity
        and like.settings.contact == settings.contact
    )


def _placed(settings: Settings) -> tuple[object, ...]:
    """What is kept where along the lines."""
    kept = (settings.section_forces, settings.stresses, settings.envelopes)
    return (dict(settings.sensors), dict(settings.sensor_lines), *kept)


def _train_rows(crossing: Crossing, settings: Settings, moving: IntArray, like: Plan | None) -> TrainRows:
    system = crossing.structure.system
    known = _lines_under_wheels(like, settings) if like is not None else {}
    profiles = [profile for run in crossing.runs for profile in run.profiles]
    groups: dict[tuple[str, int], list[int]] = {}
    for i, (name, profile) in enumerate(zip(crossing.contact_lines, profiles, strict=True)):
        groups.setdefault((name, id(profile)), []).append(i)
    lines: dict[str, tuple[PolynomialPath, PolynomialPath | None]] = {}
    for name in dict.fromkeys(crossing.contact_lines):
        if name in known:
            lines[name] = known[name]
            continue
        path = crossing.structure.line(name)
        path = settings.under_wheels(path)
        prescribed = _split(path, system, system.prescribed[moving]) if len(moving) else None
        lines[name] = _split(path, system, system.free), prescribed
    paths = tuple(
        WheelPath(np.array(wheels, dtype=np.int64), *lines[name], profiles[wheels[0]])
        for (name, _), wheels in groups.items()
    )
    return TrainRows(tuple(Wheels(run.course, run.train.offsets) for run in crossing.runs), paths)


def _lines_under_wheels(
    plan: Plan, settings: Settings
) -> dict[str, tuple[PolynomialPath, PolynomialPath | None]]:
    """Lines of a plan by their names, if wheels touch them as these settings want it."""
    own = plan.settings
    if (own.footprint, own.sleepers) != (settings.footprint, settings.sleepers):
        return {}
    names = plan.crossing.contact_lines
    return {names[int(path.wheels[0])]: (path.free, path.prescribed) for path in plan.rows.paths}


def _split(path: PolynomialPath, system: System, keep: IntArray) -> PolynomialPath:
    number = np.full(system.size, -1, dtype=np.int64)
    number[keep] = np.arange(len(keep))
    return path.renumbered(number)
