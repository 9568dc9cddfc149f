"""Simple vehicles: their matrices, static forces, and what is refused."""

import numpy as np
import pytest

from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.model.compile import compile_model
from axlespan.model.model import Model
from axlespan.vehicles.simple import axle_loads, rigid_body, rigid_mass, sprung_mass
from axlespan.vehicles.vehicle import ContactPoint, Vehicle

G = 9.81


def by_name(system, matrix, names):
    at = [list(system.independent).index(system.dof(name)) for name in names]
    return matrix.toarray()[np.ix_(at, at)]


def test_sprung_mass():
    vehicle = sprung_mass(mass=5750.0, stiffness=1.595e6, damping=2e4, unsprung_mass=300.0)
    system, names = vehicle.system, ("body.z", "wheel1.z")
    pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
    np.testing.assert_array_equal(by_name(system, system.stiffness, names), 1.595e6 * pair)
    np.testing.assert_array_equal(by_name(system, system.damping, names), 2e4 * pair)
    np.testing.assert_array_equal(by_name(system, system.mass, names), np.diag([5750.0, 300.0]))
    np.testing.assert_allclose(vehicle.static_forces(), [6050.0 * G])
    np.testing.assert_allclose(vehicle.static_forces(1.62), [6050.0 * 1.62])
    assert (vehicle.has_massive_contacts, vehicle.has_dashpot_contacts, vehicle.is_force) == (
        True,
        True,
        False,
    )
    light = sprung_mass(mass=5750.0, stiffness=1.595e6)
    assert (light.has_massive_contacts, light.has_dashpot_contacts) == (False, False)
    np.testing.assert_allclose(light.frequencies(), [np.sqrt(1.595e6 / 5750.0) / (2 * np.pi)])


def test_rigid_mass():
    vehicle = rigid_mass(mass=800.0)
    np.testing.assert_allclose(vehicle.static_forces(), [800.0 * G])
    assert vehicle.system.dof_names == ("wheel1.z",)
    assert vehicle.has_massive_contacts
    assert len(vehicle.frequencies()) == 0


def test_axle_loads():
    vehicle = axle_loads(loads=[1e5, 2e5], positions=[0.0, 2.5])
    np.testing.assert_array_equal(vehicle.static_forces(), [1e5, 2e5])
    assert vehicle.is_force
    assert [point.behind for point in vehicle.contacts] == [0.0, 2.5]
    np.testing.assert_array_equal(axle_loads(loads=7e4, positions=[0.0, 1.0, 3.0]).static_forces(), [7e4] * 3)
    np.testing.assert_array_equal(
        axle_loads(loads=np.array([1e5, 2e5]), positions=np.array([0.0, 2.5])).static_forces(), [1e5, 2e5]
    )


