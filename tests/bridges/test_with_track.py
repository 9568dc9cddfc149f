"""Bridges under track: statics, reactions, section forces, trains that come from rigid ground."""

import warnings

import numpy as np
import pytest

import axlespan as asp
from axlespan.bridges import (
    Zone,
    ballasted_track,
    least_approach,
    simple_span,
    simple_spans,
    slab_track,
    track_on_ground,
    usual_approach,
    with_track,
)
from axlespan.bridges.condition import in_condition
from axlespan.errors import InputError
from axlespan.linalg.factor import factorize

DECK = dict(length=24.0, youngs_modulus=34e9, second_moment=2.0, mass_per_length=15e3, elements=24)
STIFF = dict(length=24.0, youngs_modulus=34e9, second_moment=2.0, mass_per_length=15e3, elements=24)


def coach():
    """Two axles on primary springs under one body, 150 kN each."""
    return asp.vehicles.multibody(
        bodies=[asp.vehicles.Body("body", mass=27e3, inertia=3e5, position=4.0)],
        wheels=[asp.vehicles.Wheel(0.0, mass=1800.0), asp.vehicles.Wheel(8.0, mass=1800.0)],
        suspensions=[
            asp.vehicles.Suspension(("body", f"wheel{i}"), stiffness=1.2e6, damping=40e3) for i in (1, 2)
        ],
    )


def static(structure, forces, line="main"):
    """Displacements (all d.o.f.) under downward forces {position: force} on the rails."""
    system, path = structure.system, structure.line(line)
    load = np.zeros(system.size)
    for at, force in forces.items():
        load -= force * path.rows([at], system.size).toarray()[0]
    u = np.zeros(system.size)
    u[system.free] = factorize(system.partition.K_FF).solve(load[system.free])
    return u


class TestStatics:
    @pytest.mark.parametrize("track", [ballasted_track(), slab_track()])
    def test_the_deck_feels_the_pressures_of_the_supports(self, track):
        """Forces of the springs on the deck, as point loads on the closed form of a simple beam."""
        bridge = with_track(simple_span(**DECK), track)
        u = static(bridge, {12.0: 200e3})
        full = bridge.system.elimination @ u
        name = {number: i for i, number in enumerate(bridge.system.dof_names)}
        last = next(part for part in bridge.model.parts if part.name in ("ballast", "mortar"))
        w = []
        loads = []
        for (low, up), k in zip(last.nodes, last.stiffness[:, 0], strict=True):
            x = bridge.model.points[low, 0]
            lower, upper = (bridge.model.node_label(int(i)) + ".z" for i in (low, up))
            if 0.0 < x < 24.0 and lower in name:
                loads.append((x, k * (full[name[lower]] - full[name[upper]])))
        a, b = np.array([x for x, _ in loads]), 12.0
        forces = np.array([p for _, p in loads])
        assert len(loads) >= 36
        low, high = np.minimum(a, b), np.maximum(a, b)
        influence = low * (24.0 - high) * (24.0**2 - low**2 - (24.0 - high) ** 2) / (6.0 * 24.0 * 34e9 * 2.0)
        exact = -(influence @ forces)
        w = (bridge.line("deck").rows([b], bridge.system.size) @ u)[0]
        assert w == pytest.approx(exact, rel=1e-6)

    def test_a_long_bridge_under_stiff_track_bends_as_without_it(self):
        deck = {**DECK, "length": 60.0, "elements": 60, "second_moment": 8.0}
        bridge = with_track(simple_span(**deck), ballasted_track())
        u = static(bridge, {30.0: 200e3})
        w = (bridge.line("deck").rows([30.0], bridge.system.size) @ u)[0]
        assert w == pytest.approx(-200e3 * 60.0**3 / (48.0 * 34e9 * 8.0), rel=0.01)

    def test_all_that_stands_on_the_rails_comes_to_the_supports(self):
        bridge = with_track(simple_span(**DECK), ballasted_track(), approach=30.0, exit=30.0)
        u = static(bridge, {5.0: 120e3, -8.0: 80e3})
        reactions = bridge.system.stiffness[bridge.system.prescribed] @ u
        assert bridge.system.support_names == ("left.z", "right.z", "approach.z", "exit.z")
        assert reactions.sum() == pytest.approx(200e3, rel=1e-9)
        assert reactions[2] == pytest.approx(80e3, rel=0.01)

    def test_a_free_position_of_the_grid_is_a_node_of_the_deck(self):
        bridge = with_track(simple_span(**{**DECK, "elements": 7}), ballasted_track())
        breaks = bridge.line("deck").breaks
        sleepers = 0.3 + 0.6 * np.arange(40)
        assert np.all(np.abs(sleepers[:, None] - breaks).min(axis=1) < 1e-9)
        assert len(breaks) == 40 + 2  # the inner nodes of the seven beams moved to sleepers

    def test_a_narrow_band(self):
        bridge = with_track(
            simple_span(**{**DECK, "length": 40.2, "elements": 67}), ballasted_track(), rail_elements=2
        )
        stiffness = bridge.system.partition.K_FF.tocoo()
        there = stiffness.data != 0.0
        assert np.abs(stiffness.row - stiffness.col)[there].max() <= 12


