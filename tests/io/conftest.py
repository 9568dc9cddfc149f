"""A small bridge as matrices: a beam in the x-z plane, assembled here by hand."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.sparse import csr_array

from axlespan.io.matrices import DofMap, MatrixModel, NodeTable


@dataclass(frozen=True)
class Beam:
    """Euler-Bernoulli beam of equal elements with axial stiffness: K and M (dense), d.o.f., coordinates."""

    length: float
    count: int
    stiffness: np.ndarray
    mass: np.ndarray
    dofs: DofMap
    coordinates: NodeTable

    def model(self, **changes):
        parts = {"stiffness": csr_array(self.stiffness), "mass": csr_array(self.mass), "dofs": self.dofs}
        return MatrixModel(**(parts | {"coordinates": self.coordinates} | changes))


def beam_matrices(length, count, ei, ea, m):
    """K, M of a free beam with d.o.f. x, z, ry at each node; rotation ry = -dw/dx."""
    a = length / count
    bend = ei / a**3 * np.array([[12, -6 * a, -12, -6 * a], [-6 * a, 4 * a**2, 6 * a, 2 * a**2]])
    bend = np.vstack(
        [bend, ei / a**3 * np.array([[-12, 6 * a, 12, 6 * a], [-6 * a, 2 * a**2, 6 * a, 4 * a**2]])]
    )
    inertia = np.array(
        [
            [156, -22 * a, 54, 13 * a],
            [-22 * a, 4 * a**2, -13 * a, -3 * a**2],
            [54, -13 * a, 156, 22 * a],
            [13 * a, -3 * a**2, 22 * a, 4 * a**2],
        ]
    )
    stiffness, mass = np.zeros((3 * count + 3, 3 * count + 3)), np.zeros((3 * count + 3, 3 * count + 3))
    for e in range(count):
        at = np.ix_(
            [3 * e + 1, 3 * e + 2, 3 * e + 4, 3 * e + 5], [3 * e + 1, 3 * e + 2, 3 * e + 4, 3 * e + 5]
        )
        stiffness[at] += bend
        mass[at] += m * a / 420.0 * inertia
        at = np.ix_([3 * e, 3 * e + 3], [3 * e, 3 * e + 3])
        stiffness[at] += ea / a * np.array([[1, -1], [-1, 1]])
        mass[at] += m * a / 6.0 * np.array([[2, 1], [1, 2]])
    return stiffness, mass


@pytest.fixture(scope="session")
def free_beam():
    """N12's beam (25 m, EI 8.323e9 N m^2, 2303 kg/m), 10 elements, without supports; nodes 101 to 111."""
    length, count = 25.0, 10
    stiffness, mass = beam_matrices(length, count, 2.87e9 * 2.90, 2.87e9 * 0.5, 2303.0)
    labels = 101 + np.arange(count + 1)
    points = np.column_stack(
        [np.linspace(0.0, length, count + 1), np.full(count + 1, 2.0), np.full(count + 1, 7.0)]
    )
    table = NodeTable(labels, points, {"track": labels})
    return Beam(
        length, count, stiffness, mass, DofMap(np.repeat(labels, 3), ("x", "z", "ry") * (count + 1)), table
    )


@pytest.fixture(scope="session")
def held_beam(free_beam):
    """The beam on a pin and a roller: the three d.o.f. have no rows."""
    out = [0, 1, 3 * free_beam.count + 1]
    keep = np.setdiff1d(np.arange(len(free_beam.dofs)), out)
    at = np.ix_(keep, keep)
    dofs = free_beam.dofs.taken(keep)
    return Beam(
        free_beam.length,
        free_beam.count,
        free_beam.stiffness[at],
        free_beam.mass[at],
        dofs,
        free_beam.coordinates,
    )
