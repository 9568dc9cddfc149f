"""Static deflections of uniform Euler-Bernoulli beams; cubic elements give them exactly at nodes."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

from ._inputs import FloatArray, require_positive

StaticSupports = Literal["pinned-pinned", "fixed-fixed", "fixed-free"]


def point_load_deflection(
    x: npt.ArrayLike,
    *,
    force: float,
    at: npt.ArrayLike,
    length: float,
    bending_stiffness: float,
    supports: StaticSupports = "pinned-pinned",
) -> FloatArray:
    """Displacement at ``x`` under a downward force at ``at``, upward positive, x and at broadcast [m].

    Theory, (R31). Shear deformation is left out.

    Examples
    --------
    >>> w = point_load_deflection(5.0, force=48e3, at=5.0, length=10.0, bending_stiffness=1e9)
    >>> round(float(w), 9)
    -0.001
    """
    require_positive("length", length)
    require_positive("bending_stiffness", bending_stiffness)
    points, load = _on_beam("x", x, length), _on_beam("at", at, length)
    # Maxwell and Betti: the point nearer to the left end plays x
    s, a = np.minimum(points, load), np.maximum(points, load)
    shape: FloatArray
    b = length - a
    if supports == "pinned-pinned":
        shape = b * s * (length**2 - b**2 - s**2) / (6.0 * length)
    elif supports == "fixed-fixed":
        shape = b**2 * s**2 * (3.0 * a * length - 3.0 * a * s - b * s) / (6.0 * length**3)
    elif supports == "fixed-free":
        shape = s**2 * (3.0 * a - s) / 6.0
    else:
        raise InputError(
            "must be one of " + ", ".join(get_args(StaticSupports)), field="supports", value=supports
        )
    deflection: FloatArray = -force / bending_stiffness * shape
    return deflection


def uniform_load_deflection(
    x: npt.ArrayLike, *, load: float, length: float, bending_stiffness: float
) -> FloatArray:
    """Displacement at ``x`` of a simply supported beam under a downward ``load``, upward positive [m]."""
    require_positive("length", length)
    require_positive("bending_stiffness", bending_stiffness)
    s = _on_beam("x", x, length)
    return -load / (24.0 * bending_stiffness) * s * (length**3 - 2.0 * length * s**2 + s**3)


def point_load_moment(x: npt.ArrayLike, *, force: float, at: npt.ArrayLike, length: float) -> FloatArray:
    """Bending moment at ``x`` of a simply supported beam under a downward force, sagging positive [Nm]."""
    require_positive("length", length)
    points, load = _on_beam("x", x, length), _on_beam("at", at, length)
    return force * np.minimum(points, load) * (length - np.maximum(points, load)) / length


def _on_beam(field: str, x: npt.ArrayLike, length: float) -> FloatArray:
    points = np.asarray(x, dtype=np.float64)
    if np.any(points < 0.0) or np.any(points > length):
        raise InputError(f"must lie between 0 and {length:g} m", field=field, value=x, fix="Stay on the beam")
    return points
