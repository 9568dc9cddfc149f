"""What looks wrong of the irregularity of a crossing, and may be right: steps, heights, lines without wheels."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from axlespan.interaction.crossing import Crossing, Run
from axlespan.irregularity import Profile

# Heights of a step that a wheel is thrown up by, and of a surface that no train runs on [m].
_STEP, _HIGHEST = 2e-5, 0.2
# Distance to either side of a place, over which a step is told from a slope [m].
_BESIDE = 1e-7
# Places at which a profile is looked at.
_PLACES = 2001


def surface_notes(crossing: Crossing, end: float) -> list[str]:
    """Warnings about the irregularities on the way of the wheels until a time [s]."""
    notes = list(_unused(crossing))
    seen: set[int] = set()
    for run in crossing.runs:
        low, high = _way(run, end)
        for name, profile in zip(run.lines, run.profiles, strict=True):
            if id(profile) not in seen:
                seen.add(id(profile))
                notes += [
                    f"warning: the irregularity of the line '{name}' {word}"
                    for word in _wrong(profile, low, high)
                ]
    return notes


def _unused(crossing: Crossing) -> Iterator[str]:
    """Irregularities of lines that no wheel runs on."""
    ridden = {crossing.line_name(name) for run in crossing.runs for name in run.lines}
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
    places = [place for place in _ends(profile) if low < place < high]
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
