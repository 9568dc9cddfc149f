"""A first case file from options, and what the doctor says."""

from __future__ import annotations

import math
import sys

import pytest

from axlespan.cli.doctor import PARTS
from axlespan.cli.init import Options, write_case
from axlespan.study.build import build
from axlespan.study.loader import load_case


@pytest.fixture
def written(axlespan, tmp_path):
    """Write a case file; its path and what was said."""

    def write(*words):
        file = tmp_path / "case.yaml"
        answer = axlespan("init", file, *words)
        assert answer.code == 0, answer.err
        return file, answer.out

    return write


class TestInit:
    def test_the_usual_case_can_be_built(self, written):
        file, said = written()
        assert f"axlespan check {file}" in said
        built = build(load_case(file))
        assert len(built.crossing.train.placements) == 8
        assert built.crossing.structure.length == 25.0
        # The last wheel has left a second before the end.
        end = built.plan.settings.steps * built.plan.settings.time_step
        assert 1.0 <= end - (25.0 + built.crossing.train.wheelbase) / (250.0 / 3.6) < 1.11

    def test_the_frequency_is_that_of_the_span(self, written):
        file, _ = written("--spans", "31 m", "--frequency", "4.2 Hz", "--mass-per-length", "21 t/m")
        case = load_case(file).case.structure
        stiffness = case.youngs_modulus * case.second_moment
        frequency = math.pi / 2.0 * math.sqrt(stiffness / case.mass_per_length) / 31.0**2
        assert frequency == pytest.approx(4.2, rel=1e-3)
        assert case.damping.ratio == 0.01  # EN 1991-2, prestressed concrete from 20 m on

    @pytest.mark.parametrize(
        "words",
        [
            ("--spans", "18 m, 24 m, 18 m", "--train", "hslm-a3", "--line-speed", "none"),
            ("--spans", "40 m", "--track", "ballasted", "--irregularity", "german-low"),
            ("--track", "slab", "--bridge-type", "steel", "--second-moment", "1.2 m^4"),
            ("--train", "truck-2a3", "--speed", "80 km/h", "--spans", "12 m", "--line-speed", "80 km/h"),
        ],
    )
    def test_other_wishes(self, written, words):
        file, _ = written(*words)
        built = build(load_case(file))
        assert built.plan.settings.steps > 1000
        assert (built.loaded.case.assessment is None) == ("none" in words)

    def test_a_truck_is_not_judged_by_the_rules_of_railways(self, written):
        file, _ = written("--train", "truck-2a3", "--speed", "80 km/h", "--spans", "2 x 28 m, 35 m")
        built = build(load_case(file))
        assert built.loaded.case.assessment is None
        assert [span.length for span in built.loaded.case.structure.spans] == [28.0, 28.0, 35.0]
        text = file.read_text(encoding="utf-8")
        assert "rail" not in text and "ballast" not in text and "german" not in text
        assert "name: iso8608-b" in text

    def test_spans_that_cannot_be(self, axlespan, tmp_path):
        for spans, words in (("0 x 20 m", "must have 1 to 200 spans"), ("3 x 20 kg", "kg")):
            answer = axlespan("init", tmp_path / "no.yaml", "--spans", spans)
            assert answer.code == 2 and "--spans" in answer.err and words in answer.err

    def test_questions(self, tmp_path, monkeypatch):
        """What is not given is asked for, again after an answer that cannot be read."""
        answers = iter(["", "", "20 kg", "20 t/m", "", "", "", "hslm-a2", "200 km/h", "", "none"])
        asked = []

        def prompt(question, default):
            asked.append(question)
            return next(answers) or default

        monkeypatch.setattr("axlespan.cli.init.typer.prompt", prompt)
        file = tmp_path / "asked.yaml"
        assert write_case(file, Options(), force=False, ask=True) == 0
        assert [question for question in asked if question == "Mass per length"] == ["Mass per length"] * 2
        case = load_case(file).case
        assert case.structure.mass_per_length == 20_000.0
        assert case.train[0].vehicle == "hslm-a2"
        assert case.crossing.speed == pytest.approx(200.0 / 3.6)

    @pytest.mark.parametrize(
        ("words", "message"),
        [
            (
                ("--train", "ice33"),
                "--train = 'ice33': is not a known name in the library. Did you mean 'ice3'?",
            ),
            (("--speed", "250 kg"), "--speed = '250 kg': must be a speed; 'kg' is a mass"),
            (("--spans", "-3 m"), "--spans = '-3 m': must be positive"),
            (("--spans", ","), "must be a length, or several with commas between"),
            (("--track", "balast"), "Did you mean 'ballasted'?"),
            (("--frequency", "4 Hz", "--second-moment", "2 m^4"), "--second-moment: says again"),
        ],
    )
    def test_bad_wishes(self, axlespan, tmp_path, words, message):
        file = tmp_path / "case.yaml"
        answer = axlespan("init", file, *words)
        assert answer.code == 2
        assert message in answer.err
        assert not file.exists()

    def test_a_file_is_not_replaced_unasked(self, axlespan, written):
        file, _ = written()
        before = file.read_text(encoding="utf-8")
        answer = axlespan("init", file, "--spans", "30 m")
        assert answer.code == 2
        assert "exists already" in answer.err
        assert file.read_text(encoding="utf-8") == before
        assert axlespan("init", file, "--spans", "30 m", "--force").code == 0
        assert file.read_text(encoding="utf-8") != before


class TestDoctor:
    def test_what_it_says_here(self, axlespan):
        answer = axlespan("doctor")
        assert answer.code == 0
        for part in PARTS:
            assert part.package in answer.out
        assert f"({sys.executable})" in answer.out
        assert "semi-analytical solution: ok" in answer.out
        assert "banded, factor" in answer.out

    def test_a_part_that_is_missing(self, axlespan, monkeypatch):
        monkeypatch.setattr(
            "axlespan.cli.doctor._version", lambda part: ("", "") if part.package == "scipy" else ("1.0", "")
        )
        answer = axlespan("doctor")
        assert answer.code == 3
        assert "Needed but not there: scipy" in answer.out

    def test_an_installation_that_computes_wrongly(self, axlespan, monkeypatch):
        monkeypatch.setattr("axlespan.cli.doctor._example", lambda: False)
        answer = axlespan("doctor")
        assert answer.code == 3
        assert "computes wrong numbers" in answer.out
