"""A study lived: its parts handed out, what comes back written, and told how far it is.

Parts are handed to an `Executor`, threads of this process unless another is given: the functions
of a part are pure, so they may as well be lived by processes elsewhere. Only this process writes.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from contextlib import contextmanager, suppress
from functools import lru_cache, partial
from pathlib import Path
from threading import Event
from typing import NamedTuple

from animat.numerics.threads import KernelThreads
from animat.progress import Telling
from animat.study.execute.queue import Order
from animat.study.execute.reuse import borrowed
from animat.study.execute.shard import live_part
from animat.study.execute.signals import interruptible
from animat.study.plan.numbering import KINDS, Kind, Part
from animat.study.plan.plan import Plan
from animat.study.plan.shard import Made, classes_needed
from animat.study.store.eta import Pace
from animat.study.store.results import Results
from animat.study.store.store import Store, StoreError, open_store
from animat.study.store.tally import Tally

LOOK_EVERY = 0.2
"""Seconds between two looks for Ctrl-C while nothing is finished."""

AHEAD = 4
"""Parts handed out for each worker, so that none waits while others are written."""

NETWORKS_KEPT = 64
"""Classes of robots whose networks are kept in memory."""

TASKS: dict[Kind, str] = {"teachers": "Robots that learn", "lives": "Lives"}


class Outcome(NamedTuple):
    """How far a study is after a run, and how long that took in seconds."""

    tally: Tally
    seconds: float

    @property
    def complete(self) -> bool:
        """Whether nothing is left to live."""
        return self.tally.complete


class Workers(NamedTuple):
    """Who lives parts, and how many of them at a time. Once `stop` is set, they give up."""

    executor: Executor
    count: int
    stop: Event | None


@contextmanager
def threads(count: int | None = None) -> Iterator[Workers]:
    """Yield threads of this process, as many as there are cores unless told."""
    count = count or os.cpu_count() or 1
    with KernelThreads(count) as executor:
        yield Workers(executor, count, Event())


def run(
    plan: Plan,
    directory: Path,
    workers: Workers,
    tell: Telling,
    lenders: Sequence[Results] = (),
) -> Outcome:
    """Live what a results directory lacks of a study.

    Robots that teach are not lived again that are among the lives of `lenders`. The first Ctrl-C
    ends the run in good order: the parts that are under way are finished.

    Raises:
        SettingsError: the directory holds something else, or cannot be written.
        HeldError: another process holds the directory.
        StoreError: it cannot be written any more.
    """
    with open_store(directory, plan) as store:
        return _Run(store, workers, tell, lenders).to_its_end()


class _Run:
    """One run: what is finished, what is under way."""

    def __init__(
        self, store: Store, workers: Workers, tell: Telling, lenders: Sequence[Results]
    ) -> None:
        self.started = time.monotonic()
        self.lenders = lenders
        self.store, self.plan, self.workers, self.tell = store, store.plan, workers, tell
        self.under_way: dict[Future[Made], Part] = {}
        self.clock: float | None = None
        self.measured = 0
        self.tally = Tally(self.plan.numbering, self.plan.shares)
        for part in self.plan.all_parts():
            if (said := store.finished(part)) is not None:
                self.tally.add(part, said.steps, said.failed)
        self.order = Order(self.plan, self.tally.finished)
        self.networks = lru_cache(NETWORKS_KEPT)(store.networks)

    def to_its_end(self) -> Outcome:
        """Live and write part after part."""
        dead = self.store.dead
        rows = {kind: counts.rows for kind, counts in self.tally.counts.items()}
        self.store.note("start", threads=self.workers.count, dead=dead and str(dead), **rows)
        for kind in KINDS:
            self._tell(kind, rows[kind])
        stop = self.workers.stop or Event()
        try:
            with interruptible(stop) as asked:
                self._live_all(asked)
        except BaseException as error:
            stop.set()
            for future in self.under_way:
                future.cancel()
            with suppress(StoreError):
                self.store.note("end", why=type(error).__name__)
            raise
        outcome = Outcome(self.tally, time.monotonic() - self.started)
        self.store.note("end", why="finished" if outcome.complete else "interrupted")
        return outcome

    def _live_all(self, asked: Event) -> None:
        """Hand out parts and take them back until there are none, or until it is `asked`."""
        while True:
            while not asked.is_set() and len(self.under_way) < AHEAD * self.workers.count:
                part = self.order.next()
                if part is None:
                    break
                if not self._lent(part):
                    self._hand_out(part)
            if asked.is_set():
                for future in [each for each in self.under_way if each.cancel()]:
                    del self.under_way[future]
            if not self.under_way:
                return
            ready, _ = wait(self.under_way, LOOK_EVERY, FIRST_COMPLETED)
            for future in ready:
                self._take(self.under_way.pop(future), future.result())

    def _hand_out(self, part: Part) -> None:
        networks = {place: self.networks(place) for place in classes_needed(self.plan, part)}
        live = live_part
        if self.workers.stop:
            check = self.plan.check_functions
            live = partial(live_part, stop=self.workers.stop, check_functions=check)
        future = self.workers.executor.submit(live, self.plan.text, part, networks)
        self.under_way[future] = part

    def _lent(self, part: Part) -> bool:
        """Take a part from those who have lived it for a study of their own."""
        for lender in self.lenders:
            made = borrowed(self.plan, part, lender)
            if made is not None:
                self._take(part, made)
                return True
        return False

    def _take(self, part: Part, made: Made) -> None:
        """Write a part that was lived, and tell of it."""
        self.store.put(part, made)
        self.tally.add(part, made.steps, made.failed)
        self.order.done(part)
        # The clock starts with the first part, so that compiling does not count as living.
        if self.clock is None:
            self.clock = time.monotonic()
        else:
            self.measured += made.steps
        self._tell(part.kind, made.lives)

    def _tell(self, kind: Kind, rows: int) -> None:
        total = self.plan.numbering[kind].total
        if not total:
            return
        seconds = 0.0 if self.clock is None else time.monotonic() - self.clock
        pace = Pace(self.tally, self.plan.steps_to_learn, self.measured, seconds)
        cases = f", {self.tally.finished_cases:,} of {len(self.plan.cases):,} cases"
        self.tell(TASKS[kind], rows, total, str(pace) + (cases if kind == "lives" else ""))
