"""The store: right at any moment, whatever is killed or full; nothing lost, nothing twice."""

import errno
import os
import random
import signal
import subprocess
import time

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from tests.study.sweep.conftest import STUDY, numbers_differ

from axlespan.errors import InputError
from axlespan.study.sweep import Study, files, store

WITH_HISTORIES = STUDY.replace(
    "passage:", "histories: {variables: [sensor_acceleration, contact_force], every: 2}\npassage:"
)
EQUAL = 1e-10  # of the peak; batches of other sizes differ by rounding


@pytest.fixture
def path(study_file):
    return study_file(WITH_HISTORIES)


@pytest.fixture
def study(path):
    return Study.load(path)


@pytest.fixture
def small_parts(monkeypatch):
    monkeypatch.setattr(store, "_SECONDS", 0.0)
    monkeypatch.setattr("axlespan.study.sweep.study.lanes_for", lambda scenarios, workers, most: 2)


def histories_of(folder):
    """Accelerations by id; fails where a scenario is there twice."""
    found = {}
    for shard in (folder / "histories").glob("*.nc"):
        with xr.open_dataset(shard) as data:
            for number in data.scenario.values.tolist():
                assert number not in found
                found[number] = data.sensor_acceleration.sel(scenario=number).dropna("time").values
    return found


def require_equal(study, folder, reference):
    table, wanted = study.table(folder), study.table(reference)
    assert numbers_differ(wanted, table) < EQUAL
    one, other = histories_of(reference), histories_of(folder)
    assert sorted(one) == sorted(other) == list(wanted.index)
    for number, values in one.items():
        assert np.abs(values - other[number]).max() < EQUAL * np.abs(values).max()
    left = [
        p.name for p in folder.rglob("*") if p.name.startswith(".partial") or p.suffix in (".old", ".new")
    ]
    assert left == []


def test_what_a_store_holds_opens_with_everyday_tools(study, tmp_path):
    outcome = study.run(tmp_path / "out")
    assert (outcome.scenarios, outcome.computed, outcome.failed, outcome.missing) == (24, 24, 0, 0)
    table = pd.read_parquet(tmp_path / "out" / "table")
    assert table["id"].tolist() == list(range(24))
    assert table["crossing.speed"].iloc[0] == pytest.approx(100 / 3.6)
    assert table["structure.second_moment"].iloc[[0, 2]].tolist() == pytest.approx([0.09, 0.11])
    assert (table["outcome"] == "completed").all() and table["passed"].all()
    duckdb = pytest.importorskip("duckdb")
    query = f"select max(line_acceleration_max_m_per_s2), count(*) from '{tmp_path}/out/table/*.parquet'"
    worst, count = duckdb.sql(query).fetchall()[0]
    assert count == 24 and worst == table["line_acceleration_max_m_per_s2"].max()
    shard = table["histories"].iloc[0]
    with xr.open_dataset(tmp_path / "out" / "histories" / shard) as data:
        own = data.sensor_acceleration.sel(scenario=0, sensor="midspan").dropna("time")
        alone = study.scenario(0).run()
        assert own.values == pytest.approx(alone.at("sensor_acceleration", "midspan")[::2], abs=1e-10)
        assert float(own.time[1]) == 0.008
        assert data.contact_force.dims == ("scenario", "time", "contact")


def test_extremes_are_those_of_the_histories(study, tmp_path):
    study.run(tmp_path / "out")
    table = study.table()
    for number in (0, 13, 23):
        result, row = study.scenario(number).run(), table.loc[number]
        u = result.at("sensor_displacement", "midspan")
        a = result.at("sensor_acceleration", "midspan")
        assert row["sensor.midspan.displacement_min_m"] == pytest.approx(u.min(), rel=1e-10)
        assert row["sensor.midspan.acceleration_max_m_per_s2"] == pytest.approx(np.abs(a).max(), rel=1e-10)
        assert row["contact_force_max_N"] == pytest.approx(result.contact_force.max(), rel=1e-10)
        static = 12e3 * 9.81
        assert row["unloading_max"] == pytest.approx(1.0 - result.contact_force.min() / static, rel=1e-7)
        bodies = result.vehicle_acceleration[:, [0, 2]]
        assert row["body_acceleration_max_m_per_s2"] == pytest.approx(np.abs(bodies).max(), rel=1e-9)
        assert row["steps"] == len(result.time) - 1


