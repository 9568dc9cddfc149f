"""Measured profiles: gaps, trends, band filters, resampling, estimated densities."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from axlespan import irregularity as ir
from axlespan.errors import InputError

SPACING = 0.25
X = SPACING * np.arange(8001)


def sine(wavelength, amplitude=1e-3):
    return ir.Measurement(amplitude * np.sin(2.0 * np.pi * X / wavelength + 0.4), SPACING)


def middle(measurement):
    """The middle half, away from what the ends do to a filter."""
    n = measurement.values.size
    return slice(n // 4, 3 * n // 4)


@pytest.mark.parametrize("band", ["D1", "D2", "D3"])
@pytest.mark.parametrize("order", [1, 2, 4])
def test_band_ends_pass_half_the_power_without_shift(band, order):
    shortest, longest = ir.EN13848_BANDS[band]
    for wavelength, gain in ((shortest, np.sqrt(0.5)), (longest, np.sqrt(0.5))):
        # Long records keep the ends' transients away from the middle.
        raw = sine(wavelength)
        got = raw.filtered(band, order=order)
        m = middle(raw)
        # Projection on the input: a shift in phase would lower it and raise the rest.
        share = np.dot(got.values[m], raw.values[m]) / np.dot(raw.values[m], raw.values[m])
        rest = got.values[m] - share * raw.values[m]
        assert share == pytest.approx(gain, rel=0.01)
        assert np.abs(rest).max() < 0.02e-3


def test_band_passes_its_middle_and_stops_its_neighbors():
    for wavelength, gain in ((8.0, 1.0), (100.0, 0.0), (1.0, 0.0)):
        raw = sine(wavelength)
        m = middle(raw)
        ratio = np.std(raw.filtered("D1").values[m]) / np.std(raw.values[m])
        assert ratio == pytest.approx(gain, abs=0.01)
    # Twice the longest wavelength: analytic gain 1/(1 + ((w² - w1 w2)/(B w))⁴) of two runs of order two
    w1, w2, w = (np.tan(np.pi * SPACING / s) for s in (25.0, 3.0, 50.0))
    width = (w2 - w1) / (np.sqrt(2.0) - 1.0) ** 0.25
    gain = 1.0 / (1.0 + ((w * w - w1 * w2) / (width * w)) ** 4)
    raw = sine(50.0)
    m = middle(raw)
    assert np.std(raw.filtered("D1").values[m]) / np.std(raw.values[m]) == pytest.approx(gain, rel=0.01)


def test_standard_deviations_per_band_of_a_realization():
    spectrum = ir.spectrum("german-low")
    profile = ir.realize(spectrum, 20_000.0, seed=4, wavelengths=(3.0, 150.0))
    record = ir.Measurement(profile.value(np.arange(0.0, 20_000.0, 0.5)), 0.5)
    got = record.standard_deviations()
    for name, sigma in got.items():
        # The filter's flanks let in some of the longer, larger waves; 20 % is what they carry.
        assert sigma == pytest.approx(spectrum.standard_deviation(*ir.EN13848_BANDS[name]), rel=0.2)
        assert record.psd(segment=2500.0).standard_deviation(name) == pytest.approx(
            spectrum.standard_deviation(*ir.EN13848_BANDS[name]), rel=0.07
        )
    assert set(got) == {"D1", "D2", "D3"}
    assert set(ir.Measurement(record.values[:250], 0.5).standard_deviations()) == {"D1"}


def test_detrending_removes_polynomials():
    u = X / X[-1]
    wave = sine(7.0).values
    bent = ir.Measurement(wave + 3.0 - 2.0 * u + 0.7 * u**2, SPACING)
    np.testing.assert_allclose(bent.detrended(2).values, wave, atol=2e-5)
    assert np.abs(bent.detrended(1).values).max() > 0.05


def test_resampling_keeps_waves_and_stops_aliases():
    wave = sine(20.0)
    for spacing in (0.1, 0.25, 1.0):
        fine = wave.resampled(spacing)
        inside = slice(round(100 / spacing), round(1900 / spacing))
        expected = 1e-3 * np.sin(2.0 * np.pi * fine.x / 20.0 + 0.4)
        np.testing.assert_allclose(fine.values[inside], expected[inside], atol=2e-6)
        assert fine.spacing == spacing
        assert fine.x[-1] <= X[-1] + 1e-9
    # 1.2 m can't be sampled at 1 m: unfiltered it would appear as 6 m with its full size.
    alias = sine(1.2).resampled(1.0)
    assert np.abs(alias.values[100:1900]).max() < 0.03e-3


def test_profiles_of_a_measurement():
    wave = sine(5.0)
    at = np.linspace(10.0, 1990.0, 777)
    exact = 1e-3 * np.sin(2.0 * np.pi * at / 5.0 + 0.4)
    k = 2.0 * np.pi / 5.0
    # Linear: (k h)²/8 of the amplitude; cubic spline: (k h)⁴ 5/384, its slope (k h)³/24 of the slope's.
    np.testing.assert_allclose(wave.table().value(at), exact, atol=1.01e-3 * (k * SPACING) ** 2 / 8)
    np.testing.assert_allclose(wave.spline().value(at), exact, atol=1e-3 * (k * SPACING) ** 4 * 5 / 384)
    slope = 1e-3 * k * np.cos(k * at + 0.4)
    np.testing.assert_allclose(wave.spline().slope(at), slope, atol=1e-3 * k * (k * SPACING) ** 3 / 24)


def test_unequal_points_are_refused_or_interpolated():
    x = np.sort(np.random.default_rng(3).uniform(0.0, 100.0, 4000))
    r = 1e-3 * np.sin(x)
    with pytest.raises(InputError, match="is off the regular grid"):
        ir.Measurement.from_points(x, r)
    record = ir.Measurement.interpolated(x, r, 0.1)
    np.testing.assert_allclose(record.values[5:-5], 1e-3 * np.sin(record.x)[5:-5], atol=1e-8)
    # Positions that were rounded for printing are regular.
    fine = np.round(0.3048 * np.arange(500), 2)
    assert ir.Measurement.from_points(fine, np.zeros(500)).spacing == pytest.approx(0.3048, rel=1e-4)


@pytest.mark.parametrize(
    ("rows", "message"),
    [
        (
            ["0,1", "0.5,2", "1.5,3", "2.0,4", "2.5,5"],
            "m.csv:4: x[2] = 1.5: is off the regular grid: the step from 0.5 m is 1 m",
        ),
        (["0,1", "0.5,", "1.0,3"], "m.csv:3: r[1] = nan: has a gap"),
        (["0,1", "0.5,nan", "1.0,3"], "m.csv:3: r[1] = nan: has a gap"),
        (["0,1", "0.5,2", "0.5,3"], "m.csv:4: x[2] = 0.5: must be larger than x[1] = 0.5"),
    ],
)
def test_gaps_in_files_are_named_by_line(tmp_path, rows, message):
    path = tmp_path / "m.csv"
    path.write_text("\n".join(["x,level", *rows]) + "\n")
    with pytest.raises(InputError) as caught:
        ir.Measurement.from_csv(path)
    assert message in str(caught.value)


def test_csv_in_millimeters(tmp_path):
    path = tmp_path / "m.csv"
    path.write_text("x;level\n10;1,5\n10,5;2,5\n11;-1\n")
    record = ir.Measurement.from_csv(path, scale=1e-3)
    np.testing.assert_allclose(record.values, [1.5e-3, 2.5e-3, -1e-3])
    assert (record.start, record.spacing, record.length) == (10.0, 0.5, 1.0)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: sine(5.0).filtered("D4"), "is not a band of EN 13848-1: D1, D2, D3"),
        (lambda: sine(5.0).filtered((0.5, 3.0)), "spacing = 0.25: is too coarse for wavelengths of 0.5 m"),
        (lambda: ir.Measurement(np.zeros(900), 0.25).filtered("D3"), "is too short for wavelengths of 150 m"),
        (lambda: sine(5.0).filtered("D1", order=0), "order = 0: must be a whole number from 1 to 8"),
        (lambda: sine(5.0).detrended(11), "degree = 11: must be a whole number from 0 to 10"),
        (lambda: sine(5.0).resampled(500.0), "at least 20 steps are needed"),
        (
            lambda: ir.estimate_psd(np.zeros(100), 0.25, segment=30.0),
            "segment = 30.0: must hold at least 8 values",
        ),
        (lambda: ir.estimate_psd([1.0] * 9 + [np.inf], 0.25), "values[9] = inf: has a gap"),
    ],
)
def test_bad_requests_are_refused_with_the_rule(make, message):
    with pytest.raises(InputError) as caught:
        make()
    assert message in str(caught.value)


def test_estimate_of_white_noise_is_flat():
    # Independent values of variance s² at distance h: one-sided S = 2 s² h up to the Nyquist frequency.
    values = np.random.default_rng(5).normal(0.0, 1e-3, 200_000)
    estimate = ir.estimate_psd(values, 0.5, segment=100.0)
    inner = estimate.psd[(estimate.n > 0.05) & (estimate.n < 0.95)]
    np.testing.assert_allclose(
        inner, 2 * 1e-6 * 0.5, rtol=0.2
    )  # 2000 segments: 2.2 % each, five sigma and more
    assert inner.mean() == pytest.approx(1e-6, rel=0.01)
    assert estimate.segments == 1999


def test_an_estimate_can_be_realized_again():
    source = ir.realize("german-low", 20_000.0, seed=1, wavelengths=(3.0, 150.0))
    record = ir.Measurement(source.value(np.arange(0.0, 20_000.0, 0.5)), 0.5)
    spectrum = record.psd(segment=1000.0).as_spectrum("line 7", (4.0, 100.0))
    copy = ir.realize(spectrum, 1000.0, seed=2, wavelengths=(5.0, 50.0))
    target = ir.spectrum("german-low").standard_deviation(5.0, 50.0)
    assert copy.standard_deviation == pytest.approx(target, rel=0.05)


def test_importing_the_package_leaves_scipy_alone():
    code = """
import sys, axlespan.irregularity as ir
ir.realize("fra-4", 50.0, seed=1).value(1.0)
print("scipy" in sys.modules)"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
    assert all(hasattr(ir, name) for name in ir.__all__)
    with pytest.raises(AttributeError, match="no attribute 'Mesurement'"):
        _ = ir.Mesurement


def test_the_unit_of_the_header_holds_unless_a_scale_is_given(tmp_path):
    path = tmp_path / "m.csv"
    path.write_text("x [m];level [mm]\n10;1,5\n10,5;2,5\n11;-1\n")
    for scale in (None, 1e-3):
        np.testing.assert_allclose(ir.Measurement.from_csv(path, scale=scale).values, [1.5e-3, 2.5e-3, -1e-3])
