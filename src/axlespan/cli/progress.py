"""A progress bar where there is a terminal; nothing elsewhere."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from axlespan.compiled import when_compiling

# Characters: of the bar, of a title below which it says nothing, and of all numbers but those of the steps.
_BAR, _FEWEST, _NUMBERS = 24, 8, 38


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
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    console = Console(stderr=True)
    room = console.width - _NUMBERS - 2 * len(str(steps.total))  # for the title and the bar
    short = title if len(title) <= room - _BAR - 1 else title[: max(room - _BAR - 2, 0)] + "…"
    columns = (
        *([TextColumn("{task.description}", markup=False)] if len(short) > _FEWEST else []),
        *([BarColumn(bar_width=_BAR)] if room >= _BAR else []),
        TextColumn("{task.completed:.0f}/{task.total:.0f} steps", markup=False),
        TextColumn("{task.fields[rate]}", markup=False),
        TimeRemainingColumn(),
        TextColumn("left"),
    )
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task(short, total=steps.total, rate="")

        def show(done: int) -> None:
            speed = bar.tasks[0].speed
            bar.update(task, completed=done, rate=f"{speed:,.0f}/s" if speed else "")

        def compiling(begins: bool) -> None:
            bar.update(task, rate="compiling, once" if begins else "")

        steps.show = show
        with when_compiling(compiling):
            yield
