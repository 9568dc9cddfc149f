"""The direct method against N12's equations taken literally, and against its rivals, for a family of crossings."""

from functools import cache

import numpy as np
import pytest

from axlespan.bridges.spans import SupportAt, continuous_beam, simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.elements.beam import BeamProperties
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.simulate import simulate
from axlespan.irregularity import Harmonic
from axlespan.model.compile import compile_model
from axlespan.model.damping import Modal, Rayleigh
from axlespan.model.model import Model
from axlespan.model.motions import Constant, HarmonicMotion
from axlespan.running.line import path_on_beams
from axlespan.running.structure import Structure
from axlespan.vehicles.simple import axle_loads, rigid_body, rigid_mass, sprung_mass
from axlespan.vehicles.train import Train
from axlespan.vehicles.vehicle import ContactPoint, Vehicle

BEAM = {"length": 25.0, "youngs_modulus": 2.87e9, "second_moment": 2.9, "mass_per_length": 2303.0}
WAVE = Harmonic(amplitude=0.4e-3, wavelength=4.0)
BUMP = Harmonic(amplitude=0.4e-3, wavelength=4.0, start=4.0, stop=20.0)
MASS = sprung_mass(mass=5750.0, stiffness=1.595e6)
WHEEL = sprung_mass(mass=5750.0, stiffness=1.595e6, damping=2e4, unsprung_mass=500.0)
BOGIE = rigid_body(mass=9e3, pitch_inertia=2e4, axles=[0.0, 2.6], stiffness=1.2e6, damping=1.5e4, center=1.1)
COACH = rigid_body(
    mass=2.8e4,
    pitch_inertia=4e5,
    axles=[0.0, 4.0, 9.0],
    stiffness=[9e5, 1.1e6, 1e6],
    damping=2e4,
    unsprung_mass=400.0,
)
STEP, STEPS = 4e-3, 200  # 0.8 s: at 30 m/s just under the length of the span


def bridge(elements=8, **more):
    return simple_span(elements=elements, **(BEAM | more))


def viaduct(damping=None):
    """Ten spans, 230 d.o.f."""
    rest = {key: value for key, value in BEAM.items() if key != "length"}
    return continuous_beam(spans=[25.0] * 10, elements=12, damping=damping, **rest)


def beam_car():
    """A vehicle of beam elements: a flexible car body right on its two wheels."""
    body = BeamProperties(bending_stiffness_y=8e7, mass_per_length=900.0)
    x = -np.linspace(0.0, 6.0, 4)
    model = Model().with_nodes(np.column_stack([x, np.zeros(4)]), ["front", "b", "c", "rear"])
    model = model.with_beams([[0, 1], [1, 2], [2, 3]], body)
    points = (ContactPoint("1", 0.0, "front.z"), ContactPoint("2", 6.0, "rear.z"))
    return Vehicle(points, compile_model(model).system, "beam car", is_multibody=False)


def curved_bridge(damping=None):
    """A beam in space along a polyline that bends sideways, thick, with two lines on it."""
    points = np.array([[0, 0, 0], [4, 0, 0], [8, 0.8, 0], [12, 2.4, 0], [15, 4.4, 0], [18, 7.0, 0]], float)
    section = BeamProperties(
        axial_stiffness=9e9,
        bending_stiffness_y=4e9,
        bending_stiffness_z=6e9,
        torsional_stiffness=2e9,
        shear_stiffness_y=3e9,
        shear_stiffness_z=2e9,
        mass_per_length=3000.0,
        rotary_inertia_y=900.0,
        rotary_inertia_z=1200.0,
    )
    model = Model(plane=False).with_nodes(points)
    model = model.with_beams([[0, 1], [2, 1], [2, 3], [3, 4], [4, 5]], section)
    model = model.with_support(0, ["x", "y", "z", "rx", "rz"]).with_support(5, ["y", "z", "rx"])
    model = model.with_damping(damping)
    compiled = compile_model(model)
    line = path_on_beams(model, compiled.table, range(6))
    siding = path_on_beams(model, compiled.table, range(1, 6), start=line.breaks[1])
    return Structure(compiled.system, {"main": line, "siding": siding}, model=model)


def two_lines():
    """Two vehicles side by side, on different lines of the same bridge."""
    points = (ContactPoint("a", 0.0, "wheel1.z"), ContactPoint("b", 0.0, None, "siding", 4e4))
    del points  # a moving force and a d.o.f. cannot share a vehicle
    other = Vehicle((ContactPoint("1", 0.0, "wheel1.z", "siding"),), MASS.system, "on the siding")
    return Train((Train.of(BOGIE).placements[0], *(type(p)(other, 0.7) for p in Train.of(MASS).placements)))


