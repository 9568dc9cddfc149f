"""Resuming verifies what it trusts: damaged parts and files of histories are set aside, their scenarios done again."""

import shutil

import h5py
import numpy as np
import pandas as pd
import pytest
from tests.study.sweep.conftest import STUDY, numbers_differ
from tests.study.sweep.test_store import WITH_HISTORIES, require_equal

from axlespan.cli.sweep import Wanted, run_sweep
from axlespan.study.sweep import Study, store

SMALL = WITH_HISTORIES.replace("step: 40", "step: 100")  # 12 scenarios


@pytest.fixture(scope="module")
def complete(tmp_path_factory):
    """A study of 12 scenarios, a complete store of it in parts of 2, and the study file."""
    folder = tmp_path_factory.mktemp("complete")
    path = folder / "study.yaml"
    path.write_text(SMALL)
    study = Study.load(path)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(store, "_SECONDS", 0.0)
        patch.setattr("axlespan.study.sweep.study.lanes_for", lambda scenarios, workers, most: 2)
        patch.setattr(store.Store, "compact", lambda self: None)
        study.run(folder / "out")
    return study, folder / "out", path


@pytest.fixture
def damaged(complete, tmp_path):
    """A copy of the store to damage."""
    shutil.copytree(complete[1], tmp_path / "out")
    return tmp_path / "out"


def parts(folder):
    return sorted((folder / "table").glob("part-*.parquet"))


def shards(folder):
    return sorted((folder / "histories").glob("*.nc"))


def test_an_undisturbed_store_is_left_alone(complete, damaged):
    outcome = complete[0].run(damaged, resume=True)
    assert outcome.computed == 0 and outcome.mended == ()
    require_equal(complete[0], damaged, complete[1])


@pytest.mark.parametrize(
    "damage", ["truncated at the head", "truncated at the end", "empty", "other bytes", "a bit in a page"]
)
def test_parts_that_do_not_read(complete, damaged, damage):
    part = parts(damaged)[3]
    content = bytearray(part.read_bytes())
    if damage == "a bit in a page":
        content[40] ^= 0x10  # the footer is right, and so are all lengths
    wrong = {
        "truncated at the head": content[:200],
        "truncated at the end": content[:-1],
        "empty": b"",
        "other bytes": b"x" * len(content),
    }
    part.write_bytes(wrong.get(damage, content))
    outcome = complete[0].run(damaged, resume=True)
    assert outcome.computed == 2 and outcome.missing == 0
    (said,) = outcome.mended
    assert said.startswith(f"table/{part.name} cannot be read (")
    assert said.endswith("): it is in damaged/ now, and its scenarios are done again")
    assert (damaged / "damaged" / part.name).exists()
    assert len(pd.read_parquet(damaged / "table")) == 12
    require_equal(complete[0], damaged, complete[1])
    assert complete[0].run(damaged, resume=True).mended == ()


@pytest.mark.parametrize("damage", ["missing", "truncated", "empty", "other bytes"])
def test_histories_that_do_not_open(complete, damaged, damage):
    shard = shards(damaged)[2]
    content = shard.read_bytes()
    if damage == "missing":
        shard.unlink()
    else:
        shard.write_bytes({"truncated": content[:-100], "empty": b"", "other bytes": b"x" * 5000}[damage])
    outcome = complete[0].run(damaged, resume=True)
    assert outcome.computed == 2 and outcome.missing == 0
    (said,) = outcome.mended
    words = "is missing" if damage == "missing" else "cannot be read ("
    assert said.startswith(f"histories/{shard.name} {words}")
    assert said.endswith("the scenarios that it held are done again")
    require_equal(complete[0], damaged, complete[1])


def test_histories_without_a_scenario_that_a_row_names(complete, damaged):
    shard = shards(damaged)[1]
    with h5py.File(shard, "r+") as file:
        ids = file["scenario"][:]
        file["scenario"][0] = 999
    outcome = complete[0].run(damaged, resume=True)
    assert outcome.computed == 1
    assert outcome.mended == (
        f"histories/{shard.name} lacks 1 scenario that rows look for in it: done again",
    )
    table = complete[0].table(damaged)
    assert sorted(table.index) == list(range(12)) and ids[0] in table.index
    assert numbers_differ(complete[0].table(complete[1]), table) < 1e-10


def test_only_rows_of_lost_histories_go_from_a_table_in_one_part(complete, damaged):
    complete[0].run(damaged, resume=True)  # compacts
    before = complete[0].table(damaged)
    shard = shards(damaged)[0]
    lost = before.index[before["histories"] == shard.name]
    shard.unlink()
    outcome = complete[0].run(damaged, resume=True)
    assert outcome.computed == len(lost) == 2
    kept = before.index.difference(lost)
    after = complete[0].table(damaged)
    assert np.array_equal(after.loc[kept, "seconds"], before.loc[kept, "seconds"])  # not done again
    require_equal(complete[0], damaged, complete[1])


def test_rows_that_are_there_twice_are_kept_once(complete, damaged):
    shutil.copy(parts(damaged)[0], damaged / "table" / "part-copy.parquet")
    outcome = complete[0].run(damaged, resume=True)
    assert outcome.computed == 0
    (said,) = outcome.mended
    assert said.startswith("table/part-copy.parquet has 2 scenarios that other rows have too")
    require_equal(complete[0], damaged, complete[1])


def test_the_command_says_what_it_found(complete, damaged, capsys):
    part, shard = parts(damaged)[0], shards(damaged)[5]
    part.write_bytes(part.read_bytes()[:100])
    shard.unlink()
    assert run_sweep(complete[2], damaged, Wanted(resume=True, figures=False)) == 0
    said = capsys.readouterr().err
    assert f"{damaged}: table/{part.name} cannot be read" in said
    assert f"{damaged}: histories/{shard.name} is missing: the scenarios that it held are done again" in said


def test_a_store_without_histories(study_file, tmp_path):
    study = Study.load(study_file(STUDY.replace("step: 40", "step: 200")))
    study.run(tmp_path / "out")
    reference = study.table()
    (part,) = (tmp_path / "out" / "table").glob("*.parquet")
    part.write_bytes(part.read_bytes()[: part.stat().st_size // 2])
    outcome = study.run(tmp_path / "out", resume=True)
    assert outcome.computed == outcome.scenarios == 8
    assert numbers_differ(reference, study.table()) < 1e-10
