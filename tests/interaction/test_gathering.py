"""Tapes that are worked up many stretches at a time, and tables that recorders share: no number changes."""

from dataclasses import replace

import numpy as np
import pytest

from axlespan.bridges.spans import simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.interaction import convoy
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.plan import plan_for
from axlespan.interaction.records import gathering
from axlespan.interaction.records.recorder import Recorder
from axlespan.interaction.runs import run_plans
from axlespan.interaction.settings import settings_for
from axlespan.interaction.simulate import simulate
from axlespan.irregularity import Harmonic
from axlespan.vehicles.simple import axle_loads, sprung_mass
from axlespan.vehicles.train import Train

SPAN = simple_span(length=20.0, youngs_modulus=34e9, second_moment=0.4, mass_per_length=12e3, elements=10)
CARS = Train.of(sprung_mass(mass=20e3, stiffness=1.2e6, damping=2e4), count=3, spacing=7.0)
LOADS = Train.of(axle_loads(loads=[1.7e5, 1.5e5], positions=[0.0, 3.0]), count=4, spacing=12.0)
ROUGH = Harmonic(amplitude=1e-3, wavelength=3.0)


def crossing(train, speed):
    return Crossing(SPAN, train, speed=speed, **({"irregularity": ROUGH} if train is CARS else {}))


def arrays(result):
    names = (
        "sensor_displacement",
        "sensor_acceleration",
        "contact_force",
        "support_reaction",
        "line_acceleration",
    )
    return {name: getattr(result, name) for name in (*names, "vehicle_acceleration", "line_slope")}


@pytest.mark.parametrize("train", [CARS, LOADS])
@pytest.mark.parametrize("alpha", [0.0, -0.1])
def test_it_does_not_matter_how_many_steps_are_worked_up_together(monkeypatch, train, alpha):
    def run():
        method = Alpha(alpha)
        return simulate(
            crossing(train, 50.0),
            time_step=1e-3,
            steps=900,
            method=method,
            sensors={"mid": 10.0},
            line_points=7,
        )

    monkeypatch.setattr(convoy, "_STRETCH", 37)
    together = run()
    monkeypatch.setattr(gathering, "_STEPS", 1)
    apart = run()
    for name, values in arrays(apart).items():
        peak = np.abs(values).max(initial=0.0)
        assert np.abs(arrays(together)[name] - values).max(initial=0.0) <= 1e-13 * peak, name
    for name in ("tension_episodes", "completed_steps"):
        assert together.checks.get(name) == apart.checks.get(name)
    for name in ("largest_contact_force", "smallest_contact_force_time"):
        assert together.checks[name] == pytest.approx(apart.checks[name], rel=1e-11)
    for one in (together, apart):
        assert one.checks["equilibrium_residual"] < 1e-9
    assert together.time[-1] == apart.time[-1] == pytest.approx(0.9)


def test_recorders_share_tables_of_the_same_readings_only():
    def plan(train, speed, **wanted):
        made = crossing(train, speed)
        return plan_for(made, settings_for(made, time_step=1e-3, steps=50, **wanted))

    first = Recorder(plan(CARS, 40.0, sensors={"mid": 10.0}, line_points=5))
    same = Recorder(plan(LOADS, 60.0, sensors={"mid": 10.0}, line_points=5), like=first)
    assert same.line.sums is first.line.sums and same.reactions.sums is first.reactions.sums
    assert (
        same.line._motion is not first.line._motion
        and same.reactions._inertia is not first.reactions._inertia
    )
    assert len(same.reactions.paths[0][0]) == 8 and len(first.reactions.paths[0][0]) == 3
    for other in (
        plan(CARS, 40.0, sensors={"mid": 9.0}, line_points=5),
        plan(CARS, 40.0, sensors={"mid": 10.0}, line_points=6),
        plan(CARS, 40.0, sensors={"mid": 10.0}, line_points=5, footprint=0.7),
    ):
        assert Recorder(other, like=first).line.sums is not first.line.sums


def test_crossings_side_by_side_and_alone():
    plans = []
    for train, speed in ((CARS, 45.0), (LOADS, 62.0), (CARS, 70.0)):
        made = crossing(train, speed)
        settings = settings_for(
            made,
            time_step=1e-3,
            steps=700,
            method=Alpha(-0.1),
            footprint=0.0,
            sensors={"mid": 10.0},
            line_points=5,
        )
        plans.append(plan_for(made, settings))
    for plan, beside in zip(plans, run_plans(plans), strict=True):
        (alone,) = run_plans([replace(plan)])
        for name, values in arrays(alone).items():
            peak = np.abs(values).max(initial=0.0)
            assert np.abs(arrays(beside)[name] - values).max(initial=0.0) <= 1e-11 * peak, name


def test_wheel_loads_on_supports_against_a_plain_loop():
    made = crossing(LOADS, 50.0)
    plan = plan_for(made, settings_for(made, time_step=1e-3, steps=50, footprint=1.5))
    reactions = Recorder(plan).reactions
    random = np.random.default_rng(3)
    positions, forces = random.uniform(-3.0, 23.0, (40, 8)), random.uniform(1e5, 2e5, (40, 8))
    wanted = np.zeros((40, len(made.structure.system.prescribed)))
    for wheels, path in reactions.paths:
        for step in range(40):
            for wheel in wheels:
                dofs, weights = path.weights(positions[step, wheel])
                for dof, weight in zip(dofs, weights, strict=True):
                    wanted[step, dof] += weight * forces[step, wheel]
    assert reactions._carried(positions, forces) == pytest.approx(wanted, abs=1e-9)
    assert np.abs(wanted).max() > 1e4
