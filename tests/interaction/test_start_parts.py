"""Starts on solids, whose mass falls into parts by direction: the same with these parts as with the whole mass."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

from axlespan.bridges.spans import simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.plan import plan_for
from axlespan.interaction.settings import settings_for
from axlespan.interaction.simulate import simulate
from axlespan.interaction.start import StartFactors, start_of, starts_of
from axlespan.irregularity import Harmonic
from axlespan.linalg.factor import factorize
from axlespan.linalg.parts import FactorOfParts
from axlespan.model.compile import compile_model
from axlespan.model.damping import Rayleigh
from axlespan.model.from_mesh import Solids
from axlespan.model.materials import Material
from axlespan.model.mesh import Mesh
from axlespan.model.model import Model
from axlespan.model.motions import HarmonicMotion
from axlespan.running.structure import Structure
from axlespan.running.surface import line_over
from axlespan.vehicles.simple import sprung_mass
from axlespan.vehicles.train import Train

WHEELS = sprung_mass(mass=5750.0, stiffness=1.595e6, damping=1e4, unsprung_mass=300.0)
LENGTH = 12.0


def solid(damping=None, shaken=False):
    """A block, clamped at one end; the bearing at the other may be shaken across."""
    mesh = Mesh.box((LENGTH, 1.0, 1.0), (12, 2, 2), origin=(0.0, -0.5, 0.0))
    model = Model(plane=False).with_mesh(mesh, {"volume": Solids(Material(3e9, 0.2, 2400.0))})
    x, _, z = model.points.T
    left, right = np.flatnonzero(x < 1e-9), np.flatnonzero((x > LENGTH - 1e-9) & (z < 1e-9))
    model = model.with_supports(left, ("x", "y", "z"), name="left").with_damping(damping)
    if shaken:
        model = model.with_supports(right, ("x", "z"), name="right")
        model = model.with_supports(right, motion={"y": HarmonicMotion(1e-3, 2.0, 1.0)}, name="shaken")
    else:
        model = model.with_supports(right, ("x", "y", "z"), name="right")
    compiled = compile_model(model)
    path = line_over(model, compiled.table, [(0.0, 0.0, 1.0), (LENGTH, 0.0, 1.0)])
    lines = {"main": path.transformed(compiled.system.elimination)}
    return Structure(system=compiled.system, lines=lines, model=model, name="block")


def turned(structure):
    """The same in d.o.f. that are turned about y at each node: x' and z' both have a share of x and of z."""
    system = structure.system
    n = system.size
    c, s = np.cos(0.3), np.sin(0.3)
    R = sp.kron(sp.eye_array(n // 3), np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]), format="csr")
    own = {name: sp.csr_array(R.T @ getattr(system, name) @ R) for name in ("stiffness", "mass", "damping")}
    for matrix in own.values():
        matrix.data[np.abs(matrix.data) < 1e-12 * np.abs(matrix.data).max(initial=0.0)] = 0.0
        matrix.eliminate_zeros()
    lines = {"main": structure.lines["main"].transformed(sp.csr_array(R))}
    return Structure(system=replace(system, **own), lines=lines, name="turned"), R


def plan_of(structure, start=9.3, **more):
    crossing = Crossing(structure, Train.of(WHEELS, 3, 2.7), speed=20.0, start=start)
    return plan_for(crossing, settings_for(crossing, time_step=1e-3, steps=10, method=Alpha(0.0), **more))


@pytest.fixture
def always(monkeypatch):
    """Small models show what large ones do."""
    monkeypatch.setattr("axlespan.linalg.parts._FEWEST", 1)


def with_whole_mass(plan):
    factors = StartFactors(plan)
    factors.__dict__["mass"] = factorize(plan.structure.M)
    return start_of(plan, factors)


def assert_same(start, other, rtol=1e-12):
    np.testing.assert_allclose(start.forces, other.forces, rtol=rtol)
    for body in ("structure", "fleet"):
        for values, expected in zip(getattr(start, body).values, getattr(other, body).values, strict=True):
            assert np.abs(values - expected).max() <= rtol * np.abs(expected).max()


CASES = {
    "wheels alone": ({}, {}, True),
    "a wheel about to enter": ({}, {"start": -0.05, "footprint": 0.3}, False),
    "damped": ({"damping": Rayleigh(0.5, 1e-3)}, {"start": -0.05, "footprint": 0.3}, False),
    "shaken across": ({"shaken": True}, {}, False),
    "shaken across, damped": ({"shaken": True, "damping": Rayleigh(0.5, 1e-3)}, {}, False),
}


@pytest.mark.parametrize("case", CASES)
def test_as_with_the_whole_mass(case, always):
    build, more, by_parts = CASES[case]
    plan = plan_of(solid(**build), **more)
    factors = StartFactors(plan)
    start = start_of(plan, factors)
    assert np.abs(start.structure.a).max() > 1e-3
    assert_same(start, with_whole_mass(plan))
    assert isinstance(factors.mass, FactorOfParts)
    up = plan.crossing.structure.system.translation("z")[plan.crossing.structure.system.free]
    np.testing.assert_array_equal(factors.mass.rows, np.flatnonzero(up))
    assert ("whole" in vars(factors.mass)) != by_parts
    if by_parts:
        assert np.all(start.structure.a[up == 0.0] == 0.0)


def test_wheels_that_touch_several_parts(always):
    straight = solid()
    other, R = turned(straight)
    plan, plain = plan_of(other), plan_of(straight)
    factors = StartFactors(plan)
    start, expected = start_of(plan, factors), start_of(plain)
    assert isinstance(factors.mass, FactorOfParts)
    n = straight.system.size
    parts = np.isin(np.arange(n)[straight.system.free] % 3, (0, 2))
    np.testing.assert_array_equal(factors.mass.rows, np.flatnonzero(parts))
    assert_same(start, with_whole_mass(plan))
    np.testing.assert_allclose(start.forces, expected.forces, rtol=1e-9)
    moved = np.zeros((2, n))
    for row, state in zip(moved, (start, expected), strict=True):
        row[straight.system.free] = state.structure.a
    np.testing.assert_allclose(R @ moved[0], moved[1], rtol=0.0, atol=1e-9 * np.abs(moved[1]).max())


def test_several_at_once(always):
    """One enters, so that the whole mass is asked for; the others are as alone."""
    block = solid()
    plans = [plan_of(block, start, footprint=0.3) for start in (9.3, -0.05, 4.0)]
    for plan, start in zip(plans, starts_of(plans), strict=True):
        assert_same(start, with_whole_mass(plan))


def test_massless_dofs_hang_together(always):
    """A trace of stiffness stands in for their mass, and couples all."""
    bare = simple_span(length=25.0, youngs_modulus=2.87e9, second_moment=2.9, mass_per_length=0.0, elements=8)
    assert not isinstance(StartFactors(plan_of(bare)).mass, FactorOfParts)


def test_small_models_factor_the_whole():
    assert not isinstance(StartFactors(plan_of(solid())).mass, FactorOfParts)


def test_wheels_that_lift_off(monkeypatch):
    """Landings ask for accelerations anew, with forces in all directions."""
    crossing = Crossing(
        solid(),
        Train.of(WHEELS, 2, 2.7),
        speed=30.0,
        start=5.0,
        irregularity=Harmonic(amplitude=1e-2, wavelength=1.0, phase=0.3),
    )
    histories = []
    for fewest in (1, 10**9):
        monkeypatch.setattr("axlespan.linalg.parts._FEWEST", fewest)
        result = simulate(crossing, time_step=5e-4, steps=150, method=Alpha(0.0), contact="unilateral")
        histories.append(result.contact_force)
    assert np.any(histories[0] == 0.0)
    assert np.any(histories[0][0] > 0.0)
    np.testing.assert_allclose(histories[0], histories[1], rtol=1e-7, atol=1e-7 * histories[1].max())
