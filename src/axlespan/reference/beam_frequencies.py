"""Natural frequencies of uniform beams, thin (Euler-Bernoulli) and thick (Timoshenko)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, get_args

import numpy as np
from scipy.optimize import brentq

from axlespan.errors import InputError

from ._inputs import FloatArray, require_count, require_positive

Supports = Literal["pinned-pinned", "fixed-free", "fixed-fixed", "free-free", "fixed-pinned"]


def euler_bernoulli_roots(count: int, supports: Supports = "pinned-pinned") -> FloatArray:
    """Roots lambda_n L of the frequency equation, shape (mode,) [-]; rigid motions are left out.

    Theory, (R23): ``sin x = 0``, ``cos x cosh x = -1`` (fixed-free), ``+1`` (fixed-fixed, free-free) and
    ``tan x = tanh x`` (fixed-pinned), solved between multiples of pi.

    Examples
    --------
    >>> euler_bernoulli_roots(3, "fixed-free").round(6).tolist()
    [1.875104, 4.694091, 7.854757]
    """
    require_count("count", count)
    if supports == "pinned-pinned":
        return np.pi * np.arange(1, count + 1)
    equations: dict[str, tuple[Callable[[float], float], int]] = {
        "fixed-free": (lambda x: np.cos(x) + _sech(x), 0),
        "fixed-fixed": (lambda x: np.cos(x) - _sech(x), 1),
        "free-free": (lambda x: np.cos(x) - _sech(x), 1),
        "fixed-pinned": (lambda x: np.sin(x) - np.tanh(x) * np.cos(x), 1),
    }
    if supports not in equations:
        raise InputError("must be one of " + ", ".join(get_args(Supports)), field="supports", value=supports)
    equation, first = equations[supports]
    return np.array(
        [brentq(equation, n * np.pi, (n + 1) * np.pi, xtol=1e-14) for n in range(first, first + count)]
    )


def _sech(x: float) -> float:
    return float(2.0 * np.exp(-x) / (1.0 + np.exp(-2.0 * x)))


def euler_bernoulli_frequencies(
    length: float,
    bending_stiffness: float,
    mass_per_length: float,
    count: int,
    supports: Supports = "pinned-pinned",
) -> FloatArray:
    """Angular frequencies of a thin beam, shape (mode,) [rad/s].

    Parameters
    ----------
    length : float
        [m].
    bending_stiffness : float
        E I [N m2].
    mass_per_length : float
        [kg/m].
    count : int
        Number of frequencies.
    supports : str, optional
        Left and right end.
    """
    require_positive("length", length)
    require_positive("bending_stiffness", bending_stiffness)
    require_positive("mass_per_length", mass_per_length)
    roots = euler_bernoulli_roots(count, supports) / length
    return roots**2 * float(np.sqrt(bending_stiffness / mass_per_length))


def timoshenko_frequencies(
    length: float,
    bending_stiffness: float,
    shear_stiffness: float,
    mass_per_length: float,
    rotary_inertia: float,
    count: int,
) -> FloatArray:
    """Angular frequencies of a simply supported Timoshenko beam, bending branch, shape (mode,) [rad/s].

    The smaller root of the quadratic in omega squared that ``sin(n pi x / L)`` leaves: theory, (R24).

    Parameters
    ----------
    length : float
        [m].
    bending_stiffness : float
        E I [N m2].
    shear_stiffness : float
        kappa G A [N].
    mass_per_length : float
        rho A [kg/m].
    rotary_inertia : float
        rho I per length [kg m].
    count : int
        Number of frequencies.

    Examples
    --------
    A steel bar of 0.5 m x 1.0 m over 10 m:

    >>> stiffness, shear = 210e9 * 0.5 / 12, 5 / 6 * 210e9 / 2.6 * 0.5
    >>> frequencies = timoshenko_frequencies(10.0, stiffness, shear, 7850 * 0.5, 7850 * 0.5 / 12, 3)
    >>> (frequencies / (2 * np.pi)).round(3).tolist()
    [23.068, 88.152, 185.72]
    """
    for field, value in (
        ("length", length),
        ("bending_stiffness", bending_stiffness),
        ("shear_stiffness", shear_stiffness),
        ("mass_per_length", mass_per_length),
        ("rotary_inertia", rotary_inertia),
    ):
        require_positive(field, value)
    require_count("count", count)
    k2 = (np.arange(1, count + 1) * np.pi / length) ** 2
    quadratic = rotary_inertia * mass_per_length / shear_stiffness
    linear = mass_per_length + k2 * (rotary_inertia + bending_stiffness * mass_per_length / shear_stiffness)
    constant = bending_stiffness * k2**2
    # 2 c / (b + sqrt(...)) keeps the digits that b - sqrt(...) loses
    return np.sqrt(2.0 * constant / (linear + np.sqrt(linear**2 - 4.0 * quadratic * constant)))
