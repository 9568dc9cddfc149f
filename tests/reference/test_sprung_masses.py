"""Sprung masses against printed peaks and a plain integration of the coupled equations."""

import itertools

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from axlespan.errors import InputError
from axlespan.reference import (
    Motion,
    Newmark,
    Profile,
    SimplySupportedBeam,
    SuspendedBody,
    WheelUnit,
    cross_forces,
    cross_sprung_masses,
    cross_sprung_masses_newmark,
    harmonic,
)

BEAM = SimplySupportedBeam(length=25.0, bending_stiffness=2.87e9 * 2.90, mass_per_length=2303.0)
MASS = WheelUnit.sprung_mass(5750.0, 1.595e6)
SPEED = 100 / 3.6


def plain_crossing(masses, offsets, speed, time, modes, height, slope, zeta=0.0):
    """N12 (41, 42) with dashpots and damping, written out per mass, by a method of order 8."""
    n = np.arange(1, modes + 1)
    wave = n * np.pi / BEAM.length
    omega = wave**2 * np.sqrt(BEAM.bending_stiffness / BEAM.mass_per_length)
    modal_mass = BEAM.mass_per_length * BEAM.length / 2
    m = len(masses)

    def contact(t, state):
        q, v, z, z_rate = state[:modes], state[modes : 2 * modes], state[2 * modes : -m], state[-m:]
        forces, load = [], np.zeros(modes)
        for i, unit in enumerate(masses):
            xi = speed * t - offsets[i]
            stretch, rate = height(xi) - z[i], speed * slope(xi) - z_rate[i]
            on = 0.0 <= xi <= BEAM.length
            if on:
                stretch += np.sin(wave * xi) @ q
                rate += np.sin(wave * xi) @ v + speed * (wave * np.cos(wave * xi)) @ q
            forces.append(unit.body_mass * 9.81 + unit.stiffness * stretch + unit.damping * rate)
            if on:
                load -= np.sin(wave * xi) * forces[-1] / modal_mass
        return np.array(forces), load

    def rates(t, state):
        q, v, z_rate = state[:modes], state[modes : 2 * modes], state[-m:]
        forces, load = contact(t, state)
        bodies = [(force / unit.body_mass - 9.81) for force, unit in zip(forces, masses, strict=True)]
        return np.concatenate((v, load - 2 * zeta * omega * v - omega**2 * q, z_rate, bodies))

    start = np.concatenate((np.zeros(2 * modes), [height(-x) for x in offsets], np.zeros(m)))
    events = sorted({0.0, time[-1], *[(x + end) / speed for x in offsets for end in (0.0, BEAM.length)]})
    events = [t for t in events if t <= time[-1]]
    states, state = [start[:, None]], start
    for a, b in itertools.pairwise(events):
        asked = time[(time > a) & (time <= b)]
        inside = (a + 1e-12, b - 1e-12)  # theta is evaluated between the events only
        solved = solve_ivp(
            rates,
            inside,
            state,
            "DOP853",
            t_eval=np.unique(np.clip(np.append(asked, b), *inside)),
            rtol=1e-11,
            atol=1e-14,
        )
        states.append(solved.y[:, : asked.size])
        state = solved.y[:, -1]
    states = np.hstack(states)
    return states, np.array([contact(t, s)[0] for t, s in zip(time, states.T, strict=True)])


# by number of modes: mid-span peak [mm] and its time, mid-span acceleration, the mass's peak and acceleration
TABLE = [
    (1, 2.38389, 0.3697, 0.23363, -0.27309, 2.65768, 0.12983, -0.18361),
    (3, 2.40973, None, 0.30896, -0.35199, 2.58968, 0.14446, -0.14865),
    (5, 2.40826, None, 0.33236, -0.37497, 2.58967, 0.14297, -0.14809),
    (9, 2.40757, None, 0.35616, -0.40506, 2.58990, 0.14229, -0.14801),
    (21, 2.40731, 0.3710, 0.37203, -0.41088, 2.58998, 0.14219, -0.14797),
]


