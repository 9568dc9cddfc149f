"""The figures of every run, as axes and as files."""

import struct
import subprocess
import sys

import numpy as np
import pytest
from matplotlib import image
from matplotlib import pyplot as plt

from axlespan.bridges.spans import simple_span
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.simulate import simulate
from axlespan.plot import draw_figures, save, standard_figures
from axlespan.plot.style import COLORS
from axlespan.vehicles.simple import axle_loads
from axlespan.vehicles.train import Train

ALL = ["displacement", "acceleration", "contact_force", "vehicle_acceleration", "reactions"]


def size_of(file):
    """Width and height [pixels] from the head of a PNG."""
    head = file.read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", head[16:24])


def test_every_run_has_five_figures(train):
    figures = standard_figures(train, span=(0.0, 25.0))
    assert list(figures) == ALL
    for figure in figures.values():
        (ax,) = figure.axes
        assert len(ax.get_legend().get_texts()) <= 6
        assert "[" in ax.get_ylabel() and "[" in ax.get_xlabel()
        assert sum(len(line.get_xdata()) for line in ax.get_lines()) < 20_000
    midspan = figures["displacement"].axes[0].get_lines()[0].get_ydata()
    assert midspan.min() == pytest.approx(1e3 * train.sensor_displacement.min(), rel=1e-12)
    assert plt.get_fignums() == []


def test_files_are_images_with_something_in_them(train, tmp_path):
    written = save(standard_figures(train), tmp_path / "deep" / "figures")
    assert [file.name for file in written] == [f"{name}.png" for name in ALL]
    for file in written:
        assert size_of(file) == (1080, 540)
        pixels = image.imread(file)[:, :, :3]
        blue = np.array([int(COLORS[0][i : i + 2], 16) for i in (1, 3, 5)]) / 255.0
        assert (np.abs(pixels - blue).max(axis=2) < 0.05).sum() > 200
        border = np.concatenate([pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1]])
        assert border.min() > 0.99  # nothing is cut off


def test_figures_of_a_crossing_show_its_structure(crossings, single, tmp_path):
    names = draw_figures(single, crossings["3.1"], tmp_path)
    assert names == [f"{name}.png" for name in ALL]
    assert all((tmp_path / name).exists() for name in names)


def test_moving_forces_have_no_figures_of_what_does_not_move():
    bridge = simple_span(
        length=25.0, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=20
    )
    crossing = Crossing(bridge, Train.of(axle_loads(loads=170e3, positions=[0.0, 3.0])), speed=20.0)
    result = simulate(crossing, time_step=5e-3, steps=100)
    assert list(standard_figures(result)) == ["reactions"]


def test_a_train_that_stands_is_drawn_over_time(make):
    result = make(contact=("1.1",))
    result.contact_position[:] = 12.5
    assert standard_figures(result)["contact_force"].axes[0].get_xlabel() == "Time [s]"


def test_bodies_by_other_names_are_found(make):
    result = make(vehicle_dof=("1.wheel1.z", "1.tractor.z", "1.tractor.pitch", "2.tractor.z"))
    (ax,) = standard_figures(result)["vehicle_acceleration"].axes
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["1.tractor.z", "2.tractor.z"]
    only_wheels = make(vehicle_dof=("1.wheel1.z",))
    assert standard_figures(only_wheels) == {}


@pytest.mark.parametrize("n_time", [0, 1])
def test_nothing_computed_is_no_figure(make, n_time):
    assert standard_figures(make(n_time=n_time, sensor=("a",), contact=("1.1",))) == {}


def test_a_folder_that_cannot_be_made_is_an_error_of_the_system(make, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file"):
        save(standard_figures(make(sensor=("a",))), tmp_path / "file" / "figures")


def test_computing_does_not_wait_for_matplotlib():
    script = (
        "import sys, axlespan, axlespan.interaction.simulate, axlespan.io.results, axlespan.io.summary;"
        "print('matplotlib' in sys.modules); import axlespan.plot; print('matplotlib' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "True"]
