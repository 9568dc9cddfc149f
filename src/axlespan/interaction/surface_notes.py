"""What looks wrong of a crossing's surface and start, and may be right: steps, heights, lines without wheels."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from axlespan.interaction.crossing import Crossing, Run
from axlespan.irregularity import Profile
from axlespan.running.structure import DECK_LINE, RAIL_LINE

# Heights of a step that a wheel is thrown up by, and of a surface that no train runs on [m].
_STEP, _HIGHEST = 2e-5, 0.2
# Distance to either side of a place, over which a step is told from a slope [m].
_BESIDE = 1e-7
# Velocity of a support that sets off with a jerk [m/s or rad/s].
_JERK = 1e-6
# Places at which a profile is looked at.
_PLACES = 2001
# Way on a track after which the deck's acceleration is off by less than 1 % [m]; 3 % after half of it, 34 % without.
_SETTLED = 10.0


def surface_notes(crossing: Crossing, end: float) -> list[str]:
    """Warnings about the irregularities on the way of the wheels until a time [s]."""
    notes = list(_unused(crossing))
    seen: set[int] = set()
    for run in crossing.runs:
        low, high = _way(run, end)
        for name, profile in zip(run.lines, run.surfaces, strict=True):
            if id(profile) not in seen:
                seen.add(id(profile))
                notes += [
                    f"warning: the irregularity of the line '{name}' {word}"
                    for word in _wrong(profile, low, high)
                ]
    return notes


def start_notes(crossing: Crossing) -> list[str]:
    """Warnings of supports that start with a jerk, and of wheels that are set off on a track at the bridge."""
    return [*_jerks(crossing), *_set_off(crossing)]


def _jerks(crossing: Crossing) -> list[str]:
    """A warning if a support has a velocity at time zero, when the structure has none."""
    system, start = crossing.structure.system, np.zeros(1)
    speeds = np.array([float(motion.velocity(start)[0]) for motion in system.motions])
    moving = np.flatnonzero(np.abs(speeds) > _JERK)
    if not len(moving):
        return []
    first = int(moving[0])
    return [
        f"warning: the support '{system.support_names[first]}' moves at {speeds[first]:.3g} m/s or rad/s at t = 0, when the "
        "structure is at rest: a blow that reactions and accelerations show at first; let it begin at rest, "
        "by a smooth table or with a phase of 90 deg"
    ]


def _set_off(crossing: Crossing) -> list[str]:
    """A warning if wheels are set off on a track at the bridge, where the rails have no velocity yet."""
    lines = crossing.structure.lines
    if RAIL_LINE not in lines or DECK_LINE not in lines:
        return []
    deck = lines[DECK_LINE]
    for number, run in enumerate(crossing.runs):
        way = run.course.direction
        wheels = run.course.head(np.zeros(1)) - way * run.train.offsets
        ahead = deck.start - wheels if way > 0 else wheels - deck.stop  # to the deck, negative from there on
        near = (ahead < _SETTLED) & (ahead > deck.start - deck.stop)
        if run.course.velocity(np.zeros(1))[0] != 0.0 and np.any(near):
            place = deck.start - _SETTLED if way > 0 else deck.stop + _SETTLED
            which = f"train {number + 1}" if len(crossing.runs) > 1 else "the train"
            return [
                f"warning: {which} starts at the bridge, on a track that does not move yet: forces and deck "
                f"accelerations are wrong at first; let it start at {place:g} m or further away"
            ]
    return []


def _unused(crossing: Crossing) -> Iterator[str]:
    """Irregularities of lines that no wheel runs on."""
    ridden = {crossing.line_name(name) for name in dict.fromkeys(crossing.contact_lines)}
    for moving in (crossing, *crossing.others):
        if isinstance(moving.irregularity, Mapping):
            for name in moving.irregularity:
                if crossing.line_name(name) not in ridden:
                    lines = ", ".join(sorted(ridden))
                    yield f"warning: no wheel runs on the line '{name}', which has an irregularity; wheels run on {lines}"


def _way(run: Run, end: float) -> tuple[float, float]:
    """Lowest and highest position of the wheels of a train until a time [m]."""
    head = run.course.head(np.array([0.0, end]))
    ends = np.concatenate([head, head - run.course.direction * run.train.wheelbase])
    return float(ends.min()), float(ends.max())


def _wrong(profile: Profile, low: float, high: float) -> Iterator[str]:
    """What is said of a profile between two positions [m]."""
    places = sorted({place for place in _ends(profile) if low < place < high})
    for place in places:
        before, after = np.asarray(profile.value(np.array([place - _BESIDE, place + _BESIDE])))
        if abs(after - before) > _STEP:
            yield (
                f"steps by {1e3 * (after - before):.2g} mm at {place:g} m, a blow to each wheel: let it begin and end "
                "with zero, or give it a taper"
            )
    height = float(np.abs(profile.value(np.linspace(low, high, _PLACES))).max())
    if height > _HIGHEST:
        yield f"is up to {height:.3g} m high or deep on the way of the wheels; are its units right?"


def _ends(profile: Profile) -> list[float]:
    """Places where a profile begins and ends [m]."""
    inner = [*getattr(profile, "profiles", ()), *filter(None, [getattr(profile, "profile", None)])]
    offset = float(getattr(profile, "offset", 0.0))
    ends = [offset + place for one in inner for place in _ends(one)]
    ends += [float(x) for name in ("start", "stop") if (x := getattr(profile, name, None)) is not None]
    points = getattr(profile, "x", None)
    return [*ends, float(points[0]), float(points[-1])] if isinstance(points, np.ndarray) else ends
