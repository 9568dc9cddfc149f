"""Trains: where their wheels are, and what they weigh."""

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.vehicles.simple import axle_loads, rigid_body, sprung_mass
from axlespan.vehicles.train import Placement, Train

MASS = sprung_mass(mass=1000.0, stiffness=1e5)
CAR = rigid_body(mass=2e4, pitch_inertia=1e5, axles=[0.0, 6.0], stiffness=1e6, center=2.0, name="car")


def test_equal_vehicles_at_a_spacing():
    train = Train.of(CAR, 3, 10.0)
    np.testing.assert_allclose(train.offsets, [0, 6, 10, 16, 20, 26])
    assert train.contact_names == ("1.1", "1.2", "2.1", "2.2", "3.1", "3.2")
    assert train.wheelbase == 26.0
    assert train.name == "3 × car"
    g = 9.81 * 2e4
    np.testing.assert_allclose(train.static_forces(), [g * 2 / 3, g / 3] * 3)


def test_one_vehicle_needs_no_spacing():
    train = Train.of(CAR)
    assert (train.name, train.wheelbase) == ("car", 6.0)


def test_joined_trains_keep_gaps_between_wheels():
    loads = axle_loads(loads=[5e4, 6e4], positions=[0.0, 2.0])
    train = Train.joined([Train.of(MASS, 2, 3.0), Train.of(CAR), Train.of(loads)], [4.0, 0.5], name="mixed")
    np.testing.assert_allclose(train.offsets, [0.0, 3.0, 7.0, 13.0, 13.5, 15.5])
    assert train.contact_names == ("1.1", "2.1", "3.1", "3.2", "4.1", "4.2")
    np.testing.assert_allclose(train.static_forces(10.0), [1e4, 1e4, 2e5 * 2 / 3, 2e5 / 3, 5e4, 6e4])


def test_as_axle_loads_keeps_places_and_forces():
    train = Train.joined([Train.of(MASS, 2, 3.0), Train.of(CAR)], [4.0])
    forces = train.as_axle_loads()
    np.testing.assert_array_equal(forces.offsets, train.offsets)
    np.testing.assert_allclose(forces.static_forces(), train.static_forces())
    assert all(item.vehicle.is_force for item in forces.placements)
    assert forces.contact_names == train.contact_names


@pytest.mark.parametrize(
    ("build", "rule"),
    [
        (lambda: Train(()), "must have at least one vehicle"),
        (lambda: Train((Placement(MASS, 1.0),)), "the first at 0"),
        (
            lambda: Train((Placement(MASS, 0.0), Placement(MASS, 5.0), Placement(MASS, 4.0))),
            "one behind another",
        ),
        (lambda: Train.of(MASS, 2), "spacing: is needed"),
        (lambda: Train.of(MASS, 2, 0.0), "spacing = 0.0: must be positive"),
        (lambda: Train.of(MASS, 0), "count = 0: must be a whole number"),
        (lambda: Train.of(MASS, 1.5, 3.0), "count = 1.5: must be a whole number"),
        (lambda: Train.of(MASS, True), "count = True: must be a whole number"),
        (lambda: Train.joined([Train.of(MASS)] * 3, [1.0]), "one fewer than the trains"),
        (lambda: Train.joined([Train.of(MASS)] * 2, [-1.0]), "gaps = -1.0"),
    ],
)
def test_errors(build, rule):
    with pytest.raises(InputError, match=rule):
        build()
