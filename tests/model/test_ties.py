"""Ties and rigid links against dense elimination, written out in the test."""

import numpy as np
import pytest

from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.model.compile import compile_model
from axlespan.model.model import Model

BEAM = BeamProperties(
    axial_stiffness=2e9,
    bending_stiffness_y=8e8,
    bending_stiffness_z=3e8,
    torsional_stiffness=1e8,
    mass_per_length=900.0,
    rotary_inertia_y=40.0,
    rotary_inertia_z=20.0,
)


def full_matrices(model):
    """Stiffness, mass, damping and names of the model without its ties."""
    free = compile_model(
        Model(model.points, model.plane, model.node_names, model.parts, damping=model.damping)
    ).system
    return free.stiffness.toarray(), free.mass.toarray(), free.damping.toarray(), free.dof_names


def check_projection(system, transform, names, full):
    """The system's matrices are TᵀKT for a T whose columns follow the system's independent d.o.f."""
    order = [names.index(system.dof_names[i]) for i in system.independent]
    t = transform[:, order]
    for got, matrix in zip((system.stiffness, system.mass, system.damping), full, strict=True):
        expected = t.T @ matrix @ t
        np.testing.assert_allclose(got.toarray(), expected, atol=1e-13 * max(np.abs(expected).max(), 1.0))
    # The elimination gives back all d.o.f. of the model.
    place = [names.index(name) for name in system.dof_names]
    np.testing.assert_allclose(system.elimination.toarray(), t[place], atol=1e-14)


def test_a_chain_of_ties_is_resolved():
    """c follows b, b follows a: given in either order, c is 3 · 2 · a."""
    base = Model().with_nodes([[0, 0], [1, 0], [2, 0], [3, 0]], ["a", "b", "c", "d"])
    base = base.with_springs([[0, 1], [1, 2], [2, 3]], {"z": 5e5}, {"z": 300.0}).with_mass(
        2, 40.0, directions=("z",)
    )
    first, second = (("b", "z"), [("a", "z", 2.0)]), (("c", "z"), [("b", "z", 3.0), ("d", "z", 0.5)])
    for ties in ((first, second), (second, first)):
        model = base
        for slave, masters in ties:
            model = model.with_tie(slave, masters)
        system = compile_model(model).system
        *full, names = full_matrices(model)
        transform = np.eye(4)
        transform[names.index("b.z")] = 2.0 * np.eye(4)[names.index("a.z")]
        transform[names.index("c.z")] = (
            6.0 * np.eye(4)[names.index("a.z")] + 0.5 * np.eye(4)[names.index("d.z")]
        )
        assert [system.dof_names[i] for i in system.independent] == ["a.z", "d.z"]
        check_projection(system, transform, names, full)


def test_a_long_chain_of_ties():
    """Twenty nodes, each tied to the one before: one mass of twenty."""
    model = Model().with_nodes(np.column_stack([np.arange(20.0), np.zeros(20)]))
    for i in range(20):
        model = model.with_mass(i, 1.5, directions=("z",))
    for i in range(19, 0, -1):
        model = model.with_tie((i, "z"), [(i - 1, "z", 1.0)])
    system = compile_model(model.with_springs([[0, 19]], {"z": 1e3})).system
    np.testing.assert_allclose(system.mass.toarray(), [[30.0]], rtol=1e-14)
    np.testing.assert_allclose(system.stiffness.toarray(), [[0.0]], atol=1e-9)


def test_rigid_link_in_space():
    """A beam whose end is bound to a node off its axis: u + θ × arm, rotations alike."""
    model = Model(plane=False).with_nodes([[0, 0, 0], [4, 0, 0], [4.5, 0.7, -1.2]], ["root", "tip", "master"])
    model = model.with_beams([[0, 1]], BEAM).with_mass("master", 500.0, {"rx": 30.0, "ry": 50.0, "rz": 70.0})
    model = model.with_rigid_link("master", ["tip"])
    *full, names = full_matrices(model)
    transform = np.eye(18)
    arm = np.array([4, 0, 0]) - np.array([4.5, 0.7, -1.2])
    for i, part in enumerate("xyz"):
        row = np.zeros(18)
        row[names.index(f"master.{part}")] = 1.0
        for j, axis in enumerate("xyz"):
            row[names.index(f"master.r{axis}")] = np.cross(np.eye(3)[j], arm)[i]
        transform[names.index(f"tip.{part}")] = row
        transform[names.index(f"tip.r{part}")] = np.eye(18)[names.index(f"master.r{part}")]
    system = compile_model(model).system
    check_projection(system, transform, names, full)
    assert system.total_mass("x") == pytest.approx(500.0 + 3600.0)


