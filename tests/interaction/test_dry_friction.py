"""Laws that are all but a jump, as dry friction: Newton's method against exact solutions of stick and slip."""

import numpy as np
import pytest
from scipy.linalg import cholesky, solve_triangular
from scipy.optimize import lsq_linear

import axlespan as asp
from axlespan.interaction.nonlinear.interface_solver import Interface, solve_interface
from axlespan.model.nonlinear import MultilinearDashpot
from axlespan.vehicles.nonlinear import with_nonlinear_spring

MASS, WHEEL, STIFF, DASH, SLIDE = 5750.0, 800.0, 1.595e6, 4e3, 2e4


@pytest.mark.parametrize("width", [1e-3, 1e-6, 1e-9, 1e-12])
@pytest.mark.parametrize("n", [1, 3, 12, 40])
def test_saturated_rows_are_a_box_constrained_problem(n, width):
    """p = F0 clip(d / w) tends to the minimum of ½ pᵀ S p - pᵀ d* over |p| <= F0 as w falls."""
    rng = np.random.default_rng(n)
    for _ in range(20):
        G = rng.normal(size=(n, n))
        S, free, limit = G @ G.T + 0.1 * np.eye(n), 3.0 * rng.normal(size=n), rng.uniform(0.2, 2.0, n)

        def evaluate(d, limit=limit):
            inside = np.abs(d) < width
            return limit * np.clip(d / width, -1.0, 1.0), np.where(inside, limit / width, 0.0)

        none = np.zeros(n, dtype=bool)
        found = solve_interface(S, free, Interface(none, none, evaluate, 1.0), rng.normal(size=n))
        # ½ pᵀ (S + w / F0) p - pᵀ d* over the box: Sp + w p / F0 = d* where it sticks
        factor = cholesky(S + np.diag(width / limit), lower=True)
        exact = lsq_linear(
            factor.T,
            solve_triangular(factor, free, lower=True),
            (-limit, limit),
            method="bvls",
            tol=1e-14,
        ).x
        np.testing.assert_allclose(found.forces, exact, rtol=0.0, atol=1e-7)
        assert len(found.residuals) <= 5 + 2 * n


@pytest.mark.parametrize("rigid", [1, 3])
def test_constraints_beside_saturated_rows(rigid):
    """Rows that are held keep d = 0: the others then see the compliance that is left."""
    rng = np.random.default_rng(7)
    n = 8
    G = rng.normal(size=(n, n))
    S, free, width = G @ G.T + 0.1 * np.eye(n), 3.0 * rng.normal(size=n), 1e-10
    held, none = np.arange(n) < rigid, np.zeros(n, dtype=bool)

    def evaluate(d):
        return np.clip(d / width, -1.0, 1.0), np.where(np.abs(d) < width, 1.0 / width, 0.0)

    found = solve_interface(S, free, Interface(held, none, evaluate, 1.0), np.zeros(n))
    np.testing.assert_allclose(found.coordinates[held], 0.0, atol=1e-12)
    k, f = np.flatnonzero(held), np.flatnonzero(~held)
    elastic = np.linalg.solve(S[np.ix_(k, k)], S[np.ix_(k, f)])
    left, free_left = S[np.ix_(f, f)] - S[np.ix_(f, k)] @ elastic, free[f] - elastic.T @ free[k]
    factor = cholesky(left, lower=True)
    exact = lsq_linear(
        factor.T, solve_triangular(factor, free_left, lower=True), (-1.0, 1.0), method="bvls", tol=1e-14
    ).x
    np.testing.assert_allclose(found.forces[f], exact, rtol=0.0, atol=1e-7)


def stick_and_slip(r, dr, ddr, dt, method):
    """Body on spring, dashpot and dry friction over a led wheel: friction solved exactly in every step."""
    al, be, ga = method.alpha, method.beta, method.gamma
    w = np.array([r[0], dr, ddr])
    z = np.array([r[0], 0.0, 0.0])
    inner, friction = -(STIFF * (z[0] - w[0]) + DASH * (z[1] - w[1])), 0.0  # at rest on a crest
    z[2] = (inner + friction) / MASS
    found, sticks = [z.copy()], 0
    for new in r[1:]:
        a = (new - w[0] - dt * w[1] - (0.5 - be) * dt**2 * w[2]) / (be * dt**2)
        w = np.array([new, w[1] + dt * ((1 - ga) * w[2] + ga * a), a])
        pu, pv = z[0] + dt * z[1] + (0.5 - be) * dt**2 * z[2], z[1] + (1 - ga) * dt * z[2]
        # M a = (1+al) (-k (u - w) - c (v - w') + f) - al (the same before), with u = pu + be dt² a, v = pv + ga dt a
        known = (1 + al) * (-STIFF * (pu - w[0]) - DASH * (pv - w[1])) - al * (inner + friction)
        whole = MASS + (1 + al) * (STIFF * be * dt**2 + DASH * ga * dt)
        speed = pv + ga * dt * known / whole - w[1]  # relative, without friction
        stuck = -speed * whole / (ga * dt * (1 + al))
        friction = float(np.clip(stuck, -SLIDE, SLIDE))
        sticks += abs(stuck) < SLIDE
        a = (known + (1 + al) * friction) / whole
        z = np.array([pu + be * dt**2 * a, pv + ga * dt * a, a])
        inner = -(STIFF * (z[0] - w[0]) + DASH * (z[1] - w[1]))
        found.append(z.copy())
    return np.array(found), sticks


@pytest.mark.parametrize("alpha", [0.0, -0.1])
def test_a_suspension_sticks_and_slides(alpha):
    """On rigid ground before the bridge; friction 1e-9 m/s wide, in whole steps."""
    law = MultilinearDashpot([(-1.0, -SLIDE), (-1e-9, -SLIDE), (1e-9, SLIDE), (1.0, SLIDE)])
    car = asp.vehicles.sprung_mass(mass=MASS, stiffness=STIFF, damping=DASH, unsprung_mass=WHEEL)
    car = with_nonlinear_spring(car, law, {"body.z": 1.0, "wheel1.z": -1.0}, name="friction")
    waves, dt, speed, start = asp.irregularity.Harmonic(amplitude=1e-2, wavelength=9.0), 1e-3, 30.0, -15.75
    bridge = asp.bridges.simple_span(
        length=25.0, youngs_modulus=2.87e9, second_moment=2.9, mass_per_length=2303.0, elements=6
    )
    crossing = asp.Crossing(bridge, asp.Train.of(car), speed=speed, start=start, irregularity=waves)
    method = asp.Alpha(alpha)
    result = asp.simulate(crossing, time_step=dt, steps=600, method=method)
    assert result.facts["cut_steps"] == 0 and result.facts["newton_iterations_largest"] <= 30
    before = slice(0, 500)
    r = waves.value(start + speed * dt * np.arange(500))
    exact, sticks = stick_and_slip(
        r, speed * float(waves.slope(start)), speed**2 * float(waves.curvature(start)), dt, method
    )
    assert 40 < sticks < 450
    for i, name in enumerate(("vehicle_displacement", "vehicle_velocity")):
        own = result.at(name, "1.body.z")[before]
        assert np.abs(own - exact[:, i]).max() < 1e-6 * np.abs(exact[:, i]).max(), name
    assert result.checks["energy_residual"] < 1e-11
