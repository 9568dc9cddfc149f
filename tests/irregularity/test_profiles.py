"""Every profile: slopes and curvatures by finite differences, shapes, closed-form values."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from axlespan import irregularity as ir
from axlespan.errors import InputError

# Profiles by name, with the positions of their kinks and steps (left out of the finite differences).
WAVY = ir.CosineSum([1e-3, 4e-4, 2e-4], [0.05, 0.21, 0.9], [0.3, 2.0, 4.0])
RANDOM = ir.realize("iso8608-a", 60.0, seed=7, wavelengths=(1.0, 40.0))
TURNS = [turn * 2.0 * np.pi * 0.46 for turn in range(-3, 6)]
FLAT_ENDS = [turn + side * 0.45 for turn in TURNS for side in (-1, 1)]
PROFILES = {
    "smooth": (ir.Smooth(), []),
    "harmonic": (ir.Harmonic(1e-3, 5.0), []),
    "harmonic, bounded": (ir.Harmonic(1e-3, 5.0, 0.7, -3.0, 11.0), [-3.0, 11.0]),
    "cosines": (WAVY, []),
    "table": (ir.Table([-2.0, 1.0, 4.0, 9.0], [0.0, 2e-3, -1e-3, 5e-4]), [-2.0, 1.0, 4.0, 9.0]),
    "spline": (ir.Spline([-2.0, 1.0, 4.0, 9.0], [0.0, 2e-3, -1e-3, 5e-4]), [-2.0, 1.0, 4.0, 9.0]),
    "sum": (ir.Sum((WAVY, ir.Harmonic(1e-3, 3.0))), []),
    "shifted": (ir.Shifted(WAVY, 2.5), []),
    "scaled": (ir.Scaled(WAVY, -3.0), []),
    "bounded": (ir.Bounded(WAVY, -4.0, 9.0, taper=3.0), [-4.0, -1.0, 6.0, 9.0]),
    "bounded, cut": (ir.Bounded(WAVY, stop=6.0), [6.0]),
    "haversine bump": (ir.Bump(2.0, 5e-3, 4.0), [0.0, 4.0]),
    "half-sine bump": (ir.Bump(2.0, 5e-3, 4.0, "half-sine"), [0.0, 4.0]),
    "dipped joint": (ir.DippedJoint(2.0, 5e-3, 3.0), [0.5, 2.0, 3.5]),
    "linear ramp": (ir.Ramp(-1.0, 5.0, 1e-2), [-1.0, 5.0]),
    "cosine ramp": (ir.Ramp(-1.0, 5.0, -1e-2, "cosine"), [-1.0, 5.0]),
    "squat": (ir.Squat(2.0, 2e-3, 5.0, crest=0.4), [-0.5, 4.5]),
    "flat squat": (ir.Squat(2.0, 2e-3, 5.0, crest=0.0), [-0.5, 4.5]),
    "pothole": (ir.Pothole(2.0, 3e-2, 6.0, 1.5), [-1.0, 0.5, 3.5, 5.0]),
    "settlement": (ir.SettlementDip(2.0, 1e-2, 2.0), []),
    "fresh flat": (ir.WheelFlat(0.9, 0.46), [*TURNS, *FLAT_ENDS]),
    "rounded flat": (ir.WheelFlat(0.9, 0.46, 2e-3, "rounded", 0.3), [e + 0.3 for e in FLAT_ENDS]),
    "out of round": (ir.OutOfRound(0.46, [1, 3], [3e-4, 1e-4], [0.1, 0.2]), []),
    "realization": (RANDOM, []),
    "realization, fft": (ir.realize("fra-5", 60.0, seed=7, wavelengths=(2.0, 40.0), method="fft"), []),
    "tyre on a table": (
        ir.FiniteContact(ir.Table([0.0, 3.0, 6.0], [0.0, 1e-2, 0.0]), 0.5),
        [e + s * 0.25 for e in (0.0, 3.0, 6.0) for s in (-1, 1)],
    ),
    "tyre on a dip": (ir.FiniteContact(ir.SettlementDip(2.0, 1e-2, 1.0), 0.5), []),
}
X = np.random.default_rng(11).uniform(-6.0, 12.0, 400)


def clear_of(kinks, step, x=X):
    """Positions that are more than a few steps away from any kink."""
    return x[np.all([np.abs(x - k) > 3.0 * step for k in kinks], axis=0)] if kinks else x


@pytest.mark.parametrize("name", PROFILES)
def test_slope_and_curvature_are_the_derivatives(name):
    profile, kinks = PROFILES[name]
    step = 1e-4
    x = clear_of(kinks, step)
    assert x.size > 300
    up, down = x + step, x - step
    slope = (profile.value(up) - profile.value(down)) / (2.0 * step)
    curvature = (profile.slope(up) - profile.slope(down)) / (2.0 * step)
    # Central differences err by step² r'''/6 (1e-8 relative here) and by rounding, 1e-16 r / step.
    size = np.abs(profile.slope(x)).max() + 1e-9
    np.testing.assert_allclose(profile.slope(x), slope, rtol=0.0, atol=1e-6 * size)
    size = np.abs(profile.curvature(x)).max() + 1e-9
    np.testing.assert_allclose(profile.curvature(x), curvature, rtol=0.0, atol=1e-5 * size)


@pytest.mark.parametrize("name", [n for n, (p, _) in PROFILES.items() if isinstance(p, ir.Integrable)])
def test_integral_is_a_continuous_antiderivative(name):
    profile, _ = PROFILES[name]
    x = np.linspace(-6.0, 12.0, 180_001)
    r = profile.value(x)
    areas = np.concatenate(([0.0], np.cumsum(0.5 * (r[1:] + r[:-1]) * np.diff(x))))
    exact = profile.integral(x) - profile.integral(x[:1])
    # The trapezoidal rule meets a step within r times one spacing.
    np.testing.assert_allclose(exact, areas, rtol=0.0, atol=2e-4 * np.abs(r).max() + 1e-12)


@pytest.mark.parametrize("name", PROFILES)
def test_any_shape_of_positions_gives_that_shape(name):
    profile, _ = PROFILES[name]
    grid = np.linspace(-1.0, 5.0, 6).reshape(2, 3)
    for f in (profile.value, profile.slope, profile.curvature):
        assert np.shape(f(grid)) == (2, 3)
        assert np.shape(f([])) == (0,)
        assert np.shape(f(grid[0, 0])) == ()
        np.testing.assert_allclose(f(grid)[1, 1], f(float(grid[1, 1])), rtol=1e-12, atol=1e-18)


@pytest.mark.parametrize("name", PROFILES)
def test_profiles_pickle_for_worker_processes(name):
    profile, _ = PROFILES[name]
    assert isinstance(profile, ir.Profile)
    copy = pickle.loads(pickle.dumps(profile))
    np.testing.assert_array_equal(copy.value(X), profile.value(X))


def test_harmonic_is_equation_40_of_n12():
    profile = ir.Harmonic(amplitude=0.5e-3, wavelength=5.0)
    x = np.array([0.0, 1.25, 2.5, 3.75, 26.25, -1.25])
    np.testing.assert_allclose(profile.value(x), 0.5e-3 * np.array([0, 1, 0, -1, 1, -1]), atol=1e-18)
    bounded = ir.Harmonic(0.5e-3, 5.0, phase=np.pi / 2, start=0.0, stop=25.0)
    np.testing.assert_allclose(bounded.value([0.0, 25.0, -1e-9, 25.0 + 1e-9]), [0.5e-3, 0.5e-3, 0.0, 0.0])


@settings(max_examples=50, deadline=None)
@given(
    amplitude=st.floats(-0.1, 0.1),
    wavelength=st.floats(0.05, 200.0),
    phase=st.floats(-10.0, 10.0),
    x=st.floats(-500.0, 500.0),
)
def test_harmonic_obeys_its_differential_equation(amplitude, wavelength, phase, x):
    profile = ir.Harmonic(amplitude, wavelength, phase)
    k = 2.0 * np.pi / wavelength
    energy = (k * profile.value(x)) ** 2 + profile.slope(x) ** 2
    assert energy == pytest.approx((k * amplitude) ** 2, rel=1e-9, abs=1e-30)
    assert profile.curvature(x) == pytest.approx(-k * k * profile.value(x), rel=1e-12, abs=1e-30)


def test_bounded_profile_fades_over_the_taper():
    profile = ir.Bounded(ir.Shifted(ir.Harmonic(1.0, 1e9, np.pi / 2), 0.0), 10.0, 50.0, taper=20.0)
    expected = [0.0, 0.0, 0.5 * (1 - np.cos(np.pi / 4)), 0.5, 1.0, 0.5, 0.0, 0.0]
    np.testing.assert_allclose(
        profile.value([0.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0]), expected, atol=1e-14
    )


def test_joint_flat_and_bumps_have_the_published_size():
    joint = ir.DippedJoint(10.0, depth=5e-3, length=1.0)
    assert joint.value(10.0) == -5e-3
    assert joint.slope(10.0 + 1e-12) - joint.slope(10.0 - 1e-12) == pytest.approx(joint.dip_angle, rel=1e-9)
    assert joint.dip_angle == pytest.approx(0.04)
    # A 50 mm flat on a wheel of 0.46 m radius: R - sqrt(R² - l²/4) = 0.680 mm deep
    flat = ir.WheelFlat(0.05, 0.46)
    assert flat.value(0.0) == pytest.approx(-(0.46 - np.sqrt(0.46**2 - 0.025**2)), rel=1e-3)
    # Pivoting about the edge -l/2: the center drops by R - sqrt(R² - s²) at the distance s behind it.
    s = np.linspace(0.0, 0.025, 9)
    np.testing.assert_allclose(flat.value(s - 0.025), -(0.46 - np.sqrt(0.46**2 - s**2)), atol=1e-6)
    np.testing.assert_allclose(flat.value(s + 7 * flat.circumference), flat.value(s), atol=1e-15)
    assert ir.Bump(3.0, 0.04, 0.6).value([3.0, 2.85]) == pytest.approx([0.04, 0.02])
    assert ir.Bump(3.0, 0.04, 0.6, "half-sine").value(2.85) == pytest.approx(0.04 * np.sin(np.pi / 4))
    assert ir.Ramp(0.0, 2.0, 0.01).value([-1.0, 0.5, 2.0, 99.0]) == pytest.approx([0.0, 0.0025, 0.01, 0.01])


@pytest.mark.parametrize("crest", [0.0, 0.15, 0.5, 1.0])
def test_squat_has_its_depth_and_crest(crest):
    squat = ir.Squat(0.0, 1e-3, 0.04, crest)
    x = np.linspace(-0.02, 0.02, 200_001)
    r = squat.value(x)
    assert r.min() == pytest.approx(-1e-3, rel=1e-8)
    assert squat.value(0.0) == pytest.approx(-1e-3 * (1.0 - crest), rel=1e-8, abs=1e-15)
    assert r.max() <= 1e-15


def test_pothole_and_settlement_have_their_depths():
    hole = ir.Pothole(5.0, 0.05, 1.0, 0.2)
    np.testing.assert_allclose(
        hole.value([4.4, 4.6, 4.75, 5.0, 5.4, 5.5]), [0, -0.025, -0.05, -0.05, -0.025, 0], atol=1e-15
    )
    dip = ir.SettlementDip(50.0, 0.01, 8.0)
    assert dip.value(50.0) == -0.01
    assert abs(dip.curvature(58.0)) < 1e-18  # the inflection


BAD = [
    (lambda: ir.Harmonic(1e-3, 0.0), "wavelength = 0.0: must be positive"),
    (lambda: ir.Harmonic(1e-3, 5.0, start=3.0, stop=3.0), "stop = 3.0: must be larger than start = 3 m"),
    (lambda: ir.Harmonic(float("nan"), 5.0), "amplitude = nan: must be a finite number"),
    (lambda: ir.Bounded(WAVY, 0.0, 10.0, 6.0), "at most half the distance from start to stop, 5 m"),
    (lambda: ir.Bounded(WAVY, 0.0, 10.0, -1.0), "taper = -1.0: must not be negative"),
    (lambda: ir.Bump(0.0, 1.0, 1.0, "haversin"), "Did you mean 'haversine'?"),
    (lambda: ir.Pothole(0.0, 0.1, 1.0, 0.6), "edge = 0.6: must be at most half the length, 0.5 m"),
    (lambda: ir.Squat(0.0, 0.1, 1.0, 1.5), "crest = 1.5: must lie between 0 and 1"),
    (lambda: ir.WheelFlat(2.0, 0.46), "length = 2.0: must be less than half the circumference"),
    (lambda: ir.OutOfRound(0.46, [1.5], [1e-4]), "orders = 1.5: must be whole numbers of waves per turn"),
    (lambda: ir.OutOfRound(0.46, [1, 2], [1e-4]), "must be equally many"),
    (lambda: ir.CosineSum([1.0], [1.0, 2.0], [0.0]), "must be equally many"),
    (lambda: ir.FiniteContact(WAVY, 0.0), "length = 0.0: must be positive"),
]


@pytest.mark.parametrize(("make", "message"), BAD, ids=[m for _, m in BAD])
def test_bad_profiles_are_refused_with_the_rule(make, message):
    with pytest.raises(InputError) as caught:
        make()
    assert message in str(caught.value)
