"""Laws of contact by themselves, and the solver of their interface."""

import numpy as np
import pytest
from scipy.optimize import brentq, nnls

from axlespan.contact.laws import LAWS, Hertz, LinearSpring, Rigid, Unilateral, hertz_stiffness, law_of
from axlespan.contact.laws_of_wheels import WheelLaws
from axlespan.errors import InputError
from axlespan.interaction.nonlinear.interface_solver import (
    Interface,
    NotConverged,
    complementary,
    solve_interface,
)


@pytest.mark.parametrize(
    ("radius", "tread", "g", "k"),
    [
        (0.43, "worn", 4.2534e-8, 1.1400e11),
        (0.46, "worn", 4.2206e-8, 1.1533e11),
        (0.50, "worn", 4.1803e-8, 1.1700e11),
        (0.43, "cone", 5.1824e-8, 0.8476e11),
        (0.46, "cone", 5.1306e-8, 0.8605e11),
        (0.50, "cone", 5.0672e-8, 0.8767e11),
    ],
)
def test_hertz_stiffness_of_wheels(radius, tread, g, k):
    """G = 3.86 R^-0.115 (worn) and 4.57 R^-0.149 (cone) 1e-8 m/N^(2/3), tabulated to five digits."""
    own = hertz_stiffness(radius, tread)
    assert own == pytest.approx(g**-1.5, rel=2e-5)
    assert own == pytest.approx(k, rel=1e-4)


def test_a_linear_spring_without_stiffness_is_hertz_linearized():
    """K = 1.5 P^(1/3) / G: 1.4647 GN/m for a worn wheel of 0.46 m at 70 kN."""
    law = LinearSpring().fitted(0.46, 70e3)
    assert law.k == pytest.approx(1.4647e9, rel=1e-4)
    assert LinearSpring(2e6).fitted(0.46, 70e3).k == 2e6


@pytest.mark.parametrize("law", [Hertz(), LinearSpring(1e9, 2e4), LinearSpring(1e9, 2e4, True)])
def test_tangents_and_energies(law):
    rng = np.random.default_rng(3)
    d, rate, h = rng.uniform(-1e-4, 3e-4, 40), rng.uniform(-0.2, 0.2, 40), 1e-10
    k, c = law.tangent(d, rate)
    np.testing.assert_allclose(
        (law.force(d + h, rate) - law.force(d - h, rate)) / (2 * h), k, rtol=1e-5, atol=1e4
    )
    rough = (law.force(d, rate + 1e-6) - law.force(d, rate - 1e-6)) / 2e-6
    np.testing.assert_allclose(rough, c, rtol=1e-6, atol=1.0)
    still = np.zeros(40)
    slope = (law.energy(d + h) - law.energy(d - h)) / (2 * h)
    np.testing.assert_allclose(slope, law.force(d, still), rtol=1e-5, atol=0.1)
    pressed = np.array([2e4, 7e4])
    np.testing.assert_allclose(law.force(law.approach(pressed), np.zeros(2)), pressed)
    if not law.tension:
        assert np.all(law.force(d, rate) >= 0.0)
        assert np.all(law.force(np.full(3, -1e-6), np.array([0.0, 1.0, -1.0])) == 0.0)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Hertz(stiffness=-1.0), "stiffness = -1.0: must be positive"),
        (lambda: Hertz(stiffness=1e11, radius=0.4), "radius: says again what stiffness says"),
        (lambda: Hertz(tread="round"), "must be worn or cone"),
        (lambda: Hertz(radius=0.0), "radius = 0.0: must be positive"),
        (lambda: LinearSpring(0.0), "stiffness = 0.0: must be positive"),
        (lambda: LinearSpring(1e6, -1.0), "damping = -1.0"),
        (lambda: law_of("hertzian"), "must be one of rigid, unilateral, hertz, linear-spring"),
        (lambda: law_of(3), "contact = 3"),
    ],
)
def test_wrong_laws(make, words):
    with pytest.raises(InputError, match=words):
        make()


def test_words():
    assert [law_of(word).kind for word in LAWS] == list(LAWS)
    assert law_of(Hertz(radius=0.3)) == Hertz(radius=0.3)


