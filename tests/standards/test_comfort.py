"""Ride comfort of synthetic signals, by formula."""

import numpy as np
import pytest

from axlespan.standards.comfort import (
    CONTINUOUS_CLASSES,
    ISO_CLASSES,
    MEAN_CLASSES,
    block_rms,
    continuous_comfort,
    in_class,
    mean_comfort,
    sperling,
    sperling_factor,
    weighted_rms,
)
from axlespan.standards.weighting import WB, WK

DT = 5e-3


def sine(frequency, amplitude, seconds):
    return amplitude * np.sin(2.0 * np.pi * frequency * np.arange(round(seconds / DT)) * DT)


@pytest.mark.parametrize("frequency", [1.0, 2.0, 5.0, 10.0])
def test_sperling_of_a_sine_is_the_formula(frequency):
    """W = 3.57 (A³ F / f)^0.1 with A in m/s²; 0.896 with A in cm/s²."""
    factor = 0.325 * frequency**2 if frequency < 5.9 else 400.0 / frequency**2
    expected = 3.57 * (0.8**3 * factor / frequency) ** 0.1
    assert sperling(sine(frequency, 0.8, 10.0), DT) == pytest.approx(expected, rel=1e-9)
    assert expected == pytest.approx(0.896 * (80.0**3 * factor / frequency) ** 0.1, rel=1e-3)


def test_sperling_adds_tenth_powers_and_takes_the_worst_block():
    one, two = sine(2.0, 0.5, 5.0), sine(8.0, 0.7, 5.0)
    alone = [sperling(signal, DT) for signal in (one, two)]
    assert sperling(one + two, DT) == pytest.approx(sum(w**10 for w in alone) ** 0.1, rel=1e-9)
    assert sperling(np.concatenate([one, two]), DT) == pytest.approx(max(alone), rel=1e-9)
    assert sperling(one[:-1], DT) is None


def test_sperling_factor_has_the_published_pieces():
    assert sperling_factor([0.5, 5.0, 6.0, 20.0, 21.0]) == pytest.approx([0.08125, 8.125, 400 / 36, 1.0, 1.0])


def test_blocks_of_a_stationary_sine():
    blocks = block_rms(sine(5.0, 1.0, 40.0), DT)
    assert len(blocks) == 8
    assert blocks[1:] == pytest.approx(
        abs(WB.response(5.0)) / np.sqrt(2.0), rel=1e-3
    )  # the first one swings in


def test_mean_comfort_needs_five_minutes():
    long = sine(5.0, 0.1, 300.0)
    expected = 6.0 * 0.1 * abs(WB.response(5.0)) / np.sqrt(2.0)
    assert mean_comfort(long, DT) == pytest.approx(expected, rel=1e-3)
    assert mean_comfort(long[:-1], DT) is None
    # 10 % of the blocks twice as strong: they set the 95 % percentile
    strong = long.copy()
    strong[: 6 * 1000] *= 2.0
    assert mean_comfort(strong, DT) == pytest.approx(2.0 * expected, rel=0.02)
    # 3 % do not
    weak = long.copy()
    weak[:2000] *= 2.0
    assert mean_comfort(weak, DT) == pytest.approx(expected, rel=0.02)


def test_continuous_comfort_takes_the_worst_block():
    signal = np.concatenate([sine(5.0, 0.1, 10.0), sine(5.0, 0.3, 5.0), sine(5.0, 0.1, 5.0)])
    assert continuous_comfort(signal, DT) == pytest.approx(
        0.3 * abs(WB.response(5.0)) / np.sqrt(2.0), rel=0.02
    )
    assert continuous_comfort(signal[:999], DT) is None


def test_weighted_rms_of_iso_2631():
    assert weighted_rms(sine(8.0, 1.0, 60.0), DT) == pytest.approx(
        abs(WK.response(8.0)) / np.sqrt(2.0), rel=2e-3
    )
    assert weighted_rms(sine(8.0, 1.0, 4.0), DT) is None


@pytest.mark.parametrize(
    ("value", "classes", "name"),
    [
        (1.49, MEAN_CLASSES, "very comfortable"),
        (1.5, MEAN_CLASSES, "comfortable"),
        (9.0, MEAN_CLASSES, "very uncomfortable"),
        (0.35, CONTINUOUS_CLASSES, "medium"),
        (0.3, ISO_CLASSES, "not uncomfortable"),
        (np.inf, ISO_CLASSES, "extremely uncomfortable"),
    ],
)
def test_classes(value, classes, name):
    assert in_class(value, classes) == name
