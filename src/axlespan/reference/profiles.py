"""Irregularity profiles with their derivatives, for the reference solutions only."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from axlespan.errors import InputError

from ._inputs import FloatArray, require_positive

Curve = Callable[[FloatArray], FloatArray]


@dataclass(frozen=True)
class Profile:
    """The irregularity r(x) under the wheels, upward positive, known on and off the beam.

    Slope and curvature are needed by dashpots and by wheels that have mass. ``kinks`` names the places
    where the slope jumps, so that the solution restarts there.
    """

    height: Curve  # r(x) [m]
    slope: Curve | None = None  # dr/dx [-]
    curvature: Curve | None = None  # d2r/dx2 [1/m]
    kinks: tuple[float, ...] = ()  # [m]

    def derivative(self, order: int, x: FloatArray) -> FloatArray:
        """Return r (order 0), dr/dx (1) or d2r/dx2 (2) at ``x``, in the shape of ``x``."""
        curve = (self.height, self.slope, self.curvature)[order]
        if curve is None:
            raise InputError(
                "must give the slope for dashpots, slope and curvature for wheels with mass",
                field="profile." + ("slope", "curvature")[order - 1],
                value=None,
                fix="Pass the derivative beside the height",
            )
        return np.asarray(curve(x), dtype=np.float64)

    def require_continuous(self) -> None:
        """Raise `InputError` where the height itself jumps: a wheel with mass or a dashpot cannot follow."""
        for kink in self.kinks:
            sides = np.array([kink - 1e-7, kink + 1e-7])
            if abs(np.diff(self.derivative(0, sides))[0]) > 1e-7:
                raise InputError(
                    "must not jump under a dashpot or a wheel with mass",
                    field="profile.height",
                    value=f"jump at x = {kink:g} m",
                    fix="Bound the profile where it is zero",
                )


def level() -> Profile:
    """Return the profile without irregularity."""
    return Profile(np.zeros_like, np.zeros_like, np.zeros_like)


def harmonic(
    amplitude: float, wavelength: float, start: float = -math.inf, end: float = math.inf, phase: float = 0.0
) -> Profile:
    """Return ``amplitude sin(2 pi x / wavelength + phase)`` from ``start`` to ``end``, else 0: N12 (40).

    Parameters
    ----------
    amplitude, wavelength : float
        [m].
    start, end : float, optional
        Where the irregularity begins and ends [m]; everywhere when left out.
    phase : float, optional
        Phase at x = 0 [rad].

    Examples
    --------
    >>> r = harmonic(0.5e-3, 5.0, start=0.0, end=25.0)
    >>> r.height(np.array([-1.25, 1.25])).tolist()
    [0.0, 0.0005]
    """
    require_positive("wavelength", wavelength)
    if not start < end:
        raise InputError("must lie before the end", field="start", value=start, fix="Write start < end")
    wave = 2.0 * np.pi / wavelength
    slack = 1e-9  # [m] a wheel that stands at a bound up to rounding is inside

    def bounded(x: FloatArray, inside: FloatArray) -> FloatArray:
        return np.where((x >= start - slack) & (x <= end + slack), inside, 0.0)

    def height(x: FloatArray) -> FloatArray:
        return bounded(x, amplitude * np.sin(wave * x + phase))

    def slope(x: FloatArray) -> FloatArray:
        return bounded(x, amplitude * wave * np.cos(wave * x + phase))

    def curvature(x: FloatArray) -> FloatArray:
        return bounded(x, -amplitude * wave**2 * np.sin(wave * x + phase))

    return Profile(height, slope, curvature, tuple(x for x in (start, end) if math.isfinite(x)))
