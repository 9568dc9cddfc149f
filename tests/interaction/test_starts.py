"""Starts of many crossings at once: the equations that each must satisfy, the numbers of each alone, and memory."""

import pickle
import tracemalloc

import numpy as np
import pytest
import scipy.sparse as sp

from axlespan.bridges.spans import SupportAt, simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.line_responses import LineResponses, side_by_side
from axlespan.interaction.plan import plan_for
from axlespan.interaction.settings import settings_for
from axlespan.interaction.start import StartFactors, condensed_stiffness, rows_at, start_of, starts_of
from axlespan.irregularity import Harmonic
from axlespan.linalg.factor import factorize
from axlespan.model.damping import Rayleigh
from axlespan.model.motions import HarmonicMotion
from axlespan.vehicles.simple import axle_loads, rigid_body, sprung_mass
from axlespan.vehicles.train import Train

SPAN = {"length": 25.0, "youngs_modulus": 2.87e9, "second_moment": 2.9, "mass_per_length": 2303.0}
WAVE = Harmonic(amplitude=1e-3, wavelength=4.0, phase=0.3)
MASS = sprung_mass(mass=5750.0, stiffness=1.595e6, damping=1e4, unsprung_mass=300.0)
CAR = rigid_body(
    mass=2.8e4, pitch_inertia=4e5, axles=[0.0, 4.0, 9.0], stiffness=[9e5, 1e6, 1.2e6], unsprung_mass=400.0
)
LOADS = axle_loads(loads=[5e4, 6e4], positions=[0.0, 3.3])
BRIDGES = {
    "damped": {"damping": Rayleigh(0.4, 2e-4)},
    "moving": {
        "supports": [SupportAt(0.0), SupportAt(25.0, fixed=(), motion={"z": HarmonicMotion(2e-3, 2.0)})]
    },
}


def crossings(bridge):
    """Trains of three kinds of vehicles, ahead of the bridge, on it, and partly on it at either end."""
    mixed = Train.joined([Train.of(MASS, 2, 5.0), Train.of(LOADS), Train.of(CAR)], [4.0, 3.0])
    trains = [Train.of(MASS, 4, 3.1), Train.of(CAR, 2, 13.0), Train.of(LOADS), mixed]
    for i, train in enumerate(trains):
        for start in (-5.0, 6.0 + i, 17.0, 24.5, 27.0):
            for surface in (None, WAVE):
                more = {} if surface is None else {"irregularity": surface}
                yield Crossing(bridge, train, speed=20.0 + start, start=start, **more)


def plan_of(crossing):
    return plan_for(
        crossing, settings_for(crossing, time_step=2e-3, steps=2000, method=Alpha(-0.1), footprint=0.0)
    )


@pytest.mark.parametrize("bridge", BRIDGES)
def test_the_equations_of_motion_and_the_constraint(bridge):
    """M ü + C u̇ + K u = F - Eᵀ X on the structure, the like on the vehicles, and wheels on the line, of any order."""
    span = simple_span(elements=8, **SPAN, **BRIDGES[bridge])
    plans = [plan_of(crossing) for crossing in crossings(span)]
    for plan, start in zip(plans, starts_of(plans), strict=True):
        (u, v, a), (vu, vv, va) = start.structure.values, start.fleet.values
        m, fleet, rows = plan.structure, plan.fleet, rows_at(plan)
        x = fleet.coupled
        force = plan.forces.at(0.0) if plan.forces.n_term else np.zeros(m.size)
        left = m.M @ a + m.damping_force(v) + m.K @ u + rows.E.T @ start.forces - force
        assert np.abs(left).max() < 1e-9 * np.abs(start.forces).max()
        assert np.abs(start.load - rows.E.T @ start.forces).max() < 1e-9 * np.abs(start.forces).max()
        if not len(x):
            assert np.array_equal(start.forces, fleet.weight)
            continue
        on_wheels = np.zeros(fleet.matrices.size)
        on_wheels[fleet.dofs] = (start.forces - fleet.weight)[x]
        own = fleet.matrices
        left = own.M @ va + own.damping_force(vv) + own.K @ vu - on_wheels
        assert np.abs(left).max() < 1e-9 * np.abs(start.forces).max()
        speed, acceleration = plan.rows.motion(0.0)
        slope = rows.E1 @ u
        line = (
            rows.height + rows.E @ u,
            rows.rate + speed * slope + rows.E @ v,
            rows.second_rate
            + rows.E @ a
            + speed**2 * (rows.E2 @ u)
            + acceleration * slope
            + 2.0 * speed * (rows.E1 @ v),
        )
        for wheels, under in zip((vu, vv, va), line, strict=True):
            scale = max(np.abs(wheels).max(), 1e-6)
            assert np.abs(wheels[fleet.dofs] - under[x]).max() < 1e-9 * scale


