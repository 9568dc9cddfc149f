"""``axlespan check``: what a case is, before it is run."""

import shutil

import numpy as np
import pytest

from axlespan.cli.room import free_disk, free_memory, memory
from axlespan.errors import AnalysisError
from axlespan.study.size import _round_up, size_text

HEAVY_WHEEL = ("stiffness: 1595 kN/m", "stiffness: 1595 kN/m\n    unsprung_mass: 500 kg")


def lines_of(answer):
    """The lines of a description by their first word."""
    return {line.split()[0]: line.split(maxsplit=1)[1] for line in answer.out.splitlines()[1:-1]}


def test_a_case_in_words(axlespan, case):
    path = case()
    answer = axlespan("check", path)
    assert (answer.code, answer.err) == (0, "")
    said = answer.out.splitlines()
    assert said[0] == "Footbridge"
    assert said[-1] == f"The case is in order. Run it with: axlespan run {path} -o FOLDER"
    lines = lines_of(answer)
    exact = np.arange(1, 4) ** 2 * np.pi / 2 / 25.0**2 * np.sqrt(34e9 * 0.9 / 12e3)
    assert lines["structure"].startswith("simple span, 25 m, 40 free d.o.f., mass 300 t, frequencies ")
    found = [float(f) for f in lines["structure"].split("frequencies ")[1].removesuffix(" Hz").split(", ")]
    assert found == pytest.approx(exact, rel=1e-3)
    assert lines["train"] == "sprung mass, 1 vehicle, 1 wheel, 0 m from first wheel to last"
    frequency = np.sqrt(1595e3 / 5750.0) / (2.0 * np.pi)
    load, rest = lines["vehicle"].removeprefix("sprung mass: static wheel loads ").split(" kN; ")
    assert float(load) == pytest.approx(5.750 * 9.81, rel=1e-5)
    assert rest == f"frequencies {frequency:.4g} Hz; {1.0 / frequency / 1e-3:.4g} steps per shortest period"
    assert lines["crossing"] == f"the first wheel runs from 0 to {80 / 3.6 * 0.05:g} m"
    assert lines["analysis"] == "50 steps of 0.001 s, alpha = 0, direct method"
    assert lines["solver"].startswith("banded (narrow band: half-bandwidth 3 of 40 equations)")
    # 2 of the contact, 2 vehicle d.o.f. and 1 sensor by 3, 2 supports
    assert lines["size"].startswith(
        f"51 times of 95 values, at most {51 * 95 * 8 / 1e3:.3g} kB; memory for the run"
    )


def test_nothing_is_written(axlespan, case, tmp_path):
    assert axlespan("check", case()).code == 0
    assert {p.name for p in tmp_path.iterdir()} == {"case.yaml"}


def test_the_words_of_a_shell(axlespan, case, tmp_path):
    path = case(name="my bridge's case.yaml")
    expected = str(path).replace("'", "'\"'\"'")
    assert f"axlespan run '{expected}' -o FOLDER" in axlespan("check", path).out


def test_defaults_are_notes(axlespan, case):
    answer = axlespan("check", case(HEAVY_WHEEL))
    assert (answer.code, answer.err) == (0, "")
    assert "  note        alpha = -0.1 by default, because wheels have mass" in answer.out
    assert "alpha = -0.1, direct method" in answer.out


def test_a_risky_choice_is_a_warning_with_the_remedy(axlespan, case):
    answer = axlespan("check", case(HEAVY_WHEEL, ("steps: 50", "steps: 50\n  alpha: 0")))
    assert answer.code == 0
    assert answer.err == (
        "axlespan: warning: alpha = 0, but wheels have mass: the contact force may oscillate from step to step "
        "without bound; leave alpha out, or use alpha: -0.1\n"
    )
    assert "warning" not in answer.out


