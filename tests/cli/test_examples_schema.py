"""``axlespan examples``, ``axlespan schema``, help, version and wrong usage."""

import json
import re
from importlib.resources import files

import jsonschema
import pytest
from ruamel.yaml import YAML

import axlespan as package
from axlespan.cli.examples import everything, shipped, studies
from axlespan.study import load_case, schema

NAMES = ["neves2012-3.1", "neves2012-3.2", "three-spans", "wheels-with-mass"]


class TestExamples:
    def test_they_are_listed_with_their_titles(self, axlespan):
        answer = axlespan("examples")
        assert (answer.code, answer.err) == (0, "")
        *listed, empty, hint = answer.out.splitlines()
        titles = dict(line.split(maxsplit=1) for line in listed)
        assert set(NAMES) <= set(titles)
        assert list(titles) == sorted(titles) == list(everything())
        assert titles["neves2012-3.1"] == "Neves et al. (2012), example 3.1"
        assert (empty, hint) == (
            "",
            "Copy one with: axlespan examples NAME, then run it with: axlespan run NAME.yaml -o out",
        )

    @pytest.mark.parametrize("name", list(shipped()))
    def test_each_says_what_it_is_and_is_valid(self, axlespan, tmp_path, name):
        assert axlespan("examples", name, "-o", tmp_path / "new/folder").code == 0
        path = tmp_path / "new/folder" / f"{name}.yaml"
        assert path.read_text(encoding="utf-8") == (
            files("axlespan") / "examples" / f"{name}.yaml"
        ).read_text("utf-8")
        assert path.read_text(encoding="utf-8").startswith("# ")
        loaded = load_case(path)
        assert loaded.warnings == ()
        assert (
            loaded.case.title
            == dict(line.split(maxsplit=1) for line in axlespan("examples").out.splitlines()[:-2])[name]
        )

    @pytest.mark.parametrize("name", list(studies()))
    def test_each_study_says_what_it_is_and_is_valid(self, axlespan, tmp_path, name):
        assert axlespan("examples", name, "-o", tmp_path).code == 0
        text = (tmp_path / f"{name}.yaml").read_text(encoding="utf-8")
        assert text.startswith("# ")
        study = package.Study.load(tmp_path / f"{name}.yaml")
        assert len(study.scenarios) > 1
        assert not study.trial(timed=False).cautions

    def test_several_and_all(self, axlespan, tmp_path):
        answer = axlespan("examples", "three-spans.yaml", "neves2012-3.1", "three-spans", "-o", tmp_path)
        assert answer.code == 0
        assert answer.out.splitlines() == [f"{tmp_path}/three-spans.yaml", f"{tmp_path}/neves2012-3.1.yaml"]
        answer = axlespan("examples", "all", "-o", tmp_path / "all")
        assert {path.stem for path in (tmp_path / "all").glob("*.yaml")} == set(everything())
        copied = [str(path) for path in (tmp_path / "all").rglob("*") if path.is_file()]
        assert sorted(answer.out.splitlines()) == sorted(copied)

    def test_here_when_no_folder_is_named(self, axlespan, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)
        assert axlespan("examples", "three-spans").out == "three-spans.yaml\n"
        assert (tmp_path / "three-spans.yaml").exists()

    @pytest.mark.parametrize("words", [["neves2012-3.1"], ["three-spans", "neves2012-3.1"], ["all"]])
    def test_existing_files_stay_unless_forced(self, axlespan, tmp_path, words):
        mine = tmp_path / "neves2012-3.1.yaml"
        mine.write_text("mine")
        answer = axlespan("examples", *words, "-o", tmp_path)
        assert answer == (2, "", f"axlespan: {mine}: exists already. Use --force to replace it\n")
        assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {mine.name: "mine"}
        assert axlespan("examples", *words, "-o", tmp_path, "--force").code == 0
        assert mine.read_text(encoding="utf-8") == shipped()["neves2012-3.1"]

    @pytest.mark.parametrize(
        ("name", "fix"),
        [("threespans", "Did you mean 'three-spans'?"), ("../secret", "Known: "), ("", "Known: ")],
    )
    def test_unknown_names(self, axlespan, tmp_path, name, fix):
        answer = axlespan("examples", "three-spans", name, "-o", tmp_path)
        assert (answer.code, answer.out) == (2, "")
        assert answer.err.startswith(f"axlespan: example = {name!r}: is not a known example. {fix}")
        assert list(tmp_path.iterdir()) == []

    def test_a_file_in_the_way(self, axlespan, tmp_path):
        (tmp_path / "file").write_text("mine")
        answer = axlespan("examples", "three-spans", "-o", tmp_path / "file")
        assert answer.code == 2
        assert answer.err.startswith(f"axlespan: {tmp_path}/file/three-spans.yaml: cannot be written: ")
        assert answer.err.endswith("Name another folder with -o\n")


