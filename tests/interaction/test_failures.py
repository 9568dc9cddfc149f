"""Inputs that are refused before anything is computed, and runs that fail on the way."""

import numpy as np
import pytest

from axlespan.bridges.spans import SupportAt, simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.elements.beam import BeamProperties
from axlespan.errors import AnalysisError, InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.settings import Iteration
from axlespan.interaction.simulate import simulate
from axlespan.model.compile import compile_model
from axlespan.model.damping import Modal
from axlespan.model.model import Model
from axlespan.model.motions import Constant
from axlespan.running.line import path_on_beams
from axlespan.running.structure import Structure
from axlespan.vehicles.simple import rigid_mass, sprung_mass
from axlespan.vehicles.train import Train
from axlespan.vehicles.vehicle import ContactPoint, Vehicle

SPAN = {"length": 25.0, "youngs_modulus": 2.87e9, "second_moment": 2.9, "mass_per_length": 2303.0}
BRIDGE = simple_span(elements=8, **SPAN)
MASS = sprung_mass(mass=5750.0, stiffness=1.595e6)
TRAIN = Train.of(MASS)
CROSSING = Crossing(BRIDGE, TRAIN, speed=30.0)


def run(crossing=CROSSING, **settings):
    return simulate(crossing, **({"time_step": 1e-3, "steps": 10} | settings))


@pytest.mark.parametrize(
    ("arguments", "field", "rule"),
    [
        ({}, "crossing.speed", "either as speed or as speed_history"),
        (
            {"speed": 1.0, "speed_history": [[0.0, 1.0]]},
            "crossing.speed",
            "either as speed or as speed_history",
        ),
        ({"speed": -1.0}, "speed", "must be zero or positive"),
        ({"speed": float("nan")}, "speed", "must be zero or positive"),
        ({"speed_history": [[0.0, 1.0], [0.0, 2.0]]}, "speed_history.1", "must have increasing times"),
        ({"speed": 1.0, "start": float("inf")}, "crossing.start", "must be a finite number"),
        ({"speed": 1.0, "start": float("nan")}, "crossing.start", "must be a finite number"),
        ({"speed": 1.0, "gravity": -9.81}, "gravity", "must be zero or positive"),
    ],
)
def test_crossings(arguments, field, rule):
    with pytest.raises(InputError, match=rule) as caught:
        Crossing(BRIDGE, TRAIN, **arguments)
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("settings", "field", "rule"),
    [
        ({"time_step": 0.0}, "time_step", "must be positive"),
        ({"time_step": float("nan")}, "time_step", "must be positive"),
        ({"steps": 0}, "steps", "must be a whole number of at least 1"),
        ({"steps": 1.5}, "steps", "must be a whole number of at least 1"),
        ({"steps": True}, "steps", "must be a whole number of at least 1"),
        ({"steps": 10**9}, "steps", "must be at most 100 000 000"),
        ({"every": 0}, "every", "must be a whole number of at least 1"),
        ({"coupling": "magic"}, "method", "must be one of direct, iterative, refactored, literal"),
        ({"footprint": -0.1}, "footprint", "must be between 0 and the length of the line, 25 m"),
        ({"footprint": 26.0}, "footprint", "must be between 0 and the length of the line, 25 m"),
        ({"solver": "magic"}, "kind", "must be a kind of factor"),
        ({"sensors": {"far": 25.1}}, "sensors.far", "must lie on the structure, between 0 and 25 m"),
        ({"sensors": {"odd": float("nan")}}, "sensors.odd", "must lie on the structure"),
        ({"time_step": 0.3}, "time_step", r"is too long: 1\.\d+ steps per shortest period of vehicle 'sprung mass'"),
    ],
)  # fmt: skip
def test_settings(settings, field, rule):
    with pytest.raises(InputError, match=rule) as caught:
        run(**settings)
    assert caught.value.field == field


def test_a_step_that_leaps_over_the_bridge():
    slow = sprung_mass(mass=5750.0, stiffness=1e3)
    with pytest.raises(InputError, match="a wheel advances 9 m a step on a line of 25 m"):
        run(Crossing(BRIDGE, Train.of(slow), speed=30.0), time_step=0.3)


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ({"tolerance": 0.0}, "tolerance"),
        ({"relaxation": 0.0}, "relaxation"),
        ({"relaxation": 1.1}, "relaxation"),
        ({"limit": 0}, "max_iterations"),
    ],
)
def test_iteration_settings(arguments, field):
    with pytest.raises(InputError) as caught:
        Iteration(**arguments)
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("start", "speed", "shown"),
    [
        (-50.0, 30.0, "runs from -50 to -49.7 m"),
        (26.0, 30.0, "runs from 26 to 26.3 m"),
        (-1.0, 0.0, "from -1 to -1 m"),
    ],
)
def test_trains_that_never_come(start, speed, shown):
    with pytest.raises(InputError, match="never brings a wheel onto the structure") as caught:
        run(Crossing(BRIDGE, TRAIN, speed=speed, start=start))
    assert shown in str(caught.value)


