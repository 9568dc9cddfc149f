"""Defects of the wheel: flats and out-of-roundness, as functions of the distance rolled."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from axlespan.errors import InputError
from axlespan.irregularity.checks import Array, column, require_choice, require_finite, require_positive
from axlespan.irregularity.shapes import Shape, cusp, haversine, placed

__all__ = ["OutOfRound", "WheelFlat"]

_FLATS: dict[str, Shape] = {"fresh": cusp, "rounded": haversine}


@dataclass(frozen=True)
class WheelFlat:
    """A wheel flat: what the wheel's center loses in height, once every turn.

    x is the distance rolled since the middle of the flat was at `position`; r repeats with the circumference.
    A fresh flat of length l makes the wheel pivot about its edges, so the center describes two parabolas with
    a kink between, r = -d (1 - 2|x|/l)², and its depth is d = l²/(8R). A rounded one is a haversine (Newton &
    Clark 1979; Wu & Thompson 2002). Both hold at low speed; when the wheel leaves the rail, that is for the
    contact law to find.

    Parameters
    ----------
    length : float
        l [m]; less than half the circumference.
    wheel_radius : float
        R [m].
    depth : float, optional
        d [m]; l²/(8R) when left out. A flat that has worn round keeps its depth while it gets longer.
    shape : {"fresh", "rounded"}
        See above.
    position : float
        Distance rolled when the middle of the flat meets the rail [m].
    """

    length: float
    wheel_radius: float
    depth: float | None = None
    shape: Literal["fresh", "rounded"] = "fresh"
    position: float = 0.0

    def __post_init__(self) -> None:
        require_positive(length=self.length, wheel_radius=self.wheel_radius)
        require_finite(position=self.position)
        require_choice(self.shape, _FLATS, "shape")
        require_positive(depth=self.drop)
        if self.length > 0.5 * self.circumference:
            raise InputError(
                f"must be less than half the circumference, {0.5 * self.circumference:g} m",
                field="length",
                value=self.length,
            )

    @property
    def circumference(self) -> float:
        """2πR [m]."""
        return 2.0 * np.pi * self.wheel_radius

    @property
    def drop(self) -> float:
        """How far the wheel's center drops [m]: the depth given, or that of a fresh flat."""
        return self.length**2 / (8.0 * self.wheel_radius) if self.depth is None else self.depth

    def value(self, x: ArrayLike) -> Array:
        """Return r(x) [m] at the rolled distance x [m], shaped like x."""
        return self._derivative(x, 0)

    def slope(self, x: ArrayLike) -> Array:
        """Return dr/dx [-], shaped like x."""
        return self._derivative(x, 1)

    def curvature(self, x: ArrayLike) -> Array:
        """Return d²r/dx² [1/m], shaped like x."""
        return self._derivative(x, 2)

    def _derivative(self, x: ArrayLike, order: int) -> Array:
        half = 0.5 * self.length
        x = np.mod(np.asarray(x, dtype=np.float64) - self.position + half, self.circumference)
        return placed(x, 0.0, self.length, -self.drop, _FLATS[self.shape], order)


@dataclass(frozen=True, eq=False)
class OutOfRound:
    """An out-of-round (polygonal) wheel: r = Σ a_k sin(k x / R + φ_k) at the rolled distance x.

    Parameters
    ----------
    wheel_radius : float
        R [m].
    orders : array_like of int, (n,)
        Waves per turn k: 1 is eccentric, 2 oval, 3 a triangle, about 20 a high-order polygon.
    amplitudes : array_like, (n,)
        a_k [m].
    phases : array_like, (n,), optional
        φ_k [rad]; zero when left out.
    """

    wheel_radius: float
    orders: Array
    amplitudes: Array
    phases: Array | None = None

    def __post_init__(self) -> None:
        require_positive(wheel_radius=self.wheel_radius)
        phases = np.zeros(np.size(self.orders)) if self.phases is None else self.phases
        for field, entries in (("orders", self.orders), ("amplitudes", self.amplitudes), ("phases", phases)):
            object.__setattr__(self, field, column(np.atleast_1d(entries), field, at_least=1))
        whole = (self.orders == np.round(self.orders)) & (self.orders >= 1)
        if not whole.all():
            bad = float(self.orders[~whole][0])
            raise InputError("must be whole numbers of waves per turn, 1 or more", field="orders", value=bad)
        sizes = (self.orders.size, self.amplitudes.size, np.size(phases))
        if len(set(sizes)) > 1:
            raise InputError("orders, amplitudes and phases must be equally many", value=sizes)

    def value(self, x: ArrayLike) -> Array:
        """Return r(x) [m] at the rolled distance x [m], shaped like x."""
        return self._derivative(x, 0)

    def slope(self, x: ArrayLike) -> Array:
        """Return dr/dx [-], shaped like x."""
        return self._derivative(x, 1)

    def curvature(self, x: ArrayLike) -> Array:
        """Return d²r/dx² [1/m], shaped like x."""
        return self._derivative(x, 2)

    def _derivative(self, x: ArrayLike, order: int) -> Array:
        k = self.orders / self.wheel_radius
        phases = np.asarray(self.phases) + 0.5 * np.pi * order
        angles = np.asarray(x, dtype=np.float64)[..., np.newaxis] * k + phases
        return np.asarray(np.sin(angles) @ (self.amplitudes * k**order))
