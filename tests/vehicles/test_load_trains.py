"""Load trains against the tables of the standards and published axle lists."""

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.vehicles import load_trains

# EN 1991-2, table 6.3, with what follows from it: number of axles, length from first to last [m], total force [kN].
HSLM_A = {
    1: (50, 397.525, 8500),
    2: (48, 398.525, 9600),
    3: (46, 397.525, 8280),
    4: (44, 394.525, 8360),
    5: (42, 389.525, 7140),
    6: (40, 382.525, 7200),
    7: (40, 397.525, 7600),
    8: (38, 387.525, 7220),
    9: (36, 375.525, 7560),
    10: (36, 388.525, 7560),
}
A1 = [
    *(0, 3, 14, 17, 20.525, 22.525),
    *np.add.outer(36.7625 + 18.0 * np.arange(19), [-1.0, 1.0]).ravel(),
    *(375.0, 377.0, 380.525, 383.525, 394.525, 397.525),
]
# EN 1991-2, annex D: total force [kN], length [m], speed [km/h].
FATIGUE = {
    1: (6630, 262.10, 200),
    2: (5300, 281.10, 160),
    3: (9400, 385.52, 250),
    4: (5100, 237.60, 250),
    5: (21600, 270.30, 80),
    6: (14310, 333.10, 100),
    7: (10350, 196.50, 120),
    8: (10350, 212.50, 100),
    9: (2960, 134.80, 120),
    10: (3600, 129.60, 120),
    11: (11350, 198.50, 120),
    12: (11350, 212.50, 100),
}


@pytest.mark.parametrize("number", HSLM_A)
def test_hslm_a(number):
    axles, length, total = HSLM_A[number]
    train = load_trains.hslm_a(number)
    assert (len(train.offsets), train.wheelbase) == (axles, length)
    assert train.static_forces().sum() == pytest.approx(1e3 * total, rel=1e-14)
    # both halves are alike
    np.testing.assert_allclose(train.offsets + train.offsets[::-1], length, rtol=0, atol=1e-9)
    assert train.placements[0].vehicle.is_force


def test_the_axles_of_hslm_a1_one_by_one():
    np.testing.assert_allclose(load_trains.hslm_a(1).offsets, A1, rtol=0, atol=1e-9)
    np.testing.assert_allclose(A1[:10], [0, 3, 14, 17, 20.525, 22.525, 35.7625, 37.7625, 53.7625, 55.7625])
    assert A1[-7] == 361.7625


def test_hslm_b_is_equal_forces():
    train = load_trains.hslm_b(12, 3.5)
    np.testing.assert_allclose(train.offsets, 3.5 * np.arange(12))
    np.testing.assert_array_equal(train.static_forces(), 170e3)
    assert load_trains.hslm_b(3, 2.5, 200e3).static_forces().sum() == 600e3


@pytest.mark.parametrize("number", FATIGUE)
def test_fatigue_trains(number):
    total, length, speed = FATIGUE[number]
    train = load_trains.fatigue(number)
    vehicle = train.placements[0].vehicle
    assert vehicle.static_forces().sum() == pytest.approx(1e3 * total, rel=1e-14)
    assert vehicle.length == length
    assert vehicle.front_overhang + vehicle.wheelbase + vehicle.rear_overhang == pytest.approx(length)
    assert load_trains.entry(f"fatigue-{number}").speed == pytest.approx(speed / 3.6)


@pytest.mark.parametrize(
    ("number", "positions", "forces"),
    [
        (2, [0, 3.3, 10.0, 13.3, 13.3 + 1.4 + 2.5], [225, 225, 225, 225, 110]),
        (4, [0, 3, 14, 17, 20.3, 23.3, 39.0, 42.0], [170] * 8),
        (
            10,
            [0, 2.4, 10.3, 12.7, 16.2, 18.6, 26.5, 28.9, 32.4],
            [150, 100, 100, 150, 100, 100, 100, 100, 100],
        ),
    ],
)
def test_the_first_axles_of_fatigue_trains(number, positions, forces):
    train = load_trains.fatigue(number)
    n = len(positions)
    np.testing.assert_allclose(train.offsets[:n], positions, atol=1e-9)
    np.testing.assert_allclose(train.static_forces()[:n], 1e3 * np.array(forces))


