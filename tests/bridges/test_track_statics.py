"""Track at rest: Winkler's rail, layers, presets, run-in, transition zones."""

import numpy as np
import pytest

from axlespan.bridges import (
    PRESETS,
    RAILS,
    Layer,
    Track,
    Zone,
    ballasted_track,
    slab_track,
    track_on_ground,
)
from axlespan.errors import InputError
from axlespan.linalg.eigen import lowest_modes
from axlespan.linalg.factor import factorize

RAIL = RAILS["60E1"]


def bare(spacing, modulus, rail=RAIL):
    """Rails on one spring per support: Winkler's beam, in points."""
    layer = Layer("ballast", modulus * spacing)
    return Track(rail, spacing, (layer,), (layer,))


def deflections(structure, forces, positions, line="main"):
    """Displacements at positions under forces {position: downward}, from the matrices alone."""
    system, path = structure.system, structure.line(line)
    load = np.zeros(system.size)
    for at, force in forces.items():
        load -= force * path.rows([at], system.size).toarray()[0]
    u = np.zeros(system.size)
    u[system.free] = factorize(system.partition.K_FF).solve(load[system.free])
    return path.rows(positions, system.size) @ u, u


class TestWinkler:
    """domain: 60E1 on 50 MN/m2 under 85 kN: w0 = 1.00562 mm, M0 = 17.9616 kNm; here both rails, 170 kN on 100."""

    def test_close_supports_are_a_continuous_foundation(self):
        track = track_on_ground(bare(0.05, 100e6), 40.0, run_in=0.0, rail_elements=1)
        (depth,), _ = deflections(track, {20.0: 170e3}, [20.0])
        assert depth == pytest.approx(-1.00562e-3, rel=2e-4)

    def test_moment_under_the_wheel(self):
        track = track_on_ground(bare(0.05, 100e6), 40.0, run_in=0.0, rail_elements=1)
        x = 20.0 + 0.05 * np.arange(-3, 4)
        w, _ = deflections(track, {20.0: 170e3}, x)
        # M = -EI w''; the moment has its kink at the force, so half the force's share comes from each side
        curvature = (w[4] - 2.0 * w[3] + w[2]) / 0.05**2
        peak = 2.0 * 17.9616e3 - 170e3 * 0.05 / 6.0  # mean over the element's hat function
        assert 2.0 * RAIL.bending_stiffness * curvature == pytest.approx(peak, rel=2e-3)

    def test_the_trough_fades_as_winkler_says(self):
        track = track_on_ground(bare(0.05, 100e6), 40.0, run_in=0.0, rail_elements=1)
        beta = (100e6 / (8.0 * RAIL.bending_stiffness)) ** 0.25
        assert beta == pytest.approx(1.18308, rel=1e-5)
        away = np.linspace(0.0, 5.0, 11)
        w, _ = deflections(track, {20.0: 170e3}, 20.0 + away)
        exact = -1.00562e-3 * np.exp(-beta * away) * (np.cos(beta * away) + np.sin(beta * away))
        np.testing.assert_allclose(w, exact, atol=2e-4 * 1.00562e-3)

    def test_sleepers_at_0_6_m_differ_by_less_than_a_percent_in_the_mean(self):
        track = track_on_ground(bare(0.6, 100e6), 39.0, run_in=0.0, rail_elements=4)
        over, between = (deflections(track, {at: 170e3}, [at])[0][0] for at in (19.5, 19.8))
        assert abs(over) < 1.00562e-3 < abs(between)
        assert 0.5 * (over + between) == pytest.approx(-1.00562e-3, rel=0.01)

    def test_characteristic_length_and_modulus_of_layers_in_series(self):
        track = ballasted_track("railfe")
        assert track.foundation_modulus() == pytest.approx(1.0 / (0.6 * (1 / 400e6 + 1 / 80e6)))
        assert 1.0 / bare(0.6, 100e6).characteristic_length == pytest.approx(1.18308, rel=1e-5)