@pytest.fixture(scope="module")
def printed(axlespan):
    """The schema, as it is printed."""
    answer = axlespan("schema")
    assert (answer.code, answer.err) == (0, "")
    return json.loads(answer.out)


class TestSchema:
    def test_it_is_that_of_the_package_and_valid(self, printed):
        assert printed == json.loads(json.dumps(schema()))
        jsonschema.Draft202012Validator.check_schema(printed)

    @pytest.mark.parametrize("name", list(shipped()))
    def test_it_accepts_the_examples(self, printed, name):
        jsonschema.Draft202012Validator(printed).validate(YAML(typ="safe").load(shipped()[name]))

    @pytest.mark.parametrize(
        ("old", "new"),
        [
            ("elements: 50", "elements: 0"),
            ("length: 25 m", "lenght: 25 m"),
            ("speed: 100 km/h", ""),
            ("alpha: 0.0", "alpha: 0.1"),
        ],
    )
    def test_it_refuses_what_is_wrong(self, printed, old, new):
        text = shipped()["neves2012-3.1"]
        assert old in text
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.Draft202012Validator(printed).validate(YAML(typ="safe").load(text.replace(old, new)))


class TestUsage:
    def test_version(self, axlespan):
        assert axlespan("--version") == (0, f"axlespan {package.__version__}\n", "")

    @pytest.mark.parametrize("option", ["--help", "-h"])
    def test_help(self, axlespan, option):
        answer = axlespan(option)
        assert (answer.code, answer.err) == (0, "")
        listed = re.findall(r"^  (\w+) {2,}(.*)$", answer.out.split("Commands:")[1], re.M)
        assert {"run", "sweep", "check", "modes", "examples", "schema", "verify"} <= {
            name for name, _ in listed
        }
        assert all(text.endswith(".") and not text.endswith("..") for _, text in listed), "no line is cut off"

    @pytest.mark.parametrize("command", ["run", "sweep", "check", "modes", "examples", "schema", "verify"])
    def test_help_of_commands(self, axlespan, command):
        answer = axlespan(command, "--help")
        assert (answer.code, answer.err) == (0, "")
        assert answer.out.startswith(f"Usage: axlespan {command} ") or answer.out.startswith("Usage: root ")
        assert "``" not in answer.out

    @pytest.mark.parametrize(
        ("words", "said"),
        [
            ([], "Usage"),
            (["run"], "Missing argument 'CASE'"),
            (["runn"], "No such command 'runn'"),
            (["run", "a.yaml", "a.yaml"], "Got unexpected extra argument"),
            (["run", "a.yaml", "--fast"], "No such option: --fast"),
            (["check"], "Missing argument 'CASE'"),
            (["check", "a.yaml", "-o", "out"], "No such option: -o"),
            (["schema", "case"], "Got unexpected extra argument"),
        ],
    )
    def test_wrong_usage(self, axlespan, words, said):
        answer = axlespan(*words)
        assert answer.code == 2
        assert said in answer.err + answer.out
