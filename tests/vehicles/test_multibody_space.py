"""Vehicles in space: matrices by hand, symmetry with the plane, static loads from the side, crossings of two beams."""

import numpy as np
import pytest
from scipy.linalg import eigh

import axlespan as asp
from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.irregularity import Harmonic
from axlespan.model.compile import compile_model
from axlespan.model.model import Model
from axlespan.running.line import path_on_beams
from axlespan.running.structure import Structure
from axlespan.vehicles import Body, BodyLoad, Suspension, Train, Wheel, multibody

G = 9.81
GAUGE, B1, B2 = 1.5, 1.0, 0.95  # between wheels; half distances of the primary and secondary springs
MC, IC, JC = 48e3, 2.7e6, 115e3
MB, IB, JB = 3200.0, 7200.0, 3200.0
MW, JW = 2400.0, 1200.0
KP, CP, KS, CS = 1.04e6, 5e4, 4e5, 6e4  # each, left and right
LB, LW = 17.375, 2.5


def coach(spatial=True, heights=False, **more):
    centers = (0.5 * LW, LB + 0.5 * LW)
    roll = {"roll_inertia": JB} if spatial else {}
    body = {"roll_inertia": JC} if spatial else {}
    body |= {"height": 1.8} if heights else {}
    bodies = [Body("body", MC, 0.5 * (LB + LW), IC, **body)]
    bodies += [Body(f"bogie{i + 1}", MB, x, IB, **roll) for i, x in enumerate(centers)]
    axle = {"gauge": GAUGE, "roll_inertia": JW} if spatial else {}
    wheels = [Wheel(x + side, MW, **axle) for x in centers for side in (-0.5 * LW, 0.5 * LW)]
    two = 1.0 if spatial else 2.0
    spread = (lambda half: {"spread": 2 * half}) if spatial else (lambda half: {})
    primary = [
        Suspension((f"bogie{i // 2 + 1}", f"wheel{i + 1}"), two * KP, two * CP, **spread(B1))
        for i in range(4)
    ]
    secondary = [Suspension(("body", f"bogie{i + 1}"), two * KS, two * CS, **spread(B2)) for i in range(2)]
    return multibody(bodies=bodies, wheels=wheels, suspensions=primary + secondary, **more)


def by_name(system, matrix, names):
    at = [list(system.independent).index(system.dof(name)) for name in names]
    return matrix.toarray()[np.ix_(at, at)]


def hand_matrices():
    """K, C and M over all 17 d.o.f. from the energies: every spring a row, wheels left and right."""
    names = [f"{body}.{c}" for body in ("body", "bogie1", "bogie2") for c in ("z", "pitch", "roll")]
    names += [f"wheel{i + 1}{end}.z" for i in range(4) for end in "lr"]
    position = {name: i for i, name in enumerate(names)}
    k, c, m = (np.zeros((17, 17)) for _ in range(3))

    def seat(body, behind, y):
        row = np.zeros(17)
        row[[position[f"{body}.{part}"] for part in ("z", "pitch", "roll")]] = 1.0, behind, y
        return row

    def center(wheel):
        z, roll = np.zeros(17), np.zeros(17)
        ends = [position[f"wheel{wheel}{end}.z"] for end in "lr"]
        z[ends], roll[ends] = 0.5, (1 / GAUGE, -1 / GAUGE)
        return z, roll

    for i in range(4):
        z, roll = center(i + 1)
        m += MW * np.outer(z, z) + JW * np.outer(roll, roll)
        for y in (B1, -B1):
            row = seat(f"bogie{i // 2 + 1}", (-0.5 * LW, 0.5 * LW)[i % 2], y) - (z + y * roll)
            k += KP * np.outer(row, row)
            c += CP * np.outer(row, row)
    for i in range(2):
        for y in (B2, -B2):
            row = seat("body", (-0.5 * LB, 0.5 * LB)[i], y) - seat(f"bogie{i + 1}", 0.0, y)
            k += KS * np.outer(row, row)
            c += CS * np.outer(row, row)
    m[:9, :9] += np.diag([MC, IC, JC, MB, IB, JB, MB, IB, JB])
    return names, k, c, m


