"""A run with rules: verdicts in summary.json and in the table; what fails does not fail the command."""

import json

import pytest

WANTED = """assessment:
  line_speed: 200 km/h
  bridge_type: prestressed-concrete
  checks: [deck_acceleration, deflection, wheel_unloading, twist, sperling]
"""


@pytest.fixture
def run(axlespan, case, tmp_path):
    def started(*edits):
        out = tmp_path / "out"
        answer = axlespan("run", case(*edits), "-o", out, "--no-figures", "--force")
        return answer, json.loads((out / "summary.json").read_text(encoding="utf-8"))

    return started


def test_without_the_section_nothing_is_assessed(run):
    answer, summary = run()
    assert summary["verdicts"] == [] and summary["assessment"] is None
    assert "Rules" not in answer.out


def test_check_says_what_the_bridge_is_taken_for(axlespan, case):
    answer = axlespan("check", case(("output:", f"{WANTED}output:")))
    assert answer.code == 0
    assert "  rules       simple span of 25 m, L_Φ 25 m, n0 4.013 Hz; 5 checks\n" in answer.out
    assert "rules" not in axlespan("check", case()).out


def test_a_run_that_passes(run):
    answer, summary = run(("output:", f"{WANTED}output:"), ("steps: 50", "steps: 1500"))
    assert (answer.code, summary["assessment"], summary["verdict"]) == (0, "pass", "pass")
    found = {verdict["check"]: verdict for verdict in summary["verdicts"]}
    assert list(found) == ["deck_acceleration", "deflection", "twist", "wheel_unloading", "sperling"]
    assert found["deflection"]["limit"] == pytest.approx(25.0 / 600.0)
    assert found["deflection"]["utilization"] == pytest.approx(found["deflection"]["value"] / (25.0 / 600.0))
    # a single mass of 5750 kg: the largest deflection is near the static one
    static = 5750 * 9.81 * 25.0**3 / (48 * 34e9 * 0.9)
    assert found["deflection"]["value"] == pytest.approx(static, rel=0.1)
    assert found["twist"]["outcome"] == "not assessed" and found["twist"]["value"] is None
    assert "Rules: pass (3 pass, 2 not assessed)" in answer.out
    assert "* numbers of the standard from memory: check against the standard" in answer.out


def test_a_verdict_that_fails(run):
    own = f"{WANTED}  national: NA\n  limits: {{deck_acceleration: 1e-5 m/s^2}}\noutput:"
    answer, summary = run(("output:", own), ("steps: 50", "steps: 1500"))
    assert (answer.code, summary["assessment"]) == (0, "fail")
    assert summary["verdicts"][0]["source"] == "national value: NA"
    lines = answer.out.splitlines()
    begin = next(
        i for i, line in enumerate(lines) if line.startswith("Rules: FAIL (1 of 3 fail, 2 not assessed)")
    )
    assert lines[begin + 1].split()[:2] == ["FAIL", ">"]  # more than a hundred times the limit


def test_coarse_records_say_what_to_write(run):
    wanted = ("output:", f"{WANTED}output:\n  every: 30"), ("steps: 50", "steps: 1500")
    _, summary = run(*wanted)
    assert "records are 0.03 s apart" in summary["verdicts"][0]["reason"]


def test_the_result_is_kept_when_rules_break(run, monkeypatch, tmp_path):
    def broken(*arguments):
        raise ZeroDivisionError("a rule divides by zero")

    monkeypatch.setattr("axlespan.cli.run.assess", broken)
    answer, summary = run(("output:", f"{WANTED}output:"))
    assert answer.code == 0 and summary["verdicts"] == []
    assert "warning: the run could not be assessed: a rule divides by zero" in answer.err
    assert (tmp_path / "out" / "result.nc").exists()


def test_no_line_no_deck(run):
    _, summary = run(("output:", f"{WANTED}output:\n  line: 0"))
    reasons = [verdict["reason"] for verdict in summary["verdicts"][:2]]
    assert reasons == ["the deck was not recorded: write line: 41 under output"] * 2
