"""Telling how far long work is: bars on a terminal or in a notebook, plain lines elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from threading import Lock
from typing import Protocol

ROOM = 62
"""Characters of a line of a terminal that the name, the bar, numbers and the time so far take."""

LINE_EVERY = 5.0
"""Seconds between two lines where the output is no terminal."""


class Telling(Protocol):
    """Takes note that `done` more of `total` are done of a task.

    What the first call brings was done before, and is no part of the speed. `note` is told beside
    the numbers, in the place of the time that is left.
    """

    def __call__(self, task: str, done: int, total: int, note: str = "") -> None:
        """Take note."""


@contextmanager
def telling() -> Iterator[Telling]:
    """Yield what long work reports to; threads may call it at once."""
    notebook = _in_notebook()
    if not notebook and not sys.stderr.isatty():
        yield _plain_lines()
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        Task,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )
    from rich.table import Column
    from rich.text import Text

    class Left(TimeRemainingColumn):
        def render(self, task: Task) -> Text:
            note = task.fields["note"]
            return Text(note) if note else Text("left ") + super().render(task)

    console = Console(stderr=True, force_jupyter=notebook)
    bars = Progress(
        TextColumn("{task.description}"),
        BarColumn(bar_width=16),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        Left(table_column=Column(no_wrap=True, max_width=max(16, console.width - ROOM))),
        console=console,
    )
    tasks = {}
    lock = Lock()

    def tell(task: str, done: int, total: int, note: str = "") -> None:
        with lock:
            if task not in tasks:
                tasks[task] = bars.add_task(task, total=total, completed=done, note=note)
                return
        bars.update(tasks[task], advance=done, note=note)

    with bars:
        yield tell


def _in_notebook() -> bool:
    """Tell whether this is a notebook in which bars can be drawn: rich needs ipywidgets there."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return hasattr(shell, "kernel") and find_spec("ipywidgets") is not None


def _plain_lines() -> Telling:
    counts: dict[str, int] = {}
    before: dict[str, int] = {}
    started: dict[str, float] = {}
    last: dict[str, float] = {}
    lock = Lock()

    def tell(task: str, done: int, total: int, note: str = "") -> None:
        with lock:
            now = time.monotonic()
            start = started.setdefault(task, now)
            before.setdefault(task, done)
            counts[task] = count = counts.get(task, 0) + done
            if count < total and now - last.setdefault(task, start) < LINE_EVERY:
                return
            last[task] = now
            told = note
            if count >= total:
                told = in_words(now - start)
            elif not note and count > before[task]:
                speed = (count - before[task]) / (now - start)
                told = f"about {in_words((total - count) / speed)} left"
            line = f"{task}: {count:,} of {total:,}" + (f", {told}" if told else "")
            print(line, file=sys.stderr, flush=True)

    return tell


def in_words(seconds: float) -> str:
    """Return a duration as people say it, such as "3 min" or "2 h 5 min"."""
    if seconds < 99.5:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    if minutes < 100:
        return f"{minutes} min"
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes} min" if hours < 48 else f"{round(hours / 24)} days"
