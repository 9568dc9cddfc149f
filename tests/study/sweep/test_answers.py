"""What a study says: critical speeds, resonances, distributions, verdicts."""

import json

import numpy as np
import pytest

from axlespan.errors import InputError
from axlespan.plot.study import converging, draw_study, exceedance, over_speed
from axlespan.study.sweep import Answers, Study
from axlespan.study.sweep.resonance import Resonances, spacing_of
from axlespan.study.sweep.statistics import Distribution, convergence
from axlespan.vehicles import Train, axle_loads

LENGTH, EI, MASS = 20.0, 34e9 * 0.5, 15e3
FIRST = np.pi / (2.0 * LENGTH**2) * np.sqrt(EI / MASS)

BASE = {
    "title": "Equal wagons",
    "structure": {
        "kind": "simple-span", "length": LENGTH, "youngs_modulus": "34 GPa", "second_moment": 0.5,
        "mass_per_length": MASS, "elements": 8, "damping": {"kind": "modal", "ratio": 0.005},
    },
    "train": [{"vehicle": "axle-loads", "loads": "100 kN", "count": 12, "spacing": 15}],
    "crossing": {"speed": 30},
    "analysis": {"time_step": 0.004},
    "output": {"sensors": {"midspan": 10}, "line": 5},
}  # fmt: skip
TRAINS = {
    "equal": [{"vehicle": "axle-loads", "loads": "100 kN", "count": 12, "spacing": 15}],
    "light": [{"vehicle": "axle-loads", "loads": "20 kN", "count": 12, "spacing": 15}],
}


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    study = Study(
        BASE,
        {"train": ["equal", "light"], "crossing.speed": {"from": 60, "to": 110, "step": 2}},
        trains=TRAINS,
        passage={"after": 0.2},
    )
    folder = tmp_path_factory.mktemp("swept") / "out"
    study.run(folder)
    return study, folder


def test_the_critical_speed_is_that_of_resonance(swept):
    answers = swept[0].answers()
    resonance = FIRST * 15.0  # v = f d
    critical = answers.critical("line_acceleration_max_m_per_s2")
    assert critical["equal"][0] == pytest.approx(resonance, abs=2.0)
    # forces are moved, so the response is proportional to them
    assert critical["equal"][1] == pytest.approx(5.0 * critical["light"][1], rel=1e-9)
    own = answers.resonances["equal"]
    assert own.spacing == pytest.approx(15.0, abs=0.01)
    assert own.frequencies[0] == pytest.approx(FIRST, rel=1e-3)
    assert own.speeds(1)[0] == pytest.approx(resonance, rel=2e-3)


def test_envelopes_are_the_worst_of_all_else(swept):
    answers = swept[0].answers()
    table = swept[0].table()
    for quantity, worst in (("line_acceleration_max_m_per_s2", "max"), ("line_displacement_min_m", "min")):
        envelope = answers.envelope(quantity)
        wanted = table.groupby("speed_m_per_s")[quantity].agg(worst)
        assert envelope.speed == pytest.approx(wanted.index.to_numpy())
        assert envelope.value == pytest.approx(wanted.to_numpy())
        assert table.loc[envelope.id, quantity].to_numpy() == pytest.approx(envelope.value)
    with pytest.raises(InputError, match="is no column of the table"):
        answers.envelope("wobble")
    with pytest.raises(InputError, match="is not among the trains"):
        answers.envelope("line_displacement_min_m", "heavy")


def test_summary_and_table_say_the_same(swept):
    study, folder = swept
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["scenarios"] == summary["completed"] == 52
    worst = summary["quantities"]["line_acceleration_max_m_per_s2"]
    assert worst["worst"] == study.table()["line_acceleration_max_m_per_s2"].max()
    text = "\n".join(study.answers().lines())
    assert "Equal wagons: 52 of 52 scenarios completed, 0 failed" in text
    assert f"equal       {worst['worst']:.4g} m/s² at {3.6 * worst['worst_speed_m_per_s']:.4g} km/h" in text
    assert "contact force" not in text  # of moving forces it says nothing


def test_figures(swept, tmp_path):
    answers = swept[0].answers()
    axes = over_speed(answers, "line_acceleration_max_m_per_s2")
    curve = next(line for line in axes.lines if line.get_label() == "equal")
    envelope = answers.envelope("line_acceleration_max_m_per_s2", "equal")
    assert curve.get_xdata() == pytest.approx(3.6 * envelope.speed)
    assert curve.get_ydata() == pytest.approx(envelope.value)
    marked = [line.get_xdata()[0] for line in axes.lines if line.get_label().startswith("_")]
    assert any(x == pytest.approx(3.6 * FIRST * 15.0, rel=3e-3) for x in marked)
    names = draw_study(answers, tmp_path)
    assert names == ["line_acceleration_max.png", "line_displacement_min.png"]
    assert all((tmp_path / name).stat().st_size > 5000 for name in names)


