"""Nonlinear steps in one compiled loop are the steps that the coupling makes one by one."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

import axlespan as asp
from axlespan.bridges.unilateral import with_unilateral_springs
from axlespan.contact.laws import Hertz, LinearSpring, Unilateral
from axlespan.elements.beam import BeamProperties
from axlespan.errors import AnalysisError
from axlespan.interaction.nonlinear.contact import NonlinearCoupling
from axlespan.interaction.nonlinear.fused_march import NonlinearMarch
from axlespan.interaction.nonlinear.law_codes import CodedSprings
from axlespan.interaction.nonlinear.spring_columns import SpringColumns
from axlespan.interaction.nonlinear.springs import Springs
from axlespan.interaction.nonlinear.static_columns import StaticColumns
from axlespan.linalg.factor import factorize
from axlespan.model.compile import compile_model
from axlespan.model.model import Model
from axlespan.model.nonlinear import (
    BilinearHysteresis,
    MultilinearDashpot,
    MultilinearSpring,
    PowerDashpot,
    PowerSpring,
    ScaledLaw,
    UnilateralSpring,
)
from axlespan.model.system import SpringRows
from axlespan.running.line import path_on_beams
from axlespan.running.structure import MAIN_LINE, Structure
from axlespan.vehicles.train import Placement

pytest.importorskip("numba")

DECK = asp.bridges.simple_span(
    length=20.0, youngs_modulus=3e10, second_moment=0.4, mass_per_length=9e3, elements=20
)
TRACK = asp.bridges.with_track(DECK, asp.bridges.ballasted_track(), approach=30.0, exit=30.0)
HANGING = with_unilateral_springs(TRACK, "ballast", hanging=[(-12.0, 1e-3), (-11.4, 1e-3)])
UNIT = asp.vehicles.sprung_mass(mass=5750.0, stiffness=1.595e6, damping=20e3, unsprung_mass=800.0)
MASSES = asp.Train.of(UNIT, count=3, spacing=6.0)
MIXED = asp.Train(
    [
        Placement(replace(UNIT, contacts=(replace(UNIT.contacts[0], law=law),)), 5.0 * i)
        for i, law in enumerate(
            [None, Hertz(stiffness=1e9), Unilateral(), LinearSpring(2e7, 2e4), LinearSpring(2e8, 0.0, True)]
        )
    ],
    "mixed",
)
AXLES = asp.Train.of(asp.vehicles.axle_loads(loads=[1e5, 1e5], positions=[0.0, 2.5]), count=2, spacing=9.0)
WAVES = asp.irregularity.Harmonic(amplitude=1e-3, wavelength=3.0)
BUMPS = asp.irregularity.Harmonic(amplitude=8e-3, wavelength=3.0)


def bed():
    """A beam on the ground by springs and dashpots of all laws that are coded, under a load that swings."""
    n = 48
    x = 0.5 * np.arange(n + 1)
    nodes = np.concatenate([np.column_stack([x, 0.0 * x]), np.column_stack([x, 0.0 * x - 0.3])])
    pairs = np.column_stack([np.arange(n + 1) + n + 1, np.arange(n + 1)])
    beam = BeamProperties(bending_stiffness_y=6e6, mass_per_length=300.0)
    model = (
        Model(plane=True)
        .with_nodes(nodes)
        .with_beams(np.column_stack([np.arange(n), np.arange(n) + 1]), beam)
    )
    laws = (
        UnilateralSpring(2e7, 2e4),
        PowerSpring(6e8, 1.5),
        MultilinearSpring([(-2e-3, -3e4), (-1e-3, -2e4), (0.0, 0.0), (1e-3, 5e3)]),
        PowerDashpot(2e5, 1.2),
        MultilinearDashpot([(-0.1, -8e3), (0.0, 0.0), (0.05, 6e3)]),
    )
    for i, law in enumerate(laws):
        every = pairs[i::3] if i < 3 else pairs[i::5]
        model = model.with_nonlinear_springs(every, law, gap=2e-4 if i == 0 else 0.0, name=f"law {i}")
    for i in range(n + 1):
        model = model.with_support(n + 1 + i, ["z"], name=f"ground {i}")
    model = model.with_load(30, "z", -2e4, lambda t: np.sin(60.0 * t))
    compiled = compile_model(model)
    line = path_on_beams(model, compiled.table, range(n + 1))
    return Structure(compiled.system, {MAIN_LINE: line}, model=model)


BED = bed()
CASES = {
    # structure, train, irregularity, law, alpha, start, steps
    "rigid, hanging": (HANGING, MASSES, WAVES, "rigid", -0.1, -25.0, 600),
    "hertz, hanging": (HANGING, MASSES, WAVES, "hertz", -0.1, -25.0, 600),
    "axle loads, hanging": (HANGING, AXLES, None, "rigid", 0.0, -25.0, 600),
    "unilateral, hanging, bumps": (HANGING, MASSES, BUMPS, "unilateral", -0.1, -25.0, 400),
    "mixed, hanging": (HANGING, MIXED, WAVES, "rigid", -0.1, -25.0, 900),
    "hertz, all laws": (BED, MASSES, WAVES, Hertz(stiffness=1e10), -0.1, -2.0, 500),
    "mixed, all laws, bumps": (BED, MIXED, BUMPS, "rigid", -0.05, -2.0, 500),
    "hertz": (DECK, MASSES, WAVES, "hertz", -0.1, 0.0, 700),
    "mixed, bumps": (DECK, MIXED, BUMPS, "rigid", -0.05, 0.0, 300),
}


def run(case, monkeypatch, fused=True):
    structure, train, surface, contact, alpha, start, steps = CASES[case]
    made = []
    real = NonlinearCoupling.__call__
    with monkeypatch.context() as patch:
        patch.setattr(NonlinearCoupling, "__call__", lambda *args: made.append(1) or real(*args))
        if not fused:
            patch.setattr(NonlinearMarch, "of", classmethod(lambda cls, convoy: None))
        result = asp.simulate(
            asp.Crossing(structure, train, speed=55.0, irregularity=surface, start=start),
            time_step=5e-4,
            steps=steps,
            contact=contact,
            method=asp.Alpha(alpha),
            sensors={"middle": 10.0},
            fields=[0.0, 0.1, 0.123],
        )
    return result, len(made)


@pytest.mark.parametrize("case", CASES)
def test_same_numbers(case, monkeypatch):
    """Wheels come and go, lift off and land; steps out of the ordinary are the coupling's in both."""
    steps = CASES[case][-1]
    own, left = run(case, monkeypatch)
    other, made = run(case, monkeypatch, fused=False)
    assert made >= steps
    assert left < (0.2 * steps if "bumps" in case else 1)
    for name in ("contact_force", "sensor_displacement", "vehicle_displacement", "vehicle_velocity"):
        one, two = getattr(own, name), getattr(other, name)
        if two.size:
            # The factor of stiff rails over soft ballast is less sure than that of a beam.
            tolerance = 1e-9 if CASES[case][0] is HANGING and name.startswith("sensor") else 1e-10
            np.testing.assert_allclose(one, two, rtol=0.0, atol=tolerance * np.abs(two).max(), err_msg=name)
    fields = other.fields.displacement
    np.testing.assert_allclose(own.fields.displacement, fields, rtol=0.0, atol=1e-9 * np.abs(fields).max())
    # Stiff supports carry what rounding leaves of accelerations.
    reaction = other.support_reaction
    np.testing.assert_allclose(own.support_reaction, reaction, rtol=0.0, atol=1e-8 * np.abs(reaction).max())
    for check in ("energy_residual", "equilibrium_residual"):
        assert own.checks[check] < 1e-8
    assert (own.checks["flight_count"] > 0) == ("bumps" in case)
    for flight, told in zip(own.checks["flights"], other.checks["flights"], strict=True):
        assert (flight.pop("contact"), flight.pop("landed")) == (told.pop("contact"), told.pop("landed"))
        assert flight == pytest.approx(told, rel=1e-6, abs=1e-9)
    assert own.facts["newton_iterations"] == pytest.approx(other.facts["newton_iterations"], rel=0.02)
    for fact in ("landings", "nonlinear_springs_active", "cut_steps"):
        assert own.facts.get(fact) == other.facts.get(fact)
    assert own.facts["landing_loss"] == pytest.approx(other.facts["landing_loss"], rel=1e-8)
    assert len(own.facts["newton_iterations_per_step"]) == steps


