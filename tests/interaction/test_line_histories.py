"""The deck's motion along its line: against sensors, moved supports, other lines, and through result.nc."""

import numpy as np
import pytest

import axlespan as asp
from axlespan.bridges import SupportAt
from axlespan.interaction.simulate import simulate_many
from axlespan.model.motions import HarmonicMotion
from axlespan.running.structure import Structure

BRIDGE = {"length": 25.0, "youngs_modulus": 2.87e9, "second_moment": 2.90, "mass_per_length": 2303.0}
MASS = asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6)


def crossing_of(*, elements=9, **bridge):
    structure = asp.bridges.simple_span(**BRIDGE, elements=elements, **bridge)
    return asp.Crossing(structure, asp.Train.of(MASS, count=2, spacing=6.0), speed=30.0)


@pytest.mark.parametrize("basis", ["full", "reduced"])
@pytest.mark.parametrize("moved", [False, True], ids=["still", "moving support"])
def test_line_points_are_sensors(basis, moved):
    supports = [SupportAt(0.0, ("z",)), SupportAt(25.0, ("z",))]
    if moved:
        supports[0] = SupportAt(0.0, (), motion={"z": HarmonicMotion(2e-3, 3.0)}, name="left")
    places = np.linspace(0.0, 25.0, 6)
    result = asp.simulate(
        crossing_of(supports=supports),
        time_step=1e-3,
        steps=700,
        every=3,
        basis=basis,
        sensors={f"s{i}": at for i, at in enumerate(places)},
        line_points=6,
    )
    assert result.line_position == pytest.approx(places)
    assert result.line_displacement.shape == (234, 6)
    assert np.abs(result.line_displacement - result.sensor_displacement).max() < 1e-15
    assert np.abs(result.line_acceleration - result.sensor_acceleration).max() < 1e-11
    assert (np.abs(result.line_displacement[:, 0]).max() > 1e-3) == moved


def test_slope_of_the_ends_is_that_of_the_deflected_line():
    """A force set on midspan: the ends oscillate about the static slope P L^2 / 16 EI, down into the span."""
    structure = asp.bridges.simple_span(**BRIDGE, elements=8)
    force = asp.Train.of(asp.vehicles.axle_loads(loads=[1e5], positions=[0.0]))
    crossing = asp.Crossing(structure, force, speed=1e-6, start=12.5)
    result = asp.simulate(crossing, time_step=5e-4, steps=4000, line_points=(0.0, 12.5))
    static = 1e5 * 25.0**2 / (16.0 * 2.87e9 * 2.90)
    assert result.line_end.tolist() == [0.0, 25.0]
    assert result.line_slope[:, 0].mean() == pytest.approx(-static, rel=0.02)  # 4.8 periods and a bit
    assert result.line_slope[:, 1].mean() == pytest.approx(static, rel=0.02)


def test_the_deck_is_recorded_where_wheels_run_above_it():
    crossing = crossing_of()
    plain = crossing.structure
    two = Structure(plain.system, {"rail": plain.line(), "deck": plain.line().renumbered(np.arange(99))})
    shared = asp.Crossing(two, crossing.train, speed=30.0)
    result = asp.simulate(shared, time_step=1e-3, steps=300, line_points=3)
    same = asp.simulate(crossing, time_step=1e-3, steps=300, line_points=3)
    assert np.abs(result.line_displacement - same.line_displacement).max() < 1e-15


def test_written_and_read_back(tmp_path):
    result = asp.simulate(crossing_of(), time_step=1e-3, steps=200, line_points=5)
    again = asp.read_result(asp.write_result(result, tmp_path / "result.nc"))
    for name in ("line_position", "line_end", "line_displacement", "line_acceleration", "line_slope"):
        assert np.array_equal(getattr(again, name), getattr(result, name))
    data = result.to_xarray()
    assert data["line_acceleration"].dims == ("time", "line_point")
    assert data["line_position"].values[-1] == 25.0
    assert "line_twist" not in data and again.line_twist.size == 0


def test_not_asked_for_there_is_none():
    result = asp.simulate(crossing_of(), time_step=1e-3, steps=20)
    assert not result.line_position.size and not result.line_acceleration.size
    assert "line_point" not in result.to_xarray().dims


def test_many_side_by_side_are_as_one():
    crossing = crossing_of()
    faster = asp.Crossing(crossing.structure, crossing.train, speed=45.0)
    both = simulate_many([crossing, faster], time_step=1e-3, steps=400, line_points=7)
    alone = asp.simulate(faster, time_step=1e-3, steps=400, line_points=7)
    scale = np.abs(alone.line_acceleration).max()
    assert np.abs(both[1].line_acceleration - alone.line_acceleration).max() < 1e-8 * scale


@pytest.mark.parametrize("points", [1, 2.5, True, -3, 20_000])
def test_a_number_of_points_is_checked(points):
    with pytest.raises(asp.InputError, match="must be 0 or a whole number from 2 to 10000"):
        asp.simulate(crossing_of(), time_step=1e-3, steps=20, line_points=points)


@pytest.mark.parametrize(
    ("points", "rule"),
    [
        ((3.0, 2.0), "must be positions that increase"),
        ((0.0, np.nan), "must be positions that increase"),
        ((0.0, 25.1), "must lie on the structure, between 0 and 25 m"),
    ],
)
def test_positions_are_checked(points, rule):
    with pytest.raises(asp.InputError, match=rule):
        asp.simulate(crossing_of(), time_step=1e-3, steps=20, line_points=points)
