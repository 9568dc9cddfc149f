"""Moving forces against printed amplifications, Frýba's formula and numerical integration."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from axlespan.errors import InputError
from axlespan.reference import (
    Motion,
    SimplySupportedBeam,
    cross_forces,
    midspan_amplification,
    point_load_deflection,
)
from axlespan.reference.duhamel import exponential_convolution

BEAM = SimplySupportedBeam(length=25.0, bending_stiffness=2.87e9 * 2.90, mass_per_length=2303.0)
FORCE = 5750 * 9.81

# largest mid-span deflection over P L^3 / 48 EI during the crossing: (alpha, one mode, 51 modes)
AMPLIFICATION = [
    (0.1, 1.08389, 1.09645),
    (0.2, 1.06687, 1.06527),
    (0.25, 1.24973, 1.25761),
    (0.3, 1.39764, 1.41049),
    (0.4, 1.60137, 1.61289),
    (0.5, 1.70700, 1.70545),
    (0.6, 1.74219, 1.73113),
    (0.617, 1.74288, 1.73167),
    (0.7, 1.72939, 1.72040),
    (0.8, 1.68536, 1.67617),
    (0.9, 1.62214, 1.61268),
    (1.0, 1.54807, 1.54807),
]


def fryba(force, speed, time, modes):
    """Frýba's series while the force is on the beam, away from resonance, and its two derivatives."""
    n = np.arange(1, modes + 1)
    omega, drive = BEAM.angular_frequencies(modes), n * np.pi * speed / BEAM.length
    t = time[:, None]
    factor = -2 * force / (BEAM.mass_per_length * BEAM.length) / (omega**2 - drive**2)
    return (
        factor * (np.sin(drive * t) - drive / omega * np.sin(omega * t)),
        factor * drive * (np.cos(drive * t) - np.cos(omega * t)),
        factor * drive * (omega * np.sin(omega * t) - drive * np.sin(drive * t)),
    )


@pytest.mark.parametrize(("alpha", "one", "many"), AMPLIFICATION)
def test_amplification_by_speed(alpha, one, many):
    # the table has five decimals; the times sampled miss the peak by less than 1e-6
    assert midspan_amplification(alpha, modes=1, after_exit=False) == pytest.approx(one, abs=6e-6)
    assert midspan_amplification(alpha, after_exit=False) == pytest.approx(many, abs=6e-6)


def test_after_the_exit_the_free_vibration_can_be_larger():
    # alpha = 0.8 with 51 modes: 1.67617 during the crossing, 1.67866 after it
    assert midspan_amplification(0.8) == pytest.approx(1.67866, abs=6e-6)


@pytest.mark.parametrize(
    ("modes", "peak", "at", "end"), [(1, -2.37647, 0.3750, None), (51, -2.39683, 0.3764, 0.24471)]
)
def test_the_weight_of_the_first_example(modes, peak, at, end):
    time = np.linspace(0.0, 0.9, 9001)
    w = 1e3 * cross_forces(BEAM, [FORCE], Motion(100 / 3.6), time, modes=modes).displacement_at(12.5)
    assert w.min() == pytest.approx(peak, abs=6e-6)
    assert time[w.argmin()] == pytest.approx(at, abs=1.1e-4)
    if end is not None:
        assert w[-1] == pytest.approx(end, abs=6e-6)
    static = FORCE * 25.0**3 / (48 * BEAM.bending_stiffness)
    assert 1e3 * static == pytest.approx(2.20615, abs=6e-6)


def test_undamped_crossing_is_frybas_series():
    time = np.linspace(0.0, 0.9, 181)
    response = cross_forces(BEAM, [FORCE], Motion(100 / 3.6), time, modes=12)
    q, v, a = fryba(FORCE, 100 / 3.6, time, 12)
    np.testing.assert_allclose(response.modal_displacement, q, atol=1e-14)
    np.testing.assert_allclose(response.modal_velocity, v, atol=1e-12)
    np.testing.assert_allclose(response.modal_acceleration, a, atol=1e-10)


@pytest.mark.parametrize("ratio", [0.0, 0.02, 0.3])
def test_a_row_of_axles_with_damping_equals_numerical_integration(ratio):
    forces, motion = [1.0e5, 2.0e5, -0.5e5], Motion(60.0, offsets=(0.0, 3.0, 20.0))
    time = np.linspace(0.0, 1.2, 241)
    response = cross_forces(BEAM, forces, motion, time, modes=3, modal_damping=ratio)
    omega, waves = BEAM.angular_frequencies(3), BEAM.wave_numbers(3)

    def rates(t, state):
        load = np.zeros(3)
        for force, xi in zip(forces, 60.0 * t - np.array(motion.offsets), strict=True):
            if 0.0 <= xi <= 25.0:
                load -= force * np.sin(waves * xi) / BEAM.modal_mass
        return np.append(state[3:], load - 2 * ratio * omega * state[3:] - omega**2 * state[:3])

    solved = solve_ivp(
        rates, (0.0, 1.2), np.zeros(6), "DOP853", t_eval=time, rtol=1e-10, atol=1e-12, max_step=2e-3
    )
    # the kinks of the load at entries and exits leave about 1e-8 of the peak
    scale = np.abs(solved.y).max(axis=1)
    np.testing.assert_allclose(response.modal_displacement, solved.y[:3].T, atol=1e-7 * scale[0])
    np.testing.assert_allclose(response.modal_velocity, solved.y[3:].T, atol=1e-7 * scale[3])


