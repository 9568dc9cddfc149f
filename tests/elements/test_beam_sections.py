"""Section forces inside a beam element: curvature, equilibrium with the other end, closed forms, order."""

import numpy as np
import pytest

from axlespan.elements import beam, beam_sections
from axlespan.elements.beam import BeamProperties

LENGTH = 3.0
SLENDER = BeamProperties(
    axial_stiffness=4e8,
    bending_stiffness_y=2e7,
    bending_stiffness_z=5e7,
    torsional_stiffness=3e6,
    mass_per_length=900.0,
    rotary_inertia_y=40.0,
    rotary_inertia_z=70.0,
)
STOCKY = BeamProperties(**{**SLENDER.__dict__, "shear_stiffness_y": 3e7, "shear_stiffness_z": 2e7})
DIRECTIONS = {"along x": (1.0, 0.0, 0.0), "inclined": (2.0, -1.0, 0.7), "upright": (0.0, 0.0, 1.0)}


def element(direction=(1.0, 0.0, 0.0)):
    ends = np.zeros((1, 2, 3))
    ends[0, 1] = LENGTH * np.asarray(direction) / np.linalg.norm(direction)
    return ends, beam.frames(ends)


def local(values, frame):
    """D.o.f. (12,) of an element in its own axes."""
    return (frame[0] @ values.reshape(4, 3).T).T.ravel()


@pytest.mark.parametrize("direction", DIRECTIONS.values(), ids=DIRECTIONS)
@pytest.mark.parametrize("xi", [0.0, 0.3, 1.0])
def test_static_forces_are_those_of_the_interpolation(direction, xi):
    """M = EI w'', V = EI w''' of Hermite's cubic, N and T constant."""
    ends, frame = element(direction)
    u = np.random.default_rng(1).standard_normal(12)
    own = local(u, frame)
    w1, psi1, w2, psi2 = own[2], -own[4], own[8], -own[10]
    rows, _ = beam_sections.section_rows(ends, SLENDER, frame, np.array([xi]))
    second = (12 * xi - 6) * (w1 - w2) / LENGTH**2 + ((6 * xi - 4) * psi1 + (6 * xi - 2) * psi2) / LENGTH
    third = 12 * (w1 - w2) / LENGTH**3 + 6 * (psi1 + psi2) / LENGTH**2
    expected = [
        2e7 * second,
        2e7 * third,
        4e8 * (own[6] - own[0]) / LENGTH,
        3e6 * (own[9] - own[3]) / LENGTH,
    ]
    assert rows[0] @ u == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("properties", [SLENDER, STOCKY], ids=["slender", "stocky"])
@pytest.mark.parametrize("direction", DIRECTIONS.values(), ids=DIRECTIONS)
def test_at_the_far_end_they_are_the_end_forces_there(properties, direction):
    """The piece in front of the far end is the element: M = -My2, V = -Fz2, N = Fx2, T = Mx2."""
    ends, frame = element(direction)
    static, inertial = beam_sections.section_rows(ends, properties, frame, np.ones(1))
    wheel = beam_sections.wheel_polynomials(ends, properties, frame, np.ones(1), np.array([0.0, 0.0, 1.0]))
    u = np.random.default_rng(2).standard_normal(12)
    signs = np.array([-1.0, -1.0, 1.0, 1.0])
    pick = np.array([10, 8, 6, 9])
    for rows, matrix in ((static, beam.stiffness), (inertial, beam.mass)):
        ends_of = local(matrix(ends, properties, frame)[0] @ u, frame)
        assert rows[0] @ u == pytest.approx(signs * ends_of[pick], rel=1e-9)
    # a wheel at η loads the ends with N(η), and all of it is before the section
    along = beam.displacement_polynomials(ends, properties, frame, np.array([0.0, 0.0, 1.0]))
    for eta in (0.2, 0.9):
        powers = eta ** np.arange(4)
        assert wheel[0, 0] @ powers == pytest.approx(
            signs * local(along[0] @ powers, frame)[pick], rel=1e-9, abs=1e-12
        )


@pytest.mark.parametrize(("eta", "xi"), [(0.25, 0.25), (0.25, 0.7), (0.6, 0.1)])
def test_a_wheel_on_a_clamped_beam(eta, xi):
    """Fixed-end moments P a b² / L², and the moment diagram between them (Roark)."""
    ends, frame = element()
    wheel = beam_sections.wheel_polynomials(ends, SLENDER, frame, np.array([xi]), np.array([0.0, 0.0, 1.0]))
    a, b = eta * LENGTH, (1.0 - eta) * LENGTH
    x = xi * LENGTH
    left = b**2 * (3 * a + b) / LENGTH**3  # reaction of a unit force
    moment = -a * b**2 / LENGTH**2 + left * x - max(x - a, 0.0)
    for side in (0, 1) if eta == xi else (0,) if eta < xi else (1,):
        found = wheel[0, side] @ eta ** np.arange(4)
        assert found[0] == pytest.approx(moment, rel=1e-12)
        assert found[1] == pytest.approx(left - (1.0 if side == 0 else 0.0), rel=1e-12)
        assert found[2:] == pytest.approx([0.0, 0.0], abs=1e-15)


def test_order_on_a_vibrating_beam():
    """Nodes on an exact mode: moment and shear inside elements are exact to a high order of their length."""
    total, stiffness, mass = 12.0, 2e7, 900.0
    properties = BeamProperties(bending_stiffness_y=stiffness, mass_per_length=mass)
    k = 3 * np.pi / total
    omega2 = k**4 * stiffness / mass
    errors = []
    for n in (8, 16, 32):
        x = np.linspace(0.0, total, n + 1)
        ends = np.zeros((n, 2, 3))
        ends[:, 0, 0], ends[:, 1, 0] = x[:-1], x[1:]
        u = np.zeros((n, 12))
        for end, at in enumerate((x[:-1], x[1:])):
            u[:, 6 * end + 2], u[:, 6 * end + 4] = np.sin(k * at), -k * np.cos(k * at)
        xi = np.full(n, 0.35)
        static, inertial = beam_sections.section_rows(ends, properties, beam.frames(ends), xi)
        found = np.einsum("eqd,ed->eq", static - omega2 * inertial, u)
        s = x[:-1] + 0.35 * np.diff(x)
        exact = np.column_stack([-stiffness * k**2 * np.sin(k * s), -stiffness * k**3 * np.cos(k * s)])
        scale = stiffness * k ** np.array([2, 3])
        errors.append(np.abs(found[:, :2] - exact).max(axis=0) / scale)
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > [5.5, 4.5])
    assert np.all(errors[-1] < 1e-6)
