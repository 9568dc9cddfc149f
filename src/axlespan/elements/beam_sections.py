r"""Moment, shear, normal force and torsion inside beam elements, by equilibrium of the piece before the section.

The end forces of an element that carries a wheel at η are f = K u + C u̇ + M ü + N(η)ᵀ X. The piece from the
first end to the section at x = ξ L then gives, with the inertia m ü and the wheel on it,

.. math::
   V(x) &= f_{z1} - \int_0^x m \ddot w \, dx' - [η < ξ] X \\
   M(x) &= f_{ψ1} + f_{z1} x - \int_0^x m \ddot w (x - x') \, dx' + \int_0^x ρI \ddot ψ \, dx' - [η < ξ] X (x - x_X)

Static point loads, anywhere in the element, are exact. M pulls at the side of -z (sagging), V = dM/dx,
N > 0 pulls, T turns the face that looks along +x to the right-handed sense.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.elements import beam
from axlespan.elements.beam import BeamProperties

FloatArray = npt.NDArray[np.float64]

#: What there is at a section, in this order.
QUANTITIES = ("moment", "shear", "normal", "torsion")

# Local end forces at the first end, and their signs as section forces: My, Fz, -Fx, -Mx.
_FIRST_END = np.array([4, 2, 0, 3])
_SIGNS = np.array([1.0, 1.0, -1.0, -1.0])
_MOMENT, _SHEAR, _NORMAL, _TORSION = range(4)

# Local d.o.f. of [w1, ψ1, w2, ψ2] for bending in the x-z plane, where ψ = -ry.
_W_AND_SLOPE = np.array([2, 4, 8, 10])
_SLOPE_SIGNS = np.array([1.0, -1.0, 1.0, -1.0])


def section_rows(
    coordinates: FloatArray, properties: BeamProperties, frame: FloatArray, xi: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Section forces per displacement and per acceleration of the element's global d.o.f.

    Parameters
    ----------
    coordinates, properties, frame
        Of the elements (n, …), as for :func:`axlespan.elements.beam.stiffness`.
    xi : array (n,)
        One section in each element, 0 at its first end and 1 at its second.

    Returns
    -------
    array (n, 4, 12), array (n, 4, 12)
        Rows of :data:`QUANTITIES` [N, N m per m, rad] and [… per m/s², rad/s²].
    """
    p, length, axial, identity = _in_local_axes(coordinates, properties, frame)
    static = _SIGNS[:, None] * beam.stiffness(axial, p, identity)[:, _FIRST_END]
    inertial = _SIGNS[:, None] * beam.mass(axial, p, identity)[:, _FIRST_END]
    for rows in (static, inertial):
        rows[:, _MOMENT] += (xi * length)[:, None] * rows[:, _SHEAR]
    m = np.asarray(p.mass_per_length) * length
    # ∫ ηᵖ dη and ∫ (ξ - η) ηᵖ dη from 0 to ξ, for powers 0..3.
    power = np.arange(4)
    once = xi[:, None] ** (power + 1) / (power + 1)
    twice = xi[:, None] ** (power + 2) / ((power + 1) * (power + 2))
    deflection = beam.displacement_polynomials(axial, p, identity, np.array([0.0, 0.0, 1.0]))
    inertial[:, _SHEAR] -= m[:, None] * np.einsum("edp,ep->ed", deflection, once)
    inertial[:, _MOMENT] -= (m * length)[:, None] * np.einsum("edp,ep->ed", deflection, twice)
    rotation = _slope_polynomials(p, length)
    rotary = np.asarray(p.rotary_inertia_y) * length
    inertial[:, _MOMENT] += rotary[:, None] * np.einsum("edp,ep->ed", rotation, once)
    polar = (np.asarray(p.rotary_inertia_y) + np.asarray(p.rotary_inertia_z)) * length
    for quantity, density, first in ((_NORMAL, m, 0), (_TORSION, polar, 3)):
        inertial[:, quantity, first] += density * (once[:, 0] - once[:, 1])
        inertial[:, quantity, first + 6] += density * once[:, 1]
    return _to_global(static, frame), _to_global(inertial, frame)


def wheel_polynomials(
    coordinates: FloatArray,
    properties: BeamProperties,
    frame: FloatArray,
    xi: FloatArray,
    direction: FloatArray,
) -> FloatArray:
    """Section forces of a wheel in the same element, per contact force, as polynomials of its place η.

    Parameters
    ----------
    coordinates, properties, frame, xi
        As for :func:`section_rows`.
    direction : array (3,)
        Of the contact force on the vehicle, in global axes; the element takes the opposite.

    Returns
    -------
    array (n, 2, 4, 4)
        For wheels before the section (η < ξ) and after it: rows of :data:`QUANTITIES`, powers η⁰..η³. They
        come on top of what :func:`section_rows` gives for the displacements under that wheel.
    """
    p, length, axial, identity = _in_local_axes(coordinates, properties, frame)
    local = np.einsum("eij,j->ei", frame, direction)
    along = beam.displacement_polynomials(axial, p, identity, local)
    result = np.repeat((_SIGNS[:, None] * along[:, _FIRST_END])[:, None], 2, axis=1)
    result[:, :, _MOMENT] += (xi * length)[:, None, None] * result[:, :, _SHEAR]
    before = result[:, 0]
    before[:, _SHEAR, 0] -= local[:, 2]
    before[:, _NORMAL, 0] += local[:, 0]
    before[:, _MOMENT, 0] -= local[:, 2] * length * xi
    before[:, _MOMENT, 1] += local[:, 2] * length
    return result


def _in_local_axes(
    coordinates: FloatArray, properties: BeamProperties, frame: FloatArray
) -> tuple[BeamProperties, FloatArray, FloatArray, FloatArray]:
    """Properties, lengths, coordinates along the axis and frames of the elements as they see themselves."""
    length = beam.lengths(coordinates)
    axial = np.zeros_like(coordinates)
    axial[:, 1, 0] = length
    identity = np.broadcast_to(np.eye(3), frame.shape)
    return properties.broadcast(len(coordinates)), length, axial, identity


def _slope_polynomials(p: BeamProperties, length: FloatArray) -> FloatArray:
    """Rotation ψ of the section in the local x-z plane (n, 12, 4)."""
    bending, shear = np.asarray(p.bending_stiffness_y), np.asarray(p.shear_stiffness_z)
    phi = beam.shear_parameter(bending, shear, length)
    result = np.zeros((len(length), 12, 4))
    result[:, _W_AND_SLOPE] = beam.rotation_polynomials(phi, length) * _SLOPE_SIGNS[:, None]
    return result


def _to_global(rows: FloatArray, frame: FloatArray) -> FloatArray:
    turned = np.einsum("eqak,ekj->eqaj", rows.reshape(len(rows), 4, 4, 3), frame)
    return np.asarray(turned.reshape(rows.shape))
