"""Names of nodes, d.o.f. and parts, and what is said when one is wrong."""

import numpy as np
import pytest

from axlespan.elements.beam import BeamProperties
from axlespan.errors import InputError
from axlespan.model.compile import compile_model
from axlespan.model.dofs import DofTable, component_indices, nearest
from axlespan.model.model import Model

EB = BeamProperties(bending_stiffness_y=1e9, mass_per_length=100.0)
MODEL = (
    Model().with_nodes([[0, 0], [5, 0], [10, 0]], ["abutment", "midspan"]).with_beams([[0, 1], [1, 2]], EB)
)


def test_nodes_by_name_number_and_automatic_name():
    assert (MODEL.node("midspan"), MODEL.node(1), MODEL.node("n2"), MODEL.node(np.int64(1))) == (1, 1, 1, 1)
    assert MODEL.node_labels() == ["abutment", "midspan", "n3"]
    assert [MODEL.node_label(i) for i in range(3)] == MODEL.node_labels()


def test_a_misspelt_node_gets_the_nearest_name():
    with pytest.raises(InputError, match=r"node = 'midspn': is not a known node\. Did you mean 'midspan'\?"):
        MODEL.node("midspn")


def test_an_unknown_node_gets_the_known_names():
    with pytest.raises(InputError, match=r"Known: abutment, midspan"):
        MODEL.node("q")


@pytest.mark.parametrize("reference", [3, -1])
def test_node_numbers_out_of_range(reference):
    with pytest.raises(InputError, match=rf"node = {reference}: must be a node between 0 and 2"):
        MODEL.node(reference)


@pytest.mark.parametrize("reference", ["n0", "n4"])
def test_automatic_names_out_of_range(reference):
    with pytest.raises(InputError, match="is not a known node"):
        MODEL.node(reference)


def test_dof_names_follow_nodes_and_components():
    system = compile_model(MODEL).system
    assert system.dof_names == ("abutment.z", "abutment.ry", "midspan.z", "midspan.ry", "n3.z", "n3.ry")
    assert system.dof("midspan.ry") == 3
    with pytest.raises(
        InputError, match=r"'midspan\.rz': is not a known degree of freedom\. Did you mean 'midspan\.r?"
    ):
        system.dof("midspan.rz")


def test_free_names_skip_supports():
    system = compile_model(MODEL.with_support("abutment", ["z"])).system
    assert [system.free_name(i) for i in range(2)] == ["abutment.ry", "midspan.z"]


def test_renamed_dofs_keep_their_meaning():
    """Weight and mass follow the component of a d.o.f., not its name."""
    system = compile_model(MODEL).system
    renamed = system.renamed({"midspan.z": "sag"})
    assert renamed.dof("sag") == system.dof("midspan.z")
    np.testing.assert_array_equal(renamed.weight(9.81), system.weight(9.81))
    assert renamed.total_mass() == pytest.approx(1000.0)


def test_names_are_unique():
    with pytest.raises(InputError, match="node = 'midspan': is already the name of a node"):
        MODEL.with_nodes([[20, 0]], ["midspan"])
    with pytest.raises(InputError, match="'n1'"):
        MODEL.with_nodes([[20, 0]], ["n1"])
    with pytest.raises(InputError, match="at most one for each"):
        MODEL.with_nodes([[20, 0]], ["a", "b"])


def test_models_do_not_change():
    more = MODEL.with_nodes([[20, 0]], ["far"]).with_support(0, ["z"]).with_load(1, "z", -1.0)
    assert (len(MODEL.points), len(more.points)) == (3, 4)
    assert (MODEL.supports, MODEL.loads) == ((), ())
    assert "far" not in MODEL.node_names


def test_point_masses_move_where_the_elements_do():
    """On a beam without axial stiffness a point mass has no x of its own."""
    system = compile_model(MODEL.with_mass("midspan", 70.0)).system
    assert system.dof_names == compile_model(MODEL).system.dof_names
    assert system.total_mass() == pytest.approx(1070.0)
    alone = compile_model(Model().with_nodes([[0, 0]], ["m"]).with_mass("m", 5.0, {"ry": 2.0})).system
    assert alone.dof_names == ("m.x", "m.z", "m.ry")
    np.testing.assert_array_equal(alone.mass.toarray(), np.diag([5.0, 5.0, 2.0]))


def test_table_numbers_node_by_node():
    active = np.zeros((3, 6), dtype=bool)
    active[0, [2, 4]], active[2, [0, 5]] = True, True
    table = DofTable.of_active(active)
    assert table.size == 4
    assert table.names(["a", "b", "c"]) == ("a.z", "a.ry", "c.x", "c.rz")
    assert table.number[2, 5] == 3
    assert table.number[1].max() == -1


def test_components_and_suggestions():
    np.testing.assert_array_equal(component_indices(("z", "rx")), [2, 3])
    with pytest.raises(InputError, match="component = 'theta'"):
        component_indices(("theta",))
    assert "Known: a0, a1" in str(nearest("zzz", [f"a{i}" for i in range(20)], "thing"))
    assert str(nearest("zzz", [f"a{i}" for i in range(20)], "thing")).endswith("…")


@pytest.mark.parametrize(
    ("build", "rule"),
    [
        (lambda: Model().with_nodes([[0, float("nan")]]), "must be finite"),
        (lambda: Model().with_nodes([[0, 1, 0]]), "must have y = 0 in a plane model"),
        (lambda: MODEL.with_beams([[0, 0]], EB), "must join two different nodes"),
        (lambda: MODEL.with_beams([[0, 7]], EB), "must use nodes between 0 and 2"),
        (lambda: MODEL.with_springs([[0, 1]], {"z": -1.0}), "must be zero or positive"),
        (lambda: MODEL.with_springs([[0, 1]], {"up": 1.0}), "must be one of x, y, z"),
        (lambda: MODEL.with_mass(0, -1.0), "must be zero or positive"),
        (lambda: MODEL.with_load(0, "down", 1.0), "must be one of x, y, z"),
        (lambda: compile_model(MODEL.with_load("midspan", "x", 1.0)), "has no x: no element uses it"),
        (lambda: compile_model(Model()), "must have at least one element"),
        (lambda: compile_model(Model().with_nodes([[1, 0], [1, 0]]).with_beams([[0, 1]], EB)), "must have a positive length"),
        (lambda: compile_model(Model().with_nodes([[0, 0], [1, 1]]).with_beams([[0, 1]], EB)), "must be horizontal"),
    ],
)  # fmt: skip
def test_errors(build, rule):
    with pytest.raises(InputError, match=rule):
        build()
