"""Disks that are full or cannot be written to, real ones: what is in the store stays, and a later run goes on."""

import errno
import os
import subprocess

import pytest
from tests.study.sweep.conftest import STUDY, numbers_differ

from axlespan.errors import InputError
from axlespan.study.sweep import Study, store

resource = pytest.importorskip("resource")  # Windows has none

WITH_HISTORIES = STUDY.replace("step: 40", "step: 100").replace(
    "passage:", "histories: {variables: [sensor_acceleration, contact_force]}\npassage:"
)


@pytest.fixture
def study(study_file, monkeypatch):
    monkeypatch.setattr(store, "_SECONDS", 0.0)
    monkeypatch.setattr("axlespan.study.sweep.study.lanes_for", lambda scenarios, workers, most: 2)
    return Study.load(study_file(WITH_HISTORIES))


class Disk:
    """A small file system in memory."""

    def __init__(self, folder):
        self.folder = folder

    def again(self, options):
        subprocess.run(["mount", "-o", f"remount,{options}", str(self.folder)], check=True)


@pytest.fixture
def disk(tmp_path):
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=16m", "tmpfs", str(folder)]
    try:
        subprocess.run(mount, check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("nobody but root may mount")
    yield Disk(folder)
    subprocess.run(["umount", "-l", str(folder)], check=True)


def require_whole(study, folder, reference):
    assert numbers_differ(study.table(reference), study.table(folder)) < 1e-10
    assert not [path for path in folder.rglob("*") if path.name.startswith(".partial")]
    for kind in ("histories",):
        named = study.table(folder)[kind]
        assert set(named) == {path.name for path in (folder / kind).iterdir()}


def test_a_small_disk(study, disk, tmp_path):
    study.run(tmp_path / "reference")
    for kilobytes in (4, 20, 60, 120):
        folder = disk.folder / f"out{kilobytes}"
        used = sum(path.stat().st_blocks * 512 for path in disk.folder.rglob("*"))
        disk.again(f"size={used // 1024 + kilobytes}k")
        try:
            outcome = study.run(folder)
            pytest.fail(f"{outcome.computed} scenarios fit into {kilobytes} kB")
        except OSError as error:
            assert error.errno == errno.ENOSPC
        except InputError as error:
            assert "No space left on device" in str(error)
        disk.again("size=16m")
        begun = (folder / "store.json").exists()
        assert study.run(folder, resume=begun).missing == 0
        require_whole(study, folder, tmp_path / "reference")


def test_a_disk_that_is_read_only(study, disk, monkeypatch):
    folder = disk.folder / "out"
    disk.again("ro")
    with pytest.raises(InputError, match="cannot be made: Read-only file system"):
        study.run(folder)
    disk.again("rw")
    monkeypatch.setattr(store.Store, "compact", lambda self: None)
    study.run(folder)
    (folder / "table" / "half.parquet").write_bytes(b"")
    disk.again("ro")
    with pytest.raises(InputError, match="cannot be written to: Read-only file system"):
        study.run(folder, resume=True)
    assert len(list((folder / "table").glob("part-*.parquet"))) == len(study.scenarios) // 2


@pytest.mark.skipif(os.geteuid() == 0, reason="root writes everywhere")
def test_a_folder_without_the_right_to_write(study, tmp_path):
    folder = tmp_path / "locked"
    folder.mkdir()
    folder.chmod(0o555)
    try:
        with pytest.raises(InputError, match="cannot be made: Permission denied"):
            study.run(folder / "out")
        with pytest.raises(InputError, match="cannot be written to: Permission denied"):
            study.run(folder)
    finally:
        folder.chmod(0o755)
    assert list(folder.iterdir()) == []


def test_files_that_may_not_grow(study, tmp_path, start):
    study.run(tmp_path / "reference")

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (9_000, 9_000))

    folder = tmp_path / "out"
    process = start(study.spec.source.file, "-o", folder, preexec_fn=limit)
    _, errors = process.communicate(timeout=100)
    assert process.returncode == 3, errors
    assert "the store cannot be written: File too large; " in errors
    assert "--resume computes the others" in errors
    assert study.run(folder, resume=True).missing == 0
    require_whole(study, folder, tmp_path / "reference")
