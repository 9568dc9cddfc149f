"""Consistent mass matrices and loads of shell elements, of the displacements of `shell_interpolation`."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.elements.shell_geometry import (
    FlatGeometry,
    ShellKind,
    flatten,
    link_matrices,
    per_element,
    prepared,
)
from axlespan.elements.shell_interpolation import plane_rows
from axlespan.elements.shell_shapes import integration_rule, shapes
from axlespan.elements.shell_sides import mean_drilling
from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]


def mass(
    kind: ShellKind,
    coordinates: npt.ArrayLike,
    density: npt.ArrayLike,
    thickness: npt.ArrayLike,
    offset: npt.ArrayLike = 0.0,
    lumped: bool = False,
) -> FloatArray:
    """Mass matrices (n_e, 6 n_node, 6 n_node) [kg, kg m, kg m^2].

    Consistent: with the rotary inertia ρ t³/12 about the axes in the plane. Total, center and moments of
    inertia of a rigid motion are those of the plate on its mean plane; a rotation about the normal gets no
    rotary inertia. Only what the drilling rotation turns more than the plane does, nothing in a rigid
    motion, has the inertia ρ t³/12 as well, so that the matrix is positive definite.

    Lumped: at each node its share m of the element and m t²/12 about every axis. The matrix is diagonal
    without an offset, of 6 × 6 blocks with one; about the normal it has Σ m t²/12 more than the plate.

    Parameters
    ----------
    kind : {"shell3", "shell4"}
    coordinates : array (n_e, n_node, 3)
        Nodes on the reference surface [m].
    density : float or array (n_e,)
        ρ ≥ 0, per volume [kg/m^3].
    thickness : float or array (n_e,)
        t > 0 [m].
    offset : float or array (n_e,)
        From the reference surface to the mid-surface, along the element's normal [m].
    lumped : bool
        Lumped instead of consistent.

    Raises
    ------
    InputError
        If the coordinates are not usable, a thickness is not positive or a density is negative.
    """
    geometry, t, reach = prepared(kind, coordinates, thickness, offset)
    rho = per_element(density, len(t), "density")
    if np.any(rho < 0.0):
        raise InputError("must be zero or positive", field="density", value=float(rho.min()))
    natural, weight = integration_rule(geometry)
    layer = (rho * t)[:, None] * weight
    if lumped:
        return _lumped_mass(geometry, layer @ shapes(geometry.node_count, natural), t, reach)
    membrane, bending = plane_rows(geometry, natural)
    plane = _weighted_product(membrane, np.repeat(layer[..., None], 2, axis=2))
    spin = np.sqrt(rho * t**3 / 12.0 * geometry.area)[:, None] * mean_drilling(geometry)
    plane += spin[:, :, None] * spin[:, None, :]
    inertia = np.stack([np.ones_like(t), t**2 / 12.0, t**2 / 12.0], axis=1)
    plate = _weighted_product(bending, layer[..., None] * inertia[:, None])
    to_membrane, to_bending = link_matrices(geometry, reach)
    matrix: FloatArray = to_membrane.transpose(0, 2, 1) @ plane @ to_membrane
    matrix += to_bending.transpose(0, 2, 1) @ plate @ to_bending
    return 0.5 * (matrix + matrix.transpose(0, 2, 1))


def surface_pressure(kind: ShellKind, coordinates: npt.ArrayLike, pressure: npt.ArrayLike) -> FloatArray:
    """Nodal loads (n_e, 6 n_node) [N, N m] of a pressure along the elements' normals.

    Parameters
    ----------
    kind, coordinates
        As in `mass`.
    pressure : float or array (n_e,)
        Force per area of the mean plane, positive in the direction of the normal [N/m^2].
    """
    geometry = flatten(kind, coordinates)
    p = per_element(pressure, len(geometry.area), "pressure")
    return _surface_load(geometry, p[:, None] * geometry.axes[:, 2], np.zeros_like(p))


def body_force(
    kind: ShellKind,
    coordinates: npt.ArrayLike,
    force: npt.ArrayLike,
    thickness: npt.ArrayLike,
    offset: npt.ArrayLike = 0.0,
) -> FloatArray:
    """Nodal loads (n_e, 6 n_node) [N, N m] of a force per volume, as of gravity: force = ρ g.

    Parameters
    ----------
    kind, coordinates, thickness, offset
        As in `mass`.
    force : array (3,) or (n_e, 3)
        In global axes [N/m^3].
    """
    geometry, t, reach = prepared(kind, coordinates, thickness, offset)
    b = np.asarray(force, dtype=float)
    if b.shape not in ((3,), (len(t), 3)) or not np.all(np.isfinite(b)):
        raise InputError(f"must be 3 finite numbers, or ({len(t)}, 3)", field="force", value=force)
    return _surface_load(geometry, t[:, None] * b, reach)


def _surface_load(geometry: FlatGeometry, load: FloatArray, offset: FloatArray) -> FloatArray:
    """Nodal loads of a force per area (n_e, 3) on the mid-surface."""
    natural, weight = integration_rule(geometry)
    membrane, bending = plane_rows(geometry, natural)
    local = np.einsum("eij,ej->ei", geometry.axes, load)
    plane = np.einsum("ep,ei,epid->ed", weight, local[:, :2], membrane, optimize=True)
    plate = np.einsum("ep,e,epd->ed", weight, local[:, 2], bending[:, :, 0], optimize=True)
    to_membrane, to_bending = link_matrices(geometry, offset)
    nodal: FloatArray = np.einsum("ed,edf->ef", plane, to_membrane)
    nodal += np.einsum("ed,edf->ef", plate, to_bending)
    return nodal


def _weighted_product(rows: FloatArray, weight: FloatArray) -> FloatArray:
    """Σ_p Σ_i weight rowsᵀ rows with rows (n_e, n_point, n_row, n_d) and weights (n_e, n_point, n_row)."""
    n_e, *_, n_d = rows.shape
    flat = rows.reshape(n_e, -1, n_d)
    product: FloatArray = flat.transpose(0, 2, 1) @ (weight.reshape(n_e, -1, 1) * flat)
    return product


def _lumped_mass(geometry: FlatGeometry, share: FloatArray, t: FloatArray, offset: FloatArray) -> FloatArray:
    """Blocks of the nodes' masses (n_e, n_node) with their levers d n: S = [d n ×]."""
    n_e, n = share.shape
    x, y, z = (geometry.axes[:, 2] * offset[:, None]).T
    o = np.zeros_like(x)
    lever = np.stack([np.stack([o, z, -y], 1), np.stack([-z, o, x], 1), np.stack([y, -x, o], 1)], axis=1)
    block = np.zeros((n_e, 6, 6))
    block[:, :3, :3] = np.eye(3)
    block[:, :3, 3:], block[:, 3:, :3] = lever, lever.transpose(0, 2, 1)
    block[:, 3:, 3:] = lever.transpose(0, 2, 1) @ lever + (t**2 / 12.0)[:, None, None] * np.eye(3)
    matrix = np.zeros((n_e, n, 6, n, 6))
    node = np.arange(n)
    matrix[:, node, :, node, :] = share.T[:, :, None, None] * block
    return matrix.reshape(n_e, 6 * n, 6 * n)
