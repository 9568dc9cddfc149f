"""The cases of the book on solid elements; the long one in its parts."""

import numpy as np
import pytest

from axlespan.verification import solids


def test_the_coarse_beam_is_within_its_tolerances(check_case):
    rows = check_case(solids.coarse_beam)
    assert rows["first bending frequency"].expected == pytest.approx(29.555, abs=1e-3)
    dent = rows["deflection under a unit load"]
    assert 1.005 < dent.obtained / dent.expected < 1.03  # beam theory has none


def test_rows_of_the_long_case_compare_the_windows_of_the_figures():
    """First mass until 3 s, last from 11 s, against curves that are 3 % too deep."""

    class Ran:
        time = 1e-3 * np.arange(14_001)

        @staticmethod
        def at(quantity, name):
            assert quantity == "vehicle_displacement"
            return 1.03 * curves[:, {"1.body.z": 0, "50.body.z": 49}[name]]

    curves = np.zeros((14_001, 50))
    curves[1_000:3_001, 0] = -12e-3  # and 0 before
    curves[12_000, 49] = -11e-3
    curves[5_000, 0] = curves[10_000, 49] = -1.0  # outside the windows
    rows = {row.quantity: row for row in solids._mass_rows(Ran, curves[:, [0, 49]], "thin", 0.045, "by hand")}
    assert list(rows) == [
        f"{who} mass, thin beam{end}" for who in ("first", "last") for end in ("", ", lowest", ", highest")
    ]
    assert rows["first mass, thin beam"].error == pytest.approx(0.03)
    assert rows["last mass, thin beam, lowest"].expected == pytest.approx(-11.0)
    assert (
        rows["first mass, thin beam"].ok and not rows["first mass, thin beam, lowest"].ok
    )  # 2 % are allowed there
