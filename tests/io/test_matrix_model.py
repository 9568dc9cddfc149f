"""Checks of matrices: mass, rigid-body modes and what no structure can have; closed forms of a beam."""

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.sparse import csr_array

from axlespan.errors import InputError
from axlespan.io.matrices import DofMap, MatrixModel, ModalModel, NodeTable


def test_total_mass_is_that_of_the_beam(free_beam):
    np.testing.assert_allclose(free_beam.model().total_mass(), [57575.0, 0.0, 57575.0], rtol=1e-12)


def test_first_frequency_of_the_held_beam(held_beam):
    """N12: 30.02 rad/s for the simply supported beam."""
    model = held_beam.model()
    omega = np.sqrt(
        eigh(model.stiffness.toarray(), model.mass.toarray(), eigvals_only=True, subset_by_index=[0, 0])
    )
    np.testing.assert_allclose(omega, 30.02, atol=0.005)


def test_rigid_body_modes(free_beam, held_beam):
    assert free_beam.model().rigid_body_modes() == 3  # of the plane
    assert held_beam.model().rigid_body_modes() == 0
    rolling = free_beam.model().without([1, 3 * free_beam.count + 1])
    assert rolling.rigid_body_modes() == 1  # free to roll along x
    np.testing.assert_array_equal(rolling.held.nodes, [101, 111])
    assert rolling.held.components == ("z", "z")
    assert rolling.dofs.row(101, "z") is None
    assert rolling.dofs.row(101, "ry") == 1


def test_a_soft_bearing_is_not_a_rigid_body_mode(free_beam):
    """Springs a millionth as stiff as the girder still hold it."""
    soft = 1e-6 * free_beam.stiffness.max()
    stiffness = free_beam.stiffness.copy()
    for row in (0, 1, 3 * free_beam.count + 1):
        stiffness[row, row] += soft
    assert free_beam.model(stiffness=csr_array(stiffness)).rigid_body_modes() == 0


def test_rigid_body_vectors_are_u_plus_theta_cross_arm():
    points = np.array([[0.0, 0, 0], [2.0, 0, 0], [0.0, 3.0, 0], [1.0, 1.0, 4.0]])
    dofs = DofMap(np.repeat([1, 2, 3, 4], 6), ("x", "y", "z", "rx", "ry", "rz") * 4)
    model = MatrixModel(
        csr_array(np.eye(24)), csr_array(np.eye(24)), dofs, coordinates=NodeTable(np.arange(1, 5), points)
    )
    rng = np.random.default_rng(7)
    u, theta = rng.normal(size=3), rng.normal(size=3)
    motion = (model.rigid_body_vectors() @ np.concatenate([u, theta])).reshape(4, 6)
    np.testing.assert_allclose(motion[:, :3], u + np.cross(theta, points - points.mean(axis=0)), atol=1e-14)
    np.testing.assert_allclose(motion[:, 3:], np.tile(theta, (4, 1)), atol=1e-15)


def test_a_space_frame_floats_in_six_ways():
    """Springs between all d.o.f. of two nodes that resist relative rigid motion only: six motions are free."""
    rng = np.random.default_rng(3)
    points = rng.normal(size=(3, 3)) * 5.0
    dofs = DofMap(np.repeat([7, 8, 9], 6), ("x", "y", "z", "rx", "ry", "rz") * 3)
    table = NodeTable(np.array([7, 8, 9]), points)
    rigid = MatrixModel(
        csr_array(np.eye(18)), csr_array(np.eye(18)), dofs, coordinates=table
    ).rigid_body_vectors()
    q, _ = np.linalg.qr(rigid)
    model = MatrixModel(
        csr_array(1e9 * (np.eye(18) - q @ q.T)), csr_array(np.eye(18)), dofs, coordinates=table
    )
    assert model.rigid_body_modes() == 6


