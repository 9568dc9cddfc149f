"""Vehicles on a rigid road of waves, in closed form."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ._inputs import ComplexArray, FloatArray
from .plain_vehicles import PlainVehicle


def ride(
    vehicle: PlainVehicle,
    frequencies: npt.ArrayLike,
    amplitudes: npt.ArrayLike,
    time: npt.ArrayLike,
) -> tuple[FloatArray, FloatArray]:
    """Return the motion over wheels that move as sums of cosines, from static equilibrium: theory, (R36).

    Parameters
    ----------
    vehicle : PlainVehicle
        Its free motions decay or are distinct.
    frequencies : array_like (wave,)
        [rad/s].
    amplitudes : array_like (wave, wheel)
        Complex; a wheel is at ``Re sum amplitudes exp(i frequencies t)`` [m].
    time : array_like (time,)
        [s]; at t = 0 the bodies are in static equilibrium, without velocity.

    Returns
    -------
    motion : numpy.ndarray (time, d.o.f.)
        Of the d.o.f. that are no wheels, from the static position [m, rad].
    force : numpy.ndarray (time, wheel)
        Contact forces less the static ones [N].
    """
    omega = np.asarray(frequencies, dtype=np.float64)
    waves = np.asarray(amplitudes, dtype=np.complex128)
    t = np.asarray(time, dtype=np.float64)
    n = vehicle.free
    m, c, k = vehicle.mass, vehicle.damping, vehicle.stiffness

    def dynamic(rate: ComplexArray) -> ComplexArray:
        s = rate[:, np.newaxis, np.newaxis]
        return np.asarray(s**2 * m + s * c + k, dtype=np.complex128)

    # steady answer to each wave
    z = dynamic(1j * omega)
    bodies = np.linalg.solve(z[:, :n, :n], -(z[:, :n, n:] @ waves[..., np.newaxis]))[..., 0]
    at_wheels = (z[:, n:, :n] @ bodies[..., np.newaxis] + z[:, n:, n:] @ waves[..., np.newaxis])[..., 0]
    # free motion that makes the start what it is
    rest = np.linalg.solve(k[:n, :n], -k[:n, n:] @ waves.sum(axis=0).real)
    state = np.concatenate((rest - bodies.sum(axis=0).real, -(1j * omega @ bodies).real))
    inverse = np.linalg.inv(m[:n, :n])
    first = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ k[:n, :n], -inverse @ c[:n, :n]]])
    poles, shapes = np.linalg.eig(first)
    free = shapes[:n] * np.linalg.solve(shapes, state.astype(np.complex128))
    free_force = dynamic(poles)[:, n:, :n] @ free.T[..., np.newaxis]
    turning, fading = np.exp(1j * np.outer(t, omega)), np.exp(np.outer(t, poles))
    motion = (turning @ bodies + fading @ free.T).real
    force = (turning @ at_wheels + fading @ free_force[..., 0]).real
    return motion, force
