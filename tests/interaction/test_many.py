"""Crossings side by side are the same crossings, one by one."""

import numpy as np
import pytest

from axlespan.bridges.spans import SupportAt, simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.simulate import simulate, simulate_many
from axlespan.irregularity import Harmonic
from axlespan.model.damping import Modal, Rayleigh
from axlespan.model.motions import HarmonicMotion
from axlespan.vehicles.simple import axle_loads, rigid_body, rigid_mass, sprung_mass
from axlespan.vehicles.train import Train

SPAN = {"length": 25.0, "youngs_modulus": 2.87e9, "second_moment": 2.9, "mass_per_length": 2303.0}
MASS = sprung_mass(mass=5750.0, stiffness=1.595e6)
CAR = rigid_body(mass=9e3, pitch_inertia=2e4, axles=[0.0, 2.6], stiffness=1.2e6, damping=1.5e4, center=1.1)
LOADS = axle_loads(loads=[5e4, 7e4], positions=[0.0, 3.0])
BRIDGES = {
    "plain": simple_span(elements=8, **SPAN),
    "Rayleigh": simple_span(elements=8, damping=Rayleigh(0.4, 2e-4), **SPAN),
    "modal": simple_span(elements=8, damping=Modal(0.02), **SPAN),
    "moving": simple_span(
        elements=8,
        supports=[SupportAt(0.0), SupportAt(25.0, fixed=(), motion={"z": HarmonicMotion(2e-3, 2.0)})],
        **SPAN,
    ),
}
QUANTITIES = (
    "time",
    "sensor_displacement",
    "sensor_velocity",
    "sensor_acceleration",
    "contact_force",
    "contact_position",
    "vehicle_displacement",
    "vehicle_velocity",
    "vehicle_acceleration",
    "support_reaction",
)


def crossings(bridge):
    """Different trains, speeds, starts, profiles; one of forces only, one that starts on the bridge."""
    wave = Harmonic(amplitude=0.5e-3, wavelength=4.0)
    return [
        Crossing(bridge, Train.of(MASS), speed=30.0, irregularity=wave),
        Crossing(bridge, Train.of(LOADS), speed=25.0),
        Crossing(bridge, Train.of(CAR, 3, 6.0), speed=50.0, irregularity=wave),
        Crossing(bridge, Train.joined([Train.of(MASS), Train.of(LOADS)], [2.0]), speed=0.0, start=15.0),
        Crossing(bridge, Train.of(CAR), speed_history=[[0.0, 30.0], [0.5, 10.0]], start=9.0),
    ]


def same(one, other, tolerance):
    for quantity in QUANTITIES:
        a, b = getattr(one, quantity), getattr(other, quantity)
        assert a.shape == b.shape
        # A train that stands has velocities of rounding size; Newmark multiplies that by 4 / Δt² for wheels.
        limit = tolerance * np.abs(b).max(initial=0.0) + 1e-6
        assert np.abs(a - b).max(initial=0.0) <= limit, quantity


@pytest.mark.parametrize("alpha", [0.0, -0.1])
@pytest.mark.parametrize("bridge", BRIDGES)
def test_side_by_side(bridge, alpha):
    """Runs of different length: lanes leave when they are done."""
    several, counts = crossings(BRIDGES[bridge]), [300, 620, 300, 270, 511]
    settings = {"time_step": 2e-3, "method": Alpha(alpha), "sensors": {"m": 12.5, "q": 4.0}}
    together = simulate_many(several, steps=counts, **settings)
    for crossing, n, result in zip(several, counts, together, strict=True):
        alone = simulate(crossing, steps=n, **settings)
        assert result.contact == alone.contact
        assert result.outcome.code == "completed"
        same(result, alone, 1e-6)
        for quantity in ("sensor_displacement", "contact_force", "support_reaction"):
            a, b = getattr(result, quantity), getattr(alone, quantity)
            assert np.abs(a - b).max() <= 1e-10 * np.abs(b).max(), quantity
        assert result.checks["energy_residual"] < 1e-10
        assert result.checks["equilibrium_residual"] < 1e-9
        assert result.checks["tension_episodes"] == alone.checks["tension_episodes"]


@pytest.mark.parametrize("alpha", [0.0, -0.1])
def test_side_by_side_to_the_tenth_digit(alpha):
    """All but the rates of massless contact points, whose rounding Newmark multiplies by 4 / Δt²."""
    bridge = BRIDGES["Rayleigh"]
    several = crossings(bridge)[:3]
    settings = {"time_step": 2e-3, "method": Alpha(alpha), "sensors": {"m": 12.5}, "steps": 400}
    for result, crossing in zip(simulate_many(several, **settings), several, strict=True):
        alone = simulate(crossing, **settings)
        bodies = [i for i, name in enumerate(alone.vehicle_dof) if "wheel" not in name]
        for quantity in QUANTITIES:
            a, b = getattr(result, quantity), getattr(alone, quantity)
            if quantity.startswith("vehicle"):
                a, b = a[:, bodies], b[:, bodies]
            assert np.abs(a - b).max(initial=0.0) <= 1e-10 * np.abs(b).max(initial=0.0), quantity


