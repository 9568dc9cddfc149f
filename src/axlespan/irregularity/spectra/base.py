"""What a spectrum is: a one-sided power spectral density, with its units and where it comes from."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from axlespan.errors import InputError
from axlespan.irregularity.checks import (
    Array,
    column,
    require_band,
    require_choice,
    require_increasing,
    require_positive,
)

__all__ = ["FOUND", "FROM_MEMORY", "QUANTITIES", "Quantity", "Spectrum", "Status", "tabulated"]

Quantity: TypeAlias = Literal["vertical", "alignment", "cross level", "gauge"]
Status: TypeAlias = Literal["found", "from memory: check against the standard"]
QUANTITIES: tuple[Quantity, ...] = ("vertical", "alignment", "cross level", "gauge")
FOUND: Status = "found"
FROM_MEMORY: Status = "from memory: check against the standard"

# Gauss-Legendre points per panel: with 64 panels per decade the error of the smooth densities is that of
# rounding.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(5)


@dataclass(frozen=True)
class Spectrum:
    """A power spectral density of irregularities.

    `density` is the formula as published, with its own argument and sides; `psd` and `psd_angular` are always
    one-sided, so that the variance of a band is the integral over positive frequencies.

    Parameters
    ----------
    name : str
        Name, as in `spectrum_names`.
    density : callable
        The published formula: array of `argument` > 0 to array of S. To be used in worker processes it must
        pickle.
    wavelengths : tuple of float
        (shortest, longest) wavelength that it holds for [m].
    quantity : {"vertical", "alignment", "cross level", "gauge"}
        What varies.
    argument : {"cycles/m", "rad/m"}
        What `density` takes: n = 1/λ, or Ω = 2π/λ.
    sides : {"one-sided", "two-sided"}
        Whether `density` stands for positive frequencies alone; a two-sided one is doubled.
    amplitude_unit : {"m", "rad"}
        Unit of the irregularity itself; the German cross level is an angle.
    source : str
        Where formula and coefficients come from.
    status : str
        "found" (the numbers were read in the source) or "from memory: check against the standard".
    note : str
        What is doubtful or left out.
    """

    name: str
    density: Callable[[Array], Array]
    wavelengths: tuple[float, float]
    quantity: Quantity = "vertical"
    argument: Literal["cycles/m", "rad/m"] = "cycles/m"
    sides: Literal["one-sided", "two-sided"] = "one-sided"
    amplitude_unit: Literal["m", "rad"] = "m"
    source: str = "given by the user"
    status: Status = FOUND
    note: str = ""

    def __post_init__(self) -> None:
        require_band(self.wavelengths)
        require_choice(self.quantity, QUANTITIES, "quantity")
        require_choice(self.argument, ("cycles/m", "rad/m"), "argument")
        require_choice(self.sides, ("one-sided", "two-sided"), "sides")
        require_choice(self.amplitude_unit, ("m", "rad"), "amplitude_unit")

    @property
    def unit(self) -> str:
        """Unit of the published density: "m^2/(rad/m)"."""
        return f"{self.amplitude_unit}^2/({'1/m' if self.argument == 'cycles/m' else 'rad/m'})"

    def psd(self, n: ArrayLike) -> Array:
        """Return the one-sided S(n) [m²/(1/m)] at frequencies n [1/m], in cycles per meter.

        Raises
        ------
        InputError
            When n lies outside the wavelengths that the spectrum holds for; see `extended`.
        """
        n = np.asarray(n, dtype=np.float64)
        if n.size:
            self._require_range(n)
        # S(n) dn = S(Ω) dΩ and Ω = 2πn, so S(n) = 2π S(Ω).
        angular = self.argument == "rad/m"
        factor = (2.0 * np.pi if angular else 1.0) * (2.0 if self.sides == "two-sided" else 1.0)
        density = np.asarray(self.density(2.0 * np.pi * n if angular else n), dtype=np.float64)
        if density.shape != n.shape or not (np.isfinite(density) & (density >= 0.0)).all():
            raise InputError(
                "must return finite densities that aren't negative, shaped like its argument",
                field=f"density of {self.name}",
            )
        return factor * density

    def psd_angular(self, omega: ArrayLike) -> Array:
        """Return the one-sided S(Ω) [m²/(rad/m)] at Ω [rad/m]."""
        return self.psd(np.asarray(omega, dtype=np.float64) / (2.0 * np.pi)) / (2.0 * np.pi)

    def psd_time(self, frequency: ArrayLike, speed: float) -> Array:
        """Return the one-sided S(f) [m²/Hz] that a wheel at the speed [m/s] feels at frequencies [Hz]."""
        require_positive(speed=speed)
        return self.psd(np.asarray(frequency, dtype=np.float64) / speed) / speed

    def bin_variances(self, edges: ArrayLike) -> Array:
        """Return the variance between neighboring frequencies: ∫ S dn [m²], (n_edge - 1,).

        Parameters
        ----------
        edges : array_like, (n_edge,)
            Frequencies [1/m], strictly increasing.
        """
        edges = column(edges, "edges")
        require_increasing(edges, "edges")
        self._require_range(edges)
        t = np.log(edges)
        half, middle = 0.5 * np.diff(t), 0.5 * (t[1:] + t[:-1])
        n = np.exp(middle[:, np.newaxis] + half[:, np.newaxis] * _NODES)
        return np.asarray(half * ((self.psd(n) * n) @ _WEIGHTS))

    def standard_deviation(
        self, wavelength_min: float | None = None, wavelength_max: float | None = None
    ) -> float:
        """Return the standard deviation [m] of the wavelengths between two bounds [m], by default of all.

        Examples
        --------
        >>> from axlespan.irregularity import spectrum
        >>> round(1e3 * spectrum("german-low").standard_deviation(3.0, 25.0), 3)
        0.984
        """
        shortest = self.wavelengths[0] if wavelength_min is None else wavelength_min
        longest = self.wavelengths[1] if wavelength_max is None else wavelength_max
        require_band((shortest, longest))
        panels = 2 + math.ceil(64.0 * math.log10(longest / shortest))
        return float(np.sqrt(self.bin_variances(np.geomspace(1.0 / longest, 1.0 / shortest, panels)).sum()))

    def extended(self, wavelength_min: float, wavelength_max: float) -> Spectrum:
        """Return the same formula for another range of wavelengths [m]: an extrapolation, noted as such."""
        note = f"{self.note}; " if self.note else ""
        low, high = self.wavelengths
        note += f"extrapolated from wavelengths of {low:g} m to {high:g} m"
        return replace(self, wavelengths=(wavelength_min, wavelength_max), note=note)

    def scaled(self, factor: float) -> Spectrum:
        """Return the spectrum with the density multiplied by a factor (the profile by its square root)."""
        require_positive(factor=factor)
        note = f"{self.note}; " if self.note else ""
        return replace(self, density=_Multiple(self.density, factor), note=f"{note}density times {factor:g}")

    def scaled_to(self, standard_deviation: float, wavelength_min: float, wavelength_max: float) -> Spectrum:
        """Return the spectrum scaled to a standard deviation [m] between two wavelengths [m].

        Parameters
        ----------
        standard_deviation : float
            [m].
        wavelength_min, wavelength_max : float
            The band [m].
        """
        require_positive(standard_deviation=standard_deviation)
        return self.scaled(
            (standard_deviation / self.standard_deviation(wavelength_min, wavelength_max)) ** 2
        )

    def as_height(self, base: float) -> Spectrum:
        """Return the spectrum of an angle as that of a height difference over a base [m]: S times base².

        For the cross level the base is the distance of the wheels' contact points, 1.5 m on standard gauge.

        Raises
        ------
        InputError
            If it is a length already, or the base is not positive.
        """
        require_positive(base=base)
        if self.amplitude_unit != "rad":
            raise InputError("is a length already, not an angle", field="spectrum", value=self.name)
        scaled = self.scaled(base**2)
        return replace(scaled, amplitude_unit="m", note=f"{scaled.note} (angle to height over {base:g} m)")

    def _require_range(self, n: Array) -> None:
        low, high = self.wavelengths
        lowest, highest = float(n.min()), float(n.max())
        slack = 1.0 + 1e-9
        below = not lowest * slack * high >= 1.0
        if below or not highest * low <= slack:
            bad = lowest if below else highest
            wavelength = f" (wavelength {1.0 / bad:.6g} m)" if bad > 0.0 else ""
            raise InputError(
                f"lies outside the range of {self.name}, wavelengths from {low:g} m to {high:g} m",
                field="n",
                value=f"{bad:.6g} 1/m{wavelength}",
                fix="Stay inside, or extrapolate on purpose: spectrum.extended(shortest, longest)",
            )


@dataclass(frozen=True)
class _Multiple:
    density: Callable[[Array], Array]
    factor: float

    def __call__(self, n: Array) -> Array:
        return self.factor * self.density(n)


@dataclass(frozen=True)
class _LogLog:
    arguments: tuple[float, ...]
    densities: tuple[float, ...]

    def __call__(self, n: Array) -> Array:
        return np.exp(np.interp(np.log(n), np.log(self.arguments), np.log(self.densities)))


def tabulated(
    name: str,
    arguments: ArrayLike,
    densities: ArrayLike,
    *,
    quantity: Quantity = "vertical",
    argument: Literal["cycles/m", "rad/m"] = "cycles/m",
    sides: Literal["one-sided", "two-sided"] = "one-sided",
    source: str = "given by the user",
) -> Spectrum:
    """Return a spectrum given by points, straight lines between them in a double logarithmic plot.

    Parameters
    ----------
    name : str
        Name for messages and reports.
    arguments : array_like, (n,)
        n [1/m] or Ω [rad/m], see `argument`; positive, strictly increasing. They bound the wavelengths.
    densities : array_like, (n,)
        S there, positive [m²/(1/m)] or [m²/(rad/m)].
    quantity, argument, sides, source
        As for `Spectrum`.

    Raises
    ------
    InputError
        If points are not positive or do not increase.
    """
    n, s = column(arguments, "arguments"), column(densities, "densities")
    require_increasing(n, "arguments")
    if n.size != s.size:
        raise InputError(f"must have as many entries as arguments, {n.size}", field="densities", value=s.size)
    require_positive(**{"arguments[0]": float(n[0]), "smallest of densities": float(s.min())})
    turn = 2.0 * np.pi if argument == "rad/m" else 1.0
    density = _LogLog(tuple(n.tolist()), tuple(s.tolist()))
    wavelengths = (turn / float(n[-1]), turn / float(n[0]))
    return Spectrum(name, density, wavelengths, quantity, argument, sides, source=source)