def test_a_single_value_where_a_list_may_stand_is_a_number_of_the_table(study_file, tmp_path):
    """Loads of axles that are drawn: each row tells its own, in N, and its wheels weigh so much."""
    wheels = (
        "{vehicle: sprung-mass, mass: 12 t, stiffness: 1.5 MN/m, damping: 20 kNs/m, count: 2, spacing: 5 m}"
    )
    base = STUDY[: STUDY.index("vary:")].replace(wheels, "{vehicle: axle-loads, loads: 110 kN}")
    text = base + "vary: {train.0.loads: [100 kN, 120 kN]}\npassage: {after: 0.1 s}\n"
    made = Study.load(study_file(text))
    made.run(tmp_path / "out")
    table = pd.read_parquet(tmp_path / "out" / "table").sort_values("id")
    assert table["train.0.loads"].tolist() == [100e3, 120e3]
    assert table["contact_force_max_N"].tolist() == pytest.approx([100e3, 120e3])


def test_a_run_lasts_until_the_last_wheel_has_left(study):
    plan = study.scenario(0).built.plan
    leaves = (10.0 + 5.0) / (100 / 3.6)
    wanted = int(np.ceil((leaves + 0.1) / 0.004))  # 160, in steps of 16
    assert wanted <= plan.settings.steps < wanted * 1.125 and plan.settings.steps % 16 == 0


def test_full_disks_at_random_moments(study_file, tmp_path, monkeypatch, small_parts):
    study = Study.load(study_file(WITH_HISTORIES.replace("step: 40", "step: 100")))
    study.run(tmp_path / "reference")
    chosen = random.Random(5)
    write = files.write_whole
    for attempt in range(3):
        folder = tmp_path / f"out{attempt}"
        resume = False
        for _ in range(2):
            room = chosen.randrange(1, 16)

            def full(path, content, left=[room]):  # noqa: B006
                left[0] -= 1
                if left[0] >= 0:
                    return write(path, content)
                partial = path.with_name(f"{files.PARTIAL}x{path.suffix}")
                if chosen.random() < 0.5:  # as a process that is killed while it writes
                    partial.write_bytes(content[: len(content) // 2])
                raise OSError(errno.ENOSPC, "No space left on device")

            monkeypatch.setattr(store, "write_whole", full)
            try:
                study.run(folder, resume=resume)
            except OSError as error:
                assert error.errno == errno.ENOSPC
            except InputError as error:  # no room for the first files: nothing stays
                assert "No space left" in str(error) and not (folder / "store.json").exists()
            monkeypatch.setattr(store, "write_whole", write)
            resume = (folder / "store.json").exists()
        outcome = study.run(folder, resume=resume)
        assert outcome.missing == 0
        require_equal(study, folder, tmp_path / "reference")


def killed_when(process, folder, done, which):
    """Kill a run or one of its workers a moment after so many parts of the table are written."""
    until = time.monotonic() + 100.0
    while len(list((folder / "table").glob("part-*.parquet"))) < done and process.poll() is None:
        assert time.monotonic() < until
        time.sleep(0.002)
    time.sleep(random.Random(done).uniform(0.0, 0.05))
    if which == "run":
        process.kill()
        process.wait(30)
        return
    children = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True, check=False)
    for child in children.stdout.split()[-1:]:
        os.kill(int(child), signal.SIGKILL)
    process.wait(120)


@pytest.mark.slow
def test_kills_at_random_moments(study, path, tmp_path, start):
    study.run(tmp_path / "reference")
    chosen = random.Random(11)
    folder = tmp_path / "out"
    process = start(path, "-o", folder, "--workers", 2)
    first = chosen.randrange(1, 5)
    killed_when(process, folder, first, "run")
    process = start(path, "-o", folder, "--workers", 2, "--resume")
    killed_when(process, folder, first + chosen.randrange(2, 5), "worker")
    assert study.run(folder, resume=True).missing == 0
    require_equal(study, folder, tmp_path / "reference")


def test_a_kill_during_compaction_is_mended(study, tmp_path, monkeypatch, small_parts):
    study.run(tmp_path / "reference")

    def killed(self):
        raise KeyboardInterrupt

    monkeypatch.setattr(store.Store, "compact", killed)
    with pytest.raises(KeyboardInterrupt):
        study.run(tmp_path / "out")
    monkeypatch.undo()
    table, folder = tmp_path / "out" / "table", tmp_path / "out"
    parts = len(list(table.glob("*.parquet")))
    assert parts == 12
    # as it is between the two moves: the old table is away, the new one complete
    table.rename(folder / "table.old")
    new = folder / "table.new"
    new.mkdir()
    for part in (folder / "table.old").glob("*.parquet"):
        (new / part.name).write_bytes(part.read_bytes())
    outcome = study.run(folder, resume=True)
    assert outcome.computed == 0
    assert [p.name for p in table.glob("*.parquet")] == ["scenarios.parquet"]
    require_equal(study, folder, tmp_path / "reference")


def test_a_part_that_cannot_be_read_is_done_again(study, tmp_path, small_parts, monkeypatch):
    study.run(tmp_path / "reference")
    monkeypatch.setattr(store.Store, "compact", lambda self: None)
    study.run(tmp_path / "out")
    monkeypatch.undo()
    part = sorted((tmp_path / "out" / "table").glob("*.parquet"))[3]
    part.write_bytes(part.read_bytes()[:200])
    outcome = study.run(tmp_path / "out", resume=True)
    assert outcome.computed == 2
    require_equal(study, tmp_path / "out", tmp_path / "reference")


def test_two_runs_do_not_share_a_store(study, tmp_path):
    folder = tmp_path / "out"
    folder.mkdir()
    with files.locked(folder), pytest.raises(InputError, match=rf"is in use by process {os.getpid()} on "):
        study.run(folder)
    assert not (folder / "store.json").exists()


def test_what_a_store_is_of_is_written_again_where_it_is_gone(study, tmp_path):
    study.run(tmp_path / "out")
    file = tmp_path / "out" / "study.yaml"
    text = file.read_text()
    file.unlink()
    assert study.run(tmp_path / "out", resume=True).failed == 0
    assert file.read_text() == text


def test_a_store_is_of_one_study(study, study_file, tmp_path):
    study.run(tmp_path / "out")
    with pytest.raises(InputError, match=r"holds a study already\. Use --resume"):
        study.run(tmp_path / "out")
    other = Study.load(study_file(WITH_HISTORIES.replace("0.9, 1.1", "0.9, 1.2"), "other.yaml"))
    with pytest.raises(InputError, match=r"holds another study: its study\.yaml or base\.yaml, or a file"):
        other.run(tmp_path / "out", resume=True)
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "notes.txt").write_text("mine")
    with pytest.raises(InputError, match="is not empty, and holds no study"):
        study.run(tmp_path / "full")
    with pytest.raises(InputError, match=r"holds no study\. Run axlespan sweep"):
        study.table(tmp_path / "full")


