"""The summary of a run: peaks with times, verdicts, strict JSON and readable text."""

import io
import json
import re
from dataclasses import fields, replace

import numpy as np
import pytest
from rich.console import Console

from axlespan.bridges.spans import simple_span
from axlespan.dynamics.alpha import Alpha
from axlespan.errors import AnalysisError, Outcome
from axlespan.interaction.crossing import Crossing
from axlespan.interaction.result import VARIABLES, Result
from axlespan.interaction.settings import Iteration
from axlespan.interaction.simulate import simulate
from axlespan.io.results import read_result, write_result
from axlespan.io.summary import print_summary, summary, summary_lines, write_summary
from axlespan.io.verdicts import verdicts
from axlespan.irregularity import Harmonic
from axlespan.vehicles.simple import axle_loads, sprung_mass
from axlespan.vehicles.train import Train


def bridge():
    return simple_span(
        length=25.0, youngs_modulus=2.87e9, second_moment=2.90, mass_per_length=2303.0, elements=50
    )


def mass(**changes):
    return sprung_mass(**{"mass": 5750.0, "stiffness": 1.595e6, **changes})


@pytest.fixture(scope="module")
def example():
    """N12's example 3.1: crossing and result."""
    crossing = Crossing(bridge(), Train.of(mass()), speed=100.0 / 3.6)
    sensors = {"midspan": 12.5}
    return crossing, simulate(crossing, time_step=1e-3, steps=900, method=Alpha(0.0), sensors=sensors)


def made(**changes):
    """Two wheels, two sensors, five times, with peaks in known places."""
    names = {
        "sensor": ("a", "b"),
        "contact": ("1.1", "2.1"),
        "vehicle_dof": ("1.body.z", "1.body.pitch", "1.wheel1.z", "2.body.z"),
        "support": ("left.z", "left.ry"),
    }
    histories = {name: np.zeros((5, len(names[dimension]))) for name, (dimension, _, _) in VARIABLES.items()}
    histories["sensor_displacement"][:, 1] = [0.0, -2e-3, 1e-3, 0.0, 0.0]
    histories["sensor_acceleration"][:, 1] = [0.0, 0.0, 0.0, 3.0, -4.0]
    histories["contact_force"][:] = [[10e3, 40e3], [11e3, 40e3], [9e3, 44e3], [13e3, 38e3], [10e3, 40e3]]
    histories["contact_position"][:] = np.add.outer(5.0 * np.arange(5), [0.0, -3.0])
    histories["vehicle_acceleration"][2] = [0.5, 7.0, 900.0, -1.5]
    histories["support_reaction"][3] = [-6e3, 2e3]
    known = {
        "finite_values": True,
        "compatibility_residual": 1e-15,
        "equilibrium_residual": 1e-12,
        "energy_residual": 1e-12,
        "tension_episodes": 0,
        "tension": [],
        "static_contact_force": {"1.1": 10e3, "2.1": 40e3},
    }
    facts = {"steps": 4, "time_step": 0.1, "completed_steps": 4, "wall_time": 0.5, "notes": ("note one",)}
    result = Result(
        time=0.1 * np.arange(5),
        **names,
        **histories,
        outcome=Outcome("completed", "4 steps computed"),
        checks=known,
        facts=facts,
    )
    return replace(result, **changes)


def text_of(result, *args, **keywords):
    return "\n".join(summary_lines(summary(result, *args, **keywords)))


def test_peaks_of_sensors_come_with_their_times():
    sensors = summary(made())["sensors"]
    assert sensors["b"] == {
        "displacement_min_m": -2e-3,
        "displacement_min_time_s": 0.1,
        "displacement_max_m": 1e-3,
        "displacement_max_time_s": 0.2,
        "acceleration_min_m_per_s2": -4.0,
        "acceleration_min_time_s": 0.4,
        "acceleration_max_m_per_s2": 3.0,
        "acceleration_max_time_s": 0.3,  # 0.30000000000000004 in the result
    }


def test_contact_extremes_say_which_wheel_where_and_when():
    forces = summary(made())["contact_forces"]
    assert forces["largest"] == {
        "contact": "2.1",
        "force_N": 44e3,
        "ratio_to_static": 1.1,
        "time_s": 0.2,
        "position_m": 7.0,
    }
    assert (forces["smallest"]["contact"], forces["smallest"]["force_N"]) == ("1.1", 9e3)
    assert (forces["largest_ratio_to_static"]["contact"], forces["largest_ratio_to_static"]["time_s"]) == (
        "1.1",
        0.3,
    )
    assert forces["largest_ratio_to_static"]["ratio_to_static"] == pytest.approx(1.3)
    assert forces["largest_unloading"] == pytest.approx(0.1)


