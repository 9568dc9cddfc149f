"""Stiffness from assumed stress resultants in equilibrium and the displacements of the sides.

With resultants P β that satisfy equilibrium inside an element, the complementary energy (Pian 1964) gives

    H β = G d,   H = ∫ Pᵀ F P dA,   G = ∮ (resultants on the side)ᵀ (displacements of the side) ds,   K = Gᵀ H⁻¹ G

with the section's flexibility F and the sides of `shell_sides`. No strain is asked to vanish, so however
thin the plate, nothing locks. Both families of resultants are complete, hence invariant to the axes.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.elements import shell_sides
from axlespan.elements.shell_geometry import FlatGeometry
from axlespan.elements.shell_material import ShellSection
from axlespan.elements.shell_shapes import integration_rule, shapes

FloatArray = npt.NDArray[np.float64]

#: number of bending modes to the degree 1 and 2.
LINEAR, QUADRATIC = 9, 17

_GAUSS, _WEIGHT = np.polynomial.legendre.leggauss(3)


def membrane_modes(geometry: FlatGeometry, points: FloatArray) -> FloatArray:
    """N_x, N_y, N_xy (n_e, n_point, 3, 7), complete and linear with N_ij,j = 0.

    Points (n_e, n_point, 2) are in the axes of the plane.
    """
    x, y, one, o = _monomials(geometry, points)
    modes = [(one, o, o), (o, one, o), (o, o, one), (y, o, o), (o, x, o), (x, o, -y), (o, y, -x)]
    return np.stack([np.stack(mode, axis=-1) for mode in modes], axis=-1)


def bending_modes(geometry: FlatGeometry, points: FloatArray) -> FloatArray:
    """M_x, M_y, M_xy, Q_x, Q_y (n_e, n_point, 5, 17), complete with Q_i = M_ij,j and Q_i,i = 0.

    The first nine are linear moments, the others quadratic.
    """
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


def membrane_parameters(
    geometry: FlatGeometry, section: ShellSection, count: int = 7
) -> tuple[FloatArray, FloatArray]:
    """Parameters β (n_e, count, 3 n_node) of the first modes and stiffness, per u, v, φ of each node."""
    at, weight = _area_points(geometry)
    table = membrane_modes(geometry, at)[..., :count]
    work = _membrane_work(geometry)[:, :count]
    flexibility = np.asarray(np.linalg.inv(section.membrane), dtype=np.float64)
    return _solved(table, weight, flexibility, work)


def bending_parameters(
    geometry: FlatGeometry, section: ShellSection, count: int
) -> tuple[FloatArray, FloatArray]:
    """Parameters β (n_e, count, 3 n_node) of the first modes and stiffness, per w, θ_x, θ_y of each node."""
    at, weight = _area_points(geometry)
    flexibility = np.zeros((len(at), 5, 5))
    flexibility[:, :3, :3] = np.linalg.inv(section.bending)
    flexibility[:, 3:, 3:] = np.linalg.inv(section.shear)
    table = bending_modes(geometry, at)[..., :count]
    return _solved(table, weight, flexibility, _bending_work(geometry, section, count))


def _solved(
    table: FloatArray, weight: FloatArray, flexibility: FloatArray, work: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """β = H⁻¹ G and K = Gᵀ β."""
    n_e, *_, n_beta = table.shape
    weighted = weight[:, :, None, None] * (flexibility[:, None] @ table)
    h = table.reshape(n_e, -1, n_beta).transpose(0, 2, 1) @ weighted.reshape(n_e, -1, n_beta)
    # balanced, for slender elements give modes of very different size
    scale = 1.0 / np.sqrt(np.einsum("eii->ei", h))[:, :, None]
    beta = scale * np.linalg.solve(scale * h * scale.transpose(0, 2, 1), scale * work)
    stiffness = work.transpose(0, 2, 1) @ beta
    return beta, 0.5 * (stiffness + stiffness.transpose(0, 2, 1))


def _area_points(geometry: FlatGeometry) -> tuple[FloatArray, FloatArray]:
    """Integration points (n_e, n_point, 2) in the plane and weights (n_e, n_point)."""
    natural, weight = integration_rule(geometry)
    return shapes(geometry.node_count, natural) @ geometry.plane, weight


def _monomials(
    geometry: FlatGeometry, points: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    scaled = points / np.sqrt(geometry.area)[:, None, None]
    x, y = scaled[..., 0], scaled[..., 1]
    return x, y, np.ones_like(x), np.zeros_like(x)


def _membrane_work(geometry: FlatGeometry) -> FloatArray:
    """G (n_e, 7, 3 n_node)."""
    (n_e, n), sides = geometry.height.shape, geometry.sides
    left = np.stack([-sides[..., 1], sides[..., 0]], axis=-1)
    near, far = np.arange(n), (np.arange(n) + 1) % n
    work = np.zeros((n_e, 7, n, 3))
    for xi, weight in zip(_GAUSS, _WEIGHT, strict=True):
        force = membrane_modes(geometry, geometry.plane + 0.5 * (1.0 + xi) * sides)
        # force on the side: N times the outward normal times L, which is -left; weights dξ/2
        nx, ny = -0.5 * weight * left[..., :1], -0.5 * weight * left[..., 1:]
        push = np.stack(
            [
                force[:, :, 0] * nx + force[:, :, 2] * ny,
                force[:, :, 2] * nx + force[:, :, 1] * ny,
            ],
            axis=-1,
        ).transpose(0, 2, 1, 3)
        bulge = 0.125 * (1.0 - xi * xi) * np.einsum("ebsi,esi->ebs", push, left)
        work[:, :, near, :2] += 0.5 * (1.0 - xi) * push
        work[:, :, far, :2] += 0.5 * (1.0 + xi) * push
        work[:, :, near, 2] += bulge
        work[:, :, far, 2] -= bulge
    return work.reshape(n_e, 7, 3 * n)


def _bending_work(geometry: FlatGeometry, section: ShellSection, count: int) -> FloatArray:
    """G (n_e, count, 3 n_node)."""
    n_e, n = geometry.height.shape
    length = geometry.lengths[..., None]
    bend = shell_sides.bending_mismatch(geometry, section)
    arch = length * shell_sides.arch(geometry)
    axes = shell_sides.slope_axes(geometry)
    near, far = np.arange(n), (np.arange(n) + 1) % n
    work = np.zeros((n_e, count, 3 * n))
    for xi, weight in zip(_GAUSS, _WEIGHT, strict=True):
        m = bending_modes(geometry, geometry.plane + 0.5 * (1.0 + xi) * geometry.sides)[..., :count]
        moved = np.zeros((n_e, n, 3, 3 * n))  # θ_x, θ_y and w of the side
        moved[:, :, :2] = 1.5 * (1.0 - xi**2) * axes[..., None] * bend[:, :, None]
        moved[:, :, 2] = 0.125 * (1.0 - xi**2) * arch + 0.25 * (xi - xi**3) * length * bend
        for row, dof in enumerate((1, 2, 0)):
            moved[:, near, row, 3 * near + dof] += 0.5 * (1.0 - xi)
            moved[:, near, row, 3 * far + dof] += 0.5 * (1.0 + xi)
        # the outward normal is the axis of the slope, (dy, -dx)/L
        nx, ny = (0.5 * weight * length * axes)[..., None, :].transpose(3, 0, 1, 2)
        force = np.stack(
            [
                -(m[:, :, 2] * nx + m[:, :, 1] * ny),
                m[:, :, 0] * nx + m[:, :, 2] * ny,
                m[:, :, 3] * nx + m[:, :, 4] * ny,
            ],
            axis=2,
        )
        work += force.reshape(n_e, 3 * n, count).transpose(0, 2, 1) @ moved.reshape(n_e, 3 * n, 3 * n)
    return work
