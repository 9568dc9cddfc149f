"""Axle loads that three sleepers share, 25, 50 and 25 %."""

import numpy as np
import pytest

import axlespan as asp
from axlespan.errors import InputError

E, INERTIA, LENGTH = 34e9, 0.8, 12.0
BRIDGE = asp.bridges.simple_span(
    length=LENGTH, youngs_modulus=E, second_moment=INERTIA, mass_per_length=9e3, elements=16
)


def at_midspan(a):
    """Deflection at midspan per unit force at a, zero off the span."""
    b = np.minimum(a, LENGTH - a)
    w = b * (3 * LENGTH**2 - 4 * b**2) / (48 * E * INERTIA)
    return np.where(b > 0.0, w, 0.0)


def test_the_path_is_the_weighted_sum_of_three():
    path, n = BRIDGE.line(), BRIDGE.system.size
    shared = path.shared(0.6)
    where = np.random.default_rng(3).uniform(-1.0, 13.0, 200)
    expected = sum(
        share * path.rows(where + offset, n) for share, offset in ((0.25, -0.6), (0.5, 0.0), (0.25, 0.6))
    )
    np.testing.assert_allclose(shared.rows(where, n).toarray(), expected.toarray(), atol=1e-13)
    assert (shared.start, shared.stop) == pytest.approx((-0.6, 12.6))


def test_other_shares():
    path, n = BRIDGE.line(), BRIDGE.system.size
    shares = (0.1, 0.2, 0.4, 0.2, 0.1)
    expected = sum(share * path.rows([5.3 + 0.5 * (i - 2)], n) for i, share in enumerate(shares))
    np.testing.assert_allclose(
        path.shared(0.5, shares).rows([5.3], n).toarray(), expected.toarray(), atol=1e-14
    )


def test_a_standing_axle_by_superposition():
    """The run starts in static equilibrium: its first record is the superposition of three point loads."""
    loads = asp.vehicles.axle_loads(loads=[200e3, 180e3], positions=[0.0, 2.5])
    for head in (0.3, 4.0, 7.77, 12.3):
        crossing = asp.Crossing(BRIDGE, asp.Train.of(loads), speed=1.0, start=head)
        result = asp.simulate(
            crossing,
            time_step=1e-3,
            steps=1,
            sensors={"midspan": 6.0},
            sleepers=0.6,
            section_forces=["midspan"],
        )
        exact, moment = 0.0, 0.0
        for force, behind in ((200e3, 0.0), (180e3, 2.5)):
            for share, offset in ((0.25, -0.6), (0.5, 0.0), (0.25, 0.6)):
                at = head - behind + offset
                exact -= share * force * float(at_midspan(at))
                moment += share * force * max(0.5 * min(at, LENGTH - at), 0.0)
        assert result.sensor_displacement[0, 0] == pytest.approx(exact, rel=1e-6)
        assert result.section_moment[0, 0] == pytest.approx(moment, rel=1e-6)


def test_moments_and_accelerations_get_smaller():
    loads = asp.vehicles.axle_loads(loads=[200e3] * 8, positions=[3.0 * i for i in range(8)])
    peaks = []
    for sleepers in (None, 0.6):
        crossing = asp.Crossing(BRIDGE, asp.Train.of(loads), speed=60.0, start=-1.0)
        result = asp.simulate(
            crossing,
            time_step=5e-4,
            steps=1000,
            sensors={"midspan": 6.0},
            sleepers=sleepers,
            section_forces=["midspan"],
        )
        peaks.append((result.section_moment.max(), np.abs(result.sensor_acceleration).max()))
        assert result.checks["equilibrium_residual"] < 1e-8
    assert 0.8 * peaks[0][0] < peaks[1][0] < peaks[0][0]
    assert peaks[1][1] < peaks[0][1]


@pytest.mark.parametrize("spacing", [0.0, -0.6, 5.0])
def test_a_wrong_spacing(spacing):
    loads = asp.vehicles.axle_loads(loads=[200e3], positions=[0.0])
    with pytest.raises(InputError, match=r"sleepers = .*: must be positive and at most 3 m. Use 0.6 m"):
        asp.simulate(
            asp.Crossing(BRIDGE, asp.Train.of(loads), speed=1.0), time_step=1e-3, steps=1, sleepers=spacing
        )


def test_on_a_track_the_rails_do_it():
    bridge = asp.bridges.with_track(BRIDGE, asp.bridges.ballasted_track())
    loads = asp.vehicles.axle_loads(loads=[200e3], positions=[0.0])
    with pytest.raises(InputError, match="the structure has a track, whose rails spread the loads"):
        asp.simulate(
            asp.Crossing(bridge, asp.Train.of(loads), speed=1.0), time_step=1e-3, steps=1, sleepers=0.6
        )