def test_extremes_on_the_structure_stand_beside_those_off_it():
    rough = Harmonic(amplitude=0.5e-3, wavelength=5.0, start=0.0, stop=25.0)
    crossing = Crossing(bridge(), Train.of(mass(), 3, 3.0), speed=13.25, irregularity=rough)
    result = simulate(crossing, time_step=2e-3, steps=1500, method=Alpha(0.0))
    forces = summary(result, crossing)["contact_forces"]
    on = (result.contact_position >= 0.0) & (result.contact_position <= 25.0)
    assert forces["largest_on_structure"]["force_N"] == result.contact_force[on].max()
    assert forces["smallest_on_structure"]["force_N"] == result.contact_force[on].min()
    assert forces["smallest"]["force_N"] == result.contact_force.min() < result.contact_force[on].min()
    text = text_of(result, crossing)
    assert re.search(r"  smallest .* off the structure\n", text)
    assert re.search(r"  smallest on structure +[\d.]+ +[\d.]+ +\d\.1 +[\d.]+ +[\d.]+\n", text)
    assert summary(result)["contact_forces"]["largest_on_structure"] is None


def test_vehicle_accelerations_are_per_part_without_wheels():
    found = summary(made())["vehicle_accelerations"]
    assert list(found) == ["body.z", "body.pitch"]
    assert (found["body.z"]["min"], found["body.z"]["min_vehicle"]) == (-1.5, "2")
    assert (found["body.z"]["max"], found["body.z"]["max_vehicle"], found["body.z"]["max_time_s"]) == (
        0.5,
        "1",
        0.2,
    )
    assert found["body.pitch"]["unit"] == "rad/s^2"


def test_reactions_carry_the_unit_of_a_force_or_a_moment():
    found = summary(made())["support_reactions"]
    assert (found["left.z"]["min_N"], found["left.z"]["min_time_s"]) == (-6e3, 0.3)
    assert found["left.ry"]["max_N_m"] == 2e3


def test_the_peaks_of_n12_example_3_1(example):
    crossing, result = example
    found = summary(result, crossing, title="Example 3.1")
    sensor, body = found["sensors"]["midspan"], found["vehicle_accelerations"]["body.z"]
    # peaks of an independent solution of N12 (38, 39) in modes
    assert sensor["displacement_min_m"] == pytest.approx(-2.4069e-3, rel=1e-4)
    assert sensor["displacement_max_m"] == pytest.approx(0.1643e-3, rel=1e-3)
    assert (body["min"], body["max"]) == (pytest.approx(-0.1421, rel=1e-3), pytest.approx(0.1480, rel=1e-3))
    # m (g + a) is the contact force of a mass on a massless wheel
    assert found["contact_forces"]["largest"]["force_N"] == pytest.approx(
        5750.0 * (9.81 + body["max"]), rel=1e-9
    )
    assert found["run"]["speed_start_m_per_s"] == pytest.approx(100.0 / 3.6)
    assert (found["run"]["structure_from_m"], found["run"]["structure_to_m"]) == (0.0, 25.0)
    assert found["computation"]["steps_per_s"] == pytest.approx(900 / found["computation"]["wall_time_s"])
    assert found["verdict"] == "pass"


def test_steps_that_are_not_kept_have_their_extremes_too():
    rough = Harmonic(amplitude=0.5e-3, wavelength=2.0, start=0.0, stop=25.0)
    crossing = Crossing(bridge(), Train.of(mass(), 2, 3.0), speed=20.0, irregularity=rough)
    full, thin = (
        simulate(crossing, time_step=2e-3, steps=600, method=Alpha(0.0), every=every) for every in (1, 7)
    )
    found = summary(thin, crossing)["contact_forces"]
    assert found["largest_over_all_steps_N"] == pytest.approx(full.contact_force.max(), rel=1e-12)
    assert found["smallest_over_all_steps_N"] == pytest.approx(full.contact_force.min(), rel=1e-12)
    assert found["largest"]["force_N"] == thin.contact_force.max() < full.contact_force.max()
    expected = f"over all steps, kept or not: largest {full.contact_force.max() / 1e3:.3f} kN"
    assert expected in text_of(thin, crossing)
    assert "over all steps" not in text_of(full, crossing)


