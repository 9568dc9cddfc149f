"""The book notices: results that are off by little more than a tolerance fail."""

from dataclasses import replace

import pytest

from axlespan.interaction import simulate as home
from axlespan.verification import beams, crossings, forces, rides, supports, track, vehicles, wheels, yang_yau
from axlespan.verification.book import run


def scaled(variables, factor):
    compute = home.simulate

    def simulate(*args, **kwargs):
        result = compute(*args, **kwargs)
        return replace(result, **{name: factor * getattr(result, name) for name in variables})

    return simulate


@pytest.mark.parametrize(("case", "variable", "factor", "failing"), [
    (crossings.example_31, "sensor_displacement", 1.0005, "mid-span displacement"),
    (crossings.example_31, "vehicle_displacement", 1.0005, "mass, displacement, lowest"),
    (crossings.example_31, "vehicle_acceleration", 1.002, "mass, acceleration"),
    (crossings.example_31, "contact_force", 1.0005, "mass, contact force"),
    (forces.axle_row, "sensor_displacement", 0.9995, "displacement at midspan"),
    (wheels.wheels_with_mass, "contact_force", 1.01, "contact force 2.1"),
    (yang_yau.yang_yau, "sensor_displacement", 1.0003, "largest mid-span deflection"),
    (vehicles.half_car_bump, "contact_force", 1.001, "contact force 1.2, the worst"),
    (vehicles.truck_brakes, "sensor_displacement", 1.002, "mid-span displacement"),
    (vehicles.ice3_coach, "vehicle_displacement", 1.003, "displacement 1.body.z"),
    (rides.rough_road, "vehicle_displacement", 1.001, "displacement of the axle"),
    (rides.roll, "vehicle_displacement", 1.003, "roll of the body"),
    (track.ballasted_track, "sensor_displacement", 1.00001, "at rest, over a sleeper"),
    (supports.settlement, "support_reaction", 1.0001, "reaction, middle"),
    (supports.reactions, "support_reaction", 1.01, "crossing: sum of reactions / P"),
    (beams.two_spans, "support_reaction", 0.995, "slow force: middle reaction over the force"),
    (track.rail_on_springs, "sensor_displacement", 1.003, "running: trough at half the critical speed"),
    (track.rail_on_springs, "sensor_displacement", 1.003, "standing: M0 = P / 4 beta"),
], ids=lambda x: getattr(x, "name", str(x)).replace(" ", "_"))  # fmt: skip
def test_a_result_that_is_off_fails(case, variable, factor, failing, monkeypatch):
    monkeypatch.setattr(home, "simulate", scaled([variable], factor))
    (report,) = run([case])
    assert report.failure == ""
    assert failing in [row.quantity for row in report.rows if not row.ok]


def test_a_beam_with_another_stiffness_fails(monkeypatch):
    monkeypatch.setattr("axlespan.verification.models.SECOND_MOMENT", 2.90 * 1.001)
    (report,) = run([beams.beam_frequencies])
    # frequencies go with the root of the stiffness: 5e-4, fifty times the tolerance
    assert [row.ok for row in report.rows] == [False] * 12
    assert report.rows[0].error == pytest.approx(5e-4, rel=1e-2)


def test_wheels_without_numerical_damping_fail(monkeypatch):
    # Newmark's method: the contact force rings under a dashpot over a ramp, and grows without bound under a wheel
    monkeypatch.setattr("axlespan.interaction.settings.DAMPED_ALPHA", 0.0)
    ramp, heavy = run([wheels.ramp, wheels.wheels_with_mass])
    errors = {row.quantity: row.error for row in ramp.rows}
    assert errors["ramp on the ground: contact force"] > 0.5  # of the static load
    assert errors["ramp on the span, left: contact force"] > 0.5
    assert not heavy.ok
    assert heavy.failure.startswith("AnalysisError: the run diverged")
