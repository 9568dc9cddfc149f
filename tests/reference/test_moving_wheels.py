"""Wheels with mass in their limits, with energy, momentum and order of convergence."""

import numpy as np
import pytest
from scipy.integrate import simpson

from axlespan.errors import InputError
from axlespan.reference import (
    Motion,
    Profile,
    SimplySupportedBeam,
    WheelUnit,
    cross_forces,
    cross_sprung_masses,
    cross_wheel_units,
    harmonic,
)

BEAM = SimplySupportedBeam(length=25.0, bending_stiffness=2.87e9 * 2.90, mass_per_length=2303.0)
UNIT = WheelUnit(wheel_mass=500.0, body_mass=5750.0, stiffness=1.595e6, damping=20e3)
WEIGHT = 6250.0 * 9.81


@pytest.mark.parametrize(("stages", "order"), [(1, 2), (2, 4), (3, 6)])
def test_the_order_of_the_integration(stages, order):
    motion, r = Motion(20.0, (0.0, 3.0)), harmonic(1e-4, 4.0)
    time = np.array([0.4, 0.8, 1.2])

    def force(step, s=stages):
        settings = {"modes": 3, "profile": r, "max_step": step, "stages": s}
        return cross_wheel_units(BEAM, [UNIT] * 2, motion, time, **settings).contact_force

    exact = force(2e-4, 3)
    step = {1: 5e-4, 2: 2e-3, 3: 4e-3}[stages]
    errors = [np.abs(force(h) - exact).max() for h in (step, step / 2)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.35)


def test_a_light_mass_is_a_moving_force():
    motion, time = Motion(0.4 * BEAM.critical_speed), np.linspace(0.0, 0.25, 251)
    differences = []
    for ratio in (1e-3, 1e-4, 1e-5):
        mass = ratio * BEAM.mass_per_length * BEAM.length
        unit = WheelUnit.rigid_mass(mass)
        crossing = cross_wheel_units(BEAM, [unit], motion, time, modes=8)
        force = cross_forces(BEAM, [mass * 9.81], motion, time, modes=8).modal_displacement
        change = np.abs(crossing.beam.modal_displacement - force).max() / np.abs(force).max()
        differences.append(change)
    # the first order in the mass ratio is all that is left
    np.testing.assert_allclose(np.array(differences[:-1]) / differences[1:], 10.0, rtol=0.02)
    assert differences[-1] < 1e-4


def test_a_stiff_spring_makes_a_moving_mass():
    motion, time, modes = Motion(40.0), np.linspace(0.0, 0.62, 311), 3
    mass = cross_wheel_units(BEAM, [WheelUnit.rigid_mass(5750.0)], motion, time, modes=modes)
    differences = []
    for stiffness in (1e7, 1e8, 1e9):
        # a dashpot of 10 % takes the shaking of the mass on its stiff spring away
        damping = 0.2 * np.sqrt(stiffness * 5750.0)
        sprung = WheelUnit.sprung_mass(5750.0, stiffness, damping)
        crossing = cross_sprung_masses(BEAM, [sprung], motion, time, modes=modes)
        change = crossing.beam.displacement_at(12.5) - mass.beam.displacement_at(12.5)
        differences.append(np.abs(change).max() / np.abs(mass.beam.displacement_at(12.5)).max())
    assert differences[0] > 3 * differences[1] > 9 * differences[2]
    assert differences[2] < 2e-3


def test_a_wheel_without_mass_is_the_limit_of_light_wheels():
    motion, time = Motion(20.0, (0.0, 3.0)), np.linspace(0.0, 1.6, 161)
    settings = {"modes": 5, "profile": harmonic(1e-4, 4.0), "max_step": 5e-4}
    sprung = WheelUnit.sprung_mass(5750.0, 1.595e6, 20e3)
    limit = cross_sprung_masses(BEAM, [sprung] * 2, motion, time, **settings)
    changes = []
    for mass in (1.0, 0.1):
        light = WheelUnit(mass, 5750.0, 1.595e6, 20e3)
        crossing = cross_wheel_units(BEAM, [light] * 2, motion, time, **settings)
        changes.append(np.abs(crossing.contact_force - limit.contact_force).max())
    assert changes[0] / changes[1] == pytest.approx(10.0, rel=0.02)
    assert changes[1] < 2.0  # [N]: the weight of 0.1 kg and a little


