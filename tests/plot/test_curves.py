"""Axes of results: the right numbers in the right units under the right names."""

import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.collections import PolyCollection

from axlespan.errors import InputError
from axlespan.plot import acceleration, comparison, contact_force, displacement, reactions, velocity
from axlespan.plot.style import COLORS, new_figure


@pytest.fixture
def ax():
    return new_figure()[1]


def legend(ax):
    return [text.get_text() for text in ax.get_legend().get_texts()]


def curve(ax, label):
    return next(line for line in ax.get_lines() if line.get_label() == label)


def bands(ax):
    return [item for item in ax.collections if isinstance(item, PolyCollection)]


@pytest.fixture(autouse=True)
def nothing_left_open():
    yield
    assert plt.get_fignums() == []


# --- motions -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "draw, quantity, scale, label",
    [
        (displacement, "displacement", 1e3, "Displacement [mm]"),
        (velocity, "velocity", 1e3, "Velocity [mm/s]"),
        (acceleration, "acceleration", 1.0, "Acceleration [m/s²]"),
    ],
)
def test_sensors_are_drawn_in_engineering_units(make, ax, draw, quantity, scale, label):
    result = make(sensor=("a", "b"))
    assert draw(result, ax=ax) is ax
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Time [s]", label)
    assert legend(ax) == ["a", "b"]
    for i, name in enumerate(("a", "b")):
        np.testing.assert_array_equal(curve(ax, name).get_xdata(), result.time)
        expected = scale * getattr(result, f"sensor_{quantity}")[:, i]
        np.testing.assert_allclose(curve(ax, name).get_ydata(), expected, rtol=1e-15)


def test_vehicle_dofs_are_drawn_by_name_and_rotations_in_their_units(make, ax):
    result = make(vehicle_dof=("1.body.z", "1.body.pitch"))
    displacement(result, "1.body.pitch", ax=ax)
    assert ax.get_ylabel() == "Displacement [mrad]"
    np.testing.assert_allclose(
        curve(ax, "1.body.pitch").get_ydata(), 1e3 * result.vehicle_displacement[:, 1], rtol=1e-15
    )
    _, other = new_figure()
    assert acceleration(result, "1.body.pitch", ax=other).get_ylabel() == "Acceleration [rad/s²]"


def test_sensors_and_vehicle_dofs_go_together_but_not_with_rotations(make, ax):
    result = make(sensor=("a",), vehicle_dof=("1.body.z", "1.body.pitch"))
    displacement(result, ["a", "1.body.z"], ax=ax)
    assert legend(ax) == ["a", "1.body.z"]
    with pytest.raises(InputError, match=r"must not mix displacements and rotations"):
        displacement(result, ["a", "1.body.pitch"])


def test_unknown_and_missing_names_are_refused(make):
    result = make(sensor=("a",), vehicle_dof=("1.body.z",))
    with pytest.raises(InputError, match=r"is no sensor and no vehicle d\.o\.f\.. Known: a, 1\.body\.z"):
        displacement(result, "b")
    with pytest.raises(InputError, match=r"must have at least one name"):
        displacement(make(vehicle_dof=("1.body.z",)))
    assert plt.get_fignums() == []


def test_many_vehicles_are_a_band_with_first_last_and_largest(make, ax):
    names = tuple(f"{i + 1}.body.z" for i in range(50))
    result = make(vehicle_dof=names)
    result.vehicle_acceleration[77, 30] = -9.0
    acceleration(result, names, ax=ax)
    assert legend(ax) == [
        "all 50 vehicle d.o.f.",
        "1.body.z (first)",
        "50.body.z (last)",
        "31.body.z (largest)",
    ]
    (band,) = bands(ax)
    (path,) = band.get_paths()
    assert path.vertices[:, 1].min() == -9.0
    assert path.vertices[:, 1].max() == result.vehicle_acceleration.max()


def test_many_sensors_are_a_band_with_the_largest(make, ax):
    result = make(sensor=tuple(f"s{i}" for i in range(30)))
    result.sensor_displacement[10, 12] = 1.0e3
    displacement(result, ax=ax)
    assert legend(ax) == ["all 30 sensors", "s12 (largest)"]


