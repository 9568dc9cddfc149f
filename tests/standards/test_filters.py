"""Filters and weightings: gains at known frequencies, check values of the standards, and the same by scipy."""

import numpy as np
import pytest
from scipy.signal import bilinear, butter, freqs, lfilter, sosfiltfilt

from axlespan.errors import InputError
from axlespan.standards.filters import band_gain, low_pass, sliding_mean, up_to
from axlespan.standards.weighting import WB, WC, WD, WK

DT = 1e-3
TIME = np.arange(8000) * DT


def amplitude(signal, frequency, part=slice(2000, 6000)):
    """Amplitude of a sine in whole periods of its middle."""
    turn = np.exp(-2j * np.pi * frequency * TIME[part])
    return 2.0 * abs((signal[part] * turn).mean())


@pytest.mark.parametrize(("frequency", "gain"), [(5.0, 1.0), (30.0, 1.0), (33.75, 0.5), (40.0, 0.0)])
def test_the_deck_filter_passes_up_to_its_limit(frequency, gain):
    found = up_to(np.sin(2.0 * np.pi * frequency * TIME), DT, 30.0)
    assert amplitude(found, frequency) == pytest.approx(gain, abs=2e-3)
    assert band_gain(frequency, 30.0) == pytest.approx(gain, abs=1e-12)


def test_the_deck_filter_has_no_phase():
    pulse = np.exp(-(((TIME - 4.0) / 0.03) ** 2))
    found = up_to(pulse, DT, 30.0)
    assert np.argmax(found) == np.argmax(pulse)
    assert np.abs(found - found[::-1][np.r_[-1:7999]]).max() < 1e-3  # as even about its middle as the pulse
    both = up_to(np.column_stack([pulse, 2.0 * pulse]), DT, 30.0)
    assert np.abs(both[:, 1] - 2.0 * found).max() < 1e-12


def test_the_end_of_a_record_does_not_come_round():
    signal = np.where(TIME > 7.5, np.sin(2.0 * np.pi * 10.0 * TIME), 0.0)
    assert np.abs(up_to(signal, DT, 30.0)[:3000]).max() < 1e-3
    assert np.abs(WK.apply(signal, DT)[:7000]).max() < 1e-3


def test_coarse_sampling_is_refused():
    with pytest.raises(
        InputError, match=r"must be sampled with at most 0.0133 s for frequencies up to 30 Hz"
    ):
        up_to(np.zeros(100), 0.02, 30.0)
    with pytest.raises(InputError, match="must be sampled with less than"):
        low_pass(np.zeros(100), 0.05, 20.0)


def test_low_pass_of_wheel_forces():
    at = {
        f: amplitude(low_pass(np.sin(2.0 * np.pi * f * TIME), DT, 20.0), f) for f in (2.0, 20.0, 40.0, 80.0)
    }
    assert at[2.0] == pytest.approx(1.0, abs=1e-4)
    assert at[20.0] == pytest.approx(np.sqrt(0.5), abs=2e-3)  # 3 dB down
    corner = 20.0 / (np.sqrt(2.0) - 1.0) ** 0.25
    assert at[40.0] == pytest.approx(1.0 / (1.0 + (40.0 / corner) ** 4), rel=0.02)
    assert 20.0 * np.log10(at[40.0] / at[80.0]) == pytest.approx(24.0, abs=2.5)  # per octave
    assert low_pass(np.full(500, 7.0), DT, 20.0) == pytest.approx(7.0, abs=1e-12)
    own = sosfiltfilt(butter(2, corner, fs=1.0 / DT, output="sos"), np.sin(300.0 * TIME), padlen=50)
    assert np.abs(low_pass(np.sin(300.0 * TIME), DT, 20.0) - own).max() < 1e-9


def test_sliding_mean_over_a_way():
    position = np.linspace(0.0, 10.0, 1001)
    assert sliding_mean(3.0 * position, position, 2.0)[200:800] == pytest.approx(3.0 * position[200:800])
    step = np.where(position < 5.0, 0.0, 1.0)
    assert np.interp(4.5, position, sliding_mean(step, position, 2.0)) == pytest.approx(0.25, abs=5e-3)
    assert sliding_mean(np.ones(5), np.zeros(5), 2.0) == pytest.approx(1.0)  # a train that stands


def test_weights_of_iso_2631():
    frequencies = [0.5, 1.0, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0, 10.0, 12.5, 16.0, 20.0]
    weights = [0.418, 0.482, 0.531, 0.631, 0.804, 0.967, 1.039, 1.054, 1.036, 0.988, 0.902, 0.769, 0.636]
    assert np.abs(WK.response(frequencies)) == pytest.approx(weights, abs=6e-4)


def test_weights_of_en_12299():
    frequencies, weights = (
        [1.0, 2.0, 4.0, 5.0, 8.0, 16.0, 20.0],
        [0.391, 0.437, 0.822, 0.957, 1.056, 0.918, 0.798],
    )
    assert np.abs(WB.response(frequencies)) == pytest.approx(weights, abs=6e-4)


def test_the_fifth_order_fit_of_wk():
    """Zuo and Nayfeh (2003): a rational fit of Wk, within 0.05 of it from 1 to 20 Hz."""
    f = np.geomspace(1.0, 20.0, 40)
    top = [87.72, 1138.0, 11336.0, 5452.0, 5509.0]
    bottom = [1.0, 92.6854, 2549.83, 25969.0, 81057.0, 79783.0]
    _, fit = freqs(top, bottom, 2.0 * np.pi * f)
    assert np.abs(np.abs(fit) - np.abs(WK.response(f))).max() < 0.05


@pytest.mark.parametrize("weighting", [WB, WC, WD, WK], ids=lambda w: w.name)
def test_weighting_a_sine(weighting):
    frequency = 5.0
    found = weighting.apply(np.sin(2.0 * np.pi * frequency * TIME), DT)
    assert amplitude(found, frequency) == pytest.approx(abs(weighting.response(frequency)), rel=2e-3)


def test_weighting_is_the_causal_filter():
    """Against the filter in sampled form by the bilinear transform, at a step where that is exact enough."""
    w1, w2, w3 = 2.0 * np.pi * np.array([WD.f1, WD.f2, WD.f3])
    stages = (
        ([1.0, 0.0, 0.0], [1.0, w1 / WD.q1, w1**2]),
        ([w2**2], [1.0, w2 / WD.q1, w2**2]),
        ([w3, w3**2], [1.0, w3 / WD.q4, w3**2]),
    )
    fine = 2e-4
    time = np.arange(10_000) * fine
    signal = np.exp(-(((time - 0.5) / 0.05) ** 2))
    expected = signal
    for top, bottom in stages:
        expected = lfilter(*bilinear(top, bottom, 1.0 / fine), expected)
    assert np.abs(WD.apply(signal, fine) - expected).max() < 2e-4 * np.abs(expected).max()
