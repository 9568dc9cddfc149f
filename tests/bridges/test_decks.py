"""Decks: rows of spans, bearings that give way, sections that vary, frames; against closed forms."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from axlespan.bridges import Column, Station, SupportAt, continuous_beam, frame, simple_span, simple_spans
from axlespan.errors import InputError
from axlespan.linalg.eigen import lowest_modes
from axlespan.linalg.factor import factorize

E, INERTIA, M = 34e9, 0.8, 12e3
BEAM = dict(youngs_modulus=E, second_moment=INERTIA, mass_per_length=M)


def under(structure, forces):
    """Displacements of all d.o.f. under downward forces {position: force} on the main line."""
    system, path = structure.system, structure.line()
    load = np.zeros(system.size)
    for at, force in forces.items():
        load -= force * path.rows([at], system.size).toarray()[0]
    u = np.zeros(system.size)
    u[system.free] = factorize(system.partition.K_FF).solve(load[system.free])
    return u, load


def reactions(structure, u, load):
    system = structure.system
    return dict(zip(system.support_names, ((system.stiffness @ u) - load)[system.prescribed], strict=True))


def deflection(structure, u, at):
    return (structure.line().rows([at], structure.system.size) @ u)[0]


def first_frequency(structure):
    blocks = structure.system.partition
    return lowest_modes(blocks.K_FF, blocks.M_FF, 1).frequencies[0]


class TestSimpleSpans:
    def test_each_deck_is_a_beam_of_its_own(self):
        decks = simple_spans(spans=[20.0, 30.0], elements=20, **BEAM)
        u, load = under(decks, {10.0: 1e5, 35.0: 1e5})
        for middle, span in ((10.0, 20.0), (35.0, 30.0)):
            assert deflection(decks, u, middle) == pytest.approx(
                -1e5 * span**3 / (48 * E * INERTIA), rel=1e-9
            )
        found = reactions(decks, u, load)
        assert found == pytest.approx(
            {"span1.left.z": 5e4, "span1.right.z": 5e4, "span2.left.z": 5e4, "span2.right.z": 5e4}, rel=1e-9
        )

    def test_frequencies(self):
        decks = simple_spans(spans=[20.0, 30.0], elements=20, **BEAM)
        blocks = decks.system.partition
        found = lowest_modes(blocks.K_FF, blocks.M_FF, 2).frequencies
        exact = [np.pi / (2 * span**2) * np.sqrt(E * INERTIA / M) for span in (30.0, 20.0)]
        np.testing.assert_allclose(found, exact, rtol=1e-5)

    def test_bearings_that_give_way(self):
        decks = simple_spans(
            spans=[20.0, 20.0], elements=10, bearing_stiffness=2e8, bearing_damping=1e5, **BEAM
        )
        u, _ = under(decks, {10.0: 1e5})
        exact = -1e5 * 20.0**3 / (48 * E * INERTIA) - 0.5e5 / 2e8
        assert deflection(decks, u, 10.0) == pytest.approx(exact, rel=1e-9)
        assert decks.system.damping.sum() == pytest.approx(0.0, abs=1e-6)
        assert decks.system.damping.diagonal().max() == 1e5

    def test_a_dashpot_needs_a_spring(self):
        with pytest.raises(InputError, match="bearing_stiffness: is missing"):
            simple_spans(spans=[20.0], elements=10, bearing_damping=1e5, **BEAM)


class TestBearings:
    @pytest.mark.parametrize("stiffness", [1e7, 1e8, 2e9])
    def test_first_frequency_on_springs(self, stiffness):
        """EI b^3 (tan b L/2 + tanh b L/2) = 2 k for the symmetric modes."""
        length = 25.0
        springs = [SupportAt(x, stiffness={"z": stiffness}) for x in (0.0, length)]
        bridge = simple_span(length=length, elements=40, supports=springs, **BEAM)

        def equation(b):
            return E * INERTIA * b**3 * (np.tan(b * length / 2) + np.tanh(b * length / 2)) - 2 * stiffness

        b = brentq(equation, 1e-6, np.pi / length * (1 - 1e-9))
        assert first_frequency(bridge) == pytest.approx(
            b**2 * np.sqrt(E * INERTIA / M) / (2 * np.pi), rel=1e-5
        )

    def test_rotational_springs_of_an_integral_abutment(self):
        """Equal springs c at both ends, force in the middle: M_end = P L / 8 / (1 + 2 EI / (c L))."""
        spring, length, force = 3e9, 20.0, 2e5
        ends = [SupportAt(x, fixed=("z",), stiffness={"ry": spring}, name=f"a{x:g}") for x in (0.0, length)]
        bridge = simple_span(length=length, elements=20, supports=ends, **BEAM)
        u, load = under(bridge, {length / 2: force})
        end = force * length / 8.0 / (1.0 + 2.0 * E * INERTIA / (spring * length))
        assert abs(reactions(bridge, u, load)["a0.ry"]) == pytest.approx(end, rel=1e-9)
        assert deflection(bridge, u, 10.0) == pytest.approx(
            -force * length**3 / (48 * E * INERTIA) + end * length**2 / (8 * E * INERTIA), rel=1e-9
        )


class TestStations:
    def test_a_haunched_span_bends_as_its_curvature_says(self):
        """w = ∫ M m / EI dx, numerically; the second moment is linear between stations."""
        length, force = 30.0, 4e5
        places, moments = [0.0, 10.0, 20.0, 30.0], [2.4, 0.8, 0.8, 2.4]
        stations = [Station(x, i) for x, i in zip(places, moments, strict=True)]
        bridge = continuous_beam(spans=[length], elements=60, stations=stations, **BEAM)

        def moment(x):
            return 0.5 * min(x, length - x)

        exact = -quad(
            lambda x: force * moment(x) ** 2 / (E * np.interp(x, places, moments)),
            0.0,
            length,
            points=[10, 15, 20],
        )[0]
        u, _ = under(bridge, {15.0: force})
        assert deflection(bridge, u, 15.0) == pytest.approx(exact, rel=2e-4)

    def test_a_continuous_haunched_girder_by_the_force_method(self):
        length, force = 25.0, 4e5
        places, moments = [0.0, 20.0, 25.0, 30.0, 50.0], [0.8, 0.8, 3.0, 0.8, 0.8]
        stations = [Station(x, i) for x, i in zip(places, moments, strict=True)]
        bridge = continuous_beam(spans=[length, length], elements=100, stations=stations, **BEAM)

        def flexibility(one, other):
            return quad(
                lambda x: one(x) * other(x) / (E * np.interp(x, places, moments)),
                0.0,
                50.0,
                points=[12.5, 20, 25, 30],
                limit=200,
            )[0]

        def hogging(x):  # unit moment over the middle support
            return min(x, 50.0 - x) / 25.0

        def free(x):  # force in the middle of the first span of simple spans
            return force * (0.5 * min(x, 25.0 - x)) if x < 25.0 else 0.0

        over = -flexibility(free, hogging) / flexibility(hogging, hogging)
        u, load = under(bridge, {12.5: force})
        assert reactions(bridge, u, load)["right.z"] == pytest.approx(over / 25.0, rel=2e-4)

    def test_mass_varies(self):
        stations = [Station(0.0, mass_per_length=10e3), Station(30.0, mass_per_length=16e3)]
        bridge = continuous_beam(spans=[30.0], elements=30, stations=stations, **BEAM)
        assert bridge.system.total_mass() == pytest.approx(30.0 * 13e3)

    @pytest.mark.parametrize(
        ("stations", "message"),
        [
            ([Station(0.0, 1.0)], "stations = 1: must be at least two"),
            ([Station(5.0, 1.0), Station(0.0, 1.0)], "stations = [5.0, 0.0]: must increase"),
            ([Station(0.0, 1.0), Station(31.0, 1.0)], "stations = [0.0, 31.0]: must lie between 0 and 30 m"),
            (
                [Station(0.0, 1.0), Station(30.0)],
                "stations = 'second_moment': must be given at all stations or at none",
            ),
            ([Station(0.0, 1.0), Station(30.0, -1.0)], "stations.1.second_moment = -1.0: must be positive"),
        ],
    )
    def test_bad_stations(self, stations, message):
        with pytest.raises(InputError) as caught:
            continuous_beam(spans=[30.0], elements=30, stations=stations, **BEAM)
        assert str(caught.value) == message


class TestFrames:
    """Kleinlogel's portal frames, k = I_beam h / (I_column L); bars that don't shorten."""

    L, H, P, COLUMN = 20.0, 8.0, 3e5, 0.4
    K = INERTIA * H / (COLUMN * L)

    def portal(self, **column):
        columns = [Column(x, self.H, E, self.COLUMN, 1e6, **column) for x in (0.0, self.L)]
        return frame(spans=[self.L], area=1e6, elements=20, columns=columns, **BEAM)

    def test_pinned_feet(self):
        portal = self.portal(base="pinned")
        u, load = under(portal, {self.L / 2: self.P})
        found = reactions(portal, u, load)
        thrust = 3 * self.P * self.L / (8 * self.H * (2 * self.K + 3))
        assert found["column1.x"] == pytest.approx(thrust, rel=1e-4)
        assert found["column2.x"] == pytest.approx(-thrust, rel=1e-4)
        assert found["column1.z"] == pytest.approx(self.P / 2, rel=1e-9)

    def test_fixed_feet(self):
        portal = self.portal()
        u, load = under(portal, {self.L / 2: self.P})
        found = reactions(portal, u, load)
        foot = self.P * self.L / (8 * (self.K + 2))
        assert abs(found["column1.ry"]) == pytest.approx(foot, rel=1e-4)
        assert found["column1.x"] == pytest.approx(3 * foot / self.H, rel=1e-4)

    def test_hinged_heads_leave_a_simple_beam(self):
        portal = self.portal(top="hinged")
        u, load = under(portal, {self.L / 2: self.P})
        assert deflection(portal, u, self.L / 2) == pytest.approx(
            -self.P * self.L**3 / (48 * E * INERTIA), rel=1e-4
        )
        assert abs(reactions(portal, u, load)["column1.x"]) < 1e-6 * self.P

    def test_soft_foundations_end_between_pinned_and_fixed(self):
        thrusts = []
        for column in ({"base": "pinned"}, {"base_stiffness": {"ry": 5e8}}, {"base": "fixed"}):
            portal = self.portal(**column)
            u, load = under(portal, {self.L / 2: self.P})
            thrusts.append(reactions(portal, u, load)["column1.x"])
        assert thrusts[0] < thrusts[1] < thrusts[2]

    def test_sway_frequency_of_a_stiff_deck_on_two_columns(self):
        """Two columns clamped at both ends: k = 24 E INERTIA / h^3, the deck's mass with 26/35 of half the columns' each."""
        deck = dict(youngs_modulus=34e12, second_moment=50.0, mass_per_length=M)
        columns = [Column(x, self.H, E, 0.05, 4.0, 2e3) for x in (0.0, self.L)]
        bridge = frame(spans=[self.L], area=50.0, elements=10, columns=columns, **deck)
        mass = M * self.L + 2 * 13 / 35 * 2e3 * self.H
        exact = np.sqrt(24 * E * 0.05 / self.H**3 / mass) / (2 * np.pi)
        assert first_frequency(bridge) == pytest.approx(exact, rel=2e-3)

    def test_a_viaduct_with_bearings_at_its_ends(self):
        columns = [Column(x, 10.0, E, 0.2, 3.0, 7e3, name=f"pier {x:g}") for x in (25.0, 55.0)]
        ends = [SupportAt(0.0, name="west"), SupportAt(80.0, name="east")]
        bridge = frame(
            spans=[25.0, 30.0, 25.0], area=5.0, elements=10, columns=columns, supports=ends, **BEAM
        )
        u, load = under(bridge, {40.0: 1e5})
        found = reactions(bridge, u, load)
        assert sum(value for name, value in found.items() if name.endswith(".z")) == pytest.approx(1e5)
        assert found["west.z"] == pytest.approx(found["east.z"])
        assert found["west.z"] < 0.0  # it lifts where the neighbor is loaded

    @pytest.mark.parametrize(
        ("change", "message"),
        [
            ({"top": "riged"}, "columns.top = 'riged': must be rigid or hinged"),
            ({"height": 0.0}, "columns.height = 0.0: must be positive"),
        ],
    )
    def test_bad_columns(self, change, message):
        values = dict(position=0.0, height=8.0, youngs_modulus=E, second_moment=0.2, area=2.0)
        with pytest.raises(InputError) as caught:
            Column(**{**values, **change})
        assert str(caught.value) == message

    def test_a_frame_without_columns(self):
        with pytest.raises(InputError, match="columns = 0: must be at least one"):
            frame(spans=[20.0], area=1.0, elements=4, columns=[], **BEAM)
