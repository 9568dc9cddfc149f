"""Springs, dashpots, bars and point masses: matrices of elements without an interpolation of their own."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

_PAIR = np.array([[1.0, -1.0], [-1.0, 1.0]])


def coupling(coefficients: FloatArray) -> FloatArray:
    """Matrices (n_element, 2 n, 2 n) of springs or dashpots that act between equal d.o.f. of two nodes.

    Parameters
    ----------
    coefficients : array (n_element, n)
        Stiffness [N/m, N m/rad] or damping [N s/m, N m s/rad] of each of the n d.o.f. of a node.
    """
    n_element, n = coefficients.shape
    result = np.zeros((n_element, 2, n, 2, n))
    diagonal = np.arange(n)
    result[:, :, diagonal, :, diagonal] = coefficients.T[:, :, None, None] * _PAIR
    return result.reshape(n_element, 2 * n, 2 * n)


def directed(coefficients: FloatArray, directions: FloatArray) -> FloatArray:
    """Matrices (n_element, 6, 6) of springs or dashpots along unit vectors (n_element, 3).

    The force is the coefficient (n_element,) times the relative displacement (or velocity) of the
    two nodes along the direction.
    """
    along = np.einsum("ei,ej->eij", directions, directions) * coefficients[:, None, None]
    return np.asarray(np.einsum("ab,eij->eaibj", _PAIR, along).reshape(-1, 6, 6))


def bar_stiffness(coordinates: FloatArray, axial_stiffness: FloatArray) -> FloatArray:
    """Stiffness (n_element, 6, 6) [N/m] of bars with end coordinates (n_element, 2, 3) and EA (n_element,) [N]."""
    axis = coordinates[:, 1] - coordinates[:, 0]
    length = np.linalg.norm(axis, axis=1)
    return directed(axial_stiffness / length, axis / length[:, None])


def bar_mass(coordinates: FloatArray, mass_per_length: FloatArray) -> FloatArray:
    """Consistent mass (n_element, 6, 6) [kg] of bars; the same in all directions."""
    length = np.linalg.norm(coordinates[:, 1] - coordinates[:, 0], axis=1)
    pair = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
    blocks = np.einsum("ab,ij->aibj", pair, np.eye(3)).reshape(6, 6)
    return np.asarray((mass_per_length * length)[:, None, None] * blocks)


def point_mass(inertia: FloatArray) -> FloatArray:
    """Diagonal mass matrices (n_element, n, n) from inertias (n_element, n) [kg, kg m^2]."""
    n = inertia.shape[1]
    result = np.zeros((len(inertia), n, n))
    result[:, np.arange(n), np.arange(n)] = inertia
    return result


def rigid_arm(arms: FloatArray) -> FloatArray:
    """Small-rotation kinematics (n, 6, 6) of points at arms (n, 3) [m] from the node that carries them.

    The point's displacement is u + θ × arm, its rotation θ.
    """
    result = np.tile(np.eye(6), (len(arms), 1, 1))
    x, y, z = arms.T
    result[:, 0, 4], result[:, 0, 5] = z, -y
    result[:, 1, 3], result[:, 1, 5] = -z, x
    result[:, 2, 3], result[:, 2, 4] = y, -x
    return result
