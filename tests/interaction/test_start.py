"""How a run starts: static equilibrium, and the velocity and acceleration that the line asks of the wheels."""

import numpy as np
import pytest

from axlespan.bridges.spans import SupportAt, simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.elements.beam import BeamProperties
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.simulate import simulate
from axlespan.irregularity import Harmonic
from axlespan.model.compile import compile_model
from axlespan.model.damping import Rayleigh
from axlespan.model.model import Model
from axlespan.model.motions import Constant
from axlespan.reference import SuspendedBody
from axlespan.running.structure import Structure
from axlespan.vehicles import library
from axlespan.vehicles.simple import axle_loads, rigid_body, rigid_mass, sprung_mass
from axlespan.vehicles.train import Train
from axlespan.vehicles.vehicle import ContactPoint, Vehicle

SPAN = {"length": 25.0, "youngs_modulus": 2.87e9, "second_moment": 2.9, "mass_per_length": 2303.0}
WAVE = Harmonic(amplitude=1e-3, wavelength=4.0, phase=0.3)
MASS = sprung_mass(mass=5750.0, stiffness=1.595e6)
COACH = rigid_body(
    mass=2.8e4,
    pitch_inertia=4e5,
    axles=[0.0, 4.0, 9.0],
    stiffness=[9e5, 1.1e6, 1e6],
    damping=2e4,
    unsprung_mass=400.0,
)
LIGHT_COACH = rigid_body(mass=2.8e4, pitch_inertia=4e5, axles=[0.0, 4.0, 9.0], stiffness=[9e5, 1.1e6, 1e6])


def car_on_its_wheels():
    body = BeamProperties(bending_stiffness_y=8e7, mass_per_length=900.0)
    x = -np.linspace(0.0, 6.0, 4)
    model = Model().with_nodes(np.column_stack([x, np.zeros(4)]), ["front", "b", "c", "rear"])
    model = model.with_beams([[0, 1], [1, 2], [2, 3]], body)
    points = (ContactPoint("1", 0.0, "front.z"), ContactPoint("2", 6.0, "rear.z"))
    return Vehicle(points, compile_model(model).system, "beam car", is_multibody=False)


def loaded(structure):
    model = structure.model.with_load(3, "z", -3e4).with_load(5, "ry", 2e4)
    return Structure(compile_model(model).system, structure.lines, model=model)


BRIDGES = {
    "span": lambda: simple_span(elements=8, **SPAN),
    "Timoshenko": lambda: simple_span(elements=8, area=5.5, shear_area=4.6, **SPAN),
    "damped": lambda: simple_span(elements=8, damping=Rayleigh(0.5, 1e-3), **SPAN),
    "elastic": lambda: simple_span(
        elements=8,
        supports=[SupportAt(0.0, fixed=(), stiffness={"z": 8e6}, damping={"z": 1e5}), SupportAt(25.0)],
        **SPAN,
    ),
    "settled": lambda: simple_span(
        elements=8,
        supports=[
            SupportAt(0.0),
            SupportAt(10.0, fixed=(), motion={"z": Constant(-0.01)}),
            SupportAt(25.0, fixed=(), motion={"z": Constant(0.02)}),
        ],
        **SPAN,
    ),
    "massless": lambda: simple_span(elements=8, **(SPAN | {"mass_per_length": 0.0})),
    "loaded": lambda: loaded(simple_span(elements=8, **SPAN)),
}
TRAINS = {
    "sprung masses": (lambda: Train.of(MASS, 3, 2.7), 12.0),
    "coach": (lambda: Train.of(COACH), 13.0),
    "coach without wheel masses": (lambda: Train.of(LIGHT_COACH), 13.0),
    "half on it": (lambda: Train.of(COACH, 2, 12.0), 10.2),
    "rigid mass": (lambda: Train.of(rigid_mass(mass=9e3)), 12.5),
    "beam car": (lambda: Train.of(car_on_its_wheels()), 9.0),
    "axle loads": (lambda: Train.of(axle_loads(loads=[5e4, 6e4], positions=[0.0, 3.3])), 11.0),
}


# A rigid mass over massless d.o.f. has a test of its own.
PAIRS = [(b, t) for b in BRIDGES for t in TRAINS if (b, t) != ("massless", "rigid mass")]


