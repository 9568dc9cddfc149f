"""Consecutive steps in one compiled loop are the steps made one by one."""

import numpy as np
import pytest

from axlespan.bridges import ballasted_track, simple_span, with_track
from axlespan.dynamics.alpha import Alpha
from axlespan.interaction import runs as module
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.fused.alike import AlikeTrains
from axlespan.interaction.fused.march import FusedMarch
from axlespan.interaction.simulate import simulate_many
from axlespan.irregularity import Harmonic
from axlespan.model.damping import Modal
from axlespan.vehicles.simple import axle_loads, rigid_body, sprung_mass
from axlespan.vehicles.train import Train

pytest.importorskip("numba")

BEAM = dict(length=25.0, youngs_modulus=2.87e9, second_moment=2.9, mass_per_length=2303.0)
SPAN = simple_span(**BEAM, elements=20)
TRACK = with_track(SPAN, ballasted_track(), approach=25.0, exit=25.0)
DAMPED = simple_span(**BEAM, elements=140, damping=Modal(0.03, modes=11))
DAMPED_TRACK = with_track(
    simple_span(**BEAM, elements=20, damping=Modal(0.03)), ballasted_track(), approach=25.0, exit=25.0
)
SMALL = simple_span(**BEAM, elements=11, damping=Modal(0.03))
MASSES = Train.of(
    sprung_mass(mass=5750.0, stiffness=1.595e6, damping=3e4, unsprung_mass=600.0), count=3, spacing=4.0
)
LOADS = Train.of(axle_loads(loads=[1e5, 8e4], positions=[0.0, 3.0]))
QUANTITIES = (
    "contact_force",
    "sensor_displacement",
    "sensor_velocity",
    "vehicle_displacement",
    "support_reaction",
)


def crossings(structure, count):
    """Masses and moving loads by turns, at different speeds over a wavy line."""
    wavy = Harmonic(amplitude=0.5e-3, wavelength=5.0)
    trains = (MASSES, LOADS, MASSES)
    return [Crossing(structure, trains[i % 3], speed=20.0 + 3.0 * i, irregularity=wavy) for i in range(count)]


def run(cases, alpha):
    steps = [300 + 40 * i for i in range(len(cases))]
    return simulate_many(
        cases, time_step=1e-3, steps=steps, method=Alpha(alpha), sensors={"middle": 12.5}, footprint=0.0
    )


def compared(cases, alpha, tolerance, monkeypatch):
    """Results of the compiled loop, which are those of steps made one by one; and the marches that were used."""
    used = []
    real = FusedMarch.of.__func__

    def seen(convoy):
        used.append(real(FusedMarch, convoy))
        return used[-1]

    monkeypatch.setattr(module, "FusedMarch", type("Seen", (), {"of": staticmethod(seen)}))
    fused = run(cases, alpha)
    assert used
    assert all(made is not None for made in used)
    monkeypatch.setattr(module, "FusedMarch", type("Never", (), {"of": staticmethod(lambda convoy: None)}))
    for one, other in zip(fused, run(cases, alpha), strict=True):
        for name in QUANTITIES:
            a, b = getattr(one, name), getattr(other, name)
            assert np.abs(a - b).max(initial=0.0) <= tolerance * np.abs(b).max(initial=0.0), name
        assert one.checks["compatibility_residual"] < 1e-10
        assert one.checks["equilibrium_residual"] < 1e-7
    return fused, used


# Stiff rails over soft ballast make the effective matrix of the track so unequal that LAPACK's factor in place of the
# compiled one moves the same run by 1e-9 of the displacements, and by more of the velocities.
@pytest.mark.parametrize(("structure", "tolerance"), [(SPAN, 1e-9), (TRACK, 1e-6)], ids=["span", "track"])
@pytest.mark.parametrize("alpha", [0.0, -0.1])
@pytest.mark.parametrize("count", [1, 2, 10])
def test_same_numbers(structure, tolerance, alpha, count, monkeypatch):
    """One crossing, two one after the other, eight side by side and two more; all leave at different times."""
    compared(crossings(structure, count), alpha, tolerance, monkeypatch)


