"""Study files: what varies, and what is said where it is wrong."""

import numpy as np
import pytest
from scipy import stats
from tests.study.sweep.conftest import BASE

from axlespan.errors import InputError
from axlespan.study.sweep import Study

HEAD = f"base:\n{BASE}".replace("alpha: -0.1}", "alpha: -0.1, duration: 1 s}")


def load(study_file, rest):
    return Study.load(study_file(HEAD + rest))


def values(study, path):
    return [scenario.values[path] for scenario in study.scenarios]


def test_ranges_are_what_a_case_file_would_say(study_file):
    study = load(study_file, "vary: {crossing.speed: {from: 140 km/h, to: 420 km/h, step: 5 km/h}}")
    assert len(study.scenarios) == 57
    assert values(study, "crossing.speed")[:2] == ["140 km/h", "145 km/h"]
    assert study.scenarios[56].case.crossing.speed == pytest.approx(420 / 3.6, rel=1e-15)
    counted = load(study_file, "vary: {crossing.speed: {from: 10 m/s, to: 72 km/h, count: 3}}")
    assert [s.case.crossing.speed for s in counted.scenarios] == [10.0, 15.0, 20.0]


def test_products_run_the_last_path_fastest_and_zips_go_together(study_file):
    study = load(
        study_file,
        "vary:\n"
        "  crossing.speed: [20, 30]\n"
        "  train.0.mass: [10 t, 12 t, 14 t]\n"
        "  train.0.stiffness: {factor: [0.9, 1.0, 1.1]}\n"
        "  analysis.time_step: [4 ms, 2 ms]\n"
        "zip: [[train.0.mass, train.0.stiffness]]\n",
    )
    assert len(study.scenarios) == 2 * 3 * 2
    cases = [scenario.case for scenario in study.scenarios]
    assert [case.analysis.time_step for case in cases[:2]] == [0.004, 0.002]
    pairs = {(case.train[0].mass, case.train[0].stiffness) for case in cases}
    assert pairs == {(1e4, 1.35e6), (1.2e4, 1.5e6), (1.4e4, 1.65e6)}
    assert [case.crossing.speed for case in cases] == [20.0] * 6 + [30.0] * 6


def test_seeds_and_trains(study_file):
    study = load(
        study_file,
        "trains: {light: {vehicle: rigid-mass, mass: 5 t}, heavy: [{vehicle: rigid-mass, mass: 20 t}]}\n"
        "vary:\n"
        "  train: [light, heavy, [{vehicle: axle-loads, loads: 100 kN}]]\n"
        "  crossing.irregularity: [{kind: spectrum, name: german-low, seed: 0}]\n"
        "  analysis.alpha: [-0.1]\n",
    )
    assert values(study, "train") == ["light", "heavy", "train 3"]
    assert study.scenarios[1].case.train[0].mass == 2e4
    seeds = load(
        study_file,
        "vary: {crossing.irregularity.seed: {seeds: 4, first: 7}}\n".replace(
            "vary: {",
            "vary: {crossing.irregularity.kind: [spectrum], crossing.irregularity.name: [german-low], ",
        ),
    )
    assert [s.case.crossing.irregularity.seed for s in seeds.scenarios] == [7, 8, 9, 10]