@pytest.mark.parametrize(("bridge", "train"), PAIRS)
def test_a_train_that_stands_stays_at_rest(bridge, train):
    """At speed zero nothing moves and no force changes, over an irregular line too."""
    build, start = TRAINS[train]
    crossing = Crossing(BRIDGES[bridge](), build(), speed=0.0, start=start, irregularity=WAVE)
    result = simulate(crossing, time_step=2e-3, steps=60, sensors={"m": 12.5, "q": 6.0}, method=Alpha(-0.1))
    for quantity in ("sensor_displacement", "contact_force", "support_reaction", "vehicle_displacement"):
        history = getattr(result, quantity)
        if history.size:
            assert np.abs(history - history[0]).max() < 1e-9 * np.abs(history).max(), quantity
    assert np.abs(result.sensor_displacement[0]).max() > 1e-4
    # Equilibrium as a whole: what the wheels weigh, what the loads are, is what the supports carry.
    vertical = np.array([name.endswith(".z") for name in result.support], float)
    s = start - crossing.train.offsets
    weight = result.contact_force[0][(s >= 0.0) & (s <= 25.0)].sum() + (3e4 if bridge == "loaded" else 0.0)
    assert result.support_reaction[0] @ vertical == pytest.approx(weight, rel=1e-8)


def test_newmark_stays_at_rest_too():
    crossing = Crossing(BRIDGES["span"](), Train.of(LIGHT_COACH), speed=0.0, start=13.0, irregularity=WAVE)
    result = simulate(crossing, time_step=2e-3, steps=300, method=Alpha(0.0), sensors={"m": 12.5})
    assert np.ptp(result.contact_force) < np.ptp(result.contact_force[0]) * (1 + 1e-9)
    np.testing.assert_allclose(result.contact_force, np.tile(result.contact_force[0], (301, 1)), rtol=1e-9)


@pytest.mark.parametrize("start", [0.0, 25.0])
@pytest.mark.parametrize("train", [Train.of(MASS), Train.of(LIGHT_COACH), Train.of(axle_loads(loads=5e4))])
def test_a_wheel_that_stands_over_a_bearing(train, start):
    """Its weight goes straight into the support; the beam feels nothing of it."""
    crossing = Crossing(BRIDGES["span"](), train, speed=0.0, start=start)
    result = simulate(crossing, time_step=2e-3, steps=20, method=Alpha(0.0), sensors={"m": 12.5})
    assert np.ptp(result.contact_force, axis=0).max() < 1e-9 * result.contact_force.max()
    bearing = result.at("support_reaction", "left.z" if start == 0.0 else "right.z")
    if len(crossing.train.offsets) == 1 or start == 0.0:
        np.testing.assert_allclose(bearing, result.contact_force[:, 0], rtol=1e-9)
        np.testing.assert_allclose(result.sensor_displacement, 0.0, atol=1e-15)


def test_a_wheel_that_arrives_with_the_last_step():
    crossing = Crossing(BRIDGES["span"](), Train.of(MASS), speed=10.0, start=-1.0)
    result = simulate(crossing, time_step=1e-3, steps=100)
    np.testing.assert_allclose(result.contact_force, 5750.0 * 9.81, rtol=1e-12)


def test_a_mass_standing_on_a_massless_beam():
    """The beam is a spring then: the mass stands, and its force is its weight."""
    crossing = Crossing(BRIDGES["massless"](), Train.of(rigid_mass(mass=9e3)), speed=0.0, start=12.5)
    result = simulate(crossing, time_step=2e-3, steps=60, sensors={"m": 12.5})
    np.testing.assert_allclose(result.contact_force, 9e3 * 9.81, rtol=1e-8)
    sag = -9e3 * 9.81 * 25.0**3 / (48 * 2.87e9 * 2.9)
    np.testing.assert_allclose(result.sensor_displacement, sag, rtol=2e-3)  # the footprint spreads the load


def test_static_forces_of_an_indeterminate_vehicle_on_uneven_ground():
    """Off the bridge: three springs under a rigid body, solved in the test."""
    k, behind = np.array([9e5, 1.1e6, 1e6]), np.array([0.0, 4.0, 9.0])
    rows = np.column_stack([np.ones(3), -(4.5 - behind)])
    r = WAVE.value(-20.0 - behind)
    body = np.linalg.solve(rows.T @ (k[:, None] * rows), rows.T @ (k * r) - [2.8e4 * 9.81, 0.0])
    expected = k * (r - rows @ body)
    crossing = Crossing(
        BRIDGES["span"](),
        Train.of(LIGHT_COACH),
        speed_history=[[0.0, 0.0], [0.1, 0.0], [0.2, 60.0]],
        start=-20.0,
        irregularity=WAVE,
    )
    result = simulate(crossing, time_step=1e-3, steps=600)
    np.testing.assert_allclose(result.contact_force[0], expected, rtol=1e-9)
    np.testing.assert_allclose(result.contact_force[90], expected, rtol=1e-7)
    pitch = result.at("vehicle_displacement", "1.body.pitch")[0]
    level = np.linalg.solve(rows.T @ (k[:, None] * rows), [-2.8e4 * 9.81, 0.0])
    assert pitch == pytest.approx(body[1] - level[1], rel=1e-9)  # from the static position on level ground


