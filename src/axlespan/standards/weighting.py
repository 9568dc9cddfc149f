r"""Frequency weightings of ride comfort, as transfer functions applied exactly in the frequency domain.

ISO 2631-1 annex A and EN 12299: :math:`H = H_h H_l H_t H_s` with

.. math::
   H_h = \frac{s^2}{s^2 + ω_1 s/Q_1 + ω_1^2},\quad H_l = \frac{ω_2^2}{s^2 + ω_2 s/Q_1 + ω_2^2},\quad
   H_t = \frac{1 + s/ω_3}{1 + s/(Q_4 ω_4) + s^2/ω_4^2},\quad
   H_s = K \frac{1 + s/(Q_5 ω_5) + s^2/ω_5^2}{1 + s/(Q_6 ω_6) + s^2/ω_6^2}

A recorded signal is transformed, multiplied by H(i2πf) and transformed back: no error of a digital copy of the
filter at any time step, causal as the real one is. Silence follows the signal, so that its end does not come round.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from axlespan.standards.filters import fft_length
from axlespan.standards.verdict import FROM_MEMORY

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

# The slowest part of the filters, at 0.4 Hz with Q = 0.7, has died to 1e-8 after so many seconds.
_SILENCE = 12.0


@dataclass(frozen=True)
class Weighting:
    """A frequency weighting by the parameters of its transfer function; frequencies in Hz."""

    name: str
    source: str
    f3: float
    f4: float
    q4: float
    f5: float | None = None
    q5: float = 1.0
    f6: float | None = None
    q6: float = 1.0
    gain: float = 1.0  # K
    f1: float = 0.4
    f2: float = 100.0
    q1: float = 0.5**0.5

    def response(self, frequency: npt.ArrayLike) -> ComplexArray:
        """H [-] at frequencies [Hz].

        Examples
        --------
        >>> np.abs(WK.response([1.0, 8.0])).round(3).tolist()
        [0.482, 1.036]
        """
        s = 1j * np.asarray(frequency, dtype=float)  # in units of 2π, as all corner frequencies are
        high = s**2 / (s**2 + self.f1 * s / self.q1 + self.f1**2)
        low = self.f2**2 / (s**2 + self.f2 * s / self.q1 + self.f2**2)
        transition = (1.0 + s / self.f3) / _second(s, self.f4, self.q4)
        step = np.full(s.shape, self.gain, dtype=complex)
        if self.f5 is not None and self.f6 is not None:
            step = step * _second(s, self.f5, self.q5) / _second(s, self.f6, self.q6)
        return np.asarray(high * low * transition * step)

    def apply(self, signal: FloatArray, time_step: float) -> FloatArray:
        """Weighted signals (n_time, ...); they are taken to be silent before their begin."""
        n = fft_length(len(signal), time_step, _SILENCE)
        response = self.response(np.fft.rfftfreq(n, time_step))
        if n % 2 == 0:
            response[-1] = abs(response[-1])  # the highest frequency has no phase in samples
        shaped = np.fft.rfft(signal, n, axis=0) * response.reshape((-1,) + (1,) * (np.ndim(signal) - 1))
        return np.asarray(np.fft.irfft(shaped, n, axis=0)[: len(signal)])


def _second(s: ComplexArray, corner: float, q: float) -> ComplexArray:
    return np.asarray(1.0 + s / (q * corner) + s**2 / corner**2)


_EN12299 = f"EN 12299:2009 annex C, parameters as in comfpy; {FROM_MEMORY}"
_ISO2631 = "ISO 2631-1:1997 annex A, parameters from memory; reproduces the table of weights there"

#: Vertical, EN 12299.
WB = Weighting("Wb", _EN12299, 16.0, 16.0, 0.63, 2.5, 0.8, 4.0, 0.8, gain=0.4)
#: Horizontal, EN 12299 and ISO 2631-1.
WD = Weighting("Wd", _EN12299, 2.0, 2.0, 0.63)
#: Seat back, EN 12299.
WC = Weighting("Wc", _EN12299, 8.0, 8.0, 0.63)
#: Vertical, ISO 2631-1.
WK = Weighting("Wk", _ISO2631, 12.5, 12.5, 0.63, 2.37, 0.91, 3.35, 0.91, gain=(2.37 / 3.35) ** 2)