@pytest.mark.parametrize("method", ["latin-hypercube", "sobol", "random"])
def test_random_variables_have_the_moments_that_were_asked_for(study_file, method):
    study = load(
        study_file,
        "vary:\n"
        "  structure.youngs_modulus: {distribution: lognormal, mean: 34 GPa, std: 3 GPa}\n"
        "  crossing.speed: {distribution: uniform, from: 20 m/s, to: 40 m/s}\n"
        "  train.0.mass: {distribution: normal, mean: 12 t, std: 1 t, from: 10 t, to: 14 t}\n"
        "  train.0.stiffness: {factor: {distribution: gamma, a: 16, scale: 0.0625}}\n"
        f"sampling: {{method: {method}, count: 1024, seed: 3}}\n",
    )
    assert len(study.scenarios) == 1024
    columns = [part.values for part in study._scenarios.parts]
    numbers = [np.array([float(text.split()[0]) for text in column]) for column in columns]
    bound = 4.0 / np.sqrt(1024)  # four standard errors of plain sampling
    assert abs(numbers[0].mean() / 34.0 - 1.0) < bound * 3 / 34
    assert abs(numbers[0].std() / 3.0 - 1.0) < bound
    assert 20.0 <= numbers[1].min() < 20.2 and 39.8 < numbers[1].max() <= 40.0
    assert numbers[2].min() >= 10.0 and numbers[2].max() <= 14.0
    # each marginal follows its distribution, and variables are independent
    shape = np.sqrt(np.log1p((3 / 34) ** 2))
    law = stats.lognorm(shape, scale=34.0 * np.exp(-0.5 * shape**2))
    assert stats.kstest(numbers[0], law.cdf).pvalue > 0.01
    assert stats.kstest(numbers[3] / 1.5, stats.gamma(16, scale=0.0625).cdf).pvalue > 0.01
    assert abs(np.corrcoef(numbers[0], numbers[1])[0, 1]) < bound
    again = load(
        study_file,
        study_text := "vary: {crossing.speed: {distribution: uniform, from: 20 m/s, to: 40 m/s}}\n"
        f"sampling: {{method: {method}, count: 8, seed: 3}}\n",
    )
    assert values(again, "crossing.speed") == values(load(study_file, study_text), "crossing.speed")


def test_traffic_mixes_trains_by_their_shares(study_file):
    study = load(
        study_file,
        "trains: {a: [{vehicle: rigid-mass, mass: 5 t}], b: [{vehicle: rigid-mass, mass: 6 t}]}\n"
        "vary:\n"
        "  train: {mix: {a: 3, b: 1}, trains: 2, headway: {distribution: uniform, from: 20 s, to: 30 s}}\n"
        "  crossing.speed: {distribution: uniform, from: 20 m/s, to: 40 m/s}\n"
        "sampling: {method: latin-hypercube, count: 400}\n",
    )
    labels = values(study, "train")
    first = [label.split(" + ")[0] for label in labels]
    assert first.count("a") == 300  # a Latin hypercube meets shares exactly
    for scenario in study.scenarios[:20]:
        case = scenario.case
        assert 20.0 <= case.train[1].gap / case.crossing.speed <= 30.0