def test_rigid_link_in_the_plane():
    """The wheel seat of a body: z_seat = z - ry · arm, positive pitch lowers the front."""
    model = Model().with_nodes([[-2.0, 1.0], [0.0, 1.0], [0.0, 0.0]], ["body", "seat", "wheel"])
    model = model.with_mass("body", 900.0, {"ry": 1200.0}, directions=("z",))
    model = model.with_rigid_link("body", ["seat"], ("z",)).with_springs([[1, 2]], {"z": 4e5})
    system = compile_model(model).system
    names = [system.dof_names[i] for i in system.independent]
    assert names == ["body.z", "body.ry", "wheel.z"]
    row = np.array([1.0, -2.0, -1.0])  # stretch of the spring
    np.testing.assert_allclose(system.stiffness.toarray(), 4e5 * np.outer(row, row), rtol=1e-13)


def test_loads_on_tied_dofs_act_on_the_masters():
    model = Model().with_nodes([[0, 0], [1, 0]], ["a", "b"]).with_mass("a", 10.0, directions=("z",))
    model = model.with_springs([[0, 1]], {"z": 1.0}).with_tie(("b", "z"), [("a", "z", 0.25)])
    system = compile_model(model.with_load("b", "z", -800.0)).system
    np.testing.assert_allclose(system.loads[0].vector, [-200.0])


def test_ties_may_be_given_in_any_order():
    """The slave of the first tie takes part only because the second tie names it."""
    model = Model().with_nodes([[0, 0], [1, 0], [2, 0], [3, 0]], ["a", "b", "c", "d"])
    model = model.with_springs([[0, 1]], {"z": 1e6}).with_mass("b", 8.0, directions=("z",))
    model = model.with_tie(("c", "z"), [("d", "z", 1.0)]).with_tie(("b", "z"), [("c", "z", 1.0)])
    system = compile_model(model).system
    assert [system.dof_names[i] for i in system.independent] == ["a.z", "d.z"]
    np.testing.assert_allclose(system.mass.toarray(), np.diag([0.0, 8.0]))
    np.testing.assert_allclose(system.stiffness.toarray(), [[1e6, -1e6], [-1e6, 1e6]])


def test_a_circle_of_ties_is_refused():
    model = (
        Model()
        .with_nodes([[0, 0], [1, 0], [2, 0]], ["a", "b", "c"])
        .with_springs([[0, 1], [1, 2]], {"z": 1e6})
    )
    model = model.with_tie(("a", "z"), [("b", "z", 0.5)]).with_tie(("b", "z"), [("a", "z", 0.5)])
    with pytest.raises(InputError, match="must not form a circle"):
        compile_model(model)


def test_a_dof_tied_twice_is_refused():
    model = (
        Model()
        .with_nodes([[0, 0], [1, 0], [2, 0]], ["a", "b", "c"])
        .with_springs([[0, 1], [1, 2]], {"z": 1e6})
    )
    model = model.with_tie(("b", "z"), [("a", "z", 1.0)]).with_tie(("b", "z"), [("c", "z", 1.0)])
    with pytest.raises(InputError, match=r"'b\.z': is tied twice"):
        compile_model(model)


def test_a_support_on_a_tied_dof_is_refused():
    model = Model().with_nodes([[0, 0], [1, 0]], ["a", "b"]).with_springs([[0, 1]], {"z": 1e6})
    model = model.with_tie(("b", "z"), [("a", "z", 1.0)]).with_support("b", ["z"], name="bearing")
    with pytest.raises(InputError, match=r"'bearing\.z': is both supported and tied"):
        compile_model(model)


def test_a_support_may_hold_a_master():
    """Settling the master moves the tied node: the spring between them and the ground is stretched."""
    model = Model().with_nodes([[0, 0], [1, 0], [2, 0]], ["a", "b", "c"])
    model = model.with_springs([[1, 2]], {"z": 2e5}).with_mass("c", 1.0, directions=("z",))
    model = model.with_tie(("b", "z"), [("a", "z", 1.0)]).with_support("a", ["z"])
    blocks = compile_model(model).system.partition
    np.testing.assert_allclose(blocks.K_FP.toarray(), [[-2e5]])
    np.testing.assert_allclose(blocks.K_PP.toarray(), [[2e5]])
