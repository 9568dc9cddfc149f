"""Spectra of the French railways: good and poor track."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from axlespan.irregularity.checks import Array, require_choice
from axlespan.irregularity.spectra.base import FOUND, Spectrum

__all__ = ["sncf"]

_A = {"good": 308e-6 * 0.509, "poor": 308e-6 * 1.790}  # [m²/(1/m)]
_CORNER = 0.0489  # n0 [1/m], 0.307 rad/m


@dataclass(frozen=True)
class _Cubic:
    """A / (1 + n/n0)³."""

    a: float

    def __call__(self, n: Array) -> Array:
        return self.a / (1.0 + n / _CORNER) ** 3


def sncf(track: Literal["good", "poor"]) -> Spectrum:
    """Return an SNCF spectrum of the vertical profile.

    Parameters
    ----------
    track : {"good", "poor"}
        State of the track.
    """
    require_choice(track, _A, "track")
    return Spectrum(
        name=f"sncf-{track}",
        density=_Cubic(_A[track]),
        wavelengths=(2.0, 40.0),
        argument="cycles/m",
        source="Frýba, Dynamics of Railway Bridges (1996); coefficients as in TTB-2D",
        status=FOUND,
        note="A is taken per cycle/m as in TTB-2D; read per rad/m, the density would be 2π times as large",
    )
