"""Random profiles of the two rails of a track."""

from __future__ import annotations

from dataclasses import dataclass

from axlespan.errors import InputError
from axlespan.irregularity.composition import Scaled, Sum
from axlespan.irregularity.profile import Profile
from axlespan.irregularity.realization import Method, Realization, realize
from axlespan.irregularity.spectra.base import Spectrum
from axlespan.irregularity.spectra.registry import spectrum as named_spectrum

__all__ = ["RailPair", "realize_pair"]


@dataclass(frozen=True)
class RailPair:
    """Profiles of the two rails, from the level of the track and its cross level.

    left = level - cross_level/2, right = level + cross_level/2: a positive cross level lifts the right rail,
    which is a rotation -cross_level/base about x.
    """

    left: Profile
    right: Profile
    level: Realization
    cross_level: Realization


def realize_pair(
    vertical: Spectrum | str,
    length: float,
    *,
    seed: int,
    cross_level: Spectrum | None = None,
    wavelengths: tuple[float, float] | None = None,
    method: Method = "cosines",
    spacing: float | None = None,
    base: float = 1.5,
) -> RailPair:
    """Return random profiles of the two rails, correlated through the track's level and cross level.

    Level and cross level are independent; the level is the one that `realize` gives for the same seed.

    Parameters
    ----------
    vertical : Spectrum or str
        Spectrum of the level, or the name of a family that has a vertical and a cross level spectrum.
    length : float
        Length without repetition [m].
    seed : int
        Seed.
    cross_level : Spectrum, optional
        Spectrum of the cross level, a height difference or an angle; that of the family when a name is given.
    wavelengths, method, spacing : optional
        As for `realize` [m]; the common range of both spectra when wavelengths is left out.
    base : float
        Distance of the contact points [m] that turns an angle into a height difference.

    Raises
    ------
    InputError
        If a value is out of range, or a spectrum is not of the quantity that is asked for.
    """
    if cross_level is None:
        if not isinstance(vertical, str):
            raise InputError(
                "is needed beside a spectrum that isn't given by name", field="cross_level", value=None
            )
        cross_level = named_spectrum(vertical, "cross level")
    level = named_spectrum(vertical) if isinstance(vertical, str) else vertical
    cross = cross_level.as_height(base) if cross_level.amplitude_unit == "rad" else cross_level
    if wavelengths is None:
        bands = (level.wavelengths, cross.wavelengths)
        wavelengths = (max(b[0] for b in bands), min(b[1] for b in bands))
    both = [
        realize(s, length, seed=entropy, wavelengths=wavelengths, method=method, spacing=spacing)
        for s, entropy in ((level, seed), (cross, (seed, 1)))
    ]
    left, right = (Sum((both[0], Scaled(both[1], half))) for half in (-0.5, 0.5))
    return RailPair(left, right, *both)
