"""``axlespan sweep``, and ``axlespan check`` of a study."""

import json
from importlib import resources

import jsonschema
import pandas as pd
import pytest
from ruamel.yaml import YAML

STUDY = """\
title: Two speeds
base:
  structure: {kind: simple-span, length: 10 m, youngs_modulus: 34 GPa, second_moment: 0.1 m^4, mass_per_length: 8 t/m,
    elements: 6}
  train: [{vehicle: axle-loads, loads: 100 kN}]
  crossing: {speed: 100 km/h}
  analysis: {time_step: 5 ms}
  output: {sensors: {midspan: 5 m}}
vary: {crossing.speed: [100 km/h, 150 km/h]}
passage: {after: 0.1 s}
"""


@pytest.fixture
def path(tmp_path):
    file = tmp_path / "study.yaml"
    file.write_text(STUDY)
    return file


def test_what_goes_one_by_one_goes_in_small_batches(axlespan, path):
    """A batch that is interrupted is lost whole, and nothing is gained by large ones."""
    text = STUDY.replace("[100 km/h, 150 km/h]", "{from: 100 km/h, to: 150 km/h, count: 33}")
    text = text.replace(
        "{vehicle: axle-loads, loads: 100 kN}", "{vehicle: sprung-mass, mass: 9 t, stiffness: 1 MN/m}"
    )
    said = {
        "rigid": "5, of up to 8 scenarios side by side",
        "hertz": "5, of up to 8 scenarios one after another",
    }
    for contact, words in said.items():
        path.write_text(text.replace("analysis: {", f"analysis: {{contact: {contact}, "))
        answer = axlespan("check", path)
        assert f"  batches     {words}\n" in answer.out


def test_check_says_what_it_will_take(axlespan, path):
    answer = axlespan("check", path)
    assert answer.code == 0
    lines = dict(line.strip().split(maxsplit=1) for line in answer.out.splitlines()[1:-1])
    assert answer.out.startswith("Two speeds\n")
    assert lines["scenarios"] == "2: 2 of crossing.speed"
    assert lines["structures"] == "1 factorization"
    assert lines["batches"].startswith("1, of up to 8")
    assert "on one core" in lines["time"] and lines["disk"].startswith("about")
    assert (
        answer.out.splitlines()[-1] == f"The study is in order. Run it with: axlespan sweep {path} -o FOLDER"
    )


def test_a_sweep_and_what_it_writes(axlespan, path, tmp_path):
    out = tmp_path / "out"
    answer = axlespan("sweep", path, "-o", out)
    assert (answer.code, answer.err) == (0, "")
    assert "Two speeds: 2 of 2 scenarios completed, 0 failed" in answer.out
    table = pd.read_parquet(out / "table")
    assert table["crossing.speed"].tolist() == pytest.approx([100 / 3.6, 150 / 3.6])
    assert (out / "line_acceleration_max.png").stat().st_size > 5000
    assert json.loads((out / "summary.json").read_text())["completed"] == 2
    assert (out / "study.yaml").read_text() == STUDY
    again = axlespan("sweep", path, "-o", out)
    assert again.code == 2
    assert again.err == (
        f"axlespan: {out}: holds a study already. Use --resume to compute what is missing, "
        "or name another folder with -o\n"
    )
    assert axlespan("sweep", path, "-o", out, "--resume").code == 0