def test_spacings_of_trains():
    coach = axle_loads(loads=[1e5] * 4, positions=[0.0, 2.5, 17.375, 19.875])
    assert spacing_of(Train.of(coach, count=10, spacing=24.775)) == pytest.approx(24.775, abs=0.02)
    assert spacing_of(Train.of(axle_loads(loads=[1e5], positions=[0.0]), count=1, spacing=3.0)) is None
    found = Resonances(np.array([4.0, 16.0]), 20.0)
    assert found.between(39.0, 81.0) == [(1, 1, 80.0), (1, 2, 40.0), (2, 4, 80.0), (2, 5, 64.0)]


def test_distributions_know_their_error():
    random = np.random.default_rng(4)
    draws = random.gumbel(10.0, 2.0, (200, 400))
    inside = 0
    for values in draws:
        found = Distribution.of(values)
        low, high = found.interval(0.95)
        inside += low <= 10.0 - 2.0 * np.log(-np.log(0.95)) <= high
    assert 0.90 * 200 <= inside <= 200  # bootstrap intervals of quantiles hold about what they promise
    found = Distribution.of(np.append(draws[0], np.nan))
    assert found.standard_error == pytest.approx(draws[0].std(ddof=1) / 20.0)
    share, error = found.exceedance(12.0)
    assert share == (draws[0] > 12.0).mean()
    assert error == pytest.approx(np.sqrt(share * (1.0 - share) / 400))
    counts, means, errors = convergence(draws[0])
    assert counts[-1] == 400 and means[-1] == pytest.approx(draws[0].mean())
    assert errors[5] == pytest.approx(draws[0][: counts[5]].std(ddof=1) / np.sqrt(counts[5]))


def test_a_random_study_tells_its_distribution(tmp_path):
    study = Study(
        BASE,
        {
            "crossing.speed": {"distribution": "uniform", "from": 40, "to": 60},
            "train.0.loads": {"distribution": "normal", "mean": "100 kN", "std": "10 kN"},
        },
        sampling={"method": "latin-hypercube", "count": 32, "seed": 2},
        passage={"after": 0.2},
    )
    study.run(tmp_path / "out")
    answers = study.answers()
    found = answers.summary()["quantities"]["line_displacement_min_m"]["distribution"]
    table = study.table()
    assert found["mean"] == pytest.approx(table["line_displacement_min_m"].mean())
    assert found["quantiles"]["0.95"]["value"] == pytest.approx(
        table["line_displacement_min_m"].quantile(0.95)
    )
    axes = exceedance(answers, "line_displacement_min_m")
    assert axes.get_yscale() == "log"
    assert converging(answers, "line_displacement_min_m").lines[0].get_ydata()[-1] == pytest.approx(
        1e3 * table["line_displacement_min_m"].mean()
    )


def test_verdicts_of_scenarios_and_of_the_study(tmp_path):
    base = {**BASE, "assessment": {"line_speed": "300 km/h", "checks": ["deck_acceleration"]}}
    study = Study(
        base, {"crossing.speed": [70, 96], "train.0.loads": ["20 kN", "400 kN"]}, passage={"after": 0.2}
    )
    study.run(tmp_path / "out")
    table, answers = study.table(), study.answers()
    assert set(table["verdict"]) == {"pass", "fail"} and answers.verdict == "fail"
    exceeded = table["utilization.deck_acceleration"] > 1.0
    assert (table["verdict.deck_acceleration"] == np.where(exceeded, "fail", "pass")).all()
    about = answers.checks()["deck_acceleration"]
    assert about["utilization"] == table["utilization.deck_acceleration"].max()
    assert about["outcomes"]["fail"] == int(exceeded.sum())
    assert any("deck acceleration" in line and "fail" in line for line in answers.lines())


def test_the_worst_of_a_smallest_force_is_the_smallest():
    columns = {
        "id": np.arange(4),
        "outcome": np.array(["completed"] * 4, dtype=object),
        "reason": np.array([""] * 4, dtype=object),
        "train_name": np.array(["a", "a", "b", "b"], dtype=object),
        "speed_m_per_s": np.array([20.0, 30.0, 20.0, 30.0]),
        "passed": np.array([True] * 4),
        "contact_force_min_N": np.array([8e4, 5e4, 9e4, 7e4]),
        "line_displacement_min_m": np.array([-1e-3, -3e-3, -2e-3, -5e-3]),
        "unloading_max": np.array([0.2, 0.5, 0.1, 0.3]),
    }
    answers = Answers("made up", 4, columns, random=True)
    assert answers.critical("contact_force_min_N") == {"a": (30.0, 5e4), "b": (30.0, 7e4)}
    lines = [line.strip() for line in answers.lines()]
    at = lines.index("smallest contact force")
    assert lines[at + 1].startswith("a") and "50 kN at 108 km/h" in lines[at + 1]
    low = np.quantile(columns["contact_force_min_N"], 0.05)
    assert f"95 % above {1e-3 * low:.4g} kN" in lines[at + 3]
    at = lines.index("largest displacement downward")
    assert lines[at + 1].startswith("b") and "-5 mm at 108 km/h" in lines[at + 1]
    assert "95 % above" in lines[at + 3]
    at = lines.index("largest unloading of a wheel")
    assert f"95 % below {100 * np.quantile(columns['unloading_max'], 0.95):.4g} %" in lines[at + 3]
