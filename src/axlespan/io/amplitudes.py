r"""Amplitude spectra of histories.

A history without its mean, under a Hann window $w$, has the amplitudes
$A_k = 2 |\sum_j w_j u_j e^{-2\pi i jk/n}| / \sum_j w_j$:
a steady harmonic motion shows its amplitude. The power spectral density is
$A_k^2 / (2 \Delta f N_e)$ with the noise bandwidth $N_e = n \sum w^2 / (\sum w)^2$ of the window
(Harris, Proc. IEEE 66, 51, 1978).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]


def amplitudes(values: FloatArray, time_step: float) -> tuple[FloatArray, FloatArray, float]:
    """Frequencies [Hz], amplitudes, and the noise bandwidth of the window in bins [-].

    Parameters
    ----------
    values : array (n,) or (n, n_curve)
        At even times; amplitudes (n // 2 + 1, ...) have their unit.
    time_step : float
        [s].

    Examples
    --------
    >>> t = np.arange(1000) * 0.01
    >>> f, a, _ = amplitudes(3.0 * np.sin(2.0 * np.pi * 5.0 * t), 0.01)
    >>> float(f[a.argmax()]), round(float(a.max()), 6)
    (5.0, 3.0)
    """
    n = len(values)
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(n) / n)
    weight = window.sum()
    bandwidth = float(n * (window**2).sum() / weight**2)
    steady = ((values - values.mean(axis=0)).T * window).T
    spectrum = np.abs(np.fft.rfft(steady, axis=0)) * 2.0 / weight
    return np.asarray(np.fft.rfftfreq(n, time_step), dtype=np.float64), np.asarray(spectrum), bandwidth