class TestLines:
    def test_rails_run_on_before_and_behind(self):
        bridge = with_track(simple_span(**DECK), ballasted_track(), approach=30.0, exit=36.0)
        rail, deck = bridge.line(), bridge.line("deck")
        assert (rail.start, deck.start, deck.stop) == (-30.0, 0.0, 24.0)
        assert rail.stop == pytest.approx(60.0)
        assert bridge.line("rail") is rail
        assert bridge.sensor_line == "deck"

    def test_lengths_are_made_longer_up_to_whole_spacings(self):
        bridge = with_track(
            simple_span(**{**DECK, "length": 23.9}), ballasted_track(), approach=30.1, exit=30.0
        )
        assert bridge.line().start == pytest.approx(-30.6)
        assert bridge.line().stop == pytest.approx(54.0)

    def test_the_usual_approach(self):
        track = ballasted_track("railfe")
        assert least_approach(track) == pytest.approx(15.0 + 10.0 * track.characteristic_length)
        assert usual_approach(track) == np.ceil(least_approach(track) + 25.0)

    def test_rails_are_continuous_over_joints_where_decks_turn(self):
        decks = simple_spans(
            spans=[20.4, 20.4], youngs_modulus=34e9, second_moment=1.5, mass_per_length=12e3, elements=17
        )
        bridge = with_track(decks, ballasted_track())
        u = static(bridge, {at: 150e3 for at in (8.0, 11.0, 29.8, 32.8)})
        eps = 1e-9

        def slopes(line):
            rows = bridge.line(line).rows([20.4 - eps, 20.4 + eps], bridge.system.size, 1)
            return rows @ u

        before, after = slopes("deck")
        assert after < 0.0 < before  # the ends turn toward the spans
        assert after == pytest.approx(-before, rel=1e-6)
        assert np.ptp(slopes("rail")) < 1e-9
        names = bridge.system.support_names
        assert names[:4] == ("span1.left.z", "span1.right.z", "span2.left.z", "span2.right.z")