@pytest.mark.parametrize(
    ("rest", "says"),
    [
        ("vary: {}", "8:7: vary = {}: holds nothing that varies"),
        ("vary: {crossing.speed: []}", "8:24: vary.crossing.speed = []: holds no values"),
        ("vary: {crossing.speed: }", "8:8: vary.crossing.speed: is empty"),
        (
            "vary: {crossing.speed: 30}",
            "vary.crossing.speed = 30: is one value, which does not vary. Write a list, [30]",
        ),
        (
            "vary: {crossing.sped: [20, 30]}",
            "8:8: vary.crossing.sped: is no path of a case. Did you mean crossing.speed?",
        ),
        ("vary: {crosing: [20]}", "is no path of a case. Did you mean crossing?"),
        ("vary: {train.3.mass: [1 t]}", "leads into a list that has no entry 3. Entries are 0 to 0"),
        ("vary: {crossing.speed.x: [1]}", "leads into a single value, which has no x"),
        (
            "vary: {crossing.speed: [20 m/s, -5 m/s]}",
            "8:33: vary.crossing.speed = -5 m/s: must not be negative. Write 5 m/s",
        ),
        ("vary: {crossing.speed: [20, 30 kg]}", "30 kg"),
        ("vary: {crossing.speed: {from: 1 m/s, to: 2 kg, step: 1 m/s}}", "must be a quantity like 1 m/s"),
        ("vary: {crossing.speed: {from: 1 m/s, to: 2 m/s}}", "is missing. Add step: 5 km/h, or count: 57"),
        (
            "vary: {crossing.speed: {from: 2 m/s, to: 1 m/s, step: 1 m/s}}",
            "never gets from the first value to the last",
        ),
        (
            "vary: {crossing.speed: {from: 1 m/s, to: 2 m/s, step: -0.5 m/s}}",
            "step = -0.5 m/s: never gets from the first value to the last. Write 0.5 m/s",
        ),
        (
            "vary: {crossing.speed: {from: 1 m/s, to: 2 m/s, step: 0 m/s}}",
            "step = 0 m/s: must not be zero. Write how far values are apart, or count: 57 in its place",
        ),
        (
            "vary: {crossing.speed: {from: 140, to: 420 km/h, step: 5 km/h}}",
            "vary.crossing.speed.from = 140: has no unit, and to has one. Write 140 km/h",
        ),
        (
            "vary: {crossing.irregularity.seed: {seeds: 3}}",
            "8:8: vary.crossing.irregularity.seed: needs crossing.irregularity, which the base does not have",
        ),
        (
            "vary: {crossing.speed: {from: 0, to: 1, step: 1e-9}}",
            "makes 1000000001 values; at most 1000000 are possible",
        ),
        ("vary: {crossing.speed: {form: 1}}", "does not say how the value varies"),
        (
            "vary: {crossing.speed: {seeds: 10}}",
            "8:24: vary.crossing.speed = {seeds: 10}: are seeds, for paths such as crossing.irregularity.seed",
        ),
        (
            "vary: {crossing.speed: {distribution: normal, mean: 30 m/s, std: 1 m/s}}",
            "is random, and sampling is missing. Add sampling: {method: latin-hypercube",
        ),
        (
            "vary: {crossing.speed: {distribution: normal, mean: 30 m/s, std: -1 m/s}}\nsampling: {method: random, count: 3}",
            "8:66: vary.crossing.speed.std = -1 m/s: must be positive",
        ),
        (
            "vary: {crossing.speed: {distribution: normal, mean: 1 m/s, std: 9 m/s}}\nsampling: {method: random, count: 99}",
            "must not be negative. Cut it off with from and to",
        ),
        (
            "vary: {crossing.speed: {factor: [1, -1.1]}}",
            "8:37: vary.crossing.speed = -110.0 km/h: must not be negative. Take other factors",
        ),
        (
            "vary: {crossing.speed: {distribution: uniform, from: 3, to: 2}}\nsampling: {method: random, count: 3}",
            "must be greater than from",
        ),
        (
            "vary: {crossing.speed: {distribution: nomal, mean: 3, std: 2}}\nsampling: {method: random, count: 3}",
            "no such distribution. Did you mean normal?",
        ),
        (
            "vary: {crossing.speed: {distribution: beta, a: -1, b: 2}}\nsampling: {method: random, count: 3}",
            "beta has no values with these parameters (a: -1, b: 2)",
        ),
        (
            "vary: {crossing.speed: {distribution: beta, a: 1}}\nsampling: {method: random, count: 3}",
            "vary.crossing.speed.b: is missing",
        ),
        (
            "vary: {crossing.speed: [1]}\nsampling: {method: random, count: 3}",
            "has no random variable to sample",
        ),
        (
            "vary: {crossing.speed: [1]}\nsampling: {method: halton, count: 3}",
            "must be latin-hypercube, sobol or random",
        ),
        (
            "vary: {crossing.speed: [1, 2], train.0.mass: [5 t]}\nzip: [[crossing.speed, train.0.mass]]",
            "has 1 values, and crossing.speed has 2",
        ),
        (
            "vary: {crossing.speed: [1, 2]}\nzip: [[crossing.speed, crossing.speed]]",
            "names a path twice",
        ),
        (
            "vary: {crossing.speed: [1, 2]}\nzip: [[crossing.speed, crossing.start]]",
            "is not among the lists of vary",
        ),
        ("vary: {crossing: [{speed: 20}], crossing.speed: [1]}", "lies within crossing, which varies too"),
        ("vary: {train: [nosuch]}", "8:16: vary.train.0 = nosuch: no such train"),
        ("vary: {train: {mix: {ice3: -1}}}\nsampling: {method: random, count: 3}", "must be positive"),
        ("vary: {crossing.speed: [20, 20]}", "is named twice"),
        ("vari: {crossing.speed: [20, 20]}", "8:1: vari: unknown key. Did you mean vary?"),
        ("vary: {crossing.speed: [20]}\nhistories: {variables: [sensor]}", "must be sensor_displacement"),
        (
            "vary: {crossing.speed: [20]}\nrecords: {quantity: sensor_velocity}",
            "records.sampling_rate: is missing",
        ),
        ("vary: {crossing.speed: [20]}\npassage: {before: 3 s}", "unknown key. Keys here are after"),
    ],
)
def test_what_is_wrong_is_named_with_its_place(study_file, rest, says):
    with pytest.raises(InputError) as caught:
        load(study_file, rest)
    assert says in str(caught.value)
    assert str(caught.value).startswith(str(study_file(HEAD + rest))) or "study.yaml:" in str(caught.value)


