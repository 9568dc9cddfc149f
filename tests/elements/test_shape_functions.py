"""Shape functions and quadrature rules, family by family."""

from itertools import product
from math import factorial

import numpy as np
import pytest

from axlespan.elements.quadrature import gauss, tetrahedron, triangle, wedge
from axlespan.elements.shape_functions import EDGES, KINDS, edge_nodes, shape_functions
from axlespan.errors import InputError

COMPLETE_DEGREE = {kind: 1 for kind in KINDS} | {k: 2 for k in ("line3", "tri6", "quad8", "tet10", "hex20")}


def some_points(kind: str, n: int = 7) -> np.ndarray:
    """Points inside the convex hull of the nodes."""
    shape = shape_functions(kind)
    return np.random.default_rng(3).dirichlet(np.ones(shape.node_count), n) @ shape.nodes


@pytest.mark.parametrize("kind", KINDS)
def test_each_function_is_one_at_its_node_and_zero_at_the_others(kind: str) -> None:
    shape = shape_functions(kind)
    assert np.array_equal(shape.values(shape.nodes), np.eye(shape.node_count))


@pytest.mark.parametrize("kind", KINDS)
def test_sum_is_one_and_complete_polynomials_are_reproduced(kind: str) -> None:
    shape, points = shape_functions(kind), some_points(kind)
    for powers in product(range(3), repeat=shape.dimension):
        if sum(powers) <= COMPLETE_DEGREE[kind]:
            nodal, exact = (np.prod(x ** np.array(powers), axis=1) for x in (shape.nodes, points))
            np.testing.assert_allclose(shape.values(points) @ nodal, exact, atol=1e-14)
            gradient = shape.derivatives(points) @ nodal
            for i, p in enumerate(powers):
                lowered = np.array(powers) - (np.arange(shape.dimension) == i)
                slope = p * np.prod(points ** np.maximum(lowered, 0), axis=1) if p else 0.0 * exact
                np.testing.assert_allclose(gradient[:, i], slope, atol=1e-13)


@pytest.mark.parametrize("kind", KINDS)
def test_derivatives_match_central_differences(kind: str) -> None:
    shape, points, h = shape_functions(kind), some_points(kind), 1e-5
    for i, step in enumerate(h * np.eye(shape.dimension)):
        difference = (shape.values(points + step) - shape.values(points - step)) / (2.0 * h)
        np.testing.assert_allclose(shape.derivatives(points)[:, i], difference, atol=1e-9)


def test_hex8_and_hex20_are_the_textbook_products() -> None:
    (x, y, z), point = np.random.default_rng(0).uniform(-1, 1, (2, 3))[0], None
    point = np.array([[x, y, z]])
    nodes = shape_functions("hex8").nodes
    np.testing.assert_allclose(
        shape_functions("hex8").values(point)[0], np.prod(1 + nodes * point, axis=1) / 8
    )
    # Zienkiewicz, serendipity: corners (1+ξξa)(1+ηηa)(1+ζζa)(ξξa+ηηa+ζζa-2)/8, edges (1-ξ²)(1+ηηa)(1+ζζa)/4.
    nodes = shape_functions("hex20").nodes
    expected = np.prod(1 + nodes * point, axis=1) * ((nodes * point).sum(axis=1) - 2) / 8
    for a in range(8, 20):
        across = nodes[a] == 0
        expected[a] = np.prod(np.where(across, 1 - point[0] ** 2, 1 + nodes[a] * point[0])) / 4
    np.testing.assert_allclose(shape_functions("hex20").values(point)[0], expected, atol=1e-15)


@pytest.mark.parametrize("kind", [k for k in KINDS if len(edge_nodes(k)[0]) == 3])
def test_middle_nodes_lie_between_the_ends_of_their_edges(kind: str) -> None:
    nodes = shape_functions(kind).nodes
    for a, b, middle in edge_nodes(kind):
        assert np.array_equal(nodes[middle], (nodes[a] + nodes[b]) / 2)


def test_vtk_order_of_quadratic_hexahedron() -> None:
    """VTK file formats, figure of cell type 25: 8..11 bottom, 12..15 top, 16..19 upright edges."""
    assert edge_nodes("hex20")[4] == (4, 5, 12)
    assert edge_nodes("hex20")[8] == (0, 4, 16)
    assert edge_nodes("tet10")[2:4] == ((2, 0, 6), (0, 3, 7))
    assert len(EDGES["wedge"]) == 9


def simplex_moment(powers: tuple[int, ...]) -> float:
    """∫ Π ξ_i^p_i over the unit simplex = Π p_i! / (d + Σ p_i)!."""
    return float(np.prod([factorial(p) for p in powers]) / factorial(len(powers) + sum(powers)))


@pytest.mark.parametrize(("rule", "d"), [(triangle, 2), (tetrahedron, 3)])
@pytest.mark.parametrize("degree", [1, 2, 5])
def test_simplex_rules_are_exact_to_their_degree(rule, d: int, degree: int) -> None:
    points, weights = rule(degree).points, rule(degree).weights
    assert (weights > 0).all() and (points > 0).all() and (points.sum(axis=1) < 1).all()
    for powers in product(range(degree + 1), repeat=d):
        if sum(powers) <= degree:
            integral = weights @ np.prod(points ** np.array(powers), axis=1)
            assert integral == pytest.approx(simplex_moment(powers), rel=1e-13)


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_product_rules_are_exact_to_their_degree(count: int) -> None:
    box, prism = gauss(3, count), wedge(2, count)
    for p in range(2 * count):
        line = (1 + (-1) ** p) / (p + 1)
        assert box.weights @ box.points[:, 2] ** p == pytest.approx(4 * line, abs=1e-13)
        moment = prism.weights @ (prism.points[:, 0] * prism.points[:, 1] * prism.points[:, 2] ** p)
        assert moment == pytest.approx(simplex_moment((1, 1)) * line, abs=1e-14)


def test_wrong_requests_are_named() -> None:
    with pytest.raises(InputError, match="hex9"):
        shape_functions("hex9")
    with pytest.raises(InputError, match="n_point, 3"):
        shape_functions("hex8").values(np.zeros((4, 2)))
    with pytest.raises(InputError, match="no rule on the triangle"):
        triangle(3)
