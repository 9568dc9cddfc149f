"""Mechanisms, loose parts and negative stiffnesses are found by every factor, with the d.o.f. to blame."""

import pickle

import numpy as np
import pytest
import scipy.sparse as sp

from axlespan.linalg import NotPositiveDefinite, factorize
from axlespan.linalg.arrays import symmetric_csr
from axlespan.linalg.definiteness import SINGULAR, smallest_scaled_eigenvalue


def refused(matrix, kind):
    with pytest.raises(NotPositiveDefinite) as caught:
        factorize(matrix, kind=kind)
    return caught.value


@pytest.mark.parametrize("elements", [3, 10, 40, 100, 400, 1000])
def test_free_beam_has_two_motions_and_its_ends_move_most(kind, beam, elements):
    K, _ = beam(elements)
    error = refused(K, kind)
    assert (error.kind, error.motions) == ("mechanism", 2)
    assert (error.suspects[:2] % 2 == 0).all()  # translations
    # The end nodes have half the stiffness of an inner one, so those beside them come first on a fine mesh.
    assert {int(i) // 2 for i in error.suspects[:2]} <= {0, 1, elements - 1, elements}


@pytest.mark.parametrize("elements", [3, 10, 40, 100, 400, 1000])
def test_beam_on_one_pin_turns_about_it(kind, beam, elements):
    K, _ = beam(elements, fixed=(0,))
    error = refused(K, kind)
    assert (error.kind, error.motions) == ("mechanism", 1)
    assert int(error.suspects[0]) in (2 * elements - 3, 2 * elements - 1)  # w of the last two nodes


@pytest.mark.parametrize("elements", [10, 100, 1000])
def test_beams_with_enough_supports_are_not_refused(kind, beam, elements):
    for fixed in ((0, 1), (0, -2), (0, 1, -2, -1)):
        K, _ = beam(elements, fixed=fixed)
        factor = factorize(K, kind=kind)
        load = np.asarray(K @ np.ones(K.shape[0]))
        # rounding of K and of the load over the smallest scaled eigenvalue, 0.5 / elements⁴ of a cantilever
        assert np.abs(factor.solve(load) - 1.0).max() < 1e-15 * elements**4 + 1e-12


def test_internal_hinge_in_a_simple_span_is_a_mechanism(kind, beam):
    half = beam(5, length=12.5)[0].toarray()
    hinged = np.zeros((23, 23))
    # The halves share the deflection of the hinge, d.o.f. 10, and each has a rotation there, 11 and 12.
    for dofs in (np.arange(12), np.r_[10, np.arange(12, 23)]):
        hinged[np.ix_(dofs, dofs)] += half
    free = np.setdiff1d(np.arange(23), [0, 21])
    error = refused(hinged[np.ix_(free, free)], kind)
    assert (error.kind, error.motions) == ("mechanism", 1)
    assert free[error.suspects[0]] == 10
    held = np.setdiff1d(free, [1])  # clamped at the left end, it stands
    factorize(hinged[np.ix_(held, held)], kind=kind)


def test_disconnected_part_is_told_from_the_rest(kind, grid, beam):
    sound = grid(6, 7)
    loose, _ = beam(4, EI=2.0, length=4.0)
    error = refused(sp.block_diag([sound, loose], format="csr"), kind)
    assert (error.kind, error.motions) == ("disconnected", 2)
    assert (error.suspects >= 42).all()
    assert "coupled to nothing else" in str(error)


def test_several_loose_parts_are_found_at_once(kind, grid):
    pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
    error = refused(sp.block_diag([pair, grid(3, 3), pair, pair], format="csr"), kind)
    assert (error.kind, error.motions) == ("disconnected", 3)
    assert sorted(error.suspects) == [0, 1, 11, 12, 13, 14]


def test_coupling_by_rounding_connects_nothing(kind, grid):
    A = sp.lil_array(sp.block_diag([grid(3, 3), np.array([[1.0, -1.0], [-1.0, 1.0]])]))
    A[0, 9] = A[9, 0] = 1e-15
    error = refused(sp.csr_array(A), kind)
    assert error.kind == "disconnected"
    assert sorted(error.suspects) == [9, 10]


def test_degree_of_freedom_without_stiffness(kind):
    error = refused(np.diag([1.0, 0.0, 2.0, 0.0]), kind)
    assert (error.kind, error.motions) == ("disconnected", 2)
    assert list(error.suspects) == [1, 3]


@pytest.mark.parametrize(
    ("matrix", "suspects"),
    [
        (np.diag([1.0, -2.0, 3.0]), [1]),  # a negative diagonal entry
        (np.array([[0.0, 1.0, 0.0], [1.0, 5.0, 0.0], [0.0, 0.0, 1.0]]), [0]),  # zero, but coupled
        (np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 2.0], [0.0, 2.0, 1.0]]), [1, 2]),  # λ = −1
    ],
)
def test_indefinite_matrices(kind, matrix, suspects):
    error = refused(matrix, kind)
    assert error.kind == "indefinite"
    assert list(error.suspects) == suspects


