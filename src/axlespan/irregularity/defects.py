"""Single defects of the path: joints, bumps, ramps, squats, potholes, settlements."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from axlespan.errors import InputError
from axlespan.irregularity.checks import (
    Array,
    require_choice,
    require_finite,
    require_order,
    require_positive,
)
from axlespan.irregularity.shapes import (
    Shape,
    cosine_rise,
    cusp,
    half_sine,
    haversine,
    linear_rise,
    placed,
    two_lobes,
)

__all__ = ["Bump", "DippedJoint", "Pothole", "Ramp", "SettlementDip", "Squat"]

_BUMPS: dict[str, Shape] = {"haversine": haversine, "half-sine": half_sine}
_RISES: dict[str, Shape] = {"linear": linear_rise, "cosine": cosine_rise}


class _Defect(ABC):
    """What all defects of finite length share: four derivatives of one formula."""

    def value(self, x: ArrayLike) -> Array:
        """Return r(x) [m], shaped like x."""
        return self._derivative(np.asarray(x, dtype=np.float64), 0)

    def slope(self, x: ArrayLike) -> Array:
        """Return dr/dx [-], shaped like x."""
        return self._derivative(np.asarray(x, dtype=np.float64), 1)

    def curvature(self, x: ArrayLike) -> Array:
        """Return d²r/dx² [1/m], shaped like x."""
        return self._derivative(np.asarray(x, dtype=np.float64), 2)

    def integral(self, x: ArrayLike) -> Array:
        """Return an antiderivative of r [m²], shaped like x."""
        return self._derivative(np.asarray(x, dtype=np.float64), -1)

    @abstractmethod
    def _derivative(self, x: Array, order: int) -> Array:
        """Return the derivative of order 0, 1 or 2, or an antiderivative (-1)."""


@dataclass(frozen=True)
class Bump(_Defect):
    """A single bump; with a negative height a single dip.

    Parameters
    ----------
    center : float
        Position of the top [m].
    height : float
        Height of the top [m].
    length : float
        Length from foot to foot [m].
    shape : {"haversine", "half-sine"}
        (1 - cos 2πu)/2, which has no kinks, or sin πu, which has one at each foot.
    """

    center: float
    height: float
    length: float
    shape: Literal["haversine", "half-sine"] = "haversine"

    def __post_init__(self) -> None:
        require_finite(center=self.center, height=self.height)
        require_positive(length=self.length)
        require_choice(self.shape, _BUMPS, "shape")

    def _derivative(self, x: Array, order: int) -> Array:
        start = self.center - 0.5 * self.length
        return placed(x, start, self.length, self.height, _BUMPS[self.shape], order)


@dataclass(frozen=True)
class DippedJoint(_Defect):
    """A dipped rail joint: two parabolas that meet in a kink, r = -d (1 - 2|x - x_j|/L)².

    The quadratic dip of Jenkins et al. (1974) and Wu & Thompson (2003); a wheel feels its dip angle, the
    change of slope at the joint, 8d/L. The curvature leaves out the impulse of the kink.

    Parameters
    ----------
    position : float
        The joint x_j [m].
    depth : float
        d [m], positive.
    length : float
        L [m] from undisturbed rail to undisturbed rail.
    """

    position: float
    depth: float
    length: float

    def __post_init__(self) -> None:
        require_finite(position=self.position)
        require_positive(depth=self.depth, length=self.length)

    @property
    def dip_angle(self) -> float:
        """Change of slope at the joint [rad]."""
        return 8.0 * self.depth / self.length

    def _derivative(self, x: Array, order: int) -> Array:
        return placed(x, self.position - 0.5 * self.length, self.length, -self.depth, cusp, order)


@dataclass(frozen=True)
class Ramp(_Defect):
    """A rise from level to level: zero before start, `height` behind stop.

    Parameters
    ----------
    start, stop : float
        Where the ramp begins and ends [m].
    height : float
        Height behind the ramp [m]; negative for a ramp down.
    shape : {"linear", "cosine"}
        Straight, with a kink at both ends, or (1 - cos πu)/2, without.
    """

    start: float
    stop: float
    height: float
    shape: Literal["linear", "cosine"] = "linear"

    def __post_init__(self) -> None:
        require_order(self.start, self.stop)
        require_finite(height=self.height)
        require_choice(self.shape, _RISES, "shape")

    def _derivative(self, x: Array, order: int) -> Array:
        rise = placed(x, self.start, self.stop - self.start, self.height, _RISES[self.shape], order)
        if order > 0:
            return rise
        behind = np.maximum(x - self.stop, 0.0)
        return rise + self.height * behind if order == -1 else np.where(behind > 0.0, self.height, rise)


@dataclass(frozen=True)
class Squat(_Defect):
    """A squat on the rail head: a short dip, mostly W-shaped.

    An idealization by two cosines; measured squats have unequal lobes. A plain dip is ``Bump`` with a
    negative height.

    Parameters
    ----------
    center : float
        Position of the middle [m].
    depth : float
        Depth of the two bottoms [m], positive.
    length : float
        Length along the rail [m]; some centimeters.
    crest : float
        Height of the crest in the middle above the bottoms, as a share of the depth: 0 (one flat bottom) to 1
        (the crest reaches the undisturbed rail).
    """

    center: float
    depth: float
    length: float
    crest: float = 0.3

    def __post_init__(self) -> None:
        require_finite(center=self.center)
        require_positive(depth=self.depth, length=self.length)
        if not 0.0 <= self.crest <= 1.0:
            raise InputError("must lie between 0 and 1", field="crest", value=self.crest)

    def _derivative(self, x: Array, order: int) -> Array:
        shape = partial(two_lobes, crest=self.crest)
        return placed(x, self.center - 0.5 * self.length, self.length, -self.depth, shape, order)


@dataclass(frozen=True)
class Pothole(_Defect):
    """A hole in a road: a flat bottom between two cosine edges.

    Parameters
    ----------
    center : float
        Position of the middle [m].
    depth : float
        Depth of the bottom [m], positive.
    length : float
        Length from rim to rim [m], edges included.
    edge : float
        Length of either edge [m], at most half the length. A tyre feels edges through its patch:
        `FiniteContact`.
    """

    center: float
    depth: float
    length: float
    edge: float

    def __post_init__(self) -> None:
        require_finite(center=self.center)
        require_positive(depth=self.depth, length=self.length, edge=self.edge)
        if 2.0 * self.edge > self.length:
            raise InputError(
                f"must be at most half the length, {0.5 * self.length:g} m", field="edge", value=self.edge
            )

    def _derivative(self, x: Array, order: int) -> Array:
        start, stop = self.center - 0.5 * self.length, self.center + 0.5 * self.length
        down = Ramp(start, start + self.edge, -self.depth, "cosine")
        up = Ramp(stop - self.edge, stop, self.depth, "cosine")
        return down._derivative(x, order) + up._derivative(x, order)


@dataclass(frozen=True)
class SettlementDip:
    """A settlement trough: r = -d exp(-(x - x_c)² / (2 i²)), the shape of Peck (1969).

    Parameters
    ----------
    center : float
        Position x_c of the deepest point [m].
    depth : float
        d [m], positive.
    inflection : float
        Distance i from the center to the steepest slope [m]; the trough is felt over about 6 i.
    """

    center: float
    depth: float
    inflection: float

    def __post_init__(self) -> None:
        require_finite(center=self.center)
        require_positive(depth=self.depth, inflection=self.inflection)

    def value(self, x: ArrayLike) -> Array:
        """Return r(x) [m], shaped like x."""
        u = (np.asarray(x, dtype=np.float64) - self.center) / self.inflection
        return np.asarray(-self.depth * np.exp(-0.5 * u * u))

    def slope(self, x: ArrayLike) -> Array:
        """Return dr/dx [-], shaped like x."""
        u = (np.asarray(x, dtype=np.float64) - self.center) / self.inflection
        return -u / self.inflection * self.value(x)

    def curvature(self, x: ArrayLike) -> Array:
        """Return d²r/dx² [1/m], shaped like x."""
        u = (np.asarray(x, dtype=np.float64) - self.center) / self.inflection
        return (u * u - 1.0) / self.inflection**2 * self.value(x)
