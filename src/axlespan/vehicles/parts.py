"""What vehicles of rigid bodies are made of."""

from __future__ import annotations

from dataclasses import dataclass

from axlespan.model.nonlinear import SpringLaw


@dataclass(frozen=True)
class Body:
    """A rigid body; it pitches and rolls if it has the inertias for it."""

    name: str
    mass: float  # [kg]
    position: float  # of its center of gravity, behind the first wheel [m]
    inertia: float | None = None  # about its transverse axis: it pitches [kg m^2]
    roll_inertia: float | None = None  # about its longitudinal axis: it rolls [kg m^2]
    height: float | None = None  # of its center of gravity above the rails, where lateral forces act [m]
    side: float = 0.0  # of its center of gravity, to the left of the middle [m]


@dataclass(frozen=True)
class Wheel:
    """A wheelset, which follows the line; with a gauge, its left and right wheel follow two lines."""

    position: float  # behind the first wheel [m]
    mass: float = 0.0  # [kg] of the wheelset, or of each of two independent wheels
    name: str | None = None  # wheel1, wheel2, … when left out
    gauge: float | None = None  # between the left and the right contact point [m]
    roll_inertia: float | None = None  # [kg m^2]; when left out, half of the mass is at each wheel
    independent: bool = False  # two wheels without an axle between them
    radius: float | None = None  # rolling radius [m]


@dataclass(frozen=True)
class Suspension:
    """A spring and a dashpot side by side, between two bodies or a body and a wheel.

    With a spread there are two of them, left and right, each with the stiffness and damping given.
    """

    between: tuple[str, str]
    stiffness: float = 0.0  # [N/m]
    damping: float = 0.0  # [N s/m]
    at: float | None = (
        None  # behind the first wheel [m]; at the wheel, or at the second one's center, when left out
    )
    spread: float | None = None  # between the left and the right one [m]
    side: float | None = None  # of a single one, to the left of the middle [m]
    roll_stiffness: float = 0.0  # of an anti-roll bar between the two [N m/rad]
    roll_damping: float = 0.0  # [N m s/rad]
    # Nonlinear springs and dashpots beside it, each with a gap that is added to the elongation [m]; that is the
    # displacement of the first one less that of the second (of the body less that of the wheel), from rest on.
    laws: tuple[tuple[SpringLaw, float], ...] = ()


@dataclass(frozen=True)
class Hinge:
    """Two bodies move up and down together at a point and turn freely there: a fifth wheel, a shared joint."""

    between: tuple[str, str]
    at: float  # behind the first wheel [m]