@pytest.mark.parametrize(("modes", "w", "at", "w_max", "w_min", "z", "z_max", "z_min"), TABLE)
def test_one_mass_by_number_of_modes(modes, w, at, w_max, w_min, z, z_max, z_min):
    time = np.arange(9001) * 1e-4
    crossing = cross_sprung_masses(BEAM, [MASS], Motion(SPEED), time, modes=modes)
    midspan = 1e3 * crossing.beam.displacement_at(12.5)
    assert -midspan.min() == pytest.approx(w, abs=1.1e-5)  # five decimals, one unit in the last
    if at is not None:
        assert time[midspan.argmin()] == pytest.approx(at, abs=1.5e-4)
    # the mid-span acceleration rings with the highest mode: its peak moves by 3 % with the sampling
    acceleration = -crossing.beam.acceleration_at(12.5)
    assert acceleration.max() == pytest.approx(w_max, rel=0.03)
    assert acceleration.min() == pytest.approx(w_min, rel=0.03)
    assert -1e3 * crossing.body_displacement.min() == pytest.approx(z, abs=1.1e-5)
    assert -crossing.body_acceleration.min() == pytest.approx(z_max, abs=1.1e-5)
    assert -crossing.body_acceleration.max() == pytest.approx(z_min, abs=1.1e-5)


def test_one_mass_along_the_crossing():
    time = np.arange(901) * 1e-3
    tenths = np.arange(100, 801, 100)
    many = cross_sprung_masses(BEAM, [MASS], Motion(SPEED), time, modes=21)
    w = [0.69711, 1.43738, 1.84991, 2.30548, 2.10969, 1.98538, 1.30386, 0.86360]
    z = [0.05183, 0.86495, 2.09082, 2.55617, 2.21105, 1.64224, 1.35380, 0.35893]
    np.testing.assert_allclose(-1e3 * many.beam.displacement_at(12.5)[tenths], w, atol=1.1e-5)
    np.testing.assert_allclose(-1e3 * many.body_displacement[tenths, 0], z, atol=1.1e-5)
    one = cross_sprung_masses(BEAM, [MASS], Motion(SPEED), time, modes=1)
    w = [0.71704, 1.46320, 1.84284, 2.27955, 2.09836, 1.99179, 1.31456, 0.88357]
    np.testing.assert_allclose(-1e3 * one.beam.displacement_at(12.5)[tenths], w, atol=1.1e-5)


@pytest.mark.parametrize("damping", [0.0, 30e3])
def test_several_masses_equal_a_plain_integration(damping):
    # three different masses, uneven offsets, irregularity on and off the beam, damped beam
    masses = [
        WheelUnit.sprung_mass(5750.0, 1.595e6, damping),
        WheelUnit.sprung_mass(20_000.0, 1.0e6, 2 * damping),
        WheelUnit.sprung_mass(3_000.0, 4.0e6, damping),
    ]
    offsets, wave, modes = (0.0, 4.3, 11.0), 2 * np.pi / 7.0, 4
    time = np.linspace(0.0, 1.4, 281)
    r = harmonic(1e-3, 7.0, phase=0.4)
    crossing = cross_sprung_masses(
        BEAM, masses, Motion(SPEED, offsets), time, modes=modes, profile=r, modal_damping=0.01
    )
    states, force = plain_crossing(
        masses,
        offsets,
        SPEED,
        time,
        modes,
        lambda x: 1e-3 * np.sin(wave * x + 0.4),
        lambda x: 1e-3 * wave * np.cos(wave * x + 0.4),
        zeta=0.01,
    )
    # tolerance of the plain integration 1e-11 of the state, and its gaps of 1e-12 s at the events
    np.testing.assert_allclose(crossing.beam.modal_displacement, states[:modes].T, atol=1e-11)
    np.testing.assert_allclose(crossing.beam.modal_velocity, states[modes : 2 * modes].T, atol=1e-9)
    np.testing.assert_allclose(crossing.body_displacement, states[2 * modes : -3].T, atol=1e-10)
    np.testing.assert_allclose(crossing.body_velocity, states[-3:].T, atol=1e-9)
    np.testing.assert_allclose(crossing.contact_force, force, atol=1e-2)  # of 30 to 200 kN


# the second wheel's entry and every exit make the dashpot's force jump, which costs Newmark an order:
# so a single damped mass until it leaves, and the undamped ones through all events
@pytest.mark.parametrize(
    ("unit", "offsets", "until"),
    [(MASS, (0.0, 4.0), 1.08), (WheelUnit.sprung_mass(5750.0, 1.595e6, 50e3), (0.0,), 0.88)],
)
def test_newmark_steps_converge_with_order_two(unit, offsets, until):
    motion, r = Motion(SPEED, offsets), harmonic(0.5e-3, 5.0, phase=0.3)
    settings = {"modes": 2, "profile": r, "modal_damping": 0.01}
    units = [unit] * len(offsets)

    def error(step):
        # entries and exits at 0, 0.144, 0.9 and 1.044 s fall on step ends
        steps = round(until / step)
        coarse = cross_sprung_masses_newmark(BEAM, units, motion, step, steps, **settings)
        fine = cross_sprung_masses(BEAM, units, motion, coarse.time, max_step=step, **settings)
        return np.array(
            [
                np.abs(coarse.beam.modal_displacement - fine.beam.modal_displacement).max(),
                np.abs(coarse.body_displacement - fine.body_displacement).max(),
            ]
        )

    np.testing.assert_allclose(np.log2(error(4e-4) / error(2e-4)), 2.0, atol=0.1)


