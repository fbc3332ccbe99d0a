"""Telling how far long work is: bars on a terminal, plain lines elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Lock
from typing import Protocol

LINE_EVERY = 5.0
"""Seconds between two lines where the output is no terminal."""


class Telling(Protocol):
    """Takes note that `done` more of `total` are done of a task."""

    def __call__(self, task: str, done: int, total: int) -> None:
        """Take note."""


@contextmanager
def telling() -> Iterator[Telling]:
    """Yield what long work reports to; threads may call it at once."""
    if not sys.stderr.isatty():
        yield _plain_lines()
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    bars = Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=Console(stderr=True),
    )
    tasks = {}
    lock = Lock()

    def tell(task: str, done: int, total: int) -> None:
        with lock:
            if task not in tasks:
                tasks[task] = bars.add_task(task, total=total)
        bars.advance(tasks[task], done)

    with bars:
        yield tell


def _plain_lines() -> Telling:
    counts: dict[str, int] = {}
    started: dict[str, float] = {}
    last: dict[str, float] = {}
    lock = Lock()

    def tell(task: str, done: int, total: int) -> None:
        with lock:
            now = time.monotonic()
            start = started.setdefault(task, now)
            counts[task] = count = counts.get(task, 0) + done
            if count < total and now - last.setdefault(task, start) < LINE_EVERY:
                return
            last[task] = now
            left = (now - start) * (total - count) / max(count, 1)
            told = f", {left:.0f} s left" if count < total else f", {now - start:.0f} s"
            print(f"{task}: {count:,} of {total:,}{told}", file=sys.stderr, flush=True)

    return tell
