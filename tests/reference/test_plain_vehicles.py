"""Vehicles written out by hand: statics, frequencies, rides over waves, crossings; and a rail on sleepers."""

import numpy as np
import pytest
from scipy.linalg import eigvals

from axlespan.errors import InputError
from axlespan.reference import (
    Axle,
    Motion,
    PlainVehicle,
    Profile,
    SleeperTrack,
    SuspendedBody,
    WheelUnit,
    WinklerBeam,
    articulated_truck,
    coach,
    cross_plain_vehicles,
    cross_wheel_units,
    half_car,
    harmonic,
    quarter_car,
    ride,
)
from axlespan.reference.neves2012 import BEAM

G = 9.81
TIRE = (1.75e6, 0.0)
ICE3 = coach(
    body=(47_800.0, 1_957_888.0),
    bogie=(3500.0, 1715.0),
    wheelset=1800.0,
    primary=(2.4e6, 20e3),
    secondary=(0.70e6, 40e3),
    bogie_centers=17.375,
    wheelbase=2.5,
)
TRUCK = articulated_truck(
    tractor=(4500.0, 4604.0),
    trailer=(31_450.0, 16_302.0),
    hinge=(2.15, 6.15),
    tractor_axles=[Axle(-0.5, 700.0, (400e3, 1e4), TIRE), Axle(2.5, 1100.0, (1e6, 1e4), TIRE)],
    trailer_axles=[Axle(x, 750.0, (750e3, 1e4), TIRE) for x in (1.8, 2.9, 4.0)],
)


def unit(wheel, body, stiffness, damping):
    """A body over one wheel, as matrices."""
    one = np.array([[1.0, -1.0], [-1.0, 1.0]])
    return PlainVehicle(
        ("body", "wheel"),
        np.diag([body, wheel]),
        damping * one,
        stiffness * one,
        np.array([body, wheel]),
        (0.0,),
    )


def test_a_coach_stands_evenly_on_its_wheels():
    """62 t on four axles: 152.055 kN each, as its source says."""
    np.testing.assert_allclose(ICE3.static_loads(G), 152_055.0, rtol=1e-12)
    assert ICE3.behind == (0.0, 2.5, 17.375, 19.875)


def test_a_truck_stands_in_equilibrium():
    """Forces and moments about the front axle, of the whole and of the tractor alone."""
    loads, at = TRUCK.static_loads(G), np.array(TRUCK.behind)
    centers = (
        (4500.0, 0.5),
        (31_450.0, 8.8),
        (700.0, 0.0),
        (1100.0, 3.0),
        (750.0, 10.6),
        (750.0, 11.7),
        (750.0, 12.8),
    )
    assert loads.sum() == pytest.approx(G * sum(m for m, _ in centers), rel=1e-12)
    assert loads @ at == pytest.approx(G * sum(m * x for m, x in centers), rel=1e-12)
    # the trailer about the hinge, 2.65 m behind the front axle
    behind = (loads[2:] - 750.0 * G) @ (at[2:] - 2.65)
    assert behind == pytest.approx(31_450.0 * G * 6.15, rel=1e-12)


def test_frequencies_of_a_coach_with_its_bogies_held():
    """Bounce at sqrt(2 k_s / m) = 0.861 Hz, pitch at sqrt(2 k_s (d/2)^2 / I)."""
    k, m = ICE3.stiffness[:2, :2], ICE3.mass[:2, :2]
    found = np.sqrt(np.sort(eigvals(k, m).real)) / (2.0 * np.pi)
    pitch = np.sqrt(1.4e6 * 8.6875**2 / 1_957_888.0) / (2.0 * np.pi)
    np.testing.assert_allclose(found, [0.8613, pitch], rtol=1e-4)


@pytest.mark.parametrize("vehicle", [ICE3, TRUCK], ids=["coach", "truck"])
def test_lifting_all_wheels_lifts_all_and_strains_nothing(vehicle):
    n = vehicle.free
    lifted = np.linalg.solve(vehicle.stiffness[:n, :n], -vehicle.stiffness[:n, n:].sum(axis=1))
    heights = [0.0 if "pitch" in name else 1.0 for name in vehicle.names[:n]]
    np.testing.assert_allclose(lifted, heights, atol=1e-9)


def test_a_ride_over_one_wave_is_that_of_a_suspended_body():
    mass, stiffness, damping, t = 4000.0, 1e6, 2e4, np.linspace(0.0, 2.0, 201)
    body = SuspendedBody(mass, stiffness, damping).over_harmonic(1e-3, 9.0, t)
    motion, force = ride(unit(0.0, mass, stiffness, damping), [9.0], [[-1e-3j]], t)  # Re -i e^(i x) = sin x
    np.testing.assert_allclose(motion[:, 0], body.displacement, atol=1e-15)
    np.testing.assert_allclose(force[:, 0], mass * body.acceleration, atol=1e-8)


