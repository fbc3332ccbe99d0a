"""How many lives threads live: steps per second on one thread and on two, and their ratio.

    python bench/threads.py [--repeat 7] [--json FILE] [--markdown]

Through `animat.live_many`, as a user has it, tables of lives included. Threads share the machine
with whatever else runs, so this is by the clock, and only a quiet machine tells the truth. The
last column tells a busy machine from a bad program: how much more time of the processor the same
lives took on two threads.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple

import animat
import figures
from figures import Table, Target

RATIO = 1.9
"""How many times as fast two threads must be at least as one."""


class Spent(NamedTuple):
    """Seconds by the clock and of the processor."""

    clock: float
    processor: float


def live(world: animat.World, lives: int, steps: int, threads: int) -> Spent:
    """Live some lives, and return what it took."""
    mind = animat.Mind(death=False)
    clock, processor = time.perf_counter(), time.process_time()
    animat.live_many(mind, world, lives=lives, steps=steps, threads=threads)
    return Spent(time.perf_counter() - clock, time.process_time() - processor)


def by_threads(repeat: int, lives: int, steps: int) -> Table:
    """Compare one thread and two, in turns."""
    worlds = [
        animat.World.abundant(),
        animat.World.scarce(),
        animat.World.random({}, name="empty"),
    ]
    rows = []
    for world in worlds:
        live(world, 1, 1, 1)  # draws the raster
        measures = {count: partial(live, world, lives, steps, count) for count in (1, 2)}
        taken = figures.in_turns(measures, repeat)
        one, two = (Spent(*map(min, zip(*taken[count], strict=True))) for count in (1, 2))
        ratio = one.clock / two.clock
        rows.append(
            {
                "world": world.name,
                "1 thread, million steps/s": lives * steps / one.clock / 1e6,
                "2 threads, million steps/s": lives * steps / two.clock / 1e6,
                "ratio": ratio,
                "target": Target(ratio, RATIO, at_least=True),
                "processor time, 2 threads / 1": two.processor / one.processor,
            }
        )
    return Table(
        "Two threads",
        rows,
        f"BLIND, michel1996, {lives} lives of {steps:,} steps; the least time by the clock of "
        f"{repeat} turns, on {os.cpu_count()} cores.",
    )


def tables(repeat: int, tiny: bool) -> Iterator[Callable[[], Table]]:
    """Yield what makes the table."""
    yield partial(by_threads, repeat, 64 if tiny else 512, 20 if tiny else 10_000)


if __name__ == "__main__":
    figures.run(__doc__, tables, repeat=7)
