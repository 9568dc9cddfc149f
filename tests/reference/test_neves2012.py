"""The two examples of N12: peaks of an independent solution of (41, 42), Newmark steps as in the paper."""

import numpy as np
import pytest

from axlespan.reference.neves2012 import mass_train, single_mass


def peaks(history):
    return history.min(), history.max()


def test_single_mass():
    crossing = single_mass()
    assert crossing.time.size == 901
    # the digits given: 1e-4 mm, 1e-4 m/s2
    assert peaks(1e3 * crossing.beam.displacement_at(12.5)) == pytest.approx((-2.4069, 0.1643), abs=6e-5)
    assert peaks(1e3 * crossing.body_displacement) == pytest.approx((-2.5899, 0.4986), abs=6e-5)
    assert peaks(crossing.body_acceleration) == pytest.approx((-0.1421, 0.1480), abs=6e-5)
    # converged in time and with more modes the peaks stay, to the error of 1 ms steps
    converged = single_mass(converged=True)
    assert peaks(1e3 * converged.body_displacement) == pytest.approx((-2.5899, 0.4986), abs=2e-4)
    assert peaks(1e3 * converged.beam.displacement_at(12.5)) == pytest.approx((-2.4069, 0.1643), abs=1e-3)


def test_mass_train():
    crossing = mass_train()
    first, last = (0, slice(0, 3001)), (49, slice(11_000, 14_001))  # N12's windows [0, 3] s and [11, 14] s
    z, a = 1e3 * crossing.body_displacement, crossing.body_acceleration
    # the digits given: 1e-3 mm, 1e-3 m/s2
    assert peaks(z[first[1], first[0]]) == pytest.approx((-12.840, 7.345), abs=6e-4)
    assert peaks(a[first[1], first[0]]) == pytest.approx((-2.037, 2.037), abs=6e-4)
    assert peaks(z[last[1], last[0]]) == pytest.approx((-11.593, 7.152), abs=6e-4)
    assert peaks(a[last[1], last[0]]) == pytest.approx((-1.984, 1.984), abs=6e-4)
    converged = mass_train(converged=True)
    # 1 ms Newmark steps shorten nothing and lengthen the mass's period by 2e-5: 3e-3 of the peak after 14 s
    scale = np.abs(z).max()
    np.testing.assert_allclose(1e3 * converged.body_displacement, z, atol=3e-3 * scale)
    assert peaks(1e3 * converged.body_displacement[first[1], 0]) == pytest.approx((-12.840, 7.346), abs=1e-3)
