"""Threads that run compiled code, so that Ctrl-C is heard whatever that code does.

Python hears a signal in its main thread only, and only between two of its own instructions. So the
main thread never waits inside a kernel: it waits for a thread that does. These threads are daemons:
one whose compiled code never returns keeps neither a caller nor the end of the process waiting.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import Executor, Future
from functools import partial
from queue import Empty, SimpleQueue
from typing import Any, TypeVar

from numba.core import config

Result = TypeVar("Result")

PATIENCE = 1.0
"""Seconds to wait, after an interruption, for threads to come out of compiled code."""


class KernelThreads(Executor):
    """An executor of up to `count` daemon threads, started as they are needed.

    Left by an exception, it cancels what has not begun, and waits no longer than PATIENCE.
    """

    def __init__(self, count: int) -> None:
        """Start no thread yet."""
        self._count = count
        self._threads: list[threading.Thread] = []
        self._queue: SimpleQueue[tuple[Future[Any], Callable[[], Any]] | None] = SimpleQueue()

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Have a function called by one of the threads."""
        future: Future[Any] = Future()
        self._queue.put((future, partial(fn, *args, **kwargs)))
        if len(self._threads) < self._count:
            thread = threading.Thread(target=self._work, name="animat", daemon=True)
            self._threads.append(thread)
            thread.start()
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Let the threads end when the queue is empty, and `wait` for that."""
        if cancel_futures:
            while (item := self._next()) is not None:
                item[0].cancel()
        for _ in self._threads:
            self._queue.put(None)
        if wait:
            for thread in self._threads:
                thread.join()

    def __exit__(self, kind: object, error: object, trace: object) -> None:
        """Wait for all that was asked; after an exception only for what is soon done."""
        self.shutdown(wait=kind is None, cancel_futures=kind is not None)
        until = time.monotonic() + PATIENCE
        for thread in self._threads:
            thread.join(max(0.0, until - time.monotonic()))

    def _next(self) -> tuple[Future[Any], Callable[[], Any]] | None:
        try:
            return self._queue.get_nowait()
        except Empty:
            return None

    def _work(self) -> None:
        while (item := self._queue.get()) is not None:
            future, call = item
            if not future.set_running_or_notify_cancel():
                continue
            try:
                result = call()
            except BaseException as error:
                future.set_exception(error)
            else:
                future.set_result(result)
            del item, future, call


def attempt(call: Callable[[], Result]) -> tuple[Result | None, Exception | None]:
    """Call what runs compiled code, and return its result, or what it raised.

    From the main thread it is called on another one, while this one hears Ctrl-C. Uncompiled code
    (`NUMBA_DISABLE_JIT=1`) stays where it is, for a debugger.
    """

    def guarded() -> tuple[Result | None, Exception | None]:
        try:
            return call(), None
        except Exception as error:
            return None, error

    away = threading.current_thread() is not threading.main_thread()
    if away or config.DISABLE_JIT:  # pyright: ignore[reportAttributeAccessIssue]
        return guarded()
    with KernelThreads(1) as threads:
        return threads.submit(guarded).result()