def test_one_scenario_alone_is_like_a_run(axlespan, path, tmp_path):
    assert axlespan("sweep", path, "-o", tmp_path / "all", "--no-figures").code == 0
    answer = axlespan("sweep", path, "-o", tmp_path / "one", "--only", 1)
    assert answer.code == 0
    summary = json.loads((tmp_path / "one" / "summary.json").read_text())
    row = pd.read_parquet(tmp_path / "all" / "table").iloc[1]
    assert summary["scenario"] == {"crossing.speed": "150 km/h"}
    assert summary["provenance"] == row["provenance"]
    lowest = summary["sensors"]["midspan"]["displacement_min_m"]
    assert lowest == pytest.approx(row["sensor.midspan.displacement_min_m"], rel=1e-10)
    missing = axlespan("sweep", path, "-o", tmp_path / "no", "--only", 2)
    assert missing.code == 2 and "scenario = 2: must be from 0 to 1" in missing.err
    assert not (tmp_path / "no").exists()


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (("[100 km/h, 150 km/h]", "[]"), "holds no values"),
        (("crossing.speed: [", "crossing.sped: ["), "is no path of a case. Did you mean crossing.speed?"),
        (("elements: 6", "elements: six"), "structure.elements = six"),
        (("after: 0.1 s", "after: -1 s"), "passage.after = -1 s: must not be negative"),
    ],
)
def test_what_is_wrong_stops_it_before_anything_is_written(axlespan, path, tmp_path, change, says):
    path.write_text(STUDY.replace(*change))
    for command in (("check", path), ("sweep", path, "-o", tmp_path / "out")):
        answer = axlespan(*command)
        assert answer.code == 2 and answer.out == ""
        assert f"{path}:" in answer.err and says in answer.err
    assert sorted(p.name for p in tmp_path.iterdir()) == ["study.yaml"]


def test_far_too_many_by_mistake(axlespan, path, tmp_path):
    path.write_text(
        STUDY.replace("[100 km/h, 150 km/h]", "{from: 100, to: 110, count: 150000}").replace("100,", "20,")
    )
    answer = axlespan("sweep", path, "-o", tmp_path / "out")
    assert answer.code == 2 and not (tmp_path / "out").exists()
    assert "vary: makes 150000 scenarios, about " in answer.err
    assert "Add --yes if that is meant; axlespan check" in answer.err


def test_a_study_is_no_case_and_a_case_no_study(axlespan, path, tmp_path):
    answer = axlespan("run", path, "-o", tmp_path / "out")
    assert answer.code == 2
    says = f"is a study, not a case. Run it with: axlespan sweep {path} -o FOLDER\n"
    assert answer.err == f"axlespan: {path}: {says}"
    case = tmp_path / "case.yaml"
    text = "\n".join(line[2:] for line in STUDY.splitlines()[2:-2])
    case.write_text(text.replace("5 ms", "5 ms, duration: 0.4 s"))
    assert axlespan("check", case).code == 0
    answer = axlespan("sweep", case, "-o", tmp_path / "out")
    assert answer.code == 2
    assert f"{case}: is a case, not a study. axlespan run computes it" in answer.err
    assert sorted(p.name for p in tmp_path.iterdir()) == ["case.yaml", "study.yaml"]


def test_one_scenario_does_not_go_into_a_store(axlespan, path, tmp_path):
    out = tmp_path / "out"
    assert axlespan("sweep", path, "-o", out, "--no-figures").code == 0
    answer = axlespan("sweep", path, "-o", out, "--only", 1)
    assert answer.code == 2
    assert answer.err == f"axlespan: {out}: exists already and is not empty. Name another folder with -o\n"


def test_products_that_no_table_holds(axlespan, path, tmp_path):
    many = "{from: 20, to: 30, count: 10000}"
    vary = f"{{crossing.speed: {many}, structure.length: {many}, structure.mass_per_length: {many}}}"
    path.write_text(STUDY.replace("{crossing.speed: [100 km/h, 150 km/h]}", vary))
    answer = axlespan("sweep", path, "-o", tmp_path / "out", "--yes")
    assert answer.code == 2 and not (tmp_path / "out").exists()
    assert f"{path}:9:1: vary: makes 1e+12 scenarios (10000 × 10000 × 10000); at most 1e+07" in answer.err


