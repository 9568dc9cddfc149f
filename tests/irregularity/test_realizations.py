"""Random profiles: variance, density per octave, exactness of the table, seeds, rails."""

from __future__ import annotations

import pickle
import time

import numpy as np
import pytest

from axlespan import irregularity as ir
from axlespan.errors import InputError

METHODS = ("cosines", "fft")


@pytest.mark.parametrize("method", METHODS)
def test_variance_over_a_period_is_that_of_the_band(method):
    spectrum = ir.spectrum("german-low")
    profile = ir.realize(spectrum, 2000.0, seed=5, wavelengths=(3.0, 70.0), method=method)
    sigma = spectrum.standard_deviation(3.0, 70.0)
    assert profile.standard_deviation == pytest.approx(sigma, rel=1e-10)
    # Over a whole period (two half periods of opposite sign) the cosines are orthogonal on an even grid.
    x = np.arange(40_000) * profile.period / 40_000
    r = profile.value(x)
    if method == "fft":
        assert np.sqrt(np.mean(r**2)) == pytest.approx(sigma, rel=1e-6)
        assert abs(np.mean(r)) < 1e-9
    np.testing.assert_allclose(
        profile.value(x + 3 * profile.period), (-1 if method == "cosines" else 1) * r, atol=1e-12
    )


@pytest.mark.parametrize("method", METHODS)
def test_waves_fill_the_band_and_only_the_band(method):
    profile = ir.realize("fra-5", 700.0, seed=5, wavelengths=(2.0, 90.0), method=method)
    n = profile.waves().frequencies
    assert n[0] >= (1 - 1e-12) / 90.0
    assert n[-1] <= (1 + 1e-12) / 2.0
    np.testing.assert_allclose(np.diff(n), 1.0 / profile.period, rtol=1e-9)
    assert profile.period >= 700.0
    assert n.size >= 128


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize(("per_wave", "tolerance"), [(32, (2e-9, 3e-8, 1e-6)), (8, (6e-6, 3e-5, 3e-4))])
def test_table_meets_the_sum_of_cosines(method, per_wave, tolerance):
    # A narrow band of short waves is the worst case for the stated bounds.
    profile = ir.realize(
        "iso8608-b", 40.0, seed=2, wavelengths=(0.5, 0.6), method=method, spacing=0.5 / per_wave
    )
    waves = profile.waves()
    k = 2.0 * np.pi * waves.frequencies
    x = np.random.default_rng(1).uniform(-300.0, 300.0, 3000)
    for order, (name, bound) in enumerate(zip(("value", "slope", "curvature"), tolerance, strict=True)):
        error = getattr(profile, name)(x) - getattr(waves, name)(x)
        assert np.abs(error).max() <= bound * np.sum(waves.amplitudes * k**order)


def test_sum_of_cosines_by_plain_loop():
    profile = ir.realize("german-high", 100.0, seed=(4, 2), wavelengths=(5.0, 50.0))
    waves = profile.waves()
    x, slope = 17.3, 0.0
    for a, n, phase in zip(waves.amplitudes, waves.frequencies, waves.phases, strict=True):
        slope -= a * 2 * np.pi * n * np.sin(2 * np.pi * n * x + phase)
    assert waves.slope(x) == pytest.approx(slope, rel=1e-10)
    # a²/2 = S Δn where the density is smooth over a bin
    i = waves.amplitudes.size // 2
    step = waves.frequencies[1] - waves.frequencies[0]
    density = ir.spectrum("german-high").psd(waves.frequencies[i])
    assert waves.amplitudes[i] == pytest.approx(np.sqrt(2.0 * density * step), rel=1e-4)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", ["german-low", "fra-6", "china-ballastless"])
def test_estimated_density_per_octave_is_the_target(method, name):
    spectrum = ir.spectrum(name)
    spacing, length = 0.5, 60_000.0
    profile = ir.realize(spectrum, length, seed=20, wavelengths=(3.0, 150.0), method=method, spacing=0.375)
    values = profile.value(np.arange(0.0, length, spacing))
    estimate = ir.estimate_psd(values, spacing, segment=3000.0)
    for octave in ((3.5, 7.0), (7.0, 14.0), (14.0, 28.0), (28.0, 56.0), (56.0, 112.0)):
        variance = spectrum.standard_deviation(*octave) ** 2
        assert estimate.standard_deviation(octave) ** 2 == pytest.approx(variance, rel=0.10), octave


def test_heights_are_gaussian():
    values = ir.realize("german-low", 50_000.0, seed=3, wavelengths=(3.0, 25.0)).value(
        np.arange(0.0, 50_000.0, 1.0)
    )
    values = values / values.std()
    # Fourth moment 3 and 68.3 % within one standard deviation; the sample holds some 5000 independent values.
    assert np.mean(values**4) == pytest.approx(3.0, abs=0.15)
    assert np.mean(np.abs(values) < 1.0) == pytest.approx(0.6827, abs=0.01)


def test_same_seed_same_numbers():
    first, again, other = (ir.realize("fra-4", 300.0, seed=s, wavelengths=(2.0, 60.0)) for s in (8, 8, 9))
    x = np.linspace(-50.0, 350.0, 999)
    np.testing.assert_array_equal(first.value(x), again.value(x))
    assert np.corrcoef(first.value(x), other.value(x))[0, 1] < 0.5
    assert first == again
    copy = pickle.loads(pickle.dumps(first))
    np.testing.assert_array_equal(copy.value(x), first.value(x))
    assert len(pickle.dumps(first)) < 3000  # the table isn't in it