@pytest.mark.parametrize("bridge", BRIDGES)
def test_many_are_as_each_alone(bridge):
    span = simple_span(elements=8, **SPAN, **BRIDGES[bridge])
    plans = [plan_of(crossing) for crossing in crossings(span)]
    for plan, start in zip(plans, starts_of(plans), strict=True):
        alone = start_of(plan)
        np.testing.assert_allclose(start.forces, alone.forces, rtol=1e-12)
        for body in ("structure", "fleet"):
            for values, own in zip(getattr(start, body).values, getattr(alone, body).values, strict=True):
                scale = max(np.abs(own).max(initial=0.0), 1e-3)
                assert np.abs(values - own).max(initial=0.0) < 1e-12 * scale


@pytest.mark.parametrize("dense", [0, 10**6])
@pytest.mark.parametrize("kept", [0.0, 1e9])
@pytest.mark.parametrize("wheels", [2, 30])
def test_responses_to_loads_on_lines(dense, kept, wheels, monkeypatch):
    """By wheel or by d.o.f., whole solutions kept or not: E F⁻¹ Eᵀ and F⁻¹ Eᵀ X."""
    monkeypatch.setattr("axlespan.interaction.line_responses._KEPT", kept)
    monkeypatch.setattr("axlespan.interaction.line_responses._DENSE_UP_TO", dense)
    monkeypatch.setattr("axlespan.interaction.line_responses._AT_ONCE", 8.0 * 9 * 50)
    rng, n = np.random.default_rng(4), 50
    A = sp.diags_array([-1.0, 2.5, -1.0], offsets=[-1, 0, 1], shape=(n, n), format="csr")
    factor, lanes, dense_rows = factorize(A), [], []
    for m in (wheels, 1, wheels + 3):
        dofs, weights = 5 + rng.integers(0, 20, (m, 4)), rng.standard_normal((m, 4))
        dofs[0, 3], weights[0, 3] = 0, 0.0  # an unused place
        E = np.zeros((m, n))
        np.add.at(E, (np.arange(m)[:, None], dofs), weights)
        lanes.append((dofs, weights))
        dense_rows.append(E)
    responses = LineResponses(factor, lanes)
    forces = [rng.standard_normal(len(E)) for E in dense_rows]
    found = responses.under(forces)
    for i, E in enumerate(dense_rows):
        columns = np.linalg.solve(A.toarray(), E.T)
        np.testing.assert_allclose(responses.between(i), E @ columns, rtol=0.0, atol=1e-13)
        np.testing.assert_allclose(found[:, i], columns @ forces[i], rtol=0.0, atol=1e-12)
    loads = [rng.standard_normal(n) for _ in range(10)]
    for load, solved in zip(loads, side_by_side(factor, loads), strict=True):
        np.testing.assert_allclose(solved, np.linalg.solve(A.toarray(), load), rtol=0.0, atol=1e-13)


def test_the_factor_that_the_check_leaves_over(monkeypatch):
    """It solves with K, does not travel with the structure, and is not kept where it is large."""
    span = simple_span(elements=8, **SPAN)
    crossing = Crossing(span, Train.of(MASS, 4, 3.1), speed=20.0, start=15.0)
    plan = plan_of(crossing)
    known = span.stiffness_factor
    assert known is not None
    assert StartFactors(plan).stiffness is known
    K = span.system.partition.K_FF
    load = np.arange(1.0, K.shape[0] + 1.0)
    np.testing.assert_allclose(K @ known.solve(load), load, rtol=1e-9)
    other = pickle.loads(pickle.dumps(span))
    assert "_checked" not in vars(other)
    assert other.stiffness_factor is not known
    monkeypatch.setattr("axlespan.running.structure._KEPT", 0.0)
    bare = simple_span(elements=8, **SPAN)
    again = plan_of(Crossing(bare, Train.of(MASS, 4, 3.1), speed=20.0, start=15.0))
    assert bare.stiffness_factor is None
    np.testing.assert_allclose(start_of(again).structure.u, start_of(plan).structure.u, rtol=0.0, atol=1e-16)


def test_condensed_stiffness_is_the_schur_complement():
    """Of vehicles of two kinds, in turn; nothing couples two of them."""
    train = Train.of(CAR, 2, 13.0)
    plan = plan_of(Crossing(simple_span(elements=4, **SPAN), train, speed=20.0))
    fleet = plan.fleet
    K, x = fleet.matrices.K.toarray(), fleet.dofs
    rest = np.setdiff1d(np.arange(len(K)), x)
    expected = K[np.ix_(x, x)] - K[np.ix_(x, rest)] @ np.linalg.solve(
        K[np.ix_(rest, rest)], K[np.ix_(rest, x)]
    )
    found = condensed_stiffness(fleet)[np.ix_(fleet.coupled, fleet.coupled)]
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-9 * np.abs(K).max())


def test_a_long_train_takes_little_memory():
    """6000 wheels, a few of them on the span: nothing is as large as all wheels squared (288 MB)."""
    crossing = Crossing(
        simple_span(elements=8, **SPAN), Train.of(CAR, 2000, 13.0), speed=20.0, start=15.0, irregularity=WAVE
    )
    plan = plan_of(crossing)
    tracemalloc.start()
    start = start_of(plan)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 10e6
    assert start.forces.shape == (6000,)
    assert abs(start.forces[-1] / plan.fleet.weight[-1] - 1.0) > 1e-4  # the last one stands on waves too
