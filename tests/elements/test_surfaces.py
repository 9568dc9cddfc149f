"""Loads on faces and edges."""

import numpy as np
import pytest

from axlespan.elements.shape_functions import shape_functions
from axlespan.elements.surfaces import pressure_force, sizes, traction_force
from axlespan.errors import InputError

FACES = ("tri3", "quad4", "tri6", "quad8")


def parallelogram(kind: str) -> np.ndarray:
    """A flat, skew face (1, n_node, 3) in space with area 6 or 3 m² and normal along n."""
    nodes = shape_functions(kind).nodes
    unit = nodes if kind.startswith("tri") else (nodes + 1) / 2
    return (unit @ np.array([[3.0, 0.0, 0.0], [1.0, 1.2, 1.6]]))[None]


@pytest.mark.parametrize("kind", FACES)
def test_pressure_pushes_with_its_area_against_the_normal(kind: str) -> None:
    x = parallelogram(kind)
    area = 3.0 if kind.startswith("tri") else 6.0
    normal = np.array([0.0, -0.8, 0.6])
    assert sizes(kind, x)[0] == pytest.approx(area)
    force = pressure_force(kind, x, 5.0).reshape(-1, 3)
    np.testing.assert_allclose(force.sum(axis=0), -5.0 * area * normal, atol=1e-12)
    np.testing.assert_allclose(
        np.cross(x[0], force).sum(axis=0), np.cross(centroid(kind), -5.0 * area * normal), atol=1e-12
    )


def centroid(kind: str) -> np.ndarray:
    share = 1 / 3 if kind.startswith("tri") else 1 / 2
    return share * np.array([4.0, 1.2, 1.6])


@pytest.mark.parametrize("kind", FACES)
def test_linear_traction_gives_its_force_and_moment(kind: str) -> None:
    """t = x e_z over the face: force ∫ x dA and moment ∫ x² dA, from the moments of the parallelogram."""
    x = parallelogram(kind)
    traction = np.zeros_like(x)
    traction[..., 2] = x[..., 0]
    force = traction_force(kind, x, traction).reshape(-1, 3)[:, 2]
    if kind.startswith("tri"):
        # Over the unit triangle ∫ξ = 1/6, ∫ξ² = 1/12, ∫ξη = 1/24, times det = 6.
        first, second = 6 * (3 + 1) / 6, 6 * (9 / 12 + 2 * 3 / 24 + 1 / 12)
    else:
        first, second = 6 * (3 + 1) / 2, 6 * (9 / 3 + 2 * 3 / 4 + 1 / 3)
    assert force.sum() == pytest.approx(first)
    assert force @ x[0, :, 0] == pytest.approx(second)


def test_uniform_traction_on_quadratic_faces_and_edges_has_textbook_shares() -> None:
    share = traction_force("quad8", parallelogram("quad8"), (0.0, 0.0, 1.0)).reshape(-1, 3)[:, 2] / 6
    np.testing.assert_allclose(share, [-1 / 12] * 4 + [1 / 3] * 4)
    share = traction_force("tri6", parallelogram("tri6"), (0.0, 0.0, 1.0)).reshape(-1, 3)[:, 2] / 3
    np.testing.assert_allclose(share, [0] * 3 + [1 / 3] * 3, atol=1e-15)
    line = np.array([[[0.0, 0.0], [3.0, 4.0], [1.5, 2.0]]])
    np.testing.assert_allclose(
        traction_force("line3", line, (1.0, 0.0)).reshape(3, 2)[:, 0], 5 * np.array([1, 1, 4]) / 6
    )


def test_pressure_on_an_edge_pushes_to_its_left() -> None:
    """The bottom edge of a counterclockwise element: its outside is below, pressure pushes up."""
    edge = np.array([[[0.0, 0.0], [2.0, 0.0]]])
    np.testing.assert_allclose(pressure_force("line2", edge, 3.0), [[0.0, 3.0, 0.0, 3.0]])
    np.testing.assert_allclose(pressure_force("line2", edge, [[0.0, 3.0]]), [[0.0, 1.0, 0.0, 2.0]])
    np.testing.assert_allclose(pressure_force("line2", np.repeat(edge, 2, 0), [1.0, 2.0])[:, 1], [1.0, 2.0])


def test_each_face_has_its_own_traction() -> None:
    x = np.repeat(parallelogram("quad4"), 2, axis=0)
    force = traction_force("quad4", x, [[1.0, 0.0, 0.0], [0.0, 2.0, 0.0]]).reshape(2, 4, 3).sum(axis=1)
    np.testing.assert_allclose(force, [[6.0, 0.0, 0.0], [0.0, 12.0, 0.0]])


def test_wrong_input_is_named() -> None:
    with pytest.raises(InputError, match="hex8"):
        sizes("hex8", np.zeros((1, 8, 3)))
    with pytest.raises(InputError, match=r"\(n_face, 4, d\) for quad4"):
        sizes("quad4", np.zeros((1, 3, 3)))
    with pytest.raises(InputError, match="2 coordinates per node"):
        pressure_force("line2", np.zeros((1, 2, 3)), 1.0)
