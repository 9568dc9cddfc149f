"""Duhamel's integral of a damped oscillator under a sine, in a form that resonance does not break."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._inputs import ComplexArray, FloatArray


def exponential_convolution(
    pole: npt.ArrayLike, exponent: npt.ArrayLike, time: npt.ArrayLike
) -> ComplexArray:
    """Integrate ``exp(pole (t - s)) exp(exponent s)`` over s from 0 to t: theory, (R6).

    The quotient ``(exp(exponent t) - exp(pole t)) / (exponent - pole)`` loses its digits where the two
    come together (resonance); there ``t exp(pole t) (exp(z) - 1) / z`` with z = (exponent - pole) t is used.

    Parameters
    ----------
    pole, exponent : complex, broadcastable
        [1/s].
    time : float, broadcastable
        [s].
    """
    lam, mu = np.asarray(pole, dtype=np.complex128), np.asarray(exponent, dtype=np.complex128)
    t = np.asarray(time, dtype=np.float64)
    z = (mu - lam) * t
    near = np.abs(z) < 1.0
    far_difference = np.where(near, 1.0, mu - lam)
    far = (np.exp(mu * t) - np.exp(lam * t)) / far_difference
    small = np.where(near & (z != 0.0), z, 1.0)
    ratio = np.where(z == 0.0, 1.0, np.expm1(small) / small)
    integral: ComplexArray = np.where(near, t * np.exp(lam * t) * ratio, far)
    return integral


def sine_driven(
    frequency: FloatArray, damping: FloatArray, drive: FloatArray, time: FloatArray
) -> ComplexArray:
    """Complex amplitude Z of an oscillator at rest at t = 0 under ``sin(drive t)``: theory, (R7).

    The displacement is ``Re Z``, the velocity ``Re(pole Z)`` with ``pole = oscillator_pole(...)``. When the
    drive ends, Z goes on as ``Z exp(pole (t - t_end))``. All arguments broadcast.

    Parameters
    ----------
    frequency, damping : ndarray
        Angular frequency [rad/s] and damping ratio, 0 <= damping < 1.
    drive : ndarray
        Angular frequency of the load per unit mass [rad/s].
    time : ndarray
        [s].
    """
    pole = oscillator_pole(frequency, damping)
    forth = exponential_convolution(pole, 1j * drive, time)
    back = exponential_convolution(pole, -1j * drive, time)
    return (back - forth) / (2.0 * pole.imag)


def oscillator_pole(frequency: FloatArray, damping: FloatArray) -> ComplexArray:
    """``-zeta omega + i omega sqrt(1 - zeta^2)`` [1/s]."""
    omega, zeta = np.asarray(frequency, dtype=np.float64), np.asarray(damping, dtype=np.float64)
    return -zeta * omega + 1j * omega * np.sqrt(1.0 - zeta**2)
