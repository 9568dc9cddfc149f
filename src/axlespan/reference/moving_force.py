"""Forces that cross a simply supported beam, in closed form (Frýba)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

from ._inputs import damping_ratios, increasing_times, require_positive, require_same_length
from .beam_modes import ModalResponse, SimplySupportedBeam
from .duhamel import oscillator_pole, sine_driven
from .motion import Motion


def cross_forces(
    beam: SimplySupportedBeam,
    forces: Sequence[float],
    motion: Motion,
    time: npt.ArrayLike,
    *,
    modes: int = 51,
    modal_damping: float | Sequence[float] = 0.0,
) -> ModalResponse:
    """Return the exact modal response to constant forces that enter, cross and leave one after another.

    Every axle loads mode n by ``-P sin(n pi v t / L) / M_n`` while it is on the beam and leaves it in free
    vibration; the sum over axles is exact at any time, no time step is involved (theory, (R4) to (R8)).
    The beam is at rest until the first force enters.

    Parameters
    ----------
    beam : SimplySupportedBeam
    forces : sequence of float
        Axle loads, positive downward, shape (axle,) [N].
    motion : Motion
        Constant speed; one offset per axle. An axle must not stand on the beam at t = 0 already.
    time : array_like
        Increasing times, shape (time,) [s].
    modes : int, optional
    modal_damping : float or sequence of float, optional
        Damping ratio of all modes, or of each.

    Returns
    -------
    ModalResponse
        Upward positive.

    Raises
    ------
    InputError
        For a changing speed, offsets that do not fit the forces, an axle inside the beam at t = 0.

    Examples
    --------
    >>> beam = SimplySupportedBeam(length=25.0, bending_stiffness=2.87e9 * 2.90, mass_per_length=2303.0)
    >>> time = np.linspace(0.0, 0.9, 9001)
    >>> response = cross_forces(beam, [5750 * 9.81], Motion(100 / 3.6), time)
    >>> f"{1e3 * response.displacement_at(12.5).min():.5f} mm"
    '-2.39683 mm'
    """
    times = increasing_times(time)
    require_same_length("motion.offsets", len(motion.offsets), len(forces))
    if motion.acceleration != 0.0:
        raise InputError(
            "must be zero for the closed form",
            field="motion.acceleration",
            value=motion.acceleration,
            fix="Use cross_wheel_units for a changing speed",
        )
    entry = motion.times_at(0.0)
    if np.any(entry < -1e-12):
        raise InputError(
            "must be at or before the beam at t = 0", field="motion.start", value=motion.start, fix="Write 0"
        )
    omega, zeta = beam.angular_frequencies(modes), damping_ratios(modal_damping, modes)
    drive = beam.wave_numbers(modes) * motion.speed
    pole = oscillator_pole(omega, zeta)
    crossing = beam.length / motion.speed
    amplitude = np.zeros((times.size, modes), dtype=np.complex128)
    load = np.zeros((times.size, modes))
    for force, t_entry in zip(forces, entry, strict=True):
        elapsed = (times - t_entry)[:, np.newaxis]
        on = np.clip(elapsed, 0.0, crossing)
        free = np.maximum(elapsed - crossing, 0.0)
        amplitude += -force / beam.modal_mass * sine_driven(omega, zeta, drive, on) * np.exp(pole * free)
        loaded = (elapsed >= 0.0) & (elapsed <= crossing)
        load += np.where(loaded, -force / beam.modal_mass * np.sin(drive * on), 0.0)
    q, v = amplitude.real, (pole * amplitude).real
    return ModalResponse(beam, times, q, v, load - 2.0 * zeta * omega * v - omega**2 * q)


def midspan_amplification(
    speed_parameter: float, *, modes: int = 51, samples: int = 20_001, after_exit: bool = True
) -> float:
    """Largest mid-span deflection under one force over the static ``P L^3 / 48 EI``, undamped.

    Parameters
    ----------
    speed_parameter : float
        ``alpha = v / (2 f_1 L)``; one is the critical speed.
    modes : int, optional
    samples : int, optional
        Times looked at. The amplification does not depend on the beam.
    after_exit : bool, optional
        Whether the free vibration after the exit counts, one first period long. With many modes it holds
        the maximum near alpha = 0.8.

    Returns
    -------
    float

    Examples
    --------
    >>> round(midspan_amplification(0.617, modes=1), 5)
    1.74288
    """
    require_positive("speed_parameter", speed_parameter)
    beam = SimplySupportedBeam(length=np.pi, bending_stiffness=1.0, mass_per_length=1.0)  # omega_1 = 1
    motion = Motion(speed=speed_parameter * beam.critical_speed)
    until = beam.length / motion.speed + (2.0 * np.pi if after_exit else 0.0)
    response = cross_forces(beam, [1.0], motion, np.linspace(0.0, until, samples), modes=modes)
    static = beam.length**3 / (48.0 * beam.bending_stiffness)
    return float(-response.displacement_at(0.5 * beam.length).min() / static)