class TestDamping:
    def test_rayleigh_damping_of_the_deck_is_of_the_deck(self):
        alpha, beta = 0.3, 2e-4
        damped, plain = (
            with_track(simple_span(**DECK, damping=damping), ballasted_track())
            for damping in (asp.Rayleigh(alpha, beta), None)
        )
        shape = np.zeros(damped.system.size)
        deck = damped.line("deck")
        rows = deck.rows(deck.breaks[1:-1], damped.system.size).toarray()
        dofs = np.flatnonzero(np.abs(rows).max(axis=0))
        x = deck.breaks[1:-1]
        shape[dofs] = np.sin(np.pi * x / 24.0)[np.argmax(np.abs(rows[:, dofs]), axis=0)]
        difference = damped.system.damping - plain.system.damping
        rail = damped.line().rows(damped.line().breaks[3:-3], damped.system.size).toarray()
        on_rail = np.flatnonzero(np.abs(rail).max(axis=0))
        assert np.abs(difference[on_rail]).max() == 0.0
        assert shape @ difference @ shape > 0.0

    def test_modal_damping_of_the_deck_is_that_of_its_own_modes(self):
        bridge = simple_span(**DECK, damping=asp.Modal(0.01))
        tracked = with_track(bridge, ballasted_track())
        vectors = tracked.system.modal_damping.vectors
        assert len(vectors) == len(tracked.system.free)
        rail = tracked.line().rows(tracked.line().breaks, tracked.system.size)[:, tracked.system.free]
        assert np.abs(rail @ vectors).max() == 0.0
        np.testing.assert_allclose(
            tracked.system.modal_damping.coefficients[0],
            2.0 * 0.01 * np.pi**2 / 24.0**2 * np.sqrt(34e9 * 2.0 / 15e3),
            rtol=1e-4,
        )


