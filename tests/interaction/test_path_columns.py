"""The compliance under the wheels, from columns that end where they have died away, against dense algebra."""

import numpy as np
import pytest
import scipy.sparse as sp

from axlespan.dynamics.alpha import Alpha
from axlespan.dynamics.integrator import Integrator, Matrices
from axlespan.interaction.contact_system import path_compliance
from axlespan.interaction.path_columns import PathColumns

N = 2400


def chain(stiffness):
    """Masses on springs between neighbors and to the ground; a soft stretch lets loads be felt farther."""
    K = sp.diags_array(
        [-stiffness[1:-1], stiffness[:-1] + stiffness[1:] + 10.0, -stiffness[1:-1]], offsets=[-1, 0, 1]
    )
    return Integrator(Matrices(sp.csr_array(K), sp.csr_array(sp.eye_array(N))), Alpha(-0.1), 0.05)


def rows(rng, n_step, n_wheel):
    """Rows of four neighbors each, one wheel off the structure."""
    first = rng.integers(0, N - 4, (n_step, n_wheel, 1))
    weights = rng.uniform(-1.0, 1.0, (n_step, n_wheel, 4))
    weights[:, 1] = 0.0
    return first + np.arange(4), weights


def dense(integrator, dofs, weights):
    A = integrator.effective.toarray()
    E = np.zeros((len(dofs), N))
    np.add.at(E, (np.arange(len(dofs))[:, None], dofs), weights)
    return integrator.weight_c * integrator.u_from_a * E @ np.linalg.solve(A, E.T)


@pytest.mark.parametrize("loaded", [1, N])
@pytest.mark.parametrize("bump", [1.0, 300.0])
def test_compliance_and_response(loaded, bump):
    """Whole columns, and only what lies on the path; the bump reaches farther than the samples tell."""
    stiffness = np.full(N + 1, 50.0)
    stiffness[40:120] *= bump
    integrator = chain(stiffness)
    columns = PathColumns(integrator, np.arange(N), loaded)
    rng = np.random.default_rng(7)
    for _ in range(2):  # two stretches
        dofs, weights = rows(rng, 3, 6)
        dofs[:, 2] = 60 + np.arange(4)
        columns.hold(dofs[weights != 0.0])
        assert columns.solves_again == (loaded == N)
        result = path_compliance(columns, columns.position[dofs], weights)
        for k in range(3):
            expected = dense(integrator, dofs[k], weights[k])
            assert np.abs(result[k] - expected).max() <= 1e-14 * np.abs(expected).max()
            assert np.array_equal(result[k], result[k].T)
    if columns.solves_again:
        assert columns.compliance.shape[1] < N
    load = rng.standard_normal(len(columns.held))
    full = np.zeros(N)
    full[columns.held] = -integrator.weight_c * load
    expected = np.linalg.solve(integrator.effective.toarray(), full)
    np.testing.assert_allclose(columns.response(load), expected, atol=1e-13 * np.abs(expected).max())


def test_wheels_that_load_two_places_far_apart():
    """A line that is the mean of two others, whose d.o.f. do not lie next to one another."""
    integrator = chain(np.full(N + 1, 50.0))
    columns = PathColumns(integrator, np.arange(N), N)
    first = np.array([[200, 203, 205, 1500], [208, 212, 1400, 1412]])
    dofs = np.concatenate([first[..., None] + np.arange(3), first[..., None] + 1200 + np.arange(3)], axis=2)
    dofs %= N
    weights = np.random.default_rng(4).uniform(0.5, 1.0, dofs.shape)
    weights[:, ::2, 3:] = 0.0  # every other wheel stands on one of the lines alone
    columns.hold(dofs[weights != 0.0])
    assert columns.compliance.shape[1] < 1200
    result = path_compliance(columns, columns.position[dofs], weights)
    for k in range(len(dofs)):
        expected = dense(integrator, dofs[k], weights[k])
        assert np.abs(result[k] - expected).max() <= 1e-14 * np.abs(expected).max()


def test_alike_without_numba(monkeypatch):
    integrator = chain(np.full(N + 1, 50.0))
    dofs, weights = rows(np.random.default_rng(8), 2, 5)
    results = []
    for without in (False, True):
        if without:
            for place in ("path_columns", "contact_system"):
                monkeypatch.setattr(f"axlespan.interaction.{place}.compiled_sandwich", lambda: None)
        columns = PathColumns(integrator, np.arange(N), N)
        columns.hold(dofs[weights != 0.0])
        results.append(path_compliance(columns, columns.position[dofs], weights))
    assert np.abs(results[1] - results[0]).max() <= 1e-14 * np.abs(results[0]).max()


