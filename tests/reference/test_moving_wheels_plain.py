"""Wheels with mass against a plain integration of the equations of motion."""

import itertools

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from axlespan.reference import Motion, SimplySupportedBeam, WheelUnit, cross_wheel_units, harmonic

BEAM = SimplySupportedBeam(length=25.0, bending_stiffness=2.87e9 * 2.90, mass_per_length=2303.0)
UNIT = WheelUnit(wheel_mass=500.0, body_mass=5750.0, stiffness=1.595e6, damping=20e3)


def plain_crossing(units, motion, time, modes, r=lambda x, order: 0.0):
    """States and contact forces by a method of order 8, the mass matrix written out at every call.

    At an event the modal velocities go on unchanged: at the supports a wheel gives no impulse to the modes.
    """
    m = len(units)
    wave = np.arange(1, modes + 1) * np.pi / BEAM.length
    stiffness = 0.5 * BEAM.length * BEAM.bending_stiffness * wave**4
    modal_mass = 0.5 * BEAM.length * BEAM.mass_per_length

    def motion_of(t, state, on):
        q, v, z, z_rate = (
            state[:modes],
            state[modes : 2 * modes],
            state[2 * modes : 2 * modes + m],
            state[-m:],
        )
        speed, x = motion.speed + motion.acceleration * t, motion.position(t)
        mass, load = modal_mass * np.eye(modes), -stiffness * q
        body, wheels = np.zeros(m), []
        for i, u in enumerate(units):
            slope, bend = r(x[i], 1), r(x[i], 2)
            y, y_rate, known, phi = r(x[i], 0), 0.0, speed**2 * bend, np.zeros(modes)
            if on[i]:
                phi, d1 = np.sin(wave * x[i]), wave * np.cos(wave * x[i])
                y += phi @ q
                slope += d1 @ q
                y_rate += phi @ v
                known += 2 * speed * d1 @ v - speed**2 * (wave**2 * phi) @ q
            y_rate += speed * slope
            known += motion.acceleration * slope
            push = u.stiffness * (y - z[i]) + u.damping * (y_rate - z_rate[i])
            mass += u.wheel_mass * np.outer(phi, phi)
            load -= phi * (u.mass * 9.81 + push + u.wheel_mass * known)
            body[i] = push / u.body_mass if u.body_mass else 0.0
            wheels.append((u.mass * 9.81 + push, known, phi))
        a = np.linalg.solve(mass, load)
        force = [
            f + u.wheel_mass * (known + phi @ a) for u, (f, known, phi) in zip(units, wheels, strict=True)
        ]
        return np.concatenate((v, a, z_rate, body)), np.array(force)

    crossings = np.concatenate((motion.times_at(0.0), motion.times_at(BEAM.length)))
    events = [0.0, *sorted(t for t in crossings if 0.0 < t < time[-1]), time[-1]]
    start = [r(-x, 0) if u.body_mass else 0.0 for x, u in zip(motion.offsets, units, strict=True)]
    state = np.concatenate((np.zeros(2 * modes), start, np.zeros(m)))
    states, forces = np.full((time.size, state.size), np.nan), np.full((time.size, m), np.nan)
    for a, b in itertools.pairwise(events):
        middle = motion.position(0.5 * (a + b))
        on = (middle > 0.0) & (middle < BEAM.length)
        rows = np.flatnonzero((time >= a) & (time < b))
        solved = solve_ivp(
            lambda t, s, on=on: motion_of(t, s, on)[0],
            (a, b),
            state,
            "DOP853",
            t_eval=np.append(time[rows], b),
            rtol=1e-10,
            atol=1e-14,
        )
        states[rows] = solved.y.T[:-1]
        forces[rows] = [motion_of(t, s, on)[1] for t, s in zip(solved.t[:-1], solved.y.T, strict=False)]
        state = solved.y[:, -1]
    return states[:-1], forces[:-1]


