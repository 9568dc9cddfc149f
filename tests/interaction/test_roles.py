"""Structure and vehicle are equals: two bodies on springs that touch feel the same force in either role."""

import numpy as np
import pytest

from axlespan.dynamics.alpha import Alpha
from axlespan.elements.beam import BeamProperties
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.simulate import simulate
from axlespan.irregularity import Bump
from axlespan.model.compile import compile_model
from axlespan.model.model import Model
from axlespan.running.line import path_on_beams
from axlespan.running.structure import Structure
from axlespan.vehicles.train import Train
from axlespan.vehicles.vehicle import ContactPoint, Vehicle

# mass [kg], stiffness [N/m], damping [N s/m]
ONE, TWO = (4e3, 1.6e6, 8e3), (9e3, 9e5, 3e3)
LENGTH = 40.0


def platform(mass, stiffness, damping):
    """A rigid platform on a spring that can only heave: the same everywhere along its line."""
    beams = BeamProperties(bending_stiffness_y=1e6, mass_per_length=mass / LENGTH)
    model = Model().with_nodes([[0, 0], [LENGTH, 0]], ["left", "right"]).with_beams([[0, 1]], beams)
    model = model.with_rigid_link("left", ["right"], ("z", "ry"))
    model = model.with_support("left", ["ry"], stiffness={"z": stiffness}, damping={"z": damping})
    compiled = compile_model(model)
    line = path_on_beams(model, compiled.table, ["left", "right"])
    return Structure(compiled.system, {"main": line.transformed(compiled.system.elimination)})


def hanger(mass, stiffness, damping):
    """The same body as a vehicle: a mass on a spring to a wall, which slides along the line."""
    model = Model().with_nodes([[0, 0], [0, 2]], ["body", "wall"]).with_mass("body", mass, directions=("z",))
    model = model.with_springs([[1, 0]], {"z": stiffness}, {"z": damping}).with_support("wall", ["z"])
    return Vehicle((ContactPoint("1", 0.0, "body.z"),), compile_model(model).system, "hanger")


def run(structure, vehicle, coupling="direct"):
    crossing = Crossing(
        platform(*structure),
        Train.of(hanger(*vehicle)),
        speed=20.0,
        start=5.0,
        irregularity=Bump(center=15.0, height=3e-3, length=12.0),
        gravity=0.0,
    )
    return simulate(
        crossing,
        time_step=1e-3,
        steps=1500,
        method=Alpha(-0.1),
        footprint=0.0,
        sensors={"here": 20.0},
        coupling=coupling,
    )


def test_the_contact_force_does_not_know_who_is_who():
    first, second = run(ONE, TWO), run(TWO, ONE)
    peak = np.abs(first.contact_force).max()
    assert peak > 1e3
    assert np.abs(first.contact_force - second.contact_force).max() < 1e-9 * peak
    # What one does upward as a vehicle, it does downward as a structure.
    as_vehicle, as_structure = (
        first.at("vehicle_displacement", "1.body.z"),
        second.at("sensor_displacement", "here"),
    )
    np.testing.assert_allclose(as_structure, -as_vehicle, atol=1e-9 * np.abs(as_vehicle).max())


@pytest.mark.parametrize("alpha", [-0.1])
def test_both_bodies_at_once_by_hand(alpha):
    """With the gap r between them: (m1 + m2) ü + (c1 + c2) u̇ + (k1 + k2) u = -(m2 r̈ + c2 ṙ + k2 r)."""
    (m1, c1, k1), (m2, c2, k2) = ((m, c, k) for m, k, c in (ONE, TWO))
    result = run(ONE, TWO)
    bump, dt = Bump(center=15.0, height=3e-3, length=12.0), 1e-5
    t = np.arange(150_001) * dt
    x = 5.0 + 20.0 * t
    load = -(m2 * 400.0 * bump.curvature(x) + c2 * 20.0 * bump.slope(x) + k2 * bump.value(x))
    # Central differences with steps a hundred times shorter.
    m, c, k = m1 + m2, c1 + c2, k1 + k2
    u = [0.0, 0.5 * dt**2 * load[0] / m]
    a, b = m / dt**2 + 0.5 * c / dt, m / dt**2 - 0.5 * c / dt
    for f in load[1:-1].tolist():
        u.append((f - (k - 2.0 * m / dt**2) * u[-1] - b * u[-2]) / a)
    exact = np.array(u)[::100]
    computed = result.at("sensor_displacement", "here")
    assert np.abs(computed - exact).max() < 1e-3 * np.abs(exact).max()
