"""Trains of case files: axles, bodies and where each vehicle stands."""

import pytest

from axlespan.errors import InputError
from axlespan.study.case_placing import Unit, first_wheels

CAR = """\
  - vehicle: multibody
    count: 2
    spacing: 9 m
    bodies: [{name: body, mass: 10.5 t, inertia: 50 t m^2, position: 2.5 m}]
    wheels: [{position: 0 m, mass: 900 kg}, {position: 5 m, mass: 900 kg}]
    suspensions:
      - {between: [body, wheel1], stiffness: 600 kN/m, damping: 10 kNs/m}
      - {between: [wheel2, body], stiffness: 600 kN/m}
"""
COACH = """\
  - vehicle: multibody
    bodies:
      - {name: body, mass: 47.8 t, inertia: 1.957888e6 kg m^2, position: 9.9375 m}
      - {name: bogie1, mass: 3.5 t, inertia: 1715 kg m^2, position: 1.25 m}
      - {name: bogie2, mass: 3.5 t, inertia: 1715 kg m^2, position: 18.625 m}
    wheels:
      - {position: 0 m, mass: 1.8 t}
      - {position: 2.5 m, mass: 1.8 t}
      - {position: 17.375 m, mass: 1.8 t}
      - {name: last, position: 19.875 m, mass: 1.8 t}
    suspensions:
      - {between: [body, bogie1], stiffness: 0.7 MN/m, damping: 40 kNs/m}
      - {between: [body, bogie2], stiffness: 0.7 MN/m, damping: 40 kNs/m}
      - {between: [bogie1, wheel1], stiffness: 2.4 MN/m, damping: 20 kNs/m}
      - {between: [bogie1, wheel2], stiffness: 2.4 MN/m, damping: 20 kNs/m}
      - {between: [bogie2, wheel3], stiffness: 2.4 MN/m, damping: 20 kNs/m}
      - {between: [bogie2, last], stiffness: 2.4 MN/m, damping: 20 kNs/m}
"""


def test_wheels_have_names_and_suspensions_their_places(with_train):
    (car,) = with_train(CAR).case.train
    assert [wheel.name for wheel in car.wheels] == ["wheel1", "wheel2"]
    assert [suspension.at for suspension in car.suspensions] == [0.0, 5.0]
    assert [suspension.damping for suspension in car.suspensions] == [1e4, 0.0]
    assert car.wheel_positions == (0.0, 5.0)
    assert (car.bodies[0].mass, car.bodies[0].inertia) == (10500.0, 5e4)


def test_a_coach_on_two_bogies(with_train):
    (coach,) = with_train(COACH).case.train
    assert [suspension.at for suspension in coach.suspensions] == [1.25, 18.625, 0.0, 2.5, 17.375, 19.875]
    assert [wheel.name for wheel in coach.wheels] == ["wheel1", "wheel2", "wheel3", "last"]
    assert sum(body.mass for body in coach.bodies) + sum(wheel.mass for wheel in coach.wheels) == 62000.0


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        # both secondary springs at the middle: nothing resists pitch of the body
        (
            "{between: [body, bogie1], ",
            "{between: [body, bogie1], at: 18.625 m, ",
            "case.yaml:13:9: train.0.bodies.0 = {name: body, mass: 47.8 t, inertia: 1.957888e6 kg m^2, posi…: "
            "can pitch freely: no spring resists it. Add a suspension, or leave its inertia out",
        ),
        # a bogie on one spring pitches about it
        (
            "{between: [bogie1, wheel1], stiffness: 2.4 MN/m",
            "{between: [bogie1, wheel1], stiffness: 0",
            "case.yaml:14:9: train.0.bodies.1 = {name: bogie1, mass: 3.5 t, inertia: 1715 kg m^2, position:…: "
            "can pitch freely: no spring resists it. Add a suspension, or leave its inertia out",
        ),
    ],
)
def test_bodies_that_nothing_holds(with_train, old, new, expected):
    with pytest.raises(InputError) as caught:
        with_train(COACH.replace(old, new))
    assert str(caught.value) == expected


