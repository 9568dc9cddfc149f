"""Where tasks are computed: in this process, in local processes, or on Dask; all behind one small seam."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from multiprocessing.connection import wait as wait_for
from typing import Final, Protocol

from axlespan.study.sweep.workshop import Done, Task, run_task

# Tasks on their way for each worker: one that is computed, one that waits.
AHEAD: Final = 2
# So many times a task is tried again whose worker died.
TRIES: Final = 3

_THREADS: Final = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")


@dataclass(frozen=True, eq=False)
class Lost:
    """A task that was not computed, through no fault of its numbers: it is missing in the store."""

    number: int
    ids: tuple[int, ...]
    reason: str


class Executor(Protocol):
    """Computes tasks in any order; takes them from the iterable as it needs them."""

    @property
    def workers(self) -> int:
        """Tasks that are computed at a time."""
        ...

    def run(self, tasks: Iterable[Task]) -> Iterator[Done | Lost]:
        """What came of each task; closing the iterator stops the rest."""
        ...


class InProcess:
    """One task after the other, here."""

    workers = 1

    def run(self, tasks: Iterable[Task]) -> Iterator[Done | Lost]:
        """What came of each task."""
        return (run_task(task) for task in tasks)


class Processes:
    """Processes of this machine, each with one BLAS thread; one that dies is replaced."""

    def __init__(self, workers: int) -> None:
        self.workers = workers

    def run(self, tasks: Iterable[Task]) -> Iterator[Done | Lost]:
        """What came of each task; closing the iterator ends the processes."""
        known = {name: os.environ.get(name) for name in _THREADS}
        os.environ.update(dict.fromkeys(_THREADS, "1"))  # children read them when they start
        crew = _Crew(self.workers, iter(tasks))
        try:
            yield from crew.work()
        finally:
            crew.close()
            for name, value in known.items():
                if value is None:
                    os.environ.pop(name, None)
                else:
                    os.environ[name] = value


class _Crew:
    """A pool of processes, and the tasks that it has taken."""

    def __init__(self, workers: int, tasks: Iterator[Task]) -> None:
        self._workers, self._tasks = workers, tasks
        self._pool = self._new_pool()
        self._running: dict[Future[Done], tuple[Task, int]] = {}
        self._suspects: list[tuple[Task, int]] = []  # were on their way when a process died

    def _new_pool(self) -> ProcessPoolExecutor:
        context = multiprocessing.get_context("spawn")  # threads and locks of libraries do not survive a fork
        return ProcessPoolExecutor(self._workers, mp_context=context, initializer=_begin_worker)

    def work(self) -> Iterator[Done | Lost]:
        """Compute all tasks."""
        while True:
            self._fill()
            if not self._running:
                return
            finished, _ = wait(self._running, return_when=FIRST_COMPLETED)
            broken = False
            for future in finished:
                task, tries = self._running.pop(future)
                try:
                    yield future.result()
                except BrokenProcessPool:
                    broken = True
                    self._suspects.append((task, tries + 1))
            if broken:
                yield from self._replace()

    def _fill(self) -> None:
        """Give the pool enough to do; after a death one task at a time, to find the one that kills."""
        if self._suspects:
            if not self._running:
                self._submit(*self._suspects.pop(0))
            return
        while len(self._running) < AHEAD * self._workers:
            task = next(self._tasks, None)
            if task is None:
                return
            self._submit(task, 0)

    def _submit(self, task: Task, tries: int) -> None:
        try:
            self._running[self._pool.submit(run_task, task)] = (task, tries)
        except BrokenProcessPool:
            self._pool = self._new_pool()
            self._running[self._pool.submit(run_task, task)] = (task, tries)

    def _replace(self) -> Iterator[Lost]:
        """A new pool; what was on its way is tried again, and given up after some tries."""
        self._suspects += [(task, tries + 1) for task, tries in self._running.values()]
        self._running.clear()
        self.close()
        self._pool = self._new_pool()
        lost = [task for task, tries in self._suspects if tries > TRIES]
        self._suspects = [(task, tries) for task, tries in self._suspects if tries <= TRIES]
        for task in lost:
            yield Lost(task.number, task.ids, f"its process died {TRIES + 1} times: is there enough memory?")

    def close(self) -> None:
        """End the processes, whatever they do: they write nothing."""
        processes = list((getattr(self._pool, "_processes", None) or {}).values())
        self._pool.shutdown(wait=False, cancel_futures=True)
        for process in processes:
            process.kill()
        for process in processes:
            process.join()


def _begin_worker() -> None:
    """Leave interrupts to the parent, and end with it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    parent = multiprocessing.parent_process()
    if parent is None:
        return

    def follow() -> None:
        wait_for([parent.sentinel])
        os._exit(1)

    threading.Thread(target=follow, daemon=True).start()