def test_a_scheduler_that_is_not_there(axlespan, path, tmp_path, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr("axlespan.study.sweep.on_dask.PATIENCE", 0.5)
    answer = axlespan("sweep", path, "-o", tmp_path / "out", "--scheduler", "tcp://127.0.0.1:1")
    assert answer.code == 2 and not (tmp_path / "out").exists()
    assert "scheduler = 'tcp://127.0.0.1:1': does not answer; tried for" in answer.err


def test_a_disk_that_fills_up(axlespan, path, tmp_path, monkeypatch):
    from axlespan.study.sweep import store

    write = store.write_whole

    def full(place, content):
        if place.suffix == ".parquet":
            raise OSError(28, "No space left on device")
        write(place, content)

    monkeypatch.setattr(store, "write_whole", full)
    answer = axlespan("sweep", path, "-o", tmp_path / "out", "--no-figures")
    assert answer.code == 3
    assert "the store cannot be written: No space left on device; 0 of 2 scenarios are in" in answer.err
    monkeypatch.undo()
    assert axlespan("sweep", path, "-o", tmp_path / "out", "--resume", "--no-figures").code == 0
    assert len(pd.read_parquet(tmp_path / "out" / "table")) == 2


@pytest.fixture(scope="module")
def study_schema(axlespan):
    answer = axlespan("schema", "--study")
    assert (answer.code, answer.err) == (0, "")
    content = json.loads(answer.out)
    jsonschema.Draft202012Validator.check_schema(content)
    return jsonschema.Draft202012Validator(content)


def read(text):
    return YAML(typ="safe").load(text)


@pytest.mark.parametrize("name", ["study-hslm", "study-random", "study-monitoring"])
def test_the_schema_accepts_the_examples(study_schema, name):
    study_schema.validate(read((resources.files("axlespan") / "examples" / f"{name}.yaml").read_text()))


@pytest.mark.parametrize(
    ("vary", "rest"),
    [
        ("{crossing.speed: {from: 20 m/s, to: 30 m/s, count: 3}}", ""),
        ("{crossing.speed: {factor: [0.9, 110 %]}, crossing.irregularity.seed: {seeds: 3}}", ""),
        (
            "{train: {mix: {ice3: 2}, trains: 2, gap: {distribution: uniform, from: 1 m, to: 9 m}}}",
            "zip: [[a, b]]",
        ),
        (
            "{train: hslm-a, structure.damage: [[], [{from: 1 m, to: 2 m, stiffness: 0.5}]]}",
            "passage: {after: 0}",
        ),
    ],
)
def test_the_schema_accepts_all_forms(study_schema, vary, rest):
    study_schema.validate(read(f"base: case.yaml\nvary: {vary}\n{rest}\n"))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("vary: {a: [1]}", "'base' is a required property"),
        ("base: case.yaml\nvary: {}", "should be non-empty"),
        ("base: case.yaml\nvary: {a: []}", "is not valid under any of the given schemas"),
        ("base: case.yaml\nvary: {a: {from: 1, to: 2}}", "is not valid under any of the given schemas"),
        ("base: case.yaml\nvary: {a: {from: 1, to: 2, step: 1, count: 2}}", "is not valid under any"),
        ("base: case.yaml\nvary: {a: 3}", "is not valid under any of the given schemas"),
        ("base: case.yaml\nvary: {a: [1]}\nsampling: {method: halton, count: 3}", "'halton' is not one of"),
        (
            "base: case.yaml\nvary: {a: [1]}\nrecords: {noise: {std: 1}}",
            "'sampling_rate' is a required property",
        ),
        ("base: case.yaml\nvari: {a: [1]}\nvary: {a: [1]}", "'vari' was unexpected"),
    ],
)
def test_the_schema_refuses_what_is_wrong(study_schema, text, says):
    with pytest.raises(jsonschema.ValidationError, match=says):
        study_schema.validate(read(text))


def test_help_names_the_options(axlespan):
    text = axlespan("sweep", "--help").out
    for option in ("--resume", "--workers", "--scheduler", "--yes", "--only"):
        assert option in text