def test_a_window_shows_that_time_only(make, ax):
    result = make(sensor=("a",))
    displacement(result, window=(0.5, 1.0), ax=ax)
    assert ax.get_xlim() == (0.5, 1.0)
    drawn = curve(ax, "a").get_xdata()
    assert drawn[0] == pytest.approx(0.49) and drawn[-1] == pytest.approx(1.01)
    with pytest.raises(InputError, match=r"must hold a time of the result"):
        displacement(result, window=(5.0, 6.0))


def test_long_histories_are_thinned_and_keep_their_peak(make, ax):
    result = make(n_time=50_000, sensor=("a",))
    result.sensor_acceleration[33_333, 0] = 77.0
    acceleration(result, ax=ax)
    line = curve(ax, "a")
    assert len(line.get_xdata()) <= 4000
    assert line.get_ydata().max() == 77.0
    assert line.get_xdata()[line.get_ydata().argmax()] == result.time[33_333]


def test_small_curves_lie_on_top_of_large_ones(make, ax):
    result = make(sensor=("small", "large"))
    result.sensor_displacement[:, 1] *= 10.0
    displacement(result, ax=ax)
    assert curve(ax, "small").get_zorder() > curve(ax, "large").get_zorder()


@pytest.mark.parametrize("level", [0.0, 98.1])
def test_rounding_errors_are_not_drawn_as_motion(make, ax, level):
    result = make(sensor=("a",))
    result.sensor_acceleration[:, 0] = level + 1e-13 * result.sensor_acceleration[:, 0]
    acceleration(result, ax=ax)
    low, high = ax.get_ylim()
    assert low < level < high
    assert high - low >= max(0.09 * level, 1e-3)


def test_without_axes_a_pyplot_figure_is_made(make):
    axes = displacement(make(sensor=("a",)))
    assert plt.get_fignums() == [axes.figure.number]
    plt.close(axes.figure)
    assert plt.get_fignums() == []


# --- contact forces ------------------------------------------------------------------------------


def test_contact_forces_over_time_and_over_position(make, ax):
    result = make(contact=("1.1", "1.2"))
    contact_force(result, ax=ax)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Time [s]", "Contact force [kN]")
    assert legend(ax) == ["wheel 1.1", "wheel 1.2", "static"]
    np.testing.assert_allclose(curve(ax, "wheel 1.2").get_ydata(), 1e-3 * result.contact_force[:, 1])
    assert set(curve(ax, "static").get_ydata()) == {50.0}
    _, other = new_figure()
    contact_force(result, "position", "1.2", ax=other)
    assert other.get_xlabel() == "Position of the wheel [m]"
    line = curve(other, "wheel 1.2")
    np.testing.assert_array_equal(line.get_xdata(), result.contact_position[:, 1])
    np.testing.assert_allclose(line.get_ydata(), 1e-3 * result.contact_force[:, 1])


def test_relative_forces_are_over_the_static_ones(make, ax):
    result = make(contact=("1.1", "1.2"), checks={"static_contact_force": {"1.1": 2.0, "1.2": 4.0}})
    contact_force(result, relative=True, ax=ax)
    assert ax.get_ylabel() == "Contact force over static force [-]"
    np.testing.assert_allclose(curve(ax, "wheel 1.2").get_ydata(), result.contact_force[:, 1] / 4.0)
    assert set(curve(ax, "static").get_ydata()) == {1.0}


def test_many_wheels_over_positions_are_a_band(make, ax):
    result = make(n_time=2000, contact=tuple(f"{i + 1}.1" for i in range(50)))
    result.contact_force[:] += 50e3
    result.contact_force[1500, 20] = 90e3  # at 240 m
    contact_force(result, "position", span=(0.0, 300.0), ax=ax)
    labels = legend(ax)
    assert labels[0] == "all 50 wheels"
    assert "wheel 21.1 (largest)" in labels
    assert labels[-2:] == ["static", "ends of the structure"]
    assert len(labels) == 6
    (band,) = bands(ax)
    assert band.get_paths()[0].vertices[:, 1].max() == pytest.approx(90.0)
    assert ax.get_xlim() == (-60.0, 360.0)