def loaded_bridge():
    structure = bridge()
    model = structure.model.with_load(3, "z", -2e4, lambda t: np.sin(25.0 * t)).with_load(5, "ry", 1e4)
    compiled = compile_model(model)
    return Structure(compiled.system, structure.lines, model=model)


def supported(**supports):
    return {"supports": [SupportAt(0.0, **supports), SupportAt(25.0, fixed=("z",))]}


MIXED = Train.joined(
    [Train.of(MASS, 2, 3.0), Train.of(axle_loads(loads=[6e4, 7e4], positions=[0.0, 2.2])), Train.of(BOGIE)],
    [2.0, 1.5],
)

# name -> () -> (crossing, settings). Where nothing else is said: α = 0 for massless wheels, -0.1 for others.
CASES = {
    "sprung mass": lambda: (Crossing(bridge(), Train.of(MASS), speed=30.0, irregularity=WAVE), {}),
    "sprung mass, damped": lambda: (
        Crossing(bridge(), Train.of(sprung_mass(mass=5750.0, stiffness=1.595e6, damping=3e4)), speed=30.0),
        {},
    ),
    "wheel with mass": lambda: (Crossing(bridge(), Train.of(WHEEL, 2, 3.0), speed=30.0, irregularity=BUMP), {}),
    "moving mass": lambda: (Crossing(bridge(), Train.of(rigid_mass(mass=9e3)), speed=30.0), {}),
    "two axles": lambda: (Crossing(bridge(), Train.of(BOGIE), speed=30.0, irregularity=WAVE), {}),
    "three axles": lambda: (Crossing(bridge(), Train.of(COACH), speed=30.0, irregularity=BUMP), {}),
    "vehicle of beams": lambda: (
        Crossing(bridge(), Train.of(beam_car()), speed=30.0, irregularity=BUMP),
        {"footprint": 0.5},
    ),
    "axle loads": lambda: (
        Crossing(bridge(), Train.of(axle_loads(loads=[5e4, 7e4], positions=[0.0, 3.0])), speed=30.0),
        {},
    ),
    "mixed train": lambda: (Crossing(bridge(), MIXED, speed=30.0, irregularity=WAVE), {"method": Alpha(-0.1)}),
    "curved bridge in space": lambda: (
        Crossing(curved_bridge(), Train.of(BOGIE, 2, 6.0), speed=28.0, irregularity=WAVE),
        {"method": Alpha(-0.05)},
    ),
    "two lines": lambda: (Crossing(curved_bridge(Rayleigh(0.2, 1e-4)), two_lines(), speed=28.0), {}),
    "Timoshenko": lambda: (Crossing(bridge(area=5.5, shear_area=4.6), Train.of(MASS, 3, 2.0), speed=30.0), {}),
    "elastic supports": lambda: (
        Crossing(
            bridge(**supported(fixed=(), stiffness={"z": 8e7}, damping={"z": 4e5})), Train.of(MASS, 2, 3.0), speed=30.0
        ),
        {},
    ),
    "settlement": lambda: (
        Crossing(
            continuous_beam(
                **({k: v for k, v in BEAM.items() if k != "length"}),
                spans=[12.0, 13.0],
                elements=4,
                supports=[SupportAt(0.0), SupportAt(12.0, fixed=(), motion={"z": Constant(-0.004)}), SupportAt(25.0)],
            ),
            Train.of(BOGIE),
            speed=30.0,
        ),
        {},
    ),
    "moving base": lambda: (
        Crossing(
            bridge(
                damping=Rayleigh(0.5, 2e-4),
                **supported(fixed=(), motion={"z": HarmonicMotion(3e-3, 3.0), "ry": HarmonicMotion(1e-4, 5.0, 0.4)}),
            ),
            Train.of(MASS, 2, 3.0),
            speed=30.0,
            irregularity=WAVE,
        ),
        {"method": Alpha(-0.1)},
    ),
    "Rayleigh damping": lambda: (
        Crossing(bridge(damping=Rayleigh(0.3, 3e-4)), Train.of(BOGIE), speed=30.0, irregularity=WAVE),
        {"method": Alpha(-0.1)},
    ),
    "modal damping": lambda: (Crossing(bridge(damping=Modal(0.04)), Train.of(BOGIE), speed=30.0), {}),
    "loads on the structure": lambda: (
        Crossing(loaded_bridge(), Train.of(MASS), speed=30.0),
        {"method": Alpha(-0.1)},
    ),
    "alpha without footprint": lambda: (
        Crossing(bridge(), Train.of(WHEEL), speed=30.0),
        {"method": Alpha(-0.1), "footprint": 0.0},
    ),
    "other parameters": lambda: (
        Crossing(bridge(), Train.of(MASS), speed=30.0, irregularity=WAVE),
        {"method": Alpha(-0.05, beta=0.4, gamma=0.7)},
    ),
    "footprint of massless wheels": lambda: (
        Crossing(bridge(), Train.of(MASS, 2, 3.0), speed=30.0),
        {"footprint": 2.0},
    ),
    "starts on the bridge": lambda: (
        Crossing(bridge(), Train.of(COACH, 2, 11.0), speed=20.0, start=17.0, irregularity=WAVE),
        {},
    ),
    "starts before it": lambda: (
        Crossing(bridge(), Train.of(BOGIE, 2, 4.0), speed=30.0, start=-6.0, irregularity=WAVE),
        {},
    ),
    "brakes to a stop": lambda: (
        Crossing(
            bridge(), Train.of(BOGIE), speed_history=[[0.1, 30.0], [0.6, 0.0]], start=5.0, irregularity=WAVE
        ),
        {},
    ),
    "wheels on nodes": lambda: (
        Crossing(bridge(elements=10), Train.of(MASS, 3, 2.5), speed=62.5),
        {},
    ),
    "train longer than the bridge": lambda: (
        Crossing(bridge(elements=4, length=6.0), Train.of(BOGIE, 5, 4.5), speed=30.0),
        {},
    ),
    # Beyond 200 d.o.f. a body is advanced by sparse products and solves.
    "many d.o.f.": lambda: (
        Crossing(viaduct(), Train.of(BOGIE, 2, 5.0), speed=30.0, irregularity=WAVE),
        {"method": Alpha(0.0)},
    ),
    "many d.o.f., damped": lambda: (
        Crossing(viaduct(Rayleigh(0.4, 2e-4)), MIXED, speed=30.0, start=40.0, irregularity=WAVE),
        {"method": Alpha(-0.1), "solver": "superlu"},
    ),
    "one element": lambda: (Crossing(bridge(elements=1, length=5.0), Train.of(BOGIE), speed=20.0), {}),
    "one element, wheels with mass": lambda: (
        Crossing(bridge(elements=1, length=5.0), Train.of(COACH), speed=20.0),
        {},
    ),
}  # fmt: skip