def test_resonance_of_a_mode_is_no_singularity():
    # at alpha = 1 the first mode grows like (sin - w t cos) / 2; at alpha = 2 the second does
    speed = 2.0 * BEAM.critical_speed
    time = np.linspace(0.0, 25.0 / speed, 50)
    q = cross_forces(BEAM, [FORCE], Motion(speed), time, modes=3).modal_displacement
    wt = BEAM.angular_frequencies(2)[1] * time
    static = FORCE / (BEAM.modal_mass * BEAM.angular_frequencies(2)[1] ** 2)
    np.testing.assert_allclose(q[:, 1], -0.5 * static * (np.sin(wt) - wt * np.cos(wt)), atol=1e-12 * static)
    beside = cross_forces(BEAM, [FORCE], Motion(speed * (1 + 1e-7)), time, modes=3).modal_displacement
    np.testing.assert_allclose(beside, q, atol=1e-5 * static)


def test_convolution_of_exponentials_holds_on_both_sides_of_its_switch():
    pole, time = -3.0 + 40.0j, 0.05
    nodes, weights = np.polynomial.legendre.leggauss(40)
    nodes, weights = 0.5 * time * (nodes + 1.0), 0.5 * time * weights
    for gap in (0.0, 1e-9, 0.3j, 19.999j, 20.001j, 15.0 - 14.0j, 200.0j):  # |gap t| = 1 is the switch
        exponents = gap * nodes + pole * time  # pole (t - s) + (pole + gap) s
        integral = weights @ np.exp(exponents)
        assert exponential_convolution(pole, pole + gap, time) == pytest.approx(integral, abs=1e-14)


def test_a_slow_force_moves_the_static_deflection_along():
    speed = 0.01
    position = np.array([4.0, 12.5, 20.0])
    response = cross_forces(BEAM, [FORCE], Motion(speed), position / speed, modes=400)
    x = np.array([6.0, 12.5, 17.0])
    static = point_load_deflection(
        x, force=FORCE, at=position[:, None], length=25.0, bending_stiffness=BEAM.bending_stiffness
    )
    # dynamics add alpha = 4e-5 of static, the series' rest 1e-7
    np.testing.assert_allclose(response.displacement_at(x), static, rtol=2e-4)


@pytest.mark.parametrize("i", [1, 2, 3])
def test_cancellation_speeds_leave_the_beam_at_rest(i):
    # alpha = 1 / (2 i + 1): the first mode has no free vibration after the exit
    motion = Motion(BEAM.critical_speed / (2 * i + 1))
    exit_time = 25.0 / motion.speed
    response = cross_forces(BEAM, [FORCE], motion, exit_time * np.array([0.5, 1.001, 1.5, 2.0]), modes=1)
    w = np.abs(response.displacement_at(12.5))
    assert w[1:].max() < 1e-12 * w[0]


def test_resonance_speed_of_a_regular_train_beats_its_neighbors():
    spacing, count = 18.0, 10
    frequency = BEAM.angular_frequencies(1)[0] / (2 * np.pi)
    time = np.linspace(0.0, 4.0, 4001)
    peaks = []
    for factor in (0.85, 1.0, 1.15):
        motion = Motion.spaced(frequency * spacing * factor, count, spacing)
        response = cross_forces(BEAM, [1e5] * count, motion, time, modes=1, modal_damping=0.005)
        peaks.append(np.abs(response.displacement_at(12.5)).max())
    assert peaks[1] > 1.5 * max(peaks[0], peaks[2])


def test_wrong_input_is_named():
    with pytest.raises(InputError, match="must have one entry per vehicle, 2 in all"):
        cross_forces(BEAM, [1.0, 1.0], Motion(10.0), [1.0])
    with pytest.raises(InputError, match="must be zero for the closed form"):
        cross_forces(BEAM, [1.0], Motion(10.0, acceleration=1.0), [1.0])
    with pytest.raises(InputError, match="must be at or before the beam at t = 0"):
        cross_forces(BEAM, [1.0], Motion(10.0, start=5.0), [1.0])
    with pytest.raises(InputError, match="must increase and start at zero or later"):
        cross_forces(BEAM, [1.0], Motion(10.0), [1.0, 0.5])
    with pytest.raises(InputError, match="must be at least zero and below one"):
        cross_forces(BEAM, [1.0], Motion(10.0), [1.0], modal_damping=1.0)
    with pytest.raises(InputError, match="must be one number or one per mode, 3 in all"):
        cross_forces(BEAM, [1.0], Motion(10.0), [1.0], modes=3, modal_damping=[0.1, 0.2])