class TestFirstInstant:
    """What the wheels do at t = 0 on a moving start, by finite differences along the line."""

    H = 1e-4

    def height(self, crossing, result, t):
        """r + E u of the structure as it is at t = 0, under every wheel at a time around zero."""
        s = crossing.start + crossing.motion.distance(np.array([t])) - crossing.train.offsets
        system = crossing.structure.system
        path = crossing.structure.lines["main"]
        u = np.zeros(system.size)
        u[system.free] = self.static(crossing, result)
        return crossing.irregularity.value(s) + path.rows(s, system.size) @ u

    @staticmethod
    def static(crossing, result):
        system = crossing.structure.system
        s = crossing.start - crossing.train.offsets
        load = -crossing.structure.lines["main"].rows(s, system.size).T @ TestFirstInstant.standing(crossing)
        return np.linalg.solve(system.partition.K_FF.toarray(), load[system.free])

    @staticmethod
    def standing(crossing):
        still = Crossing(
            crossing.structure,
            crossing.train,
            speed=0.0,
            start=crossing.start,
            irregularity=crossing.irregularity,
        )
        return simulate(still, time_step=1e-3, steps=1, footprint=0.0, method=Alpha(-0.1)).contact_force[0]

    @pytest.mark.parametrize("train", [MASS, COACH], ids=["massless", "massive"])
    def test_wheels_follow_the_line(self, train):
        crossing = Crossing(
            BRIDGES["span"](),
            Train.of(train),
            speed_history=[[0.0, 20.0], [1.0, 25.0]],
            start=14.0,
            irregularity=WAVE,
        )
        result = simulate(crossing, time_step=1e-3, steps=2, footprint=0.0, method=Alpha(-0.1))
        before, now, after = (self.height(crossing, result, t) for t in (-self.H, 0.0, self.H))
        wheels = [result.vehicle_dof.index(f"1.wheel{i + 1}.z") for i in range(len(crossing.train.offsets))]
        np.testing.assert_allclose(result.vehicle_displacement[0, wheels], now, rtol=1e-8)
        speeds = result.vehicle_velocity[0, wheels]
        np.testing.assert_allclose(speeds, (after - before) / (2 * self.H), atol=1e-5 * np.abs(speeds).max())
        inner = [i for i in range(len(result.vehicle_dof)) if i not in wheels]
        np.testing.assert_array_equal(result.vehicle_velocity[0, inner], 0.0)

    def test_wheels_with_mass_accelerate_with_the_line(self):
        """ü_X = s'' terms of the frozen line, plus E ü of the structure's own acceleration at t = 0."""
        crossing = Crossing(
            BRIDGES["span"](),
            Train.of(COACH),
            speed_history=[[-1.0, 20.0], [1.0, 24.0]],
            start=14.0,
            irregularity=WAVE,
        )
        sensors = {str(i): 14.0 - x for i, x in enumerate(crossing.train.offsets)}
        result = simulate(crossing, time_step=1e-3, steps=2, footprint=0.0, sensors=sensors)
        before, now, after = (self.height(crossing, result, t) for t in (-self.H, 0.0, self.H))
        frozen = (after - 2 * now + before) / self.H**2
        wheels = [result.vehicle_dof.index(f"1.wheel{i + 1}.z") for i in range(3)]
        wanted = frozen + result.sensor_acceleration[0]
        np.testing.assert_allclose(
            result.vehicle_acceleration[0, wheels], wanted, atol=1e-4 * np.abs(wanted).max()
        )

    def test_equations_of_motion_hold_at_time_zero(self):
        """M ü + C u̇ + K u = forces for every body of the coach, wheels included."""
        crossing = Crossing(BRIDGES["span"](), Train.of(COACH), speed=20.0, start=14.0, irregularity=WAVE)
        result = simulate(crossing, time_step=1e-3, steps=1, footprint=0.0)
        blocks = COACH.system.partition
        force = np.zeros(len(COACH.system.free))
        force[COACH.contact_dofs] = result.contact_force[0] - COACH.static_forces()
        left = (
            blocks.M_FF @ result.vehicle_acceleration[0]
            + blocks.C_FF @ result.vehicle_velocity[0]
            + blocks.K_FF @ result.vehicle_displacement[0]
        )
        np.testing.assert_allclose(left, force, atol=1e-8 * np.abs(force).max())


def test_a_start_on_rigid_ground_is_free_of_the_bridge():
    """Far before it, the bridge is at rest until the first wheel arrives."""
    crossing = Crossing(BRIDGES["span"](), Train.of(MASS, 2, 3.0), speed=30.0, start=-9.0, irregularity=WAVE)
    result = simulate(crossing, time_step=1e-3, steps=400, sensors={"m": 12.5})
    before = crossing.start + 30.0 * result.time <= 0.0
    assert np.all(result.sensor_displacement[before] == 0.0)
    assert np.all(result.sensor_displacement[-1] != 0.0)


