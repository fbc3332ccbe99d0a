"""Many lives at once: lived on all cores, a chunk at a time, told as a table with a row each."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from threading import Event
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from animat.arguments import MOST_63, callback, instance, sequence, whole
from animat.life.life import Progress, check
from animat.life.setting import LifeError, Setting, bring_together
from animat.life.slices import live_slice
from animat.life.summary import summary
from animat.mind.mind import Mind
from animat.mind.networks import Networks
from animat.robot.khepera import Khepera
from animat.world.world import World

if TYPE_CHECKING:
    from animat.report.estimates import Estimate
    from animat.report.survival import DeathCount

CHUNK, LARGEST_CHUNK = 32, 8192
"""Lives that a thread takes at a time: at least, and at most where lives are short."""

STEPS_OF_A_CHUNK = 2_000_000
"""What a chunk of short lives comes to, so that the table of it costs little beside them."""

SLICE = 10_000
"""Steps of each life of a chunk between two looks at the outside."""


MOST_LIVES = 10**9
"""Lives that may be asked for at once; in a study, by each case."""

MOST_THREADS = 4_096

TURNS = 8
"""How many times a thread takes a chunk at least, of lives enough."""


@dataclass(frozen=True)
class Lives:
    """Lives of one setting and seed: `table` has a row for each (columns in docs/lives.md)."""

    table: pa.Table

    def mean_lifespan(self) -> Estimate:
        """Return the mean lifespan in steps, restricted at the cap, and its 95 % interval."""
        from animat.report.survival import mean_lifespan

        return mean_lifespan(self.table)

    def causes(self) -> list[DeathCount]:
        """Return how the lives ended, the most frequent way first."""
        from animat.report.survival import causes

        return causes(self.table)


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
) -> Lives:
    """Live the lives `first` to `first + lives - 1` of a seed, on all cores, and return them.

    `networks` gives life i the networks i modulo their number, in place of the mind's own. Lives
    of equal seed and index start in the same pose and meet the same luck, whatever their mind.
    Raises LifeError for what cannot be lived.
    """
    callback("progress", progress, LifeError)
    if networks is not None:
        networks = sequence("networks", networks, Networks, LifeError)
        if not networks:
            raise LifeError("networks is empty; give at least one")
        if any(one.weights.shape != networks[0].weights.shape for one in networks):
            raise LifeError("networks differ in their form; all lives have the same")
        mind = Mind(**{**dict(instance("mind", mind, Mind)), "networks": networks[0]})
    setting = bring_together(mind, world, robot)
    weights = None if networks is None else np.array([one.weights for one in networks])
    chunks = live_chunks(setting, seed, first, lives, steps, weights, threads, progress)
    return Lives(pa.concat_tables(pa.table(chunk) for chunk in chunks).unify_dictionaries())


def live_chunks(
    setting: Setting,
    seed: int,
    first: int,
    lives: int,
    steps: int,
    weights: NDArray[np.float64] | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Iterator[dict[str, pa.Array]]:
    """Yield the columns of chunk after chunk of lives, in the order of their index.

    Only as many chunks as there are threads are held at a time.
    """
    seed, _, steps = check(seed, 0, steps)
    first = whole("first", first, 0, MOST_63, LifeError)
    lives = whole("lives", lives, 1, min(MOST_LIVES, MOST_63 + 1 - first), LifeError)
    if threads is None:
        threads = os.cpu_count() or 1
    threads = whole("threads", threads, 1, MOST_THREADS, LifeError)
    stop = Event()

    size = chunk_size(steps, lives, threads)

    def chunk(start: int) -> dict[str, pa.Array]:
        indices = np.arange(start, min(start + size, first + lives), dtype=np.uint64)
        own = None if weights is None else weights[indices % np.uint64(len(weights))]
        states = live_states(setting, seed, indices, steps, own, stop, progress)
        return summary(setting, seed, indices, states)

    starts = iter(range(first, first + lives, size))
    under_way: deque[Future[dict[str, pa.Array]]] = deque()
    with ThreadPoolExecutor(threads) as pool:
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


def live_states(
    setting: Setting,
    seed: int,
    lives: NDArray[np.uint64],
    steps: int,
    weights: NDArray[np.float64] | None = None,
    stop: Event | None = None,
    progress: Progress | None = None,
) -> NDArray[np.void]:
    """Live the lives of the given indices [L] and return their states [L] at the end."""
    states, present = setting.begin(seed, lives, weights)
    until = 0
    before = 0
    while until < steps and not states["dead"].all() and not (stop and stop.is_set()):
        until = min(until + SLICE, steps)
        live_on(setting, seed, lives, states, present, until)
        if progress:
            now = int(states["step"].sum())
            progress(now - before)
            before = now
    return states


def live_on(
    setting: Setting,
    seed: int,
    lives: NDArray[np.uint64],
    states: NDArray[np.void],
    present: NDArray[np.uint8],
    until: int,
) -> None:
    """Live L lives on, in place, until each has lived `until` steps or is dead."""
    live_slice(
        states,
        present,
        lives,
        setting.mind_parameters,
        setting.robot_parameters,
        setting.raster,
        setting.functions,
        np.uint64(seed),
        until,
    )
