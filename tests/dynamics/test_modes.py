"""Modal masses, participation factors and effective masses against closed forms."""

import numpy as np
import pytest

import axlespan as asp
from axlespan.dynamics.modes import participation
from axlespan.linalg.eigen import Modes, lowest_modes
from axlespan.model.compile import compile_model
from axlespan.model.modal import full_shapes, modes_of
from axlespan.model.model import Model


def shear_building(n):
    """Equal masses 2 kg on equal springs 5 N/m, the lowest on the ground."""
    k = 5.0 * (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
    k[-1, -1] = 5.0
    return k, 2.0 * np.eye(n)


def test_a_shear_building():
    """ω_j = 2 √(k/m) sin((2j-1)π / (4n+2)), φ_ij = sin(i (2j-1)π / (2n+1))."""
    n = 6
    K, M = shear_building(n)
    modes = lowest_modes(K, M)
    found = participation(modes, M @ np.ones((n, 1)), np.array([12.0]), np.abs(modes.shapes).max(axis=0))
    i, j = np.arange(1, n + 1)[:, None], np.arange(1, n + 1)
    shapes = np.sin(i * (2 * j - 1) * np.pi / (2 * n + 1))
    shapes /= np.abs(shapes).max(axis=0)
    mass = 2.0 * (shapes**2).sum(axis=0)
    amount = 2.0 * shapes.sum(axis=0)
    assert modes.angular_frequencies == pytest.approx(
        2 * np.sqrt(2.5) * np.sin((2 * np.arange(1, n + 1) - 1) * np.pi / (4 * n + 2))
    )
    assert found.modal_mass == pytest.approx(mass)
    assert np.abs(found.factor[:, 0]) == pytest.approx(np.abs(amount / mass))
    assert found.effective_mass[:, 0] == pytest.approx(amount**2 / mass)
    assert found.cumulative[-1, 0] == pytest.approx(1.0)


def test_a_simple_span():
    """Odd modes take 8 / (n π)² of the mass, modal masses are half of it; even ones nothing."""
    bridge = asp.bridges.simple_span(
        length=25.0, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=24
    )
    found = modes_of(bridge.system)
    assert len(found.modes) == 10 and found.directions == ("z",)
    n = np.arange(1, 7)
    expected = np.where(n % 2, 8.0 / (n * np.pi) ** 2, 0.0)
    assert found.participation.share[:6, 0] == pytest.approx(expected, abs=2e-4)
    assert found.participation.modal_mass[:4] == pytest.approx(0.5 * 2303.0 * 25.0, rel=1e-3)
    assert np.abs(found.participation.factor[:3, 0]) == pytest.approx(
        [4 / np.pi, 0.0, 4 / 3 / np.pi], abs=1e-3
    )
    omega = (n * np.pi / 25.0) ** 2 * np.sqrt(2.87e9 * 2.9 / 2303.0)
    assert found.modes.angular_frequencies[:6] == pytest.approx(omega, rel=1e-3)


@pytest.mark.parametrize("damping", ["rayleigh", "modal", "none"])
def test_damping_ratios(damping):
    given = {"rayleigh": asp.Rayleigh(0.4, 2e-4), "modal": asp.Modal(0.013), "none": None}[damping]
    bridge = asp.bridges.simple_span(
        length=25.0,
        youngs_modulus=2.87e9,
        second_moment=2.90,
        mass_per_length=2303.0,
        elements=8,
        damping=given,
    )
    found = modes_of(bridge.system, 5)
    omega = found.modes.angular_frequencies
    expected = {"rayleigh": 0.2 / omega + 1e-4 * omega, "modal": np.full(5, 0.013), "none": np.zeros(5)}
    assert found.damping_ratio == pytest.approx(expected[damping], rel=1e-9, abs=1e-12)


def test_directions_and_ties():
    """A rigid body of 3 t on springs along x and z, the masses at the ends of rigid links."""
    model = Model(plane=True).with_nodes([[0, 0], [1, 0], [-2, 0], [0, 0]])
    model = model.with_springs([[3, 0]], {"x": 2e6, "z": 5e6, "ry": 4e6})
    model = model.with_mass(1, 2000.0).with_mass(2, 1000.0).with_rigid_link(0, [1, 2])
    model = model.with_support(3, ("x", "z", "ry"))
    system = compile_model(model).system
    found = modes_of(system)
    assert found.directions == ("x", "z")
    assert found.participation.total_mass == pytest.approx([3000.0, 3000.0])
    assert found.participation.cumulative[-1] == pytest.approx([1.0, 1.0])
    # the center of mass is over the spring, so translations and rotation do not mix
    squares = np.sort([2e6 / 3000.0, 5e6 / 3000.0, 4e6 / (2000.0 + 4 * 1000.0)])
    assert found.modes.angular_frequencies**2 == pytest.approx(squares)
    turning = full_shapes(system, found.modes)[:, np.argmin(np.abs(squares - 4e6 / 6000.0))]
    ends = [turning[system.dof(name)] for name in ("n2.z", "n3.z")]
    if abs(squares[0] - squares[1]) > 1.0:
        assert ends[1] == pytest.approx(-2.0 * ends[0])


def test_scale_does_not_matter_for_effective_masses():
    modes = Modes(np.ones(2), np.array([[0.5, 0.1], [0.2, -0.4]]))
    r = np.array([[3.0], [2.0]])
    one, two = (participation(modes, r, np.array([5.0]), np.full(2, size)) for size in (1.0, 0.5))
    assert np.array_equal(one.effective_mass, two.effective_mass)
    assert two.modal_mass == pytest.approx(4.0 * one.modal_mass)
    assert two.factor == pytest.approx(0.5 * one.factor)


def test_too_many():
    K, M = shear_building(3)
    with pytest.raises(asp.InputError, match="count = 4: must be at most 3"):
        lowest_modes(K, M, 4)
