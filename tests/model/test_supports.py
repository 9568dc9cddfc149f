"""Fixed, elastic and moved supports against statics by hand."""

import numpy as np
import pytest

from axlespan.bridges.spans import SupportAt, continuous_beam, simple_span
from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.model.compile import compile_model
from axlespan.model.model import Model
from axlespan.model.motions import Constant, HarmonicMotion

EI = 2.87e9 * 2.9
BEAM = {"youngs_modulus": 2.87e9, "second_moment": 2.9, "mass_per_length": 2303.0}


def static(system, load=None):
    """Free displacements and reactions with the supports where their motions are at t = 0."""
    blocks = system.partition
    u_p = np.array([float(motion.value(np.zeros(1))[0]) for motion in system.motions])
    force = np.zeros(len(system.free)) if load is None else load[system.free]
    k = blocks.K_FF.toarray()
    u = np.linalg.solve(k, force - blocks.K_FP.toarray() @ u_p)
    reactions = blocks.K_FP.toarray().T @ u + blocks.K_PP.toarray() @ u_p
    if load is not None:
        reactions -= load[system.prescribed]
    return u, reactions


def unit_load(system, name, amount):
    load = np.zeros(system.size)
    load[list(system.independent).index(system.dof(name))] = amount
    return load


def test_fixed_ends_share_a_force():
    bridge = simple_span(length=20.0, elements=8, **BEAM)
    u, reactions = static(bridge.system, unit_load(bridge.system, "n3.z", -1000.0))
    assert bridge.system.support_names == ("left.z", "right.z")
    np.testing.assert_allclose(reactions, [750.0, 250.0], rtol=1e-10)
    # Under the force at a quarter: P a² b² / 3 EI L.
    at = [bridge.system.free_name(i) for i in range(len(u))].index("n3.z")
    assert u[at] == pytest.approx(-1000.0 * 5.0**2 * 15.0**2 / (3 * EI * 20.0), rel=1e-10)


def test_clamped_ends():
    supports = [SupportAt(0.0, ("z", "ry"), name="a"), SupportAt(20.0, ("z", "ry"), name="b")]
    bridge = simple_span(length=20.0, elements=4, supports=supports, **BEAM)
    _, reactions = static(bridge.system, unit_load(bridge.system, "n3.z", -1000.0))
    assert bridge.system.support_names == ("a.z", "a.ry", "b.z", "b.ry")
    # Clamping moments P L / 8; about y, the left one turns the beam's end up, which is negative ry.
    np.testing.assert_allclose(reactions, [500.0, -2500.0, 500.0, 2500.0], rtol=1e-10)


def test_elastic_supports_are_springs_in_series():
    supports = [SupportAt(0.0, (), stiffness={"z": 4e6}), SupportAt(20.0, (), stiffness={"z": 1e6})]
    bridge = simple_span(length=20.0, elements=4, supports=supports, **BEAM)
    u, reactions = static(bridge.system, unit_load(bridge.system, "n3.z", -1000.0))
    names = [bridge.system.free_name(i) for i in range(len(u))]
    values = dict(zip(names, u, strict=True))
    assert values["n1.z"] == pytest.approx(-500.0 / 4e6)
    assert values["n5.z"] == pytest.approx(-500.0 / 1e6)
    assert values["n3.z"] == pytest.approx(-0.5 * (500.0 / 4e6 + 500.0 / 1e6) - 1000.0 * 20.0**3 / (48 * EI))
    np.testing.assert_allclose(reactions, [500.0, 500.0], rtol=1e-10)
    assert bridge.system.support_names == ("support1.z", "support2.z")


def test_the_ground_of_an_elastic_support_may_move():
    supports = [
        SupportAt(0.0, (), stiffness={"z": 4e6}, motion={"z": Constant(-0.02)}),
        SupportAt(20.0, (), stiffness={"z": 1e6}, motion={"z": Constant(-0.01)}),
    ]
    bridge = simple_span(length=20.0, elements=2, supports=supports, **BEAM)
    u, reactions = static(bridge.system)
    names = [bridge.system.free_name(i) for i in range(len(u))]
    values = dict(zip(names, u, strict=True))
    # Statically determinate: it follows the ground as a rigid body; a rise of 0.01 in 20 m is ry = -5e-4.
    np.testing.assert_allclose([values[f"n{i}.z"] for i in (1, 2, 3)], [-0.02, -0.015, -0.01], rtol=1e-9)
    np.testing.assert_allclose([values[f"n{i}.ry"] for i in (1, 2, 3)], -5e-4, rtol=1e-7)
    np.testing.assert_allclose(reactions, 0.0, atol=1e-4)


def test_a_dashpot_support():
    supports = [SupportAt(0.0, (), stiffness={"z": 4e6}, damping={"z": 7e3}), SupportAt(20.0)]
    system = simple_span(length=20.0, elements=2, supports=supports, **BEAM).system
    index = list(system.independent).index(system.dof("n1.z"))
    assert system.damping.toarray()[index, index] == 7e3
    assert system.partition.C_FP.toarray().min() == -7e3


