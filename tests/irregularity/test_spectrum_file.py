"""A spectrum from a file: units, points, what is wrong by line."""

import numpy as np
import pytest

from axlespan import irregularity as ir
from axlespan.errors import InputError


def write(tmp_path, text):
    path = tmp_path / "mine.csv"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    "text",
    [
        "n [1/m]; S [m^2/(1/m)]\n0.01; 2e-4\n0.1; 2e-6\n1; 2e-8\n",
        "n [1/m],S [mm^2/(1/m)]\n0.01,200\n0.1,2\n1,0.02\n",
        "\ufeffn [cycles/m]\tS [mm² m]\n# measured\n0,01\t200\n\n0,1\t2\n1\t0,02\n",
        "n [1/m]; S [m³]\n0.01; 2e-4\n1; 2e-8\n",
    ],
)
def test_the_same_spectrum_in_several_units(tmp_path, text):
    """S = 2e-8 / n^2 m^3 is straight in a double logarithmic plot."""
    spectrum = ir.read_spectrum(write(tmp_path, text))
    n = np.geomspace(0.01, 1.0, 31)
    np.testing.assert_allclose(spectrum.psd(n), 2e-8 / n**2, rtol=1e-12)
    assert spectrum.name == "mine"
    assert spectrum.wavelengths == pytest.approx((1.0, 100.0))


def test_angular_wavenumbers(tmp_path):
    """S(n) = 2 pi S(omega) at omega = 2 pi n; the variance is the integral over either."""
    path = write(tmp_path, "omega [rad/m]; S [cm^2/(rad/m)]\n0.1; 1\n10; 1e-4\n")
    spectrum = ir.read_spectrum(path)
    omega = np.geomspace(0.1, 10.0, 21)
    np.testing.assert_allclose(spectrum.psd_angular(omega), 1e-6 / omega**2, rtol=1e-12)
    variance = 1e-6 * (1.0 / 0.1 - 1.0 / 10.0)
    assert spectrum.standard_deviation() == pytest.approx(np.sqrt(variance), rel=1e-9)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "mine.csv: is empty. Begin with a line such as"),
        ("0.01; 2e-4\n1; 2e-8\n", "mine.csv:1: value = '0.01; 2e-4': must name both columns|must name both columns"),
        ("n [1/m]; S [m^2]\n1; 1\n2; 1\n", r"mine.csv:1: S \[m\^2\]: is no unit of a density"),
        ("n [m]; S [m^3]\n1; 1\n2; 1\n", r"mine.csv:1: n \[m\]: must be in 1/m or rad/m"),
        ("n [1/m]; S [m^2/(rad/m)]\n1; 1\n2; 1\n", r"mine.csv:1: S \[m\^2/\(rad/m\)\]: must be per 1/m"),
        ("n [1/m]; S [m^3]\n1; 1\n", "mine.csv:1: needs at least two points"),
        ("n [1/m]; S [m^3]\n1; 1\n2\n", "mine.csv:3: needs a wavenumber and a density"),
        ("n [1/m]; S [m^3]\n1; 1\n2; -1\n", r"mine.csv:3: S \[m\^3\] = '-1': must be positive and finite"),
        ("n [1/m]; S [m^3]\n1; 1\n2; nan\n", "mine.csv:3: .* must be positive and finite"),
        ("n [1/m]; S [m^3]\n1; 1\n2; x\n", "mine.csv:3: .* must be a number"),
        ("n [1/m]; S [m^3]\n1; 1\n1; 1\n", "mine.csv:3: .* must increase: the one before is 1"),
        ("n S\n1 1\n", "mine.csv:1: needs two columns"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_told_with_its_line(tmp_path, text, message):
    with pytest.raises(InputError, match=message):
        ir.read_spectrum(write(tmp_path, text))