@pytest.mark.parametrize(
    ("spans", "total"), [("[1 m, 2 m]", "3 m"), ("[20 m, 20 m]", "40 m"), ("24 m", None)]
)
def test_spans_to_assess_that_are_not_those_of_the_deck(axlespan, case, spans, total):
    path = case(("output:", f"assessment: {{spans: {spans}}}\noutput:"))
    answer = axlespan("check", path)
    said = (
        f"axlespan: warning: {path}:18:21: assessment.spans = {spans}: add up to {total}, and the deck is 25 m long. "
        "Leave them out where the structure knows its spans\n"
    )
    assert (answer.code, answer.err) == (0, said if total else "")


def test_unusual_values_are_warnings_with_their_place(axlespan, case):
    path = case(("elements: 20", "elements: 20\n  damping: {kind: modal, ratio: 45 %}"))
    answer = axlespan("check", path)
    assert answer.code == 0
    assert answer.err == (
        f"axlespan: warning: {path}:9:33: structure.damping.ratio = 45 %: is unusual; is its unit right?\n"
    )


@pytest.mark.parametrize(
    ("entries", "words"),
    [
        (
            "    gap: 0 m",
            "vehicle 2 begins 0 m behind the first wheel of vehicle 1, whose last wheel is 0 m behind it",
        ),
        ("    offset: 0 m", "vehicle 2 begins 0 m behind the first wheel of vehicle 1"),
    ],
)
def test_vehicles_that_overlap(axlespan, case, entries, words):
    block = "  - vehicle: sprung-mass\n    mass: 5750 kg\n    stiffness: 1595 kN/m\n"
    path = case((block, f"{block}{block}{entries}\n"))
    answer = axlespan("check", path)
    assert answer.code == 2
    assert answer.err.startswith(f"axlespan: {path}:10:3: train: {words}")


def test_vehicles_of_one_entry_within_another(axlespan, case):
    old = "  - vehicle: sprung-mass\n    mass: 5750 kg\n    stiffness: 1595 kN/m\n"
    new = "  - {vehicle: axle-loads, loads: 100 kN, spacings: [4 m, 4 m]}\n  - {vehicle: axle-loads, loads: 50 kN, offset: 6 m}\n"
    answer = axlespan("check", case((old, new)))
    assert (
        "vehicle 2 begins 6 m behind the first wheel of vehicle 1, whose last wheel is 8 m behind it"
        in answer.err
    )
    assert answer.out.splitlines()[2].endswith("2 vehicles, 4 wheels, 8 m from first wheel to last")


def test_a_chosen_solver_needs_no_reason(axlespan, case):
    assert (
        lines_of(axlespan("check", case(("steps: 50", "steps: 50\n  solver: superlu"))))["solver"]
        == "superlu"
    )


def test_frequencies_that_are_not_found_are_no_obstacle(axlespan, case, monkeypatch):
    def none(*arguments):
        raise AnalysisError("Lanczos' method found 2 of 3 modes")

    monkeypatch.setattr("axlespan.cli.check.lowest_modes", none)
    answer = axlespan("check", case())
    assert answer.code == 0
    assert "frequencies not found: Lanczos' method found 2 of 3 modes" in answer.out


