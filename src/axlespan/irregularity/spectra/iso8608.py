"""Spectra of road surfaces by ISO 8608, classes A (best) to H (worst)."""

from __future__ import annotations

from dataclasses import dataclass

from axlespan.errors import InputError
from axlespan.irregularity.checks import Array, require_choice, require_positive
from axlespan.irregularity.spectra.base import FROM_MEMORY, Spectrum

__all__ = ["iso8608", "iso8608_class"]

_N0 = 0.1  # reference frequency [1/m]
_CLASSES = "abcdefgh"


@dataclass(frozen=True)
class _Power:
    """Gd(n0) (n/n0)^-w."""

    gd: float
    waviness: float

    def __call__(self, n: Array) -> Array:
        return self.gd * (n / _N0) ** -self.waviness


def iso8608(road_class: str, *, waviness: float = 2.0) -> Spectrum:
    """Return the spectrum in the middle of a road class.

    Gd(n0) is the geometric mean of the class limits: 16e-6 m³ for A and four times as much for each class
    after it.

    Parameters
    ----------
    road_class : str
        "A" to "H".
    waviness : float
        Exponent w; ISO 8608 classifies with 2.
    """
    require_choice(road_class.lower(), _CLASSES, "road_class")
    require_positive(waviness=waviness)
    return Spectrum(
        name=f"iso8608-{road_class.lower()}",
        density=_Power(16e-6 * 4.0 ** _CLASSES.index(road_class.lower()), waviness),
        wavelengths=(0.1, 100.0),
        argument="cycles/m",
        source="ISO 8608:2016, annex C",
        status=FROM_MEMORY,
        note="0.01 to 10 cycles/m as recommended for road vehicles; classes are fitted from 0.011 to 2.83",
    )


def iso8608_class(gd: float) -> str:
    """Return the class, "A" to "H", of a road with the displacement density gd = Gd(0.1 cycles/m) [m³].

    The limits between the classes are 32, 128, 512, … 131072 · 1e-6 m³.

    Parameters
    ----------
    gd : float
        Gd(0.1 cycles/m) [m³].

    Raises
    ------
    InputError
        If it is not positive.
    """
    require_positive(gd=gd)
    for i, name in enumerate(_CLASSES[:-1]):
        if gd < 32e-6 * 4.0**i:
            return name.upper()
    if gd < 32e-6 * 4.0**7:
        return "H"
    raise InputError(
        "is rougher than class H", field="gd", value=gd, fix="Check the unit: Gd(n0) in m³, not 1e-6 m³"
    )
