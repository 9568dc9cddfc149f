"""Materials and cross-sections in engineering terms."""

from __future__ import annotations

import math
from dataclasses import dataclass

from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError


def require_positive(value: float, field: str, *, zero: bool = False) -> float:
    """Return the value if it is a finite positive number (or zero where allowed).

    Raises
    ------
    InputError
        Otherwise, naming the field.
    """
    number = float(value)
    if math.isnan(number) or number < 0.0 or (number == 0.0 and not zero):
        rule = "must be zero or positive" if zero else "must be positive"
        raise InputError(rule, field=field, value=value)
    if math.isinf(number):
        raise InputError("must be finite", field=field, value=value)
    return number


@dataclass(frozen=True)
class Material:
    """A linear elastic isotropic material."""

    youngs_modulus: float  # [Pa]
    poisson_ratio: float = 0.2  # [-]
    density: float = 0.0  # [kg/m^3]

    def __post_init__(self) -> None:
        require_positive(self.youngs_modulus, "youngs_modulus")
        require_positive(self.density, "density", zero=True)
        if not -1.0 < self.poisson_ratio < 0.5:
            raise InputError("must lie between -1 and 0.5", field="poisson_ratio", value=self.poisson_ratio)

    @property
    def shear_modulus(self) -> float:
        """G = E / (2 (1 + ν)) [Pa]."""
        return self.youngs_modulus / (2.0 * (1.0 + self.poisson_ratio))


@dataclass(frozen=True)
class BeamSection:
    """A beam's cross-section; local y is lateral, z vertical for a horizontal beam."""

    second_moment: float  # I_y, bending in the vertical plane [m^4]
    area: float | None = None  # [m^2]; without it the beam carries no axial force
    lateral_second_moment: float = 0.0  # I_z [m^4]
    torsion_constant: float = 0.0  # J [m^4]
    shear_area: float | None = None  # κ_z A [m^2]; None: no shear deformation
    lateral_shear_area: float | None = None  # κ_y A [m^2]
    mass_per_length: float | None = None  # [kg/m]; ρ A by default
    rotary_inertia: bool | None = None  # of the section; by default, with shear deformation only

    def __post_init__(self) -> None:
        require_positive(self.second_moment, "second_moment")
        for name in ("area", "shear_area", "lateral_shear_area", "mass_per_length"):
            if getattr(self, name) is not None:
                require_positive(getattr(self, name), name, zero=name == "mass_per_length")
        for name in ("lateral_second_moment", "torsion_constant"):
            require_positive(getattr(self, name), name, zero=True)

    def properties(self, material: Material) -> BeamProperties:
        """Stiffness and mass of a beam of this section and material.

        Parameters
        ----------
        material : Material

        Raises
        ------
        InputError
            If rotary inertia is asked for without an area.
        """
        shear_modulus, modulus = material.shear_modulus, material.youngs_modulus
        mass = material.density * (self.area or 0.0) if self.mass_per_length is None else self.mass_per_length
        with_rotary = self.shear_area is not None if self.rotary_inertia is None else self.rotary_inertia
        if with_rotary and self.area is None:
            raise InputError(
                "is needed for the rotary inertia of the section",
                field="area",
                fix="Give the area, or rotary_inertia: false",
            )
        per_moment = mass / self.area if with_rotary and self.area else 0.0
        return BeamProperties(
            axial_stiffness=modulus * (self.area or 0.0),
            bending_stiffness_y=modulus * self.second_moment,
            bending_stiffness_z=modulus * self.lateral_second_moment,
            torsional_stiffness=shear_modulus * self.torsion_constant,
            shear_stiffness_y=math.inf
            if self.lateral_shear_area is None
            else shear_modulus * self.lateral_shear_area,
            shear_stiffness_z=math.inf if self.shear_area is None else shear_modulus * self.shear_area,
            mass_per_length=mass,
            rotary_inertia_y=per_moment * self.second_moment,
            rotary_inertia_z=per_moment * self.lateral_second_moment,
        )
