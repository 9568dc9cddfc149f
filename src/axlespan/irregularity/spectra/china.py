"""Chinese spectra: ballastless track of high-speed lines, ballasted trunk lines, short waves on the rail."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from axlespan.errors import InputError
from axlespan.irregularity.checks import Array, require_choice
from axlespan.irregularity.spectra.base import FOUND, FROM_MEMORY, QUANTITIES, Quantity, Spectrum

__all__ = ["china_ballastless", "china_short_wave", "china_trunk"]

_MM2 = 1e-6  # [m²/mm²]

# Break points f [1/m], A [mm² (1/m)^(n-1)] and n of the pieces between them, from long waves to short.
_BALLASTLESS = {
    "vertical": (
        (0.0187, 0.0474, 0.1533),
        (1.0544e-5, 3.5588e-3, 1.9784e-2, 3.9488e-4),
        (3.3891, 1.9271, 1.3643, 3.4516),
    ),
    "alignment": ((0.0450, 0.1234), (3.9513e-3, 1.1047e-2, 7.5633e-4), (1.8670, 1.5354, 2.8171)),
    "cross level": ((0.0258, 0.1163), (3.6148e-3, 4.3685e-2, 4.5867e-3), (1.7278, 1.0461, 2.0939)),
    "gauge": ((0.1090, 0.2938), (5.4978e-2, 5.0701e-3, 1.8778e-4), (0.8282, 1.9037, 4.5948)),
}


@dataclass(frozen=True)
class _Pieces:
    """A / fⁿ [mm²/(1/m)], with A and n by pieces of f."""

    breaks: tuple[float, ...]
    a: tuple[float, ...]
    exponents: tuple[float, ...]

    def __call__(self, f: Array) -> Array:
        i = np.searchsorted(self.breaks, f, side="right")
        return np.asarray(_MM2 * np.asarray(self.a)[i] / f ** np.asarray(self.exponents)[i])


def china_ballastless(quantity: Quantity = "vertical", *, percentile: float | None = None) -> Spectrum:
    """Return the spectrum of ballastless high-speed track (TB/T 3352-2014).

    Parameters
    ----------
    quantity : {"vertical", "alignment", "cross level", "gauge"}
        What varies.
    percentile : float, optional
        Share of the line, between 0 and 1, whose density lies below the one returned; the mean when left out.
        The density at one frequency is taken as chi-square distributed with two degrees of freedom, so the
        factor on the mean is -ln(1 - percentile): 0.693 for 50 %, 2.303 for 90 % (from memory).

    Raises
    ------
    InputError
        If there is no such quantity, or the percentile is not between 0 and 1.
    """
    require_choice(quantity, QUANTITIES, "quantity")
    mean = Spectrum(
        name="china-ballastless",
        density=_Pieces(*_BALLASTLESS[quantity]),
        wavelengths=(2.0, 200.0),
        quantity=quantity,
        argument="cycles/m",
        source="TB/T 3352-2014; coefficients as in three public codes, one of them JBG_SDITT",
        status=FOUND,
    )
    if percentile is None:
        return mean
    if not 0.0 < percentile < 1.0:
        raise InputError(
            "must lie between 0 and 1", field="percentile", value=percentile, fix="Write 0.9 for 90 %"
        )
    scaled = mean.scaled(-math.log1p(-percentile))
    note = f"{scaled.note}: the {100.0 * percentile:g} % percentile"
    return Spectrum(
        name=f"{mean.name} {100.0 * percentile:g} %",
        density=scaled.density,
        wavelengths=mean.wavelengths,
        quantity=quantity,
        source=mean.source,
        status=FROM_MEMORY,
        note=note,
    )


# A to G for f in 1/m and S in mm²/(1/m)
_TRUNK = {
    ("vertical", "left"): (1.1029, -1.4709, 0.5941, 0.8480, 3.8016, -0.2500, 0.0112),
    ("vertical", "right"): (0.8581, -1.4607, 0.5848, 0.0407, 2.8428, -0.1989, 0.0094),
    ("alignment", "left"): (0.2244, -1.5746, 0.6683, -2.1466, 1.7665, -0.1506, 0.0052),
    ("alignment", "right"): (0.3743, -1.5894, 0.7265, 0.4353, 0.9101, -0.0270, 0.0031),
    ("cross level", "left"): (0.1214, -2.1603, 2.0214, 4.5089, 2.2227, -0.0396, 0.0073),
    ("cross level", "right"): (0.1214, -2.1603, 2.0214, 4.5089, 2.2227, -0.0396, 0.0073),
}


@dataclass(frozen=True)
class _Rational:
    """A (f² + B f + C) / (f⁴ + D f³ + E f² + F f + G) [mm²/(1/m)]."""

    coefficients: tuple[float, ...]

    def __call__(self, f: Array) -> Array:
        a, b, c, d, e, ff, g = self.coefficients
        return _MM2 * a * (f * f + b * f + c) / ((((f + d) * f + e) * f + ff) * f + g)


def china_trunk(rail: Literal["left", "right"], quantity: Quantity = "vertical") -> Spectrum:
    """Return the spectrum of ballasted Chinese trunk lines (160 to 200 km/h).

    Parameters
    ----------
    rail : {"left", "right"}
        The rail; it makes no difference for the cross level.
    quantity : {"vertical", "alignment", "cross level"}
        What varies.
    """
    require_choice(rail, ("left", "right"), "rail")
    require_choice(quantity, ("vertical", "alignment", "cross level"), "quantity")
    return Spectrum(
        name=f"china-trunk-{rail}",
        density=_Rational(_TRUNK[quantity, rail]),
        wavelengths=(1.0, 150.0),
        quantity=quantity,
        argument="cycles/m",
        source="spectra of the Chinese trunk lines; coefficients as in a public code",
        status=FOUND,
        note="the source states no range of wavelengths: 1 m to 150 m is assumed",
    )


@dataclass(frozen=True)
class _ShortWave:
    """0.036 f^-3.15 [mm²/(1/m)]."""

    def __call__(self, f: Array) -> Array:
        return np.asarray(_MM2 * 0.036 * f**-3.15)


def china_short_wave() -> Spectrum:
    """Return the spectrum of vertical short waves on the rail, 0.01 m to 1 m, beside one of long waves."""
    return Spectrum(
        name="china-short-wave",
        density=_ShortWave(),
        wavelengths=(0.01, 1.0),
        argument="cycles/m",
        source="short-wave spectrum of Chinese track; coefficients as in a public code",
        status=FOUND,
    )