@pytest.mark.parametrize(
    ("axles", "positions", "loads"),
    [
        ("loads: 170 kN", (0.0,), (170e3,)),
        ("loads: 170 kN, spacings: [3 m, 11 m, 3 m]", (0.0, 3.0, 14.0, 17.0), (170e3,) * 4),
        ("loads: [170 kN, 100 kN], positions: [0, 3]", (0.0, 3.0), (170e3, 100e3)),
        ("loads: 170 kN, positions: [0 m, 3 m]", (0.0, 3.0), (170e3, 170e3)),
    ],
)
def test_axle_loads(with_train, axles, positions, loads):
    (vehicle,) = with_train(f"  - {{vehicle: axle-loads, {axles}}}\n").case.train
    assert (vehicle.wheel_positions, vehicle.axle_loads) == (positions, loads)


MASS = "vehicle: rigid-mass, mass: 5 t"


@pytest.mark.parametrize(
    ("entries", "expected"),
    [
        ([f"{{{MASS}}}"], ((0.0,),)),
        ([f"{{{MASS}, count: 3, spacing: 4 m}}"], ((0.0, 4.0, 8.0),)),
        # the next entry goes on at the spacing of the one before
        ([f"{{{MASS}, count: 2, spacing: 4 m}}", f"{{{MASS}}}"], ((0.0, 4.0), (8.0,))),
        # gap counts from the last wheel ahead: 17 m behind the first wheel of the last of two groups
        (
            [
                "{vehicle: axle-loads, loads: 170 kN, spacings: [3 m, 11 m, 3 m], count: 2, spacing: 20 m}",
                f"{{{MASS}, gap: 3.525 m, count: 2, spacing: 6 m}}",
            ],
            ((0.0, 20.0), (40.525, 46.525)),
        ),
        # offset counts from the first wheel of the train
        ([f"{{{MASS}, spacing: 4 m}}", f"{{{MASS}, offset: 30 m}}"], ((0.0,), (30.0,))),
    ],
)
def test_where_vehicles_stand(with_train, entries, expected):
    train = with_train("".join(f"  - {entry}\n" for entry in entries)).case.train
    heads = first_wheels(train, [Unit(entry.wheel_positions[-1], entry.count) for entry in train])
    assert [pytest.approx(entry) for entry in expected] == list(heads)


def test_the_library_knows_spacings(with_train):
    loaded = with_train("  - {vehicle: ice3, count: 2}\n  - {vehicle: ice3}\n", vehicles=["ice3", "hslm-a1"])
    units = [Unit(19.875, 2, 24.775), Unit(19.875, 1, 24.775)]
    assert first_wheels(loaded.case.train, units) == ((0.0, 24.775), (49.55,))


@pytest.mark.parametrize(
    ("name", "fix"),
    [
        ("ice4", "Did you mean ice3?"),
        ("HSLM-A11", "Did you mean hslm-a1?"),
        ("rigidmass", "Did you mean rigid-mass?"),
        (
            "tractor",
            "Kinds are sprung-mass, axle-loads, rigid-mass, multibody, mesh or matrices; axlespan library lists the vehicles",
        ),
    ],
)
def test_names_that_the_library_does_not_have(with_train, name, fix):
    with pytest.raises(InputError) as caught:
        with_train(f"  - {{vehicle: {name}, count: 2}}\n", vehicles=["ice3", "hslm-a1"])
    start = f"case.yaml:11:15: train.0.vehicle = {name}: no such kind of vehicle, and none in the library. "
    assert str(caught.value) == start + fix


def test_spectra_that_are_not_there(loaded):
    with pytest.raises(InputError) as caught:
        loaded(
            ("80 km/h", "80 km/h\n  irregularity: {kind: spectrum, name: fra4, seed: 1}"),
            spectra=["fra-4", "sncf"],
        )
    expected = "case.yaml:18:40: crossing.irregularity.name = fra4: no such spectrum. Did you mean fra-4?"
    assert str(caught.value) == expected
