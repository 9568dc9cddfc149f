"""Materials of shells and the section stiffness that follows: N = A ε, M = D κ, Q = S γ.

Plane stress in the layer (σ_zz = 0), orthotropic with its axis 1 along a direction that is projected on
each element; resultants are in the order (xx, yy, xy) and (xz, yz) of the element's axes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.elements.shell_geometry import per_element
from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ShellMaterial:
    """A linear elastic orthotropic material of a shell; `ShellMaterial.isotropic` is the usual one.

    Every modulus is one number or one per element. Axis 1 is the `direction` projected on the element,
    then turned by `angle` about the element's normal; axis 3 is the normal.
    """

    youngs_modulus_1: float | FloatArray  # E_1 [N/m^2]
    youngs_modulus_2: float | FloatArray  # E_2 [N/m^2]
    poisson_ratio_12: float | FloatArray  # ν_12: strain -ν_12 σ_1/E_1 along axis 2
    shear_modulus_12: float | FloatArray  # G_12 [N/m^2]
    shear_modulus_13: float | FloatArray  # G_13, transverse [N/m^2]
    shear_modulus_23: float | FloatArray  # G_23, transverse [N/m^2]
    direction: tuple[float, float, float] | None = None  # in global axes; None: the element's first side
    angle: float | FloatArray = 0.0  # from the direction to axis 1 [rad]
    shear_factor: float = 5.0 / 6.0  # κ of the transverse shear

    def __post_init__(self) -> None:
        for name in (
            "youngs_modulus_1",
            "youngs_modulus_2",
            "shear_modulus_12",
            "shear_modulus_13",
            "shear_modulus_23",
            "shear_factor",
        ):
            value = np.asarray(getattr(self, name), dtype=float)
            if not np.all((value > 0.0) & np.isfinite(value)):
                raise InputError("must be positive and finite", field=name, value=getattr(self, name))
        e1, e2, nu = (
            np.asarray(value, dtype=float)
            for value in (self.youngs_modulus_1, self.youngs_modulus_2, self.poisson_ratio_12)
        )
        if not np.all(nu**2 * e2 < e1):
            raise InputError(
                "the elastic energy must be positive: poisson_ratio_12**2 must be below E_1/E_2",
                field="poisson_ratio_12",
                value=self.poisson_ratio_12,
                fix="check which axis is 1: ν_12 belongs to a stress along axis 1",
            )
        if self.direction is not None and not np.linalg.norm(self.direction) > 0.0:
            raise InputError("must be a vector that is not zero", field="direction", value=self.direction)

    @classmethod
    def isotropic(
        cls,
        youngs_modulus: float | FloatArray,
        poisson_ratio: float | FloatArray,
        shear_factor: float = 5.0 / 6.0,
    ) -> ShellMaterial:
        """Return the isotropic material, one for all elements or one per element.

        Examples
        --------
        >>> round(ShellMaterial.isotropic(210e9, 0.3).shear_modulus_12 / 1e9, 2)
        80.77
        """
        nu = np.asarray(poisson_ratio, dtype=float)
        if not np.all((nu > -1.0) & (nu < 0.5)):
            raise InputError("must lie between -1 and 0.5", field="poisson_ratio", value=poisson_ratio)
        shear = youngs_modulus / (2.0 * (1.0 + poisson_ratio))
        return cls(
            youngs_modulus, youngs_modulus, poisson_ratio, shear, shear, shear, shear_factor=shear_factor
        )


@dataclass(frozen=True, eq=False)
class ShellSection:
    """Stiffness of the section per unit length, in the element's axes, about the mid-surface."""

    membrane: FloatArray  # A (n_e, 3, 3) [N/m]
    bending: FloatArray  # D (n_e, 3, 3) [N m]
    shear: FloatArray  # S (n_e, 2, 2) [N/m]
    thickness: FloatArray  # t (n_e,) [m]


def section(
    material: ShellMaterial, axes: FloatArray, side: FloatArray, thickness: FloatArray
) -> ShellSection:
    """Return A = t C, D = t³/12 C and S = κ t G in the axes of each element.

    Parameters
    ----------
    material : ShellMaterial
    axes : array (n_e, 3, 3)
        Unit vectors x, y and normal of each element, as rows.
    side : array (n_e, 3)
        Vector along the first side, the direction when the material has none.
    thickness : array (n_e,)
        [m].

    Raises
    ------
    InputError
        If the material's direction is normal to an element, or a modulus is given for another number of
        elements.
    """
    n = len(axes)
    e1, e2, nu, g12, g13, g23, angle = (
        per_element(value, n, name)
        for value, name in (
            (material.youngs_modulus_1, "youngs_modulus_1"),
            (material.youngs_modulus_2, "youngs_modulus_2"),
            (material.poisson_ratio_12, "poisson_ratio_12"),
            (material.shear_modulus_12, "shear_modulus_12"),
            (material.shear_modulus_13, "shear_modulus_13"),
            (material.shear_modulus_23, "shear_modulus_23"),
            (material.angle, "angle"),
        )
    )
    plane = np.zeros((n, 3, 3))
    scale = 1.0 / (1.0 - nu**2 * e2 / e1)
    plane[:, 0, 0], plane[:, 1, 1], plane[:, 2, 2] = scale * e1, scale * e2, g12
    plane[:, 0, 1] = plane[:, 1, 0] = scale * nu * e2

    turn = angle + _direction_angle(material, axes, side)
    c, s = np.cos(turn), np.sin(turn)
    # ε_material = T ε_element, so C_element = Tᵀ C_material T
    to_material = np.stack(
        [
            np.stack([c * c, s * s, c * s], 1),
            np.stack([s * s, c * c, -c * s], 1),
            np.stack([-2.0 * c * s, 2.0 * c * s, c * c - s * s], 1),
        ],
        axis=1,
    )
    plane = to_material.transpose(0, 2, 1) @ plane @ to_material
    rotation = np.stack([np.stack([c, s], 1), np.stack([-s, c], 1)], axis=1)
    transverse = rotation.transpose(0, 2, 1) @ (np.stack([g13, g23], 1)[:, :, None] * rotation)
    t = thickness[:, None, None]
    return ShellSection(t * plane, t**3 / 12.0 * plane, material.shear_factor * t * transverse, thickness)


def _direction_angle(material: ShellMaterial, axes: FloatArray, side: FloatArray) -> FloatArray:
    """Angle from the element's x axis to the projected direction."""
    direction = side if material.direction is None else np.broadcast_to(material.direction, side.shape)
    x, y = (np.einsum("ei,ei->e", axes[:, k], direction) for k in (0, 1))
    lost = np.flatnonzero(np.hypot(x, y) < 1e-6 * np.linalg.norm(direction, axis=1))
    if lost.size:
        raise InputError(
            f"must not be normal to an element, as it is to element {lost[0]}",
            field="direction",
            value=material.direction,
            fix="give another direction, or split the elements into parts with one direction each",
        )
    angle: FloatArray = np.arctan2(y, x)
    return angle
