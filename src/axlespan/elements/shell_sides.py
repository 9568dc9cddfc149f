"""Sides of flat shell elements: Allman's sides in the plane, Timoshenko beams across it.

D.o.f. of a node of the plane: u, v, φ (drilling) for the membrane and w, θ_x, θ_y for bending. Along a side
from node i to node j of length L, with ξ in [-1, 1] and the slope β = dw/ds that the rotations ask for,

    u = linear + (1 - ξ²)/8 (φ_i - φ_j) n × (x_j - x_i)                 (Allman 1984)
    w = linear + L (1 - ξ²)/8 (β_i - β_j) + L (ξ - ξ³)/4 g'
    β = linear + 3 (1 - ξ²)/2 g',    g' = g/(1 + φ_s),    g = (w_j - w_i)/L - (β_i + β_j)/2

The mismatch g splits into bending g' and shear γ = φ_s g' by the flexibility φ_s = 12 D/(S L²). What
neighbors share, and with it constant moments work, takes φ_s `RELAXATION` times.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.elements.shell_geometry import FlatGeometry
from axlespan.elements.shell_material import ShellSection

FloatArray = npt.NDArray[np.float64]

#: factor on φ_s. Cylindrical bending is exact with any; in torsion the sides shear over a depth of the order
#: of the thickness, and only when longer than about 8 t they bend.
RELAXATION = 20.0


def side_flexibility(geometry: FlatGeometry, section: ShellSection) -> FloatArray:
    """Shear flexibility φ_s = 12 D/(S L²) of each side as a beam, (n_e, n_side)."""
    along = geometry.sides / geometry.lengths[..., None]
    x, y = along[..., 0], along[..., 1]
    curvature = np.stack([x * x, y * y, 2.0 * x * y], axis=-1)
    bending = np.einsum("esi,eij,esj->es", curvature, section.bending, curvature)
    shear = np.einsum("esi,eij,esj->es", along, section.shear, along)
    ratio: FloatArray = 12.0 * bending / (shear * geometry.lengths**2)
    return ratio


def slope_axes(geometry: FlatGeometry) -> FloatArray:
    """Unit vectors a (n_e, n_side, 2) with the slope along a side β = a · (θ_x, θ_y)."""
    axes: FloatArray = np.stack([geometry.sides[..., 1], -geometry.sides[..., 0]], axis=-1)
    return axes / geometry.lengths[..., None]


def arch(geometry: FlatGeometry) -> FloatArray:
    """Rows of β_i - β_j (n_e, n_side, 3 n_node) per bending d.o.f."""
    n_e, n = geometry.height.shape
    rows = np.zeros((n_e, n, n, 3))
    near, far, axes = np.arange(n), (np.arange(n) + 1) % n, slope_axes(geometry)
    rows[:, near, near, 1:] = axes
    rows[:, near, far, 1:] = -axes
    return rows.reshape(n_e, n, 3 * n)


def mismatch(geometry: FlatGeometry) -> FloatArray:
    """Rows of g = (w_j - w_i)/L - (β_i + β_j)/2 (n_e, n_side, 3 n_node) per bending d.o.f."""
    n_e, n = geometry.height.shape
    rows = np.zeros((n_e, n, n, 3))
    near, far, axes = np.arange(n), (np.arange(n) + 1) % n, slope_axes(geometry)
    rows[:, near, near, 0], rows[:, near, far, 0] = -1.0 / geometry.lengths, 1.0 / geometry.lengths
    rows[:, near, near, 1:] = rows[:, near, far, 1:] = -0.5 * axes
    return rows.reshape(n_e, n, 3 * n)


def bending_mismatch(geometry: FlatGeometry, section: ShellSection) -> FloatArray:
    """Rows of g' (n_e, n_side, 3 n_node) per bending d.o.f., with the relaxed φ_s."""
    return mismatch(geometry) / (1.0 + RELAXATION * side_flexibility(geometry, section)[..., None])


def mean_drilling(geometry: FlatGeometry) -> FloatArray:
    """Mean rotation ∮ u·ds / 2A of the plane less the mean drilling rotation, (n_e, 3 n_node)."""
    n_e, n = geometry.height.shape
    # each node carries half of the two sides that meet there
    half = 0.5 * (geometry.sides + np.roll(geometry.sides, 1, axis=1))
    rows = np.full((n_e, n, 3), -1.0 / n)
    rows[..., :2] = half / (2.0 * geometry.area)[:, None, None]
    return rows.reshape(n_e, 3 * n)