def test_a_folder_that_cannot_be_written_leaves_nothing(study, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be made: Not a directory"):
        study.run(tmp_path / "file" / "out")
    with pytest.raises(InputError, match="is a file, not a folder"):
        study.run(tmp_path / "file")


def test_a_failed_scenario_is_a_row_with_its_reason(study_file, tmp_path):
    text = STUDY.replace("{factor: [0.9, 1.1]}", "[0.1 m^4]").replace(
        "  crossing.speed: {from: 100 km/h, to: 300 km/h, step: 40 km/h}\n",
        "  crossing.speed: [100 km/h]\n  analysis.method: [direct, iterative]\n"
        "  analysis.max_iterations: [2]\n",
    )
    with pytest.raises(InputError, match="is only for method: iterative"):
        Study.load(study_file(text))
    study = Study.load(
        study_file(text.replace("[direct, iterative]", "[iterative]").replace("[2]", "[2, 200]"))
    )
    outcome = study.run(tmp_path / "out")
    table = study.table()
    assert outcome.failed == 2 and outcome.missing == 0
    assert table["outcome"].tolist() == ["failed", "failed", "completed", "completed"]
    assert all("converge" in reason for reason in table["reason"][:2])
    assert table["line_acceleration_max_m_per_s2"].isna().tolist() == [True, True, False, False]
    assert study.run(tmp_path / "out", resume=True).computed == 0


def test_a_scenario_that_makes_no_case_is_refused_or_a_row(study_file, tmp_path):
    text = STUDY.replace("{factor: [0.9, 1.1]}", "[0.1 m^4]").replace("step: 40", "step: 200")
    with pytest.raises(
        InputError, match=r"study.yaml:15:27: vary.analysis.beta = 0.01: must be at least 0.3"
    ):
        Study.load(study_file(text.replace("passage", "  analysis.beta: [0.3025, 0.01]\npassage"))).run(
            tmp_path / "o"
        )
    random = (
        "  analysis.beta: {distribution: uniform, from: 0.2, to: 0.4}\nsampling: {method: sobol, count: 4}\n"
    )
    study = Study.load(study_file(text.replace("passage", f"{random}passage")))
    study.run(tmp_path / "out")
    table = study.table()
    valid = table["analysis.beta"] >= 0.3025
    assert 0 < valid.sum() < len(table)
    assert (table["outcome"] == np.where(valid, "completed", "invalid")).all()
    assert table["reason"][~valid].str.contains("conditionally stable").all()