class TestCoach:
    def test_matrices(self):
        names, k, c, m = hand_matrices()
        system = coach().system
        assert len(system.free) == 17
        np.testing.assert_allclose(by_name(system, system.stiffness, names), k, rtol=1e-11, atol=1e-6)
        np.testing.assert_allclose(by_name(system, system.damping, names), c, rtol=1e-11, atol=1e-7)
        np.testing.assert_allclose(by_name(system, system.mass, names), m, rtol=1e-11, atol=1e-8)

    def test_frequencies(self):
        _, k, _, m = hand_matrices()
        expected = np.sqrt(eigh(k[:9, :9], m[:9, :9], eigvals_only=True)) / (2 * np.pi)
        np.testing.assert_allclose(coach().frequencies(), expected, rtol=1e-9)

    def test_roll_stands_beside_bounce_and_pitch(self):
        """Roll by itself: a chain of three roll springs with the wheels held; the others are those of the plane."""
        both, flat = coach().frequencies(), coach(spatial=False).frequencies()
        rolls = [f for f in both if np.min(np.abs(flat - f)) > 1e-6 * f]
        ks, kp = 2 * KS * B2**2, 4 * KP * B1**2
        k = np.array([[2 * ks, -ks, -ks], [-ks, ks + kp, 0], [-ks, 0, ks + kp]])
        expected = np.sqrt(eigh(k, np.diag([JC, JB, JB]), eigvals_only=True)) / (2 * np.pi)
        np.testing.assert_allclose(rolls, expected, rtol=1e-9)

    def test_contacts(self):
        points = coach().contacts
        assert [p.name for p in points] == ["1l", "1r", "2l", "2r", "3l", "3r", "4l", "4r"]
        assert {p.line for p in points if p.name.endswith("l")} == {"left"}
        assert [p.dof for p in points[:2]] == ["wheel1l.z", "wheel1r.z"]
        np.testing.assert_allclose(coach().static_forces(), (MC + 2 * MB + 4 * MW) * G / 8)
        assert {p.line for p in coach().on_lines({"left": "a", "right": "b"}).contacts} == {"a", "b"}

    def test_half_of_the_mass_at_each_wheel_without_a_roll_inertia(self):
        axle = multibody(
            bodies=[Body("body", 1e3, 0.0)],
            wheels=[Wheel(0.0, 600.0, gauge=1.5)],
            suspensions=[Suspension(("body", "wheel1"), 1e6)],
        )
        m = by_name(axle.system, axle.system.mass, ["wheel1l.z", "wheel1r.z"])
        np.testing.assert_allclose(m, np.diag([300.0, 300.0]))


class TestSideLoads:
    def test_cross_wind_unloads_the_windward_wheels(self):
        """60 kN from the left at 2.4 m: the moment about the rails, shared by eight equal wheels."""
        still, blown = coach(), coach(loads=[BodyLoad("body", y=-60e3, height=2.4)])
        change = blown.static_forces() - still.static_forces()
        share = 60e3 * 2.4 / GAUGE / 4
        np.testing.assert_allclose(change, [-share, share] * 4, rtol=1e-9)

    def test_the_height_of_the_body_is_where_a_lateral_force_acts(self):
        """Centrifugal force v²/R in a curve to the left pushes to the right."""
        force = -MC * 40.0**2 / 2000.0
        turning = coach(heights=True).loaded([BodyLoad("body", y=force)])
        change = turning.static_forces() - coach().static_forces()
        np.testing.assert_allclose(change[1::2], -force * 1.8 / GAUGE / 4, rtol=1e-9)

    def test_a_load_off_the_middle(self):
        """Payload over the left front: rigid-body statics of the whole, by forces and both moments."""
        loaded = coach().loaded([BodyLoad("body", z=-20e3, roll=-20e3 * 0.4, pitch=-20e3 * -3.0)])
        change = loaded.static_forces() - coach().static_forces()
        x = np.array([p.behind for p in loaded.contacts])
        y = np.array([0.5 * GAUGE, -0.5 * GAUGE] * 4)
        assert change.sum() == pytest.approx(20e3)
        assert change @ y == pytest.approx(20e3 * 0.4)
        assert change @ (x - 0.5 * (LB + LW)) == pytest.approx(20e3 * -3.0, rel=1e-9)

    def test_a_body_beside_the_middle(self):
        lean = multibody(
            bodies=[Body("body", 1e4, 1.0, 1e4, 1e4, side=0.15)],
            wheels=[Wheel(0.0, gauge=1.5), Wheel(2.0, gauge=1.5)],
            suspensions=[Suspension(("body", f"wheel{i}"), 1e6, spread=1.5) for i in (1, 2)],
        )
        half = 1e4 * G / 2
        np.testing.assert_allclose(lean.static_forces(), [half * 0.6, half * 0.4] * 2, rtol=1e-9)

    def test_too_much_wind_tips_it_over(self):
        with pytest.raises(InputError, match=r"wheel '1l'.*would tip over"):
            coach(loads=[BodyLoad("body", y=-900e3, height=2.4)]).static_forces()