class TestRigidBody:
    def test_matrices(self):
        """Potential ½ Σ k (z - θ a_i - w_i)²: positive pitch lowers the front, a_i > 0 ahead of the center."""
        body = rigid_body(
            mass=4e4,
            pitch_inertia=1.2e6,
            axles=[0.0, 5.0, 12.0],
            stiffness=[1e6, 2e6, 3e6],
            damping=1e4,
            center=6.5,
        )
        system = body.system
        names = ("body.z", "body.pitch", "wheel1.z", "wheel2.z", "wheel3.z")
        arms = 6.5 - np.array([0.0, 5.0, 12.0])
        k, c = np.zeros((5, 5)), np.zeros((5, 5))
        for i, stiffness in enumerate((1e6, 2e6, 3e6)):
            row = np.zeros(5)
            row[[0, 1, 2 + i]] = 1.0, -arms[i], -1.0
            k += stiffness * np.outer(row, row)
            c += 1e4 * np.outer(row, row)
        np.testing.assert_allclose(by_name(system, system.stiffness, names), k, atol=1e-8)
        np.testing.assert_allclose(by_name(system, system.damping, names), c, atol=1e-10)
        np.testing.assert_allclose(by_name(system, system.mass, names), np.diag([4e4, 1.2e6, 0, 0, 0]))

    def test_two_axles_share_by_the_lever_rule(self):
        body = rigid_body(
            mass=3e4,
            pitch_inertia=1e6,
            axles=[0.0, 8.0],
            stiffness=[1e6, 4e6],
            unsprung_mass=[100.0, 700.0],
            center=2.0,
        )
        np.testing.assert_allclose(
            body.static_forces(), [(22500.0 + 100.0) * G, (7500.0 + 700.0) * G], rtol=1e-12
        )

    def test_three_axles_share_by_their_stiffness(self):
        """Statically indeterminate: z and θ from equilibrium, spring by spring, in the test."""
        axles, k, center, mass = np.array([0.0, 4.0, 11.0]), np.array([1e6, 2e6, 1.5e6]), 5.0, 2.8e4
        body = rigid_body(mass=mass, pitch_inertia=9e5, axles=axles, stiffness=list(k), center=center)
        rows = np.column_stack([np.ones(3), -(center - axles)])
        z, theta = np.linalg.solve(rows.T @ (k[:, None] * rows), [-mass * G, 0.0])
        np.testing.assert_allclose(body.static_forces(), -k * (rows @ [z, theta]), rtol=1e-11)
        assert body.static_forces().sum() == pytest.approx(mass * G)

    def test_the_center_is_in_the_middle_by_default(self):
        body = rigid_body(mass=3e4, pitch_inertia=1e6, axles=[0.0, 3.0, 9.0], stiffness=1e6)
        moment = body.static_forces() @ (4.5 - np.array([0.0, 3.0, 9.0]))
        assert moment == pytest.approx(0.0, abs=1e-6)
        assert body.has_massive_contacts is False

    def test_a_wheel_that_would_pull_is_named(self):
        with pytest.raises(InputError, match=r"wheel '2' of vehicle 'rigid body'.*must press on the line"):
            rigid_body(
                mass=1e4, pitch_inertia=1e5, axles=[0.0, 4.0], stiffness=1e6, center=-1.0
            ).static_forces()

    def test_without_gravity_nothing_presses(self):
        body = rigid_body(mass=1e4, pitch_inertia=1e5, axles=[0.0, 4.0], stiffness=1e6)
        np.testing.assert_allclose(body.static_forces(0.0), 0.0, atol=1e-9)


def beam_car(unsprung=0.0):
    """A car body of beams, its wheels right under its ends."""
    beams = BeamProperties(bending_stiffness_y=3e8, mass_per_length=2000.0)
    x = -np.linspace(0.0, 9.0, 5)
    model = Model().with_nodes(np.column_stack([x, np.zeros(5)]), ["front", "b", "c", "d", "rear"])
    model = model.with_beams([[0, 1], [1, 2], [2, 3], [3, 4]], beams)
    if unsprung:
        model = model.with_mass("front", unsprung).with_mass("rear", unsprung)
    points = (ContactPoint("1", 0.0, "front.z"), ContactPoint("2", 9.0, "rear.z"))
    return Vehicle(points, compile_model(model).system, "beam car")


def test_a_vehicle_of_beams_stands_on_its_ends():
    np.testing.assert_allclose(beam_car(250.0).static_forces(), [(9000.0 + 250.0) * G] * 2, rtol=1e-10)
    assert beam_car().has_massive_contacts


def test_as_axle_loads():
    forces = beam_car(250.0).as_axle_loads()
    assert forces.is_force
    np.testing.assert_allclose(forces.static_forces(), [9250.0 * G] * 2, rtol=1e-10)
    assert [(p.name, p.behind) for p in forces.contacts] == [("1", 0.0), ("2", 9.0)]


