"""Axle forces from text files, right and wrong ones."""

import pytest

from axlespan.errors import InputError
from axlespan.vehicles.load_trains import read_axles
from axlespan.vehicles.load_trains.table import axle_table


@pytest.fixture
def file(tmp_path):
    def write(text):
        path = tmp_path / "axles.csv"
        path.write_text(text, encoding="utf-8")
        return path

    return write


@pytest.mark.parametrize(
    ("text", "positions", "loads"),
    [
        ("position [m]; load [kN]\n0; 170\n3,5; 180\n", [0.0, 3.5], [170e3, 180e3]),
        ("position [m],load [kN]\n0,170\n3.5,180\n", [0.0, 3.5], [170e3, 180e3]),
        ("x (mm)\tforce (MN)\n1000\t0,17\n4500\t0.18\n", [0.0, 3.5], [170e3, 180e3]),
        (
            "# a comment\n\nPosition;name;Axle load\n2;a;170000 # here\n\n5.5;b;1.8e5\n",
            [0.0, 3.5],
            [170e3, 180e3],
        ),
    ],
)
def test_files(file, text, positions, loads):
    assert axle_table(file(text)) == (pytest.approx(positions), pytest.approx(loads))


def test_a_train(file):
    train = read_axles(file("position [m]; load [kN]\n0; 170\n3; 180\n"))
    assert (train.name, train.offsets.tolist()) == ("axles", [0.0, 3.0])
    assert train.static_forces().tolist() == [170e3, 180e3]


HEAD = "position [m]; load [kN]\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "{}: is empty. Begin with a line such as: position [m]; load [kN]"),
        (HEAD, "{}:1: has no axles below its header"),
        ("170\n180\n", "{}:1: '170': needs two columns. Separate them by semicolons, tabs or commas. "),
        ("0; 170\n3; 170\n", "{}:1: header = '0, 170': has no column named position. Begin with"),
        (
            "position [m]; weight_of [kN]\n0; 1\n",
            "{}:1: header = 'position [m], weight_of [kN]': has no column named load",
        ),
        ("position [m]; load [t]\n0; 22.5\n", "{}:1: load [t]: must be a force"),
        (HEAD + "0; 170\n3; \n", "{}:3: load [kN]: is missing"),
        (HEAD + "0; 170\n\n3\n", "{}:4: load [kN]: is missing"),
        (HEAD + "0; nan\n", "{}:2: load [kN] = 'nan': must be finite"),
        (HEAD + "0; 170 kN\n", "{}:2: load [kN] = '170 kN': must be a number"),
        (HEAD + "0; 170\n3; -170\n", "{}:3: load [kN] = '-170': must be positive"),
        (
            HEAD + "0; 170\n3; 170\n3; 170\n",
            "{}:4: position [m] = '3': must increase: the axle before is at 3",
        ),
        (
            "position;load\n0;170\n",
            "{}:2: load = '170': looks wrong: without a unit it is 170 N. Name the column load [kN]",
        ),
    ],
)
def test_wrong_files(file, text, message):
    path = file(text)
    with pytest.raises(InputError) as caught:
        axle_table(path)
    assert str(caught.value).startswith(message.format(path))


def test_no_file(tmp_path):
    with pytest.raises(InputError, match="cannot be read: No such file"):
        axle_table(tmp_path / "none.csv")
