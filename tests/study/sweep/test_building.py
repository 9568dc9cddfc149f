"""What scenarios share is built once, and is what each would build for itself."""

import numpy as np
import pytest
from tests.study.sweep.conftest import STUDY

from axlespan.standards import assess
from axlespan.study.sweep import Study, building, validation
from axlespan.study.sweep.building import Builder
from axlespan.study.sweep.verdicts import verdict_row

# speed runs fastest, then the train, then the structure
SHARED = STUDY[: STUDY.index("vary:")].replace(
    "crossing: {speed: 100 km/h}",
    "crossing: {speed: 100 km/h, irregularity: {kind: spectrum, name: fra-6, seed: 3}}",
)
SHARED += """\
vary:
  structure.second_moment: {factor: [0.9, 1.1]}
  train.0.mass: [12 t, 15 t]
  crossing.speed: [100 km/h, 200 km/h]
passage: {after: 0.1 s}
"""


@pytest.fixture
def study(study_file):
    return Study.load(study_file(SHARED))


def built(study, builder, number):
    return builder.build(study._recipe.composed(study._scenarios.values([number])[0]))


def test_scenarios_share_what_is_the_same(study):
    builder = Builder(study._recipe)
    slow, fast, heavy, _, stiff = (built(study, builder, n).plan for n in range(5))
    assert [plan.crossing.speed * 3.6 for plan in (slow, fast)] == pytest.approx([100.0, 200.0])
    assert fast.structure is slow.structure and fast.fleet is slow.fleet and fast.laws is slow.laws
    assert fast.rows.paths[0].free is slow.rows.paths[0].free
    assert fast.crossing.irregularity is slow.crossing.irregularity
    assert heavy.structure is slow.structure and heavy.fleet is not slow.fleet
    assert heavy.rows.paths[0].free is slow.rows.paths[0].free
    assert stiff.structure is not slow.structure and stiff.crossing.train is slow.crossing.train
    assert stiff.rows.paths[0].free is not slow.rows.paths[0].free


def test_what_is_shared_is_what_each_builds_for_itself(study):
    builder = Builder(study._recipe)
    for number in range(8):
        shared, own = built(study, builder, number).plan, built(study, Builder(study._recipe), number).plan
        assert shared.settings == own.settings
        for one, other in ((shared.structure, own.structure), (shared.fleet.matrices, own.fleet.matrices)):
            assert np.array_equal(one.K.toarray(), other.K.toarray())
            assert np.array_equal(one.M.toarray(), other.M.toarray())
        assert np.array_equal(shared.fleet.weight, own.fleet.weight)
        assert shared.fleet.weight.tolist() == pytest.approx([9.81 * (15e3 if number % 4 > 1 else 12e3)] * 2)
        places = np.linspace(-5.0, 15.0, 41)
        for one, other in zip(shared.rows.paths, own.rows.paths, strict=True):
            assert np.array_equal(one.free.weights(places)[1], other.free.weights(places)[1])
            assert np.array_equal(one.profile.value(places), other.profile.value(places))


def test_each_structure_train_and_irregularity_is_made_once(study, monkeypatch):
    from axlespan.study import build

    made = []
    for module, name in ((building, "structure_of"), (build, "train_of"), (build, "irregularity_of")):
        own = getattr(module, name)
        monkeypatch.setattr(
            module, name, lambda *a, name=name, own=own, **more: made.append(name) or own(*a, **more)
        )
    builder = Builder(study._recipe)
    for number in range(8):
        built(study, builder, number)
    assert {name: made.count(name) for name in made} == {
        "structure_of": 2,
        "train_of": 2,
        "irregularity_of": 1,
    }


def test_parts_that_were_validated_are_taken_as_they_are(study, monkeypatch):
    builder, seen = Builder(study._recipe), []
    make = validation.case_of
    monkeypatch.setattr(building, "case_of", lambda recipe, data: seen.append(data) or make(recipe, data))
    cases = [built(study, builder, number).loaded.case for number in (0, 1)]
    assert isinstance(seen[0]["structure"], dict) and seen[1]["structure"] is cases[0].structure
    assert isinstance(seen[1]["crossing"], dict)  # its speed is another one
    assert [case.crossing.speed * 3.6 for case in cases] == pytest.approx([100.0, 200.0])
    assert cases[1] == study.scenario(1).case


def test_warnings_of_a_train_are_told_each_time(study_file):
    crane = "{vehicle: axle-loads, loads: 90 kN, positions: [0 m, 6 m]}, {vehicle: rigid-mass, mass: 1 t, offset: 3 m}"
    begin, end = STUDY.index("  train: ["), STUDY.index("  crossing: {")
    study = Study.load(study_file(f"{STUDY[:begin]}  train: [{crane}]\n{STUDY[end:]}"))
    builder = Builder(study._recipe)
    first, second = (built(study, builder, number).warnings for number in (0, 5))
    assert first == second
    assert "vehicle 2 begins 3 m behind the first wheel of vehicle 1" in "".join(first)


def test_verdicts_do_not_depend_on_who_was_judged_before(study_file, tmp_path):
    text = SHARED.replace("vary:", "  assessment: {line_speed: 200 km/h}\nvary:").replace(
        "line: 5}", "line: 5, envelopes: [moment]}"
    )
    study = Study.load(study_file(text))
    study.run(tmp_path / "out")
    table = study.table()
    for number in (1, 6):
        scenario = study.scenario(number)
        alone = verdict_row(
            assess(scenario.run(), scenario.built.crossing, scenario.case.assessment.wanted())
        )
        assert alone["verdict.dynamic_effect"] == "pass" and "verdict.dynamic_moment" in alone
        for name, value in alone.items():
            own = table.loc[number, name]
            assert own == pytest.approx(value, rel=1e-9) if isinstance(value, float) else own == value
