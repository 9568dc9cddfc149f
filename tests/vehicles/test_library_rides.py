"""Each vehicle of the library on the move: nothing happens on smooth ground, and it crosses a bridge."""

from importlib.resources import files

import numpy as np
import pytest

import axlespan as asp
from axlespan.interaction.runs import run_plan
from axlespan.study.build import build
from axlespan.study.loader import read_case
from axlespan.vehicles import library
from axlespan.vehicles.library.trains import train_of

NAMES = library.names()
BRIDGE = asp.bridges.simple_span(
    length=30.0, youngs_modulus=3.4e10, second_moment=3.0, mass_per_length=15e3, elements=10
)


def train(name):
    placements = tuple(
        asp.vehicles.Placement(item.vehicle.on_lines({"left": "main", "right": "main"}), item.behind)
        for item in train_of(library.entry(name)).placements
    )
    return asp.Train(placements, name)


@pytest.mark.parametrize("name", NAMES)
def test_it_feels_nothing_on_smooth_ground(name):
    crossing = asp.Crossing(BRIDGE, train(name), speed=50.0, start=-20.0)
    result = asp.simulate(crossing, time_step=2e-3, steps=201)
    before = result.contact_position.max(axis=1) < -0.7  # half of the footprint ahead
    assert before.sum() > 150
    static = crossing.train.static_forces()
    error = np.abs(result.contact_force[before] / static - 1.0).max()
    assert error < 1e-9


@pytest.mark.parametrize("name", ["hs20-3d", "car-7dof", "truck-2a3", "ice-3d-trailer"])
def test_a_slow_crossing_deflects_the_bridge_as_its_axle_loads_do(name):
    """At walking pace the deflection at midspan is that of the static loads at their places."""
    vehicles = train(name)
    base = vehicles.wheelbase
    start = 15.0 + 0.5 * base
    crossing = asp.Crossing(BRIDGE, vehicles, speed=1e-6, start=start)
    result = asp.simulate(crossing, time_step=5e-3, steps=4, sensors={"midspan": 15.0}, footprint=0.0)
    x = start - vehicles.offsets
    x = np.minimum(x, 30.0 - x)
    on = x > 0.0
    stiffness = 3.4e10 * 3.0
    influence = x * (3 * 30.0**2 - 4 * x**2) / (48 * stiffness)  # of a force at x on the middle
    expected = -(vehicles.static_forces() * influence)[on].sum()
    assert result.sensor_displacement[0, 0] == pytest.approx(expected, rel=2e-3)


def test_the_example_of_cross_wind():
    """On the average of the ride the wheels carry their static share, by the moment of the wind about the rails."""
    path = files("axlespan") / "examples" / "cross-wind.yaml"
    result = run_plan(build(read_case(path.read_text(encoding="utf-8"))).plan)
    share = 60e3 * 2.4 / 1.5 / 4
    even = (48e3 + 2 * 3200.0 + 4 * 2400.0) * 9.81 / 8
    np.testing.assert_allclose(result.contact_force.mean(axis=0)[0::2], even - share, rtol=5e-3)
    np.testing.assert_allclose(result.contact_force.mean(axis=0)[1::2], even + share, rtol=5e-3)