@pytest.mark.parametrize("structure", [DAMPED, DAMPED_TRACK, SMALL], ids=["span", "track", "small"])
@pytest.mark.parametrize(("alpha", "tolerance"), [(0.0, 1e-7), (-0.1, 1e-8)])
@pytest.mark.parametrize("count", [1, 10])
def test_damping_of_modes(structure, tolerance, alpha, count, monkeypatch):
    """Beside the band, with vehicles and moving loads; a load of the structure itself acts from the start."""
    assert structure.system.modal_damping is not None
    fused, used = compared(crossings(structure, count), alpha, tolerance, monkeypatch)
    assert all(made._body.modal is not None for made in used)
    undamped = run(crossings(TRACK if structure is DAMPED_TRACK else SPAN, 1), alpha)[0]
    change = np.abs(undamped.sensor_displacement - fused[0].sensor_displacement).max()
    assert change > 1e-3 * np.abs(undamped.sensor_displacement).max()  # the damping is felt


def cars(mass):
    """Two kinds of vehicles on six wheels, of ten d.o.f. in blocks of four and two, with damped suspensions."""
    body = rigid_body(
        mass=mass, pitch_inertia=2.0 * mass, axles=(0.0, 4.0), stiffness=8e5, damping=2e4, unsprung_mass=700.0
    )
    small = sprung_mass(mass=3000.0, stiffness=1e6, damping=1e4, unsprung_mass=500.0)
    return Train.joined([Train.of(body), Train.of(small), Train.of(body), Train.of(small)], [3.0, 2.5, 3.0])


@pytest.mark.parametrize("structure", [SPAN, TRACK], ids=["span", "track"])
@pytest.mark.parametrize(
    "masses", [(2e4,) * 5, (2e4,) * 9, (2e4, 2e4, 2.1e4, 2e4)], ids=["five", "nine", "unequal"]
)
def test_vehicles_of_equal_trains_go_side_by_side(masses, structure, monkeypatch):
    """One of several lanes gives the numbers of its crossing alone, as do unequal trains, which go by themselves."""
    wavy = Harmonic(amplitude=0.5e-3, wavelength=5.0)
    known = {mass: cars(mass) for mass in masses}
    cases = [
        Crossing(structure, known[mass], speed=20.0 + 4.0 * i, start=20.0, irregularity=wavy)
        for i, mass in enumerate(masses)
    ]
    made = []
    real = AlikeTrains.of.__func__

    def seen(*args):
        made.append(real(AlikeTrains, *args))
        return made[-1]

    monkeypatch.setattr(AlikeTrains, "of", staticmethod(seen))

    def moved(some):
        return simulate_many(some, time_step=1e-3, steps=400, method=Alpha(-0.1), sensors={"middle": 12.5})

    together = moved(cases)
    assert {one is not None for one in made} == {len(set(masses)) == 1}
    for case, one in zip(cases, together, strict=True):
        (alone,) = moved([case])
        for name in QUANTITIES:
            a, b = getattr(one, name), getattr(alone, name)
            part = 1e-9 if structure is TRACK and name in ("sensor_velocity", "support_reaction") else 1e-10
            assert np.abs(a - b).max() <= part * np.abs(b).max(), name


def test_an_indefinite_contact_system_is_refused():
    """The small factorization says so, and solves what is definite within the reach of its rows."""
    from axlespan.interaction.fused.contact_kernel import solve_system

    rng = np.random.default_rng(3)
    half = rng.standard_normal((9, 9))
    matrix, right = half @ half.T + 20.0 * np.eye(9), rng.standard_normal(9)
    matrix[:3, 5:], matrix[5:, :3] = 0.0, 0.0
    matrix[0, 4] = matrix[4, 0] = matrix[0, 2] = matrix[2, 0] = 0.0
    reach = np.array([int(np.flatnonzero(row).max()) for row in matrix])
    x = right.copy()
    assert solve_system(matrix.copy(), reach.copy(), 9, x)
    np.testing.assert_allclose(matrix @ x, right, atol=1e-12)
    for wrong in (-100.0, np.nan):
        matrix[4, 4] = wrong
        assert not solve_system(matrix.copy(), reach.copy(), 9, right.copy())