def test_numbers_follow_from_the_documented_rule():
    # PCG64 phases, bins of 1/λmax / q with q the smallest count for length, four long waves and 128 terms.
    shortest, longest, length = 3.0, 25.0, 500.0
    low, high = 1.0 / longest, 1.0 / shortest
    q = int(np.ceil(max(length / longest, 4, 128 * low / (high - low))))
    step = low / q
    count = int(np.floor((high - low) / step + 0.5))
    edges = np.append(low + step * np.arange(count), high)
    phases = np.random.Generator(np.random.PCG64(1)).uniform(0.0, 2.0 * np.pi, count)
    x = np.array([0.0, 10.0, 250.0, -7.0])
    r = np.zeros(4)
    spectrum = ir.spectrum("german-low")
    for i in range(count):
        amplitude = np.sqrt(2.0) * spectrum.standard_deviation(1.0 / edges[i + 1], 1.0 / edges[i])
        r += amplitude * np.cos(2.0 * np.pi * (low + (i + 0.5) * step) * x + phases[i])
    profile = ir.realize("german-low", length, seed=1, wavelengths=(shortest, longest))
    np.testing.assert_allclose(profile.value(x), r, atol=1e-11)
    # A change of these numbers changes every stored result.
    np.testing.assert_allclose(r[:3], [-0.45845986e-3, 0.91781155e-3, 0.09241667e-3], atol=1e-11)


def test_a_million_points_take_less_than_five_seconds():
    profile = ir.realize("iso8608-a", 10_000.0, seed=1, wavelengths=(0.5, 100.0))
    x = np.random.default_rng(0).uniform(0.0, 10_000.0, 1_000_000)
    start = time.perf_counter()
    values = profile.value(x)
    assert time.perf_counter() - start < 5.0
    assert values.std() == pytest.approx(profile.standard_deviation, rel=0.1)


def test_rails_follow_from_level_and_cross_level():
    pair = ir.realize_pair("german-low", 2000.0, seed=6)
    x = np.linspace(0.0, 2000.0, 5001)
    left, right = pair.left.value(x), pair.right.value(x)
    np.testing.assert_allclose(0.5 * (left + right), pair.level.value(x), atol=1e-15)
    np.testing.assert_allclose(right - left, pair.cross_level.value(x), atol=1e-15)
    np.testing.assert_array_equal(pair.level.value(x), ir.realize("german-low", 2000.0, seed=6).value(x))
    # σ² of a rail = σ² of the level + σ² of half the cross level, the angle times 1.5 m
    cross = ir.german("low", "cross level").standard_deviation() * 1.5
    assert pair.cross_level.standard_deviation == pytest.approx(cross, rel=1e-9)
    assert abs(np.corrcoef(pair.level.value(x), pair.cross_level.value(x))[0, 1]) < 0.1
    assert np.corrcoef(left, right)[0, 1] > 0.7


def test_rails_from_two_spectra():
    cross = ir.tabulated("cross", [0.02, 0.5], [1e-5, 1e-8], quantity="cross level")
    pair = ir.realize_pair(ir.spectrum("china-trunk-left"), 100.0, seed=1, cross_level=cross)
    assert pair.level.wavelengths == pytest.approx((2.0, 50.0))
    assert pair.cross_level.standard_deviation == pytest.approx(cross.standard_deviation(2.0, 50.0), rel=1e-9)
    with pytest.raises(InputError, match="is needed beside a spectrum"):
        ir.realize_pair(ir.spectrum("sncf-good"), 100.0, seed=1)


BAD = [
    (lambda: ir.realize("german-low", 0.0, seed=1), "length = 0.0: must be positive"),
    (lambda: ir.realize("german-low", 100.0, seed=-1), "seed = -1: must be a whole number, 0 or more"),
    (lambda: ir.realize("german-low", 100.0, seed=1, wavelengths=(25.0, 3.0)), "must be (shortest, longest)"),
    (
        lambda: ir.realize("german-low", 100.0, seed=1, wavelengths=(1.0, 25.0)),
        "outside the range of german-low",
    ),
    (lambda: ir.realize("german-low", 100.0, seed=1, wavelengths=(3.0, 200.0)), "(wavelength 200 m)"),
    (
        lambda: ir.realize("german-low", 100.0, seed=1, spacing=1.0),
        "spacing = 1.0: is too coarse for wavelengths of 3 m",
    ),
    (lambda: ir.realize("german-low", 100.0, seed=1, method="fff"), "Did you mean 'fft'?"),
    (lambda: ir.realize("fra-44", 100.0, seed=1), "Did you mean 'fra-4'?"),
    (lambda: ir.realize("iso8608-a", 1e6, seed=1), "needs a table of 3.2e+08 points"),
]


@pytest.mark.parametrize(("make", "message"), BAD, ids=[m for _, m in BAD])
def test_bad_requests_are_refused_with_the_rule(make, message):
    with pytest.raises(InputError) as caught:
        make()
    assert message in str(caught.value)


@pytest.mark.parametrize("method", ["fft", "cosines"])
def test_many_values_at_a_time_are_those_of_a_few(method: str) -> None:
    """Over several periods, before and behind the origin, right on points and between them."""
    profile = ir.realize("german-low", 40.0, seed=3, method=method)
    x = np.concatenate([np.linspace(-130.0, 170.0, 3001), profile.spacing * np.arange(-50.0, 50.0)])
    few = np.concatenate([profile.value(x[i : i + 100]) for i in range(0, len(x), 100)])
    many = profile.value(x.reshape(-1, 7)) if len(x) % 7 == 0 else profile.value(x)
    assert np.abs(few).max() > 1e-4
    np.testing.assert_allclose(many.ravel(), few, rtol=1e-11, atol=1e-15)
