"""Spectra of the Federal Railroad Administration for track classes 1 (worst) to 6 (best), old and new.

The two families differ by a lot for the same class number: say which one a result was computed with.
"""

from __future__ import annotations

from dataclasses import dataclass

from axlespan.errors import InputError
from axlespan.irregularity.checks import Array, require_choice
from axlespan.irregularity.spectra.base import FOUND, FROM_MEMORY, QUANTITIES, Quantity, Spectrum

__all__ = ["fra", "fra_new"]

# 5 ft to 1000 ft
_WAVELENGTHS = (1.524, 304.8)

# A [1e-8 m], classes 1 to 6. Vertical: Frýba. The others: published per ft² and divided by 10.764 ft²/m²; the
# same conversion reproduces Frýba's vertical classes 1 to 4 to the digit and gives 1.5535 and 0.885 for 5 and
# 6.
_OLD = {
    "vertical": (15.53, 8.85, 4.92, 2.75, 1.57, 0.98),
    "alignment": (9.832, 5.506, 3.146, 1.750, 0.983, 0.551),
    "cross level": (4.523, 3.146, 2.163, 1.455, 0.983, 0.669),
    "gauge": (9.832, 5.506, 3.146, 1.750, 0.983, 0.551),
}
# n1, n2 [1/m]; Frýba rounds the vertical n2, elsewhere 0.1312, to three digits.
_OLD_CORNERS = {
    "vertical": (0.0233, 0.131),
    "alignment": (0.0328, 0.1837),
    "cross level": (0.0233, 0.1312),
    "gauge": (0.0292, 0.2329),
}


@dataclass(frozen=True)
class _OldLevel:
    """A n2² (n² + n1²) / (n⁴ (n² + n2²))."""

    a: float
    n1: float
    n2: float

    def __call__(self, n: Array) -> Array:
        return self.a * self.n2**2 * (n**2 + self.n1**2) / (n**4 * (n**2 + self.n2**2))


@dataclass(frozen=True)
class _OldDifference:
    """A n2² / ((n² + n1²)(n² + n2²))."""

    a: float
    n1: float
    n2: float

    def __call__(self, n: Array) -> Array:
        return self.a * self.n2**2 / ((n**2 + self.n1**2) * (n**2 + self.n2**2))


def fra(track_class: int, quantity: Quantity = "vertical") -> Spectrum:
    """Return a spectrum of the old FRA family, in cycles/m (Hamid et al. 1983; Frýba 1996).

    Parameters
    ----------
    track_class : int
        1 (worst) to 6 (best).
    quantity : {"vertical", "alignment", "cross level", "gauge"}
        What varies.
    """
    _require_class(track_class)
    require_choice(quantity, QUANTITIES, "quantity")
    form = _OldLevel if quantity in ("vertical", "alignment") else _OldDifference
    note = "sides not stated in the source, taken as one-sided"
    if quantity == "vertical" and track_class >= 5:
        note += (
            f"; {'1.5535' if track_class == 5 else '0.885'}e-8 m by conversion from ft², Frýba prints this A"
        )
    return Spectrum(
        name=f"fra-{track_class}",
        density=form(1e-8 * _OLD[quantity][track_class - 1], *_OLD_CORNERS[quantity]),
        wavelengths=_WAVELENGTHS,
        quantity=quantity,
        argument="cycles/m",
        source="Frýba, Dynamics of Railway Bridges (1996), after Hamid et al. (1983); as in TTB-2D",
        status=FOUND,
        note=note,
    )


_K, _OMEGA_C = 0.25, 0.8245
_A_V = (1.2107, 1.0181, 0.6816, 0.5376, 0.2095, 0.0339)  # [cm² rad/m]
_A_A = (3.3634, 1.2107, 0.4128, 0.3027, 0.0762, 0.0339)  # [cm² rad/m], from memory
_OMEGA_S = (0.6046, 0.9308, 0.8520, 1.1312, 0.8209, 0.4380)  # [rad/m], from memory but for class 6


@dataclass(frozen=True)
class _NewLevel:
    """k A Ωc² / (Ω² (Ω² + Ωc²))."""

    a: float

    def __call__(self, omega: Array) -> Array:
        return _K * self.a * _OMEGA_C**2 / (omega**2 * (omega**2 + _OMEGA_C**2))


@dataclass(frozen=True)
class _NewDifference:
    """4 k A Ωc² / ((Ω² + Ωc²)(Ω² + Ωs²))."""

    a: float
    omega_s: float

    def __call__(self, omega: Array) -> Array:
        return 4.0 * _K * self.a * _OMEGA_C**2 / ((omega**2 + _OMEGA_C**2) * (omega**2 + self.omega_s**2))


def fra_new(track_class: int, quantity: Quantity = "vertical") -> Spectrum:
    """Return a spectrum of the new FRA family, in rad/m.

    Parameters
    ----------
    track_class : int
        1 (worst) to 6 (best); speeds of freight/passenger trains 16/24, 40/48, 64/97, 97/129, 129/145,
        177/177 km/h (from memory).
    quantity : {"vertical", "alignment", "cross level", "gauge"}
        What varies.
    """
    _require_class(track_class)
    require_choice(quantity, QUANTITIES, "quantity")
    i = track_class - 1
    difference = quantity in ("cross level", "gauge")
    a = 1e-4 * (_A_A if quantity == "alignment" else _A_V)[i]
    remembered = quantity == "alignment" or (difference and track_class != 6)
    return Spectrum(
        name=f"fra-new-{track_class}",
        density=_NewDifference(a, _OMEGA_S[i]) if difference else _NewLevel(a),
        wavelengths=_WAVELENGTHS,
        quantity=quantity,
        argument="rad/m",
        source="FRA track classes after Garg & Dukkipati (1984); A_v as in TTB-2D and two other public codes",
        status=FROM_MEMORY if remembered else FOUND,
        note="sides not stated in the source, taken as one-sided",
    )


def _require_class(track_class: int) -> None:
    if track_class not in range(1, 7):
        raise InputError("must be a whole number from 1 to 6", field="track_class", value=track_class)
