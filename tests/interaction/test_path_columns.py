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