def test_laws_of_mixed_wheels():
    """Each wheel has the law that it was given, fitted to its radius and static force."""
    laws = WheelLaws.of(
        [Rigid(), Hertz(), Unilateral(), LinearSpring(), Hertz()],
        np.array([1e4, 5e4, 2e4, 7e4, 6e4]),
        [None, 0.43, None, 0.46, 0.5],
    )
    assert laws.rigid.tolist() == [True, False, False, False, False]
    assert laws.unilateral.tolist() == [False, False, True, False, False]
    assert laws.may_part.tolist() == [False, True, True, True, True]
    zero = np.zeros(5)
    np.testing.assert_allclose(laws.force(zero, zero), [0.0, 5e4, 0.0, 7e4, 6e4])
    assert laws.indentation[1] == pytest.approx(4.2534e-8 * 5e4 ** (2 / 3), rel=1e-4)
    assert laws.indentation[4] == pytest.approx(4.1803e-8 * 6e4 ** (2 / 3), rel=1e-4)
    assert not laws.all_rigid


def random_compliance(rng, n):
    half = rng.normal(size=(n, n))
    return 1e-9 * (half @ half.T / n + 0.05 * np.eye(n))


@pytest.mark.parametrize("seed", range(30))
def test_complementarity_is_exact(seed):
    """Against non-negative least squares, and by its own conditions."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 25))
    S, free = random_compliance(rng, n), 1e-3 * rng.normal(size=n)
    one_sided = rng.random(n) < 0.7
    forces = complementary(S, free, one_sided)
    gap = free - S @ forces
    scale, size = np.abs(free).max(), np.abs(forces).max(initial=1e-30)
    assert np.abs(gap[~one_sided]).max(initial=0.0) < 1e-11 * scale
    assert forces[one_sided].min(initial=0.0) >= 0.0
    assert gap[one_sided].max(initial=0.0) < 1e-11 * scale
    assert np.abs(forces * gap)[one_sided].max(initial=0.0) < 1e-11 * scale * size
    if one_sided.all():
        L = np.linalg.cholesky(S)
        other, _ = nnls(L.T, np.linalg.solve(L, free))
        np.testing.assert_allclose(forces, other, atol=1e-8 * size)
    same = solve_interface(S, free, Interface(~one_sided, one_sided, None, 1e5), np.zeros(n))
    np.testing.assert_allclose(same.forces, forces, atol=1e-9 * size)


@pytest.mark.parametrize("k", [1e9, 1e11, 1e13, 1e17])
def test_one_hertz_wheel_by_bisection(k):
    """X = k (d* - S X)^1.5 to rounding, with quadratic convergence."""
    S, free = 3e-9, 4e-4

    def evaluate(d):
        return k * np.maximum(d, 0) ** 1.5, 1.5 * k * np.sqrt(np.maximum(d, 0))

    face = Interface(np.zeros(1, bool), np.zeros(1, bool), evaluate, 1e5)
    found = solve_interface(np.array([[S]]), np.array([free]), face, np.array([1e4]))
    exact = brentq(lambda x: x - k * max(free - S * x, 0.0) ** 1.5, 0.0, free / S, xtol=1e-14, rtol=1e-15)
    assert found.forces[0] == pytest.approx(exact, rel=1e-9)
    r = [value for value in found.residuals if value > 1e-13]
    if k <= 1e11:
        assert r[-1] < 5.0 * r[-2] ** 1.8  # quadratic
    assert len(found.residuals) <= 40


def test_groups_that_do_not_feel_each_other():
    """Leading indices are solved at once: the same as one by one."""
    rng = np.random.default_rng(9)
    S = np.array([random_compliance(rng, 4) for _ in range(6)])
    free = 1e-3 * rng.normal(size=(6, 4))
    rigid, one_sided = rng.random((6, 4)) < 0.2, rng.random((6, 4)) < 0.5
    one_sided &= ~rigid

    def evaluate(d):
        return 1e8 * np.maximum(d, 0) ** 1.5, 1.5e8 * np.sqrt(np.maximum(d, 0))

    both = solve_interface(S, free, Interface(rigid, one_sided, evaluate, 1e5), np.zeros((6, 4)))
    for i in range(6):
        face = Interface(rigid[i], one_sided[i], evaluate, 1e5)
        own = solve_interface(S[i], free[i], face, np.zeros(4))
        np.testing.assert_allclose(both.forces[i], own.forces, rtol=1e-8, atol=1e-5)


def test_no_convergence_says_where():
    def jumpy(d):  # a law with a wrong tangent, that overshoots further and further
        return -3e9 * d * np.array([1.0, 0.1]), np.zeros_like(d)

    face = Interface(np.zeros(2, bool), np.zeros(2, bool), jumpy, 1e5)
    with pytest.raises(NotConverged, match="no convergence in") as caught:
        solve_interface(1e-9 * np.eye(2), np.array([1e-4, 3.3e-5]), face, np.zeros(2))
    assert caught.value.row == 0
    assert len(caught.value.residuals) == 60