class TestSize:
    """A run that does not fit is refused before it starts; what would do is said."""

    def test_too_many_records(self, axlespan, case, tmp_path, monkeypatch):
        """100 000 times of 95 values are 76 MB, and with their compressed copy 152 MB."""
        path = case(("steps: 50", "steps: 100000"))
        monkeypatch.setattr("axlespan.cli.room.memory", lambda: 0.36e9)
        answer = axlespan("check", path)
        assert answer == (
            2,
            "",
            f"axlespan: {path}:17:10: analysis.steps = 100000: 100001 kept times of 95 values: the run takes about 502 MB "
            "of memory, and this machine has 360 MB. Keep fewer of them with every: 10 under output, or make fewer steps\n",
        )
        assert axlespan("run", path, "-o", tmp_path / "out").code == 2
        assert not (tmp_path / "out").exists()
        assert (
            axlespan("check", case(("steps: 50", "steps: 100000"), ("output:", "output:\n  every: 2"))).code
            == 2
        )
        monkeypatch.setattr("axlespan.cli.room.memory", lambda: 0.503e9)
        assert axlespan("check", path).code == 0

    def test_what_is_advised_is_accepted(self, axlespan, case, monkeypatch):
        """100 million steps of a train need 1.6 TB."""
        more = ("stiffness: 1595 kN/m", "stiffness: 1595 kN/m\n    count: 40\n    spacing: 9 m")
        long = ("steps: 50", "duration: 1000 s"), ("1 ms", "0.1 ms")
        monkeypatch.setattr("axlespan.cli.room.memory", lambda: 4e9)
        answer = axlespan("check", case(more, *long))
        assert answer.code == 2
        assert (
            "analysis.duration = 1000 s: 10000001 kept times of 407 values: the run takes about 65.5 GB"
            in answer.err
        )
        every = int(answer.err.split("every: ")[1].split()[0])
        assert every == 50
        assert axlespan("check", case(more, *long, ("output:", f"output:\n  every: {every}"))).code == 0

    def test_too_many_fields(self, axlespan, case, monkeypatch):
        path = case(
            ("steps: 50", "steps: 100000"), ("output:", "output:\n  every: 1000\n  fields: {every: 1}")
        )
        monkeypatch.setattr("axlespan.cli.room.memory", lambda: 0.4e9)
        answer = axlespan("check", path)
        # 42 d.o.f. by two, one contact by three
        assert f"the run takes about {(0.35e9 + 16 * 100_001 * 87) / 1e6:.0f} MB of memory" in answer.err
        assert answer.err.startswith(f"axlespan: {path}:20:11: output.fields = {{every: 1}}: 100001 fields: ")
        assert answer.err.endswith("Ask for fewer\n")

    def test_too_many_wheels(self, axlespan, case, monkeypatch):
        more = ("stiffness: 1595 kN/m", "stiffness: 1595 kN/m\n    count: 2000\n    spacing: 9 m")
        monkeypatch.setattr("axlespan.cli.room.memory", lambda: 0.4e9)
        answer = axlespan("check", case(more, ("steps: 50", "steps: 5")))
        assert "train: has 2000 wheels: the run takes about " in answer.err
        assert answer.err.endswith("Use fewer vehicles, or axle-loads for those that matter less\n")

    def test_what_is_hardly_there_is_a_warning(self, axlespan, case, monkeypatch):
        monkeypatch.setattr("axlespan.cli.room.free_memory", lambda: 0.1e9)
        monkeypatch.setattr("axlespan.cli.room.free_disk", lambda folder: 1000.0)
        answer = axlespan("check", case())
        assert answer.code == 0
        assert answer.err == (
            "axlespan: warning: the run takes about 350 MB of memory; 100 MB are free\n"
            "axlespan: warning: the results may take 38.8 kB; 1 kB are free on the disk\n"
        )

    def test_this_machine_has_some(self, tmp_path):
        assert 1e7 < free_memory() <= memory()
        assert free_disk(tmp_path / "no" / "such" / "folder") == pytest.approx(
            shutil.disk_usage(tmp_path).free, rel=0.2
        )

    def test_numbers_in_words(self):
        assert [size_text(n) for n in (0.0, 5304.0, 2.5e6, 1.234e9, 9.99e13)] == [
            "0 kB",
            "5.3 kB",
            "2.5 MB",
            "1.23 GB",
            "99.9 TB",
        ]
        assert [_round_up(n) for n in (0.2, 1.0, 1.01, 2.0, 7.0, 10.0, 10.5, 301.0)] == [
            1,
            1,
            2,
            2,
            10,
            10,
            20,
            500,
        ]
