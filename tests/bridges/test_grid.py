"""Beam grids: limits of right and skew decks, torsion, lines between girders, track in space."""

import math

import numpy as np
import pytest

import axlespan as asp
from axlespan.bridges import GridBeam, ballasted_track, beam_grid, simple_span, with_track
from axlespan.errors import InputError
from axlespan.linalg.eigen import lowest_modes
from axlespan.linalg.factor import factorize

E = 34e9
GIRDER = GridBeam(0.6, 0.02, 1.2, 4e3)
CROSS = GridBeam(0.05, 0.005, 0.3, 0.0)
RIGID = GridBeam(1e2, 1e2, 10.0, 0.0)
GRID = dict(
    length=24.0,
    girders=[-3.0, -1.0, 1.0, 3.0],
    girder=GIRDER,
    cross_beam=CROSS,
    youngs_modulus=E,
    elements=12,
)

ON_GIRDERS = {f"g{i}": y for i, y in enumerate(GRID["girders"])}


def under(structure, forces):
    """Displacements under downward forces {(line, position): force}."""
    system = structure.system
    load = np.zeros(system.size)
    for (line, at), force in forces.items():
        load -= force * structure.line(line).rows([at], system.size).toarray()[0]
    u = np.zeros(system.size)
    u[system.free] = factorize(system.partition.K_FF).solve(load[system.free])
    return u, load


def at(structure, u, line, position):
    return (structure.line(line).rows([position], structure.system.size) @ u)[0]


class TestRight:
    def test_equal_loads_on_all_girders_bend_them_as_beams(self):
        grid = beam_grid(**GRID, lines=ON_GIRDERS)
        u, _ = under(grid, {(f"g{i}", 12.0): 1e5 for i in range(4)})
        exact = -1e5 * 24.0**3 / (48 * E * 0.6)
        for i in range(4):
            assert at(grid, u, f"g{i}", 12.0) == pytest.approx(exact, rel=1e-9)

    def test_stiff_cross_beams_make_a_rigid_section(self):
        """Courbon: girder i takes 1/n + y_i e / Σ y²; a sine load keeps its shape along all girders."""
        girder = GridBeam(0.6, 0.0, 1.2, 4e3)
        grid = beam_grid(
            **{**GRID, "girder": girder, "cross_beam": GridBeam(1e4, 0.0, 10.0)},
            lines=ON_GIRDERS,
        )
        x = np.linspace(0.0, 24.0, 13)[1:-1]
        u, _ = under(grid, {("g3", float(s)): 1e4 * math.sin(math.pi * s / 24.0) for s in x})
        w = np.array([at(grid, u, f"g{i}", 12.0) for i in range(4)])
        y = np.array(GRID["girders"])
        shares = 0.25 + y * 3.0 / np.sum(y**2)
        np.testing.assert_allclose(w / w.sum(), shares, atol=2e-4)

    def test_torsion_of_girders_on_stiff_cross_beams(self):
        """Two girders on springs of their torsion alone: a couple over the middle twists both by T L / 4 G J / 2."""
        girder = GridBeam(0.01, 0.5, 1.0, 1.0)
        grid = beam_grid(
            length=20.0,
            girders=[-0.05, 0.05],
            girder=girder,
            cross_beam=RIGID,
            youngs_modulus=E,
            elements=10,
            lines={"a": 0.05, "b": -0.05},
        )
        u, _ = under(grid, {("a", 10.0): -2e7, ("b", 10.0): 2e7})
        twist = (at(grid, u, "a", 10.0) - at(grid, u, "b", 10.0)) / 0.1
        shear_modulus = E / 2.4
        # ends turn with the end beams, which the bearings of both girders hold
        assert twist == pytest.approx(2e6 * 20.0 / 4.0 / (2.0 * shear_modulus * 0.5), rel=5e-3)

    def test_first_frequency_is_that_of_the_whole_section(self):
        grid = beam_grid(**GRID)
        blocks = grid.system.partition
        found = lowest_modes(blocks.K_FF, blocks.M_FF, 1).frequencies[0]
        assert found == pytest.approx(math.pi / (2 * 24.0**2) * math.sqrt(E * 0.6 / 4e3), rel=1e-3)

    def test_lines_between_girders_share_by_the_lever_rule(self):
        grid = beam_grid(**GRID, lines={"between": 0.5, "g2": -1.0, "g3": 1.0})
        u, load = under(grid, {("between", 7.0): 1e5})
        other, same = under(grid, {("g2", 7.0): 0.25e5, ("g3", 7.0): 0.75e5})
        np.testing.assert_allclose(u, other, atol=1e-12)
        np.testing.assert_allclose(load, same, atol=1e-6)

    def test_tracks_beside_each_other(self):
        grid = beam_grid(**GRID, track_centers=[2.0, -2.0])
        names = ["main", "left", "right", "main2", "left2", "right2"]
        assert list(grid.lines) == [*names, "girder1", "girder2", "girder3", "girder4"]
        u, _ = under(grid, {("main", 12.0): 1e5})
        v, _ = under(grid, {("main2", 12.0): 1e5})
        assert at(grid, u, "main", 12.0) == pytest.approx(at(grid, v, "main2", 12.0), rel=1e-9)
        assert at(grid, u, "main2", 12.0) == pytest.approx(at(grid, v, "main", 12.0), rel=1e-9)


