"""Measured profiles: reading, checking, detrending, filtering into bands, resampling."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike
from scipy.signal import butter, sosfiltfilt

from axlespan.errors import InputError, Place
from axlespan.irregularity.bands import EN13848_BANDS, band_of
from axlespan.irregularity.checks import Array, column, require_finite, require_increasing, require_positive
from axlespan.irregularity.columns import read_columns
from axlespan.irregularity.estimate import PsdEstimate, estimate_psd
from axlespan.irregularity.spline import Spline
from axlespan.irregularity.table import Table

__all__ = ["Measurement"]

# Share of the spacing by which a position may miss its place on the regular grid: files print rounded
# positions.
_TOLERANCE = 0.05
# Low-pass before thinning out: cut-off as a share of the new sampling frequency.
_THINNING = 0.4


@dataclass(frozen=True, eq=False)
class Measurement:
    """A measured profile: heights at equal distances. Every operation returns a new one.

    Parameters
    ----------
    values : array_like, (n,)
        Heights [m], without gaps.
    spacing : float
        Distance of the samples [m].
    start : float
        Position of the first sample [m].
    """

    values: Array
    spacing: float
    start: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", column(self.values, "values"))
        require_positive(spacing=self.spacing)
        require_finite(start=self.start)

    @classmethod
    def from_points(cls, x: ArrayLike, r: ArrayLike) -> Measurement:
        """Return the measurement of equally spaced points without gaps: positions [m] and heights [m].

        Raises
        ------
        InputError
            Where a value is missing (NaN), a position doesn't increase, or the spacing isn't uniform.
        """
        x, r = column(x, "x"), column(r, "r")
        if x.size != r.size:
            raise InputError(f"must have as many entries as x, {x.size}", field="r", value=r.size)
        require_increasing(x)
        bad = _first_off_grid(x)
        if bad is not None:
            raise InputError(
                f"is off the regular grid: the step from {x[bad - 1]:g} m is {x[bad] - x[bad - 1]:g} m, "
                f"the usual one {np.median(np.diff(x)):g} m",
                field=f"x[{bad}]",
                value=float(x[bad]),
                fix="Cut the record in two, or interpolate: Measurement.interpolated(x, r, spacing)",
            )
        return cls(r, float(x[-1] - x[0]) / (x.size - 1), float(x[0]))

    @classmethod
    def from_csv(
        cls, path: str | Path, *, columns: tuple[int | str, int | str] = (0, 1), scale: float | None = None
    ) -> Measurement:
        """Read a measurement from a text file with two columns, x and r.

        Parameters
        ----------
        path : str or Path
            The file: fields separated by commas, semicolons, tabs or blanks, with or without a header.
        columns : tuple
            Positions and heights: numbers of columns (from 0) or names in the header.
        scale : float, optional
            Factor from the file's heights to meters, 1e-3 for a file in millimeters; by the unit in its header,
            ``x [m]; r [mm]``, when left out, else 1.
        """
        require_finite(scale=scale)
        x, r, lines = read_columns(path, columns, scale)
        finite = np.isfinite(x) & np.isfinite(r)
        try:
            return cls.from_points(x, r)
        except InputError as error:
            bad: int | None = None
            if not finite.all():
                bad = int(np.argmin(finite))
            elif x.size > 1:
                down = np.flatnonzero(np.diff(x) <= 0.0)
                bad = int(down[0]) + 1 if down.size else _first_off_grid(x)
            raise error.located(Place(str(path), None if bad is None else lines[bad])) from None

    @classmethod
    def interpolated(cls, x: ArrayLike, r: ArrayLike, spacing: float) -> Measurement:
        """Return a measurement at equal distances from points at unequal ones, by a natural cubic spline.

        Parameters
        ----------
        x, r : array (n,)
            Positions, increasing, and heights [m].
        spacing : float
            Of the new points [m].
        """
        require_positive(spacing=spacing)
        spline = Spline(np.asarray(x, dtype=np.float64), np.asarray(r, dtype=np.float64))
        count = math.floor((spline.x[-1] - spline.x[0]) / spacing * (1.0 + 1e-12)) + 1
        start = float(spline.x[0])
        # The last grid point may pass the last given one by rounding, where the spline is zero.
        grid = np.minimum(start + spacing * np.arange(count), spline.x[-1])
        return cls(spline.value(grid), spacing, start)

    @property
    def x(self) -> Array:
        """Positions of the samples [m], (n,)."""
        return np.asarray(self.start + self.spacing * np.arange(self.values.size), dtype=np.float64)

    @property
    def length(self) -> float:
        """Distance from the first sample to the last [m]."""
        return self.spacing * (self.values.size - 1)

    def detrended(self, degree: int = 1) -> Measurement:
        """Return the profile without its least-squares polynomial: 0 the mean, 1 a line, 2 a curve.

        Raises
        ------
        InputError
            If the degree is not a whole number from 0 to 10.
        """
        if degree not in range(0, 11):
            raise InputError("must be a whole number from 0 to 10", field="degree", value=degree)
        u = np.linspace(-1.0, 1.0, self.values.size)
        basis = np.polynomial.legendre.legvander(u, degree)
        trend = basis @ np.linalg.lstsq(basis, self.values, rcond=None)[0]
        return replace(self, values=self.values - trend)

    def filtered(self, band: str | tuple[float, float], *, order: int = 2) -> Measurement:
        """Return the wavelengths of a band, without shift in phase.

        A Butterworth band-pass runs forward and backward. Its corners are moved so that both runs together
        pass half the power (-3 dB) at the ends of the band; the flanks then are those of twice the order,
        four by default.

        Parameters
        ----------
        band : str or tuple of float
            "D1", "D2", "D3" (EN 13848-1), or (shortest, longest) wavelength [m].
        order : int
            Order of one run.

        Raises
        ------
        InputError
            When the profile is shorter than twice the longest wavelength, or sampled too coarsely for the
            shortest.
        """
        shortest, longest = band_of(band)
        if order not in range(1, 9):
            raise InputError("must be a whole number from 1 to 8", field="order", value=order)
        if self.spacing > shortest / 2.5:
            raise InputError(
                f"is too coarse for wavelengths of {shortest:g} m",
                field="spacing",
                value=self.spacing,
                fix=f"Take at most {shortest / 2.5:g} m, or a band of longer waves",
            )
        if self.length < 2.0 * longest:
            raise InputError(
                f"is too short for wavelengths of {longest:g} m: at least twice that is needed",
                field="length",
                value=self.length,
            )
        sos = butter(order, _corners(shortest, longest, self.spacing, order), "bandpass", output="sos")
        pad = min(self.values.size - 1, round(2.0 * longest / self.spacing))
        return replace(self, values=sosfiltfilt(sos, self.values, padlen=pad))

    def resampled(self, spacing: float) -> Measurement:
        """Return the profile at another spacing [m], by a cubic spline.

        Before thinning out, waves that the new samples can't carry are taken away by a zero-phase low-pass
        with its corner at 0.4 of the new sampling frequency.

        Raises
        ------
        InputError
            If the spacing is not positive, or too coarse for the length.
        """
        require_positive(spacing=spacing)
        values = self.values
        if spacing > self.spacing:
            if self.length < 20.0 * spacing:
                raise InputError(
                    f"is too coarse for a profile of {self.length:g} m; at least 20 steps are needed",
                    field="spacing",
                    value=spacing,
                )
            corner = min(2.0 * _THINNING * self.spacing / spacing, 0.95)
            pad = min(values.size - 1, round(20.0 * spacing / self.spacing))
            values = sosfiltfilt(butter(4, corner, output="sos"), values, padlen=pad)
        return Measurement.interpolated(self.x, values, spacing)

    def standard_deviations(self) -> dict[str, float]:
        """Return the standard deviation [m] in those bands of EN 13848-1 that the profile resolves."""
        fits = {
            name: band
            for name, band in EN13848_BANDS.items()
            if self.length >= 2.0 * band[1] and self.spacing <= band[0] / 2.5
        }
        return {name: float(np.std(self.filtered(band).values)) for name, band in fits.items()}

    def psd(self, segment: float | None = None) -> PsdEstimate:
        """Return the density estimated by Welch's method; see `estimate_psd`.

        Parameters
        ----------
        segment : float, optional
            Length of the segments [m].
        """
        return estimate_psd(self.values, self.spacing, segment=segment)

    def table(self) -> Table:
        """Return the profile that is linear between the samples; its ends go on."""
        return Table(self.x, self.values)

    def spline(self) -> Spline:
        """Return the profile that is a cubic spline through the samples; its ends go on."""
        return Spline(self.x, self.values)


def _first_off_grid(x: Array) -> int | None:
    """Index behind the first step that differs too much from the usual one."""
    steps = np.diff(x)
    usual = np.median(steps)
    bad = np.flatnonzero(np.abs(steps - usual) > _TOLERANCE * usual)
    return int(bad[0]) + 1 if bad.size else None


def _corners(shortest: float, longest: float, spacing: float, order: int) -> list[float]:
    """Corners of one run, as shares of the Nyquist frequency, for half the power at the ends after two.

    With w = tan(π n h), |H|² = 1 / (1 + ((w² - w1 w2) / (B w))^(2N)): it is 1/√2 at w1 and w2 for
    B = (w2 - w1) / (√2 - 1)^(1/(2N)).
    """
    w1, w2 = (math.tan(math.pi * spacing / wavelength) for wavelength in (longest, shortest))
    half_width = 0.5 * (w2 - w1) / (math.sqrt(2.0) - 1.0) ** (0.5 / order)
    middle = math.hypot(half_width, math.sqrt(w1 * w2))
    return [2.0 / math.pi * math.atan(w) for w in (middle - half_width, middle + half_width)]