class TestLayers:
    def test_two_rails_carry_what_two_seats_give(self):
        values = PRESETS["zhai-2004"].values
        track = ballasted_track()
        pads, ballast, subgrade = track.layers
        assert (pads.stiffness, ballast.stiffness, subgrade.stiffness) == (130e6, 275.5e6, 155e6)
        assert (pads.mass, ballast.mass) == (251.0, 1062.8)  # a whole sleeper, ballast of two seats
        assert track.bending_stiffness == 2.0 * 2.059e11 * 3.217e-5
        assert ballasted_track("ttb-2d").layers[0].stiffness == 0.5 * values["pad_stiffness"]

    def test_presets_name_their_sources_and_what_is_to_be_checked(self):
        assert all(
            "19" in p.source or "20" in p.source or "typical" in p.source or "railFE" in p.source
            for p in PRESETS.values()
        )
        assert PRESETS["zhai-2004"].to_check == {"shear_stiffness", "shear_damping"}
        assert not RAILS["60E1"].to_check
        assert RAILS["54E1"].to_check

    def test_a_pinned_pinned_mode_has_its_frequency(self):
        track = bare(0.6, 1e12)
        model = track_on_ground(track, 36.0, run_in=0.0, rail_elements=6)
        lowest = lowest_modes(model.system.partition.K_FF, model.system.partition.M_FF, 1).frequencies[0]
        ratio = np.pi / 2.0 * np.sqrt(RAIL.bending_stiffness / RAIL.mass_per_length) / 0.36
        assert track.pinned_pinned_frequency == pytest.approx(ratio)
        assert lowest == pytest.approx(ratio, rel=3e-3)

    def test_mass_of_all_that_moves(self):
        model = track_on_ground(ballasted_track(), 60.0)
        rails = 2 * 60.64 * (60.0 - 0.3)  # half of the two clamped elements' mass goes to the ground
        assert model.system.total_mass() == pytest.approx(rails + 100 * (251.0 + 1062.8), rel=2e-3)

    def test_slab_track_in_panels_is_softer_at_the_joints(self):
        soft = dict(foundation_modulus=50e6)
        one, panels = (
            track_on_ground(slab_track(**soft, panel_length=length), 65.0, run_in=10.0)
            for length in (None, 6.5)
        )
        at = 32.5
        whole, jointed = (deflections(model, {at: 170e3}, [at])[0][0] for model in (one, panels))
        assert abs(jointed) > 1.1 * abs(whole)

    def test_slab_spreads_a_wheel_as_two_beams_on_springs(self):
        """Rails on fastenings on a slab on its foundation: Fourier integral of the coupled beams."""
        track = slab_track()
        k_f, k_s = (layer.stiffness / track.spacing for layer in track.layers)
        rail, slab = track.bending_stiffness, track.layers[0].bending_stiffness
        q = np.linspace(0.0, 60.0, 60001)
        lower = slab * q**4 + k_s
        compliance = (lower + k_f) / ((rail * q**4 + k_f) * lower + k_f * rail * q**4)
        exact = -170e3 / np.pi * np.trapezoid(compliance, q)
        model = track_on_ground(track, 78.0, rail_elements=4)
        at = 39.0 + track.spacing * np.array([0.0, 0.5])
        w = [deflections(model, {x: 170e3}, [x])[0][0] for x in at]
        assert np.mean(w) == pytest.approx(exact, rel=0.01)


class TestRunIn:
    def test_the_trough_grows_smoothly_from_nothing(self):
        model = track_on_ground(ballasted_track(shear_stiffness=0.0), 90.0, run_in=15.0)
        x = np.arange(0.6, 30.0, 0.6)
        w = np.array([deflections(model, {at: 150e3}, [at])[0][0] for at in x])
        xi = np.clip(x / 15.0, 0.0, 1.0)
        course = w[-1] * xi**3 * (10.0 - 15.0 * xi + 6.0 * xi**2)
        np.testing.assert_allclose(w, course, atol=0.03 * abs(w[-1]))

    def test_ends_are_held_by_the_ground(self):
        model = track_on_ground(ballasted_track(), 60.0)
        dofs, weights = model.line().weights(np.array([0.0, 60.0]))
        assert np.all(np.isin(dofs[weights != 0.0], model.system.prescribed))