# Mass per meter of the line categories [t/m], by the figure in their names; category A has 5.0.
PER_METER = {"1": 5.0, "2": 6.4, "3": 7.2, "4": 8.0, "5": 8.8}
AXLE = {"a": 16.0, "b": 18.0, "c": 20.0, "d": 22.5, "e": 25.0}


@pytest.mark.parametrize("category", ["a", "b1", "b2", "c2", "c3", "c4", "d2", "d3", "d4", "d5", "e4", "e5"])
def test_en15528_wagons_have_the_masses_of_their_categories(category):
    train = load_trains.en15528(category, 3)
    wagon = train.placements[0].vehicle
    np.testing.assert_allclose(wagon.static_forces(), 1e3 * 9.81 * AXLE[category[0]])
    per_meter = wagon.static_forces().sum() / 9810.0 / wagon.length
    assert round(per_meter, 1) == PER_METER[category[1:] or "1"]
    np.testing.assert_allclose(np.diff(train.offsets[::4]), wagon.length)
    assert train.offsets[1] == 1.8


def test_real_trains():
    ice3 = load_trains.vehicle("ice3-axles")
    assert (ice3.wheelbase, ice3.length, len(ice3.contacts)) == (193.3, 200.32, 32)
    # masses of Goicolea (2014): 47.8 + 2 · 3.5 + 4 · 1.8 t, cars 4 and 5 with 41.2 t
    expected = 9.81 * np.repeat([62.0, 55.4, 62.0], [12, 8, 12]) / 4.0
    np.testing.assert_allclose(ice3.static_forces() / 1e3, expected, rtol=5e-5)
    ave = load_trains.vehicle("ave-s100")
    assert (ave.wheelbase, ave.length, len(ave.contacts)) == (193.16, 200.15, 26)
    forces = ave.static_forces()
    np.testing.assert_array_equal(forces, forces[::-1])
    assert forces.sum() == pytest.approx(2e3 * (2 * (172.1 + 170.7 + 131.6 + 161.9 + 169.2 + 167.9) + 160.5))


def test_every_entry_can_be_built_and_says_where_it_comes_from():
    entries = load_trains.entries()
    assert len({entry.name for entry in entries}) == len(entries) == 37
    for entry in entries:
        vehicle = entry.vehicle()
        assert vehicle.name == entry.name
        assert vehicle.static_forces().min() > 1e3
        assert entry.source
        assert entry.certainty in ("verified", "one source", "check against the standard")


def test_static_load_models():
    lm71 = load_trains.LM71
    assert sum(force for _, force in lm71.forces) == 1e6
    assert lm71.distributed[1][:1] == (3.2,)
    assert lm71.scaled(1.33).forces[0] == (-2.4, 1.33 * 250e3)
    for model, load, length, gap in (
        (load_trains.SW0, 133e3, 15.0, 5.3),
        (load_trains.SW2, 150e3, 25.0, 7.0),
    ):
        (begin, first, one), (second, end, other) = model.distributed
        assert one == other == load
        assert (first - begin, second - first, end - second) == pytest.approx((length, gap, length))
        assert begin == -end
    assert {model.certainty for model in load_trains.STATIC.values()} == {"check against the standard"}


@pytest.mark.parametrize(
    ("build", "message"),
    [
        (lambda: load_trains.hslm_a(11), "number = 11: must be 1 to 10"),
        (lambda: load_trains.fatigue(0), "number = 0: must be 1 to 12"),
        (lambda: load_trains.en15528("d6"), "Did you mean"),
        (lambda: load_trains.vehicle("hslm-a11"), "Did you mean 'hslm-a1"),
        (lambda: load_trains.hslm_b(0, 3.0), "forces = 0: must be a whole number of at least 1"),
        (lambda: load_trains.hslm_b(10, -3.0), "spacing = -3.0: must be positive"),
    ],
)
def test_errors(build, message):
    with pytest.raises(InputError, match=message):
        build()
