"""Static beams against the modal series and against cubic elements assembled by hand."""

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.reference import (
    SimplySupportedBeam,
    point_load_deflection,
    point_load_moment,
    uniform_load_deflection,
)

LENGTH, STIFFNESS, FORCE = 10.0, 3.0e8, 2.0e4


def hermite_deflection(at, supports, nodes):
    """Deflections at ``nodes`` (which hold the load's place) by cubic elements: exact at nodes."""
    n = len(nodes)
    k = np.zeros((2 * n, 2 * n))
    for e, h in enumerate(np.diff(nodes)):
        block = np.array(
            [
                [12, 6 * h, -12, 6 * h],
                [6 * h, 4 * h**2, -6 * h, 2 * h**2],
                [-12, -6 * h, 12, -6 * h],
                [6 * h, 2 * h**2, -6 * h, 4 * h**2],
            ]
        )
        k[2 * e : 2 * e + 4, 2 * e : 2 * e + 4] += STIFFNESS / h**3 * block
    load = np.zeros(2 * n)
    load[2 * int(np.argmin(np.abs(nodes - at)))] = -FORCE
    fixed = {
        "pinned-pinned": [0, 2 * n - 2],
        "fixed-fixed": [0, 1, 2 * n - 2, 2 * n - 1],
        "fixed-free": [0, 1],
    }
    free = np.setdiff1d(np.arange(2 * n), fixed[supports])
    u = np.zeros(2 * n)
    u[free] = np.linalg.solve(k[np.ix_(free, free)], load[free])
    return u[::2]


@pytest.mark.parametrize("supports", ["pinned-pinned", "fixed-fixed", "fixed-free"])
@pytest.mark.parametrize("at", [2.5, 5.0, 8.0])
def test_point_load_equals_cubic_elements(supports, at):
    nodes = np.array([0.0, 1.0, 2.5, 4.0, 5.0, 7.0, 8.0, 10.0])
    w = point_load_deflection(
        nodes, force=FORCE, at=at, length=LENGTH, bending_stiffness=STIFFNESS, supports=supports
    )
    np.testing.assert_allclose(w, hermite_deflection(at, supports, nodes), atol=1e-12)


def test_point_load_equals_the_modal_series():
    beam = SimplySupportedBeam(LENGTH, STIFFNESS, 1.0)
    n, x, at = 20_000, np.array([1.0, 3.3, 5.0, 9.0]), 3.3
    series = (
        -FORCE
        * beam.shapes(x, n)
        @ (beam.shapes(at, n) / (beam.modal_mass * beam.angular_frequencies(n) ** 2))
    )
    w = point_load_deflection(x, force=FORCE, at=at, length=LENGTH, bending_stiffness=STIFFNESS)
    np.testing.assert_allclose(w, series, rtol=1e-9)  # the rest of the series falls like n^-3


def test_textbook_maxima():
    mid = LENGTH / 2
    point = point_load_deflection(mid, force=FORCE, at=mid, length=LENGTH, bending_stiffness=STIFFNESS)
    uniform = uniform_load_deflection(mid, load=1e3, length=LENGTH, bending_stiffness=STIFFNESS)
    assert point == pytest.approx(-FORCE * LENGTH**3 / (48 * STIFFNESS), rel=1e-14)
    assert uniform == pytest.approx(-5 * 1e3 * LENGTH**4 / (384 * STIFFNESS), rel=1e-14)
    assert point_load_moment(mid, force=FORCE, at=mid, length=LENGTH) == pytest.approx(FORCE * LENGTH / 4)


def test_uniform_load_is_the_integral_of_point_loads():
    at, weight = np.polynomial.legendre.leggauss(8)
    x = 3.0
    total = 0.0
    for low, high in ((0.0, x), (x, LENGTH)):  # a cubic on either side of x: the rule is exact
        places = 0.5 * (high - low) * (at + 1.0) + low
        w = point_load_deflection(x, force=1e3, at=places, length=LENGTH, bending_stiffness=STIFFNESS)
        total += 0.5 * (high - low) * (weight @ w)
    uniform = uniform_load_deflection(x, load=1e3, length=LENGTH, bending_stiffness=STIFFNESS)
    assert total == pytest.approx(uniform, rel=1e-12)


def test_a_load_off_the_beam_is_refused():
    with pytest.raises(InputError, match="must lie between 0 and 10 m"):
        point_load_deflection(1.0, force=1.0, at=11.0, length=LENGTH, bending_stiffness=STIFFNESS)