def test_newmark_keeps_the_energy_law_of_its_equations():
    # what the equations say is what the result holds: N = M (g + z'') at every step
    r = harmonic(0.5e-3, 5.0, 0.0, 25.0)
    crossing = cross_sprung_masses_newmark(
        BEAM, [MASS] * 3, Motion.spaced(SPEED, 3, 3.0), 1e-3, 1200, profile=r
    )
    force = 5750.0 * (9.81 + crossing.body_acceleration)
    np.testing.assert_allclose(crossing.contact_force, force, rtol=1e-12)
    # the modal velocity is the trapezoidal sum of the modal accelerations for gamma = 1/2
    a, v = crossing.beam.modal_acceleration, crossing.beam.modal_velocity
    steps = 0.5e-3 * (a[1:] + a[:-1])
    np.testing.assert_allclose(np.diff(v, axis=0), steps, atol=1e-9 * np.abs(v).max())
    z, z_rate = crossing.body_displacement, crossing.body_velocity
    np.testing.assert_allclose(np.diff(z, axis=0), 0.5e-3 * (z_rate[1:] + z_rate[:-1]), atol=1e-14)


def test_a_soft_spring_makes_a_moving_force():
    time = np.arange(901) * 1e-3
    soft = WheelUnit.sprung_mass(5750.0, 1.0)
    crossing = cross_sprung_masses(BEAM, [soft], Motion(SPEED), time, modes=10)
    force = cross_forces(BEAM, [5750.0 * 9.81], Motion(SPEED), time, modes=10)
    # the spring gives way by 1 N/m x 3 mm, 5e-8 of the weight
    np.testing.assert_allclose(crossing.beam.modal_displacement, force.modal_displacement, atol=1e-7 * 2.4e-3)


def test_before_and_after_the_beam_a_mass_rides_on_the_ground():
    body, wave = SuspendedBody(5750.0, 1.595e6, 20e3), 2 * np.pi / 5.0
    unit = WheelUnit.sprung_mass(body.mass, body.stiffness, body.damping)
    time = np.linspace(0.0, 2.0, 401)
    crossing = cross_sprung_masses(
        BEAM, [unit], Motion(20.0, start=-40.0), time, modes=2, profile=harmonic(1e-3, 5.0)
    )
    motion = body.over_harmonic(1e-3, wave * 20.0, time)  # x = -40 m is a zero of the irregularity
    np.testing.assert_allclose(crossing.body_displacement[:, 0], motion.displacement, atol=1e-12)
    np.testing.assert_allclose(crossing.body_acceleration[:, 0], motion.acceleration, atol=1e-8)
    assert not crossing.beam.modal_displacement[:-1].any()  # it enters at the last time


def test_a_height_is_enough_for_springs():
    r = Profile(lambda x: 1e-3 * np.sin(x))
    crossing = cross_sprung_masses(BEAM, [MASS], Motion(20.0), [0.0, 0.5], modes=3, profile=r)
    full = Profile(r.height, lambda x: 1e-3 * np.cos(x), lambda x: -1e-3 * np.sin(x))
    expected = cross_sprung_masses(BEAM, [MASS], Motion(20.0), [0.0, 0.5], modes=3, profile=full)
    np.testing.assert_array_equal(crossing.contact_force, expected.contact_force)
    assert np.isnan(crossing.wheel_velocity).all()
    assert np.isfinite(expected.wheel_acceleration).all()


def test_wrong_input_is_named():
    with pytest.raises(InputError, match="must have wheels without mass"):
        cross_sprung_masses(BEAM, [WheelUnit.rigid_mass(1.0)], Motion(20.0), [1.0])
    with pytest.raises(InputError, match="must be unconditionally stable"):
        Newmark(beta=0.2)
    with pytest.raises(InputError, match="must have one entry per vehicle, 2 in all"):
        cross_sprung_masses_newmark(BEAM, [MASS] * 2, Motion(20.0), 1e-3, 10)
    with pytest.raises(InputError, match=r"time_step = 0.0: must be a positive number"):
        cross_sprung_masses_newmark(BEAM, [MASS], Motion(20.0), 0.0, 10)
    with pytest.raises(InputError, match="must give the slope for dashpots"):
        damped = WheelUnit.sprung_mass(1.0, 1.0, 0.1)
        cross_sprung_masses(BEAM, [damped], Motion(20.0), [1.0], profile=Profile(np.sin))