def test_wheels_far_from_the_bridge_move_as_on_rigid_ground():
    """Body over a harmonic foot in closed form."""
    r = Harmonic(amplitude=1e-3, wavelength=10.0, phase=0.0)
    vehicle = sprung_mass(mass=5750.0, stiffness=1.595e6, damping=1e4)
    crossing = Crossing(BRIDGES["span"](), Train.of(vehicle), speed=20.0, start=-20.0, irregularity=r)
    result = simulate(crossing, time_step=5e-4, steps=2100, method=Alpha(0.0))
    exact = SuspendedBody(5750.0, 1.595e6, 1e4).over_harmonic(1e-3, 2 * np.pi * 2.0, result.time)
    off = result.time < 1.0
    body = result.at("vehicle_displacement", "1.body.z")
    # Period error (ω Δt)² / 12 over a phase of 17 rad.
    assert np.abs(body - exact.displacement)[off].max() < 1e-4 * np.abs(exact.displacement).max()


def test_a_footprint_over_a_fixed_end_does_not_deflect_the_span_before_its_wheel_has_come():
    """A mass that starts at 0 and one that starts 1 m before it do the same to the span, to the footprint squared."""
    span, mass = simple_span(**SPAN, elements=50), rigid_mass(mass=5750.0)
    first, second = (
        simulate(
            Crossing(span, Train.of(mass), speed=25.0, start=start),
            time_step=1e-3,
            steps=800 - round(40 * start),
            sensors={"midspan": 12.5},
        ).sensor_displacement[:, 0]
        for start in (0.0, -1.0)
    )
    assert abs(first[0]) < 1e-4 * np.abs(second).max()
    # a standing start over the end, with half the footprint on the span, was off by 5e-3, a start from rest by 3e-4
    assert np.abs(first - second[40:]).max() < 2e-4 * np.abs(second).max()


@pytest.mark.parametrize("direction", ["forward", "backward"])
@pytest.mark.parametrize("basis", ["full", "reduced"])
def test_a_train_that_starts_over_the_end_does_not_strike_the_span(direction, basis):
    """The share of its first wheel on the span at t = 0 has come little by little, as from 1 m before."""
    train = Train.of(library.vehicle("ice3-heavy"))
    span = simple_span(length=20.0, youngs_modulus=34e9, second_moment=0.9, mass_per_length=9e3, elements=20)
    far = -1.0 if direction == "forward" else 21.0
    here, before = (
        simulate(
            Crossing(span, train, speed=25.0, start=start, direction=direction),
            time_step=1e-3,
            steps=steps,
            line_points=41,
            basis=basis,
        )
        for start, steps in ((None, 900), (far, 940))
    )
    static = train.static_forces()[0]
    assert np.abs(here.contact_force - before.contact_force[40:]).max() < 3e-4 * static  # from rest 2.4e-2
    acceleration = np.abs(here.line_acceleration - before.line_acceleration[40:]).max()
    assert acceleration < 0.1 * np.abs(before.line_acceleration).max()  # from rest 20
    moved = np.abs(here.line_displacement - before.line_displacement[40:]).max()
    assert moved < 2e-4 * np.abs(before.line_displacement).max()


def test_a_wheel_that_stands_over_a_fixed_end_is_in_equilibrium():
    """With no speed the share of the footprint on the span is balanced, and nothing moves."""
    span = simple_span(**SPAN, elements=50)
    standing = Crossing(span, Train.of(rigid_mass(mass=5750.0)), speed=0.0)
    result = simulate(standing, time_step=1e-3, steps=20, footprint=0.5, sensors={"midspan": 12.5})
    middle = result.sensor_displacement[:, 0]
    assert middle[0] < -1e-6
    assert np.abs(middle - middle[0]).max() < 1e-9 * abs(middle[0])


@pytest.mark.parametrize("start", [-1.0, -1.5, -5.0])
def test_wheels_that_land_on_nodes_do_not_see_how_they_came(start):
    """Positions k v Δt that are nodes of the beam, or miss one by rounding: the same history from every start."""
    span = simple_span(length=20.0, youngs_modulus=34e9, second_moment=0.9, mass_per_length=9e3, elements=20)
    train = Train.of(sprung_mass(mass=5750.0, stiffness=1.595e6), count=2, spacing=3.0)
    early = round(-start / 0.025)
    here, before = (
        simulate(Crossing(span, train, speed=25.0, start=begin), time_step=1e-3, steps=steps, line_points=21)
        for begin, steps in ((0.0, 900), (start, 900 + early))
    )
    scale = np.abs(here.line_acceleration).max()
    assert np.abs(before.line_acceleration[early:] - here.line_acceleration).max() < 1e-7 * scale
    assert np.abs(before.contact_force[early:] - here.contact_force).max() < 1e-9 * 5750.0 * 9.81
