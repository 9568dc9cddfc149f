"""Four-node flat shell: assumed stress resultants in equilibrium, displacements along the sides only.

Complementary energy with resultants P β that satisfy equilibrium inside (Pian 1964) gives

    H β = G d,   H = ∫ Pᵀ F P dA,   G = ∮ (resultants on the side)ᵀ (displacements of the side) ds,   K = Gᵀ H⁻¹ G

with the section's flexibility F and the sides of `shell_sides`. Membrane forces: complete and linear, 7
parameters (Cen et al. 2011, HSF-Q4θ-7β); moments: complete and quadratic with the shear forces that balance
them, 17. Both are invariant to the choice of axes, and no strain is asked to vanish, so nothing locks.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from axlespan.elements import shell_sides
from axlespan.elements.shell_geometry import FlatGeometry
from axlespan.elements.shell_material import ShellSection

FloatArray = npt.NDArray[np.float64]

#: weight of the mean drilling rotation against the mean rotation of the plane, times G t A (Hughes and
#: Brezzi 1989); from 0.01 to 1 results hardly move.
DRILLING_STIFFNESS = 0.1
#: weight of alternating drilling rotations (+ - + -); small, for curved shells have them without strain.
ALTERNATING_STIFFNESS = 1e-3

#: factor on the sides' shear flexibility 12 D/(S L²). Bending along a side is exact with any; in torsion
#: sides shear over a depth of the order of the thickness, and from 8 t of length on they bend instead.
SIDE_RELAXATION = 20.0
#: fading of the forces that tie drilling rotations to bending in the plane on curved surfaces.
FADING = 4.0

_GAUSS, _WEIGHT = np.polynomial.legendre.leggauss(3)


def natural_rule() -> tuple[FloatArray, FloatArray]:
    """Points (9, 2) and weights (9,) of the Gauss rule on the square [-1, 1]²."""
    r, s = np.meshgrid(_GAUSS, _GAUSS, indexing="ij")
    return np.stack([r.ravel(), s.ravel()], axis=1), np.outer(_WEIGHT, _WEIGHT).ravel()


def bilinear(natural: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Shape functions (..., 4) and derivatives (2, ..., 4) at natural points (..., 2)."""
    r, s = natural[..., :1], natural[..., 1:]
    rn, sn = np.array([-1.0, 1.0, 1.0, -1.0]), np.array([-1.0, -1.0, 1.0, 1.0])
    value = 0.25 * (1.0 + r * rn) * (1.0 + s * sn)
    return value, np.stack([0.25 * rn * (1.0 + s * sn), 0.25 * sn * (1.0 + r * rn)])


def bubbles(natural: FloatArray) -> FloatArray:
    """Quadratic functions (..., 4) that are 1 - ξ² on their side and vanish on the others."""
    r, s = natural[..., 0], natural[..., 1]
    across, along = 0.5 * (1.0 - r * r), 0.5 * (1.0 - s * s)
    return np.stack([across * (1.0 - s), along * (1.0 + r), across * (1.0 + s), along * (1.0 - r)], axis=-1)


