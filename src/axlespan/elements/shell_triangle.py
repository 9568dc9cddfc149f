"""Three-node flat shell: Felippa's optimal membrane triangle, and for bending a mean of two plates.

Membrane: the assumed natural deviatoric strain element OPT of C. A. Felippa, A study of optimal membrane
triangles with drilling freedoms, Comput. Methods Appl. Mech. Engrg. 192 (2003) 2125-2168, which bends
exactly in its plane in rectangles of any aspect ratio.

Bending: DKMT of I. Katili, A new discrete Kirchhoff-Mindlin element, Int. J. Numer. Meth. Engng 36 (1993)
1859-1883, from assumed rotations, is too flexible, much so where it is distorted; the hybrid stress element
of linear moments (HSM in Batoz, Bathe, Ho 1980), here with transverse shear, is too stiff. Both pass the
patch test; their weighted mean errs several times less than either.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.elements import shell_hybrid, shell_sides
from axlespan.elements.shell_geometry import FlatGeometry
from axlespan.elements.shell_material import ShellSection
from axlespan.elements.shell_shapes import shape_slopes, shapes

FloatArray = npt.NDArray[np.float64]

#: α_b, share of the drilling rotations in the mean strain.
BASIC = 1.5
#: least β_0, for Poisson's ratios near 1/2.
LEAST_HIGHER_ORDER = 0.01
#: fading of the drilling rotations' part in the mean strain and of β_0, on curved surfaces.
BASIC_FADING, HIGHER_ORDER_FADING = 4.0, 64.0
#: share of the discrete Kirchhoff-Mindlin plate in the bending stiffness, the rest is the hybrid one's.
DISCRETE_SHARE = 0.87
# [corner, side, node]: natural strains that a hierarchical rotation gives, Felippa's β_1 ... β_9 permuted
_CORNER_STRAINS = np.array(
    [
        [[1.0, 2.0, 1.0], [0.0, 1.0, -1.0], [-1.0, -1.0, -2.0]],
        [[-2.0, -1.0, -1.0], [1.0, 1.0, 2.0], [-1.0, 0.0, 1.0]],
        [[1.0, -1.0, 0.0], [-1.0, -2.0, -1.0], [2.0, 1.0, 1.0]],
    ]
)
#: middles of the sides: with equal weights a rule of degree 2.
_MIDDLES = np.array([[0.5, 0.0], [0.5, 0.5], [0.0, 0.5]])


def membrane_stiffness(geometry: FlatGeometry, section: ShellSection, turning: FloatArray) -> FloatArray:
    """Stiffness (n_e, 9, 9) per d.o.f. (u, v, φ of each node)."""
    strain = membrane_strain(geometry, section, turning, _MIDDLES)
    return _energy(strain, section.membrane, geometry.area)


def bending_stiffness(geometry: FlatGeometry, section: ShellSection) -> FloatArray:
    """Stiffness (n_e, 9, 9) per d.o.f. (w, θ_x, θ_y of each node)."""
    discrete = _energy(curvature(geometry, section, _MIDDLES), section.bending, geometry.area)
    discrete += _energy(shear_strain(geometry, section, _MIDDLES), section.shear, geometry.area)
    _, hybrid = shell_hybrid.bending_parameters(geometry, section, shell_hybrid.LINEAR)
    return DISCRETE_SHARE * discrete + (1.0 - DISCRETE_SHARE) * hybrid


def membrane_strain(
    geometry: FlatGeometry, section: ShellSection, turning: FloatArray, natural: FloatArray
) -> FloatArray:
    """ε_x, ε_y, γ_xy (n_e, n_point, 3, 9) at natural points: mean and higher-order part.

    Facets of a curved surface see drilling rotations that don't strain the surface. Where it turns by the
    angle δ from the element's plane to its sides, λ = δ √(2A)/t, the mean strain's share α_b fades by
    1/(1 + 4 λ²) and β_0 by 1/(1 + 64 λ²), towards the constant strain triangle.
    """
    n_e, area = len(geometry.area), geometry.area[:, None, None]
    next_side, last_side = geometry.sides, np.roll(geometry.sides, 1, axis=1)
    away = np.roll(geometry.sides, -1, axis=1)  # the side opposite to each node
    bent = 2.0 * geometry.area * (turning / section.thickness) ** 2
    basic = (BASIC / (1.0 + BASIC_FADING * bent))[:, None]
    mean = np.zeros((n_e, 3, 3, 3))
    mean[:, 0, :, 0] = mean[:, 2, :, 1] = -away[..., 1]
    mean[:, 1, :, 1] = mean[:, 2, :, 0] = away[..., 0]
    mean[:, 0, :, 2] = basic / 6.0 * away[..., 1] * (next_side[..., 1] - last_side[..., 1])
    mean[:, 1, :, 2] = basic / 6.0 * away[..., 0] * (next_side[..., 0] - last_side[..., 0])
    mean[:, 2, :, 2] = basic / 3.0 * (next_side.prod(axis=-1) - last_side.prod(axis=-1))

    # rotations above that of the constant strain triangle
    above = np.zeros((n_e, 3, 3, 3))
    above[..., :2] = (away / (4.0 * area))[:, None]
    above[:, np.arange(3), np.arange(3), 2] = 1.0
    a, b = np.roll(geometry.sides, -1, axis=1), np.roll(geometry.sides, -2, axis=1)
    cartesian = np.stack(
        [-a[..., 1] * b[..., 1], -a[..., 0] * b[..., 0], a[..., 0] * b[..., 1] + a[..., 1] * b[..., 0]],
        axis=1,
    )
    natural_strain = np.einsum("pc,csn->psn", shapes(3, natural), _CORNER_STRAINS)
    factor = higher_order_factor(section) / (1.0 + HIGHER_ORDER_FADING * bent)
    scale = 1.5 * np.sqrt(factor)[:, None, None] / (6.0 * area)
    higher = (scale * cartesian)[:, None] @ natural_strain @ above.reshape(n_e, 1, 3, 9)
    return mean.reshape(n_e, 1, 3, 9) / (2.0 * area[..., None]) + higher


def higher_order_factor(section: ShellSection) -> FloatArray:
    """β_0 = 2/(Ē C̄) - 3/2 (n_e,), of the moduli and compliances averaged over all directions in the plane.

    Isotropic: (1 - 4 ν²)/2, for which bending in the plane is exact (Felippa 2003, section 5).
    """
    product = np.ones(len(section.thickness))
    for matrix, shear in ((section.membrane, 4.0), (np.linalg.inv(section.membrane), 1.0)):
        along = 3.0 * (matrix[:, 0, 0] + matrix[:, 1, 1]) + 2.0 * matrix[:, 0, 1] + shear * matrix[:, 2, 2]
        product = product * along / 8.0
    factor: FloatArray = np.maximum(2.0 / product - 1.5, LEAST_HIGHER_ORDER)
    return factor


def curvature(geometry: FlatGeometry, section: ShellSection, natural: FloatArray) -> FloatArray:
    """κ_x = θ_y,x, κ_y = -θ_x,y, κ_xy = θ_y,y - θ_x,x (n_e, n_point, 3, 9) at natural points."""
    value, slope = shapes(3, natural), shape_slopes(3, natural)
    jacobian = np.einsum("apn,eni->epai", slope, geometry.plane)
    bubble_slope = 4.0 * (slope * np.roll(value, -1, axis=1) + value * np.roll(slope, -1, axis=2))
    inverse = np.linalg.inv(jacobian)
    nodes = np.einsum("epia,apn->epin", inverse, slope)
    sides = np.einsum("epia,aps->epis", inverse, bubble_slope)
    n_e, n_point = jacobian.shape[:2]
    rows = np.zeros((n_e, n_point, 3, 3, 3))
    rows[..., 0, :, 2], rows[..., 1, :, 1] = nodes[..., 0, :], -nodes[..., 1, :]
    rows[..., 2, :, 2], rows[..., 2, :, 1] = nodes[..., 1, :], -nodes[..., 0, :]
    bend = shell_sides.mismatch(geometry)
    bend /= 1.0 + shell_sides.side_flexibility(geometry, section)[..., None]
    turn = 1.5 * shell_sides.slope_axes(geometry)[:, None]  # (n_e, 1, side, xy)
    x, y = sides[..., 0, :], sides[..., 1, :]
    arched = np.stack(
        [x * turn[..., 1], -y * turn[..., 0], y * turn[..., 1] - x * turn[..., 0]], axis=2
    )  # (n_e, n_point, 3, side)
    return rows.reshape(n_e, n_point, 3, 9) + arched @ bend[:, None]


def shear_strain(geometry: FlatGeometry, section: ShellSection, natural: FloatArray) -> FloatArray:
    """γ_xz, γ_yz (n_e, n_point, 2, 9): at each node from the sides that meet there, linear between."""
    ratio = shell_sides.side_flexibility(geometry, section)[..., None]
    along = ratio / (1.0 + ratio) * shell_sides.mismatch(geometry)  # γ along each side
    unit = geometry.sides / geometry.lengths[..., None]
    pair = np.stack([np.roll(unit, 1, axis=1), unit], axis=2)  # (n_e, node, side, xy)
    corner = np.linalg.solve(pair, np.stack([np.roll(along, 1, axis=1), along], axis=2))
    return np.einsum("pn,enid->epid", shapes(3, natural), corner)


def _energy(strain: FloatArray, stiffness: FloatArray, area: FloatArray) -> FloatArray:
    """∫ Bᵀ C B dA with strains (n_e, 3, n_row, n_d) at the middles of the sides."""
    weighted = (stiffness * (area / 3.0)[:, None, None])[:, None] @ strain
    n_e, *_, n_d = strain.shape
    energy: FloatArray = strain.reshape(n_e, -1, n_d).transpose(0, 2, 1) @ weighted.reshape(n_e, -1, n_d)
    return energy
