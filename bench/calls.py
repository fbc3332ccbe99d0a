"""What one call of a kernel costs, of whoever advances a life step by step.

    python bench/calls.py [--repeat 7] [--json FILE] [--markdown]

Timed is a call that advances a life by no step, so that nothing but the call is in it. Printed is
the least of the repeats.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from functools import partial

import numpy as np

import animat
import figures
from animat.life import kernels
from animat.life.batch import advance
from animat.life.scenario import bring_together
from animat.numerics.layout import raw
from figures import Table, Target

MOST = 5.0
"""Microseconds."""


def of_kernels(repeat: int, tiny: bool) -> Table:
    """Time a call of the kernel, and of the function that calls it for a setting."""
    setting = bring_together(animat.Mind(death=False), animat.World.abundant())
    lives = np.zeros(1, np.uint64)
    states, present = setting.begin(1, lives)
    kernel = kernels.advance.of(setting.counts, setting.functions)
    given = raw(states), present, lives, *setting.constants, 1, 0
    calls: dict[str, Callable[[], None]] = {
        "the kernel": lambda: kernel(*given),
        "advance": lambda: advance(setting, 1, lives, states, present, 0),
    }
    count = 10 if tiny else 20_000
    rows = []
    for name, call in calls.items():
        taken = []
        for _ in range(repeat):
            start = time.process_time()
            for _ in range(count):
                call()
            taken.append(1e6 * (time.process_time() - start) / count)
        least = min(taken)
        rows.append({"call": name, "us": least, "target": Target(least, MOST, at_least=False)})
    return Table("A call", rows, f"{count:,} calls in a row, {repeat} times.")


def tables(repeat: int, tiny: bool) -> Iterator[Callable[[], Table]]:
    """Yield what makes the table."""
    yield partial(of_kernels, repeat, tiny)


if __name__ == "__main__":
    figures.run(__doc__, tables, repeat=7)
