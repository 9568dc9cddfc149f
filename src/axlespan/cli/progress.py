"""A progress bar where there is a terminal; nothing elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

_TITLE = 32  # characters of a case's title beside the bar


@dataclass
class Steps:
    """Counts the steps of a run, and shows them where somebody watches."""

    total: int
    done: int = 0
    show: Callable[[int], None] = field(default=lambda done: None, repr=False)

    def __call__(self, done: int) -> None:
        """Take note of the number of steps done."""
        self.done = done
        self.show(done)


@contextmanager
def progress(steps: Steps, title: str) -> Iterator[None]:
    """Show the steps on a terminal: a bar, their number, the rate and the time left."""
    if sys.stderr is None or not sys.stderr.isatty():
        yield
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}", markup=False),  # a title may have brackets
        BarColumn(bar_width=24),
        MofNCompleteColumn(),
        TextColumn("steps"),
        TextColumn("{task.fields[rate]}"),
        TimeRemainingColumn(),
        TextColumn("left"),
    )
    short = title if len(title) <= _TITLE else title[: _TITLE - 1] + "…"
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(short, total=steps.total, rate="")

        def show(done: int) -> None:
            speed = bar.tasks[0].speed
            bar.update(task, completed=done, rate=f"{speed:,.0f}/s" if speed else "")

        steps.show = show
        yield