def test_settlement_of_a_middle_support():
    """Two equal spans: R = 6 EI δ / L³ pulls the middle support down, half of it at each end."""
    supports = [
        SupportAt(0.0, name="a"),
        SupportAt(10.0, motion={"z": Constant(-0.01)}, name="b"),
        SupportAt(20.0, name="c"),
    ]
    bridge = continuous_beam(spans=[10.0, 10.0], elements=5, supports=supports, **BEAM)
    _, reactions = static(bridge.system)
    middle = -6.0 * EI * 0.01 / 10.0**3
    np.testing.assert_allclose(reactions, [-0.5 * middle, middle, -0.5 * middle], rtol=1e-9)


def test_a_prescribed_rotation():
    """A clamped end turned by φ: M = 3 EI φ / L on a propped beam."""
    supports = [SupportAt(0.0, ("z",), motion={"ry": Constant(1e-3)}), SupportAt(12.0)]
    bridge = simple_span(length=12.0, elements=3, supports=supports, **BEAM)
    _, reactions = static(bridge.system)
    assert bridge.system.support_names == ("support1.z", "support1.ry", "support2.z")
    shear = 3.0 * EI * 1e-3 / 12.0**2
    np.testing.assert_allclose(reactions, [-shear, 3.0 * EI * 1e-3 / 12.0, shear], rtol=1e-9)


def test_supports_between_nodes_get_a_node():
    bridge = simple_span(
        length=20.0, elements=4, supports=[SupportAt(0.0), SupportAt(7.5), SupportAt(20.0)], **BEAM
    )
    np.testing.assert_allclose(bridge.model.points[:, 0], [0.0, 5.0, 7.5, 10.0, 15.0, 20.0])
    np.testing.assert_allclose(bridge.lines["main"].breaks, [0.0, 5.0, 7.5, 10.0, 15.0, 20.0])
    assert bridge.system.partition.K_PP.shape == (3, 3)


def test_spans_have_their_own_properties():
    bridge = continuous_beam(
        spans=[10.0, 30.0],
        youngs_modulus=[2e9, 4e9],
        second_moment=[1.0, 2.0],
        mass_per_length=[1000.0, 3000.0],
        elements=[2, 6],
    )
    assert bridge.system.support_names == ("left.z", "support2.z", "right.z")
    assert bridge.system.total_mass() == pytest.approx(10_000.0 + 90_000.0)
    # Clapeyron's three moments with a force at the middle of the second span.
    load = unit_load(bridge.system, "n6.z", -1000.0)
    _, reactions = static(bridge.system, load)
    l1, l2, b1, b2 = 10.0, 30.0, 2e9, 8e9
    moment = -(3.0 / 8.0 * 1000.0 * l2**2 / b2) / (2.0 * (l1 / b1 + l2 / b2))
    np.testing.assert_allclose(
        reactions, [moment / l1, 500.0 - moment / l1 - moment / l2, 500.0 + moment / l2], rtol=1e-9
    )


def test_motion_objects_stay_with_their_support():
    motion = HarmonicMotion(0.01, 2.0)
    bridge = simple_span(
        length=20.0, elements=2, supports=[SupportAt(0.0, motion={"z": motion}), SupportAt(20.0)], **BEAM
    )
    assert bridge.system.motions == (motion, Constant(0.0))


class TestErrors:
    MODEL = (
        Model()
        .with_nodes([[0, 0], [5, 0]], ["a", "b"])
        .with_beams([[0, 1]], BeamProperties(bending_stiffness_y=1e9, mass_per_length=1.0))
    )

    def test_supported_twice(self):
        with pytest.raises(InputError, match=r"'a\.z': is (supported twice|already the name of a support)"):
            self.MODEL.with_support("a", ["z"]).with_support("a", ["z", "ry"])

    def test_no_such_dof(self):
        with pytest.raises(InputError, match=r"'a\.x': has no x at this node"):
            compile_model(self.MODEL.with_support("a", ["x"]))

    def test_unknown_component(self):
        with pytest.raises(InputError, match="'w': must be one of x, y, z, rx, ry, rz"):
            self.MODEL.with_support("a", ["w"])

    def test_off_the_beam(self):
        with pytest.raises(InputError, match=r"support position = 21\.0: must be between 0 and 20 m"):
            simple_span(length=20.0, elements=4, supports=[SupportAt(21.0)], **BEAM)

    def test_fixed_and_elastic_at_once(self):
        with pytest.raises(InputError, match=r"'a\.z': is held in two ways at once"):
            self.MODEL.with_support("a", ["z"], stiffness={"z": 1e6})

    def test_two_supports_of_one_name(self):
        """Reactions are told apart by the name."""
        with pytest.raises(InputError, match="name"):
            simple_span(
                length=20.0,
                elements=4,
                supports=[SupportAt(0.0, name="a"), SupportAt(20.0, name="a")],
                **BEAM,
            )

    def test_negative_stiffness(self):
        with pytest.raises(InputError, match=r"must be zero or positive"):
            self.MODEL.with_support("a", stiffness={"z": -1.0})