def test_convergence_is_quadratic(monkeypatch):
    """Of the slowest step: each residual is at most a multiple of the square of the one before it, once they are small."""
    result, _ = run("hertz, hanging", monkeypatch)
    residuals = np.array(result.facts["newton_residuals"])
    assert len(residuals) == result.facts["newton_iterations_largest"] or len(residuals) > 3
    small = np.flatnonzero(residuals < 1e-1)
    assert len(small) >= 2
    for i in small[:-1]:
        assert residuals[i + 1] < 10.0 * residuals[i] ** 2 + 1e-13


def test_a_step_that_fails_is_told_as_ever(monkeypatch):
    """A lost vehicle ends the run where and with the words that it did; what was computed is kept."""
    ramp = asp.irregularity.Table(
        np.array([-100.0, 4.0, 5.0, 5.1, 100.0]), np.array([0.0, 0.0, 0.03, -0.2, -0.2])
    )
    crossing = asp.Crossing(DECK, asp.Train.of(UNIT), speed=40.0, irregularity=ramp)
    told = []
    for fused in (True, False):
        with monkeypatch.context() as patch:
            if not fused:
                patch.setattr(NonlinearMarch, "of", classmethod(lambda cls, convoy: None))
            with pytest.raises(AnalysisError, match=r"step \d+, .* lost") as caught:
                asp.simulate(crossing, time_step=5e-4, steps=900, contact="hertz", lost_after=0.02)
        told.append((str(caught.value), len(caught.value.result.contact_force)))
    assert told[0] == told[1]


