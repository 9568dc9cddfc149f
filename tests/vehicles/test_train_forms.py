"""One train in several forms: as masses, as forces, the other way round; and vehicles that get in each other's way."""

from dataclasses import replace

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.vehicles import ContactPoint, Placement, Train, Vehicle, axle_loads, rigid_body, sprung_mass

MASS = sprung_mass(mass=1000.0, stiffness=1e5)
CAR = rigid_body(mass=2e4, pitch_inertia=1e5, axles=[0.0, 6.0], stiffness=1e6, center=2.0, name="car")
TRAIN = Train.joined([Train.of(MASS, 2, 3.0), Train.of(CAR)], [4.0], name="mixed")


@pytest.mark.parametrize("gravity", [9.81, 10.0])
def test_moving_masses_weigh_the_same(gravity):
    masses = TRAIN.as_moving_masses(gravity)
    np.testing.assert_array_equal(masses.offsets, TRAIN.offsets)
    np.testing.assert_allclose(masses.static_forces(gravity), TRAIN.static_forces(gravity), rtol=1e-14)
    assert masses.contact_names == TRAIN.contact_names
    systems = [item.vehicle.system for item in masses.placements]
    assert sum(system.total_mass() for system in systems) == pytest.approx(22e3)
    assert all(item.vehicle.has_massive_contacts for item in masses.placements)
    assert masses.name == "mixed as moving masses"


def test_moving_masses_of_forces():
    masses = Train.of(axle_loads(loads=[98.1e3, 49.05e3], positions=[0.0, 3.0])).as_moving_masses()
    mass = masses.placements[0].vehicle.system.partition.M_FF.diagonal()
    np.testing.assert_allclose(mass, [1e4, 5e3])
    with pytest.raises(InputError, match=r"gravity = 0\.0: must be positive"):
        masses.as_moving_masses(0.0)


def test_a_car_the_other_way_round():
    turned = CAR.reversed()
    assert [point.behind for point in turned.contacts] == [0.0, 6.0]
    assert [point.dof for point in turned.contacts] == ["wheel2.z", "wheel1.z"]
    assert [point.name for point in turned.contacts] == ["1", "2"]
    np.testing.assert_allclose(turned.static_forces(), CAR.static_forces()[::-1])
    again = turned.reversed()
    assert [(p.name, p.behind, p.dof) for p in again.contacts] == [
        (p.name, p.behind, p.dof) for p in CAR.contacts
    ]


def test_a_train_the_other_way_round():
    turned = TRAIN.reversed()
    np.testing.assert_allclose(turned.offsets, 13.0 - TRAIN.offsets[::-1])
    np.testing.assert_allclose(turned.static_forces(), TRAIN.static_forces()[::-1])


def test_overhangs_change_ends():
    car = replace(CAR, length=10.0, overhang=1.0)
    assert (car.front_overhang, car.rear_overhang) == (1.0, 3.0)
    assert (car.reversed().front_overhang, car.reversed().rear_overhang) == (3.0, 1.0)
    assert (replace(CAR, length=10.0).front_overhang, CAR.front_overhang) == (2.0, 0.0)
    train = Train((Placement(car, 0.0), Placement(car, 12.0)))
    assert train.ends == (1.0, 21.0)


def test_left_and_right_change_sides():
    points = [
        ContactPoint(f"{axle}{side[0]}", behind, None, side, 1e4 * (axle + (side == "left")))
        for axle, behind in ((1, 0.0), (2, 2.5))
        for side in ("left", "right")
    ]
    turned = Vehicle(tuple(points)).reversed()
    assert [(p.name, p.line, p.behind) for p in turned.contacts] == [
        (p.name, p.line, p.behind) for p in points
    ]
    assert [p.force for p in turned.contacts] == [2e4, 3e4, 1e4, 2e4]


FORCES = axle_loads(loads=[1e5, 1e5], positions=[0.0, 8.0])
LONG = replace(CAR, length=9.0)


@pytest.mark.parametrize(
    ("placements", "message"),
    [
        (
            [(MASS, 0.0), (MASS, 0.0)],
            "vehicle 2 begins 0 m behind the first wheel of vehicle 1, whose last wheel is 0 m",
        ),
        (
            [(CAR, 0.0), (MASS, 5.0)],
            "vehicle 2 begins 5 m behind the first wheel of vehicle 1, whose last wheel is 6 m",
        ),
        (
            [(CAR, 0.0), (FORCES, 1.0), (MASS, 5.5)],
            "vehicle 3 begins 5.5 m behind the first wheel of vehicle 1",
        ),
        ([(LONG, 0.0), (LONG, 8.5)], "vehicle 2 begins 8.5 m .* which needs 9 m between buffers"),
        ([(CAR, 0.0), (LONG, 7.0)], "vehicle 2 begins 7 m .* which needs 7.5 m between buffers"),
    ],
)
def test_vehicles_within_each_other(placements, message):
    train = Train(tuple(Placement(vehicle, behind) for vehicle, behind in placements))
    with pytest.raises(InputError, match=message):
        train.require_apart()


@pytest.mark.parametrize(
    ("placements", "lines"),
    [
        ([(FORCES, 0.0), (FORCES, 3.0), (CAR, 4.0)], None),  # forces are no bodies
        ([(LONG, 0.0), (LONG, 8.95)], None),  # buffers give way
        ([(CAR, 0.0), (CAR, 0.0)], ["left", "left", "right", "right"]),
    ],
)
def test_vehicles_that_do_not_touch(placements, lines):
    Train(tuple(Placement(vehicle, behind) for vehicle, behind in placements)).require_apart(lines)


def test_trains_of_any_spacings_can_be_turned():
    """The head of the turned train is at 0 exactly, whatever rounding does to sums of lengths."""
    rng = np.random.default_rng(4)
    for _ in range(200):
        cars = [
            axle_loads(loads=[1e5, 1e5], positions=[0.0, round(float(rng.uniform(1.0, 20.0)), 3)])
            for _ in range(5)
        ]
        train = Train.joined([Train.of(car) for car in cars], rng.uniform(2.0, 9.0, 4).round(3).tolist())
        turned = train.reversed()
        assert turned.placements[0].behind == 0.0
        np.testing.assert_allclose(turned.offsets, train.wheelbase - train.offsets[::-1], atol=1e-12)
