"""Wheels with mass that follow a simply supported beam exactly, with or without a sprung body."""

from __future__ import annotations

from collections.abc import Sequence

import numpy.typing as npt

from ._inputs import (
    STANDARD_GRAVITY,
    damping_ratios,
    increasing_times,
    require_count,
    require_not_negative,
    require_positive,
)
from .beam_modes import SimplySupportedBeam
from .motion import Motion
from .profiles import Profile, level
from .responses import CrossingResponse
from .wheel_march import march
from .wheel_path import WheelPath, respond
from .wheel_unit import UnitTable, WheelUnit


def cross_wheel_units(
    beam: SimplySupportedBeam,
    units: Sequence[WheelUnit],
    motion: Motion,
    time: npt.ArrayLike,
    *,
    modes: int = 60,
    profile: Profile | None = None,
    modal_damping: float | Sequence[float] = 0.0,
    gravity: float = STANDARD_GRAVITY,
    max_step: float = 1e-4,
    stages: int = 3,
) -> CrossingResponse:
    """Return the crossing of wheels that stay on the beam and the irregularity: theory, (R9) to (R18).

    The wheel's acceleration holds the convective terms,
    ``w_tt + 2 v w_xt + v^2 (w_xx + r'') + a (w_x + r')``, so the mass matrix of the modal equations
    depends on time. They are integrated by Gauss collocation of order ``2 stages`` that restarts at every
    entry, exit and kink of the profile. Contact is never lost: a negative contact force is reported as such.

    Off the beam wheels run on rigid ground under the same irregularity. At a kink of the path the wheel's
    velocity jumps; the impulse is in ``impacts``, not in ``contact_force``. At entry and exit the support
    takes all of it.

    Parameters
    ----------
    beam : SimplySupportedBeam
    units : sequence of WheelUnit
        From the head of the row.
    motion : Motion
        One offset per unit.
    time : array_like
        Increasing times from zero or later, (time,) [s]. The vehicles stand in static equilibrium on the
        irregularity at t = 0, bodies without vertical velocity.
    modes : int, optional
        Deflections converge with 10 to 20. The contact force of a wheel with mass holds undamped bending
        waves of all modes: its value at an instant converges slowly, its mean over milliseconds soon.
    profile : Profile, optional
        Level when left out.
    modal_damping : float or sequence of float, optional
        Damping ratio of all modes, or of each.
    gravity : float, optional
        [m/s2].
    max_step : float, optional
        Longest step of the integration [s]. Modes with periods below a few steps follow quasi-statically.
    stages : int, optional
        Stages of the Gauss method.

    Returns
    -------
    CrossingResponse

    Raises
    ------
    InputError
        For a profile without the derivatives needed, offsets that do not fit the units, and the like.

    Examples
    --------
    >>> beam = SimplySupportedBeam(length=25.0, bending_stiffness=2.87e9 * 2.90, mass_per_length=2303.0)
    >>> crossing = cross_wheel_units(beam, [WheelUnit.rigid_mass(5750.0)], Motion(20.0), [0.5, 1.0], modes=20)
    >>> crossing.contact_force.shape
    (2, 1)
    """
    times = increasing_times(time)
    require_count("modes", modes)
    require_positive("max_step", max_step)
    require_not_negative("gravity", gravity)
    motion.require_forward(float(times[-1]))
    path = WheelPath(beam, modes, motion, profile or level(), UnitTable.of(units))
    ratios = damping_ratios(modal_damping, modes)
    return respond(path, march(path, times, ratios, gravity, max_step, stages), ratios, gravity)
