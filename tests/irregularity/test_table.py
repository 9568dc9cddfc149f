"""Tables of points, from memory and from files."""

from __future__ import annotations

import numpy as np
import pytest

from axlespan import irregularity as ir
from axlespan.errors import InputError

TABLE = ir.Table([0.0, 2.0, 3.0], [0.0, 4e-3, 1e-3])


def test_table_is_linear_between_points_and_its_ends_go_on():
    np.testing.assert_allclose(TABLE.value([-1.0, 0.0, 1.0, 2.5, 3.0, 3.1]), [0, 0, 2e-3, 2.5e-3, 1e-3, 1e-3])


def test_slope_is_that_of_the_piece_to_the_right():
    np.testing.assert_allclose(TABLE.slope([-1.0, 0.0, 1.0, 2.0, 2.5, 3.0]), [0, 2e-3, 2e-3, -3e-3, -3e-3, 0])
    np.testing.assert_array_equal(TABLE.curvature([0.5, 2.0]), 0.0)


def test_table_keeps_a_copy_of_its_points():
    x = np.array([0.0, 1.0])
    table = ir.Table(x, [1.0, 2.0])
    x[:] = 9.0
    np.testing.assert_array_equal(table.x, [0.0, 1.0])
    with pytest.raises(ValueError, match="read-only"):
        table.x[0] = 5.0


@pytest.mark.parametrize(
    ("x", "r", "message"),
    [
        ([0.0, 2.0, 2.0], [0.0, 1.0, 2.0], "x[2] = 2.0: must be larger than x[1] = 2"),
        ([0.0, 3.0, 2.0], [0.0, 1.0, 2.0], "x[2] = 2.0: must be larger than x[1] = 3"),
        ([0.0, 1.0, 2.0], [0.0, np.nan, 2.0], "r[1] = nan: has a gap"),
        ([0.0, 1.0], [0.0], "r = 'shape (1,)': must be a list of at least 2 numbers"),
        ([0.0, 1.0], [0.0, 1.0, 2.0], "r = 3: must have as many entries as x, 2"),
    ],
)
def test_bad_points_are_named_by_their_index(x, r, message):
    with pytest.raises(InputError) as caught:
        ir.Table(x, r)
    assert message in str(caught.value)


FILES = {
    "comma": "x,r\n0,0\n1.5,2\n3,-1\n",
    "semicolon, decimal comma": "Ort [m];Höhe [mm]\n0;0\n1,5;2\n3;-1,0\n",
    "tab": "0\t0\n1.5\t2\n3\t-1\n",
    "blanks and comments": "# measured in May\n\n0 0\n1.5   2 # bolt\n3 -1\n",
}


@pytest.mark.parametrize("kind", FILES)
def test_csv_dialects(tmp_path, kind):
    path = tmp_path / "profile.csv"
    path.write_text(FILES[kind], encoding="utf-8")
    table = ir.Table.from_csv(path, scale=1e-3)
    np.testing.assert_allclose(table.x, [0.0, 1.5, 3.0])
    np.testing.assert_allclose(table.r, [0.0, 2e-3, -1e-3])


def test_csv_columns_by_name_and_number(tmp_path):
    path = tmp_path / "profile.csv"
    path.write_text("km,x,left,right\n0,0,1,2\n0,1,3,4\n")
    np.testing.assert_allclose(ir.Table.from_csv(path, columns=("x", "right")).r, [2.0, 4.0])
    np.testing.assert_allclose(ir.Table.from_csv(path, columns=(1, 2)).r, [1.0, 3.0])


@pytest.mark.parametrize(
    ("text", "columns", "message"),
    [
        ("x,r\n0,0\n1,1\n\n1,2\n", (0, 1), "p.csv:5: x[2] = 1.0: must be larger than x[1] = 1"),
        ("x,r\n0,0\n1,\n2,2\n", (0, 1), "p.csv:3: r[1] = nan: has a gap"),
        ("0,0\n1,one\n", (0, 1), "p.csv:2: column 1 = 'one': must be a number"),
        ("0,0\n1\n", (0, 1), "p.csv:2: row: has 1 fields, but column 1 is asked for"),
        ("x,left\n0,0\n", ("x", "lefd"), "Did you mean 'left'?"),
        ("0,0\n1,1\n", ("x", "r"), "is a name, but the file has no header row"),
        ("# nothing\n", (0, 1), "p.csv: file: has no rows"),
    ],
)
def test_bad_files_are_named_by_line(tmp_path, text, columns, message):
    path = tmp_path / "p.csv"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        ir.Table.from_csv(path, columns=columns)
    assert message in str(caught.value)


def test_missing_file_is_an_input_error(tmp_path):
    with pytest.raises(InputError, match="cannot be read: No such file"):
        ir.Table.from_csv(tmp_path / "absent.csv")


@pytest.mark.parametrize(
    ("text", "x", "r"),
    [
        ("x [m]; r [mm]\n0; 0\n1; 1,5\n2; 0\n", [0.0, 1.0, 2.0], [0.0, 1.5e-3, 0.0]),
        ("chainage [km],height (mm)\n0.5,0\n0.6,2\n", [500.0, 600.0], [0.0, 2e-3]),
        ("x [m] r [mm]\n0 0\n1 1.5\n", [0.0, 1.0], [0.0, 1.5e-3]),
        ("x;r (smoothed)\n0;0\n1;0.001\n", [0.0, 1.0], [0.0, 1e-3]),
    ],
)
def test_units_of_the_header_hold(tmp_path, text, x, r):
    path = tmp_path / "profile.csv"
    path.write_text(text)
    table = ir.Table.from_csv(path)
    np.testing.assert_allclose(table.x, x, rtol=1e-14)
    np.testing.assert_allclose(table.r, r, rtol=1e-14)


def test_columns_are_found_without_their_units(tmp_path):
    path = tmp_path / "profile.csv"
    path.write_text("km [km];x [m];left [mm];right [mm]\n0;0;1;2\n0;1;3;4\n")
    np.testing.assert_allclose(ir.Table.from_csv(path, columns=("x", "right")).r, [2e-3, 4e-3])


def test_a_unit_that_is_no_length_is_refused(tmp_path):
    path = tmp_path / "p.csv"
    path.write_text("x [m]; r [kN]\n0; 0\n1; 1\n")
    with pytest.raises(InputError, match=r"p\.csv:1: r \[kN\]: must be a length; 'kN' is a force"):
        ir.Table.from_csv(path)


def test_ends_go_on_in_integral_and_spline():
    """The antiderivative against a sum over a fine grid, far beyond both ends."""
    x, r = np.array([0.0, 1.0, 3.0]), np.array([2e-3, 0.0, 1e-3])
    grid = np.linspace(-5.0, 9.0, 140_001)
    for profile in (ir.Table(x, r), ir.Spline(x, r)):
        assert profile.value([-5.0, 9.0]).tolist() == pytest.approx([2e-3, 1e-3])
        assert profile.slope([-5.0, 9.0]).tolist() == [0.0, 0.0]
        exact = profile.integral(9.0) - profile.integral(-5.0)
        values = profile.value(grid)
        assert exact == pytest.approx(
            float(np.sum(0.5 * (values[1:] + values[:-1]) * np.diff(grid))), rel=1e-6
        )