@cache
def run(name, coupling="direct"):
    crossing, settings = CASES[name]()
    length = crossing.structure.length
    length = min(length, 60.0)
    sensors = {"quarter": 0.25 * length, "middle": 0.5 * length, "near the end": 0.97 * length}
    return simulate(crossing, time_step=STEP, steps=STEPS, sensors=sensors, coupling=coupling, **settings)


def bodies(result):
    """D.o.f. of bodies: those that are no contact."""
    return [i for i, name in enumerate(result.vehicle_dof) if "body" in name]


def difference(a, b):
    """Largest difference relative to the peak of b."""
    return np.abs(a - b).max(initial=0.0) / max(np.abs(b).max(initial=0.0), 1e-300)


QUANTITIES = ("sensor_displacement", "contact_force", "support_reaction", "vehicle_displacement")


@pytest.mark.parametrize("name", CASES)
def test_direct_is_literal(name):
    """To 1e-9 of the peak; N12 (18) loses about six digits of the accelerations, so 1e-7 for these."""
    direct, literal = run(name), run(name, "literal")
    assert np.abs(literal.sensor_displacement).max() > 1e-5  # something happens
    for quantity in QUANTITIES:
        assert difference(getattr(direct, quantity), getattr(literal, quantity)) < 1e-9, quantity
    assert difference(direct.sensor_velocity, literal.sensor_velocity) < 1e-8
    assert difference(direct.sensor_acceleration, literal.sensor_acceleration) < 1e-7
    inner = bodies(direct)
    if inner:
        assert difference(direct.vehicle_velocity[:, inner], literal.vehicle_velocity[:, inner]) < 1e-8
        assert (
            difference(direct.vehicle_acceleration[:, inner], literal.vehicle_acceleration[:, inner]) < 1e-7
        )


@pytest.mark.parametrize("name", CASES)
def test_direct_is_refactored(name):
    direct, refactored = run(name), run(name, "refactored")
    for quantity in QUANTITIES:
        assert difference(getattr(refactored, quantity), getattr(direct, quantity)) < 1e-9, quantity


@pytest.mark.parametrize("name", CASES)
def test_checks_are_small(name):
    checks = run(name).checks
    assert checks["finite_values"] is True
    assert checks["compatibility_residual"] < 1e-9
    assert checks["equilibrium_residual"] < 1e-9
    assert checks["energy_residual"] < 1e-9


# The fixed-point iteration converges where the wheels are light beside the bridge's own inertia.
ITERATIVE = [name for name in CASES if "mass" not in name or name == "sprung mass"]


@pytest.mark.parametrize("name", ITERATIVE)
def test_direct_is_iterative(name):
    """Its tolerance is 1e-10 of the largest static force at each step."""
    direct, iterative = run(name), run(name, "iterative")
    for quantity in QUANTITIES:
        assert difference(getattr(iterative, quantity), getattr(direct, quantity)) < 1e-7, quantity
