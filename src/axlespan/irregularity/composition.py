"""Profiles made of profiles: sums, shifts, multiples, and stretches with a taper."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from axlespan.errors import InputError
from axlespan.irregularity.checks import Array, require_finite, require_order, within
from axlespan.irregularity.profile import Profile

__all__ = ["Bounded", "Scaled", "Shifted", "Sum"]


@dataclass(frozen=True)
class Sum:
    """The sum of profiles; of none, the smooth path.

    Parameters
    ----------
    profiles : sequence of Profile
        The terms.
    """

    profiles: tuple[Profile, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "profiles", tuple(self.profiles))

    def value(self, x: ArrayLike) -> Array:
        """Return r(x) [m], shaped like x."""
        return sum((p.value(x) for p in self.profiles), start=np.zeros(np.shape(x)))

    def slope(self, x: ArrayLike) -> Array:
        """Return dr/dx [-], shaped like x."""
        return sum((p.slope(x) for p in self.profiles), start=np.zeros(np.shape(x)))

    def curvature(self, x: ArrayLike) -> Array:
        """Return d²r/dx² [1/m], shaped like x."""
        return sum((p.curvature(x) for p in self.profiles), start=np.zeros(np.shape(x)))


@dataclass(frozen=True)
class Shifted:
    """A profile moved forward along the path: r(x) = profile(x - offset).

    Parameters
    ----------
    profile : Profile
        The profile to move.
    offset : float
        How far [m]; what was at x = 0 comes to x = offset.
    """

    profile: Profile
    offset: float

    def __post_init__(self) -> None:
        require_finite(offset=self.offset)

    def value(self, x: ArrayLike) -> Array:
        """Return r(x) [m], shaped like x."""
        return self.profile.value(np.asarray(x, dtype=np.float64) - self.offset)

    def slope(self, x: ArrayLike) -> Array:
        """Return dr/dx [-], shaped like x."""
        return self.profile.slope(np.asarray(x, dtype=np.float64) - self.offset)

    def curvature(self, x: ArrayLike) -> Array:
        """Return d²r/dx² [1/m], shaped like x."""
        return self.profile.curvature(np.asarray(x, dtype=np.float64) - self.offset)


@dataclass(frozen=True)
class Scaled:
    """A profile multiplied by a number.

    Parameters
    ----------
    profile : Profile
        The profile to multiply.
    factor : float
        The factor; -1 turns bumps into dips.
    """

    profile: Profile
    factor: float

    def __post_init__(self) -> None:
        require_finite(factor=self.factor)

    def value(self, x: ArrayLike) -> Array:
        """Return r(x) [m], shaped like x."""
        return self.factor * self.profile.value(x)

    def slope(self, x: ArrayLike) -> Array:
        """Return dr/dx [-], shaped like x."""
        return self.factor * self.profile.slope(x)

    def curvature(self, x: ArrayLike) -> Array:
        """Return d²r/dx² [1/m], shaped like x."""
        return self.factor * self.profile.curvature(x)


@dataclass(frozen=True)
class Bounded:
    """A profile that is zero outside start <= x <= stop, with cosine tapers inside the bounds.

    Parameters
    ----------
    profile : Profile
        The profile to bound.
    start, stop : float, optional
        The bounds [m]; one left out doesn't bound and has no taper.
    taper : float
        Length [m] over which the profile fades in behind start and out before stop. The factor is
        (1 - cos(π d / taper)) / 2 at the distance d from the bound, so r and its slope don't jump, the
        curvature does. With 0 the profile is cut off.
    """

    profile: Profile
    start: float | None = None
    stop: float | None = None
    taper: float = 0.0

    def __post_init__(self) -> None:
        require_order(self.start, self.stop)
        require_finite(taper=self.taper)
        if self.taper < 0.0:
            raise InputError("must not be negative", field="taper", value=self.taper)
        if self.start is not None and self.stop is not None and 2.0 * self.taper > self.stop - self.start:
            half = 0.5 * (self.stop - self.start)
            raise InputError(
                f"must be at most half the distance from start to stop, {half:g} m",
                field="taper",
                value=self.taper,
            )

    def value(self, x: ArrayLike) -> Array:
        """Return r(x) [m], shaped like x."""
        x = np.asarray(x, dtype=np.float64)
        return self._window(x, 0) * self.profile.value(x)

    def slope(self, x: ArrayLike) -> Array:
        """Return dr/dx [-], shaped like x."""
        x = np.asarray(x, dtype=np.float64)
        return self._window(x, 1) * self.profile.value(x) + self._window(x, 0) * self.profile.slope(x)

    def curvature(self, x: ArrayLike) -> Array:
        """Return d²r/dx² [1/m], shaped like x."""
        x = np.asarray(x, dtype=np.float64)
        return (
            self._window(x, 2) * self.profile.value(x)
            + 2.0 * self._window(x, 1) * self.profile.slope(x)
            + self._window(x, 0) * self.profile.curvature(x)
        )

    def _window(self, x: Array, order: int) -> Array:
        """Derivative of the window; at most one of the two tapers is felt at any x."""
        window = within(x, self.start, self.stop).astype(np.float64) * (order == 0)
        for bound, sign in ((self.start, 1.0), (self.stop, -1.0)):
            if bound is not None and self.taper > 0.0:
                d = sign * (x - bound)
                k = np.pi / self.taper
                fade = (
                    0.5 - 0.5 * np.cos(k * d),
                    0.5 * sign * k * np.sin(k * d),
                    0.5 * k * k * np.cos(k * d),
                )[order]
                window = np.where((d >= 0.0) & (d < self.taper), fade, window)
        return window