def test_energy_balance_between_events():
    motion, r = Motion(20.0, (0.0, 3.0), acceleration=2.0), harmonic(1e-3, 4.0)
    entry, leaving = motion.times_at(0.0)[1], motion.times_at(25.0)[0]
    time = np.linspace(entry + 1e-3, leaving - 1e-3, 8001)
    units = [UNIT, WheelUnit.rigid_mass(4000.0)]
    c = cross_wheel_units(BEAM, units, motion, time, modes=6, profile=r)
    omega = BEAM.angular_frequencies(6)
    q, v = c.beam.modal_displacement, c.beam.modal_velocity
    energy = 0.5 * BEAM.modal_mass * (v**2 + (omega * q) ** 2).sum(axis=1)
    stretch = c.wheel_displacement[:, 0] - c.body_displacement[:, 0]
    rate = c.wheel_velocity[:, 0] - c.body_velocity[:, 0]
    energy += 0.5 * UNIT.stiffness * stretch**2 + 0.5 * UNIT.body_mass * c.body_velocity[:, 0] ** 2
    for i, unit in enumerate(units):  # the static part of the springs turns M g z into M g y
        energy += 0.5 * unit.wheel_mass * c.wheel_velocity[:, i] ** 2
        energy += unit.mass * 9.81 * c.wheel_displacement[:, i]
    # the contact forces push along the path: N times what the wheel climbs beyond the beam's own velocity
    beam_velocity = np.einsum("tvn,tn->tv", BEAM.shapes(c.position, 6), v)
    power = (c.contact_force * (c.wheel_velocity - beam_velocity)).sum(axis=1) - UNIT.damping * rate**2
    work = simpson(power, x=time)
    assert np.abs(energy - energy[0]).max() > 50.0  # [J]: the balance is not empty
    assert energy[-1] - energy[0] == pytest.approx(work, abs=1e-4 * np.abs(energy - energy[0]).max())


def test_equations_of_motion_hold_in_the_result():
    motion, time = Motion(20.0, (0.0, 3.0)), np.linspace(0.3, 1.1, 9)
    c = cross_wheel_units(BEAM, [UNIT] * 2, motion, time, modes=12, profile=harmonic(1e-4, 4.0))
    omega = BEAM.angular_frequencies(12)
    load = -np.einsum("tvn,tv->tn", BEAM.shapes(c.position, 12), c.contact_force) / BEAM.modal_mass
    residual = c.beam.modal_acceleration + omega**2 * c.beam.modal_displacement - load
    np.testing.assert_allclose(residual, 0.0, atol=1e-9)
    inertia = 500.0 * c.wheel_acceleration + 5750.0 * c.body_acceleration
    np.testing.assert_allclose(c.contact_force, WEIGHT + inertia, rtol=1e-11)


def test_wheel_velocity_and_acceleration_are_rates_of_the_path():
    motion, h = Motion(20.0, (0.0,), acceleration=-3.0), 1e-5
    time = np.concatenate([t + h * np.arange(-1, 2) for t in (0.2, 0.5, 0.9)])
    c = cross_wheel_units(BEAM, [UNIT], motion, time, modes=4, profile=harmonic(1e-4, 4.0))
    y = c.wheel_displacement[:, 0].reshape(3, 3)
    # differences of 1e-3 m over 1e-5 s: truncation 1e-8, rounding 1e-11 for the rate, 1e-6 for the second one
    np.testing.assert_allclose(c.wheel_velocity[1::3, 0], (y[:, 2] - y[:, 0]) / (2 * h), atol=1e-7)
    v = c.wheel_velocity[:, 0].reshape(3, 3)
    np.testing.assert_allclose(c.wheel_acceleration[1::3, 0], (v[:, 2] - v[:, 0]) / (2 * h), atol=1e-5)


def test_on_the_ground_the_contact_force_follows_the_profile():
    motion = Motion(20.0, start=-30.0, acceleration=1.0)
    time = np.linspace(0.0, 1.2, 61)
    c = cross_wheel_units(
        BEAM, [WheelUnit.rigid_mass(700.0)], motion, time, modes=2, profile=harmonic(1e-3, 4.0)
    )
    x, v, wave = motion.position(time)[:, 0], 20.0 + time, 2 * np.pi / 4.0
    expected = 700.0 * (9.81 - 1e-3 * wave**2 * v**2 * np.sin(wave * x) + 1e-3 * wave * np.cos(wave * x))
    np.testing.assert_allclose(c.contact_force[:, 0], expected, rtol=1e-12)


def test_entry_and_exit_turn_the_wheel_and_give_the_beam_nothing():
    motion, late = Motion(20.0, (0.0, 3.0)), 1e-8
    time = np.array([0.15 - late, 0.15 + late, 1.25 - late, 1.25 + late])
    c = cross_wheel_units(BEAM, [UNIT] * 2, motion, time, modes=20)
    np.testing.assert_allclose(c.beam.modal_velocity[0], c.beam.modal_velocity[1], atol=1e-6)
    np.testing.assert_allclose(c.beam.modal_velocity[2], c.beam.modal_velocity[3], atol=1e-6)
    entry, leaving = c.impacts[0], c.impacts[1]
    assert (entry.vehicle, leaving.vehicle) == (1, 0)
    assert entry.time == pytest.approx(0.15)
    assert leaving.time == pytest.approx(1.25)
    # m v times the beam's slope there, downward at entry behind another wheel, upward at exit
    assert entry.impulse == pytest.approx(500.0 * 20.0 * c.beam.slope_at(0.0)[0], rel=1e-5)
    assert leaving.impulse == pytest.approx(-500.0 * 20.0 * c.beam.slope_at(25.0)[2], rel=1e-5)
    jump = c.wheel_velocity[1, 1] - c.wheel_velocity[0, 1]
    assert 500.0 * jump == pytest.approx(entry.impulse, rel=1e-4)


