"""Spectra of the German railways for low and high disturbance (ERRI B176)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from axlespan.irregularity.checks import Array, require_choice
from axlespan.irregularity.spectra.base import FOUND, QUANTITIES, Quantity, Spectrum

__all__ = ["german"]

_OMEGA_C, _OMEGA_R, _OMEGA_S = 0.8246, 0.0206, 0.4380  # [rad/m]
_HALF_BASE = 0.75  # b [m]
# A [m² rad/m]
_A = {
    "low": {"vertical": 4.032e-7, "alignment": 2.119e-7, "cross level": 4.032e-7, "gauge": 5.32e-8},
    "high": {"vertical": 10.80e-7, "alignment": 6.125e-7, "cross level": 10.80e-7, "gauge": 1.032e-7},
}


@dataclass(frozen=True)
class _Level:
    """A Ωc² / ((Ω² + Ωr²)(Ω² + Ωc²))."""

    a: float

    def __call__(self, omega: Array) -> Array:
        return self.a * _OMEGA_C**2 / ((omega**2 + _OMEGA_R**2) * (omega**2 + _OMEGA_C**2))


@dataclass(frozen=True)
class _Difference:
    """A Ωc² Ω² / ((Ω² + Ωr²)(Ω² + Ωc²)(Ω² + Ωs²))."""

    a: float

    def __call__(self, omega: Array) -> Array:
        return _Level(self.a)(omega) * omega**2 / (omega**2 + _OMEGA_S**2)


def german(disturbance: Literal["low", "high"], quantity: Quantity = "vertical") -> Spectrum:
    """Return a German spectrum, in rad/m.

    The cross level is the spectrum of an *angle* [rad²/(rad/m)]: A_v b⁻² with b = 0.75 m;
    `Spectrum.as_height` turns it into the height difference between the rails.

    Parameters
    ----------
    disturbance : {"low", "high"}
        Low is meant for 250 km/h and more.
    quantity : {"vertical", "alignment", "cross level", "gauge"}
        What varies.
    """
    require_choice(disturbance, _A, "disturbance")
    require_choice(quantity, QUANTITIES, "quantity")
    a = _A[disturbance][quantity]
    angle = quantity == "cross level"
    density = (
        _Level(a) if quantity in ("vertical", "alignment") else _Difference(a / _HALF_BASE**2 if angle else a)
    )
    return Spectrum(
        name=f"german-{disturbance}",
        density=density,
        wavelengths=(3.0, 150.0),
        quantity=quantity,
        argument="rad/m",
        amplitude_unit="rad" if angle else "m",
        source="ERRI B176, after Claus & Schiehlen (1998); as in TTB-2D and two other public codes",
        status=FOUND,
        note="sides not stated in the source, taken as one-sided; others use it from 0.5 m to 80 m",
    )
