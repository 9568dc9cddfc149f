"""Maps, spectra, verdict bars, elevations, profiles: what is drawn are the numbers."""

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.patches import Circle, FancyBboxPatch

import axlespan as asp
from axlespan.plot import line_maps
from axlespan.plot.style import new_figure
from axlespan.standards.verdict import judged, not_assessed


@pytest.fixture(autouse=True)
def closed():
    """Close what a test opens."""
    yield
    plt.close("all")


@pytest.fixture(scope="module")
def crossing():
    bridge = asp.bridges.simple_span(
        length=25.0, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=10
    )
    train = asp.Train.of(asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6), count=2, spacing=6.0)
    return asp.Crossing(bridge, train, speed=30.0)


@pytest.fixture(scope="module")
def result(crossing):
    return asp.simulate(crossing, time_step=1e-3, steps=1000, sensors={"mid": 12.5}, line_points=11)


@pytest.mark.parametrize(("quantity", "scale"), [("displacement", 1e3), ("acceleration", 1.0)])
def test_map_of_the_line(result, quantity, scale, monkeypatch):
    monkeypatch.setattr(line_maps, "_TIMES", 2000)
    ax = asp.plot.line_map(result, quantity)
    (mesh,) = ax.collections
    table = scale * getattr(result, f"line_{quantity}")
    assert np.array_equal(mesh.get_array(), table)
    assert mesh.get_clim() == (-np.abs(table).max(), np.abs(table).max())  # zero is white
    first, last = ax.lines
    assert np.array_equal(first.get_xdata(), result.contact_position[:, 0])
    assert last.get_label() == "wheel 2.1"
    assert ax.get_xlim() == (0.0, 25.0)


def test_a_thinned_map_keeps_extremes(result, monkeypatch):
    monkeypatch.setattr(line_maps, "_TIMES", 40)
    _, ax = new_figure()
    asp.plot.line_map(result, "acceleration", ax=ax)
    (mesh,) = ax.collections
    assert mesh.get_array().shape == (40, 11)
    assert np.abs(mesh.get_array()).max() == np.abs(result.line_acceleration).max()


def test_map_needs_the_line(crossing, result):
    plain = asp.simulate(crossing, time_step=1e-2, steps=5)
    with pytest.raises(asp.InputError, match=r"has no motions along the line.*line_points=41"):
        asp.plot.line_map(plain)
    with pytest.raises(asp.InputError, match="must be one of displacement, acceleration"):
        asp.plot.line_map(result, "moment")


def test_spectrum_shows_the_amplitude_of_a_tone(make):
    made = make(n_time=1000, sensor=("s",), contact=("1.1",))
    made.sensor_acceleration[:, 0] = 2.0 + 3.0 * np.sin(2.0 * np.pi * 5.0 * made.time)  # 50 periods
    made.contact_force[:, 0] = 1e3 * np.cos(2.0 * np.pi * 8.0 * made.time)
    (curve,) = asp.plot.spectrum(made, "s").lines
    x, y = curve.get_data()
    assert x[y.argmax()] == pytest.approx(5.0)
    assert y.max() == pytest.approx(3.0)
    ax = asp.plot.spectrum(made, "1.1", "contact_force", highest=20.0)
    x, y = ax.lines[0].get_data()
    assert (x[y.argmax()], y.max()) == (pytest.approx(8.0), pytest.approx(1.0))  # [kN]
    assert ax.get_xlim() == (0.0, 20.0)
    assert ax.get_ylabel() == "Contact force, amplitude [kN]"


def test_what_has_no_spectrum(make):
    made = make(n_time=200, sensor=tuple("abcdefg"))
    with pytest.raises(asp.InputError, match="names = 7: must be at most 6 names"):
        asp.plot.spectrum(made)
    with pytest.raises(asp.InputError, match=r"must hold 16 times or more, evenly spaced"):
        asp.plot.spectrum(made, "a", window=(0.0, 0.05))
    with pytest.raises(asp.InputError, match="quantity = 'force': must be one of displacement"):
        asp.plot.spectrum(made, "a", "force")