def test_a_kink_in_the_profile_is_the_limit_of_short_bends():
    at, rise, motion = 9.0, 2e-3, Motion(20.0, (0.0, 4.0))
    time = np.array([0.5, 0.6, 0.8, 1.0])

    def sharp(x):
        return rise * np.maximum(x - at, 0.0)

    kink = Profile(sharp, lambda x: np.where(x > at, rise, 0.0), np.zeros_like, kinks=(at,))
    settings = {"modes": 3, "max_step": 2.5e-4}
    exact = cross_wheel_units(BEAM, [UNIT] * 2, motion, time, profile=kink, **settings)
    turned = [
        impact for impact in exact.impacts if abs(motion.position(impact.time)[impact.vehicle] - at) < 1e-6
    ]
    assert [impact.vehicle for impact in turned] == [0, 1]
    # less than m v r', since the beam yields
    assert all(0.9 * 500.0 * 20.0 * rise < impact.impulse < 500.0 * 20.0 * rise for impact in turned)
    errors = []
    for length in (0.2, 0.1, 0.05):
        lo, hi = at - length / 2, at + length / 2
        bend = Profile(
            lambda x, lo=lo, hi=hi, n=length: np.where(
                x < lo, 0.0, np.where(x > hi, rise * (x - at), 0.5 * rise * (x - lo) ** 2 / n)
            ),
            lambda x, lo=lo, n=length: rise * np.clip((x - lo) / n, 0.0, 1.0),
            lambda x, lo=lo, hi=hi, n=length: np.where((x > lo) & (x < hi), rise / n, 0.0),
            kinks=(lo, hi),
        )
        smooth = cross_wheel_units(BEAM, [UNIT] * 2, motion, time, profile=bend, **settings)
        errors.append(np.abs(smooth.beam.modal_velocity - exact.beam.modal_velocity).max())
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 2.0, atol=0.15)


def test_two_units_follow_each_other_over_a_fine_wave():
    # 5750 kg on 1595 kN/m and 20 kNs/m over 500 kg, 3 m apart, 20 m/s, 0.1 mm waves of 4 m everywhere.
    # Wheels with mass feel the undamped bending waves that entries send out: a share of 1 / n in mode n,
    # 6e-4 of the static load in the force at an instant; averaged over 5 ms 20 and 40 modes agree.
    motion, time = Motion(20.0, (0.0, 3.0)), np.arange(12_501) * 1e-4
    settings = {"profile": harmonic(1e-4, 4.0)}
    forces = [
        cross_wheel_units(BEAM, [UNIT] * 2, motion, time, modes=modes, **settings).contact_force / WEIGHT
        for modes in (20, 40)
    ]
    window = ((time >= 0.05) & (time < 0.15)) | ((time >= 0.20) & (time < 1.25))
    assert np.abs(forces[0] - forces[1])[window].max() < 1e-3
    inner = ((time >= 0.055) & (time < 0.145)) | ((time >= 0.205) & (time < 1.245))
    mean = [
        np.stack([np.convolve(f[:, i], np.ones(50) / 50, "same") for i in (0, 1)], axis=1)[inner]
        for f in forces
    ]
    np.testing.assert_allclose(mean[0], mean[1], atol=1e-4)
    # and on the whole within 2 % of the static load
    assert 0.98 < mean[1].min() < 0.99
    assert 1.01 < mean[1].max() < 1.02


def test_wrong_input_is_named():
    with pytest.raises(InputError, match="must keep the wheels moving forward"):
        cross_wheel_units(BEAM, [UNIT], Motion(10.0, acceleration=-5.0), [2.5])
    with pytest.raises(InputError, match="must not jump under a dashpot or a wheel with mass"):
        cross_wheel_units(BEAM, [UNIT], Motion(10.0), [1.0], profile=harmonic(1e-3, 5.0, 1.0, 25.0))
    with pytest.raises(InputError, match=r"max_step = 0.0: must be a positive number"):
        cross_wheel_units(BEAM, [UNIT], Motion(10.0), [1.0], max_step=0.0)
    with pytest.raises(InputError, match="slope and curvature for wheels with mass"):
        cross_wheel_units(BEAM, [UNIT], Motion(10.0), [1.0], profile=Profile(np.sin, np.cos))