@pytest.mark.parametrize("threads", [2, 3])
def test_threads_change_nothing(threads):
    bridge = BRIDGES["plain"]
    several = crossings(bridge)
    settings = {"time_step": 2e-3, "steps": [100, 50, 100, 80, 100], "sensors": {"m": 12.5}}
    one = simulate_many(several, **settings, threads=1)
    for result, other in zip(simulate_many(several, **settings, threads=threads), one, strict=True):
        assert result.facts["threads"] == threads
        for quantity in ("sensor_displacement", "contact_force", "support_reaction"):
            a, b = getattr(result, quantity), getattr(other, quantity)
            assert np.abs(a - b).max() <= 1e-10 * np.abs(b).max(), quantity


def test_threads_of_the_environment(monkeypatch):
    crossing = crossings(BRIDGES["plain"])[0]
    monkeypatch.setenv("AXLESPAN_THREADS", "2")
    assert simulate(crossing, time_step=2e-3, steps=5).facts["threads"] == 2
    assert simulate(crossing, time_step=2e-3, steps=5, threads=1).facts["threads"] == 1
    monkeypatch.setenv("AXLESPAN_THREADS", "many")
    with pytest.raises(InputError, match="must be a whole number from 1 to 1024") as caught:
        simulate(crossing, time_step=2e-3, steps=5)
    assert caught.value.field == "AXLESPAN_THREADS"
    with pytest.raises(InputError, match="must be a whole number from 1 to 1024"):
        simulate(crossing, time_step=2e-3, steps=5, threads=0)


def test_the_method_follows_all_trains():
    """One wheel with mass among them damps all; the footprint is each train's own affair."""
    bridge = BRIDGES["plain"]
    heavy = Train.of(sprung_mass(mass=5750.0, stiffness=1.595e6, unsprung_mass=300.0))
    light, massive = simulate_many(
        [Crossing(bridge, Train.of(MASS), speed=30.0), Crossing(bridge, heavy, speed=30.0)],
        time_step=2e-3,
        steps=100,
    )
    assert (light.facts["alpha"], massive.facts["alpha"]) == (-0.1, -0.1)


def washboard(bridge):
    """A heavy mass over a washboard: without damping it runs away within 300 steps."""
    return Crossing(
        bridge,
        Train.of(rigid_mass(mass=2.3e5)),
        speed=60.0,
        start=8.0,
        irregularity=Harmonic(amplitude=0.05, wavelength=1.0),
    )


@pytest.mark.parametrize("steps", [200, 300])
def test_one_that_fails_leaves_the_others_alone(steps):
    """What happens in its lane reaches neither their histories nor their checks."""
    bridge = BRIDGES["plain"]
    good = Crossing(bridge, Train.of(CAR), speed=30.0)
    bad = washboard(bridge)
    settings = {"time_step": 2e-3, "method": Alpha(0.0), "footprint": 0.0, "sensors": {"m": 12.5}}
    one, failed = simulate_many([good, bad], steps=steps, **settings)
    alone = simulate(good, steps=steps, **settings)
    assert failed.outcome.code == "failed"
    assert "diverged at step" in failed.outcome.message
    assert 20 < len(failed.time) <= steps
    assert failed.facts["completed_steps"] == len(failed.time) - 1
    assert failed.checks["finite_values"] is False
    assert np.isfinite(failed.contact_force).all()
    same(one, alone, 1e-6)
    assert one.checks["finite_values"] is True
    assert one.checks["energy_residual"] < 1e-10


def test_lanes_that_fail_and_lanes_that_are_done():
    """One leaves after 90 steps, one fails after that, one goes on."""
    bridge = BRIDGES["plain"]
    good = Crossing(bridge, Train.of(CAR), speed=30.0)
    settings = {"time_step": 2e-3, "method": Alpha(0.0), "footprint": 0.0, "sensors": {"m": 12.5}}
    short, failed, long = simulate_many([good, washboard(bridge), good], steps=[90, 300, 300], **settings)
    assert [r.outcome.code for r in (short, failed, long)] == ["completed", "failed", "completed"]
    alone = simulate(good, steps=300, **settings)
    same(long, alone, 1e-6)
    assert len(short.time) == 91
    np.testing.assert_allclose(short.sensor_displacement, alone.sensor_displacement[:91], atol=1e-15)


class TestErrors:
    def test_none(self):
        assert simulate_many([], time_step=1e-3, steps=10) == []

    def test_one_structure(self):
        pair = [crossings(BRIDGES["plain"])[0], crossings(BRIDGES["modal"])[0]]
        with pytest.raises(InputError, match="must all be of one structure object"):
            simulate_many(pair, time_step=1e-3, steps=10)

    def test_numbers_of_steps(self):
        pair = crossings(BRIDGES["plain"])[:2]
        with pytest.raises(InputError, match="must be one number, or one for each crossing"):
            simulate_many(pair, time_step=1e-3, steps=[10, 20, 30])
        whole = simulate_many(pair, time_step=1e-3, steps=np.int64(10))
        assert [len(result.time) for result in whole] == [11, 11]