class TestCrossing:
    def test_a_train_on_rigid_ground_feels_nothing_until_the_track_begins(self):
        track = track_on_ground(ballasted_track(), 60.0)
        crossing = asp.Crossing(track, asp.Train.of(coach()), speed=60.0, start=-60.0)
        result = asp.simulate(crossing, time_step=1e-3, steps=1050)
        before = result.contact_position[:, 0] < -0.2
        assert before.sum() > 900
        load = coach().static_forces(9.81)
        np.testing.assert_allclose(result.contact_force[before], np.tile(load, (before.sum(), 1)), rtol=1e-9)

    def test_on_homogeneous_track_the_force_settles_to_the_static_one(self):
        track = track_on_ground(ballasted_track(), 150.0, rail_elements=4)
        crossing = asp.Crossing(track, asp.Train.of(coach()), speed=70.0, start=-5.0)
        step = 5e-4
        result = asp.simulate(crossing, time_step=step, steps=int(2.0 / step))
        load = coach().static_forces(9.81)[0]
        force, where = result.contact_force[:, 0], result.contact_position[:, 0]
        settled = (where > 60.0) & (where < 120.0)
        assert np.abs(force[settled] / load - 1.0).max() < 0.01  # sleeper passing included
        whole = (where > 60.0) & (where < 60.0 + 0.6 * 60)
        assert force[whole].mean() == pytest.approx(load, rel=2e-3)

    def test_the_settled_deflection_is_the_static_one(self):
        track = track_on_ground(ballasted_track(), 60.0)
        crossing = asp.Crossing(track, asp.Train.of(coach()), speed=15.0, start=15.0)
        sensors = {"between": 30.0, "over": ("rail", 30.3)}
        result = asp.simulate(crossing, time_step=1e-3, steps=1300, sensors=sensors, footprint=0.0)
        load = coach().static_forces(9.81)[0]
        for sensor, at in enumerate((30.0, 30.3)):
            rows = track.line().rows([at], track.system.size)
            still = (rows @ static(track, {at: load, at - 8.0: load}))[0]
            deepest = result.sensor_displacement[:, sensor].min()
            assert deepest == pytest.approx(still, rel=2e-3)

    def test_wheels_are_let_down_gently(self):
        track = track_on_ground(ballasted_track(), 60.0)
        crossing = asp.Crossing(track, asp.Train.of(coach()), speed=80.0, start=-10.0)
        result = asp.simulate(crossing, time_step=5e-4, steps=1400)
        load = coach().static_forces(9.81)[0]
        assert np.abs(result.contact_force / load - 1.0).max() < 0.02
        hard = track_on_ground(ballasted_track(), 60.0, run_in=0.0)
        result = asp.simulate(
            asp.Crossing(hard, asp.Train.of(coach()), speed=80.0, start=-10.0), time_step=5e-4, steps=1400
        )
        assert np.abs(result.contact_force / load - 1.0).max() > 0.08

    def test_a_longer_approach_changes_nothing_on_the_bridge(self):
        responses = []
        for approach in (None, 150.0):
            bridge = with_track(simple_span(**DECK), ballasted_track(), approach=approach)
            crossing = asp.Crossing(bridge, asp.Train.of(coach()), speed=75.0, start=-170.0)
            result = asp.simulate(crossing, time_step=1e-3, steps=2700, sensors={"midspan": 12.0})
            responses.append(result)
        one, other = responses
        largest = np.abs(one.sensor_displacement).max()
        assert np.abs(one.sensor_displacement - other.sensor_displacement).max() < 2e-3 * largest
        largest = np.abs(one.sensor_acceleration).max()
        assert np.abs(one.sensor_acceleration - other.sensor_acceleration).max() < 0.01 * largest

    def test_shear_of_the_deck_at_its_bearing_is_the_reaction(self):
        damping = asp.Rayleigh.from_ratio(0.01, (5.0, 20.0))
        bridge = with_track(simple_span(**DECK, damping=damping), ballasted_track())
        crossing = asp.Crossing(bridge, asp.Train.of(coach()), speed=60.0, start=-5.0)
        sensors = {"bearing": 0.0, "midspan": 12.0, "rail": ("rail", -3.0)}
        result = asp.simulate(
            crossing,
            time_step=1e-3,
            steps=600,
            sensors=sensors,
            section_forces=["rail", "bearing", "midspan"],
        )
        reaction = result.support_reaction[:, result.support.index("left.z")]
        scale = np.abs(reaction).max()
        np.testing.assert_allclose(result.section_shear[:, 1], reaction, atol=1e-9 * scale)
        assert result.section == ("rail", "bearing", "midspan")
        assert np.abs(result.section_moment[:, 2]).max() > 10.0 * np.abs(result.section_moment[:, 0]).max()

    def test_envelopes_are_those_of_the_deck(self):
        bridge = with_track(simple_span(**DECK), ballasted_track())
        crossing = asp.Crossing(bridge, asp.Train.of(coach()), speed=60.0)
        breaks = bridge.line("deck").breaks
        near = float(breaks[np.argmin(np.abs(breaks - 12.0))])
        result = asp.simulate(
            crossing, time_step=2e-3, steps=250, sensors={"near": near}, envelopes=["deflection", "moment"]
        )
        assert (result.envelopes.position[0], result.envelopes.position[-1]) == (0.0, 24.0)
        at = np.argmin(np.abs(result.envelopes.position - near))
        lowest = result.envelopes.of("deflection").smallest[at]
        assert lowest == pytest.approx(result.sensor_displacement.min(), rel=1e-9)

    def test_every_check_of_a_run_passes(self):
        bridge = with_track(simple_span(**DECK), ballasted_track())
        crossing = asp.Crossing(bridge, asp.Train.of(coach(), count=3, spacing=12.0), speed=70.0)
        result = asp.simulate(crossing, time_step=1e-3, steps=1000)
        assert result.checks["equilibrium_residual"] < 1e-8
        assert result.checks["energy_residual"] < 1e-8
        assert result.checks["compatibility_residual"] < 1e-12