@pytest.mark.parametrize("spread", [1, 9])
def test_contact_systems_are_those_of_plain_numpy(spread):
    """Rows close together on the path and far apart, at its ends, wheels off the structure, two vehicles."""
    from axlespan.interaction.fused.contact_kernel import fill_system, pack_rows, room_for

    rng = np.random.default_rng(spread)
    n, width, lanes = 60, 31, 4
    full = rng.standard_normal((n, n))
    full = full + full.T
    full[np.abs(np.subtract.outer(np.arange(n), np.arange(n))) > 12] = 0.0
    offset = np.clip(np.arange(n) - 15, 0, n - width)
    Z = np.array([full[i, begin : begin + width] for i, begin in enumerate(offset)])
    low, high = np.maximum(np.arange(n) - 12, 0), np.minimum(np.arange(n) + 13, n)
    rows = rng.permutation(n)  # of the body, at path places
    row_of = np.empty(n, dtype=np.int64)
    row_of[rows] = np.arange(n)
    E, place, weights = np.zeros((5, n)), np.zeros((5, 4), dtype=np.int64), np.zeros((5, 4))
    for wheel, begin in enumerate((0, 6, 14, 22, n - 1 - 3 * spread)):
        if wheel == 2:
            continue  # off the structure
        at = begin + spread * np.arange(4)
        weights[wheel] = rng.standard_normal(4)
        E[wheel, at], place[wheel] = weights[wheel], rows[at] * lanes + 1
    vehicles = np.zeros((7, 7))
    vehicles[1:4, 1:4], vehicles[4:7, 4:7] = 3.0 * np.eye(3) + 0.5, 2.0 * np.eye(3) + 0.25
    at = np.array([0, 1, 2, 4, 5])
    room, S, reach = room_for(5, 4), np.full((6, 6), np.nan), np.zeros(6, dtype=np.int64)
    path = (
        row_of,
        np.stack([np.arange(n) * width - offset, low, high, offset], axis=1),
        Z.reshape(-1),
        width,
    )
    on = np.array([0, 1, 3, 4])
    pack_rows((0,) * lanes, on, place, weights, path, room)
    own_vehicles = np.triu(vehicles[1:, 1:])
    ends = np.array([int(np.flatnonzero(row).max()) for row in own_vehicles])
    fill_system(on, at, 0, 6, (own_vehicles.ravel(), ends, 0), path, room, S, reach)
    wanted = vehicles[1:, 1:].copy()
    wanted[np.ix_(at, at)] += E @ full @ E.T
    upper = np.triu_indices(6)
    np.testing.assert_allclose(S[upper], wanted[upper], atol=1e-12)
    assert all(reach >= [int(np.flatnonzero(row).max()) for row in np.triu(wanted)])


def test_a_wheel_out_of_reach_does_not_hide_one_that_loads_two_lines():
    """Three wheels whose lowest places descend: the last one stands on both lines, so near to the first one again."""
    from axlespan.interaction.fused.contact_kernel import fill_system, pack_rows, room_for

    n, width = 200, 31  # two lines of 100 places
    near = np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    full = np.where(near > 12, 0.0, np.exp(-0.3 * near))
    offset = np.clip(np.arange(n) - 15, 0, n - width)
    Z = np.array([full[i, begin : begin + width] for i, begin in enumerate(offset)])
    low, high = np.maximum(np.arange(n) - 12, 0), np.minimum(np.arange(n) + 13, n)
    place = np.array([[110, 111, 112, 113], [60, 61, 62, 63], [6, 7, 106, 107]])
    weights = np.full((3, 4), 0.25)
    E = np.zeros((3, n))
    np.put_along_axis(E, place, weights, axis=1)
    room, S, reach = room_for(3, 4), np.full((3, 3), np.nan), np.zeros(3, dtype=np.int64)
    path = (
        np.arange(n),
        np.stack([np.arange(n) * width - offset, low, high, offset], axis=1),
        Z.reshape(-1),
        width,
    )
    on = np.arange(3)
    pack_rows((0,), on, place, weights, path, room)
    vehicles = (np.eye(3).ravel(), np.arange(3), 0)
    fill_system(on, np.arange(3), 0, 3, vehicles, path, room, S, reach)
    wanted = np.eye(3) + E @ full @ E.T
    assert wanted[0, 2] > 0.01
    np.testing.assert_allclose(S[np.triu_indices(3)], wanted[np.triu_indices(3)], atol=1e-12)
    assert reach[0] == 2
