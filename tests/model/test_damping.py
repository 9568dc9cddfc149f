"""Damping ratios measured on the eigenvalues of λ² M + λ C + K."""

import numpy as np
import pytest
from scipy.linalg import eig

from axlespan.bridges.spans import SupportAt, simple_span
from axlespan.errors import InputError
from axlespan.model.compile import compile_model
from axlespan.model.damping import Modal, Rayleigh
from axlespan.model.model import Model

BEAM = {"length": 25.0, "youngs_modulus": 2.87e9, "second_moment": 2.9, "mass_per_length": 2303.0}


def measured(system):
    """Angular frequencies |λ| and ratios -Re λ / |λ| of the oscillating modes, lowest first."""
    blocks = system.partition
    k, m, c = (matrix.toarray() for matrix in (blocks.K_FF, blocks.M_FF, blocks.C_FF))
    if system.modal_damping is not None:
        u, d = system.modal_damping.vectors, system.modal_damping.coefficients
        c = c + (u * d) @ u.T
    n = len(k)
    scale = np.sqrt(np.abs(k).max() / np.abs(m).max())  # balances the pencil
    a = np.block([[np.zeros((n, n)), np.eye(n)], [-k / scale**2, -c / scale]])
    b = np.block([[np.eye(n), np.zeros((n, n))], [np.zeros((n, n)), m]])
    above, below = eig(a, b, right=False, homogeneous_eigvals=True)
    finite = np.abs(below) > 1e-9 * np.abs(above)  # the others belong to massless d.o.f.
    values = scale * above[finite] / below[finite]
    values = values[values.imag > 0.0]
    values = values[np.argsort(np.abs(values))]
    return np.abs(values), -values.real / np.abs(values)


def test_rayleigh_gives_its_ratio_at_both_frequencies():
    undamped, _ = measured(simple_span(elements=6, **BEAM).system)
    f = undamped[[0, 2]] / (2.0 * np.pi)
    omega, ratio = measured(
        simple_span(elements=6, damping=Rayleigh.from_ratio(0.03, (f[0], f[1])), **BEAM).system
    )
    np.testing.assert_allclose(omega[:3], undamped[:3], rtol=1e-9)
    np.testing.assert_allclose(ratio[[0, 2]], 0.03, rtol=1e-7)
    assert ratio[1] < 0.03 < ratio[3]


def test_rayleigh_coefficients():
    """ζ = α / 2ω + β ω / 2."""
    omega, ratio = measured(simple_span(elements=4, damping=Rayleigh(alpha=0.8, beta=2e-5), **BEAM).system)
    np.testing.assert_allclose(ratio, 0.4 / omega + 1e-5 * omega, rtol=1e-6)


def test_rayleigh_adds_to_dashpots():
    model = Model().with_nodes([[0, 0], [0, 1]], ["ground", "mass"]).with_support("ground", ["z"])
    model = model.with_springs([[0, 1]], {"z": 4e4}, {"z": 50.0}).with_mass("mass", 100.0, directions=("z",))
    system = compile_model(model.with_damping(Rayleigh(0.5, 1e-3))).system
    np.testing.assert_allclose(system.partition.C_FF.toarray(), [[50.0 + 50.0 + 40.0]])


@pytest.mark.parametrize("modes", [None, 3])
def test_modal_gives_its_ratio_to_its_modes(modes):
    undamped, _ = measured(simple_span(elements=6, **BEAM).system)
    system = simple_span(elements=6, damping=Modal(0.02, modes), **BEAM).system
    omega, ratio = measured(system)
    assert len(ratio) == 12
    count = modes or 12
    np.testing.assert_allclose(omega, undamped, rtol=1e-9)
    np.testing.assert_allclose(ratio[:count], 0.02, rtol=1e-6)
    np.testing.assert_allclose(ratio[count:], 0.0, atol=1e-9)


def test_modal_with_massless_dofs():
    """An elastic bearing in x under a beam that has no mass in x: one d.o.f. without a mode."""
    supports = [SupportAt(0.0, (), stiffness={"x": 1e6, "z": 1e9}), SupportAt(25.0)]
    system = simple_span(elements=4, supports=supports, damping=Modal(0.02), **BEAM).system
    _, ratio = measured(system)
    assert len(ratio) == 9
    np.testing.assert_allclose(ratio, 0.02, rtol=1e-6)


def test_no_modal_damping_for_a_ratio_of_zero():
    assert simple_span(elements=4, damping=Modal(0.0), **BEAM).system.modal_damping is None


@pytest.mark.parametrize(
    ("build", "field", "rule"),
    [
        (lambda: Rayleigh(alpha=-1.0), "damping.alpha", "must be zero or positive"),
        (lambda: Rayleigh(beta=float("nan")), "damping.beta", "must be zero or positive"),
        (lambda: Rayleigh.from_ratio(-0.01, (1.0, 2.0)), "damping.ratio", "must be zero or positive"),
        (lambda: Rayleigh.from_ratio(0.01, (2.0, 2.0)), "damping.frequencies", "must be two different"),
        (lambda: Rayleigh.from_ratio(0.01, (0.0, 2.0)), "damping.frequencies", "must be positive"),
        (lambda: Rayleigh.from_ratio(0.01, (2.0,)), "damping.frequencies", "must be two"),
        (lambda: Modal(1.0), "damping.ratio", "must be below 1"),
        (lambda: Modal(-0.1), "damping.ratio", "must be zero or positive"),
        (lambda: Modal(0.1, modes=0), "damping.modes", "must be"),
        (lambda: Modal(0.1, modes=-2), "damping.modes", "must be"),
    ],
)
def test_errors(build, field, rule):
    with pytest.raises(InputError, match=rule) as caught:
        build()
    assert caught.value.field == field