LAWS = {
    "unilateral": UnilateralSpring(3e6, 2e4),
    "power": PowerSpring(4e9, 2.5),
    "table": MultilinearSpring([(-2e-3, -9e3), (-1e-3, -6e3), (0.0, 0.0), (1e-3, 2e3)]),
    "power dashpot": PowerDashpot(3e4, 1.5),
    "table dashpot": MultilinearDashpot([(-0.1, -2e3), (0.0, 0.0), (0.05, 2e3)]),
    "scaled": ScaledLaw(PowerSpring(4e9, 2.0), np.linspace(0.5, 2.0, 40)),
}


def test_deviations_of_coded_laws():
    """Those of the laws themselves, with their derivatives."""
    from axlespan.interaction.nonlinear.interface_kernel import deviations

    random = np.random.default_rng(3)
    groups = [
        SpringRows(
            name,
            law,
            sp.csr_array((40, 5)),
            1e-3 * random.standard_normal(40),
            law.stiffness,
            law.reference_damping,
        )
        for name, law in LAWS.items()
    ]
    base = np.concatenate([group.gap for group in groups])
    empty = sp.csr_array((len(base), 5))
    springs = Springs(tuple(groups), empty, empty, base, [np.zeros((40, 0))] * len(groups))
    coded = CodedSprings.of(springs)
    e, rate = 2e-3 * random.standard_normal(springs.n), 0.1 * random.standard_normal(springs.n)
    q, by_e, by_rate = (np.full(springs.n, np.nan) for _ in range(3))
    law_arrays = (coded.kinds, coded.numbers, coded.points)
    deviations(np.arange(springs.n), 0, springs.n, e, rate, law_arrays, q, by_e, by_rate)
    scale = np.abs(springs.forces(e, rate)) + springs.stiffness * np.abs(e)
    assert np.all(np.abs(q - springs.deviation(e, rate)) <= 1e-12 * scale)
    assert np.any(q == 0.0) and np.any(q != 0.0)
    k, c = springs.tangent(e, rate)
    np.testing.assert_allclose(by_e, k, rtol=1e-11, atol=1e-6)
    np.testing.assert_allclose(by_rate, c, rtol=1e-11, atol=1e-8)


