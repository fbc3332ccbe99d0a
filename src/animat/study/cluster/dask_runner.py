"""Parts lived by the workers of a cluster, as an executor.

A part waits as long as nobody may live it, and is given to others if all have gone who might have
lived it. What is a coroutine here runs in the thread of the client's event loop.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Coroutine
from concurrent.futures import CancelledError, Executor, Future
from contextlib import suppress
from functools import partial
from typing import Any, Protocol

from distributed import Client, KilledWorker
from distributed import Future as There
from distributed.comm.core import CommClosedError

from animat.study.cluster.admission import Roster
from animat.study.cluster.worker import ClusterError, begun, live
from animat.study.plan.plan import plan_of
from animat.study.plan.shard import Made, part_identity

LOOK_EVERY = 1.0
"""Seconds between two looks at who is there."""

BRIEFLY = 5.0
"""Seconds to wait for an answer while the user waits for the end."""


class Jobs(Protocol):
    """Workers that are jobs of a batch system."""

    async def keep(self) -> None:
        """See that as many as wanted are there or on their way. Raises ClusterError."""


class _Elsewhere(Future[Made]):
    """A part that is lived elsewhere; it cannot be cancelled while a worker is at it."""

    def __init__(self, is_begun: Callable[[str], bool]) -> None:
        super().__init__()
        self.key = ""
        self._is_begun = is_begun

    def cancel(self) -> bool:
        return not self._is_begun(self.key) and super().cancel()


class Remote(Executor):
    """Lives parts on those workers of a cluster that a roster accepts."""

    def __init__(self, client: Client, roster: Roster, jobs: Jobs | None = None) -> None:
        """Look who is there. Raises ClusterError if neither they nor the scheduler will do."""
        self._client, self._roster, self._jobs = client, roster, jobs
        self._placed: dict[str, tuple[There, set[str]]] = {}
        self._running: set[Future[None]] = set()
        self._error: Exception | None = None
        self._begun: tuple[float, set[str]] = 0.0, set()
        self._start(roster.look_first()).result()
        self._keeping = self._start(self._keep())

    @property
    def threads(self) -> int:
        """How many threads there are to live parts now."""
        return sum(self._roster.accepted.values())

    def submit(self, fn: Any, /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Have a part lived; the arguments are those of `live_part`, and no other function is."""
        text, part, networks = args
        call = partial(live, text, part, networks, part_identity(plan_of(text), part))
        future = _Elsewhere(self._is_begun)
        running = self._start(self._bring(future, call))
        self._running.add(running)
        running.add_done_callback(self._running.discard)
        future.add_done_callback(lambda _: running.cancel())
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Want nothing any more."""
        loop: Any = self._client.loop
        loop.add_callback(self._roster.give_up)
        for running in [self._keeping, *self._running]:
            running.cancel()

    def _start(self, what: Coroutine[Any, Any, Any]) -> Future[Any]:
        loop: Any = self._client.loop
        return asyncio.run_coroutine_threadsafe(what, loop.asyncio_loop)

    async def _bring(self, future: _Elsewhere, call: partial[Made]) -> None:
        """Have a part lived, and bring the result or what went wrong."""
        try:
            made = await self._live(future, call)
        except (Exception, asyncio.CancelledError) as error:
            if future.set_running_or_notify_cancel():
                future.set_exception(self._error or error)
        else:
            if future.set_running_or_notify_cancel():
                future.set_result(made)

    async def _live(self, future: _Elsewhere, call: partial[Made]) -> Made:
        while self._error is None:
            while not (allowed := set(self._roster.accepted)):
                await self._roster.someone.wait()
            self._see_scheduler()
            there = self._client.submit(call, workers=sorted(allowed), pure=False)
            future.key = str(there.key)
            self._placed[future.key] = there, allowed
            try:
                result: Any = there.result()
                return await result
            except (CancelledError, CommClosedError):
                self._see_scheduler()
            except KilledWorker as error:
                raise ClusterError(
                    f"{error.allowed_failures + 1} workers died one after another while they lived"
                    " the same part; what they said last tells why"
                ) from None
            finally:
                del self._placed[future.key]
                there.release()
        raise self._error

    async def _keep(self) -> None:
        """Look who is there, again and again, until the end of all or an error."""
        try:
            while True:
                await asyncio.sleep(LOOK_EVERY)
                self._see_scheduler()
                with suppress(OSError):
                    await self._roster.look()
                    await self._release_stranded()
                if self._jobs and self._running:
                    await self._jobs.keep()
        except Exception as error:
            self._fail(error)

    async def _release_stranded(self) -> None:
        """Let those parts be given to others for which only workers that have gone may be used.

        Only the scheduler knows which these are: of a part that has killed its workers the news may
        still be on its way, and it must not be begun again.
        """

        # Pickled by value, since the scheduler may have an animat without it.
        def waiting(dask_scheduler: Any) -> list[str]:
            return [str(task.key) for task in dask_scheduler.unrunnable]

        if any(not may & self._roster.accepted.keys() for _, may in self._placed.values()):
            client: Any = self._client
            for key in await client.run_on_scheduler(waiting):
                if key in self._placed:
                    self._placed[key][0].release()

    def _see_scheduler(self) -> None:
        if self._client.status != "running":
            raise ClusterError("the scheduler has gone away")

    def _fail(self, error: Exception) -> None:
        """End everything that is under way with an error."""
        self._error = error
        for running in list(self._running):
            running.cancel()

    def _is_begun(self, key: str) -> bool:
        """Tell whether a worker is at a task; all are asked, at most once in a while."""
        if self._error is not None or self._client.status != "running":
            return False
        if time.monotonic() - self._begun[0] > LOOK_EVERY:
            keys: set[str] = set()
            asking = self._start(asyncio.wait_for(self._all_begun(), BRIEFLY))
            with suppress(OSError):
                keys = asking.result()
            self._begun = time.monotonic(), keys
        return key in self._begun[1]

    async def _all_begun(self) -> set[str]:
        client: Any = self._client
        # Who has died since the last look would be waited for.
        who = list(self._roster.accepted.keys() & await client.nthreads())
        answers = await client.run(begun, workers=who, on_error="ignore")
        return {key for keys in answers.values() for key in keys}
