"""Random profiles with a given spectrum: a sum of cosines with random phases, tabulated by FFT."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from axlespan.compiled import numba_is_there
from axlespan.errors import InputError
from axlespan.irregularity.checks import Array, require_band, require_choice, require_positive
from axlespan.irregularity.hermite import quintic
from axlespan.irregularity.profile import CosineSum
from axlespan.irregularity.spectra.base import Spectrum
from axlespan.irregularity.spectra.registry import spectrum as named_spectrum

__all__ = ["Method", "Realization", "realize"]

Method: TypeAlias = Literal["cosines", "fft"]

# Table points per shortest wavelength, the fewest allowed and the default.
_FEWEST, _DEFAULT = 8, 32
# The longest wave fits at least so often into the period, so that its density is resolved.
_LONG_WAVES = 4
# Below this number of terms a sum of cosines is visibly not Gaussian.
_FEWEST_TERMS = 128
_LARGEST_TABLE = 1 << 23
# Points that are interpolated at once; keeps the temporaries in cache.
_BLOCK = 1 << 16
# So many positions at a time are worth machine code.
_MANY = 256


@dataclass(frozen=True)
class Realization:
    """A random profile r = Σ a_k cos(2π n_k x + φ_k) with the density of a spectrum.

    a_k²/2 is the variance of the spectrum between the edges of bin k, so the variance of the sum is exactly
    that of the band; the phases are uniform in [0, 2π), from PCG64 with the seed. The frequencies are Δn
    apart, where Δn <= 1/length and 1/Δn holds at least four of the longest waves. With method "cosines" n_k
    is the middle of its bin and the profile is r(x + 1/Δn) = -r(x); with "fft" n_k is a multiple of Δn and
    r(x + 1/Δn) = r(x), as of the samples that an inverse FFT gives. Both are defined for all x.

    r, its slope and its curvature are computed on a grid by FFT, to rounding, and interpolated with
    polynomials of degree five that match all three. A wave of amplitude a is met within a (2π h/λ)⁶/46080 at
    the grid spacing h: 1e-9 a for the shortest wave at the default, 32 points for each of it. `slope` and
    `curvature` are the exact derivatives of the interpolated r; of the shortest wave they are met within 3e-8
    and 1e-6 of their amplitude.

    Parameters
    ----------
    spectrum : Spectrum
        The spectrum.
    length : float
        Length without repetition [m].
    wavelengths : tuple of float
        (shortest, longest) wavelength [m].
    seed : int or tuple of int
        Seed; the same seed gives the same numbers.
    method : {"cosines", "fft"}
        See above.
    spacing : float
        Largest spacing of the grid [m], at most an eighth of the shortest wavelength.
    """

    spectrum: Spectrum
    length: float
    wavelengths: tuple[float, float]
    seed: int | tuple[int, ...]
    method: Method = "cosines"
    spacing: float = 0.0

    def __post_init__(self) -> None:
        require_positive(length=self.length)
        require_band(self.wavelengths)
        require_choice(self.method, ("cosines", "fft"), "method")
        shortest = self.wavelengths[0]
        if self.spacing == 0.0:
            object.__setattr__(self, "spacing", shortest / _DEFAULT)
        require_positive(spacing=self.spacing)
        if self.spacing > shortest / _FEWEST * (1.0 + 1e-9):
            raise InputError(
                f"is too coarse for wavelengths of {shortest:g} m",
                field="spacing",
                value=self.spacing,
                fix=f"Take at most {shortest / _FEWEST:g} m, an eighth of it, or leave it out",
            )
        for entry in self.seed if isinstance(self.seed, tuple) else (self.seed,):
            if not isinstance(entry, (int, np.integer)) or entry < 0:
                raise InputError("must be a whole number, 0 or more", field="seed", value=self.seed)
        if self.period / self.spacing > _LARGEST_TABLE:
            raise InputError(
                f"needs a table of {self.period / self.spacing:.2g} points, more than {_LARGEST_TABLE:.2g}",
                field="length",
                value=self.length,
                fix="Take a shorter length, a longer shortest wavelength, or sum realizations of two bands",
            )
        # Fails here, not at the first step, where the wavelengths are outside the spectrum's range.
        self._amplitudes  # noqa: B018

    def __reduce__(self) -> tuple[Any, ...]:
        # Tables are rebuilt from the seed: a pickle for a worker holds six fields.
        fields = (self.spectrum, self.length, self.wavelengths, self.seed, self.method, self.spacing)
        return Realization, fields

    @property
    def period(self) -> float:
        """1/Δn [m]: after this distance the profile returns, with the opposite sign for "cosines"."""
        return 1.0 / self._frequency_step

    @property
    def standard_deviation(self) -> float:
        """Standard deviation over a whole period [m], that of the spectrum's band."""
        return float(np.sqrt(0.5 * np.sum(self._amplitudes**2)))

    def value(self, x: ArrayLike) -> Array:
        """Return r(x) [m], shaped like x."""
        return self._interpolated(x, self._table, 0)

    def slope(self, x: ArrayLike) -> Array:
        """Return dr/dx [-], shaped like x."""
        return self._interpolated(x, self._table, 1)

    def curvature(self, x: ArrayLike) -> Array:
        """Return d²r/dx² [1/m], shaped like x."""
        return self._interpolated(x, self._table, 2)

    def integral(self, x: ArrayLike) -> Array:
        """Return the antiderivative of r with zero mean [m²], shaped like x."""
        return self._interpolated(x, self._integral_table, 0)

    def waves(self) -> CosineSum:
        """Return the sum of cosines itself, which evaluates term by term: exact and slow."""
        frequencies = np.asarray(self._frequency_step * (self._bins + self._offset), dtype=np.float64)
        return CosineSum(self._amplitudes, frequencies, self._phases)

    @cached_property
    def _frequency_step(self) -> float:
        # A whole number of steps up to the lowest frequency puts every bin's middle on (k + 1/2) Δn.
        shortest, longest = self.wavelengths
        terms = 1.0 / longest / (1.0 / shortest - 1.0 / longest) * _FEWEST_TERMS
        return 1.0 / longest / math.ceil(max(self.length / longest, _LONG_WAVES, terms) - 1e-9)

    @property
    def _offset(self) -> float:
        return 0.5 if self.method == "cosines" else 0.0

    @property
    def _bins(self) -> NDArray[np.int64]:
        """K of the frequencies (k + offset) Δn; all of them lie inside the band."""
        low, high = (1.0 / w / self._frequency_step for w in reversed(self.wavelengths))
        return np.arange(round(low), math.floor(high - self._offset + 1e-9) + 1)

    @cached_property
    def _amplitudes(self) -> Array:
        # Inner edges halfway between frequencies, outer edges at the ends of the band.
        n = self._frequency_step * (self._bins + self._offset)
        edges = np.concatenate(
            ([1.0 / self.wavelengths[1]], 0.5 * (n[1:] + n[:-1]), [1.0 / self.wavelengths[0]])
        )
        return np.sqrt(2.0 * self.spectrum.bin_variances(edges))

    @property
    def _phases(self) -> Array:
        generator = np.random.Generator(np.random.PCG64(np.random.SeedSequence(self.seed)))
        return generator.uniform(0.0, 2.0 * np.pi, self._bins.size)

    @cached_property
    def _points(self) -> int:
        return _fast_length(math.ceil(self.period / self.spacing))

    @cached_property
    def _table(self) -> Array:
        return np.stack([self._row(order) for order in (0, 1, 2)])

    @cached_property
    def _scaled_table(self) -> Array:
        """Value, slope and curvature (n_point + 1, 3) times 1, h and h² of the distance h of the points."""
        h = self.period / self._points
        return np.ascontiguousarray((self._table * np.array([1.0, h, h * h])[:, None]).T)

    @cached_property
    def _integral_table(self) -> Array:
        return np.stack([self._row(-1), *self._table[:2]])

    def _row(self, order: int) -> Array:
        """Derivative of the given order at the grid points of a period and at the first of the next."""
        wavenumbers = 2.0 * np.pi * self._frequency_step * (self._bins + self._offset)
        coefficients = np.zeros(self._points, dtype=np.complex128)
        coefficients[self._bins] = self._amplitudes * np.exp(1j * self._phases) * (1j * wavenumbers) ** order
        row = np.fft.ifft(coefficients, norm="forward")
        turn = np.exp(2j * np.pi * self._offset * np.arange(self._points) / self._points)
        real = (row * turn).real
        return np.append(real, real[0] * self._sign)

    @property
    def _sign(self) -> float:
        return -1.0 if self.method == "cosines" else 1.0

    def _interpolated(self, x: ArrayLike, table: Array, order: int) -> Array:
        x = np.asarray(x, dtype=np.float64)
        flat = x.ravel()
        out = np.empty(flat.size)
        points = self._points
        if order == 0 and table is self._table and flat.size >= _MANY and numba_is_there():
            from axlespan.irregularity.periodic_kernel import fill_values

            fill_values(flat, self._scaled_table, self.period / points, self._sign, out)
            return out.reshape(x.shape)
        h = self.period / points
        for i in range(0, flat.size, _BLOCK):
            u = flat[i : i + _BLOCK] / h
            cell = np.floor(u)
            turns, j = np.divmod(cell.astype(np.int64), points)
            signs = np.where(turns % 2 == 0, 1.0, self._sign)
            out[i : i + _BLOCK] = signs * quintic(table[:, j], table[:, j + 1], u - cell, h, order)
        return out.reshape(x.shape)