@pytest.mark.parametrize("acceleration", [0.0, -6.0])
def test_units_equal_a_plain_integration(acceleration):
    units = [UNIT, WheelUnit.rigid_mass(3000.0), WheelUnit(800.0, 12_000.0, 2.5e6, 10e3)]
    motion = Motion(20.0, offsets=(0.0, 3.1, 9.7), acceleration=acceleration)
    time, wave = np.linspace(0.0, 1.6, 321), 2 * np.pi / 4.0

    def r(x, order):
        return 2e-4 * wave**order * (np.sin, np.cos, lambda p: -np.sin(p))[order](wave * x)

    states, force = plain_crossing(units, motion, time, 4, r)
    crossing = cross_wheel_units(BEAM, units, motion, time, modes=4, profile=harmonic(2e-4, 4.0))
    # the plain integration holds 1e-10 of the state; deflections reach 5 mm, forces 150 kN
    np.testing.assert_allclose(crossing.beam.modal_displacement[:-1], states[:, :4], atol=1e-10)
    np.testing.assert_allclose(crossing.beam.modal_velocity[:-1], states[:, 4:8], atol=1e-8)
    sprung = [0, 2]
    np.testing.assert_allclose(
        crossing.body_displacement[:-1, sprung], states[:, 8:11][:, sprung], atol=1e-10
    )
    np.testing.assert_allclose(crossing.body_velocity[:-1, sprung], states[:, 11:][:, sprung], atol=1e-8)
    events = np.concatenate((motion.times_at(0.0), motion.times_at(25.0)))
    between = np.abs(time[:-1, None] - events).min(axis=1) > 1e-9  # forces jump at events
    np.testing.assert_allclose(crossing.contact_force[:-1][between], force[between], atol=0.05)
    # a rigid mass is its own body
    np.testing.assert_array_equal(crossing.body_acceleration[:, 1], crossing.wheel_acceleration[:, 1])


# largest mid-span deflection over M g L^3 / 48 EI during the crossing, 80 modes, steps of 3e-5 s
MIDSPAN = {
    (0.1, 0.25): 1.28719,
    (0.1, 0.5): 1.76290,
    (0.1, 0.75): 1.80348,
    (0.5, 0.25): 1.41790,
    (0.5, 0.5): 2.02212,
    (0.5, 0.75): 2.23081,
    (1.0, 0.25): 1.57126,
    (1.0, 0.5): 2.44965,
    (1.0, 0.75): 2.28575,
}


@pytest.mark.parametrize("ratio", [0.1, 0.5, 1.0])
@pytest.mark.parametrize("alpha", [0.25, 0.5, 0.75])
def test_moving_mass_converges_in_time_and_modes(ratio, alpha):
    mass = ratio * BEAM.mass_per_length * BEAM.length
    motion = Motion(alpha * BEAM.critical_speed)
    until = BEAM.length / motion.speed
    time = np.linspace(0.0, until, 401)

    unit = WheelUnit.rigid_mass(mass)
    _, force = plain_crossing([unit], motion, time, 5)
    five = cross_wheel_units(BEAM, [unit], motion, time, modes=5)
    np.testing.assert_allclose(five.contact_force[:-1], force, atol=1e-6 * np.abs(force).max())
    ten = cross_wheel_units(BEAM, [unit], motion, time, modes=10)
    static = mass * 9.81 * 25.0**3 / (48 * BEAM.bending_stiffness)
    # 10 modes against 80: 2.4e-4 measured for the heaviest and fastest mass, 5e-4 with the times sampled
    assert -ten.beam.displacement_at(12.5).min() / static == pytest.approx(MIDSPAN[ratio, alpha], rel=6e-4)


@pytest.mark.parametrize(("ratio", "alpha"), [(0.1, 0.5), (0.5, 0.25), (1.0, 0.75)])
def test_moving_mass_table_holds_for_another_beam(ratio, alpha):
    # mass ratio and speed parameter say all: a beam of other length, stiffness and mass has the same table
    beam = SimplySupportedBeam(length=8.0, bending_stiffness=4e8, mass_per_length=700.0)
    mass = ratio * 700.0 * 8.0
    motion = Motion(alpha * beam.critical_speed)
    time = np.linspace(0.0, 8.0 / motion.speed, 2001)
    crossing = cross_wheel_units(beam, [WheelUnit.rigid_mass(mass)], motion, time, modes=24, max_step=2e-5)
    static = mass * 9.81 * 8.0**3 / (48 * 4e8)
    # 24 modes against 80: 2e-4 measured for the heaviest and fastest
    assert -crossing.beam.displacement_at(4.0).min() / static == pytest.approx(
        MIDSPAN[ratio, alpha], rel=3e-4
    )
