"""The vehicle of the semi-analytical solutions: a body on a spring and a dashpot over a wheel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from axlespan.errors import InputError

from ._inputs import FloatArray, require_not_negative, require_positive


@dataclass(frozen=True)
class WheelUnit:
    """One wheel, with or without mass, that may carry a body on a spring and a dashpot in parallel.

    Examples
    --------
    >>> WheelUnit.sprung_mass(mass=5750.0, stiffness=1.595e6)
    WheelUnit(wheel_mass=0.0, body_mass=5750.0, stiffness=1595000.0, damping=0.0)
    """

    wheel_mass: float  # [kg], zero for a contact point without mass
    body_mass: float = 0.0  # [kg]
    stiffness: float = 0.0  # [N/m]
    damping: float = 0.0  # [Ns/m]

    def __post_init__(self) -> None:
        for field in ("wheel_mass", "body_mass", "stiffness", "damping"):
            require_not_negative(field, getattr(self, field))
        if self.body_mass > 0.0:
            require_positive("stiffness", self.stiffness)
        elif self.stiffness > 0.0 or self.damping > 0.0:
            raise InputError(
                "must be positive where there is a spring or a dashpot",
                field="body_mass",
                value=self.body_mass,
                fix="Use WheelUnit.rigid_mass for a mass without suspension",
            )
        elif self.wheel_mass == 0.0:
            raise InputError("must have some mass", field="wheel_mass", value=0.0, fix="Give a mass")

    @classmethod
    def sprung_mass(cls, mass: float, stiffness: float, damping: float = 0.0) -> WheelUnit:
        """Return N12's sprung mass: the wheel has no mass of its own."""
        return cls(wheel_mass=0.0, body_mass=mass, stiffness=stiffness, damping=damping)

    @classmethod
    def rigid_mass(cls, mass: float) -> WheelUnit:
        """Return a mass that follows the beam without suspension."""
        return cls(wheel_mass=mass)

    @property
    def mass(self) -> float:
        """Mass of wheel and body [kg]."""
        return self.wheel_mass + self.body_mass


@dataclass(frozen=True)
class UnitTable:
    """The data of a row of units, one column per property."""

    wheel_mass: FloatArray  # (vehicle,) [kg]
    body_mass: FloatArray  # (vehicle,) [kg]
    stiffness: FloatArray  # (vehicle,) [N/m]
    damping: FloatArray  # (vehicle,) [Ns/m]

    @classmethod
    def of(cls, units: Sequence[WheelUnit]) -> UnitTable:
        """Return the table of ``units``."""
        if len(units) == 0:
            raise InputError(
                "must name one unit at least", field="units", value=units, fix="Give a WheelUnit"
            )
        return cls(
            np.array([unit.wheel_mass for unit in units]),
            np.array([unit.body_mass for unit in units]),
            np.array([unit.stiffness for unit in units]),
            np.array([unit.damping for unit in units]),
        )

    @property
    def mass(self) -> FloatArray:
        """Mass of wheel and body, (vehicle,) [kg]."""
        return self.wheel_mass + self.body_mass

    @property
    def profile_derivatives(self) -> int:
        """Derivatives of the profile that enter the equations: 0 (spring), 1 (dashpot) or 2 (wheel mass)."""
        if np.any(self.wheel_mass > 0.0):
            return 2
        return 1 if np.any(self.damping > 0.0) else 0

    def body_rate(self, coefficient: FloatArray) -> FloatArray:
        """``coefficient / body_mass``, zero where there is no body, (vehicle,)."""
        has_body = self.body_mass > 0.0
        return np.where(has_body, coefficient / np.where(has_body, self.body_mass, 1.0), 0.0)
