"""Consecutive steps in one compiled loop are the steps made one by one."""

import numpy as np
import pytest

from axlespan.bridges import ballasted_track, simple_span, with_track
from axlespan.dynamics.alpha import Alpha
from axlespan.interaction import simulate as module
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.fused.march import FusedMarch
from axlespan.interaction.simulate import simulate_many
from axlespan.irregularity import Harmonic
from axlespan.vehicles.simple import axle_loads, sprung_mass
from axlespan.vehicles.train import Train

pytest.importorskip("numba")

SPAN = simple_span(length=25.0, youngs_modulus=2.87e9, second_moment=2.9, mass_per_length=2303.0, elements=20)
TRACK = with_track(SPAN, ballasted_track(), approach=25.0, exit=25.0)
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


# Stiff rails over soft ballast make the effective matrix of the track so unequal that LAPACK's factor in place of the
# compiled one moves the same run by 1e-9 of the displacements, and by more of the velocities.
@pytest.mark.parametrize(("structure", "tolerance"), [(SPAN, 1e-9), (TRACK, 1e-6)], ids=["span", "track"])
@pytest.mark.parametrize("alpha", [0.0, -0.1])
@pytest.mark.parametrize("count", [1, 2, 10])
def test_same_numbers(structure, tolerance, alpha, count, monkeypatch):
    """One crossing, two one after the other, eight side by side and two more; all leave at different times."""
    cases = crossings(structure, count)
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


def test_an_indefinite_contact_system_is_refused():
    """The small Cholesky factorization says so, and solves what is definite."""
    from axlespan.interaction.fused.kernel import solve_small

    rng = np.random.default_rng(3)
    half = rng.standard_normal((7, 7))
    matrix, right = half @ half.T + np.eye(7), rng.standard_normal(7)
    x = right.copy()
    assert solve_small(matrix.copy(), 7, x)
    np.testing.assert_allclose(matrix @ x, right, atol=1e-12)
    matrix[4, 4] = -1.0
    assert not solve_small(matrix.copy(), 7, right.copy())
    matrix[4, 4] = np.nan
    assert not solve_small(matrix.copy(), 7, right.copy())
