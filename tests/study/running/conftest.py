"""Tests that start other processes end, whatever becomes of those."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Iterator

import pytest

from .patience import LONGEST


@pytest.fixture
def bounded() -> Iterator[None]:
    """End a test that hangs, and all tests with it."""

    def end() -> None:
        for _ in range(3):
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(1.0)

    watchdog = threading.Timer(2 * LONGEST, end)
    watchdog.daemon = True
    watchdog.start()
    yield
    watchdog.cancel()
