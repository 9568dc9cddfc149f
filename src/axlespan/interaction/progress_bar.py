"""A progress bar for scripts and notebooks."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def reporting(
    progress: Callable[[int], None] | bool | None, steps: int
) -> Iterator[Callable[[int], None] | None]:
    """Yield what a run reports its steps to: the caller's function, a bar for ``True``, or nothing."""
    if progress is None or callable(progress):
        yield progress
        return
    if not progress:
        yield None
        return
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        BarColumn(),
        TextColumn("{task.completed:.0f}/{task.total:.0f} steps", markup=False),
        TimeRemainingColumn(),
    )
    with Progress(*columns) as bar:
        task = bar.add_task("", total=steps)
        yield lambda done: bar.update(task, completed=done)
