"""Whatever a case file holds: a case, or errors that name their places."""

import json
from pathlib import Path

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from ruamel.yaml import YAML

from axlespan.errors import InputError
from axlespan.study import LoadedCase, read_case

RIGHT = (Path(__file__).parent / "right.yaml").read_text(encoding="utf-8")
LINES = RIGHT.splitlines(keepends=True)

TOKENS = [
    *"{}[]:,-?|>&*!%@`#'\"\\~ \n\t",
    *(": ", "- ", "&a ", "*a", "<<: ", "!!str ", "!x ", "---\n", "...\n", "%YAML 1.1\n", "\n  "),
    *(
        "25",
        "-1",
        "0",
        ".nan",
        ".inf",
        "1e999",
        "1e-999",
        "0x1F",
        "1:30",
        "2020-01-01",
        "9" * 400,
        "12,5",
        "1 000",
    ),
    *(
        "true",
        "null",
        "none",
        "auto",
        "[]",
        "{}",
        "[[[]]]",
        "kg",
        "m",
        "km/h",
        "%",
        "°",
        "−",
        "\x00",
        "\x85",
        "\u2028",
        "é",
    ),
    *("kind", "vehicle", "count", "speed", "from", "points: [[0, 0], [1, 0]]", "length: 25 m"),
]


@st.composite
def mutations(draw):
    """A right case after a few changes: tokens put in, pieces cut out, lines moved."""
    text = RIGHT
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, len(text)))
        cut = draw(st.sampled_from([0, 0, 1, 2, 5, 20]))
        kind = draw(st.sampled_from(["token", "token", "line", "text"]))
        new = draw(
            st.sampled_from(TOKENS)
            if kind == "token"
            else st.sampled_from(LINES)
            if kind == "line"
            else st.text(max_size=8)
        )
        text = text[:at] + new + text[at + cut :]
    return text


def outcome(text):
    try:
        return read_case(text, "fuzz.yaml")
    except InputError as error:
        return error


@settings(max_examples=600, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(mutations())
@example("? a\n: *b")
@example("a: !!int x")
@example("a: !!float 1:30\nb: !!null x")
@example("{a: 1, ? : 2}")
@example('a: "\\UFFFFFFFF"')
@example("structure: {<<: [1, *x]}")
def test_mutated_cases_load_or_are_refused_with_places(text):
    result = outcome(text)
    if isinstance(result, LoadedCase):
        assert result.case.structure.length > 0.0
        return
    for error in getattr(result, "errors", (result,)):
        assert error.place is not None
        assert error.place.file == "fuzz.yaml"
        assert error.rule
        assert error.place.line is None or 1 <= error.place.line <= len(text.splitlines()) + 1
        assert "pydantic" not in str(error)
        assert "Traceback" not in str(error)


scalars = (
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.sampled_from(["25 m", "x", "none", "1 kg", ""])
)
values = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
)
PATHS = [
    "title",
    "structure",
    "structure.length",
    "structure.damping",
    "train",
    "train.0",
    "train.0.count",
    "crossing.speed",
]
PATHS += [
    "structure.supports.0.at",
    "structure.supports.1.motion.z",
    "crossing.irregularity",
    "analysis.contact",
    "output.sensors",
]


@settings(max_examples=300, deadline=None)
@given(st.sampled_from(PATHS), values)
def test_values_of_any_kind_in_any_place(path, value):
    data = YAML(typ="safe", pure=True).load(RIGHT)
    inner = data
    *steps, last = [int(step) if step.isdigit() else step for step in path.split(".")]
    for step in steps:
        inner = inner[step]
    inner[last] = value
    result = outcome(json.dumps(data).replace("NaN", ".nan").replace("Infinity", ".inf"))  # JSON is YAML
    assert isinstance(result, (LoadedCase, InputError))


def test_the_case_to_begin_with_is_right():
    assert read_case(RIGHT).warnings == ()


@pytest.mark.parametrize("cut", range(0, len(RIGHT), 7))
def test_files_cut_short(cut):
    result = outcome(RIGHT[:cut])
    assert isinstance(result, (LoadedCase, InputError))
