"""Films of crossings: length, what is drawn where, and what is refused."""

import shutil

import numpy as np
import pytest
from PIL import Image

from axlespan.bridges.spans import simple_span
from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.simulate import simulate
from axlespan.plot.animation import _Film, animation
from axlespan.vehicles import Train, multibody
from axlespan.vehicles.parts import Body, Suspension, Wheel


@pytest.fixture(scope="module")
def crossing():
    bridge = simple_span(
        length=20.0, youngs_modulus=30e9, second_moment=0.3, mass_per_length=8e3, elements=10
    )
    car = multibody(
        bodies=[Body("body", 32e3, 5.0, 1.1e6)],
        wheels=[Wheel(0.0, 1200.0), Wheel(10.0, 1200.0)],
        suspensions=[Suspension(("body", "wheel1"), 1.4e6, 6e4), Suspension(("body", "wheel2"), 1.4e6, 6e4)],
    )
    return Crossing(bridge, Train.of(car), speed=25.0)


@pytest.fixture(scope="module")
def result(crossing):
    return simulate(crossing, time_step=4e-3, steps=250, line_points=41)


def test_a_film_has_its_length_and_moves(result, crossing, tmp_path):
    path = animation(result, crossing, tmp_path / "film.gif", speed=0.5, frames_per_second=5, dpi=50)
    with Image.open(path) as film:
        assert film.n_frames == 11  # 1 s, twice as slow, five a second, both ends
        assert film.size == (450, 150)
        assert film.info["duration"] == 200  # ms
        first = np.asarray(film.convert("RGB"), dtype=int)
        film.seek(5)
        later = np.asarray(film.convert("RGB"), dtype=int)
    assert (np.abs(first - later).max(axis=2) > 60).sum() > 500


def test_bodies_stand_where_the_result_says(result, crossing):
    film = _Film(result, crossing, 100.0, None)
    row = 150
    film.show(float(result.time[row]))
    body = next(p for p in film._moving if getattr(p, "get_width", lambda: 0.0)() > 5.0)
    x, z = body.get_xy()
    assert x + 0.5 * body.get_width() == pytest.approx(25.0 * result.time[row] - 5.0)
    moved = 100.0 * result.at("vehicle_displacement", "1.body.z")[row]
    assert z == pytest.approx(1.05 + moved, rel=1e-9)
    # pitch lowers the front, which is to the right
    pitch = 100.0 * result.at("vehicle_displacement", "1.body.pitch")[row]
    assert body.get_angle() == pytest.approx(-np.degrees(np.arctan(pitch)))
    deck = film._moving[0].get_xy()
    middle = deck[np.argmin(np.abs(deck[:200, 0] - 10.0)), 1]
    assert middle == pytest.approx(100.0 * result.line_displacement[row, 20], rel=5e-3)
    wheels = [p for p in film._moving if hasattr(p, "radius")]
    where = [w.center[0] for w in wheels]
    assert where == pytest.approx([25.0 * result.time[row], 25.0 * result.time[row] - 10.0])


def test_the_factor_is_round_and_shows_the_deflection(result, crossing):
    film = _Film(result, crossing, None, None)
    largest = np.abs(result.line_displacement).max()
    assert film._factor in {m * 10.0**p for m in (1, 2, 5) for p in range(5)}
    assert 0.35 < film._factor * largest / min(0.04 * 20.0, 1.3) <= 1.0


def test_refusals(result, crossing, tmp_path, monkeypatch):
    for words, options, name in (
        ("must end in .gif or .mp4", {}, "film.avi"),
        ("must be positive", {"speed": 0.0}, "film.gif"),
        ("must be zero or positive", {"exaggeration": -1.0}, "film.gif"),
        ("must be a whole number from 1 to 100", {"frames_per_second": 0}, "film.gif"),
    ):
        with pytest.raises(InputError, match=words):
            animation(result, crossing, tmp_path / name, **options)
    monkeypatch.setattr(shutil, "which", lambda name: None)
    with pytest.raises(InputError, match=r"needs ffmpeg, which is not installed. Install ffmpeg"):
        animation(result, crossing, tmp_path / "film.mp4")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="ffmpeg is not installed")
def test_mp4(result, crossing, tmp_path):
    path = animation(result, crossing, tmp_path / "film.mp4", frames_per_second=5, dpi=50)
    assert path.read_bytes()[4:8] == b"ftyp"