def test_speeds_that_were_meant_in_kilometers_per_hour_are_a_warning(study_file):
    study = load(study_file, "vary: {crossing.speed: [80, 100, 120]}")
    (said,) = study.trial(timed=False).cautions
    assert said.endswith(
        "study.yaml:8:29: vary.crossing.speed.1 = 100: is taken as 100 m/s, which is 360 km/h. "
        "Write 100 km/h if that is meant"
    )
    assert load(study_file, "vary: {crossing.speed: [80, 360 km/h]}").trial(timed=False).cautions == ()


def test_a_base_that_a_run_would_refuse_is_refused(study_file):
    """8 t/m, written as 8."""
    base = HEAD.replace("8 t/m", "8")
    assert base != HEAD
    with pytest.raises(InputError, match=r"structure.mass_per_length = 8: with it the first frequency"):
        Study.load(study_file(base + "vary: {crossing.speed: [20 m/s, 30 m/s]}"))
    Study.load(study_file(base + "vary: {structure.mass_per_length: [14 t/m, 15 t/m]}"))


def test_the_base_may_stand_in_a_file_of_its_own(study_file):
    case = "\n".join(line[2:] for line in HEAD.splitlines()[1:]) + "\n"
    study_file(case, "case.yaml")
    study = Study.load(study_file("base: case.yaml\nvary: {crossing.speed: [20 m/s, 30 m/s]}\n"))
    assert [s.case.crossing.speed for s in study.scenarios] == [20.0, 30.0]
    study_file(case.replace("10 m,", "-10 m,"), "case.yaml")
    with pytest.raises(InputError, match=r"case.yaml:1:40: structure.length = -10 m: must be positive"):
        Study.load(study_file("base: case.yaml\nvary: {crossing.speed: [20 m/s]}\n"))
    with pytest.raises(InputError, match=r"study.yaml:1:7: base = cas.yaml: no such file"):
        Study.load(study_file("base: cas.yaml\nvary: {crossing.speed: [20 m/s]}\n"))


def test_python_says_the_same_without_lines_of_a_file():
    with pytest.raises(InputError) as caught:
        Study({"structure": {"kind": "simple-span"}}, {"crossing.speed": [20]})
    assert "structure.length: is missing" in str(caught.value)
    assert "study:" not in str(caught.value)
    with pytest.raises(InputError, match=r"^vary.crossing.speed.0 = 'x'|^vary"):
        Study({}, {"crossing.speed": {"from": "x", "to": 2, "step": 1}})
