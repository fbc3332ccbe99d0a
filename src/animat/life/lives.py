"""Many lives at once: simulated on all cores, a chunk at a time, as a table with a row each."""

from __future__ import annotations

import os
import warnings
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
from numpy.typing import NDArray

from animat.files.arguments import MOST_63, MOST_THREADS, callback, instance, sequence, whole
from animat.files.tables import to_pandas, write_csv
from animat.life.batch import Batch, Progress
from animat.life.life import check
from animat.life.scenario import LifeError, Setting, bring_together
from animat.life.summary import NAMES, summary, without_failed
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.numerics.threads import KernelThreads
from animat.robot.khepera import Khepera
from animat.world.world import World

if TYPE_CHECKING:
    import pandas as pd

    from animat.statistics.estimates import Estimate
    from animat.statistics.survival import DeathCount

CHUNK, LARGEST_CHUNK = 32, 8192
"""Lives that a thread takes at a time: at least, and at most where lives are short."""

STEPS_OF_A_CHUNK = 2_000_000
"""What a chunk of short lives comes to, so that the table of it costs little beside them."""

MOST_LIVES = 10**9
"""Lives that may be asked for at once; in a study, by each case."""

TURNS = 8
"""How many times a thread takes a chunk at least, of lives enough."""


@dataclass(frozen=True)
class Lives:
    """Lives of one setting and seed: `table` has a row for each (columns in docs/tables.md).

    A life that failed has its name and the reason in the column `error`, and null elsewhere. No
    statistic counts it, and each warns of that.
    """

    table: pa.Table

    @property
    def failed(self) -> int:
        """How many of them failed."""
        return self.table.num_rows - self.table["error"].null_count

    def to_pandas(self) -> pd.DataFrame:
        """Return the table as one of pandas; needs pandas (`pip install animat[pandas]`).

        Raises SettingsError without it.
        """
        return to_pandas(self.table)

    def to_csv(self, path: str | Path) -> None:
        """Write the table as a CSV file, replacing what was there. Raises SettingsError."""
        write_csv(self.table, path)

    def mean_lifespan(self) -> Estimate:
        """Return the mean lifespan in steps, restricted at the cap, and its 95 % interval.

        Raises LifeError if every life failed.
        """
        from animat.statistics.survival import mean_lifespan

        return mean_lifespan(self._whole())

    def causes(self) -> list[DeathCount]:
        """Return how the lives ended, the most frequent way first.

        Raises LifeError if every life failed.
        """
        from animat.statistics.survival import causes

        return causes(self._whole())

    def _whole(self) -> pa.Table:
        """Return the lives that did not fail; say so if that is not all."""
        if not self.failed:
            return self.table
        if self.failed == self.table.num_rows:
            raise LifeError(f"all {self.failed} lives failed; the column error says why")
        _warn(self, "they are left out of account")
        return self.table.filter(pc.field("error").is_null())


def _warn(lives: Lives, what: str) -> None:
    """Warn of lives that failed, with the first of them, if any did."""
    if lives.failed:
        first = lives.table.filter(pc.field("error").is_valid()).slice(0, 1).to_pylist()[0]
        warnings.warn(
            f"{lives.failed} of {lives.table.num_rows} lives failed; {what}; such as life"
            f" {first['life']}: {first['error']}",
            RuntimeWarning,
            stacklevel=3,
        )


def live_many(
    mind: Mind,
    world: World,
    *,
    lives: int = 1_000,
    robot: Khepera | None = None,
    seed: int = 0,
    first: int = 0,
    steps: int = 300_000,
    networks: Sequence[Networks] | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
    check_functions: bool = False,
) -> Lives:
    """Live the lives `first` to `first + lives - 1` of a seed, on all cores, and return them.

    `networks` gives life i the networks i modulo their number, in place of the mind's own. Lives
    with the same seed and index share their starting pose and random numbers, whatever the mind.
    A life fails where a custom function raises or gives what no life can go on with; the others go
    on, a RuntimeWarning tells of it, and the column `error` says why. With `check_functions`,
    custom functions check every index they use. Raises LifeError for what cannot be lived.
    """
    callback("progress", progress, LifeError)
    if networks is not None:
        networks = sequence("networks", networks, Networks, LifeError)
        if not networks:
            raise LifeError("networks is empty; give at least one")
        if any(one.weights.shape != networks[0].weights.shape for one in networks):
            raise LifeError("networks differ in their form; all lives have the same")
        mind = Mind(**{**dict(instance("mind", mind, Mind)), "networks": networks[0]})
    setting = bring_together(mind, world, robot, check_functions=check_functions)
    weights = None if networks is None else np.array([one.weights for one in networks])
    chunks = live_chunks(setting, seed, first, lives, steps, weights, threads, progress)
    lived = Lives(pa.concat_tables(chunks).unify_dictionaries())
    _warn(lived, "the others are kept")
    return lived


def live_chunks(
    setting: Setting,
    seed: int,
    first: int,
    lives: int,
    steps: int,
    weights: NDArray[np.float64] | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Iterator[pa.Table]:
    """Yield chunk after chunk of lives, in the order of their index.

    Only as many chunks as there are threads are held at a time.
    """
    seed, _, steps = check(seed, 0, steps)
    first = whole("first", first, 0, MOST_63, LifeError)
    lives = whole("lives", lives, 1, min(MOST_LIVES, MOST_63 + 1 - first), LifeError)
    if threads is None:
        threads = os.cpu_count() or 1
    threads = whole("threads", threads, 1, MOST_THREADS, LifeError)
    setting.begin(seed, np.array([first], np.uint64))  # a world without room is told of at once
    stop = Event()
    batch = Batch(setting, seed, steps, stop=stop, progress=progress)
    size = chunk_size(steps, lives, threads)

    def chunk(start: int) -> pa.Table:
        indices = np.arange(start, min(start + size, first + lives), dtype=np.uint64)
        own = None if weights is None else weights[indices % np.uint64(len(weights))]
        result = batch.run(indices, own)
        columns = summary(setting, seed, indices, result.states)
        return pa.table(without_failed(columns, result.errors, NAMES))

    starts = iter(range(first, first + lives, size))
    under_way: deque[Future[pa.Table]] = deque()
    with KernelThreads(threads) as pool:
        try:
            while True:
                while len(under_way) < 2 * threads and (start := next(starts, None)) is not None:
                    under_way.append(pool.submit(chunk, start))
                if not under_way:
                    return
                yield under_way.popleft().result()
        finally:
            stop.set()


def chunk_size(steps: int, lives: int, threads: int) -> int:
    """Return how many lives of up to `steps` steps a thread takes at a time.

    Few enough that every thread takes several times, and none waits long for the last.
    """
    share = -(-lives // (TURNS * threads))
    return max(min(STEPS_OF_A_CHUNK // steps, LARGEST_CHUNK, share), CHUNK)