class TestBadInput:
    def test_sensors_off_the_deck(self):
        bridge = with_track(simple_span(**DECK), ballasted_track())
        crossing = asp.Crossing(bridge, asp.Train.of(coach()), speed=60.0)
        with pytest.raises(InputError) as caught:
            asp.simulate(crossing, time_step=1e-3, steps=10, sensors={"ground": -5.0})
        assert str(caught.value) == (
            "sensors.ground = -5.0: must lie on the deck, between 0 and 24 m. Sensors on the rails name their line: "
            "{at: -5 m, line: rail}"
        )
        with pytest.raises(
            InputError, match=r"sensors\.a\.line = 'rial': is not a known running line. Did you mean 'rail'"
        ):
            asp.simulate(crossing, time_step=1e-3, steps=10, sensors={"a": ("rial", 1.0)})

    def test_an_approach_that_is_too_short(self):
        with pytest.warns(
            UserWarning, match="approach = 18 m is shorter than the run-in of 15 m and 10 characteristic"
        ):
            with_track(simple_span(**DECK), ballasted_track(), approach=18.0)
        with pytest.raises(InputError, match=r"approach = 5\.0: must be longer than the run-in, 15 m"):
            with_track(simple_span(**DECK), ballasted_track(), approach=5.0)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with_track(simple_span(**DECK), ballasted_track(), approach=24.0)

    def test_a_spacing_longer_than_the_bridge(self):
        small = simple_span(**{**DECK, "length": 0.5, "elements": 2})
        with pytest.raises(
            InputError, match=r"sleeper_spacing = 0\.6: must be shorter than the bridge, 0\.5 m"
        ):
            with_track(small, ballasted_track())

    def test_a_bridge_of_matrices(self):
        bridge = simple_span(**DECK)
        bare = asp.Structure(bridge.system, bridge.lines, "matrices")
        with pytest.raises(InputError, match="must be a finite element model: matrices is given by matrices"):
            with_track(bare, ballasted_track())

    def test_springs_that_follow_a_law_already(self):
        """Track is laid and stiffness changed before laws are given; a law in the model itself stays."""
        bearings = [
            asp.bridges.SupportAt(x, name=n, stiffness={"z": 1e9}) for x, n in ((0.0, "a"), (24.0, "b"))
        ]
        bridge = simple_span(**{**DECK, "length": 24.0, "supports": bearings})
        lifting = asp.bridges.with_unilateral_springs(bridge, "support a")
        message = "'support a': follows a law already, which would be lost. Give laws last"
        with pytest.raises(InputError, match=f"bridge = {message}"):
            with_track(lifting, ballasted_track())
        with pytest.raises(InputError, match=f"structure = {message}"):
            in_condition(lifting, stiffness=0.9)
        track = asp.bridges.with_unilateral_springs(with_track(bridge, ballasted_track()), "support a")
        assert [springs.name for springs in track.system.nonlinear] == ["support a"]

    def test_a_zone_off_the_track(self):
        with pytest.raises(InputError, match=r"zones\.0 = '200 to 210 m': lies off the track"):
            with_track(simple_span(**DECK), ballasted_track(), zones=[Zone(200.0, 210.0, 2.0)])


class TestSpace:
    def test_wheels_left_and_right_carry_half_of_a_plane_wheel(self):
        vehicle = asp.vehicles.multibody(
            bodies=[asp.vehicles.Body("body", mass=27e3, inertia=3e5, position=4.0, roll_inertia=4e4)],
            wheels=[asp.vehicles.Wheel(at, mass=1800.0, gauge=1.5, roll_inertia=900.0) for at in (0.0, 8.0)],
            suspensions=[
                asp.vehicles.Suspension(("body", f"wheel{i}"), stiffness=0.6e6, damping=20e3, spread=2.0)
                for i in (1, 2)
            ],
        )
        motion = dict(time_step=1e-3, steps=900, sensors={"left": ("left", 40.2), "right": ("right", 40.2)})
        space = track_on_ground(ballasted_track(), 60.0, space=True)
        result = asp.simulate(asp.Crossing(space, asp.Train.of(vehicle), speed=60.0), **motion)
        plane = track_on_ground(ballasted_track(), 60.0)
        sensors = {"rail": 40.2}
        flat = asp.simulate(
            asp.Crossing(plane, asp.Train.of(coach()), speed=60.0), **{**motion, "sensors": sensors}
        )
        one, other = (result.sensor_displacement[:, i] for i in range(2))
        deepest = np.abs(one).max()
        np.testing.assert_allclose(one, other, atol=1e-9 * deepest)
        np.testing.assert_allclose(one, flat.sensor_displacement[:, 0], atol=1e-6 * deepest)
        np.testing.assert_allclose(result.contact_force[:, 0], 0.5 * flat.contact_force[:, 0], rtol=1e-5)
