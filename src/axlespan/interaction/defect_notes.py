"""What a time step is too long for: defects of lines and wheels that are passed in a few steps."""

from __future__ import annotations

import math
from collections.abc import Iterator

from axlespan.interaction.crossing import Crossing
from axlespan.irregularity import (
    Bump,
    DippedJoint,
    FiniteContact,
    OutOfRound,
    Pothole,
    Profile,
    Ramp,
    Squat,
    WheelFlat,
)

# Steps on a defect below which its shape is not seen, and those that are proposed.
_FEWEST, _PROPOSED = 4, 12


def defect_notes(crossing: Crossing, time_step: float, end: float) -> list[str]:
    """Warnings about defects that wheels pass in fewer steps than show them, one for each kind."""
    notes: dict[str, str] = {}
    for run in crossing.runs:
        speed = run.course.largest_speed(end)
        way = speed * time_step
        felt = {
            id(profile): profile
            for profile, (_, _, point, _) in zip(run.profiles, run.train.contacts, strict=True)
            if point.dof is not None  # forces feel no surface
        }
        found = sorted((size, name) for profile in felt.values() for name, size in _sizes(profile, 0.0))
        for size, name in found:
            if way > size / _FEWEST and name not in notes:
                notes[name] = (
                    f"warning: a wheel moves {1e3 * way:.3g} mm in a time step, too much to see {name} of "
                    f"{1e3 * size:.3g} mm; {size / _PROPOSED / speed:.1g} s would show it"
                )
    return list(notes.values())


def _sizes(profile: Profile, patch: float) -> Iterator[tuple[str, float]]:
    """Kinds of defects in a profile and how long they are [m]; a patch makes each at least as long."""
    match profile:
        case Bump() | DippedJoint() | Squat() | WheelFlat():
            words = {
                Bump: "a bump",
                DippedJoint: "a dipped joint",
                Squat: "a squat",
                WheelFlat: "a wheel flat",
            }
            yield words[type(profile)], max(profile.length, patch)
        case Pothole():
            yield "the edge of a pothole", max(profile.edge, patch)
        case Ramp():
            yield "a ramp", max(profile.stop - profile.start, patch)
        case OutOfRound():
            yield "a wave of a wheel", 2.0 * math.pi * profile.wheel_radius / float(profile.orders.max())
        case FiniteContact(inner, length):
            yield from _sizes(inner, length)
        case _:
            inner_ones = [
                *getattr(profile, "profiles", ()),
                *filter(None, [getattr(profile, "profile", None)]),
            ]
            for one in inner_ones:
                yield from _sizes(one, patch)
