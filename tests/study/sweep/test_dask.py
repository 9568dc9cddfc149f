"""Sweeps on a real Dask scheduler, with workers in processes of their own on this machine."""

import os
import random
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import suppress

import pytest
from tests.study.sweep.conftest import numbers_differ

from axlespan.errors import InputError
from axlespan.study.sweep import Study, on_dask, store

pytest.importorskip("distributed")
pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore")]


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Cluster:
    """A scheduler and its workers, each a process that can be killed."""

    def __init__(self):
        self.port = free_port()
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.processes = []

    def begin(self, *arguments):
        command = [sys.executable, "-m", "distributed.cli." + arguments[0], *arguments[1:]]
        environment = {**os.environ, "OMP_NUM_THREADS": "1"}
        process = subprocess.Popen(
            command,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env=environment,
            start_new_session=True,
        )
        self.processes.append(process)
        return process

    def scheduler(self):
        more = ("--no-dashboard", "--host", "127.0.0.1", "--port", str(self.port), "--idle-timeout", "120 s")
        return self.begin("dask_scheduler", *more)

    def require_open(self):
        """Wait until the scheduler answers."""
        until = time.monotonic() + 20.0
        while time.monotonic() < until:
            with suppress(OSError), socket.create_connection(("127.0.0.1", self.port), 1.0):
                return
            time.sleep(0.05)
        raise AssertionError("the scheduler does not answer")

    def worker(self):
        return self.begin(
            "dask_worker",
            self.address,
            "--nthreads",
            "1",
            "--no-nanny",
            "--no-dashboard",
            "--host",
            "127.0.0.1",
            "--death-timeout",
            "30",
        )

    def end(self):
        for process in self.processes:
            process.kill()
            process.wait(20)


@pytest.fixture
def cluster():
    own = Cluster()
    yield own
    own.end()


@pytest.fixture
def study(study_file):
    return Study.load(study_file())


@pytest.fixture
def small_tasks(monkeypatch):
    monkeypatch.setattr(store, "_SECONDS", 0.0)
    monkeypatch.setattr("axlespan.study.sweep.study.lanes_for", lambda scenarios, workers, most: 2)


def test_the_same_numbers_on_two_workers(study, cluster, tmp_path):
    cluster.scheduler()
    cluster.worker()
    cluster.worker()
    study.run(tmp_path / "here")
    reference = study.table()
    seen = []
    outcome = study.run(
        tmp_path / "there", scheduler=cluster.address, progress=lambda *numbers: seen.append(numbers)
    )
    assert outcome.missing == 0 and seen[-1] == (24, 0, 24)
    assert numbers_differ(reference, study.table()) < 1e-10


def test_a_worker_that_is_killed(study, cluster, tmp_path, small_tasks):
    cluster.scheduler()
    doomed = cluster.worker()
    cluster.worker()
    study.run(tmp_path / "here")
    reference = study.table()

    def kill(done, failed, total):
        if done and doomed.poll() is None:
            doomed.send_signal(signal.SIGKILL)

    outcome = study.run(tmp_path / "there", scheduler=cluster.address, progress=kill)
    assert doomed.poll() is not None
    if outcome.missing:  # what was on that worker when it died
        outcome = study.run(tmp_path / "there", resume=True)
    assert outcome.missing == 0
    assert numbers_differ(reference, study.table()) < 1e-10


def test_schedulers_that_are_killed_at_random_moments(study, tmp_path, small_tasks):
    study.run(tmp_path / "here")
    reference, folder, trial = study.table(), tmp_path / "there", study.trial(timed=False)
    chosen, kept = random.Random(8), 0
    for _ in range(2):
        cluster = Cluster()
        scheduler = cluster.scheduler()
        cluster.worker()
        last = kept + chosen.randrange(2, 7)

        def kill(done, failed, total, scheduler=scheduler, last=last):
            if done >= last and scheduler.poll() is None:
                time.sleep(chosen.uniform(0.0, 0.05))  # somewhere within the tasks that follow
                scheduler.send_signal(signal.SIGKILL)

        try:
            outcome = study.run(
                folder, scheduler=cluster.address, progress=kill, resume=folder.exists(), trial=trial
            )
        finally:
            cluster.end()
        assert "the scheduler is gone" in outcome.reasons
        assert len(study.table()) == 24 - outcome.missing >= last
        kept = 24 - outcome.missing
    assert kept < 24
    assert study.run(folder, resume=True).computed == 24 - kept
    assert numbers_differ(reference, study.table()) < 1e-10


def test_a_scheduler_that_ends_while_it_is_asked(study, cluster, tmp_path, monkeypatch):
    scheduler = cluster.scheduler()
    cluster.worker()
    count = on_dask._count

    def killed(client):
        number = count(client)
        scheduler.send_signal(signal.SIGKILL)
        scheduler.wait(20)
        return number

    monkeypatch.setattr(on_dask, "_count", killed)
    monkeypatch.setattr(on_dask, "PATIENCE", 4.0)
    with pytest.raises(InputError, match=r"scheduler: is gone: it answered, and then closed the connection"):
        study.run(tmp_path / "out", scheduler=cluster.address)
    assert not (tmp_path / "out").exists()


def test_a_scheduler_that_does_not_answer(study, tmp_path, monkeypatch):
    address = f"tcp://127.0.0.1:{free_port()}"
    monkeypatch.setattr(on_dask, "PATIENCE", 1.0)
    with pytest.raises(InputError, match=rf"scheduler = '{address}': does not answer; tried for [12] s"):
        study.run(tmp_path / "out", scheduler=address)
    assert not (tmp_path / "out").exists()
    with pytest.raises(InputError, match="is no address of a scheduler"):
        study.run(tmp_path / "out", scheduler="nonsense://x:1")


def test_a_scheduler_without_workers(study, cluster, tmp_path, monkeypatch):
    cluster.scheduler()
    cluster.require_open()
    monkeypatch.setattr(on_dask, "PATIENCE", 1.5)
    with pytest.raises(
        InputError, match=r"has no workers; waited 2 s for one. Start some with: dask worker tcp://"
    ):
        study.run(tmp_path / "out", scheduler=cluster.address)


def test_workers_with_other_versions(study, cluster, tmp_path, monkeypatch):
    cluster.scheduler()
    cluster.worker()
    there = on_dask.versions()
    monkeypatch.setattr(on_dask, "_here", lambda: {**there, "axlespan": "9.9"})
    with pytest.raises(
        InputError, match=r"has a worker with other versions: tcp://.* has axlespan .* \(here 9.9\)"
    ):
        study.run(tmp_path / "out", scheduler=cluster.address)
    assert not (tmp_path / "out").exists()


def test_a_local_cluster(study, tmp_path):
    small = Study.load(study.spec.source.file)
    assert small.run(tmp_path / "out", workers=2, scheduler="local").missing == 0
    assert threading.active_count() < 50
