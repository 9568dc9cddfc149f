"""What is refused before a crossing is computed: time steps, ways and places that say nothing."""

from __future__ import annotations

import numpy as np

from axlespan.contact.rows import TrainRows
from axlespan.elements.beam_sections import QUANTITIES
from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.sensors import by_line
from axlespan.interaction.settings import Settings
from axlespan.model.motions import Constant
from axlespan.running.sections import BeamSections
from axlespan.running.stress_points import StressPoints
from axlespan.running.structure import Structure

# Fewest steps per shortest period of a vehicle, and per crossing of a wheel; below, results say nothing.
_STEPS_PER_PERIOD, _STEPS_PER_CROSSING = 4, 4


def check_damping(structure: Structure) -> None:
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


def check_time_step(crossing: Crossing, settings: Settings) -> None:
    """The time step must resolve the vehicles, and no train may leap over the structure."""
    dt = settings.time_step
    for vehicle in {id(item.vehicle): item.vehicle for item in crossing.placements}.values():
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
    end = dt * settings.steps
    leap = dt * max(run.course.largest_speed(end) for run in crossing.runs)
    length = crossing.structure.length
    if leap > length / _STEPS_PER_CROSSING:
        raise InputError(
            f"is too long: a wheel advances {leap:.3g} m a step on a line of {length:g} m",
            field="time_step",
            value=f"{dt:g} s",
            fix=f"Use {dt * length / leap / 200.0:.1g} s or less",
        )


def check_reach(crossing: Crossing, settings: Settings, rows: TrainRows) -> None:
    """A wheel of each train must be on the structure at some time, or the run says nothing about it."""
    ends = np.array([0.0, settings.steps * settings.time_step])
    begin = 0
    for number, run in enumerate(crossing.runs):
        wheels = begin + np.arange(len(run.lines))
        begin += len(wheels)
        paths = [
            path.free
            for path in rows.paths
            if np.any((path.wheels >= wheels[0]) & (path.wheels <= wheels[-1]))
        ]
        start, stop = min(path.start for path in paths), max(path.stop for path in paths)
        head = run.course.head(ends)
        way = np.concatenate([head, head - run.course.direction * run.train.wheelbase])
        if way.max() < start or way.min() > stop:
            # Without the reach of footprints, which nobody wrote.
            own = [
                crossing.structure.line(name) for name in map(crossing.line_name, dict.fromkeys(run.lines))
            ]
            start, stop = min(line.start for line in own), max(line.stop for line in own)
            raise InputError(
                f"never brings a wheel onto the structure, which lies between {start:g} and {stop:g} m",
                field=f"others.{number - 1}" if number else "crossing",
                value=f"the first wheel runs from {head[0]:g} to {head[1]:g} m",
                fix="Check start, speed, time_step and steps",
            )


def check_sections(structure: Structure, settings: Settings) -> None:
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