def test_verdict_bars():
    verdicts = [
        judged("deck_acceleration", "A", "acceleration", 7.0, 3.5, "m/s^2"),
        judged("deflection", "B", "deflection", 0.01, 0.04, "m"),
        judged("mean_comfort", "C", "comfort", 1.2, None, ""),
        not_assessed("derailment", "D", "Y/Q", "no lateral forces"),
        judged("twist", "E", "twist", np.inf, 1.5e-3, "m"),
    ]
    ax = asp.plot.verdict_bars(verdicts)
    lengths = [bar.get_width() for bar in ax.patches[1::2]]  # each on a paler one of full length
    assert lengths == pytest.approx([25.0, 200.0, 200.0])
    colors = [mpl.colors.to_hex(bar.get_facecolor()).upper() for bar in ax.patches[1::2]]
    assert colors == ["#009E73", "#D55E00", "#D55E00"]  # pass, fail, fail
    assert [text.get_text() for text in ax.get_yticklabels()] == ["deflection", "deck acceleration", "twist"]
    assert ax.texts[1].get_text() == "200 %: 7, limit 3.5 m/s²"
    assert ax.texts[0].get_text() == "25 %: 10, limit 40 mm"
    assert ax.texts[2].get_text() == "beyond: inf, limit 1.5 mm"
    assert ax.get_xlabel().endswith("(2 without limit or not assessed)")
    with pytest.raises(asp.InputError, match="have no limit to draw"):
        asp.plot.verdict_bars(verdicts[2:4])


def test_elevation_is_to_scale(crossing):
    ax = asp.plot.elevation(crossing, head=20.0)
    wheels = [patch.center for patch in ax.patches if isinstance(patch, Circle)]
    assert wheels == [(20.0, 0.46), (14.0, 0.46)]
    assert len([patch for patch in ax.patches if isinstance(patch, FancyBboxPatch)]) == 2
    (supports,) = [line for line in ax.lines if line.get_marker() == 6]
    assert sorted(supports.get_xdata()) == [0.0, 25.0]
    assert ax.get_aspect() == 1.0
    assert ax.get_xlim() == (-3.75, 28.75)
    forces = asp.Crossing(
        crossing.structure, crossing.train.as_axle_loads(), speed=30.0, direction="backward"
    )
    ax = asp.plot.elevation(forces, head=5.0)
    assert sorted(text.xy[0] for text in ax.texts) == [5.0, 11.0]  # backward: what follows is ahead in x
    with pytest.raises(asp.InputError, match="must hold positions that increase"):
        asp.plot.elevation(crossing, window=(3.0, 3.0))


def test_profile_and_its_spectrum():
    ax = asp.plot.irregularity(asp.irregularity.Harmonic(amplitude=2e-3, wavelength=4.0), 0.0, 8.0)
    x, y = ax.lines[0].get_data()
    assert y == pytest.approx(2.0 * np.sin(2.0 * np.pi * x / 4.0), abs=1e-12)  # [mm]
    shape = asp.irregularity.spectrum("german-low")
    ax = asp.plot.power_spectrum(shape, (3.0, 150.0))
    length, psd = ax.lines[0].get_data()
    assert psd == pytest.approx(shape.psd(1.0 / length))
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    with pytest.raises(asp.InputError, match="must come after the beginning"):
        asp.plot.irregularity(asp.irregularity.Smooth(), 1.0, 1.0)
    with pytest.raises(asp.InputError, match="must increase from above zero"):
        asp.plot.power_spectrum(shape, (0.0, 1.0))


def test_figures_have_units_and_return_axes(result, crossing):
    """Whatever draws one figure takes axes, returns them, and names units on both of them."""
    for draw in (
        asp.plot.displacement,
        asp.plot.velocity,
        asp.plot.acceleration,
        asp.plot.contact_force,
        asp.plot.reactions,
        asp.plot.line_map,
        asp.plot.spectrum,
    ):
        _, ax = new_figure()
        assert draw(result, ax=ax) is ax
        assert "[" in ax.get_xlabel(), draw.__name__
        assert "[" in ax.get_ylabel(), draw.__name__
