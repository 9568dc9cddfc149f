"""Linear elasticity: σ = D ε in Voigt's notation.

Order of the components in space: xx, yy, zz, xy, yz, zx; in the plane: xx, yy, xy. Shear strains are
engineering strains, γ_xy = 2 ε_xy.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]

#: names of the components of stress and strain in space and in the plane.
COMPONENTS = {3: ("xx", "yy", "zz", "xy", "yz", "zx"), 2: ("xx", "yy", "xy")}

#: the pair of axes of each component.
PAIRS = {3: ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)), 2: ((0, 0), (1, 1), (0, 1))}

_INSIDE = np.array([0, 1, 3])  # components in the x-y plane
_OUTSIDE = np.array([2, 4, 5])


def isotropic(youngs_modulus: float, poisson_ratio: float) -> FloatArray:
    """Elasticity matrix (6, 6) [N/m^2] of an isotropic material.

    Parameters
    ----------
    youngs_modulus : float
        E > 0 [N/m^2].
    poisson_ratio : float
        -1 < ν < 0.5.

    Examples
    --------
    >>> isotropic(2.0, 0.0).diagonal()
    array([2., 2., 2., 1., 1., 1.])
    """
    _check_positive(youngs_modulus, "youngs_modulus")
    if not -1.0 < poisson_ratio < 0.5:
        raise InputError(
            "must lie between -1 and 0.5, both excluded",
            field="poisson_ratio",
            value=poisson_ratio,
            fix="Write 0.49 to 0.4999 for a nearly incompressible material",
        )
    shear = youngs_modulus / (2.0 * (1.0 + poisson_ratio))
    lame = 2.0 * shear * poisson_ratio / (1.0 - 2.0 * poisson_ratio)
    matrix = np.diag([2.0 * shear] * 3 + [shear] * 3)
    matrix[:3, :3] += lame
    return matrix


def orthotropic(
    youngs_moduli: tuple[float, float, float],
    poisson_ratios: tuple[float, float, float],
    shear_moduli: tuple[float, float, float],
) -> FloatArray:
    """Elasticity matrix (6, 6) [N/m^2] of an orthotropic material in its own axes.

    Parameters
    ----------
    youngs_moduli : tuple
        E_x, E_y, E_z [N/m^2].
    poisson_ratios : tuple
        ν_xy, ν_yz, ν_xz, where ν_ij = -ε_j/ε_i under a stress along i alone. The others follow from symmetry,
        ν_ji/E_j = ν_ij/E_i.
    shear_moduli : tuple
        G_xy, G_yz, G_zx [N/m^2].

    Raises
    ------
    InputError
        If a modulus is not positive or the ratios leave no positive strain energy.
    """
    for field, moduli in (("youngs_moduli", youngs_moduli), ("shear_moduli", shear_moduli)):
        for modulus in moduli:
            _check_positive(modulus, field)
    nu_xy, nu_yz, nu_xz = poisson_ratios
    e_x, e_y, e_z = youngs_moduli
    compliance = np.array(
        [
            [1.0 / e_x, -nu_xy / e_x, -nu_xz / e_x],
            [-nu_xy / e_x, 1.0 / e_y, -nu_yz / e_y],
            [-nu_xz / e_x, -nu_yz / e_y, 1.0 / e_z],
        ]
    )
    # Scaled by the moduli the diagonal is 1, which makes the eigenvalues comparable.
    scale = np.sqrt(youngs_moduli)
    if np.linalg.eigvalsh(compliance * np.outer(scale, scale))[0] < 1e-12:
        raise InputError(
            "must leave a positive strain energy",
            field="poisson_ratios",
            value=tuple(poisson_ratios),
            fix="Make ν_ij² < E_i/E_j for each pair and 1 - Σ ν_ij ν_ji - 2 ν_xy ν_yz ν_zx > 0",
        )
    matrix = np.zeros((6, 6))
    inverse = np.linalg.inv(compliance)
    matrix[:3, :3] = 0.5 * (inverse + inverse.T)
    matrix[3:, 3:] = np.diag(shear_moduli)
    return matrix


def rotated(elasticity: FloatArray, axes: npt.ArrayLike) -> FloatArray:
    """Elasticity matrix (..., 6, 6) in global axes of a material with axes of its own.

    Parameters
    ----------
    elasticity : array (6, 6)
        In the axes of the material [N/m^2].
    axes : array (3, 3) or (n_element, 3, 3)
        Unit vectors of the material's axes, as rows, in global components.
    """
    rows = np.asarray(axes, float)
    if rows.shape[-2:] != (3, 3) or not np.allclose(rows @ np.swapaxes(rows, -1, -2), np.eye(3), atol=1e-8):
        raise InputError(
            "must be orthonormal rows", field="axes", value=rows.tolist(), fix="Normalize the three axes"
        )
    to_material = strain_rotation(rows)
    return np.asarray(np.swapaxes(to_material, -1, -2) @ elasticity @ to_material)


def strain_rotation(axes: FloatArray) -> FloatArray:
    """Matrices T (..., 6, 6): engineering strains along the rows of ``axes`` (..., 3, 3) are T ε."""
    matrix = np.empty((*axes.shape[:-2], 6, 6))
    for row, (i, j) in enumerate(PAIRS[3]):
        engineering = 1.0 if i == j else 2.0
        for column, (k, m) in enumerate(PAIRS[3]):
            product = axes[..., i, k] * axes[..., j, m]
            if k != m:
                product = 0.5 * (product + axes[..., i, m] * axes[..., j, k])
            matrix[..., row, column] = engineering * product
    return matrix


def plane_strain(elasticity: FloatArray) -> FloatArray:
    """Elasticity matrix (..., 3, 3) [N/m^2] in the x-y plane for ε_zz = γ_yz = γ_zx = 0, from (..., 6, 6)."""
    return np.asarray(elasticity)[..., _INSIDE[:, None], _INSIDE]


def plane_stress(elasticity: FloatArray) -> FloatArray:
    """Elasticity matrix (..., 3, 3) [N/m^2] in the x-y plane for σ_zz = σ_yz = σ_zx = 0, from (..., 6, 6).

    Examples
    --------
    >>> plane_stress(isotropic(1.0, 0.5 - 1e-9))[0, :2].round(6)
    array([1.333333, 0.666667])
    """
    full = np.asarray(elasticity, float)
    kept = full[..., _INSIDE[:, None], _INSIDE]
    coupling = full[..., _OUTSIDE[:, None], _INSIDE]
    condensed = full[..., _OUTSIDE[:, None], _OUTSIDE]
    return np.asarray(kept - np.swapaxes(coupling, -1, -2) @ np.linalg.solve(condensed, coupling))


def check_elasticity(elasticity: npt.ArrayLike, size: int) -> FloatArray:
    """Return the matrix, or one per element, if symmetric and positive definite; raise InputError else.

    Parameters
    ----------
    elasticity : array (size, size) or (n_element, size, size)
        Elasticity [N/m^2].
    size : int
        6 in space, 3 in the plane.
    """
    matrix = np.asarray(elasticity, float)
    if matrix.shape[-2:] != (size, size) or matrix.ndim not in (2, 3):
        raise InputError(
            f"must be an array ({size}, {size}) or (n_element, {size}, {size})",
            field="elasticity",
            value=matrix.shape,
            fix="Build it with axlespan.elements.elasticity",
        )
    # One material is the usual case also where there is one matrix per element.
    distinct = matrix.reshape(-1, size, size)
    if (distinct == distinct[:1]).all():
        distinct = distinct[:1]
    if not np.isfinite(distinct).all():
        raise InputError("must be finite", field="elasticity", fix="Check the moduli")
    largest = np.abs(distinct).max(axis=(1, 2))
    asymmetry = np.abs(distinct - np.swapaxes(distinct, 1, 2)).max(axis=(1, 2))
    scale = 1.0 / np.sqrt(np.maximum(np.abs(np.diagonal(distinct, axis1=1, axis2=2)), 1e-300))
    lowest = np.linalg.eigvalsh(distinct * scale[:, :, None] * scale[:, None, :])[:, 0]
    for wrong, rule in ((asymmetry > 1e-9 * largest, "symmetric"), (lowest <= 1e-12, "positive definite")):
        if wrong.any():
            raise InputError(
                f"must be {rule}",
                field="elasticity",
                value=distinct[wrong][0].tolist(),
                fix="Check the moduli and Poisson's ratios",
            )
    return matrix


def _check_positive(value: float, field: str) -> None:
    if not (np.isfinite(value) and value > 0.0):
        raise InputError("must be positive", field=field, value=value, fix="Give it in N/m²")