def response_of(columns, load):
    full = np.zeros((columns.integrator.size, *load.shape[1:]))
    full[columns.held] = -columns.integrator.weight_c * load
    return np.linalg.solve(columns.integrator.effective.toarray(), full)


@pytest.mark.parametrize("numba", [True, False])
def test_whole_columns_are_kept_as_memory_allows(numba, monkeypatch):
    """A train goes along the path: with room no column is computed twice, without the oldest ones make place."""
    if not numba:
        monkeypatch.setattr("axlespan.interaction.path_kernel._compiled_rows", lambda: None)
    integrator = chain(np.full(N + 1, 50.0))
    path, rng = np.arange(0, N, 5), np.random.default_rng(9)
    inverse, scale = np.linalg.inv(integrator.effective.toarray()), integrator.weight_c * integrator.u_from_a
    asked = []
    columns_of = integrator.columns

    def counted(dofs, *more):
        asked.extend(dofs.tolist())
        return columns_of(dofs, *more)

    monkeypatch.setattr(integrator, "columns", counted)
    for room in (len(path), 150):
        monkeypatch.setattr("axlespan.interaction.path_columns._KEPT", 8.0 * N * room)
        columns = PathColumns(integrator, path, 1)
        asked.clear()
        for head in (0, 4, 8, 200, 210, 0, 410):
            needed = path[head : head + 40]
            columns.hold(rng.permutation(np.repeat(needed, 2)))
            assert not columns.solves_again
            assert np.all(np.isin(needed, columns.held))
            assert np.all(np.diff(columns.held) > 0)
            assert np.array_equal(columns.held[columns.position[needed]], needed)
            assert len(columns.held) <= room
            Z = scale * inverse[np.ix_(columns.held, columns.held)]
            np.testing.assert_allclose(columns.compliance, Z, rtol=0.0, atol=1e-14 * Z.max())
            for shape in ((), (3,)):
                load = np.zeros((len(columns.held), *shape))
                load[columns.position[needed]] = rng.standard_normal((len(needed), *shape))
                expected = -integrator.weight_c * inverse[:, columns.held] @ load
                np.testing.assert_allclose(
                    columns.response(load), expected, rtol=0.0, atol=1e-14 * np.abs(expected).max()
                )
        if room == len(path):
            assert len(asked) == len(set(asked))
            assert columns.nbytes >= 8 * N * len(columns.held)
        else:  # the first ones were dropped while the train was far away
            assert asked.count(0) == 2


def test_a_short_path_has_all_its_columns_at_once():
    """And columns that are missed later come with their neighbors."""
    integrator = chain(np.full(N + 1, 50.0))
    short = PathColumns(integrator, np.arange(0, 500, 5), 1)
    short.hold(np.array([50, 55]))
    assert np.array_equal(short.held, np.arange(0, 500, 5))
    path = np.arange(0, N, 5)
    long = PathColumns(integrator, path, 1)
    long.hold(path[[20, 21]])
    assert np.array_equal(long.held, path[[20, 21]])
    long.hold(path[[100, 300]])
    new = np.setdiff1d(long.held, path[[20, 21]]) // 5
    assert len(new) == 64
    assert np.minimum(np.abs(new - 100), np.abs(new - 300)).max() <= 16


def test_a_small_model_keeps_no_idle_columns():
    """Each step passes all of them."""
    stiffness = np.full(41, 50.0)
    K = sp.diags_array(
        [-stiffness[1:-1], stiffness[:-1] + stiffness[1:], -stiffness[1:-1]], offsets=[-1, 0, 1]
    )
    integrator = Integrator(Matrices(sp.csr_array(K), sp.csr_array(sp.eye_array(40))), Alpha(0.0), 0.05)
    columns = PathColumns(integrator, np.arange(40), 4)
    for first in (0, 10, 30):
        columns.hold(np.arange(first, first + 4))
        assert len(columns.held) <= 6
        load = np.zeros(len(columns.held))
        load[columns.position[first]] = 2.0
        np.testing.assert_allclose(columns.response(load), response_of(columns, load), rtol=1e-12)