@pytest.mark.parametrize(
    "key, name, limit",
    [
        ("compatibility_residual", "compatibility", 1e-8),
        ("equilibrium_residual", "equilibrium", 1e-6),
        ("energy_residual", "energy", 1e-6),
    ],
)
def test_verdicts_turn_at_their_limits(key, name, limit):
    for value, verdict in (
        (limit, "pass"),
        (1.01 * limit, "attention"),
        (np.inf, "attention"),
        (None, "not checked"),
    ):
        row = next(row for row in verdicts({key: value}) if row["name"] == name)
        assert (row["verdict"], row["limit"]) == (verdict, limit)
        assert ("remedy" in row) == (verdict == "attention")


def test_a_check_that_fails_calls_for_attention():
    bad = {**made().checks, "energy_residual": 1e-3, "finite_values": False}
    found = summary(made(checks=bad))
    assert found["verdict"] == "attention"
    text = "\n".join(summary_lines(found))
    assert "Checks: attention" in text
    assert "  attention    energy         1.0e-03, limit 1e-06" in text
    assert "  attention    finite " in text


def test_tension_is_told_wheel_by_wheel():
    episodes = [
        {
            "contact": "2.1",
            "start": 0.01 * i,
            "stop": 0.01 * i + 0.005,
            "position": 1.0 * i,
            "size": 500.0 + i,
        }
        for i in reversed(range(30))
    ]
    checks = {**made().checks, "tension": episodes, "tension_episodes": 30}
    found = summary(made(checks=checks))
    assert found["tension"]["episodes"] == 30
    assert len(found["tension"]["first"]) == 20
    assert found["tension"]["first"][1] == {
        "contact": "2.1",
        "start_s": 0.01,
        "stop_s": 0.015,
        "position_m": 1.0,
        "largest_tension_N": 501.0,
    }
    lines = summary_lines(found)
    assert "Tension: 30 episodes" in lines
    assert "  wheel 2.1    0.01 to 0.015 s, up to 0.501 kN at 1.000 m" in lines
    assert "  and 22 more" in lines
    assert found["verdict"] == "attention"


def test_a_wheel_that_pulls_is_unloaded_completely():
    result = made()
    forces = result.contact_force.copy()
    forces[2, 0] = -3e3
    text = text_of(replace(result, contact_force=forces))
    assert "unloading complete: see tension" in text
    assert "-0.3000" in text


def test_the_text_of_a_run(example):
    crossing, result = example
    lines = summary_lines(summary(result, crossing, title="Example 3.1", files=["out/result.nc"]))
    assert lines[0] == "Example 3.1: completed"
    for part in (
        "  structure    simple span, 25 m, 100 d.o.f.",
        "  train        sprung mass, 1 wheel",
        "  speed        100 km/h (27.778 m/s)",
        "  time         900 steps of 1 ms, to 0.9 s; alpha 0, beta 0.25, gamma 0.5",
        "  out/result.nc",
        "Checks: pass",
    ):
        assert part in lines
    midspan = next(line for line in lines if line.startswith("  midspan"))
    assert midspan.split()[1:5] == ["-2.4069", "0.371", "0.1643", "0.9"]
    assert max(map(len, lines)) <= 120
    assert all(line == line.rstrip() for line in lines)


def test_long_tables_show_the_largest():
    n = 30
    sizes = np.random.default_rng(5).permutation(n) + 1.0
    result = made(
        sensor=tuple(f"s{i}" for i in range(n)),
        sensor_displacement=np.vstack([np.zeros(n), 1e-3 * sizes, np.zeros((3, n))]),
        sensor_acceleration=np.zeros((5, n)),
    )
    lines = summary_lines(summary(result))
    shown = {line.split()[0] for line in lines if re.match(r"  s\d", line)}
    assert shown == {f"s{i}" for i in np.argsort(-sizes)[:8]}
    assert "  and 22 more sensors with less" in lines
    assert len(summary(result)["sensors"]) == n


