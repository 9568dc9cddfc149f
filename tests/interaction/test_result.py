"""What a result holds, how it is asked for, and what it says about the run."""

import re
import sys

import numpy as np
import pytest

from axlespan.bridges.spans import SupportAt, simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.errors import InputError
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.result import VARIABLES
from axlespan.interaction.simulate import simulate
from axlespan.linalg.factor import available
from axlespan.vehicles.simple import axle_loads, rigid_body
from axlespan.vehicles.train import Train

SPAN = {"length": 25.0, "youngs_modulus": 2.87e9, "second_moment": 2.9, "mass_per_length": 2303.0}
CAR = rigid_body(mass=9e3, pitch_inertia=2e4, axles=[0.0, 2.6], stiffness=1.2e6, unsprung_mass=200.0)
TRAIN = Train.joined([Train.of(CAR), Train.of(axle_loads(loads=5e4))], [4.0])
CROSSING = Crossing(simple_span(elements=8, **SPAN), TRAIN, speed=30.0)
SENSORS = {"midspan": 12.5, "third": 8.0}
WHOLE = simulate(CROSSING, time_step=2e-3, steps=301, sensors=SENSORS)
HISTORIES = (
    "sensor_displacement",
    "sensor_velocity",
    "sensor_acceleration",
    "contact_force",
    "contact_position",
    "vehicle_displacement",
    "vehicle_velocity",
    "vehicle_acceleration",
    "support_reaction",
)


def test_names():
    assert WHOLE.sensor == ("midspan", "third")
    assert WHOLE.contact == ("1.1", "1.2", "2.1")
    assert WHOLE.vehicle_dof == ("1.body.z", "1.body.pitch", "1.wheel1.z", "1.wheel2.z")
    assert WHOLE.support == ("left.z", "right.z")


def test_shapes_and_times():
    np.testing.assert_allclose(WHOLE.time, 2e-3 * np.arange(302), rtol=1e-14)
    sizes = {"sensor": 2, "contact": 3, "vehicle": 4, "support": 2}
    for name in HISTORIES:
        assert getattr(WHOLE, name).shape == (302, sizes[name.split("_")[0]])
    np.testing.assert_allclose(
        WHOLE.contact_position, 30.0 * WHOLE.time[:, None] - [0.0, 2.6, 6.6], atol=1e-12
    )


def test_histories_by_name():
    np.testing.assert_array_equal(WHOLE.at("vehicle_velocity", "1.body.pitch"), WHOLE.vehicle_velocity[:, 1])
    np.testing.assert_array_equal(WHOLE.at("support_reaction", "right.z"), WHOLE.support_reaction[:, 1])
    with pytest.raises(InputError, match="quantity = 'deflection': must be one of sensor_displacement"):
        WHOLE.at("deflection", "midspan")
    with pytest.raises(
        InputError, match=r"name = 'middle': is not a sensor of this result\. Known: midspan, third"
    ):
        WHOLE.at("sensor_displacement", "middle")


@pytest.mark.parametrize("every", [2, 3, 7, 500])
def test_every_nth_step(every):
    some = simulate(CROSSING, time_step=2e-3, steps=301, sensors=SENSORS, every=every)
    np.testing.assert_array_equal(some.time, WHOLE.time[::every])
    for name in HISTORIES:
        np.testing.assert_array_equal(getattr(some, name), getattr(WHOLE, name)[::every])
    for check in (
        "largest_contact_force",
        "smallest_contact_force",
        "equilibrium_residual",
        "energy_residual",
    ):
        assert some.checks[check] == WHOLE.checks[check]