def test_a_ride_of_wheels_with_mass_adds_their_inertia():
    t = np.linspace(0.0, 1.0, 101)
    motion, light = ride(unit(0.0, 4000.0, 1e6, 2e4), [9.0], [[1e-3]], t)
    again, heavy = ride(unit(500.0, 4000.0, 1e6, 2e4), [9.0], [[1e-3]], t)
    np.testing.assert_allclose(again, motion, atol=1e-15)
    np.testing.assert_allclose((heavy - light)[:, 0], -500.0 * 81.0 * 1e-3 * np.cos(9.0 * t), atol=1e-8)


@pytest.mark.parametrize("wheel", [0.0, 500.0])
@pytest.mark.parametrize("acceleration", [0.0, -5.0])
def test_a_unit_crosses_as_by_the_other_way_of_solving(wheel, acceleration):
    """Modes, body and wheel in one system agree with contact forces as unknowns, kinks and all."""
    time = np.arange(0.0, 1.4, 5e-3)
    ramp = Profile(
        lambda x: 2e-3 * np.clip((x - 5.0) / 3.0, 0.0, 1.0),
        lambda x: np.where((x >= 5.0) & (x <= 8.0), 2e-3 / 3.0, 0.0),
        np.zeros_like,
        (5.0, 8.0),
    )
    motion = Motion(25.0, start=-1.0, acceleration=acceleration)
    settings = {"profile": ramp, "modes": 6, "modal_damping": 0.01, "max_step": 1e-3}
    one = cross_plain_vehicles(BEAM, [unit(wheel, 5750.0, 1.595e6, 2e4)], motion, time, **settings)
    other = cross_wheel_units(BEAM, [WheelUnit(wheel, 5750.0, 1.595e6, 2e4)], motion, time, **settings)
    scale = np.abs(other.body_displacement).max()
    np.testing.assert_allclose(one.displacement, other.body_displacement, atol=1e-9 * scale)
    np.testing.assert_allclose(
        one.beam.displacement_at(12.5), other.beam.displacement_at(12.5), atol=1e-9 * scale
    )
    # at the kinks themselves the force jumps
    smooth = np.all([np.abs(time - motion.times_at(x)) > 1e-3 for x in (0.0, 5.0, 8.0, 25.0)], axis=0)
    np.testing.assert_allclose(one.contact_force[smooth], other.contact_force[smooth], atol=1e-7 * 6250.0 * G)


def test_two_vehicles_are_numbered_one_behind_the_other():
    """A second car far behind changes nothing for the first one on the span."""
    car = quarter_car(17_300.0, 700.0, (4e5, 1e4), TIRE)
    time = np.arange(0.0, 1.0, 0.02)
    alone = cross_plain_vehicles(BEAM, [car], Motion(20.0), time, modes=4)
    both = cross_plain_vehicles(BEAM, [car, car], Motion(20.0, (0.0, 40.0)), time, modes=4)
    np.testing.assert_allclose(both.contact_force[:, 0], alone.contact_force[:, 0], rtol=1e-9)
    np.testing.assert_allclose(both.displacement[:, :2], alone.displacement, atol=1e-12)
    np.testing.assert_allclose(both.contact_force[:, 1], 18_000.0 * G, rtol=1e-9)


def test_a_start_on_waves_is_static():
    """A half car stands on its uneven wheels: the sum of forces is the weight, and nothing moves yet."""
    car = half_car(
        (16_200.0, 93_457.0), [(-2.4, 700.0, 4e5, 1e4, 1.75e6, 0.0), (2.4, 1100.0, 1e6, 2e4, 3.5e6, 0.0)]
    )
    response = cross_plain_vehicles(
        BEAM, [car], Motion(1e-6, car.behind, start=-9.0), [0.0, 1.0], profile=harmonic(1e-2, 7.0), modes=2
    )
    assert response.contact_force[0].sum() == pytest.approx(18_000.0 * G, rel=1e-9)
    np.testing.assert_allclose(
        response.displacement[1], response.displacement[0], atol=2e-8
    )  # 1e-6 m on a slope


def test_sleepers_close_together_are_a_continuous_foundation():
    """Layers in series; 50 MN/m2 and 85 kN: 1.00562 mm."""
    each = 3.0 * 50e6 * 0.05
    track = SleeperTrack(210e9 * 3.0383e-5, 0.05, each, each, each, supports=200)
    rail = WinklerBeam(210e9 * 3.0383e-5, 50e6, 60.21)
    assert track.deflection(85e3, 200) == pytest.approx(-rail.static_deflection(85e3), rel=2e-4)


def test_shear_between_blocks_makes_the_track_stiffer():
    values = (12.5e6, 0.6, 130e6, 275e6, 155e6)
    with_shear = SleeperTrack(*values, shear=157e6, supports=60).deflection(150e3, 61)
    assert 0.6 < with_shear / SleeperTrack(*values, supports=60).deflection(150e3, 61) < 0.95
    with pytest.raises(InputError, match="three at least"):
        SleeperTrack(*values, supports=2)