def test_laws_with_memory_are_not_coded():
    rows = SpringRows("friction", BilinearHysteresis(8e6, 2e3), sp.csr_array((1, 5)), np.zeros(1))
    springs = Springs((rows,), rows.rows, rows.rows, np.zeros(1), [np.zeros((1, 1))])
    assert CodedSprings.of(springs) is None


@pytest.mark.parametrize("n", [1, 7, 40])
def test_dense_solution(n):
    from axlespan.interaction.nonlinear.interface_kernel import solve_dense

    random = np.random.default_rng(n)
    room, right = np.zeros((n + 9, n + 9)), random.standard_normal(n)
    matrix = random.standard_normal((n, n))
    matrix[0, 0] = 0.0 if n > 1 else 2.0  # wants another pivot
    room[:n, :n] = matrix
    x = np.zeros(n + 9)
    x[:n] = right
    assert solve_dense(room, n, x)
    np.testing.assert_allclose(matrix @ x[:n], right, atol=1e-10)
    room[:n, :n] = 0.0
    assert not solve_dense(room, n, x)


def test_columns_of_springs():
    """Compliance among springs and under wheels, from a dense inverse."""
    from axlespan.dynamics.integrator import Integrator, Matrices

    n, random = 30, np.random.default_rng(5)
    K = sp.csr_array(sp.diags_array([4.0 * np.ones(n), -np.ones(n - 1), -np.ones(n - 1)], offsets=[0, 1, -1]))
    integrator = Integrator(Matrices(K=K, M=sp.csr_array(sp.eye_array(n))), asp.Alpha(-0.1), 0.5)
    rows = sp.csr_array(np.where(random.random((50, n)) < 0.1, random.standard_normal((50, n)), 0.0))
    columns = SpringColumns(integrator, rows, np.arange(4, 20))
    B = rows.toarray()
    Z = 1.0 - 0.1
    Z = Z * integrator.u_from_a * np.linalg.inv(integrator.effective.toarray())
    chosen = np.array([2, 33, 40, 49])
    np.testing.assert_allclose(columns.between(chosen), B[chosen] @ Z @ B[chosen].T, atol=1e-13)
    dofs, weights = np.array([[4, 5, 6], [18, 19, 4]]), np.array([[0.2, 0.5, 0.3], [0.6, 0.4, 0.0]])
    E = np.zeros((2, n))
    E[[[0], [1]], dofs] = weights
    np.testing.assert_allclose(columns.under(dofs, weights, chosen), E @ Z @ B[chosen].T, atol=1e-13)
    assert sorted(columns.slot) == list(range(50))  # two blocks, both asked for


def test_static_columns():
    """Compliance of rows that have been taken in, one group after the other."""
    n, random = 20, np.random.default_rng(6)
    K = sp.csr_array(sp.diags_array([4.0 * np.ones(n), -np.ones(n - 1), -np.ones(n - 1)], offsets=[0, 1, -1]))
    rows = sp.csr_array(random.standard_normal((9, n)))
    columns = StaticColumns(rows, factorize(K))
    columns.take_in(np.array([5, 1]))
    columns.take_in(np.array([7]))
    columns.take_in(np.array([], dtype=np.int64))
    Z = rows.toarray() @ np.linalg.inv(K.toarray()) @ rows.toarray().T
    asked = np.array([1, 3, 5, 7])
    expected = Z[np.ix_(asked, asked)]
    expected[1], expected[:, 1] = 0.0, 0.0
    np.testing.assert_allclose(columns.compliance(asked), expected, atol=1e-13)
    forces = np.zeros(9)
    forces[[1, 5, 7]] = random.standard_normal(3)
    np.testing.assert_allclose(K @ columns.deflection(forces), rows.T @ forces, atol=1e-12)
