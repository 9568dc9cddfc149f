"""Spectra: standard deviations per band, units, sides, the library."""

from __future__ import annotations

import pickle
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from axlespan import irregularity as ir
from axlespan.errors import InputError

D1, D2, D3 = ir.EN13848_BANDS.values()

# Standard deviations [mm] in D1 (3-25 m), D2 (25-70 m), D3 (70-150 m), from an independent integration of the
# published formulas with the coefficients of the sources.
SIGMA = {
    ("german-low", "vertical"): (0.984, 1.651, 2.122),
    ("german-high", "vertical"): (1.611, 2.702, 3.474),
    ("german-low", "alignment"): (0.714, 1.197, 1.539),
    ("german-high", "alignment"): (1.213, 2.035, 2.616),
    ("fra-new-1", "vertical"): (8.541, 14.488, 19.577),
    ("fra-new-2", "vertical"): (7.832, 13.285, 17.952),
    ("fra-new-3", "vertical"): (6.408, 10.870, 14.689),
    ("fra-new-4", "vertical"): (5.691, 9.654, 13.045),
    ("fra-new-5", "vertical"): (3.553, 6.027, 8.144),
    ("fra-new-6", "vertical"): (1.429, 2.424, 3.276),
    ("fra-1", "vertical"): (1.647, 3.969, 9.858),
    ("fra-2", "vertical"): (1.244, 2.996, 7.442),
    ("fra-3", "vertical"): (0.927, 2.234, 5.548),
    ("fra-4", "vertical"): (0.693, 1.670, 4.148),
    ("fra-5", "vertical"): (0.524, 1.262, 3.134),
    ("fra-6", "vertical"): (0.414, 0.997, 2.476),
    ("sncf-good", "vertical"): (1.047, 1.066, 0.820),
    ("sncf-poor", "vertical"): (1.964, 1.999, 1.538),
    ("china-ballastless", "vertical"): (0.286, 0.362, 0.765),
    ("china-trunk-left", "vertical"): (1.951, 1.455, 0.735),
}


@pytest.mark.parametrize(("name", "quantity"), SIGMA)
def test_standard_deviation_per_band(name, quantity):
    # SNCF's formula is meant for 2 m to 40 m; the reference extrapolates it to the longer bands.
    spectrum = ir.spectrum(name, quantity)
    if name.startswith("sncf"):
        spectrum = spectrum.extended(2.0, 150.0)
    got = [1e3 * spectrum.standard_deviation(*band) for band in (D1, D2, D3)]
    np.testing.assert_allclose(got, SIGMA[name, quantity], rtol=0.0, atol=0.5001e-3)


def test_road_class_a_has_its_closed_form():
    # S = Gd n0² / n² integrates to Gd n0² (λmax - λmin).
    got = ir.iso8608("A").standard_deviation(0.5, 100.0)
    assert got == pytest.approx(np.sqrt(16e-6 * 0.01 * 99.5), rel=1e-12)
    assert 1e3 * got == pytest.approx(3.990, abs=5e-4)


@pytest.mark.parametrize("name", ir.spectrum_names())
def test_variance_is_the_integral_of_the_density(name):
    spectrum = ir.spectrum(name)
    low, high = spectrum.wavelengths
    breaks = [0.0187, 0.0474, 0.1533] if name == "china-ballastless" else []
    t = [np.log(1.0 / high), *np.log(breaks), np.log(1.0 / low)]
    variance = sum(
        quad(lambda s: float(spectrum.psd(np.exp(s))) * np.exp(s), a, b, epsrel=1e-10, epsabs=0.0)[0]
        for a, b in pairwise(t)
    )
    # Jumps of the density at China's break points fall inside a panel.
    tolerance = 1e-5 if breaks else 1e-9
    assert spectrum.standard_deviation() == pytest.approx(np.sqrt(variance), rel=tolerance)


