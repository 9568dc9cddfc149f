"""Tension episodes, and extreme contact forces over all steps."""

import numpy as np
import pytest

from axlespan.bridges.spans import simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.simulate import simulate
from axlespan.irregularity import Harmonic
from axlespan.vehicles.simple import rigid_body, sprung_mass
from axlespan.vehicles.train import Train

SPAN = {"length": 25.0, "youngs_modulus": 2.87e9, "second_moment": 2.9, "mass_per_length": 2303.0}
BRIDGE = simple_span(elements=8, **SPAN)
WASHBOARD = Harmonic(amplitude=40e-3, wavelength=9.0)  # over 12 mm the spring of a standing mass is slack


def episodes_of(time, forces):
    """Where a history is negative: start, stop and largest tension of each stretch, in plain Python."""
    found, current = [], None
    for t, f in zip(time.tolist(), forces.tolist(), strict=True):
        if f < 0.0:
            current = (t, t, -f) if current is None else (current[0], t, max(current[2], -f))
        elif current is not None:
            found.append(current)
            current = None
    return found if current is None else [*found, current]


@pytest.mark.parametrize("every", [1, 7])
def test_episodes_are_those_of_the_force_history(every):
    """Over all steps, whatever is kept, across the stretches in which the run is worked up."""
    vehicle = rigid_body(mass=9e3, pitch_inertia=2e4, axles=[0.0, 2.6], stiffness=1.2e6, center=1.1)
    crossing = Crossing(BRIDGE, Train.of(vehicle, 2, 5.0), speed=20.0, irregularity=WASHBOARD)
    whole = simulate(crossing, time_step=1e-3, steps=1400, method=Alpha(0.0))
    checks = simulate(crossing, time_step=1e-3, steps=1400, method=Alpha(0.0), every=every).checks
    expected = {
        name: episodes_of(whole.time, whole.contact_force[:, i]) for i, name in enumerate(whole.contact)
    }
    assert checks["tension_episodes"] == sum(map(len, expected.values())) > 4
    for name in whole.contact:
        own = sorted((e["start"], e["stop"], e["size"]) for e in checks["tension"] if e["contact"] == name)
        np.testing.assert_allclose(own, expected[name], rtol=1e-12)
    first = min(checks["tension"], key=lambda e: e["start"])
    wheel = whole.contact.index(first["contact"])
    at = np.flatnonzero(whole.contact_force[:, wheel] == -first["size"])[0]
    assert first["position"] == pytest.approx(whole.contact_position[at, wheel])
    np.testing.assert_allclose(
        list(checks["largest_contact_force"].values()), whole.contact_force.max(axis=0)
    )
    np.testing.assert_allclose(
        list(checks["smallest_contact_force"].values()), whole.contact_force.min(axis=0)
    )


def test_an_episode_that_lasts_until_the_end_counts():
    crossing = Crossing(
        BRIDGE, Train.of(sprung_mass(mass=5750.0, stiffness=1.595e6)), speed=20.0, irregularity=WASHBOARD
    )
    whole = simulate(crossing, time_step=1e-3, steps=1000)
    negative = np.flatnonzero(whole.contact_force[:, 0] < 0.0)
    middle = int(negative[5])
    checks = simulate(crossing, time_step=1e-3, steps=middle).checks
    assert checks["tension"][-1]["stop"] == pytest.approx(middle * 1e-3)


def test_no_tension_on_a_smooth_line():
    crossing = Crossing(BRIDGE, Train.of(sprung_mass(mass=5750.0, stiffness=1.595e6)), speed=20.0)
    result = simulate(crossing, time_step=1e-3, steps=1300)
    assert result.checks["tension_episodes"] == 0
    assert result.checks["tension"] == []
    assert result.checks["static_contact_force"] == {"1.1": pytest.approx(5750 * 9.81)}
    assert result.checks["smallest_contact_force"]["1.1"] > 0.9 * 5750 * 9.81
