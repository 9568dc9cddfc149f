"""Where tasks are computed: in this process, in local processes, or on Dask; all behind one small seam."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from functools import partial
from multiprocessing.connection import wait as wait_for
from typing import Any, Final, Protocol

from axlespan.study.sweep.under_way import News, Tell
from axlespan.study.sweep.workshop import Done, Task, run_task

# Tasks on their way for each worker: one that is computed, one that waits.
AHEAD: Final = 2
# Seconds between two looks at how far tasks are.
_PAUSE: Final = 0.5
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

    def run(self, tasks: Iterable[Task], news: News | None = None) -> Iterator[Done | Lost]:
        """What came of each task; closing the iterator stops the rest. ``news`` hears how far tasks are."""
        ...


class InProcess:
    """One task after the other, here."""

    workers = 1

    def run(self, tasks: Iterable[Task], news: News | None = None) -> Iterator[Done | Lost]:
        """What came of each task."""
        return (run_task(task, None if news is None else partial(news, task.number)) for task in tasks)


class Processes:
    """Processes of this machine, each with one BLAS thread; one that dies is replaced."""

    def __init__(self, workers: int) -> None:
        self.workers = workers

    def run(self, tasks: Iterable[Task], news: News | None = None) -> Iterator[Done | Lost]:
        """What came of each task; closing the iterator ends the processes."""
        known = {name: os.environ.get(name) for name in _THREADS}
        os.environ.update(dict.fromkeys(_THREADS, "1"))  # children read them when they start
        crew = _Crew(self.workers, iter(tasks), news)
        try:
            yield from crew.work()
        finally:
            crew.close()
            for name, value in known.items():
                if value is None:
                    os.environ.pop(name, None)
                else:
                    os.environ[name] = value


@dataclass(frozen=True, eq=False)
class _Sent:
    """A task on its way."""

    task: Task
    tries: int
    place: int  # where its worker writes how far it is


class _Crew:
    """A pool of processes, and the tasks that it has taken."""

    def __init__(self, workers: int, tasks: Iterator[Task], news: News | None = None) -> None:
        self._workers, self._tasks, self._news = workers, tasks, news
        # threads and locks of libraries do not survive a fork
        self._context = multiprocessing.get_context("spawn")
        # How far the tasks on their way are, each in a place of its own: no lock that a process could die with.
        self._places: Any = None if news is None else self._context.RawArray("d", AHEAD * workers)
        self._free = list(range(AHEAD * workers))
        self._pool = self._new_pool()
        self._running: dict[Future[Done], _Sent] = {}
        self._suspects: list[tuple[Task, int]] = []  # were on their way when a process died

    def _new_pool(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(
            self._workers, mp_context=self._context, initializer=_begin_worker, initargs=(self._places,)
        )

    def work(self) -> Iterator[Done | Lost]:
        """Compute all tasks."""
        while True:
            self._fill()
            if not self._running:
                return
            pause = None if self._news is None else _PAUSE
            finished, _ = wait(self._running, timeout=pause, return_when=FIRST_COMPLETED)
            broken = False
            for future in finished:
                sent = self._taken_back(future)
                try:
                    yield future.result()
                except BrokenProcessPool:
                    broken = True
                    self._suspects.append((sent.task, sent.tries + 1))
            self._tell()
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
        place = self._free.pop()
        if self._places is not None:
            self._places[place] = 0.0
        try:
            future = self._pool.submit(_run_in_place, run_task, task, place)
        except BrokenProcessPool:
            self._pool = self._new_pool()
            future = self._pool.submit(_run_in_place, run_task, task, place)
        self._running[future] = _Sent(task, tries, place)

    def _taken_back(self, future: Future[Done]) -> _Sent:
        """A task that is over, or whose process died."""
        sent = self._running.pop(future)
        self._free.append(sent.place)
        return sent

    def _tell(self) -> None:
        """Tell how far the tasks on their way are."""
        if self._news is not None:
            for sent in self._running.values():
                self._news(sent.task.number, float(self._places[sent.place]))

    def _replace(self) -> Iterator[Lost]:
        """A new pool; what was on its way is tried again, and given up after some tries."""
        for sent in [self._taken_back(future) for future in list(self._running)]:
            self._suspects.append((sent.task, sent.tries + 1))
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


# Of this worker: how far all tasks on their way are, shared with the parent.
_PLACES: list[Any] = []


def _run_in_place(run: Callable[[Task, Tell | None], Done], task: Task, place: int) -> Done:
    """Compute a task in a worker, which writes into its place how far it is."""
    places = _PLACES[0] if _PLACES else None
    return run(task, None if places is None else partial(places.__setitem__, place))


def _begin_worker(places: Any) -> None:
    """Leave interrupts to the parent, and end with it."""
    _PLACES[:] = [places]
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    parent = multiprocessing.parent_process()
    if parent is None:
        return

    def follow() -> None:
        wait_for([parent.sentinel])
        os._exit(1)

    threading.Thread(target=follow, daemon=True).start()
