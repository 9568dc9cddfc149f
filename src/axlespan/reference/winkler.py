"""The infinite beam on an elastic foundation under a standing or moving force (Winkler)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

from ._inputs import FloatArray, require_not_negative, require_positive


@dataclass(frozen=True)
class WinklerBeam:
    """An infinite Euler-Bernoulli beam on springs: a rail on its track, undamped.

    Examples
    --------
    A rail 60E1 on 50 MN/m2:

    >>> rail = WinklerBeam(210e9 * 3.0383e-5, foundation_modulus=50e6, mass_per_length=60.21)
    >>> f"{1e3 * rail.static_deflection(85e3):.5f} mm, {rail.critical_speed:.2f} m/s"
    '1.00562 mm, 770.26 m/s'
    """

    bending_stiffness: float  # E I [N m2]
    foundation_modulus: float  # spring stiffness per length k [N/m2]
    mass_per_length: float  # [kg/m]

    def __post_init__(self) -> None:
        require_positive("bending_stiffness", self.bending_stiffness)
        require_positive("foundation_modulus", self.foundation_modulus)
        require_positive("mass_per_length", self.mass_per_length)

    @property
    def characteristic(self) -> float:
        """``beta = (k / 4 E I)^(1/4)`` [1/m]."""
        return float((0.25 * self.foundation_modulus / self.bending_stiffness) ** 0.25)

    @property
    def critical_speed(self) -> float:
        """``(4 k E I / m^2)^(1/4)``, the lowest speed of free waves [m/s]."""
        stiffness = 4.0 * self.foundation_modulus * self.bending_stiffness
        return float((stiffness / self.mass_per_length**2) ** 0.25)

    def static_deflection(self, force: float) -> float:
        """Depth under a standing force, ``P beta / 2 k`` [m], downward positive."""
        return 0.5 * force * self.characteristic / self.foundation_modulus

    def static_moment(self, force: float) -> float:
        """Bending moment under a standing force, ``P / 4 beta`` [Nm], sagging positive."""
        return 0.25 * force / self.characteristic

    def deflection(self, x: npt.ArrayLike, force: float, speed: float = 0.0) -> FloatArray:
        """Steady displacement at the distance ``x`` from a downward force, shape of x, upward positive [m].

        Theory, (R26). Holds below the critical speed; above it waves run ahead of the force, and without
        damping the steady state is not unique.
        """
        a, b, depth = self._profile(force, speed)
        distance = np.abs(np.asarray(x, dtype=np.float64))
        wave = np.cos(b * distance) + a / b * np.sin(b * distance)
        return -depth * np.exp(-a * distance) * wave

    def moment(self, x: npt.ArrayLike, force: float, speed: float = 0.0) -> FloatArray:
        """Steady bending moment at the distance ``x`` from a downward force, sagging positive [Nm]."""
        a, b, depth = self._profile(force, speed)
        distance = np.abs(np.asarray(x, dtype=np.float64))
        wave = np.cos(b * distance) - a / b * np.sin(b * distance)
        return self.bending_stiffness * depth * (a**2 + b**2) * np.exp(-a * distance) * wave

    def _profile(self, force: float, speed: float) -> tuple[float, float, float]:
        require_not_negative("speed", speed)
        ratio = (speed / self.critical_speed) ** 2
        if ratio >= 1.0:
            raise InputError(
                "must stay below the critical speed",
                field="speed",
                value=speed,
                fix=f"Write a speed below {self.critical_speed:.4g} m/s",
            )
        decay = self.characteristic * float(np.sqrt(1.0 - ratio))
        wave = self.characteristic * float(np.sqrt(1.0 + ratio))
        return decay, wave, self.static_deflection(force) / float(np.sqrt(1.0 - ratio))