def changed(matrix, row, column, value, both=True):
    result = matrix.copy()
    result[row, column] = value
    if both:
        result[column, row] = value
    return csr_array(result)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda b: {"stiffness": csr_array(b.stiffness[:-1, :-1])},
            r"stiffness = \(32, 32\): must have 33 rows",
        ),
        (lambda b: {"mass": csr_array(b.mass[:-1])}, r"mass = \(32, 33\): must have 33 rows"),
        (lambda b: {"damping": csr_array(np.eye(5))}, r"damping = \(5, 5\): must have 33 rows"),
        (
            lambda b: {"stiffness": changed(b.stiffness, 4, 7, np.nan)},
            r"stiffness of 102.z and 103.z = nan: must be finite",
        ),
        (lambda b: {"mass": changed(b.mass, 4, 4, np.inf)}, r"mass of 102.z and 102.z = inf: must be finite"),
        (lambda b: {"mass": changed(b.mass, 4, 4, 1e90)}, "sound size"),
        (
            lambda b: {"stiffness": changed(b.stiffness, 4, 7, 0.0, both=False)},
            "stiffness: must be symmetric; K - Kᵀ reaches",
        ),
        (
            lambda b: {"mass": changed(b.mass, 4, 4, -1.0)},
            r"mass of 102.z = -1.0: must not be negative on the diagonal",
        ),
        (
            lambda b: {"mass": changed(b.mass, 4, 7, 1e6)},
            "between 102.z and 103.z it exceeds what their diagonal",
        ),
        (
            lambda b: (
                {
                    "stiffness": csr_array(np.pad(b.stiffness, (0, 1))),
                    "mass": csr_array(np.pad(b.mass, (0, 1))),
                }
                | {"dofs": DofMap(np.append(b.dofs.nodes, 111), (*b.dofs.components, "rx"))}
            ),
            r"d.o.f. = '111.rx': has neither stiffness nor mass",
        ),
        (
            lambda b: {"coordinates": NodeTable(np.array([101]), np.zeros((1, 3)))},
            r"node = 102: has no coordinates",
        ),
    ],
)
def test_what_no_structure_has_is_said(free_beam, change, message):
    with pytest.raises(InputError, match=message):
        free_beam.model(**change(free_beam))


def test_digits_of_an_export_are_forgiven(free_beam):
    """An asymmetry of 1e-9 of the largest entry is averaged out."""
    stiffness = free_beam.stiffness.copy()
    stiffness[4, 7] *= 1.0 + 1e-9
    model = free_beam.model(stiffness=csr_array(stiffness))
    assert abs(model.stiffness - model.stiffness.T).max() == 0.0
    np.testing.assert_allclose(model.stiffness.toarray(), free_beam.stiffness, rtol=1e-9)


def test_a_dof_cannot_occur_twice():
    with pytest.raises(InputError, match=r"d.o.f. = '3.z': occurs twice"):
        DofMap(np.array([1, 3, 3]), ("z", "z", "z"))
    with pytest.raises(InputError, match=r"node = 4: occurs twice"):
        NodeTable(np.array([4, 2, 4]), np.zeros((3, 3)))
    with pytest.raises(InputError, match=r"node = 2: must have finite coordinates"):
        NodeTable(np.array([4, 2]), np.array([[0.0, 0, 0], [0, np.nan, 0]]))


def test_node_sets_of_a_table_suggest_the_nearest_name(free_beam):
    assert free_beam.coordinates.nodes_of_set("track")[0] == 101
    with pytest.raises(InputError, match=r"'trak': is not a known node set. Did you mean 'track'\?"):
        free_beam.coordinates.nodes_of_set("trak")


def test_modal_matrices_follow_from_frequencies():
    dofs = DofMap(np.array([1, 2]), ("z", "z"))
    model = ModalModel(np.array([2.0, 5.0]), np.array([10.0, 4.0]), np.eye(2), dofs, np.array([0.01, 0.02]))
    np.testing.assert_allclose(
        model.stiffnesses, [10.0 * (4 * np.pi) ** 2, 4.0 * (10 * np.pi) ** 2], rtol=1e-15
    )
    np.testing.assert_allclose(model.dampings, [0.02 * 4 * np.pi * 10.0, 0.04 * 10 * np.pi * 4.0], rtol=1e-15)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"frequencies": np.array([1.0, -2.0])}, r"frequencies = -2.0: must not be negative"),
        ({"masses": np.array([1.0, 0.0])}, r"masses = 0.0: must be positive"),
        ({"masses": np.array([1.0])}, r"masses = \(1,\): must have the shape \(2,\)"),
        ({"shapes": np.ones((3, 2))}, r"shapes = \(3, 2\): must have the shape \(2, 2\)"),
        ({"shapes": np.full((2, 2), np.nan)}, "shapes: must be finite"),
        ({"damping_ratios": np.array([0.1, -0.1])}, "damping_ratios = -0.1: must not be negative"),
        ({"coordinates": NodeTable(np.array([1]), np.zeros((1, 3)))}, "node = 2: has no coordinates"),
    ],
)
def test_what_no_modal_model_has_is_said(change, message):
    parts = {
        "frequencies": np.ones(2),
        "masses": np.ones(2),
        "shapes": np.eye(2),
        "dofs": DofMap([1, 2], ("z", "z")),
    }
    with pytest.raises(InputError, match=message):
        ModalModel(**(parts | change))
