"""The spectrum of a given profile, estimated by Welch's method."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.signal import detrend, welch

from axlespan.errors import InputError
from axlespan.irregularity.bands import band_of
from axlespan.irregularity.checks import Array, column, require_positive
from axlespan.irregularity.spectra.base import Spectrum, tabulated

__all__ = ["PsdEstimate", "estimate_psd"]


@dataclass(frozen=True, eq=False)
class PsdEstimate:
    """An estimated density at equally spaced frequencies.

    Parameters
    ----------
    n : array, (n_frequency,)
        Frequencies from 0 to the Nyquist frequency [1/m], in cycles per meter.
    psd : array, (n_frequency,)
        One-sided S(n) [m²/(1/m)].
    segments : int
        Number of overlapping segments that were averaged; the random error of one value is about 1/√segments.
    """

    n: Array
    psd: Array
    segments: int

    def standard_deviation(self, band: str | tuple[float, float]) -> float:
        """Return the standard deviation [m] in a band: "D1", … or (shortest, longest) wavelength [m]."""
        shortest, longest = band_of(band)
        # Each density stands for the frequencies up to halfway to its neighbors.
        step = self.n[1]
        low = np.maximum(self.n - 0.5 * step, 1.0 / longest)
        high = np.minimum(self.n + 0.5 * step, 1.0 / shortest)
        return float(np.sqrt(np.sum(self.psd * np.maximum(high - low, 0.0))))

    def as_spectrum(self, name: str, wavelengths: tuple[float, float] | None = None) -> Spectrum:
        """Return the estimate as a spectrum to realize, within wavelengths [m] or all but the mean.

        Raises
        ------
        InputError
            If they hold fewer than two frequencies of the estimate.
        """
        keep = self.n > 0.0
        if wavelengths is not None:
            shortest, longest = band_of(wavelengths)
            keep &= (self.n * longest >= 1.0 - 1e-9) & (self.n * shortest <= 1.0 + 1e-9)
        if keep.sum() < 2:
            raise InputError("holds fewer than two frequencies", field="wavelengths", value=wavelengths)
        return tabulated(name, self.n[keep], self.psd[keep], source="estimated from a profile")


def estimate_psd(values: ArrayLike, spacing: float, *, segment: float | None = None) -> PsdEstimate:
    """Estimate the one-sided density of a profile by Welch's method: half overlapping Hann windows.

    Parameters
    ----------
    values : array_like, (n,)
        Heights [m] at equal distances.
    spacing : float
        Their distance [m].
    segment : float, optional
        Length of a segment [m]; an eighth of the profile when left out. Take several of the longest waves of
        interest.

    Raises
    ------
    InputError
        When the values have gaps or a segment has fewer than 8 of them.
    """
    values = column(values, "values", at_least=8)
    require_positive(spacing=spacing)
    length = values.size * spacing
    if segment is None:
        segment = length / 8.0
    points = round(segment / spacing)
    if not 8 <= points <= values.size:
        raise InputError(
            f"must hold at least 8 values and at most the profile's length, {length:g} m",
            field="segment",
            value=segment,
        )
    n, psd = welch(
        values, fs=1.0 / spacing, window="hann", nperseg=points, noverlap=points // 2, detrend=detrend
    )
    segments = 1 + (values.size - points) // (points - points // 2)
    return PsdEstimate(np.asarray(n, dtype=np.float64), np.asarray(psd, dtype=np.float64), segments)
