"""Thinned curves keep their peaks; bands hold every curve."""

import numpy as np
import pytest

from axlespan.io.thinning import band, band_over, thinned


@pytest.mark.parametrize("n", [1, 399, 400, 401, 4003, 100_000])
def test_thinned_curves_keep_ends_and_extremes(n):
    rng = np.random.default_rng(n)
    x, values = np.arange(n) / 7.0, rng.standard_normal(n)
    t, v = thinned(x, values, 400)
    assert len(t) <= max(400, min(n, 400))
    assert (t[0], t[-1], v[0], v[-1]) == (x[0], x[-1], values[0], values[-1])
    assert (v.min(), v.max()) == (values.min(), values.max())
    assert np.all(np.diff(t) > 0.0)
    np.testing.assert_array_equal(values[np.searchsorted(x, t)], v)


def test_thinned_curves_keep_every_local_peak_of_their_bins():
    x, values = np.arange(10_000.0), np.zeros(10_000)
    spikes = np.arange(50, 10_000, 100)
    values[spikes] = np.where(np.arange(len(spikes)) % 2, 1.0, -1.0)
    t, v = thinned(x, values, 400)  # bins of 100 points, one spike in each
    np.testing.assert_array_equal(t[v != 0.0], spikes)


@pytest.mark.parametrize("n", [10, 997, 1000, 5003])
def test_a_band_holds_every_point_of_every_curve(n):
    table = np.random.default_rng(n).standard_normal((n, 9))
    x = np.arange(float(n))
    at, low, high = band(x, table, bins=100)
    assert len(at) == min(n, 100)
    owner = np.searchsorted(at, x, side="right") - 1
    for i in range(len(at)):
        assert (low[i], high[i]) == (table[owner == i].min(), table[owner == i].max())


def test_a_band_over_positions_agrees_with_a_plain_loop():
    rng = np.random.default_rng(2)
    positions = np.subtract.outer(0.13 * np.arange(800.0), 3.0 * np.arange(7))
    table = rng.standard_normal(positions.shape)
    at, low, high = band_over(positions, table, (10.0, 60.0), bins=90)
    width = at[1] - at[0]
    assert len(at) == 90 and width == pytest.approx(50.0 / 90)
    for center, lowest, highest in zip(at, low, high, strict=True):
        inside = np.abs(positions - center) <= 0.5 * width
        assert (lowest, highest) == (table[inside].min(), table[inside].max())


def test_a_band_over_positions_has_bins_of_two_steps_at_least():
    positions = np.subtract.outer(np.arange(100.0), np.array([0.0, 0.5]))
    at, low, high = band_over(positions, np.ones(positions.shape), (0.0, 50.0), bins=600)
    assert len(at) == 25
    assert set(low) == set(high) == {1.0}


def test_a_train_that_stands_has_a_band_too():
    positions = np.tile([10.0, 12.0], (50, 1))
    table = np.random.default_rng(1).standard_normal((50, 2))
    at, low, high = band_over(positions, table, (8.0, 14.0), bins=6)
    np.testing.assert_allclose(at, [10.5, 12.5])
    np.testing.assert_array_equal(low, table.min(axis=0))
    np.testing.assert_array_equal(high, table.max(axis=0))