def test_conversions_between_arguments():
    spectrum = ir.spectrum("german-low")
    omega = np.array([0.05, 0.2, 1.0])
    a, wc, wr = 4.032e-7, 0.8246, 0.0206
    by_hand = a * wc**2 / ((omega**2 + wr**2) * (omega**2 + wc**2))
    np.testing.assert_allclose(spectrum.psd_angular(omega), by_hand, rtol=1e-12)
    np.testing.assert_allclose(spectrum.psd(omega / (2 * np.pi)), 2 * np.pi * by_hand, rtol=1e-12)
    # S(f) = S(Ω) 2π / v
    speed = 80.0
    np.testing.assert_allclose(
        spectrum.psd_time(omega / (2 * np.pi) * speed, speed), 2 * np.pi * by_hand / speed
    )
    assert spectrum.unit == "m^2/(rad/m)"
    assert ir.spectrum("fra-4").unit == "m^2/(1/m)"


def test_two_sided_density_is_doubled():
    one = ir.Spectrum("one", lambda n: 1e-6 / n**2, (1.0, 50.0))
    two = ir.Spectrum("two", lambda n: 0.5e-6 / n**2, (1.0, 50.0), sides="two-sided")
    assert two.standard_deviation() == pytest.approx(one.standard_deviation(), rel=1e-14)


def test_old_and_new_fra_formulas_by_hand():
    n, n1, n2 = 0.1, 0.0233, 0.131
    assert ir.fra(4).psd(n) == pytest.approx(
        2.75e-8 * n2**2 * (n**2 + n1**2) / (n**4 * (n**2 + n2**2)), rel=1e-12
    )
    n1, n2 = 0.0292, 0.2329
    gauge = 1.750e-8 * n2**2 / ((n**2 + n1**2) * (n**2 + n2**2))
    assert ir.fra(4, "gauge").psd(n) == pytest.approx(gauge, rel=1e-12)
    omega, wc, ws = 0.5, 0.8245, 0.4380
    level = 0.25 * 0.0339e-4 * wc**2 / (omega**2 * (omega**2 + wc**2))
    cross = 4 * 0.25 * 0.0339e-4 * wc**2 / ((omega**2 + wc**2) * (omega**2 + ws**2))
    assert ir.fra_new(6).psd_angular(omega) == pytest.approx(level, rel=1e-12)
    assert ir.fra_new(6, "cross level").psd_angular(omega) == pytest.approx(cross, rel=1e-12)


def test_german_cross_level_is_an_angle_and_becomes_a_height():
    angle = ir.german("low", "cross level")
    assert angle.unit == "rad^2/(rad/m)"
    omega, wc, wr, ws, b = 0.3, 0.8246, 0.0206, 0.4380, 0.75
    by_hand = (
        4.032e-7 / b**2 * wc**2 * omega**2 / ((omega**2 + wr**2) * (omega**2 + wc**2) * (omega**2 + ws**2))
    )
    assert angle.psd_angular(omega) == pytest.approx(by_hand, rel=1e-12)
    height = angle.as_height(1.5)
    assert height.unit == "m^2/(rad/m)"
    assert height.psd_angular(omega) == pytest.approx(1.5**2 * by_hand, rel=1e-12)
    with pytest.raises(InputError, match="is a length already"):
        height.as_height(1.5)


def test_china_pieces_meet_and_percentiles_scale():
    for quantity in ("vertical", "alignment", "cross level", "gauge"):
        spectrum = ir.china_ballastless(quantity)
        for f in spectrum.density.breaks:
            # The coefficients are printed to five digits: the pieces meet within a percent.
            assert spectrum.psd(f * (1 + 1e-9)) == pytest.approx(
                float(spectrum.psd(f * (1 - 1e-9))), rel=0.01
            )
    mean, high = ir.china_ballastless(), ir.china_ballastless(percentile=0.9)
    assert high.psd(0.1) / mean.psd(0.1) == pytest.approx(2.303, abs=5e-4)
    assert high.status == "from memory: check against the standard"
    assert ir.china_short_wave().psd(10.0) == pytest.approx(0.036e-6 * 10.0**-3.15, rel=1e-12)


@pytest.mark.parametrize("rail", ["left", "right"])
@pytest.mark.parametrize("quantity", ["vertical", "alignment", "cross level"])
def test_trunk_line_fractions_have_no_poles_in_their_range(rail, quantity):
    n = np.geomspace(1.0 / 150.0, 1.0, 4001)
    density = ir.china_trunk(rail, quantity).psd(n)
    assert density.min() > 0.0
    assert np.abs(np.diff(np.log(density))).max() < 0.05