@pytest.mark.parametrize("strength", [1e-9, 1e-5, 1e-2, 0.7])
def test_negative_spring_is_found_whatever_its_strength(kind, grid, strength):
    A = sp.lil_array(grid(8, 9))
    values, vectors = np.linalg.eigh(A.toarray())
    A[40, 40] -= 1.0 / (vectors[40] ** 2 / values).sum() * (1.0 + strength)  # just beyond singular
    error = refused(sp.csr_array(A), kind)
    assert error.kind == "indefinite"
    assert error.suspects[0] == 40


def test_units_do_not_matter(kind, beam):
    K, _ = beam(30, fixed=(0, -2))
    scale = 10.0 ** np.random.default_rng(7).uniform(-8, 8, K.shape[0])
    scaled = sp.csr_array(sp.diags_array(scale) @ K @ sp.diags_array(scale))
    b = np.random.default_rng(8).standard_normal(K.shape[0])
    x = factorize(scaled, kind=kind).solve(b * scale) * scale
    np.testing.assert_allclose(x, np.linalg.solve(K.toarray(), b), rtol=1e-7)


def test_stiffnesses_too_far_apart_for_double_precision_are_refused(kind):
    def two_springs(ratio):  # a mass on a soft spring, tied to another by a stiff one
        return np.array([[1.0 + ratio, -ratio], [-ratio, ratio]])

    assert factorize(two_springs(1e10), kind=kind).solve(np.array([0.0, 1.0]))[0] == pytest.approx(
        1, rel=1e-5
    )
    assert refused(two_springs(1e15), kind).motions == 1


@pytest.mark.parametrize("n", [5, 30, 80])
def test_scaled_eigenvalue_is_right_where_it_matters(kind, n):
    # A chain of n springs, free but for a weak one of stiffness c: λ ≈ c / Σ k_ii.
    K = np.diag(np.r_[1.0, np.full(n - 2, 2.0), 1.0]) - np.eye(n, k=1) - np.eye(n, k=-1)
    K[0, 0] += 1e-11
    csr = symmetric_csr(K)
    estimate = smallest_scaled_eigenvalue(csr, factorize(K, kind=kind))
    assert estimate == pytest.approx(1e-11 / (2 * n - 2), rel=1e-3)
    assert estimate > SINGULAR


def test_names_and_words_survive_a_trip_to_another_process():
    error = NotPositiveDefinite("mechanism", np.array([4, 2]), 1)
    named = error.named(["a", "b", "c", "d", "node5.rz"])
    text = str(pickle.loads(pickle.dumps(named)))
    assert text == (
        "the matrix is not positive definite: 1 motion without stiffness (a mechanism, or stiffnesses too "
        "far apart for double precision); the d.o.f. with the largest share: node5.rz, c. Add supports, "
        "remove a hinge, or give these d.o.f. a stiffness"
    )
    assert "share: 4, 2." in str(error)
    assert list(named.suspects) == [4, 2]
