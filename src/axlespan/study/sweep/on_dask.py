"""Tasks on Dask distributed: a scheduler that somebody has started, or a local cluster."""

from __future__ import annotations

import asyncio
import importlib
import logging
import platform
import secrets
import time
import warnings
from collections.abc import Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from typing import Any, Final

import numpy
import scipy

import axlespan
from axlespan.errors import InputError
from axlespan.study.sweep.executors import AHEAD, Lost
from axlespan.study.sweep.under_way import News
from axlespan.study.sweep.workshop import Done, Task, run_task

PATIENCE: Final = 10.0
"""How long a scheduler is waited for [s], and then workers of it."""

_LOOK: Final = 5.0  # s between two counts of the workers
_PAUSE: Final = 0.1  # s between two looks at what is ready
_NEWS: Final = 1.0  # s between two messages of a worker, which all go through the scheduler

LOCAL: Final = "local"
_EXAMPLE: Final = "tcp://host:8786"


class OnDask:
    """A Dask client and its workers."""

    def __init__(self, client: Any, workers: int) -> None:
        self._client, self.workers = client, workers
        self._looked = time.monotonic()
        self._heard: dict[int, float] = {}  # how far tasks are

    def run(self, tasks: Iterable[Task], news: News | None = None) -> Iterator[Done | Lost]:
        """What came of each task; closing the iterator cancels the rest."""
        supply = iter(tasks)
        running: dict[Any, Task] = {}
        topic = None if news is None else self._listen()
        finished = _engine().as_completed(loop=self._client.loop)

        def give(number: int) -> None:
            for _ in range(number):
                task = next(supply, None)
                if task is None:
                    return
                future = self._client.submit(_run_on_worker, task, topic, pure=False)
                running[future.key] = task
                finished.add(future)

        try:
            give(AHEAD * self.workers)
            while running:
                while news is not None and not finished.has_ready() and not finished.is_empty():
                    time.sleep(_PAUSE)
                    self._tell(news, running.values())
                future = next(finished)
                task = running.pop(future.key)
                yield self._outcome(future, task)
                self._look_around()
                give(AHEAD * self.workers - len(running))
        finally:
            with suppress(Exception):
                self._client.cancel([future for future in finished.futures])
            with suppress(Exception):
                self._client.unsubscribe_topic(topic)

    def _listen(self) -> str:
        """Hear of workers how far their tasks are; the topic of their messages."""
        topic = f"axlespan-{secrets.token_hex(8)}"

        def hear(event: Any) -> None:  # in the client's own thread
            with suppress(Exception):
                number, share = event[1]
                self._heard[int(number)] = float(share)

        self._client.subscribe_topic(topic, hear)
        return topic

    def _tell(self, news: News, running: Iterable[Task]) -> None:
        """Tell how far the tasks on their way are."""
        for task in list(running):
            share = self._heard.get(task.number)
            if share is not None:
                news(task.number, share)

    def _look_around(self) -> None:
        """Count the workers now and then: clusters grow and shrink."""
        now = time.monotonic()
        if now - self._looked > _LOOK:
            self._looked = now
            with suppress(Exception):
                self.workers = max(1, _count(self._client))

    def _outcome(self, future: Any, task: Task) -> Done | Lost:
        try:
            if future.status == "finished":
                done: Done = future.result()
                return done
            error = None if future.status in ("cancelled", "lost") else future.exception()
        except (OSError, CancelledError, asyncio.CancelledError) as lost:  # while the answer came over
            raise ConnectionError("the scheduler is gone") from lost
        if error is None or self._client.status != "running":
            raise ConnectionError("the scheduler is gone")
        return Lost(task.number, task.ids, " ".join(str(error).split())[:300] or type(error).__name__)


def _run_on_worker(task: Task, topic: str | None) -> Done:
    """Compute a task on a worker, which tells the client now and then how far it is."""
    if topic is None:
        return run_task(task)
    worker, last = _engine().get_worker(), time.monotonic()

    def tell(share: float) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= _NEWS:
            last = now
            with suppress(Exception):  # without news the task goes on
                worker.log_event(topic, [task.number, share])

    return run_task(task, tell)


