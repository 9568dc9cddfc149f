"""The same numbers alone, side by side, in processes; processes that die; batches."""

import os
import signal
from pathlib import Path

import numpy as np
import pytest
from tests.study.sweep.conftest import STUDY, numbers_differ

from axlespan.interaction.groundwork import Groundwork
from axlespan.study.sweep import Study, building, executors, workshop
from axlespan.study.sweep.executors import InProcess, Lost, Processes
from axlespan.study.sweep.planning import tasks
from axlespan.study.sweep.recipe import Recipe
from axlespan.study.sweep.workshop import run_task

EQUAL = 1e-10


@pytest.fixture
def study(study_file):
    return Study.load(study_file())


def rows(dones):
    import pandas as pd

    return pd.DataFrame([row for done in dones for row in done.rows]).sort_values("id").set_index("id")


def work(study, lanes):
    return tasks(study._recipe, study._scenarios, np.arange(len(study.scenarios)), lanes)


def test_numbers_do_not_depend_on_who_is_beside(study):
    alone = rows(InProcess().run(work(study, 1)))
    for lanes in (2, 5, 128):
        beside = rows(InProcess().run(work(study, lanes)))
        assert numbers_differ(alone, beside) < EQUAL


def test_processes_compute_the_same_and_tell_how_far_they_are(study_file, monkeypatch):
    # 16 scenarios, and long enough to be seen under way
    study = Study.load(
        study_file(STUDY.replace("time_step: 4 ms", "time_step: 0.1 ms").replace("step: 40", "step: 80"))
    )
    alone = rows(InProcess().run(work(study, 128)))
    monkeypatch.setattr(executors, "_PAUSE", 0.02)
    shares = []
    made = list(Processes(2).run(work(study, 4), lambda number, share: shares.append((number, share))))
    assert numbers_differ(alone, rows(made)) < EQUAL
    sizes = {one.number: len(one.rows) for one in made}
    assert all(0.0 <= share <= sizes[number] + 1e-9 for number, share in shares)
    assert any(0.0 < share < sizes[number] for number, share in shares)


def test_a_reduced_basis_does_not_depend_on_the_batch(study_file):
    text = STUDY.replace("alpha: -0.1", "alpha: -0.1, basis: reduced").replace("step: 40", "step: 100")
    study = Study.load(study_file(text))
    alone = rows(InProcess().run(work(study, 1)))
    assert numbers_differ(alone, rows(InProcess().run(work(study, 128)))) < EQUAL


def test_scenarios_of_a_structure_follow_each_other(study):
    made = [task.ids for task in work(study, 5)]
    assert sorted(number for ids in made for number in ids) == list(range(24))
    moments = [[study.scenario(number).case.structure.second_moment for number in ids] for ids in made]
    flat = [moment for batch in moments for moment in batch]
    assert flat == sorted(flat)  # each structure is begun once
    assert all(len(set(batch)) == 1 for batch in moments)
    assert max(map(len, made)) <= 5


def test_many_structures_share_a_task_and_time_steps_do_not(study_file):
    text = STUDY.replace("{factor: [0.9, 1.1]}", "{from: 0.08 m^4, to: 0.12 m^4, count: 50}").replace(
        "  crossing.speed: {from: 100 km/h, to: 300 km/h, step: 40 km/h}\n",
        "  analysis.time_step: [4 ms, 2 ms]\n",
    )
    study = Study.load(study_file(text))
    batches = [task.ids for task in work(study, 40)]
    assert len(batches) == 6  # 100 scenarios of each time step
    for ids in batches:
        assert len({study.scenario(number).case.analysis.time_step for number in ids}) == 1


def test_a_structure_is_built_once_and_kept(study, monkeypatch):
    built = []
    make = building.structure_of
    monkeypatch.setattr(building, "structure_of", lambda case: built.append(case) or make(case))
    workshop.forget()
    list(InProcess().run(work(study, 3)))
    assert [case.second_moment for case in built] == pytest.approx([0.09, 0.11])


def deadly(task, tell=None):
    """A task that kills its process, if it holds scenario 3; others are computed."""
    if 3 in task.ids:
        os.kill(os.getpid(), signal.SIGKILL)
    return run_task(task)


def test_a_task_that_kills_its_process_is_given_up_and_the_others_are_done(study, monkeypatch):
    monkeypatch.syspath_prepend(str(Path(__file__).parents[3]))  # processes find this module there
    monkeypatch.setattr(executors, "run_task", deadly)
    monkeypatch.setattr(executors, "TRIES", 1)
    outcomes = list(Processes(1).run(work(study, 6)))  # two tasks are on their way when it dies
    lost = [one for one in outcomes if isinstance(one, Lost)]
    done = sorted(row["id"] for one in outcomes if not isinstance(one, Lost) for row in one.rows)
    assert len(lost) == 1 and 3 in lost[0].ids
    assert "its process died 2 times" in lost[0].reason
    assert sorted([*done, *lost[0].ids]) == list(range(24))


def test_workers_of_another_version_refuse(study):
    from dataclasses import replace

    from axlespan.errors import InputError

    recipe = replace(Recipe.of(study.spec), version="0.0.1")
    with pytest.raises(InputError, match=r"this worker has axlespan .*, and the run was started by 0.0.1"):
        workshop.Workshop(recipe)


@pytest.mark.parametrize("basis", ["full", "reduced"])
def test_a_structure_is_factored_once_for_all_its_tasks(study_file, monkeypatch, basis):
    study = Study.load(study_file(STUDY.replace("alpha: -0.1", f"alpha: -0.1, basis: {basis}")))
    laid = []
    make = Groundwork.of.__func__
    monkeypatch.setattr(
        Groundwork, "of", classmethod(lambda cls, plans: laid.append(plans) or make(cls, plans))
    )
    workshop.forget()
    together = rows(InProcess().run(work(study, 3)))
    assert len(laid) == 2  # structures; the tasks are eight
    monkeypatch.undo()
    apart = []
    for task in work(study, 3):
        workshop.forget()
        apart += InProcess().run([task])
    assert numbers_differ(rows(apart), together) < EQUAL


def test_factors_of_other_time_steps_and_methods_are_not_mixed(study_file):
    text = STUDY.replace("step: 40", "step: 100").replace(
        "vary:\n", "vary:\n  analysis.alpha: [-0.1, -0.2]\n  analysis.time_step: [4 ms, 3 ms]\n"
    )
    study = Study.load(study_file(text))
    workshop.forget()
    kept = rows(InProcess().run(work(study, 128)))
    for number in (0, 10, len(study.scenarios) - 1):
        alone = study.scenario(number).run()
        assert kept.loc[number, "sensor.midspan.displacement_min_m"] == pytest.approx(
            alone.sensor_displacement.min(), rel=EQUAL
        )