def membrane_parameters(
    geometry: FlatGeometry, section: ShellSection, turning: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Force parameters β (n_e, 7, 12) and stiffness (n_e, 12, 12), with the drilling penalties.

    Facets of a curved surface see drilling rotations that don't strain the surface. Where it turns by the
    angle δ from the element's plane to its sides, the two modes that ask φ to follow bending in the plane
    fade by 1/(1 + 4 (δ √A/t)²), which leaves the five of Pian and Sumihara (1984).
    """
    flexibility = np.linalg.inv(section.membrane)
    work = _membrane_work(geometry)
    beta, stiffness = _hybrid(geometry, membrane_modes, flexibility, work)
    if np.any(turning):
        beta_5, stiffness_5 = _hybrid(
            geometry, lambda *at: membrane_modes(*at)[..., :5], flexibility, work[:, :5]
        )
        share = 1.0 / (1.0 + FADING * (turning / section.thickness) ** 2 * geometry.area)[:, None, None]
        stiffness = share * stiffness + (1.0 - share) * stiffness_5
        beta = share * beta
        beta[:, :5] += (1.0 - share) * beta_5
    shear_area = section.membrane[:, 2, 2] * geometry.area
    alternating = np.tile([0.0, 0.0, 0.25, 0.0, 0.0, -0.25], 2)[None]
    penalties = (
        (DRILLING_STIFFNESS, shell_sides.mean_drilling(geometry)),
        (ALTERNATING_STIFFNESS, alternating),
    )
    for weight, row in penalties:
        stiffness += (weight * shear_area)[:, None, None] * row[:, :, None] * row[:, None, :]
    return beta, stiffness


def bending_parameters(geometry: FlatGeometry, section: ShellSection) -> tuple[FloatArray, FloatArray]:
    """Moment parameters β (n_e, 17, 12) and stiffness (n_e, 12, 12)."""
    flexibility = np.zeros((len(geometry.area), 5, 5))
    flexibility[:, :3, :3] = np.linalg.inv(section.bending)
    flexibility[:, 3:, 3:] = np.linalg.inv(section.shear)
    return _hybrid(geometry, bending_modes, flexibility, _bending_work(geometry, section))


def membrane_modes(geometry: FlatGeometry, points: FloatArray) -> FloatArray:
    """N_x, N_y, N_xy (n_e, n_point, 3, 7) at points (n_e, n_point, 2) of the plane, with N_ij,j = 0."""
    x, y, one, o = _monomials(geometry, points)
    modes = [(one, o, o), (o, one, o), (o, o, one), (y, o, o), (o, x, o), (x, o, -y), (o, y, -x)]
    return np.stack([np.stack(mode, axis=-1) for mode in modes], axis=-1)


def bending_modes(geometry: FlatGeometry, points: FloatArray) -> FloatArray:
    """M_x, M_y, M_xy, Q_x, Q_y (n_e, n_point, 5, 17), with Q_i = M_ij,j and Q_i,i = 0."""
    x, y, one, o = _monomials(geometry, points)
    modes = [
        *((one, o, o, o, o), (o, one, o, o, o), (o, o, one, o, o)),
        *((x, o, o, one, o), (y, o, o, o, o), (o, x, o, o, o), (o, y, o, o, one)),
        *((o, o, x, o, one), (o, o, y, one, o)),
        *((x * y, o, o, y, o), (o, x * y, o, o, x), (y * y, o, o, o, o), (o, x * x, o, o, o)),
        *((o, o, x * x, o, 2.0 * x), (o, o, y * y, 2.0 * y, o)),
        *((x * x, o, -x * y, x, -y), (o, y * y, -x * y, -x, y)),
    ]
    table = np.stack([np.stack(mode, axis=-1) for mode in modes], axis=-1)
    table[..., 3:, :] /= np.sqrt(geometry.area)[:, None, None, None]
    return table


def _hybrid(
    geometry: FlatGeometry,
    modes: Callable[[FlatGeometry, FloatArray], FloatArray],
    flexibility: FloatArray,
    work: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """β = H⁻¹ G and K = Gᵀ β."""
    natural, weight = natural_rule()
    value, slope = bilinear(natural)
    jacobian = np.einsum("apn,eni->epai", slope, geometry.plane)
    table = modes(geometry, value @ geometry.plane)
    weighted = (weight * np.linalg.det(jacobian))[:, :, None, None] * (flexibility[:, None] @ table)
    n_e, *_, n_beta = table.shape
    h = table.reshape(n_e, -1, n_beta).transpose(0, 2, 1) @ weighted.reshape(n_e, -1, n_beta)
    # balanced, for slender elements give modes of very different size
    scale = 1.0 / np.sqrt(np.einsum("eii->ei", h))[:, :, None]
    beta = scale * np.linalg.solve(scale * h * scale.transpose(0, 2, 1), scale * work)
    stiffness = work.transpose(0, 2, 1) @ beta
    return beta, 0.5 * (stiffness + stiffness.transpose(0, 2, 1))


def _monomials(
    geometry: FlatGeometry, points: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    scaled = points / np.sqrt(geometry.area)[:, None, None]
    x, y = scaled[..., 0], scaled[..., 1]
    return x, y, np.ones_like(x), np.zeros_like(x)


def _membrane_work(geometry: FlatGeometry) -> FloatArray:
    """G (n_e, 7, 12)."""
    sides = geometry.sides
    left = np.stack([-sides[..., 1], sides[..., 0]], axis=-1)
    near, far = np.arange(4), (np.arange(4) + 1) % 4
    work = np.zeros((len(sides), 7, 4, 3))
    for xi, weight in zip(_GAUSS, _WEIGHT, strict=True):
        n = membrane_modes(geometry, geometry.plane + 0.5 * (1.0 + xi) * sides)
        # force on the side: N times the outward normal times L, which is -left; weights dξ/2
        nx, ny = -0.5 * weight * left[..., :1], -0.5 * weight * left[..., 1:]
        force = np.stack([n[:, :, 0] * nx + n[:, :, 2] * ny, n[:, :, 2] * nx + n[:, :, 1] * ny], axis=-1)
        arched = 0.125 * (1.0 - xi * xi) * np.einsum("esbi,esi->ebs", force, left)
        force = force.transpose(0, 2, 1, 3)
        work[:, :, near, :2] += 0.5 * (1.0 - xi) * force
        work[:, :, far, :2] += 0.5 * (1.0 + xi) * force
        work[:, :, near, 2] += arched
        work[:, :, far, 2] -= arched
    return work.reshape(len(sides), 7, 12)


def _bending_work(geometry: FlatGeometry, section: ShellSection) -> FloatArray:
    """G (n_e, 17, 12)."""
    length = geometry.lengths[..., None]
    bend = shell_sides.mismatch(geometry)
    bend /= 1.0 + SIDE_RELAXATION * shell_sides.side_flexibility(geometry, section)[..., None]
    arch = length * shell_sides.arch(geometry)
    axes = shell_sides.slope_axes(geometry)
    normal = axes[..., None, :]  # outward, as it happens: (dy, -dx)/L
    near, far = np.arange(4), (np.arange(4) + 1) % 4
    work = np.zeros((len(length), 17, 12))
    for xi, weight in zip(_GAUSS, _WEIGHT, strict=True):
        m = bending_modes(geometry, geometry.plane + 0.5 * (1.0 + xi) * geometry.sides)
        w = 0.125 * (1.0 - xi**2) * arch + 0.25 * (xi - xi**3) * length * bend
        w[:, near, 3 * near] += 0.5 * (1.0 - xi)
        w[:, near, 3 * far] += 0.5 * (1.0 + xi)
        theta = 1.5 * (1.0 - xi**2) * axes[..., None] * bend[:, :, None]
        for k in (0, 1):
            theta[:, near, k, 3 * near + 1 + k] += 0.5 * (1.0 - xi)
            theta[:, near, k, 3 * far + 1 + k] += 0.5 * (1.0 + xi)
        nx, ny = 0.5 * weight * length * normal[..., 0], 0.5 * weight * length * normal[..., 1]
        moved = np.concatenate([theta, w[:, :, None]], axis=2)
        # couple about x: -(M_xy n_x + M_y n_y), about y: M_x n_x + M_xy n_y
        force = np.stack(
            [
                -(m[:, :, 2] * nx + m[:, :, 1] * ny),
                m[:, :, 0] * nx + m[:, :, 2] * ny,
                m[:, :, 3] * nx + m[:, :, 4] * ny,
            ],
            axis=2,
        )
        work += np.einsum("eskb,eskd->ebd", force, moved, optimize=True)
    return work