def test_the_window_over_positions_finds_where_forces_change(make, ax):
    result = make(n_time=1000, contact=("1.1",))
    position = result.contact_position[:, 0]
    quiet = (position < 50.0) | (position > 80.0)
    result.contact_force[:, 0] = np.where(quiet, 50e3, 51e3)
    contact_force(result, "position", ax=ax)
    low, high = ax.get_xlim()
    assert (low, high) == (pytest.approx(44.0, abs=0.3), pytest.approx(86.0, abs=0.3))


def test_trains_of_many_axle_loads_have_no_static_line(make, ax):
    names = ("1.1", "1.2", "1.3", "1.4")
    static = dict(zip(names, (1.0, 2.0, 3.0, 4.0), strict=True))
    contact_force(make(contact=names, checks={"static_contact_force": static}), ax=ax)
    assert legend(ax) == [f"wheel {name}" for name in names]


@pytest.mark.parametrize(
    "arguments, rule",
    [
        ({"over": "speed"}, "must be time or position"),
        ({"contacts": "9.1"}, "is not a contact of this result"),
    ],
)
def test_contact_forces_refuse(make, arguments, rule):
    with pytest.raises(InputError, match=rule):
        contact_force(make(contact=("1.1",)), **arguments)
    with pytest.raises(InputError, match="has no contact to draw"):
        contact_force(make(sensor=("a",)))


# --- reactions and comparisons -------------------------------------------------------------------


def test_reactions_are_the_largest_forces_that_are_not_zero(make, ax):
    names = ("left.x", "left.z", "left.ry", *(f"mid{i}.z" for i in range(7)))
    result = make(support=names)
    result.support_reaction[:, 0] = 0.0
    result.support_reaction[:, 1] *= 100.0
    result.support_reaction[:, 4] *= 0.01
    reactions(result, ax=ax)
    assert ax.get_ylabel() == "Largest support reactions [kN]"
    drawn = legend(ax)
    assert len(drawn) == 6 and drawn[0] == "left.z"
    assert not {"left.x", "left.ry", "mid1.z"} & set(drawn)
    np.testing.assert_allclose(curve(ax, "left.z").get_ydata(), 1e-3 * result.support_reaction[:, 1])


def test_named_reactions_may_be_moments(make, ax):
    result = make(support=("left.z", "left.ry", *(f"s{i}.z" for i in range(6))))
    reactions(result, "left.ry", ax=ax)
    assert ax.get_ylabel() == "Support reaction [kN m]"
    with pytest.raises(InputError, match="must not mix forces and moments"):
        reactions(result, ["left.z", "left.ry"])
    with pytest.raises(InputError, match="must be one to 6 supports"):
        reactions(result, [f"s{i}.z" for i in range(6)] + ["left.z"])
    with pytest.raises(InputError, match="is not a support of this result"):
        reactions(result, "right.z")


def test_comparisons_tell_curves_apart_without_color(ax):
    time = np.linspace(0.0, 1.0, 50)
    curves = {f"c{i}": np.sin(time + i) for i in range(6)}
    comparison(time, curves, ylabel="Displacement [mm]", window=(0.2, 0.8), ax=ax)
    lines = ax.get_lines()
    assert [line.get_color() for line in lines] == list(COLORS)
    assert len({str(line._dash_pattern) for line in lines}) == 6
    assert (ax.get_ylabel(), ax.get_xlim()) == ("Displacement [mm]", (0.2, 0.8))
    np.testing.assert_array_equal(curve(ax, "c3").get_ydata(), curves["c3"])


def test_comparisons_refuse_what_does_not_fit():
    time = np.linspace(0.0, 1.0, 5)
    with pytest.raises(InputError, match=r"curves\.b = \(4,\): must have one value for each time, 5 in all"):
        comparison(time, {"a": time, "b": time[:4]})
    with pytest.raises(InputError, match="must be one to 6 curves"):
        comparison(time, {})