@contextmanager
def on_dask(address: str, workers: int | None = None, patience: float | None = None) -> Iterator[OnDask]:
    """Connect to a scheduler, or start a local cluster of so many workers for ``local``.

    Raises
    ------
    InputError
        If Dask is not installed, the scheduler does not answer, has no workers, or they differ from this program.
    """
    distributed, patience = _engine(), PATIENCE if patience is None else patience
    _silence()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        cluster = None
        if address == LOCAL:
            cluster = distributed.LocalCluster(
                n_workers=workers or 1,
                threads_per_worker=1,
                dashboard_address=None,
                silence_logs=logging.CRITICAL,
            )
        client = _connected(cluster or address, patience)
        try:
            number = _workers(client, address, patience)
            _require_same(client)
            yield OnDask(client, number)
        finally:
            with suppress(Exception):
                client.close(timeout=2)
            if cluster is not None:
                with suppress(Exception):
                    cluster.close(timeout=5)


def _silence() -> None:
    """Keep what Dask logs off the terminal: its loggers have levels of their own, and tell of every lost connection."""
    for name in ["distributed", *logging.root.manager.loggerDict]:
        if name.partition(".")[0] == "distributed":
            logging.getLogger(name).setLevel(logging.CRITICAL)


def _engine() -> Any:
    try:
        return importlib.import_module("distributed")
    except ImportError:
        raise InputError("is not installed", field="dask", fix="pip install 'axlespan[dask]'") from None


def _connected(target: Any, patience: float) -> Any:
    begun = time.monotonic()
    try:
        return _engine().Client(target, timeout=f"{patience}s", set_as_default=False)
    except (OSError, TimeoutError) as error:
        waited = time.monotonic() - begun
        raise InputError(
            f"does not answer; tried for {waited:.0f} s",
            field="scheduler",
            value=str(target),
            fix=f"Start one with: dask scheduler, and give its address, such as {_EXAMPLE}",
        ) from error
    except (ValueError, TypeError, KeyError) as error:
        raise InputError(
            "is no address of a scheduler", field="scheduler", value=str(target), fix=f"Write {_EXAMPLE}"
        ) from error


def _workers(client: Any, address: str, patience: float) -> int:
    """Number of workers, once there is one."""
    with suppress(Exception):
        client.wait_for_workers(1, timeout=patience)
    number = _count(client)
    if not number:
        raise InputError(
            f"has no workers; waited {patience:.0f} s for one",
            field="scheduler",
            value=address,
            fix=f"Start some with: dask worker {address} --nthreads 1",
        )
    return number


def _count(client: Any) -> int:
    try:
        return len(client.scheduler_info(n_workers=-1)["workers"])
    except TypeError:  # older ones tell all without being asked
        return len(client.scheduler_info()["workers"])


def versions() -> dict[str, str]:
    """What numbers depend on."""
    return {
        "axlespan": axlespan.__version__,
        "python": ".".join(platform.python_version_tuple()[:2]),
        "numpy": numpy.__version__,
        "scipy": scipy.__version__,
    }


def _here() -> dict[str, str]:
    return versions()


def _require_same(client: Any) -> None:
    here = _here()
    try:
        there: dict[str, dict[str, str]] = client.run(versions)
    except Exception as error:
        if isinstance(error, OSError) or client.status != "running":
            rule = "is gone: it answered, and then closed the connection"
            raise InputError(
                rule, field="scheduler", fix="Start it again, and look at what it wrote before it ended"
            ) from error
        words = " ".join(str(error).split())[:200] or type(error).__name__
        raise InputError(
            f"cannot use axlespan on a worker: {words}",
            field="scheduler",
            fix="Install axlespan on all workers",
        ) from error
    for worker, found in there.items():
        differing = [
            f"{name} {found.get(name)} (here {here[name]})" for name in here if found.get(name) != here[name]
        ]
        if differing:
            raise InputError(
                f"has a worker with other versions: {worker} has {', '.join(differing)}",
                field="scheduler",
                fix="Install the same versions everywhere",
            )
