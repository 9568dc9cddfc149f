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
BoolArray = npt.NDArray[np.bool_]

#: α_b, share of the drilling rotations in the mean strain.
BASIC = 1.5
#: least β_0, for Poisson's ratios near 1/2.
LEAST_HIGHER_ORDER = 0.01
#: fading of the drilling rotations' part in the mean strain and of β_0, on curved surfaces.
BASIC_FADING, HIGHER_ORDER_FADING = 4.0, 64.0
#: share of the discrete Kirchhoff-Mindlin plate in the bending stiffness, the rest is the hybrid one's.
DISCRETE_SHARE = 0.8
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


def membrane_stiffness(
    geometry: FlatGeometry, section: ShellSection, turning: FloatArray, mixed: BoolArray
) -> FloatArray:
    """Stiffness (n_e, 9, 9) per d.o.f. (u, v, φ of each node)."""
    strain = membrane_strain(geometry, section, turning, mixed, _MIDDLES)
    return _energy(strain, section.membrane, geometry.area)


def bending_stiffness(geometry: FlatGeometry, section: ShellSection) -> FloatArray:
    """Stiffness (n_e, 9, 9) per d.o.f. (w, θ_x, θ_y of each node)."""
    discrete = _energy(curvature(geometry, section, _MIDDLES), section.bending, geometry.area)
    discrete += _energy(shear_strain(geometry, section, _MIDDLES), section.shear, geometry.area)
    _, hybrid = shell_hybrid.bending_parameters(geometry, section, shell_hybrid.LINEAR)
    return DISCRETE_SHARE * discrete + (1.0 - DISCRETE_SHARE) * hybrid


def membrane_strain(
    geometry: FlatGeometry,
    section: ShellSection,
    turning: FloatArray,
    mixed: BoolArray,
    natural: FloatArray,
) -> FloatArray:
    """ε_x, ε_y, γ_xy (n_e, n_point, 3, 9) at natural points: mean and higher-order part.

    Facets of a curved surface see drilling rotations that don't strain the surface. Where it turns by the
    angle δ from the element's plane to its sides, λ = δ √(2A)/t, the mean strain's share α_b fades by
    1/(1 + 4 λ²) and β_0 by 1/(1 + 64 λ²), towards the constant strain triangle.

    On sides that are mixed (n_e, 3), shared with quadrilaterals, α_b is 1 as it is there.
    """
    n_e, area = len(geometry.area), geometry.area[:, None, None]
    away = np.roll(geometry.sides, -1, axis=1)  # the side opposite to each node
    bent = 2.0 * geometry.area * (turning / section.thickness) ** 2
    # mean strain of a side's arch (φ_i - φ_j)/8 in the plane, which the drilling rotations of its ends share
    dx, dy = geometry.sides[..., 0], geometry.sides[..., 1]
    share = np.where(mixed, 1.0, BASIC) / (1.0 + BASIC_FADING * bent)[:, None]
    bulge = share * np.stack([-(dy**2), -(dx**2), 2.0 * dx * dy]) / 6.0
    mean = np.zeros((n_e, 3, 3, 3))
    mean[:, 0, :, 0] = mean[:, 2, :, 1] = -away[..., 1]
    mean[:, 1, :, 1] = mean[:, 2, :, 0] = away[..., 0]
    mean[..., 2] = (bulge - np.roll(bulge, 1, axis=2)).transpose(1, 0, 2)

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
    strain: FloatArray = mean.reshape(n_e, 1, 3, 9) / (2.0 * area[..., None]) + higher
    return strain


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
    """κ_x = θ_y,x, κ_y = -θ_x,y, κ_xy = θ_y,y - θ_x,x (n_e, n_point, 3, 9) at natural points.

    The means are those of sides with a relaxed flexibility, as in the hybrid elements.
    """
    n_e = len(geometry.area)
    value, slope = shapes(3, natural), shape_slopes(3, natural)
    inverse = np.linalg.inv(np.einsum("an,eni->eai", slope[:, 0], geometry.plane))
    x, y = (inverse @ slope[:, 0]).transpose(1, 0, 2)  # slopes of the nodes' functions
    nodal = np.zeros((n_e, 3, 3, 3))
    nodal[:, 0, :, 2], nodal[:, 1, :, 1] = x, -y
    nodal[:, 2, :, 2], nodal[:, 2, :, 1] = y, -x

    # the sides' arches of slope, 3/2 (1 - ξ²) g' about the axes a
    bubble = 4.0 * (slope * np.roll(value, -1, axis=1) + value * np.roll(slope, -1, axis=2))
    x, y = np.einsum("eia,aps->ieps", inverse, bubble)
    a_x, a_y = 1.5 * shell_sides.slope_axes(geometry)[:, None].transpose(3, 0, 1, 2)
    arched = np.stack([x * a_y, -y * a_x, y * a_y - x * a_x], axis=2)
    dx, dy = geometry.sides[..., 0], geometry.sides[..., 1]
    mean = np.stack([-dx * dy, dx * dy, dx**2 - dy**2], axis=1)[:, None]
    mean = mean / (geometry.lengths * geometry.area[:, None])[:, None, None]
    bend = shell_sides.mismatch(geometry) / (1.0 + shell_sides.side_flexibility(geometry, section)[..., None])
    shared = shell_sides.bending_mismatch(geometry, section)
    rows: FloatArray = nodal.reshape(n_e, 1, 3, 9) + (arched - mean) @ bend[:, None] + mean @ shared[:, None]
    return rows


def shear_strain(geometry: FlatGeometry, section: ShellSection, natural: FloatArray) -> FloatArray:
    """γ_xz, γ_yz (n_e, n_point, 2, 9): at each node from the sides that meet there, linear between."""
    ratio = shell_sides.side_flexibility(geometry, section)[..., None]
    along = ratio / (1.0 + ratio) * shell_sides.mismatch(geometry)  # γ along each side
    unit = geometry.sides / geometry.lengths[..., None]
    pair = np.stack([np.roll(unit, 1, axis=1), unit], axis=2)  # (n_e, node, side, xy)
    corner = np.linalg.solve(pair, np.stack([np.roll(along, 1, axis=1), along], axis=2))
    strain: FloatArray = np.einsum("pn,enid->epid", shapes(3, natural), corner)
    return strain


def _energy(strain: FloatArray, stiffness: FloatArray, area: FloatArray) -> FloatArray:
    """∫ Bᵀ C B dA with strains (n_e, 3, n_row, n_d) at the middles of the sides."""
    weighted = (stiffness * (area / 3.0)[:, None, None])[:, None] @ strain
    n_e, *_, n_d = strain.shape
    energy: FloatArray = strain.reshape(n_e, -1, n_d).transpose(0, 2, 1) @ weighted.reshape(n_e, -1, n_d)
    return energy
