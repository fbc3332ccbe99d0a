"""Ctrl-C: once to finish what is under way, twice to stop at once."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event
from types import FrameType

ASKED = (
    "interrupted: finishing the parts that are under way; once more Ctrl-C stops at once, and"
    " loses them only\n"
)


@contextmanager
def interruptible(stop: Event) -> Iterator[Event]:
    """Yield an event that the first Ctrl-C sets; a second sets `stop` and raises.

    Where somebody else cares for Ctrl-C, or it is ignored, nothing changes.
    """
    asked = Event()

    def interrupted(number: int, frame: FrameType | None) -> None:
        if asked.is_set():
            stop.set()
            raise KeyboardInterrupt
        asked.set()
        sys.stderr.write(ASKED)
        sys.stderr.flush()

    ours = threading.current_thread() is threading.main_thread()
    if not ours or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield asked
        return
    before = signal.signal(signal.SIGINT, interrupted)
    try:
        yield asked
    finally:
        signal.signal(signal.SIGINT, before)