def test_road_classes_step_by_four_and_are_found_again():
    for i, letter in enumerate("ABCDEFGH"):
        gd = float(ir.iso8608(letter).psd(0.1))
        assert gd == pytest.approx(16e-6 * 4**i, rel=1e-12)
        assert ir.iso8608_class(gd) == letter
    # 1e-6 m³ at Ω0 = 1 rad/m for class A, ISO 8608's other form
    assert ir.iso8608("a").psd_angular(1.0) == pytest.approx(1e-6 * 16 * 0.01 * 2 * np.pi, rel=1e-12)
    assert ir.iso8608_class(32.1e-6) == "B"
    with pytest.raises(InputError, match="rougher than class H"):
        ir.iso8608_class(1.0)


def test_tabulated_spectrum_is_a_line_between_logarithms():
    table = ir.tabulated("mine", [0.01, 1.0], [1e-4, 1e-8])
    n = np.geomspace(0.01, 1.0, 7)
    np.testing.assert_allclose(table.psd(n), 1e-8 / n**2, rtol=1e-12)
    assert table.wavelengths == pytest.approx((1.0, 100.0))
    angular = ir.tabulated("mine", [0.1, 1.0], [1e-4, 1e-6], argument="rad/m")
    assert angular.wavelengths == pytest.approx((2 * np.pi, 20 * np.pi))
    assert angular.psd_angular(0.1) == pytest.approx(1e-4)


def test_scaling_to_a_standard_deviation():
    scaled = ir.spectrum("german-low").scaled_to(0.4e-3, 3.0, 25.0)
    assert scaled.standard_deviation(3.0, 25.0) == pytest.approx(0.4e-3, rel=1e-12)
    assert "density times" in scaled.note


def test_every_spectrum_of_the_library_says_where_it_comes_from():
    assert len(ir.spectrum_names()) == 28
    for quantity in ("vertical", "alignment", "cross level", "gauge"):
        for name in ir.spectrum_names(quantity):
            spectrum = ir.spectrum(name, quantity)
            assert spectrum.name == name
            assert spectrum.quantity == quantity
            assert len(spectrum.source) > 10
            assert spectrum.status in ("found", "from memory: check against the standard")
            assert pickle.loads(pickle.dumps(spectrum)) == spectrum
    assert ir.spectrum("fra-new-3", "alignment").status.startswith("from memory")
    assert ir.spectrum("fra-new-3").status == "found"


BAD = [
    (lambda: ir.spectrum("german-lo"), "Did you mean 'german-low'?"),
    (lambda: ir.spectrum("sncf-good", "gauge"), "is not given by the spectrum sncf-good; it has vertical"),
    (
        lambda: ir.spectrum("sncf-good").psd(1.0 / 50.0),
        "lies outside the range of sncf-good, wavelengths from 2 m to 40 m",
    ),
    (lambda: ir.spectrum("german-low").standard_deviation(1.0, 25.0), "n = '1 1/m (wavelength 1 m)'"),
    (lambda: ir.spectrum("german-low").standard_deviation(25.0, 3.0), "must be (shortest, longest)"),
    (lambda: ir.spectrum("german-low").psd([0.0, 0.1]), "n = '0 1/m'"),
    (lambda: ir.fra(7), "track_class = 7: must be a whole number from 1 to 6"),
    (lambda: ir.german("medium"), "disturbance = 'medium': is not known; known are low, high"),
    (lambda: ir.iso8608("I"), "is not known; known are a, b, c"),
    (lambda: ir.china_ballastless(percentile=90.0), "Write 0.9 for 90 %"),
    (
        lambda: ir.tabulated("t", [1.0, 1.0], [1.0, 1.0]),
        "arguments[1] = 1.0: must be larger than arguments[0]",
    ),
    (lambda: ir.tabulated("t", [1.0, 2.0], [1.0, 0.0]), "smallest of densities = 0.0: must be positive"),
    (
        lambda: ir.Spectrum("s", lambda n: -n, (1.0, 2.0)).psd(0.7),
        "must return finite densities that aren't negative",
    ),
]


@pytest.mark.parametrize(("make", "message"), BAD, ids=[m for _, m in BAD])
def test_bad_requests_are_refused_with_the_rule(make, message):
    with pytest.raises(InputError) as caught:
        make()
    assert message in str(caught.value)