@pytest.mark.parametrize("method", [Alpha(0.0), Alpha(-0.1)])
def test_velocities_and_accelerations_belong_to_the_displacements(method):
    """N12 (16) and (17) hold from step to step at sensors and for every d.o.f. of the vehicles."""
    result, dt = simulate(CROSSING, time_step=2e-3, steps=301, sensors=SENSORS, method=method), 2e-3
    beta, gamma = method.beta, method.gamma
    for what in ("sensor", "vehicle"):
        u, v, a = (getattr(result, f"{what}_{q}") for q in ("displacement", "velocity", "acceleration"))
        v_new = v[:-1] + ((1 - gamma) * a[:-1] + gamma * a[1:]) * dt
        u_new = u[:-1] + v[:-1] * dt + ((0.5 - beta) * a[:-1] + beta * a[1:]) * dt**2
        np.testing.assert_allclose(v[1:], v_new, atol=1e-12 * np.abs(v).max())
        np.testing.assert_allclose(u[1:], u_new, atol=1e-12 * np.abs(u).max())


@pytest.mark.parametrize("solver", available())
def test_solvers_agree(solver):
    other = simulate(CROSSING, time_step=2e-3, steps=301, sensors=SENSORS, solver=solver)
    assert other.facts["solver"] == solver
    for name in ("sensor_displacement", "contact_force", "support_reaction"):
        expected = getattr(WHOLE, name)
        np.testing.assert_allclose(getattr(other, name), expected, atol=1e-10 * np.abs(expected).max())


def test_runs_repeat_to_the_bit():
    again = simulate(CROSSING, time_step=2e-3, steps=301, sensors=SENSORS)
    for name in HISTORIES:
        np.testing.assert_array_equal(getattr(again, name), getattr(WHOLE, name))


def test_facts_and_progress():
    seen = []
    result = simulate(
        CROSSING, time_step=2e-3, steps=301, method=Alpha(-0.2), footprint=0.5, progress=seen.append
    )
    facts = result.facts
    assert (facts["structure_dofs"], facts["vehicle_dofs"], facts["contacts"]) == (16, 4, 3)
    assert (facts["steps"], facts["time_step"], facts["completed_steps"]) == (301, 2e-3, 301)
    assert (facts["alpha"], facts["beta"], facts["gamma"]) == pytest.approx((-0.2, 0.36, 0.7))
    assert facts["footprint"] == 0.5
    assert facts["coupling"] == "direct"
    assert seen[-1] == 301
    assert seen == sorted(seen)
    assert (result.outcome.code, result.outcome.message) == ("completed", "301 steps computed")


def test_to_xarray():
    data = WHOLE.to_xarray()
    assert dict(data.sizes) == {"time": 302, "sensor": 2, "contact": 3, "vehicle_dof": 4, "support": 2}
    force = data["contact_force"].sel(contact="1.2")
    np.testing.assert_array_equal(force, WHOLE.at("contact_force", "1.2"))
    assert force.attrs["units"] == "N"
    assert data["sensor_displacement"].attrs["units"] == "m"
    assert data["time"].attrs["units"] == "s"
    assert all(data[name].attrs["long_name"] for name in HISTORIES)


def test_without_sensors_vehicles_or_supports_that_move():
    bridge = simple_span(elements=4, supports=[SupportAt(0.0), SupportAt(25.0)], **SPAN)
    result = simulate(Crossing(bridge, Train.of(axle_loads(loads=1e5)), speed=30.0), time_step=2e-3, steps=20)
    assert result.sensor_displacement.shape == (21, 0)
    assert result.vehicle_displacement.shape == (21, 0)
    assert result.support == ("support1.z", "support2.z")
    assert "100 to 100 kN, 1 wheels" in repr(result)
    assert re.search(r"midspan +displacement -", repr(WHOLE))


def test_to_pandas():
    table = WHOLE.to_pandas()
    assert table.index.name == "time" and table.columns.names == ["quantity", "name"]
    np.testing.assert_array_equal(table.index, WHOLE.time)
    assert list(table["contact_force"].columns) == list(WHOLE.contact)
    for quantity, (dimension, unit, _) in VARIABLES.items():
        assert table.attrs["units"][quantity] == unit
        for name in getattr(WHOLE, dimension):
            np.testing.assert_array_equal(table[quantity, name], WHOLE.at(quantity, name))


def test_to_pandas_without_pandas(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(InputError, match=r"pandas: is not installed. pip install 'axlespan\[xarray\]'"):
        WHOLE.to_pandas()