def test_the_last_wheel_counts_too():
    """The head has left, the tail is still on the bridge."""
    result = run(Crossing(BRIDGE, Train.of(MASS, 2, 20.0), speed=30.0, start=30.0))
    assert result.contact_position[0, 1] == 10.0


class TestStructures:
    def test_a_mechanism_is_named(self):
        """A beam on one pin turns about it."""
        bridge = simple_span(elements=4, supports=[SupportAt(0.0)], **SPAN)
        for start in (-10.0, 5.0):
            with pytest.raises(
                InputError, match=r"'simple span': is a mechanism: it can move freely at n\d\.z"
            ):
                run(Crossing(bridge, TRAIN, speed=30.0, start=start), steps=400)

    def test_a_loose_part_is_named(self):
        model = Model().with_nodes([[0, 0], [5, 0], [0, 3], [5, 3]], ["a", "b", "c", "d"])
        beams = BeamProperties(bending_stiffness_y=1e9, mass_per_length=1e3)
        model = model.with_beams([[0, 1], [2, 3]], beams).with_support("a", ["z"]).with_support("b", ["z"])
        compiled = compile_model(model)
        structure = Structure(compiled.system, {"main": path_on_beams(model, compiled.table, ["a", "b"])})
        with pytest.raises(
            InputError, match=r"has a part that no support holds: it can move freely at [cd]\.z"
        ):
            run(Crossing(structure, TRAIN, speed=10.0))

    def test_nothing_that_could_move(self):
        clamped = [SupportAt(0.0, ("z", "ry")), SupportAt(25.0, ("z", "ry"))]
        bridge = simple_span(elements=1, supports=clamped, **SPAN)
        with pytest.raises(InputError, match="has no free degree of freedom"):
            run(Crossing(bridge, TRAIN, speed=30.0))

    def test_unknown_line(self):
        vehicle = Vehicle((ContactPoint("1", 0.0, "wheel1.z", "trak 2"),), MASS.system)
        two = Structure(BRIDGE.system, {"track 1": BRIDGE.line(), "track 2": BRIDGE.line()})
        with pytest.raises(InputError, match="Did you mean 'track 2'"):
            run(Crossing(two, Train.of(vehicle), speed=30.0))


class TestVehicles:
    def wagon(self, change):
        model = Model().with_nodes([[0, 1], [0, 0], [0, 3]], ["body", "wheel1", "wall"])
        model = model.with_mass("body", 1e3, directions=("z",)).with_springs([[0, 1], [2, 0]], {"z": 1e6})
        points = (ContactPoint("1", 0.0, "wheel1.z"),)
        return Vehicle(points, compile_model(change(model)).system, "wagon")

    def test_modal_damping(self):
        vehicle = self.wagon(lambda m: m.with_support("wall", ["z"]).with_damping(Modal(0.05)))
        with pytest.raises(InputError, match="damping = 'modal': is not available for vehicles"):
            run(Crossing(BRIDGE, Train.of(vehicle), speed=30.0))

    def test_loads(self):
        vehicle = self.wagon(lambda m: m.with_support("wall", ["z"]).with_load("body", "z", -10.0, np.sin))
        with pytest.raises(
            InputError, match="'wagon': has loads that change in time, which are not supported"
        ):
            run(Crossing(BRIDGE, Train.of(vehicle), speed=30.0))

    def test_supports_that_move(self):
        vehicle = self.wagon(lambda m: m.with_support("wall", motion={"z": Constant(0.1)}))
        with pytest.raises(InputError, match="'wagon': has supports that move"):
            run(Crossing(BRIDGE, Train.of(vehicle), speed=30.0))

    def test_mechanisms(self):
        model = Model().with_nodes([[0, 1], [0, 0]], ["body", "wheel1"])
        model = model.with_mass("body", 1e3, {"ry": 10.0}, directions=("z",)).with_springs(
            [[0, 1]], {"z": 1e6}
        )
        vehicle = Vehicle((ContactPoint("1", 0.0, "wheel1.z"),), compile_model(model).system, "unicycle")
        with pytest.raises(InputError, match=r"'unicycle': must stand on its wheels.*body\.ry"):
            run(Crossing(BRIDGE, Train.of(vehicle), speed=30.0))


