"""What a crossing becomes before it is computed: matrices of both bodies, contact rows, applied forces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from axlespan.contact.laws_of_wheels import WheelLaws
from axlespan.contact.rows import TrainRows, WheelPath, Wheels
from axlespan.dynamics.integrator import Matrices
from axlespan.elements.beam_sections import QUANTITIES
from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.defect_notes import defect_notes
from axlespan.interaction.forces import AppliedForces
from axlespan.interaction.nonlinear.laws import laws_of, require_direct
from axlespan.interaction.sensors import by_line, check_sensors, sensor_rows
from axlespan.interaction.settings import Settings
from axlespan.interaction.surface_notes import start_notes, surface_notes
from axlespan.interaction.traffic import require_clear_tracks
from axlespan.linalg.arrays import block_diagonal
from axlespan.model.motions import Constant
from axlespan.model.system import System
from axlespan.running.path import PolynomialPath
from axlespan.running.sections import BeamSections
from axlespan.running.stress_points import StressPoints
from axlespan.running.structure import Structure
from axlespan.vehicles.train import Train
from axlespan.vehicles.vehicle import Vehicle

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

# Fewest steps per shortest period of a vehicle, and per crossing of a wheel; below, results say nothing.
_STEPS_PER_PERIOD, _STEPS_PER_CROSSING = 4, 4


@dataclass(frozen=True, eq=False)
class Fleet:
    """The vehicles of a train as one block-diagonal system; moving forces have no d.o.f."""

    matrices: Matrices
    weight: FloatArray  # (n_contact,) static contact forces [N]
    coupled: IntArray  # (n_coupled,) contacts that have a d.o.f., among all contacts
    dofs: IntArray  # (n_coupled,) their d.o.f. in the fleet
    vehicle_of: IntArray  # (n_coupled,) vehicle of each coupled contact
    owner_of_dof: IntArray  # (n,) vehicle of each d.o.f.
    dof_names: tuple[str, ...]

    @property
    def forced(self) -> IntArray:
        """Contacts that are moving forces."""
        mask = np.ones(len(self.weight), dtype=bool)
        mask[self.coupled] = False
        return np.flatnonzero(mask)


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
        _check_damping(crossing.structure)
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
    _check_time_step(plan)
    _check_reach(plan)
    end = settings.time_step * settings.steps
    notes = [*require_clear_tracks(crossing, end), *surface_notes(crossing, end), *start_notes(crossing)]
    notes += defect_notes(crossing, settings.time_step, end)
    if notes:
        plan = replace(plan, settings=replace(settings, notes=(*settings.notes, *notes)))
    if like is None or _placed(settings) != _placed(like.settings):
        check_sensors(crossing.structure, settings.sensors, settings.sensor_lines)
        _check_sections(crossing.structure, settings)
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


def _check_damping(structure: Structure) -> None:
    """Modal damping acts on velocities relative to fixed supports."""
    system = structure.system
    if system.modal_damping is not None and not all(
        isinstance(motion, Constant) for motion in system.motions
    ):
        raise InputError(
            "acts on the motion relative to supports that stand still, but a support moves",
            field="damping",
            value="modal",
            fix="Use Rayleigh damping",
        )


def matrices_of(system: System) -> Matrices:
    """The free blocks of a system."""
    blocks = system.partition
    damping = blocks.C_FF if blocks.C_FF.nnz else None
    return Matrices(blocks.K_FF, blocks.M_FF, damping, system.modal_damping)


def fleet_of(train: Train, gravity: float, first: int = 0) -> Fleet:
    """All vehicles of a train as one system; ``first`` vehicles of other trains are counted before."""
    kinds: dict[int, Matrices] = {}
    blocks: list[Matrices] = []
    names: list[str] = []
    coupled: list[int] = []
    dofs: list[int] = []
    owner: list[int] = []
    dof_owner: list[int] = []
    begin, contact = 0, 0
    for i, item in enumerate(train.placements):
        vehicle = item.vehicle
        if vehicle.system is not None:
            _check_vehicle(vehicle)
            own = kinds.get(id(vehicle.system)) or matrices_of(vehicle.system)
            kinds[id(vehicle.system)] = own  # vehicles that differ in their wheels alone share one
            blocks.append(own)
            names += [f"{first + i + 1}.{vehicle.system.free_name(j)}" for j in range(own.size)]
            coupled += range(contact, contact + len(vehicle.contacts))
            dofs += (begin + vehicle.contact_dofs).tolist()
            owner += [i] * len(vehicle.contacts)
            dof_owner += [i] * own.size
            begin += own.size
        contact += len(vehicle.contacts)
    index = np.int64
    return Fleet(
        _block_diagonal(blocks),
        train.static_forces(gravity),
        np.array(coupled, dtype=index),
        np.array(dofs, dtype=index),
        np.array(owner, dtype=index),
        np.array(dof_owner, dtype=index),
        tuple(names),
    )


def joined(fleets: Sequence[Fleet]) -> Fleet:
    """Several trains as one fleet; contacts, d.o.f. and vehicles are numbered on."""
    if len(fleets) == 1:
        return fleets[0]
    contacts, dofs, vehicles = (
        np.concatenate([[0], np.cumsum(sizes)])[:-1]
        for sizes in (
            [len(fleet.weight) for fleet in fleets],
            [fleet.matrices.size for fleet in fleets],
            [int(fleet.owner_of_dof.max(initial=-1)) + 1 for fleet in fleets],
        )
    )
    return Fleet(
        _block_diagonal([fleet.matrices for fleet in fleets if fleet.matrices.size]),
        np.concatenate([fleet.weight for fleet in fleets]),
        np.concatenate([fleet.coupled + at for fleet, at in zip(fleets, contacts, strict=True)]),
        np.concatenate([fleet.dofs + at for fleet, at in zip(fleets, dofs, strict=True)]),
        np.concatenate([fleet.vehicle_of + at for fleet, at in zip(fleets, vehicles, strict=True)]),
        np.concatenate([fleet.owner_of_dof + at for fleet, at in zip(fleets, vehicles, strict=True)]),
        tuple(name for fleet in fleets for name in fleet.dof_names),
    )


def _check_vehicle(vehicle: Vehicle) -> None:
    """Loads of vehicles are constant, so that only static contact forces know them; their supports stand still."""
    assert vehicle.system is not None
    moves = any(not (isinstance(m, Constant) and m.amount == 0.0) for m in vehicle.system.motions)
    varies = any(load.history is not None for load in vehicle.system.loads)
    if varies or moves:
        what = "loads that change in time" if varies else "supports that move"
        raise InputError(
            f"has {what}, which are not supported in vehicles", field="vehicle", value=vehicle.name
        )


def _block_diagonal(blocks: Sequence[Matrices]) -> Matrices:
    if not blocks:
        empty = sp.csr_array((0, 0), dtype=float)
        return Matrices(empty, empty)
    if any(block.C_low_rank is not None for block in blocks):
        raise InputError(
            "is not available for vehicles", field="damping", value="modal", fix="Use Rayleigh damping"
        )
    stiffness = block_diagonal([block.K for block in blocks])
    mass = block_diagonal([block.M for block in blocks])
    if all(block.C is None for block in blocks):
        return Matrices(stiffness, mass)
    zero = [sp.csr_array(block.K.shape) if block.C is None else block.C for block in blocks]
    return Matrices(stiffness, mass, block_diagonal(zero))


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


def _check_time_step(plan: Plan) -> None:
    """The time step must resolve the vehicles, and no train may leap over the structure."""
    dt = plan.settings.time_step
    for vehicle in {id(item.vehicle): item.vehicle for item in plan.crossing.placements}.values():
        frequencies = vehicle.frequencies() if vehicle.is_multibody else np.empty(0)
        if len(frequencies) and dt * frequencies.max() > 1.0 / _STEPS_PER_PERIOD:
            period = 1.0 / frequencies.max()
            raise InputError(
                f"is too long: {period / dt:.3g} steps per shortest period of vehicle '{vehicle.name}' ({period:.4g} s); "
                f"at least {_STEPS_PER_PERIOD} are needed",
                field="time_step",
                value=f"{dt:g} s",
                fix=f"Use {period / 40.0:.1g} s or less",
            )
    end = dt * plan.settings.steps
    leap = dt * max(run.course.largest_speed(end) for run in plan.crossing.runs)
    length = plan.crossing.structure.length
    if leap > length / _STEPS_PER_CROSSING:
        raise InputError(
            f"is too long: a wheel advances {leap:.3g} m a step on a line of {length:g} m",
            field="time_step",
            value=f"{dt:g} s",
            fix=f"Use {dt * length / leap / 200.0:.1g} s or less",
        )


def _check_reach(plan: Plan) -> None:
    """A wheel of each train must be on the structure at some time, or the run says nothing about it."""
    ends = plan.times_of(np.array([0, plan.settings.steps]))
    begin = 0
    for number, run in enumerate(plan.crossing.runs):
        wheels = begin + np.arange(len(run.lines))
        begin += len(wheels)
        paths = [
            path.free
            for path in plan.rows.paths
            if np.any((path.wheels >= wheels[0]) & (path.wheels <= wheels[-1]))
        ]
        start, stop = min(path.start for path in paths), max(path.stop for path in paths)
        head = run.course.head(ends)
        way = np.concatenate([head, head - run.course.direction * run.train.wheelbase])
        if way.max() < start or way.min() > stop:
            raise InputError(
                f"never brings a wheel onto the structure, which lies between {start:g} and {stop:g} m",
                field=f"others.{number - 1}" if number else "crossing",
                value=f"the first wheel runs from {head[0]:g} to {head[1]:g} m",
                fix="Check start, speed, time_step and steps",
            )


def _check_sections(structure: Structure, settings: Settings) -> None:
    """Section forces are those of beams under the line, stresses those of solids and shells."""
    known = (settings.sensors, settings.sensor_lines)
    for name, (_, places) in by_line(structure, settings.section_forces, *known).items():
        segments, xi = structure.line(name).locate(places)
        BeamSections.at(structure, segments, xi, name, wanted="section_forces")
    for name, (numbers, places) in by_line(structure, settings.stresses, *known).items():
        StressPoints.at(structure, [settings.stresses[i] for i in numbers], places, name)
    if any(name in QUANTITIES for name in settings.envelopes):
        name = structure.sensor_line
        segments = np.arange(len(structure.line(name).breaks) - 1)
        BeamSections.at(structure, segments, np.zeros(len(segments)), name, wanted="envelopes")