class TestAntiRollBar:
    def test_matrix(self):
        """½ k_R (φ - (z_l - z_r)/g)² added by hand."""
        springs = [Suspension(("body", f"wheel{i}"), 1e4, spread=1.8) for i in (1, 2)]
        wheels = [
            Wheel(0.0, 53.0, gauge=1.8, independent=True),
            Wheel(3.0, 76.0, gauge=1.8, independent=True),
        ]
        body = [Body("body", 1040.0, 1.5, 1580.0, 1180.0)]
        bar = Suspension(("body", "wheel1"), roll_stiffness=25e3)
        without, with_bar = (
            multibody(bodies=body, wheels=wheels, suspensions=springs + extra).system for extra in ([], [bar])
        )
        names = ["body.roll", "wheel1l.z", "wheel1r.z"]
        row = np.array([1.0, -1 / 1.8, 1 / 1.8])
        added = by_name(with_bar, with_bar.stiffness, names) - by_name(without, without.stiffness, names)
        np.testing.assert_allclose(added, 25e3 * np.outer(row, row), rtol=1e-9)
        m = by_name(without, without.mass, ["wheel1l.z", "wheel1r.z", "wheel2l.z"])
        np.testing.assert_allclose(m, np.diag([53.0, 53.0, 76.0]))


def parallel_beams(elements=20, length=30.0):
    """Two equal beams side by side, joined by nothing, under the left and the right wheels."""
    beams = BeamProperties(bending_stiffness_y=7e10, mass_per_length=6000.0)
    model, lines = Model(plane=False), {}
    x = np.linspace(0.0, length, elements + 1)
    for name, y in (("left", 0.75), ("right", -0.75)):
        first = len(model.points)
        model = model.with_nodes(np.column_stack([x, np.full_like(x, y), np.zeros_like(x)]))
        nodes = np.arange(first, first + elements + 1)
        model = model.with_beams(np.column_stack([nodes[:-1], nodes[1:]]), beams, name=name)
        lines[name] = nodes
        for node in nodes:
            fixed = ["x", "y", "rx", "rz"] + (["z"] if node in (nodes[0], nodes[-1]) else [])
            model = model.with_support(int(node), fixed, name=f"{name}{node}")
    compiled = compile_model(model)
    paths = {name: path_on_beams(model, compiled.table, list(nodes)) for name, nodes in lines.items()}
    position = np.full(len(compiled.system.dof_names), -1)
    position[compiled.system.independent] = np.arange(compiled.system.size)
    paths = {name: path.renumbered(position) for name, path in paths.items()}
    return Structure(compiled.system, paths, "two beams", model)


def run(structure, vehicle, irregularity=None, steps=700):
    crossing = asp.Crossing(
        structure,
        Train.of(vehicle),
        speed=70.0,
        irregularity=irregularity or Harmonic(amplitude=0.4e-3, wavelength=6.0),
    )
    return asp.simulate(crossing, time_step=1e-3, steps=steps, sensors={"midspan": 15.0})


