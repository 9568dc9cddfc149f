r"""Straight prismatic beams in space, Euler-Bernoulli or Timoshenko.

One formulation serves both theories and two and three dimensions. Bending in each principal plane
uses the exact static solution of the shear-flexible beam as interpolation (Przemieniecki 1968,
Friedman and Kosmatka 1993): with Φ = 12 EI / (κGA L²) and ξ = x / L,

.. math:: w(ξ) = N(ξ) [w_1, ψ_1, w_2, ψ_2]^T, \qquad ψ(ξ) = P(ξ) [w_1, ψ_1, w_2, ψ_2]^T

which is free of shear locking and becomes Hermite's cubic for Φ = 0. Stiffness, consistent mass (with
rotary inertia), loads and the running line all use these same polynomials.

Local axes: x along the element, y and z the principal axes; rotations are right-handed, so the slope
is ψ = -ry in the x-z plane and ψ = +rz in the x-y plane.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int_]

#: d.o.f. of a beam element in its local axes, node by node.
DOFS = ("x", "y", "z", "rx", "ry", "rz")

# Local d.o.f. (0..11) of each simple state, in the order [w1, ψ1, w2, ψ2] or [u1, u2], and the
# sign that turns a right-handed rotation into a slope.
_BENDING_XZ = (np.array([2, 4, 8, 10]), np.array([1.0, -1.0, 1.0, -1.0]))
_BENDING_XY = (np.array([1, 5, 7, 11]), np.array([1.0, 1.0, 1.0, 1.0]))
_AXIAL = np.array([0, 6])
_TORSION = np.array([3, 9])

# ∫ ξ^i ξ^j dξ over [0, 1] for powers 0..3.
_MOMENTS = 1.0 / (np.arange(4)[:, None] + np.arange(4)[None, :] + 1.0)


@dataclass(frozen=True)
class BeamProperties:
    """Stiffness and mass of beams; each value is a number or an array (n_element,).

    ``inf`` as shear stiffness means no shear deformation (Euler-Bernoulli).
    """

    axial_stiffness: FloatArray | float = 0.0  # EA [N]
    bending_stiffness_y: FloatArray | float = 0.0  # EI_y, bending in the x-z plane [N m^2]
    bending_stiffness_z: FloatArray | float = 0.0  # EI_z, bending in the x-y plane [N m^2]
    torsional_stiffness: FloatArray | float = 0.0  # GJ [N m^2]
    shear_stiffness_y: FloatArray | float = np.inf  # κ_y G A, shear along y [N]
    shear_stiffness_z: FloatArray | float = np.inf  # κ_z G A, shear along z [N]
    mass_per_length: FloatArray | float = 0.0  # m [kg/m]
    rotary_inertia_y: FloatArray | float = 0.0  # ρ I_y per length [kg m]
    rotary_inertia_z: FloatArray | float = 0.0  # ρ I_z per length [kg m]

    def broadcast(self, n_element: int) -> BeamProperties:
        """Return the same properties with every value as an array (n_element,)."""
        arrays = {
            f.name: np.broadcast_to(np.asarray(getattr(self, f.name), float), (n_element,))
            for f in fields(self)
        }
        return replace(self, **arrays)


def lengths(coordinates: FloatArray) -> FloatArray:
    """Lengths (n_element,) [m] of elements with end coordinates (n_element, 2, 3) [m]."""
    result: FloatArray = np.linalg.norm(coordinates[:, 1] - coordinates[:, 0], axis=1)
    return result


def frames(coordinates: FloatArray, up: FloatArray | None = None) -> FloatArray:
    """Local axes as rows of rotation matrices (n_element, 3, 3).

    Parameters
    ----------
    coordinates : array (n_element, 2, 3)
        End points [m].
    up : array (3,) or (n_element, 3), optional
        A direction in the local x-z plane, on the side of +z. Global z by default; for elements
        parallel to global z it is -x, so that local y stays global y.
    """
    axis = coordinates[:, 1] - coordinates[:, 0]
    axis = axis / np.linalg.norm(axis, axis=1, keepdims=True)
    if up is None:
        vertical = np.abs(axis[:, 2]) > 1.0 - 1e-9
        side = np.cross(np.array([0.0, 0.0, 1.0]), axis)
        side[vertical] = [0.0, 1.0, 0.0]
    else:
        side = np.cross(np.broadcast_to(np.asarray(up, float), axis.shape), axis)
    side = side / np.linalg.norm(side, axis=1, keepdims=True)
    return np.stack([axis, side, np.cross(axis, side)], axis=1)


def shear_parameter(bending: FloatArray, shear: FloatArray, length: FloatArray) -> FloatArray:
    """Φ = 12 EI / (κGA L²) [-]; zero for an infinite shear stiffness."""
    return np.asarray(12.0 * bending / (shear * length**2))


def deflection_polynomials(phi: FloatArray, length: FloatArray) -> FloatArray:
    """Coefficients (n_element, 4, 4) of N in powers of ξ; rows follow [w1, ψ1, w2, ψ2]."""
    one, zero = np.ones_like(phi), np.zeros_like(phi)
    rows = [
        [one + phi, -phi, -3.0 * one, 2.0 * one],
        [zero, length * (1.0 + 0.5 * phi), -length * (2.0 + 0.5 * phi), length],
        [zero, phi, 3.0 * one, -2.0 * one],
        [zero, -0.5 * length * phi, -length * (1.0 - 0.5 * phi), length],
    ]
    table = np.array(rows).transpose(2, 0, 1)
    return np.asarray(table / (1.0 + phi)[:, None, None])


def rotation_polynomials(phi: FloatArray, length: FloatArray) -> FloatArray:
    """Coefficients (n_element, 4, 4) of P, the rotation of the section, in powers of ξ."""
    one, zero = np.ones_like(phi), np.zeros_like(phi)
    rows = [
        [zero, -6.0 / length, 6.0 / length, zero],
        [one + phi, -4.0 - phi, 3.0 * one, zero],
        [zero, 6.0 / length, -6.0 / length, zero],
        [zero, phi - 2.0, 3.0 * one, zero],
    ]
    table = np.array(rows).transpose(2, 0, 1)
    return np.asarray(table / (1.0 + phi)[:, None, None])


def _bending_stiffness(bending: FloatArray, phi: FloatArray, length: FloatArray) -> FloatArray:
    c, h = bending / ((1.0 + phi) * length**3), length
    rows = [
        [12.0 * c, 6.0 * c * h, -12.0 * c, 6.0 * c * h],
        [6.0 * c * h, (4.0 + phi) * c * h**2, -6.0 * c * h, (2.0 - phi) * c * h**2],
        [-12.0 * c, -6.0 * c * h, 12.0 * c, -6.0 * c * h],
        [6.0 * c * h, (2.0 - phi) * c * h**2, -6.0 * c * h, (4.0 + phi) * c * h**2],
    ]
    return np.array(rows).transpose(2, 0, 1)


def _integrate(left: FloatArray, weight: FloatArray) -> FloatArray:
    """∫ weight · leftᵀ left over the element, for polynomials in ξ."""
    return np.asarray(weight[:, None, None] * (left @ _MOMENTS @ left.transpose(0, 2, 1)))


_Plane = tuple[tuple[IntArray, FloatArray], tuple[FloatArray, FloatArray, FloatArray]]


def _planes(p: BeamProperties, length: FloatArray) -> list[_Plane]:
    xz = (p.bending_stiffness_y, p.shear_stiffness_z, p.rotary_inertia_y)
    xy = (p.bending_stiffness_z, p.shear_stiffness_y, p.rotary_inertia_z)
    planes: list[_Plane] = []
    for where, (bending, shear, rotary) in ((_BENDING_XZ, xz), (_BENDING_XY, xy)):
        phi = shear_parameter(np.asarray(bending), np.asarray(shear), length)
        planes.append((where, (np.asarray(bending), phi, np.asarray(rotary))))
    return planes


def stiffness(coordinates: FloatArray, properties: BeamProperties, frame: FloatArray) -> FloatArray:
    """Stiffness matrices (n_element, 12, 12) [N/m, N, N m] in global axes."""
    length, p = lengths(coordinates), properties.broadcast(len(coordinates))
    local = np.zeros((len(coordinates), 12, 12))
    for (dofs, sign), (bending, phi, _) in _planes(p, length):
        local[:, dofs[:, None], dofs] += _bending_stiffness(bending, phi, length) * np.outer(sign, sign)
    pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
    for dofs, rigidity in ((_AXIAL, p.axial_stiffness), (_TORSION, p.torsional_stiffness)):
        local[:, dofs[:, None], dofs] += (rigidity / length)[:, None, None] * pair
    return to_global(local, frame)


def mass(coordinates: FloatArray, properties: BeamProperties, frame: FloatArray) -> FloatArray:
    """Consistent mass matrices (n_element, 12, 12) [kg, kg m, kg m^2] in global axes."""
    length, p = lengths(coordinates), properties.broadcast(len(coordinates))
    local = np.zeros((len(coordinates), 12, 12))
    for (dofs, sign), (_, phi, rotary) in _planes(p, length):
        block = _integrate(deflection_polynomials(phi, length), p.mass_per_length * length)
        block += _integrate(rotation_polynomials(phi, length), rotary * length)
        local[:, dofs[:, None], dofs] += block * np.outer(sign, sign)
    pair = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
    polar = np.asarray(p.rotary_inertia_y) + np.asarray(p.rotary_inertia_z)
    for dofs, inertia in ((_AXIAL, p.mass_per_length), (_TORSION, polar)):
        local[:, dofs[:, None], dofs] += (inertia * length)[:, None, None] * pair
    return to_global(local, frame)


def to_global(local: FloatArray, frame: FloatArray) -> FloatArray:
    """Turn element matrices (n_element, 12, 12) from local to global axes: Rᵀ k R."""
    blocks = local.reshape(-1, 4, 3, 4, 3)
    turned = np.einsum("eki,eakbl,elj->eaibj", frame, blocks, frame, optimize=True)
    return np.asarray(turned.reshape(local.shape))


def displacement_polynomials(
    coordinates: FloatArray, properties: BeamProperties, frame: FloatArray, direction: FloatArray
) -> FloatArray:
    """Displacement of the axis along a direction, as polynomials of ξ in the element's d.o.f.

    Parameters
    ----------
    coordinates, properties, frame
        As for :func:`stiffness`.
    direction : array (3,) or (n_element, 3)
        Unit vector in global axes, e.g. (0, 0, 1) for vertical.

    Returns
    -------
    array (n_element, 12, 4)
        Coefficients of ξ⁰..ξ³ for each global d.o.f. [m/m or m/rad].
    """
    n_element = len(coordinates)
    length, p = lengths(coordinates), properties.broadcast(n_element)
    local = np.zeros((n_element, 3, 12, 4))  # displacement along local x, y, z
    local[:, 0, 0, :2] = [1.0, -1.0]
    local[:, 0, 6, :2] = [0.0, 1.0]
    for axis, ((dofs, sign), (_, phi, _)) in zip((2, 1), _planes(p, length), strict=True):
        local[:, axis, dofs] = deflection_polynomials(phi, length) * sign[:, None]
    along = np.einsum("eij,ej->ei", frame, np.broadcast_to(direction, (n_element, 3)))
    rows = np.einsum("ei,eidp->edp", along, local).reshape(n_element, 4, 3, 4)
    return np.asarray(np.einsum("eakp,ekj->eajp", rows, frame).reshape(n_element, 12, 4))


def end_forces(
    coordinates: FloatArray, properties: BeamProperties, frame: FloatArray, displacements: FloatArray
) -> FloatArray:
    """Static end forces (n_element, 12) [N, N m] in local axes for global displacements (n_element, 12)."""
    length, p = lengths(coordinates), properties.broadcast(len(coordinates))
    identity = np.broadcast_to(np.eye(3), frame.shape)
    axial = np.zeros_like(coordinates)
    axial[:, 1, 0] = length
    local = stiffness(axial, p, identity)
    turned = np.einsum("eij,eaj->eai", frame, displacements.reshape(-1, 4, 3)).reshape(-1, 12)
    return np.asarray(np.einsum("eij,ej->ei", local, turned))