def test_moving_forces_are_constant():
    crossing = Crossing(bridge(), Train.of(axle_loads(loads=170e3, positions=[0.0, 3.0])), speed=20.0)
    result = simulate(crossing, time_step=5e-3, steps=100)
    found = summary(result, crossing)
    assert found["vehicle_accelerations"] == {} and found["sensors"] == {}
    assert "  constant     170.000 kN: the static ones" in summary_lines(found)


def test_speed_histories_show_both_ends():
    crossing = Crossing(bridge(), Train.of(mass()), speed_history=[[0.0, 10.0], [1.0, 20.0]])
    result = simulate(crossing, time_step=5e-3, steps=100, method=Alpha(0.0))
    assert "  speed        from 36 to 54 km/h" in text_of(result, crossing).splitlines()


def test_the_summary_is_strict_json_that_a_stored_result_gives_again(tmp_path, example):
    crossing, result = example
    content = summary(result, crossing, title="Brücke", version="1.2.3")
    write_summary(content, tmp_path / "summary.json")

    def strict(word):
        raise AssertionError(word)

    text = (tmp_path / "summary.json").read_text(encoding="utf-8")
    assert json.loads(text, parse_constant=strict) == content
    assert "Brücke" in text
    write_result(result, tmp_path / "result.nc")
    assert summary(read_result(tmp_path / "result.nc"), crossing, title="Brücke", version="1.2.3") == content
    assert sorted(file.name for file in tmp_path.iterdir()) == ["result.nc", "summary.json"]


def test_numbers_that_are_not_finite_become_null():
    checks = {
        **made().checks,
        "energy_residual": np.nan,
        "largest_contact_force": {"1.1": -np.inf, "2.1": None},
    }
    found = summary(made(checks=checks))
    assert found["checks"][3]["value"] is None
    assert found["checks"][3]["verdict"] == "attention"
    assert found["contact_forces"]["largest_over_all_steps_N"] == 44e3
    json.dumps(found, allow_nan=False)


def test_a_failed_run_keeps_what_was_computed(tmp_path):
    crossing = Crossing(bridge(), Train.of(mass()), speed=20.0)
    stubborn = Iteration(tolerance=1e-15, limit=1)
    with pytest.raises(AnalysisError) as caught:
        simulate(crossing, time_step=1e-3, steps=400, coupling="iterative", iteration=stubborn)
    partial = caught.value.result
    write_result(partial, tmp_path / "result.nc", case_text="title: x")
    read = read_result(tmp_path / "result.nc")
    assert read.outcome.code == "failed"
    np.testing.assert_array_equal(read.contact_force, partial.contact_force)
    found = summary(read, crossing, title="Case")
    assert (found["outcome"]["code"], found["verdict"]) == ("failed", "attention")
    lines = summary_lines(found)
    assert lines[0] == "Case: failed"
    assert lines[1].startswith("  failed       ") and "step" in lines[1]


def test_nothing_computed_and_nothing_recorded():
    bare = Result(
        time=np.zeros(0),
        sensor=(),
        contact=(),
        vehicle_dof=(),
        support=(),
        **{name: np.zeros((0, 0)) for name in VARIABLES},
        outcome=Outcome("failed", "stopped", remedy="Start again"),
    )
    lines = summary_lines(summary(bare))
    assert lines[:3] == ["Crossing: failed", "  failed       stopped", "  remedy       Start again"]
    assert "  not checked  energy                               energy that appears" in "\n".join(lines)


def test_printed_lines_are_plain_in_a_pipe_and_colored_on_a_terminal():
    content = summary(made())
    pipe, terminal = io.StringIO(), io.StringIO()
    print_summary(content, Console(file=pipe, width=40))
    print_summary(content, Console(file=terminal, force_terminal=True, color_system="standard"))
    assert pipe.getvalue().splitlines() == summary_lines(content)
    assert "\x1b[32mpass\x1b[0m" in terminal.getvalue()


def test_nothing_is_checked_before_the_first_step(example):
    """A run that fails at once has the start alone: no check of it may say pass."""
    crossing, whole = example
    n_time = len(whole.time)
    kept = {
        field.name: value[:1]
        for field in fields(whole)
        if isinstance(value := getattr(whole, field.name), np.ndarray) and len(value) == n_time
    }
    started = replace(whole, **kept, outcome=Outcome("failed", "step 1: it failed"))
    found = summary(started, crossing)
    assert {check["verdict"] for check in found["checks"]} == {"not checked"}
    assert found["verdict"] == "attention"