class TestCrossings:
    def test_symmetric_input_gives_the_response_of_the_plane(self):
        single = asp.bridges.simple_span(
            length=30.0, youngs_modulus=1.4e11, second_moment=1.0, mass_per_length=12e3, elements=20
        )
        flat, both = run(single, coach(spatial=False)), run(parallel_beams(), coach())
        scale = np.abs(flat.contact_force).max()
        for side in (0, 1):
            np.testing.assert_allclose(
                2 * both.contact_force[:, side::2], flat.contact_force, atol=1e-11 * scale
            )
        names = list(both.vehicle_dof)
        for i, name in enumerate(flat.vehicle_dof):
            twin = name.replace(".z", "l.z") if ".wheel" in name else name
            expected = flat.vehicle_displacement[:, i]
            size = np.abs(expected).max()
            np.testing.assert_allclose(
                both.vehicle_displacement[:, names.index(twin)], expected, atol=2e-12 * size
            )
        roll = both.vehicle_displacement[:, names.index("1.body.roll")]
        assert np.abs(roll).max() < 1e-12
        np.testing.assert_allclose(
            both.sensor_displacement[:, 0], flat.sensor_displacement[:, 0], atol=2e-12 * 1e-3
        )

    def test_wind_moves_its_share_of_the_load_to_the_right_beam(self):
        """Off the structure and on it: by linearity the difference to the run without wind is static at first."""
        wind = [BodyLoad("body", y=-60e3, height=2.4)]
        still, blown = run(parallel_beams(), coach()), run(parallel_beams(), coach(loads=wind))
        share = 60e3 * 2.4 / GAUGE / 4
        waiting = still.contact_position[0] < 0.0  # wheels that stand on the ground before the bridge
        np.testing.assert_allclose(
            (blown.contact_force - still.contact_force)[0, waiting],
            np.array([-share, share] * 4)[waiting],
            rtol=1e-6,  # the first bogie is about to move
        )
        total = blown.contact_force - still.contact_force
        assert np.abs(total.sum(axis=1)).max() < 1e-6 * still.contact_force[0].sum()

    def test_a_slow_crossing_reaches_the_static_lean(self):
        """The body leans by the beams' deflection under its own unequal loads: statics of beams in closed form."""
        axle = {"gauge": GAUGE}
        body = Body("body", 20e3, 0.0, None, 2e4)
        bogie = multibody(
            bodies=[body],
            wheels=[Wheel(0.0, **axle)],
            suspensions=[Suspension(("body", "wheel1"), 1e6, 2e5, spread=1.5)],
            loads=[BodyLoad("body", roll=20e3)],
        )
        smooth = asp.irregularity.Smooth()
        crossing = asp.Crossing(
            parallel_beams(), Train.of(bogie), speed=1e-6, start=15.0, irregularity=smooth
        )
        result = asp.simulate(crossing, time_step=1e-2, steps=5)
        share = 20e3 / GAUGE
        force = 10e3 * G + np.array([-share, share])
        np.testing.assert_allclose(result.contact_force[0], force, rtol=1e-9)
        reactions = dict(zip(result.support, result.support_reaction[0], strict=True))
        for name, nodes, load in (("left", (0, 20), force[0]), ("right", (21, 41), force[1])):
            ends = [reactions[f"{name}{node}.z"] for node in nodes]
            np.testing.assert_allclose(ends, load / 2, rtol=1e-6)
        down = -force * 30.0**3 / (48 * 7e10)
        u = dict(zip(result.vehicle_dof, result.vehicle_displacement[0], strict=True))
        assert u["1.wheel1l.z"] == pytest.approx(down[0], rel=1e-6)
        assert u["1.wheel1r.z"] == pytest.approx(down[1], rel=1e-6)
        assert u["1.body.roll"] == pytest.approx((down[0] - down[1]) / GAUGE, rel=1e-6)
