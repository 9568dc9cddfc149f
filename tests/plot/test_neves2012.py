"""Figures 3 to 10 of Neves et al. (2012)."""

import re
from dataclasses import replace

import numpy as np
import pytest
from matplotlib import image
from matplotlib import pyplot as plt

from axlespan.errors import InputError
from axlespan.plot import save
from axlespan.plot.neves2012 import PANELS, neves2012


@pytest.fixture(scope="module")
def figures(single, train):
    return neves2012(single, train)


def test_there_are_figures_3_to_10(figures):
    assert list(figures) == [f"neves2012-fig{number}" for number in range(3, 11)]
    for panel in PANELS:
        figure = figures[f"neves2012-fig{panel.number}"]
        (ax,) = figure.axes
        assert ax.get_xlim() == panel.window
        assert [text.get_text() for text in ax.get_legend().get_texts()] == [
            "Direct method",
            "Semi-analytical solution",
        ]
        assert figure.get_suptitle().startswith(f"Neves et al. (2012), figure {panel.number}. Vertical")
    assert plt.get_fignums() == []


# peaks of an independent solution of N12 (38) to (42) in modes, in mm and m/s2
@pytest.mark.parametrize(
    "number, low, high",
    [
        (3, -2.4069, 0.1643),
        (5, -2.5899, 0.4986),
        (6, -0.1421, 0.1480),
        (7, -12.840, 7.345),
        (8, -2.037, 2.037),
        (9, -11.593, 7.152),
        (10, -1.984, 1.984),
    ],
)
def test_both_curves_have_the_known_peaks_and_differ_little(figures, number, low, high):
    (ax,) = figures[f"neves2012-fig{number}"].axes
    ours, theirs = (line.get_ydata() for line in ax.get_lines())
    for values in (ours, theirs):
        assert values.min() == pytest.approx(low, abs=6e-4 * max(1.0, abs(low)))
        assert values.max() == pytest.approx(high, abs=6e-4 * max(1.0, abs(high)))
    stated = float(re.search(r"difference (\S+) %", ax.texts[0].get_text())[1])
    assert stated == pytest.approx(100.0 * np.abs(ours - theirs).max() / np.abs(theirs).max(), rel=0.05)
    assert stated < 0.03


def test_midspan_accelerations_are_compared_with_a_warning_about_modes(figures):
    assert figures["neves2012-fig4"].get_suptitle().endswith("(20 modes, all)")


def test_nothing_is_cut_off_in_the_images(figures, tmp_path):
    for file in save(figures, tmp_path):
        pixels = image.imread(file)[:, :, :3]
        assert np.concatenate([pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1]]).min() > 0.99


def test_one_example_alone_gives_its_own_figures(single):
    assert list(neves2012(single)) == [f"neves2012-fig{number}" for number in range(3, 7)]
    assert neves2012() == {}


def test_results_that_do_not_fit_are_refused(single):
    short = replace(single, time=single.time[:500])
    with pytest.raises(InputError, match=r"must reach 0\.9 s for figure 3 of N12"):
        neves2012(short)
    with pytest.raises(InputError, match="is not a sensor of this result"):
        neves2012(single, sensor="quarter")
