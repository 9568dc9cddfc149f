"""What a profile is; the smooth path, the harmonic path (N12 (40)) and sums of cosines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from axlespan.errors import InputError
from axlespan.irregularity.checks import (
    Array,
    clipped,
    column,
    require_finite,
    require_order,
    require_positive,
    within,
)

__all__ = ["CosineSum", "Harmonic", "Integrable", "Profile", "Smooth"]


@runtime_checkable
class Profile(Protocol):
    """The height r(x) of the path above its ideal line, with its first two derivatives.

    x is the position along the path [m], an array of any shape; x = 0 is the start of the structure. r > 0
    lifts the wheel. Where r or its slope jumps, the derivatives are those of the smooth pieces, without the
    impulses.
    """

    def value(self, x: ArrayLike) -> Array:
        """Return r(x) [m], shaped like x."""
        ...

    def slope(self, x: ArrayLike) -> Array:
        """Return dr/dx [-], shaped like x."""
        ...

    def curvature(self, x: ArrayLike) -> Array:
        """Return d²r/dx² [1/m], shaped like x."""
        ...


@runtime_checkable
class Integrable(Profile, Protocol):
    """A profile that also knows an antiderivative, so that averages over a contact patch are exact."""

    def integral(self, x: ArrayLike) -> Array:
        """Return a continuous antiderivative of r [m²], shaped like x; its constant has no meaning."""
        ...


@dataclass(frozen=True)
class Smooth:
    """The ideal path: r = 0."""

    def value(self, x: ArrayLike) -> Array:
        """Return zeros [m], shaped like x."""
        return np.zeros(np.shape(x))

    slope = curvature = integral = value


@dataclass(frozen=True)
class Harmonic:
    """A sine along the path, N12 (40): r = a sin(2πx/λ + φ).

    Parameters
    ----------
    amplitude : float
        a [m].
    wavelength : float
        λ [m], positive.
    phase : float
        φ [rad] at x = 0, the start of the structure.
    start, stop : float, optional
        r is zero outside start <= x <= stop [m]; a bound left out doesn't bound.

    Examples
    --------
    >>> Harmonic(amplitude=0.5e-3, wavelength=5.0).value([0.0, 1.25])
    array([0.    , 0.0005])
    """

    amplitude: float
    wavelength: float
    phase: float = 0.0
    start: float | None = None
    stop: float | None = None

    def __post_init__(self) -> None:
        require_finite(amplitude=self.amplitude, phase=self.phase)
        require_positive(wavelength=self.wavelength)
        require_order(self.start, self.stop)

    @property
    def wavenumber(self) -> float:
        """2π/λ [rad/m]."""
        return 2.0 * np.pi / self.wavelength

    def value(self, x: ArrayLike) -> Array:
        """Return r(x) [m], shaped like x."""
        return self._wave(x, self.amplitude, 0.0)

    def slope(self, x: ArrayLike) -> Array:
        """Return dr/dx [-], shaped like x."""
        return self._wave(x, self.amplitude * self.wavenumber, 0.5 * np.pi)

    def curvature(self, x: ArrayLike) -> Array:
        """Return d²r/dx² [1/m], shaped like x."""
        return self._wave(x, -self.amplitude * self.wavenumber**2, 0.0)

    def integral(self, x: ArrayLike) -> Array:
        """Return an antiderivative of r [m²], shaped like x."""
        x = clipped(np.asarray(x, dtype=np.float64), self.start, self.stop)
        return -self.amplitude / self.wavenumber * np.cos(self.wavenumber * x + self.phase)

    def _wave(self, x: ArrayLike, amplitude: float, lead: float) -> Array:
        x = np.asarray(x, dtype=np.float64)
        wave = amplitude * np.sin(self.wavenumber * x + (self.phase + lead))
        return np.where(within(x, self.start, self.stop), wave, 0.0)


# Numbers in one block of positions times frequencies: 8 MiB, so that it stays in cache.
_BLOCK = 1 << 20


@dataclass(frozen=True, eq=False)
class CosineSum:
    """A sum of cosines, evaluated term by term: r = Σ a_k cos(2π n_k x + φ_k).

    The work is positions times terms; a `Realization` gives the same numbers from a table, much faster.

    Parameters
    ----------
    amplitudes, frequencies, phases : array_like, (n_term,)
        a_k [m], n_k [1/m] and φ_k [rad].
    """

    amplitudes: Array
    frequencies: Array
    phases: Array

    def __post_init__(self) -> None:
        for field in ("amplitudes", "frequencies", "phases"):
            object.__setattr__(self, field, column(getattr(self, field), field, at_least=1))
        if not self.amplitudes.size == self.frequencies.size == self.phases.size:
            sizes = (self.amplitudes.size, self.frequencies.size, self.phases.size)
            raise InputError("amplitudes, frequencies and phases must be equally many", value=sizes)

    def value(self, x: ArrayLike) -> Array:
        """Return r(x) [m], shaped like x."""
        return self._derivative(x, 0)

    def slope(self, x: ArrayLike) -> Array:
        """Return dr/dx [-], shaped like x."""
        return self._derivative(x, 1)

    def curvature(self, x: ArrayLike) -> Array:
        """Return d²r/dx² [1/m], shaped like x."""
        return self._derivative(x, 2)

    def _derivative(self, x: ArrayLike, order: int) -> Array:
        # The derivative of order d of a cosine leads it by d quarter turns.
        x = np.asarray(x, dtype=np.float64)
        flat = x.ravel()
        wavenumbers = 2.0 * np.pi * self.frequencies
        weights = self.amplitudes * wavenumbers**order
        phases = self.phases + 0.5 * np.pi * order
        out = np.empty(flat.size)
        step = max(1, _BLOCK // weights.size)
        for i in range(0, flat.size, step):
            out[i : i + step] = np.cos(np.outer(flat[i : i + step], wavenumbers) + phases) @ weights
        return out.reshape(x.shape)