class TestMechanisms:
    def test_a_body_without_springs_is_named(self):
        model = Model().with_nodes([[0, 0], [0, 1], [0, 2]], ["wheel", "body", "roof"])
        model = model.with_springs([[0, 1]], {"z": 1e6}).with_mass("body", 100.0, directions=("z",))
        model = model.with_mass("roof", 50.0, directions=("z",))
        vehicle = Vehicle((ContactPoint("1", 0.0, "wheel.z"),), compile_model(model).system, "wagon")
        with pytest.raises(
            InputError, match=r"'wagon': must stand on its wheels, but can move freely at roof\.z"
        ):
            vehicle.static_forces()

    def test_a_body_that_pitches_on_one_axle_is_named(self):
        model = Model().with_nodes([[0, 0], [0, 1]], ["wheel", "body"])
        model = model.with_springs([[0, 1]], {"z": 1e6}).with_mass(
            "body", 100.0, {"ry": 5.0}, directions=("z",)
        )
        vehicle = Vehicle((ContactPoint("1", 0.0, "wheel.z"),), compile_model(model).system)
        with pytest.raises(InputError, match=r"can move freely at body\.ry"):
            vehicle.static_forces()


def two_axles(pitch_inertia=1.0, axles=(0.0, 2.0), stiffness=1.0):
    return rigid_body(mass=1.0, pitch_inertia=pitch_inertia, axles=axles, stiffness=stiffness)


@pytest.mark.parametrize(
    ("build", "rule"),
    [
        (lambda: sprung_mass(mass=0.0, stiffness=1.0), "mass = 0.0: must be positive"),
        (lambda: sprung_mass(mass=1.0, stiffness=-1.0), "stiffness = -1.0: must be positive"),
        (lambda: sprung_mass(mass=1.0, stiffness=1.0, damping=-1.0), "damping = -1.0: must be zero or positive"),
        (lambda: rigid_mass(mass=float("nan")), "mass = nan: must be positive"),
        (lambda: axle_loads(loads=[1.0, -2.0], positions=[0.0, 1.0]), r"loads\.1 = -2\.0: must be positive"),
        (lambda: axle_loads(loads=[1.0], positions=[0.0, 1.0]), "must be one load, or one for each axle"),
        (lambda: axle_loads(loads=1.0, positions=[1.0, 2.0]), "must have its first wheel at 0"),
        (lambda: two_axles(axles=[0.0]), "must be two or more increasing"),
        (lambda: two_axles(axles=[0.0, 2.0, 1.0]), "must be two or more increasing"),
        (lambda: two_axles(pitch_inertia=0.0), "pitch_inertia = 0.0: must be positive"),
        (lambda: two_axles(stiffness=[1.0]), "one for each of the 2 axles"),
        (lambda: two_axles(stiffness=[1.0, 0.0]), r"stiffness\.1"),
        (lambda: Vehicle(()), "must have at least one wheel"),
        (lambda: Vehicle((ContactPoint("1", 0.0), ContactPoint("1", 2.0))), "must have different names"),
    ],
)  # fmt: skip
def test_errors(build, rule):
    with pytest.raises(InputError, match=rule):
        build()


class TestContactDofs:
    MODEL = (
        Model()
        .with_nodes([[0, 0], [0, 1], [-2, 0]], ["wheel", "body", "other"])
        .with_springs([[0, 1], [2, 1]], {"z": 1e6})
        .with_mass("body", 100.0, directions=("z",))
    )

    def vehicle(self, *dofs, model=None):
        points = tuple(ContactPoint(str(i + 1), 2.0 * i, dof) for i, dof in enumerate(dofs))
        return Vehicle(points, compile_model(model or self.MODEL).system)

    def test_are_free_dofs(self):
        supported = self.MODEL.with_support("other", ["z"])
        vehicle = self.vehicle("wheel.z", model=supported)
        assert vehicle.system.free_name(int(vehicle.contact_dofs[0])) == "wheel.z"
        with pytest.raises(InputError, match=r"'other\.z': must be free"):
            _ = self.vehicle("other.z", model=supported).contact_dofs

    def test_unknown(self):
        with pytest.raises(InputError, match=r"Did you mean 'wheel\.z'"):
            _ = self.vehicle("wheels.z").contact_dofs

    def test_twice(self):
        with pytest.raises(InputError, match="must touch the line with different"):
            _ = self.vehicle("wheel.z", "wheel.z").contact_dofs

    def test_tied(self):
        tied = self.MODEL.with_tie(("other", "z"), [("body", "z", 1.0)])
        with pytest.raises(InputError, match=r"'other\.z': must be free and not tied"):
            _ = self.vehicle("other.z", model=tied).contact_dofs