class TestSkew:
    def test_a_small_skew_is_nearly_none(self):
        right, skewed = (beam_grid(**GRID, skew=angle) for angle in (0.0, 1e-4))
        a, b = (at(grid, under(grid, {("main", 12.0): 1e5})[0], "main", 12.0) for grid in (right, skewed))
        assert b == pytest.approx(a, rel=1e-3)

    def test_left_and_right_mirror_each_other(self):
        one, other = (beam_grid(**GRID, skew=angle) for angle in (0.5, -0.5))
        u, load = under(one, {("left", 9.0 + 0.75 * math.tan(0.5)): 1e5})
        v, other_load = under(other, {("right", 9.0 + 0.75 * math.tan(0.5)): 1e5})

        def bearings(grid, u, load):
            found = ((grid.system.stiffness @ u) - load)[grid.system.prescribed]
            return {n: r for n, r in zip(grid.system.support_names, found, strict=True) if n.endswith(".z")}

        mirrored = {
            f"girder{5 - int(name[6])}{name[7:]}": r for name, r in bearings(other, v, other_load).items()
        }
        assert bearings(one, u, load) == pytest.approx(mirrored, rel=1e-6, abs=1.0)

    def test_obtuse_corners_take_more(self):
        s = ON_GIRDERS
        grid = beam_grid(**GRID, skew=math.radians(40.0), lines=s)
        slope = math.tan(math.radians(40.0))
        u, load = under(
            grid, {(name, y * slope + 2.0 * k): 1e4 for name, y in s.items() for k in range(1, 12)}
        )
        found = dict(
            zip(
                grid.system.support_names,
                ((grid.system.stiffness @ u) - load)[grid.system.prescribed],
                strict=True,
            )
        )
        # left girders begin ahead: the begin of the leftmost and the end of the rightmost are the obtuse corners
        assert found["girder4.begin.z"] > 1.05 * found["girder1.begin.z"]
        assert found["girder1.end.z"] == pytest.approx(found["girder4.begin.z"], rel=1e-6)
        assert sum(v for n, v in found.items() if n.endswith(".z")) == pytest.approx(44e4)

    def test_lines_begin_where_the_deck_does(self):
        grid = beam_grid(**GRID, skew=0.6)
        assert grid.line("left").start == pytest.approx(0.75 * math.tan(0.6))
        assert grid.line("main").start == 0.0


class TestTrackInSpace:
    def test_a_deck_of_two_girders_under_two_rails_is_the_plane_bridge(self):
        """Each rail over a girder of half the deck: nothing rolls.

        Sleepers stand between the nodes of the grid, whose cubics lack the local bending under each of them.
        """
        half = GridBeam(0.6, 0.02, 1.2, 4e3)
        grid = beam_grid(
            length=24.0, girders=[-0.75, 0.75], girder=half, cross_beam=CROSS, youngs_modulus=E, elements=20
        )
        space = with_track(grid, ballasted_track())
        flat = with_track(
            simple_span(length=24.0, youngs_modulus=E, second_moment=1.2, mass_per_length=8e3, elements=20),
            ballasted_track(),
        )
        for place in (3.3, 12.0, -4.0):
            u, _ = under(space, {("left", place): 60e3, ("right", place): 60e3})
            v, _ = under(flat, {("main", place): 120e3})
            for line in ("left", "right", "main"):
                assert at(space, u, line, place) == pytest.approx(at(flat, v, "main", place), rel=2e-5)
            assert at(space, u, "deck", 12.0) == pytest.approx(at(flat, v, "deck", 12.0), rel=2e-5)

    def test_a_crossing_on_a_skew_deck(self):
        grid = beam_grid(**GRID, skew=0.4, damping=asp.Rayleigh.from_ratio(0.01, (5.0, 20.0)))
        bridge = with_track(grid, ballasted_track())
        loads = asp.vehicles.axle_loads(loads=150e3, positions=[0.0, 2.5])
        result = asp.simulate(
            asp.Crossing(bridge, asp.Train.of(loads), speed=50.0),
            time_step=2e-3,
            steps=300,
            sensors={"midspan": 12.0, "left": ("left", 12.0)},
        )
        assert result.checks["equilibrium_residual"] < 1e-8
        assert -5e-3 < result.sensor_displacement[:, 0].min() < -5e-4

    def test_a_deck_with_beams_across_its_ends_only(self):
        """Its cross beams inside the span are none; the load of both rails comes to the bearings."""
        grid = beam_grid(**{**GRID, "cross_beams": 1})
        track = with_track(grid, ballasted_track(), approach=30.0, exit=30.0)
        u, load = under(track, {("left", 12.0): 1e5, ("right", 12.0): 1e5})
        pushed = track.system.stiffness @ u - load
        held = track.system.prescribed[[name.endswith(".z") for name in track.system.support_names]]
        assert pushed[held].sum() == pytest.approx(2e5, rel=1e-6)

    def test_a_deck_without_lines_under_the_rails(self):
        grid = beam_grid(**GRID, lines={"main": 0.0})
        with pytest.raises(
            InputError,
            match="line = 'left': is no running line of beam grid; a track in space",
        ):
            with_track(grid, ballasted_track())


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"girders": [1.0]}, "girders = [1.0]: must be at least two positions, from right to left"),
        (
            {"girders": [1.0, -1.0]},
            "girders = [1.0, -1.0]: must be at least two positions, from right to left",
        ),
        ({"cross_beams": 5}, "cross_beams = 5: must divide the 12 elements of a girder"),
        (
            {"skew": 45.0},
            "skew = 45.0: must be at most 60 deg to either side. It is an angle in rad from the perpendicular of the axis",
        ),
        ({"lines": {"main": 4.0}}, "lines.main = 4.0: must lie between the outer girders, -3 and 3 m"),
        ({"girder": [GIRDER]}, "girder = 1: must be one or one for each of the 4 girders"),
        ({"length": -1.0}, "length = -1.0: must be positive"),
    ],
)
def test_bad_input(change, message):
    with pytest.raises(InputError) as caught:
        beam_grid(**{**GRID, **change})
    assert str(caught.value) == message
