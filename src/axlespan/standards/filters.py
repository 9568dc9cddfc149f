"""Filters of the rules: the band of the deck acceleration, and wheel-rail forces.

The deck's filter passes frequencies up to its limit in full, as the rule counts them, and falls to zero as half a
cosine over the next quarter; a Butterworth filter would take 30 % away at the limit itself. It has no phase, so
that peaks stay where they are. Forces go through a Butterworth filter forth and back: no phase, 3 dB down at its
frequency, 24 dB per octave beyond.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from axlespan.errors import InputError

FloatArray = npt.NDArray[np.float64]

#: Where the deck's filter has fallen to zero, over the frequency up to which it passes all.
ROLL_OFF = 1.25

# Seconds of silence around a signal, so that its end does not come round to its begin.
_SILENCE = 4.0


def band_gain(frequency: npt.ArrayLike, limit: float) -> FloatArray:
    """Gain [-] of the deck's filter at frequencies [Hz]: 1 up to the limit, 0 from 1.25 times that on.

    Examples
    --------
    >>> band_gain([0.0, 30.0, 33.75, 37.5, 100.0], 30.0).round(6).tolist()
    [1.0, 1.0, 0.5, 0.0, 0.0]
    """
    f = np.abs(np.asarray(frequency, dtype=float))
    share = np.clip((f / limit - 1.0) / (ROLL_OFF - 1.0), 0.0, 1.0)
    return np.asarray(0.5 * (1.0 + np.cos(np.pi * share)))


def up_to(signal: FloatArray, time_step: float, limit: float) -> FloatArray:
    """The part of signals (n_time, ...) with frequencies up to a limit [Hz]; see :func:`band_gain`.

    Raises
    ------
    InputError
        If the sampling is too coarse to hold that band.
    """
    if limit * ROLL_OFF > 0.5 / time_step:
        raise InputError(
            f"must be sampled with at most {1.0 / (2.0 * ROLL_OFF * limit):.3g} s for frequencies up to {limit:g} Hz",
            field="time_step",
            value=time_step,
        )
    n = fft_length(len(signal), time_step, _SILENCE)
    gain = band_gain(np.fft.rfftfreq(n, time_step), limit)
    spectrum = np.fft.rfft(signal, n, axis=0)
    shaped = spectrum * gain.reshape((-1,) + (1,) * (np.ndim(signal) - 1))
    return np.asarray(np.fft.irfft(shaped, n, axis=0)[: len(signal)])


def low_pass(signal: FloatArray, time_step: float, frequency: float) -> FloatArray:
    """Signals (n_time, ...) through a Butterworth filter, 3 dB down at a frequency [Hz], without phase.

    Two passes of second order, each 1.5 dB down there. Ends are continued by point reflection.

    Raises
    ------
    InputError
        If the sampling is too coarse.
    """
    from scipy.signal import butter, sosfiltfilt

    # two passes of 1 / (1 + (f/f_c)^4) in power: -3 dB at f asks for f_c = f / (√2 - 1)^(1/4)
    corner = frequency / (np.sqrt(2.0) - 1.0) ** 0.25
    if corner >= 0.5 / time_step:
        rule = f"must be sampled with less than {0.5 / corner:.3g} s for a filter at {frequency:g} Hz"
        raise InputError(rule, field="time_step", value=time_step)
    sections = butter(2, corner, fs=1.0 / time_step, output="sos")
    pad = min(len(signal) - 1, int(np.ceil(1.0 / (frequency * time_step))))
    return np.asarray(sosfiltfilt(sections, signal, axis=0, padlen=max(0, pad)))


def sliding_mean(signal: FloatArray, position: FloatArray, length: float) -> FloatArray:
    """Mean of a signal (n_time,) over a length [m] of the way, centered, at its own positions [m].

    Positions must not decrease; near the ends the mean is over what there is.
    """
    way = np.concatenate([[0.0], np.cumsum(0.5 * (signal[1:] + signal[:-1]) * np.diff(position))])
    begin = np.clip(position - 0.5 * length, position[0], position[-1])
    end = np.clip(position + 0.5 * length, position[0], position[-1])
    width = end - begin
    total = np.interp(end, position, way) - np.interp(begin, position, way)
    return np.asarray(np.where(width > 0.0, total / np.where(width > 0.0, width, 1.0), signal))


def fft_length(n: int, time_step: float, silence: float) -> int:
    """Samples of a signal with silence [s] after it, a number that transforms quickly."""
    from scipy.fft import next_fast_len

    return int(next_fast_len(n + int(np.ceil(silence / time_step)), real=True))