class TestZones:
    def test_factors_act_on_the_supports_inside(self):
        plain = track_on_ground(bare(0.6, 100e6), 60.0)
        stiff = track_on_ground(bare(0.6, 100e6), 60.0, zones=[Zone(24.0, 36.0, (1.0, 4.0))])
        springs = [next(p for p in model.model.parts if p.name == "ballast") for model in (plain, stiff)]
        ratio = springs[1].stiffness[:, 0] / springs[0].stiffness[:, 0]
        x = 0.6 * (np.arange(100) + 0.5)
        inside = (x > 24.0) & (x < 36.0)
        np.testing.assert_allclose(ratio, np.where(inside, 1.0 + 3.0 * (x - 24.0) / 12.0, 1.0))

    def test_hanging_sleepers_let_the_rail_sag_more(self):
        plain = track_on_ground(ballasted_track(), 60.0)
        void = track_on_ground(ballasted_track(), 60.0, zones=[Zone(29.0, 31.0, 0.0)])
        depths = [deflections(model, {30.0: 150e3}, [30.0])[0][0] for model in (plain, void)]
        assert depths[1] < 1.5 * depths[0]

    def test_two_zones_multiply(self):
        zones = [Zone(20.0, 40.0, 2.0), Zone(20.0, 40.0, 3.0)]
        model = track_on_ground(bare(0.6, 100e6), 60.0, zones=zones)
        spring = next(part for part in model.model.parts if part.name == "ballast")
        assert spring.stiffness[50, 0] == pytest.approx(6.0 * 60e6)


class TestSpace:
    def test_equal_wheels_on_both_rails_are_the_plane_track(self):
        plane = track_on_ground(ballasted_track(), 60.0)
        space = track_on_ground(ballasted_track(), 60.0, space=True)
        (flat,), _ = deflections(plane, {30.3: 150e3}, [30.3])
        (both,), _ = deflections(space, {30.3: 150e3}, [30.3])
        assert both == pytest.approx(flat, rel=1e-9)

    def test_one_loaded_rail_rolls_the_sleepers(self):
        space = track_on_ground(ballasted_track(), 60.0, space=True)
        (left,), u = deflections(space, {30.3: 75e3}, [30.3], "left")
        right = (space.line("right").rows([30.3], space.system.size) @ u)[0]
        assert left < 5.0 * abs(right) * -1.0
        # a rigid sleeper on equal seats: what one seat feels of the other is what roll and heave leave
        (mean,), _ = deflections(space, {30.3: 150e3}, [30.3])
        assert 0.5 * (left + right) == pytest.approx(0.5 * mean, rel=1e-9)


class TestBadInput:
    @pytest.mark.parametrize(
        ("values", "message"),
        [
            ({"sleeper_spacing": -0.6}, "sleeper_spacing = -0.6: must be positive"),
            ({"sleeper_spacing": 6.0}, "sleeper_spacing = 6.0: must be at most 3 m. 0.6 m is usual"),
            ({"pad_stiffness": 0.0}, "pad_stiffness = 0.0: must be positive"),
            (
                {"preset": "zhai2004"},
                "preset = 'zhai2004': is not a known preset of ballasted track. Did you mean 'zhai-2004'?",
            ),
            ({"preset": "slab"}, "preset = 'slab': is one of slab track. Known: zhai-2004, ttb-2d, railfe"),
            ({"preset": None}, "sleeper_spacing: is missing. Give it, or name a preset"),
            ({"rail": "60E2"}, "rail = '60E2': is not a known rail. Did you mean '60E1'?"),
            ({"subgrade_stiffness": -1.0}, "subgrade_stiffness = -1.0: must be zero or positive"),
        ],
    )
    def test_of_tracks(self, values, message):
        with pytest.raises(InputError) as caught:
            ballasted_track(**values)
        assert str(caught.value) == message

    @pytest.mark.parametrize(
        ("length", "more", "message"),
        [
            (60.1, {}, "length = 60.1: must be a whole number of spacings, 0.6 m. Use 60 m"),
            (20.0, {}, "length = 20.0: must be longer than its two run-ins, 30 m"),
            (60.0, {"run_in": -1.0}, "run_in = -1.0: must be zero or positive"),
            (60.0, {"rail_elements": 0}, "rail_elements = 0: must be from 1 to 20. Use 2"),
            (
                60.0,
                {"zones": [Zone(70.0, 80.0, 2.0)]},
                "zones.0 = '70 to 80 m': lies off the track, which goes from 0 to 60 m",
            ),
            (
                60.0,
                {"zones": [Zone(20.0, 30.0, 2.0, "balast")]},
                "zones.0.layer = 'balast': is not a known layer of this track. Did you mean 'ballast'?",
            ),
        ],
    )
    def test_of_track_on_the_ground(self, length, more, message):
        with pytest.raises(InputError) as caught:
            track_on_ground(ballasted_track(), length, **more)
        assert str(caught.value) == message

    def test_of_zones(self):
        with pytest.raises(InputError, match="must end behind its start"):
            Zone(3.0, 2.0, 1.0)

    def test_of_panels(self):
        with pytest.raises(InputError, match="at least two support spacings"):
            slab_track(panel_length=1.0)