def realize(
    spectrum: Spectrum | str,
    length: float,
    *,
    seed: int | tuple[int, ...],
    wavelengths: tuple[float, float] | None = None,
    method: Method = "cosines",
    spacing: float | None = None,
) -> Realization:
    """Return a random profile with the density of a spectrum; see `Realization` for what it is exactly.

    Parameters
    ----------
    spectrum : Spectrum or str
        A spectrum, or the name of one of the library's vertical spectra. That of an angle gives a profile in
        rad.
    length : float
        Length without repetition [m]: the path from the last wheel at the start to the first wheel at the
        end.
    seed : int or tuple of int
        Seed; the same seed gives the same numbers.
    wavelengths : tuple of float, optional
        (shortest, longest) wavelength [m]; the whole range of the spectrum when left out.
    method : {"cosines", "fft"}
        Frequencies in the middle of their bins, or multiples of 1/period.
    spacing : float, optional
        Largest spacing of the table [m]; a 32nd of the shortest wavelength when left out.

    Raises
    ------
    InputError
        When the name is unknown, the wavelengths lie outside the spectrum's range, the spacing is too coarse.

    Examples
    --------
    >>> profile = realize("german-low", 500.0, seed=1, wavelengths=(3.0, 25.0))
    >>> round(1e3 * profile.standard_deviation, 3)
    0.984
    """
    if isinstance(spectrum, str):
        spectrum = named_spectrum(spectrum)
    band = spectrum.wavelengths if wavelengths is None else (float(wavelengths[0]), float(wavelengths[1]))
    if spacing is not None:
        require_positive(spacing=spacing)
    return Realization(spectrum, length, band, seed, method, spacing or 0.0)


def _fast_length(n: int) -> int:
    """Return the smallest 2^a 3^b 5^c >= n with b, c <= 1, for the FFT."""
    return min(m << max(0, math.ceil(math.log2(n / m))) for m in (1, 3, 5, 15))