class TestRunsThatFail:
    HEAVY = Crossing(BRIDGE, Train.of(rigid_mass(mass=2303.0 * 25.0)), speed=70.0)

    def test_divergence_keeps_what_was_computed(self):
        """Newmark, a moving mass and no footprint: the contact force grows without bound."""
        with pytest.raises(AnalysisError, match="the run diverged at step") as caught:
            simulate(
                self.HEAVY, time_step=2e-4, steps=1700, method=Alpha(0.0), footprint=0.0, sensors={"m": 12.5}
            )
        result, message = caught.value.result, str(caught.value)
        assert result.outcome.code == "failed"
        assert result.outcome.message == message
        assert "contact 1.1, d.o.f. 1.wheel1.z" in message
        assert "Use alpha = -0.1" in message
        n = result.facts["completed_steps"]
        assert 500 < n < 1700
        assert f"at step {n + 1}," in message
        np.testing.assert_allclose(result.time, 2e-4 * np.arange(n + 1))
        assert np.isfinite(result.contact_force).all()
        # Until shortly before, it is the run that stopped in time.
        early = simulate(
            self.HEAVY, time_step=2e-4, steps=n - 50, method=Alpha(0.0), footprint=0.0, sensors={"m": 12.5}
        )
        np.testing.assert_allclose(
            result.sensor_displacement[: n - 49], early.sensor_displacement, rtol=1e-12, atol=1e-15
        )
        assert result.checks["finite_values"] is False
        assert result.checks["largest_contact_force"]["1.1"] == pytest.approx(result.contact_force.max())

    def test_iteration_that_does_not_converge(self):
        """A wheel with far more mass than the bridge has around it."""
        light = simple_span(elements=8, **(SPAN | {"mass_per_length": 20.0}))
        crossing = Crossing(light, Train.of(rigid_mass(mass=5e3)), speed=20.0)
        with pytest.raises(AnalysisError, match="did not converge in 50 iterations") as caught:
            simulate(crossing, time_step=1e-2, steps=100, coupling="iterative", iteration=Iteration(limit=50))
        result = caught.value.result
        step = int(str(caught.value).split("step ")[1].split(",")[0])
        assert step > 2
        assert len(result.time) == step  # from time zero to the step before
        assert result.facts["completed_steps"] == step - 1
        assert np.isfinite(result.checks["largest_contact_force"]["1.1"])
        assert "Use the direct method" in str(caught.value)

    def test_a_failed_run_keeps_every_nth_step(self):
        with pytest.raises(AnalysisError) as caught:
            simulate(self.HEAVY, time_step=2e-4, steps=1700, method=Alpha(0.0), footprint=0.0, every=10)
        result = caught.value.result
        assert len(result.time) == result.facts["completed_steps"] // 10 + 1
        np.testing.assert_allclose(np.diff(result.time), 2e-3)
        assert np.abs(result.contact_force[-1]).max() > 0.0


class TestNotes:
    def notes(self, vehicle, **settings):
        return " / ".join(run(Crossing(BRIDGE, Train.of(vehicle), speed=30.0), **settings).facts["notes"])

    WHEEL = sprung_mass(mass=5750.0, stiffness=1.595e6, unsprung_mass=300.0)
    DASHPOT = sprung_mass(mass=5750.0, stiffness=1.595e6, damping=1e4)

    def test_defaults_are_told(self):
        assert self.notes(MASS) == ""
        assert "alpha = -0.1 by default, because wheels have mass" in self.notes(self.WHEEL)
        assert "footprint of 0.5 m by default" in self.notes(self.WHEEL)
        told = self.notes(self.DASHPOT)
        assert "because a dashpot ends at a massless contact point" in told
        assert "footprint" not in told

    def test_a_risky_choice_is_told(self):
        assert "warning: alpha = 0, but wheels have mass" in self.notes(self.WHEEL, method=Alpha(0.0))
        assert "warning" in self.notes(self.WHEEL, method=Alpha(-0.02))
        assert "warning" not in self.notes(self.WHEEL, method=Alpha(-0.1))
        assert "warning" not in self.notes(MASS, method=Alpha(0.0))
